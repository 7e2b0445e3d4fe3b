// A glTF file as a RenderScene.
#pragma once

#include <string>
#include <vector>

#include "render/render_scene.hpp"

namespace render {

/// Geometry is read by scene/'s loader. All else is read from the JSON and not from tinygltf 2.7's model, which passes over a
/// member of the wrong type in silence and cannot tell a lamp of range 0 from one without. Throws std::exception; neither its
/// message nor a remark names the file.
RenderScene load_gltf_scene(const std::string& path, std::vector<std::string>& remarks);

}  // namespace render
