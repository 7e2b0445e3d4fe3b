// Reading the elements of an accessor, with every reference and range checked.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/tinygltf.hpp"

namespace harness {

/// Checks that `accessor_id` exists. Throws SceneError, as all of this file do, with a message that begins with the accessor.
const tinygltf::Accessor& find_accessor(const tinygltf::Model& model, int accessor_id);

/// Three floats an element: the accessor must be VEC3 FLOAT. Values are passed on as they are, NaN and infinities too.
std::vector<float> read_positions(const tinygltf::Model& model, int accessor_id);

/// Two floats an element, of VEC2 FLOAT or of normalized UNSIGNED_BYTE or _SHORT, which become [0, 1].
std::vector<float> read_texcoords(const tinygltf::Model& model, int accessor_id);

/// The accessor must be SCALAR of an unsigned type. The values are not compared with any vertex count.
std::vector<std::uint32_t> read_indices(const tinygltf::Model& model, int accessor_id);

/// The bytes of a bufferView, which must exist and lie inside its buffer; they live as long as the model.
std::span<const unsigned char> view_bytes(const tinygltf::Model& model, int view_id);

}  // namespace harness
