// One triangle primitive of a glTF mesh, in the mesh's own space.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/tinygltf.hpp"

namespace harness {

struct PrimitiveSize {
    std::uint64_t triangle_count, vertex_count;
};

/// As the accessors claim it, without reading them: what decides whether there is room. No triangles for points, lines, and too
/// few vertices. Throws SceneError.
PrimitiveSize primitive_size(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

struct PrimitiveTriangles {
    std::vector<float> positions;
    std::vector<std::uint32_t> indices;  // three a triangle, each less than the vertex count
};

/// Lists, strips and fans become a list. Throws SceneError.
PrimitiveTriangles read_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive);

}  // namespace harness
