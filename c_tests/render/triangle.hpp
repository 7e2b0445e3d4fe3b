// A triangle's vertices.
#pragma once

#include "scene/scene.hpp"

namespace render {

inline std::array<harness::Vec3f, 3> triangle_of(const harness::Mesh& mesh, std::size_t primitive_id) {
    const auto vertex = [&](std::size_t corner) -> harness::Vec3f {
        const float* position = &mesh.positions[3 * std::size_t{mesh.indices[3 * primitive_id + corner]}];
        return {position[0], position[1], position[2]};
    };
    return {vertex(0), vertex(1), vertex(2)};
}

}  // namespace render
