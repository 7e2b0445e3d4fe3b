#include "scene/gltf_nodes.hpp"

#include <algorithm>
#include <cmath>

#include "scene/load.hpp"

namespace harness {

namespace {

/// The walk recurses once a level.
constexpr std::size_t deepest_level = 1000;
/// Nodes with two parents double with each level: forty of them would take a day to walk.
constexpr std::size_t most_visits = std::size_t(1) << 20;

Affine from_matrix(const std::vector<double>& m) {
    if (m.size() != 16) throw SceneError("matrix has " + std::to_string(m.size()) + " numbers, not 16");
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) throw SceneError("matrix is not affine: its last row is not 0 0 0 1");
    // Column by column in the file.
    return {{{{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}}}, {m[12], m[13], m[14]}};
}

std::vector<double> property(const char* name, const std::vector<double>& values, std::vector<double> otherwise) {
    if (values.empty()) return otherwise;
    if (values.size() != otherwise.size())
        throw SceneError(std::string(name) + " has " + std::to_string(values.size()) + " numbers, not " +
                         std::to_string(otherwise.size()));
    return values;
}

/// The rotation by a quaternion x y z w of any length but 0: files hold unit quaternions rounded to float.
std::array<Vec3d, 3> rotation_rows(const std::vector<double>& q) {
    const double x = q[0], y = q[1], z = q[2], w = q[3];
    const double norm = x * x + y * y + z * z + w * w;
    if (norm == 0) throw SceneError("rotation has length 0");
    const double s = 2 / norm;
    return {{{1 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)},
             {s * (x * y + z * w), 1 - s * (x * x + z * z), s * (y * z - x * w)},
             {s * (x * z - y * w), s * (y * z + x * w), 1 - s * (x * x + y * y)}}};
}

Affine local_transform(const tinygltf::Node& node) {
    if (!node.matrix.empty()) return from_matrix(node.matrix);
    const auto translation = property("translation", node.translation, {0, 0, 0});
    const auto scale = property("scale", node.scale, {1, 1, 1});
    Affine result{rotation_rows(property("rotation", node.rotation, {0, 0, 0, 1})),
                  {translation[0], translation[1], translation[2]}};
    for (Vec3d& row : result.linear)
        for (std::size_t column = 0; column < 3; ++column) row[column] *= scale[column];
    return result;
}

bool is_finite(const Vec3d& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

bool is_finite(const Affine& a) {
    return std::ranges::all_of(a.linear, [](const Vec3d& row) { return is_finite(row); }) && is_finite(a.translation);
}

[[noreturn]] void fail(int node_id, const std::string& what) {
    throw SceneError("node " + std::to_string(node_id) + ": " + what);
}

class Walk {
public:
    Walk(const tinygltf::Model& model, const NodeVisitor& visitor)
        : model_(model), visitor_(visitor), on_path_(model.nodes.size(), false) {}

    void visit(int node_id, const Affine& parent, std::size_t level) {
        const tinygltf::Node& node = enter(node_id, level);
        const Affine transform = parent * transform_of(node_id);
        if (!is_finite(transform)) fail(node_id, "the product of the matrices down to it is not finite");
        visitor_(node_id, transform);
        for (int child : node.children) {
            if (std::size_t(child) >= model_.nodes.size())
                fail(node_id,
                     "child " + std::to_string(child) + " does not exist: " + std::to_string(model_.nodes.size()) + " nodes");
            visit(child, transform, level + 1);
        }
        on_path_[std::size_t(node_id)] = false;
    }

private:
    const tinygltf::Node& enter(int node_id, std::size_t level) {
        if (on_path_[std::size_t(node_id)]) fail(node_id, "it is its own descendant");
        if (level > deepest_level) fail(node_id, "deeper than " + std::to_string(deepest_level) + " levels");
        if (++visit_count_ > most_visits) fail(node_id, "more than " + std::to_string(most_visits) + " node instances");
        on_path_[std::size_t(node_id)] = true;
        return model_.nodes[std::size_t(node_id)];
    }

    Affine transform_of(int node_id) const {
        try {
            return local_transform(model_.nodes[std::size_t(node_id)]);
        } catch (const SceneError& error) {
            fail(node_id, error.what());
        }
    }

    const tinygltf::Model& model_;
    const NodeVisitor& visitor_;
    std::vector<bool> on_path_;
    std::size_t visit_count_ = 0;
};

std::vector<int> nobodys_children(const tinygltf::Model& model) {
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (int child : node.children)
            if (std::size_t(child) < is_child.size()) is_child[std::size_t(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) roots.push_back(int(i));
    if (roots.empty() && !model.nodes.empty()) throw SceneError("no scene, and every node is another's child");
    return roots;
}

std::vector<int> root_nodes(const tinygltf::Model& model) {
    if (model.scenes.empty() && model.defaultScene < 0) return nobodys_children(model);
    const std::size_t scene_id = std::size_t(std::max(model.defaultScene, 0));
    const std::string name = "scene " + std::to_string(scene_id);
    if (scene_id >= model.scenes.size())
        throw SceneError(name + " does not exist: " + std::to_string(model.scenes.size()) + " scenes");
    const std::vector<int>& roots = model.scenes[scene_id].nodes;
    for (int root : roots)
        if (std::size_t(root) >= model.nodes.size())
            throw SceneError(name + ": node " + std::to_string(root) + " does not exist: " + std::to_string(model.nodes.size()) +
                             " nodes");
    return roots;
}

}  // namespace

Vec3d Affine::apply(const Vec3d& p) const {
    Vec3d result;
    for (std::size_t i = 0; i < 3; ++i)
        result[i] = linear[i][0] * p[0] + linear[i][1] * p[1] + linear[i][2] * p[2] + translation[i];
    return result;
}

Affine operator*(const Affine& outer, const Affine& inner) {
    Affine product;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            product.linear[i][j] = outer.linear[i][0] * inner.linear[0][j] + outer.linear[i][1] * inner.linear[1][j] +
                                   outer.linear[i][2] * inner.linear[2][j];
    product.translation = outer.apply(inner.translation);
    return product;
}

void walk_nodes(const tinygltf::Model& model, const NodeVisitor& visitor) {
    Walk walk(model, visitor);
    for (int root : root_nodes(model)) walk.visit(root, Affine{}, 1);
}

std::vector<MeshInstance> mesh_instances(const tinygltf::Model& model) {
    std::vector<MeshInstance> instances;
    walk_nodes(model, [&](int node_id, const Affine& transform) {
        const int mesh_id = model.nodes[std::size_t(node_id)].mesh;
        if (mesh_id < 0) return;
        if (std::size_t(mesh_id) >= model.meshes.size())
            fail(node_id,
                 "mesh " + std::to_string(mesh_id) + " does not exist: " + std::to_string(model.meshes.size()) + " meshes");
        instances.push_back({node_id, mesh_id, transform});
    });
    return instances;
}

}  // namespace harness
