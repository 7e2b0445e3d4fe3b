#include "scene/gltf_expand.hpp"

#include <map>
#include <utility>

#include "scene/gltf_primitive.hpp"

namespace harness {

namespace {

/// Instances multiply: a small file can ask for any amount of memory. The engines count triangles and vertices of a scene in 32
/// bits, Embree in 31.
constexpr std::uint64_t most_expanded = std::uint64_t(1) << 31;

/// A vertex that is not finite, in the file or once rounded to float, is not this loader's to judge: the library rejects or skips
/// its triangles.
std::vector<float> transformed(const std::vector<float>& positions, const Affine& transform) {
    // The product with the identity would turn -0 into 0 and spread one infinity over the vertex.
    if (transform == Affine{}) return positions;
    std::vector<float> result(positions.size());
    for (std::size_t i = 0; i < positions.size(); i += 3) {
        const Vec3d p = transform.apply({positions[i], positions[i + 1], positions[i + 2]});
        for (std::size_t axis = 0; axis < 3; ++axis) result[i + axis] = float(p[axis]);
    }
    return result;
}

}  // namespace

std::vector<PrimitiveInstance> primitive_instances(const tinygltf::Model& model, const std::vector<MeshInstance>& instances) {
    std::vector<PrimitiveInstance> result;
    PrimitiveSize total{0, 0};
    for (const MeshInstance& instance : instances) {
        const auto& primitives = model.meshes[std::size_t(instance.mesh_id)].primitives;
        if (primitives.empty()) throw SceneError("mesh " + std::to_string(instance.mesh_id) + " has no primitives");
        for (std::size_t i = 0; i < primitives.size(); ++i) {
            const PrimitiveSize size =
                naming_primitive(instance.mesh_id, i, [&] { return primitive_size(model, primitives[i]); });
            if (size.triangle_count == 0) continue;
            total.triangle_count += size.triangle_count;
            total.vertex_count += size.vertex_count;
            if (total.triangle_count > most_expanded || total.vertex_count > most_expanded)
                throw SceneError("more than 2^31 triangles or vertices at node " + std::to_string(instance.node_id));
            result.push_back({&instance, i});
        }
    }
    return result;
}

std::vector<Mesh> expand(const tinygltf::Model& model, const std::vector<PrimitiveInstance>& instances) {
    std::map<std::pair<int, std::size_t>, PrimitiveTriangles> read;  // each primitive once, however many instances it has
    std::vector<Mesh> meshes;
    for (const auto& [instance, primitive_id] : instances) {
        const tinygltf::Mesh& mesh = model.meshes[std::size_t(instance->mesh_id)];
        auto found = read.find({instance->mesh_id, primitive_id});
        if (found == read.end()) {
            PrimitiveTriangles triangles = naming_primitive(
                instance->mesh_id, primitive_id, [&, id = primitive_id] { return read_primitive(model, mesh.primitives[id]); });
            found = read.emplace(std::pair{instance->mesh_id, primitive_id}, std::move(triangles)).first;
        }
        meshes.push_back({mesh.name, transformed(found->second.positions, instance->transform), found->second.indices});
    }
    return meshes;
}

}  // namespace harness
