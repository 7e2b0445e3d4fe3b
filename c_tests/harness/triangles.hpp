// A harness mesh as the C interface wants it.
#pragma once

#include "gnomon.h"
#include "scene/scene.hpp"

namespace harness {

/// Points into the mesh, which must outlive it.
inline GnomonTriangles triangles_of(const Mesh& mesh) {
    GnomonTriangles triangles{};
    triangles.positions = mesh.positions.data();
    triangles.vertex_count = mesh.vertex_count();
    triangles.indices = mesh.indices.data();
    triangles.index_format = GNOMON_INDEX_U32;
    triangles.triangle_count = mesh.triangle_count();
    return triangles;
}

}  // namespace harness
