// From a path to tinygltf's model of it.
#pragma once

#include <string>

#include "scene/tinygltf.hpp"

namespace harness {

/// Buffers are loaded, images are not looked at. No reference and no range inside the model has been checked yet. Throws
/// std::exception; the message does not name the file.
tinygltf::Model read_gltf_document(const std::string& path);

}  // namespace harness
