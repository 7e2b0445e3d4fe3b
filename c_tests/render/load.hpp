// Where scenes to render come from: a glTF file, or a generator.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "render/render_scene.hpp"

namespace render {

/// `spec` is a path to a .glb or .gltf file, or `gen:NAME[:TRIANGLES]`: gen:cornell, gen:furnace, or any that load_scene knows,
/// which become grey. Throws harness::SceneError, in one line that names the file and the member: for what gltf_light.hpp,
/// gltf_camera.hpp and gltf_material.hpp say, and for every reference that leads nowhere.
///
/// What can be done without is said in `remarks`, one line each:
///   - a scene without a camera gets one that frames it, called "default";
///   - a scene without any light gets a sky of 1000 nt, an overcast day; `environment_nt`, where given, is the sky in any case;
///   - a primitive without a material is grey, a base colour above 1 becomes 1;
///   - a texture that cannot be read, or that a primitive has no coordinates for, is left out: its factor remains;
///   - lamps and cameras that no node of the scene holds are left out.
/// Not looked at: vertex colours, normals and normal maps, skins and animations.
RenderScene load_render_scene(const std::string& spec, std::vector<std::string>& remarks,
                              std::optional<float> environment_nt = {});

}  // namespace render
