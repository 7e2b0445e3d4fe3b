#include "render/load.hpp"

#include <utility>

#include "render/camera.hpp"
#include "render/generate.hpp"
#include "render/gltf_scene.hpp"
#include "scene/load.hpp"

namespace render {

namespace {

using harness::SceneError;

constexpr float overcast_nt = 1000;

const struct {
    std::string spec;
    RenderScene (*make)();
} lit_generators[] = {{"gen:cornell", make_cornell}, {"gen:furnace", make_furnace}};

RenderScene grey_scene(harness::Scene geometry) {
    RenderScene scene;
    scene.name = geometry.name;
    scene.materials = {grey_material()};
    for (harness::Mesh& mesh : geometry.meshes) scene.surfaces.push_back({std::move(mesh), {}, 0});
    return scene;
}

RenderScene load_gltf(const std::string& path, std::vector<std::string>& remarks) {
    const std::size_t first = remarks.size();
    try {
        RenderScene scene = load_gltf_scene(path, remarks);
        if (scene.surfaces.empty()) throw SceneError("no triangles in its default scene");
        for (std::size_t i = first; i < remarks.size(); ++i) remarks[i] = path + ": " + remarks[i];
        return scene;
    } catch (const std::exception& error) {
        throw SceneError(path + ": " + error.what());
    }
}

RenderScene load_any(const std::string& spec, std::vector<std::string>& remarks) {
    for (const auto& [name, make] : lit_generators) {
        if (spec == name) return make();
        if (spec.starts_with(name + ":")) throw SceneError(spec + ": of " + name + " there is one size only");
    }
    if (spec.ends_with(".glb") || spec.ends_with(".gltf")) return load_gltf(spec, remarks);
    return grey_scene(harness::load_scene(spec));
}

}  // namespace

RenderScene load_render_scene(const std::string& spec, std::vector<std::string>& remarks, std::optional<float> environment_nt) {
    RenderScene scene = load_any(spec, remarks);
    if (environment_nt) scene.environment_nt = {*environment_nt, *environment_nt, *environment_nt};
    if (!environment_nt && !scene.has_light()) {
        scene.environment_nt = {overcast_nt, overcast_nt, overcast_nt};
        remarks.push_back(spec + ": no light: under a sky of 1000 nt");
    }
    if (scene.cameras.empty()) {
        scene.cameras.push_back(default_camera(scene, spec));
        remarks.push_back(spec + ": no camera: seen from outside");
    }
    return scene;
}

}  // namespace render
