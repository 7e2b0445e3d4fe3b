// The list of generators: generators() and generate_scene().
#include <utility>

#include "scene/generators.hpp"
#include "scene/load.hpp"

namespace harness {

namespace {

/// About 5 GB of triangles and vertices of a soup; also keeps every vertex index within 32 bits.
constexpr std::size_t most_triangles = 100'000'000;

struct Generator {
    GeneratorInfo info;
    std::size_t default_triangle_count;
    Scene (*make)(std::size_t triangle_count);
};

const std::vector<Generator> table = {
    {{"soup", "small triangles, uniformly random in a cube", false}, 100'000, make_soup},
    {{"needles", "slivers, 10^-3 to 10^-7 as wide as long", false}, 20'000, make_needles},
    {{"icosphere", "a sphere of nearly equal triangles", true}, 20'480, make_icosphere},
    {{"uv_sphere", "a sphere of longitudes and latitudes, its poles of high valence", true}, 20'000, make_uv_sphere},
    {{"cube_grid", "a cube, each side a grid", true}, 12'288, make_cube_grid},
    {{"torus", "a torus", true}, 20'000, make_torus},
    {{"fan_valence", "a bipyramid: half of all triangles meet at each apex", true}, 2'000, make_fan_valence},
    {{"shells", "eight spheres, one inside the other", true}, 40'000, make_shells},
    {{"height_field", "a grid of whole-number coordinates and heights", false}, 20'000, make_height_field},
    {{"terrain", "hills of fractal noise", false}, 200'000, make_terrain},
    {{"teapot_in_stadium", "a huge coarse bowl, and in it a small dense torus", false}, 100'000, make_teapot_in_stadium},
    {{"interior", "furnished rooms with pillars, inside one closed box", true}, 50'000, make_interior},
    {{"hair", "long thin tubes on a sphere", false}, 200'000, make_hair},
    {{"identical", "one triangle, many times", false}, 1'000, make_identical},
};

std::string known_names() {
    std::string names;
    for (const Generator& generator : table) names += (names.empty() ? "" : ", ") + generator.info.name;
    return names;
}

}  // namespace

const std::vector<GeneratorInfo>& generators() {
    static const std::vector<GeneratorInfo> infos = [] {
        std::vector<GeneratorInfo> list;
        for (const Generator& generator : table) list.push_back(generator.info);
        return list;
    }();
    return infos;
}

Scene generate_scene(const std::string& name, std::size_t triangle_count) {
    if (triangle_count > most_triangles)
        throw SceneError("gen:" + name + ": " + std::to_string(triangle_count) + " triangles, of at most " +
                         std::to_string(most_triangles));
    for (const Generator& generator : table) {
        if (generator.info.name != name) continue;
        Scene scene = generator.make(triangle_count == 0 ? generator.default_triangle_count : triangle_count);
        scene.name = name;
        return scene;
    }
    throw SceneError("gen:" + name + ": no such generator; there are " + known_names());
}

}  // namespace harness
