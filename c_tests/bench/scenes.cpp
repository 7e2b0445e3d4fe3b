#include "bench/scenes.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

namespace harness {
namespace {

constexpr std::size_t least_triangles = 50'000;  // performance.md's scenes; smaller ones live in the caches
constexpr std::array quick_names = {"2cylinderengine", "spaceship", "stanford_bunny", "stanford_dragon",
                                    "stk_ravenbridge_mansion"};
constexpr std::array quick_generated = {"gen:interior:1000000"};
constexpr std::array generated = {"gen:interior:1000000", "gen:terrain:1000000", "gen:icosphere:1000000"};
constexpr std::string_view assimp_engine = GNOMON_ASSIMP_MODELS "/2CylinderEngine-glTF-Binary/2CylinderEngine.glb";

std::vector<std::string> shared_scenes() {
    std::vector<std::string> paths;
    std::error_code missing;
    for (const auto& entry : std::filesystem::directory_iterator(GNOMON_SHARED_SCENES, missing)) {
        if (entry.path().extension() == ".glb") paths.push_back(entry.path().string());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

bool is_quick(const std::string& path) {
    const std::string name = std::filesystem::path(path).stem().string();
    return std::find(quick_names.begin(), quick_names.end(), name) != quick_names.end();
}

/// A shared scene, or what is generated in its place.
struct Substituted {
    std::string path, generated;
};
const std::array structure_scenes = {
    Substituted{"", "gen:soup:100000"},
    Substituted{GNOMON_SHARED_SCENES "/teapot_in_stadium.glb", "gen:teapot_in_stadium:100000"},
    Substituted{"", "gen:interior:100000"},
    Substituted{GNOMON_SHARED_SCENES "/stanford_bunny.glb", "gen:icosphere:80000"},
    Substituted{"", "gen:hair:99000"},
    Substituted{GNOMON_SHARED_SCENES "/kicad_dsub62.glb", "gen:needles:60000"},
};

}  // namespace

std::vector<SceneChoice> choose_scenes(const BenchOptions& options, std::vector<std::string>& notes) {
    std::vector<SceneChoice> choices;
    for (const std::string& spec : options.scenes) choices.push_back({spec, 0});
    if (!choices.empty()) return choices;
    for (const std::string& path : shared_scenes()) {
        if (!options.quick || is_quick(path)) choices.push_back({path, least_triangles});
    }
    if (choices.empty()) {
        notes.push_back("no scenes in " GNOMON_SHARED_SCENES ": measured assimp's 2CylinderEngine and generated scenes alone");
        if (std::filesystem::exists(assimp_engine)) choices.push_back({std::string(assimp_engine), least_triangles});
    }
    if (options.quick) {
        for (const char* spec : quick_generated) choices.push_back({spec, 0});
    } else {
        for (const char* spec : generated) choices.push_back({spec, 0});
    }
    return choices;
}

std::vector<SceneChoice> choose_structure_scenes(const BenchOptions& options) {
    std::vector<SceneChoice> choices;
    for (const std::string& spec : options.scenes) choices.push_back({spec, 0});
    if (!choices.empty()) return choices;
    for (const auto& [path, generated] : structure_scenes) {
        choices.push_back({std::filesystem::is_regular_file(path) ? path : generated, 0});
    }
    return choices;
}

}  // namespace harness
