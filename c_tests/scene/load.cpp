#include "scene/load.hpp"

#include <charconv>
#include <string_view>

namespace harness {

namespace {

constexpr std::string_view generator_prefix = "gen:";

std::size_t parse_triangle_count(const std::string& spec, std::string_view text) {
    std::size_t count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size() || count == 0)
        throw SceneError(spec + ": \"" + std::string(text) + "\" is not a number of triangles");
    return count;
}

/// `spec` without its prefix: NAME[:TRIANGLES].
Scene load_generated(const std::string& spec, std::string_view rest) {
    const std::size_t colon = rest.find(':');
    const std::string name(rest.substr(0, colon));
    const std::size_t triangle_count = colon == std::string_view::npos ? 0 : parse_triangle_count(spec, rest.substr(colon + 1));
    return generate_scene(name, triangle_count);
}

}  // namespace

Scene load_scene(const std::string& spec) {
    if (spec.starts_with(generator_prefix)) return load_generated(spec, std::string_view(spec).substr(generator_prefix.size()));
    if (!spec.ends_with(".glb") && !spec.ends_with(".gltf"))
        throw SceneError(spec + ": neither a .glb or .gltf file nor gen:NAME[:TRIANGLES]");
    Scene scene = load_gltf(spec);
    if (scene.triangle_count() == 0) throw SceneError(spec + ": no triangles in its default scene");
    return scene;
}

}  // namespace harness
