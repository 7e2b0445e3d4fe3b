// From a path to tinygltf's model of it.
#pragma once

#include <string>

#include "scene/glb.hpp"
#include "scene/tinygltf.hpp"

namespace harness {

/// The JSON and the BIN chunk of a .glb file; of a .gltf file the JSON alone. Throws std::exception, as all of this file do; the
/// message does not name the file.
GlbChunks read_gltf_chunks(const std::string& path);

/// Buffers are loaded, relative to the file at `path`; images are not looked at. No reference and no range inside the model has
/// been checked yet.
tinygltf::Model parse_gltf(GlbChunks chunks, const std::string& path);

}  // namespace harness
