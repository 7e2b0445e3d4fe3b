#include "scene/gltf_primitive.hpp"

#include <array>
#include <numeric>
#include <string>

#include "scene/gltf_accessor.hpp"
#include "scene/load.hpp"

namespace harness {

namespace {

int position_accessor(const tinygltf::Primitive& primitive) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end()) throw SceneError("no POSITION");
    return position->second;
}

std::uint64_t triangle_count(int mode, std::uint64_t corner_count) {
    switch (mode) {
        case TINYGLTF_MODE_TRIANGLES:
            return corner_count / 3;
        case TINYGLTF_MODE_TRIANGLE_STRIP:
        case TINYGLTF_MODE_TRIANGLE_FAN:
            return corner_count < 3 ? 0 : corner_count - 2;
        case TINYGLTF_MODE_POINTS:
        case TINYGLTF_MODE_LINE:
        case TINYGLTF_MODE_LINE_LOOP:
        case TINYGLTF_MODE_LINE_STRIP:
            return 0;
        default:
            throw SceneError("mode " + std::to_string(mode) + " does not exist");
    }
}

/// Places of the three corners of triangle `i` among the primitive's corners (specification, section 3.7.2.1).
std::array<std::size_t, 3> triangle_corners(int mode, std::size_t i) {
    switch (mode) {
        case TINYGLTF_MODE_TRIANGLE_STRIP:
            return {i, i + 1 + i % 2, i + 2 - i % 2};
        case TINYGLTF_MODE_TRIANGLE_FAN:
            return {i + 1, i + 2, 0};
        default:
            return {3 * i, 3 * i + 1, 3 * i + 2};
    }
}

std::vector<std::uint32_t> read_corners(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                                        std::size_t vertex_count) {
    if (primitive.indices < 0) {
        std::vector<std::uint32_t> corners(vertex_count);
        std::iota(corners.begin(), corners.end(), 0u);
        return corners;
    }
    std::vector<std::uint32_t> corners = read_indices(model, primitive.indices);
    for (std::size_t i = 0; i < corners.size(); ++i)
        if (corners[i] >= vertex_count)
            throw SceneError("index " + std::to_string(corners[i]) + " at position " + std::to_string(i) +
                             " is out of range: " + std::to_string(vertex_count) + " vertices");
    return corners;
}

}  // namespace

PrimitiveSize primitive_size(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    const std::uint64_t vertex_count = find_accessor(model, position_accessor(primitive)).count;
    const std::uint64_t corner_count = primitive.indices < 0 ? vertex_count : find_accessor(model, primitive.indices).count;
    return {triangle_count(primitive.mode, corner_count), vertex_count};
}

PrimitiveTriangles read_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive) {
    PrimitiveTriangles result{read_positions(model, position_accessor(primitive)), {}};
    const std::vector<std::uint32_t> corners = read_corners(model, primitive, result.positions.size() / 3);
    const std::size_t count = triangle_count(primitive.mode, corners.size());
    result.indices.reserve(count * 3);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t corner : triangle_corners(primitive.mode, i)) result.indices.push_back(corners[corner]);
    return result;
}

}  // namespace harness
