// The part of a glTF file's JSON that geometry needs, checked for types before tinygltf reads it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <set>
#include <string>
#include <string_view>

namespace harness {

/// Drops all but buffers, accessors, meshes, nodes and scenes, and checks the types of what is left. Throws SceneError, or an
/// exception of nlohmann::json for text that is not JSON.
///
/// Why before tinygltf 2.7: it forms a pointer past the buffer for an image whose bufferView lies outside, recurses as deep as
/// `extras` nest, cuts integers to 32 bits, and passes over a property of the wrong type in silence.
std::string geometry_json(std::string_view text);

/// The object that `text` holds, of its members those that are named, without `extras` and the like in them; no type is checked.
/// Throws as geometry_json does.
nlohmann::json parse_gltf_json(std::string_view text, const std::set<std::string>& kept_at_root);

}  // namespace harness
