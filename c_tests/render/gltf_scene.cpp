#include "render/gltf_scene.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "render/generate.hpp"
#include "render/gltf_camera.hpp"
#include "render/gltf_light.hpp"
#include "render/gltf_material.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/gltf_document.hpp"
#include "scene/gltf_expand.hpp"
#include "scene/gltf_json.hpp"
#include "scene/load.hpp"

namespace render {

namespace {

using namespace harness;
using Remarks = std::vector<std::string>;

const std::set<std::string> read_at_root = {"cameras", "extensions", "images",   "materials",
                                            "meshes",  "nodes",      "samplers", "textures"};

/// What a primitive looks like, wherever it stands.
struct Look {
    std::uint32_t material_id;
    std::vector<float> uvs;
};

class Looks {
public:
    Looks(const tinygltf::Model& model, const JsonObject& root, RenderScene& scene, Remarks& remarks)
        : model_(model), materials_(root.objects("materials")), scene_(scene), remarks_(remarks) {
        for (const JsonObject& mesh : root.objects("meshes")) primitives_.push_back(mesh.objects("primitives"));
    }

    void read_materials(TextureReader& textures) {
        for (const JsonObject& material : materials_)
            scene_.materials.push_back(read_material(material, textures, scene_, remarks_));
    }

    const Look& of(int mesh_id, std::size_t primitive_id) {
        const auto found = known_.find({mesh_id, primitive_id});
        if (found != known_.end()) return found->second;
        const JsonObject& primitive = primitives_[std::size_t(mesh_id)][primitive_id];
        return known_[{mesh_id, primitive_id}] = naming_primitive(mesh_id, primitive_id, [&] { return read(primitive); });
    }

private:
    Look read(const JsonObject& primitive) {
        const std::optional<std::size_t> id = primitive.id("material", materials_.size(), "materials");
        if (!id) return {without_material(), {}};
        if (scene_.materials[*id].base_color_texture < 0) return {std::uint32_t(*id), {}};
        return {std::uint32_t(*id), read_uvs(primitive, materials_[*id])};
    }

    /// One more material, for all that have none. The specification's white would leave nothing to be seen under an even sky.
    std::uint32_t without_material() {
        if (!grey_) {
            grey_ = std::uint32_t(scene_.materials.size());
            scene_.materials.push_back(grey_material());
        }
        return *grey_;
    }

    std::vector<float> read_uvs(const JsonObject& primitive, const JsonObject& material) {
        const JsonObject info = material.object("pbrMetallicRoughness").object("baseColorTexture");
        if (info.object("extensions").has("KHR_texture_transform"))
            remark_once(info.path() + ": KHR_texture_transform is not applied");
        const std::string set =
            "TEXCOORD_" + std::to_string(info.id("texCoord", 1000, "sets of texture coordinates").value_or(0));
        const JsonObject attributes = primitive.object("attributes");
        const std::optional<std::size_t> accessor_id = attributes.id(set.c_str(), model_.accessors.size(), "accessors");
        if (!accessor_id) {
            remark_once(primitive.path() + " has no " + set + ": its texture is left out");
            return {};
        }
        std::vector<float> uvs = read_texcoords(model_, int(*accessor_id));
        const std::size_t vertex_count =
            find_accessor(model_, int(attributes.id("POSITION", model_.accessors.size(), "accessors").value())).count;
        if (uvs.size() / 2 != vertex_count)
            throw SceneError(set + " has " + std::to_string(uvs.size() / 2) + " elements for " + std::to_string(vertex_count) +
                             " vertices");
        return uvs;
    }

    void remark_once(const std::string& remark) {
        if (std::ranges::find(remarks_, remark) == remarks_.end()) remarks_.push_back(remark);
    }

    const tinygltf::Model& model_;
    std::vector<JsonObject> materials_;
    std::vector<std::vector<JsonObject>> primitives_;  // by mesh
    RenderScene& scene_;
    Remarks& remarks_;
    std::map<std::pair<int, std::size_t>, Look> known_;
    std::optional<std::uint32_t> grey_;
};

/// A mirroring transform turns front into back; the specification wants the front to stay.
bool is_mirroring(const Affine& transform) {
    const auto& [a, b, c] = transform.linear;
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]) < 0;
}

void read_surfaces(const tinygltf::Model& model, Looks& looks, RenderScene& scene) {
    const std::vector<MeshInstance> instances = mesh_instances(model);
    const std::vector<PrimitiveInstance> primitives = primitive_instances(model, instances);
    std::vector<Mesh> meshes = expand(model, primitives);
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        const Look& look = looks.of(primitives[i].instance->mesh_id, primitives[i].primitive_id);
        std::vector<std::uint32_t>& indices = meshes[i].indices;
        if (is_mirroring(primitives[i].instance->transform))
            for (std::size_t corner = 0; corner < indices.size(); corner += 3)
                std::swap(indices[corner + 1], indices[corner + 2]);
        scene.surfaces.push_back({std::move(meshes[i]), look.uvs, look.material_id});
    }
}

/// Cameras and lamps where nodes put them.
class Placed {
public:
    Placed(const JsonObject& root, RenderScene& scene)
        : nodes_(root.objects("nodes")),
          cameras_(root.objects("cameras")),
          light_objects_(root.object("extensions").object("KHR_lights_punctual").objects("lights")),
          is_camera_used_(cameras_.size()),
          is_light_used_(light_objects_.size()),
          scene_(scene) {
        for (const JsonObject& light : light_objects_) lights_.push_back(read_light(light));
    }

    void visit(int node_id, const Affine& transform) {
        const JsonObject& node = nodes_[std::size_t(node_id)];
        if (const auto id = node.id("camera", cameras_.size(), "cameras")) {
            Camera camera = read_camera(cameras_[*id], frame_of(node_id, transform));
            camera.name = node.text("name", camera.name);
            scene_.cameras.push_back(camera);
            is_camera_used_[*id] = true;
        }
        const JsonObject use = node.object("extensions").object("KHR_lights_punctual");
        if (const auto id = use.id("light", lights_.size(), "lights")) {
            add_light(scene_, lights_[*id], frame_of(node_id, transform));
            is_light_used_[*id] = true;
        }
    }

    void remark_unused(Remarks& remarks) const {
        for (std::size_t i = 0; i < cameras_.size(); ++i)
            if (!is_camera_used_[i]) remarks.push_back(cameras_[i].path() + " is at no node of the scene: it is left out");
        for (std::size_t i = 0; i < lights_.size(); ++i)
            if (!is_light_used_[i]) remarks.push_back(light_objects_[i].path() + " is at no node of the scene: it is left out");
    }

private:
    std::vector<JsonObject> nodes_, cameras_, light_objects_;
    std::vector<Light> lights_;
    std::vector<bool> is_camera_used_, is_light_used_;
    RenderScene& scene_;
};

}  // namespace

RenderScene load_gltf_scene(const std::string& path, Remarks& remarks) {
    const GlbChunks chunks = read_gltf_chunks(path);
    const tinygltf::Model model = parse_gltf(chunks, path);  // first: it checks references, and what all of the JSON must be
    const nlohmann::json document = parse_gltf_json(chunks.json, read_at_root);
    const JsonObject root(document, "");

    RenderScene scene;
    scene.name = std::filesystem::path(path).stem().string();
    TextureReader textures(model, root, path, scene, remarks);
    Looks looks(model, root, scene, remarks);
    looks.read_materials(textures);
    read_surfaces(model, looks, scene);
    Placed placed(root, scene);
    walk_nodes(model, [&](int node_id, const Affine& transform) { placed.visit(node_id, transform); });
    placed.remark_unused(remarks);
    return scene;
}

}  // namespace render
