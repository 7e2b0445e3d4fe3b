#include "render/furnace.hpp"

#include <array>
#include <nlohmann/json.hpp>

#include "harness/mean.hpp"
#include "render/camera_ray.hpp"
#include "render/traced_scene.hpp"

namespace render {

namespace {

constexpr const char* class_names[] = {"diffuse", "mirror", "glass", "background", "all"};  // the first three as MaterialKind
constexpr std::size_t background = 3, all = 4;

/// By pixel. The same rays as those of a picture of one sample.
std::vector<std::size_t> seen_classes(const RenderScene& scene, const Camera& camera, const RenderOptions& options) {
    const TracedScene traced(scene, options.precision, options.thread_count);
    std::vector<std::size_t> classes;
    for (int y = 0; y < options.height; ++y) {
        for (int x = 0; x < options.width; ++x) {
            const GnomonRay ray = camera_ray(camera, (x + 0.5) / options.width, (y + 0.5) / options.height);
            GnomonHit hit;
            const bool is_hit = gnomon_intersect(traced.handle.get(), &ray, &hit);
            classes.push_back(is_hit ? std::size_t(scene.materials[scene.surfaces[hit.geometry_id].material_id].kind)
                                     : background);
        }
    }
    return classes;
}

nlohmann::ordered_json classes_json(const Image& image, const std::vector<std::size_t>& classes) {
    std::array<harness::Mean, std::size(class_names)> means;
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        for (const std::size_t index : {classes[i], all}) means[index].add(luminance(image.pixels[i]));
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < means.size(); ++i) {
        if (means[i].count == 0) continue;
        list.push_back({{"class", class_names[i]},
                        {"mean", means[i].mean},
                        {"standard_error", means[i].standard_error()},
                        {"sample_count", means[i].count},
                        {"pixel_count", means[i].count}});
    }
    return list;
}

}  // namespace

nlohmann::ordered_json furnace_json(const RenderScene& scene, const Camera& camera, RenderOptions options,
                                    const RenderProgress& progress, const std::atomic<bool>& stop) {
    options.sample_count = 1;
    const std::vector<std::size_t> classes = seen_classes(scene, camera, options);
    nlohmann::ordered_json methods = nlohmann::ordered_json::array();
    for (const auto& [name, method] : {std::pair{"path", Method::path}, std::pair{"whitted", Method::whitted}}) {
        options.method = method;
        const Rendering rendering = render(scene, camera, options, progress, stop);
        methods.push_back({{"method", name}, {"classes", classes_json(rendering.image, classes)}});
    }
    return {{"methods", methods}};
}

}  // namespace render
