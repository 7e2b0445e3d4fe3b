// What scenes are made of: generators, the writer, the glTF loader on files that are as they should be.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <set>

#include "suites/gltf_maker.hpp"

using namespace harness;

namespace {

using Indices = std::vector<std::uint32_t>;

/// Bit for bit, NaNs and the sign of zero included.
bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0);
}

bool same_bits(const Scene& a, const Scene& b) {
    if (a.meshes.size() != b.meshes.size()) return false;
    for (std::size_t i = 0; i < a.meshes.size(); ++i) {
        const Mesh &x = a.meshes[i], &y = b.meshes[i];
        if (x.name != y.name || !same_bits(x.positions, y.positions) || x.indices != y.indices) return false;
    }
    return true;
}

bool indices_are_valid(const Mesh& mesh) {
    for (std::uint32_t index : mesh.indices)
        if (index >= mesh.vertex_count()) return false;
    return mesh.indices.size() % 3 == 0 && mesh.positions.size() % 3 == 0;
}

/// Each directed edge stands once, and once the other way round.
bool is_closed(const Mesh& mesh) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        if (!edges.insert({mesh.indices[i], mesh.indices[next]}).second) return false;
    }
    for (const auto& [from, to] : edges)
        if (!edges.contains({to, from})) return false;
    return !edges.empty();
}

/// Six times the volume that a closed mesh encloses: positive when its triangles face outward.
double signed_volume(const Mesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        Vec3d p[3];
        for (std::size_t corner = 0; corner < 3; ++corner)
            for (std::size_t axis = 0; axis < 3; ++axis) p[corner][axis] = mesh.positions[mesh.indices[i + corner] * 3 + axis];
        sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) + p[0][1] * (p[1][2] * p[2][0] - p[1][0] * p[2][2]) +
               p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return sum;
}

/// Positions of the only mesh that `maker`'s file loads as.
std::vector<float> loaded_positions(const GltfMaker& maker) {
    const Scene scene = maker.load();
    REQUIRE(scene.meshes.size() == 1);
    return scene.meshes[0].positions;
}

Indices loaded_indices(const GltfMaker& maker) {
    const Scene scene = maker.load();
    REQUIRE(scene.meshes.size() == 1);
    return scene.meshes[0].indices;
}

std::string load_scene_error(const std::string& spec) {
    try {
        load_scene(spec);
    } catch (const SceneError& error) {
        return error.what();
    }
    return "loaded";
}

}  // namespace

TEST_CASE("generators make about as many triangles as asked, finite and with valid indices") {
    for (const GeneratorInfo& generator : generators()) {
        for (std::size_t asked : {2'000, 20'000}) {
            CAPTURE(generator.name);
            CAPTURE(asked);
            const Scene scene = generate_scene(generator.name, asked);
            CHECK(scene.name == generator.name);
            // The coarsest step is `interior`, which adds whole rooms: 3^2 or 2^2 of them next to 3.4.
            CHECK(double(scene.triangle_count()) == doctest::Approx(double(asked)).epsilon(0.25));
            for (const Mesh& mesh : scene.meshes) {
                CHECK(indices_are_valid(mesh));
                CHECK(std::ranges::all_of(mesh.positions, [](float x) { return std::isfinite(x); }));
            }
        }
    }
}

TEST_CASE("generators make the least scene when asked for one triangle") {
    for (const GeneratorInfo& generator : generators()) {
        CAPTURE(generator.name);
        const Scene scene = generate_scene(generator.name, 1);
        CHECK(scene.triangle_count() >= 1);
        for (const Mesh& mesh : scene.meshes) CHECK(indices_are_valid(mesh));
    }
}

TEST_CASE("generators make the same scene on every call") {
    for (const GeneratorInfo& generator : generators()) {
        CAPTURE(generator.name);
        CHECK(same_bits(generate_scene(generator.name, 3'000), generate_scene(generator.name, 3'000)));
    }
}

TEST_CASE("generators that say closed are closed, and the others are not") {
    for (const GeneratorInfo& generator : generators()) {
        for (std::size_t asked : {1, 5'000}) {
            CAPTURE(generator.name);
            CAPTURE(asked);
            const Scene scene = generate_scene(generator.name, asked);
            CHECK(std::ranges::all_of(scene.meshes, is_closed) == generator.closed);
        }
    }
}

TEST_CASE("generators of one closed surface face outward") {
    for (const char* name : {"icosphere", "uv_sphere", "cube_grid", "torus", "fan_valence", "shells"}) {
        CAPTURE(name);
        for (const Mesh& mesh : generate_scene(name, 5'000).meshes) CHECK(signed_volume(mesh) > 0);
    }
}

TEST_CASE("fan_valence has an apex of the valence asked for") {
    const Scene scene = generate_scene("fan_valence", 200);
    const Indices& indices = scene.meshes[0].indices;
    const auto apex = std::uint32_t(scene.meshes[0].vertex_count() - 1);
    CHECK(std::ranges::count(indices, apex) == 100);
}

TEST_CASE("height_field has whole coordinates") {
    const Scene scene = generate_scene("height_field", 2'000);
    CHECK(std::ranges::all_of(scene.meshes[0].positions, [](float x) { return x == std::floor(x); }));
}

TEST_CASE("load_scene reads gen: specifications and names what is wrong with one") {
    CHECK(same_bits(load_scene("gen:torus:900"), generate_scene("torus", 900)));
    CHECK(load_scene("gen:cube_grid").triangle_count() == 12'288);
    CHECK(load_scene_error("gen:toruss").starts_with("gen:toruss: no such generator; there are soup, needles, "));
    CHECK(load_scene_error("gen:torus:many") == "gen:torus:many: \"many\" is not a number of triangles");
    CHECK(load_scene_error("gen:torus:") == "gen:torus:: \"\" is not a number of triangles");
    CHECK(load_scene_error("gen:torus:900000000000") == "gen:torus: 900000000000 triangles, of at most 100000000");
    CHECK(load_scene_error("bunny.obj") == "bunny.obj: neither a .glb or .gltf file nor gen:NAME[:TRIANGLES]");
    CHECK(load_scene_error("missing.glb") == "missing.glb: no such file");
}

TEST_CASE("load_scene refuses a file without triangles") {
    const TempFolder folder;
    const std::string path = folder.write("empty.gltf", R"({"asset": {"version": "2.0"}})");
    CHECK(load_gltf(path).meshes.empty());
    CHECK(load_scene_error(path) == path + ": no triangles in its default scene");
}

TEST_CASE("bounds cover the finite vertices that a triangle refers to") {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    const Mesh mesh{"", {-1, 0, 0, 2, 3, 0, 0, 0, 5, infinity, 9, 9, 100, 100, 100}, {0, 1, 2, 0, 1, 3}};
    const Bounds bounds = Scene{"", {mesh}}.bounds();
    CHECK(bounds.lower == Vec3d{-1, 0, 0});
    CHECK(bounds.upper == Vec3d{2, 3, 5});
    const Bounds nothing = Scene{}.bounds();
    CHECK(nothing.lower[0] > nothing.upper[0]);
}

TEST_CASE("write_glb and load_gltf return every scene to the bit") {
    const TempFolder folder;
    for (const GeneratorInfo& generator : generators()) {
        CAPTURE(generator.name);
        const Scene scene = generate_scene(generator.name, 1'000);
        const std::string path = folder.file(generator.name + ".glb");
        write_glb(scene, path);
        const Scene loaded = load_gltf(path);
        CHECK(loaded.name == generator.name);
        CHECK(same_bits(loaded, scene));
    }
}

TEST_CASE("write_glb and load_gltf keep NaN, infinities, negative zero and denormals") {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    constexpr float denormal = std::numeric_limits<float>::denorm_min();
    const Scene scene{"odd", {{"odd", {nan, infinity, -infinity, -0.0f, denormal, 1, 3e38f, -3e38f, 0}, {0, 1, 2}}}};
    const TempFolder folder;
    write_glb(scene, folder.file("odd.glb"));
    CHECK(same_bits(load_gltf(folder.file("odd.glb")), scene));
}

TEST_CASE("write_glb refuses a mesh without triangles and a path that cannot be written") {
    const TempFolder folder;
    const Scene empty_mesh{"", {{"", {0, 0, 0}, {}}}};
    CHECK_THROWS_WITH_AS(write_glb(empty_mesh, folder.file("a.glb")), doctest::Contains("mesh 0 has no triangles"), SceneError);
    CHECK_THROWS_WITH_AS(write_glb(generate_scene("torus", 100), folder.file("no/a.glb")), doctest::Contains("cannot be written"),
                         SceneError);
}

TEST_CASE("indices of each width, and none") {
    const Indices expected = {0, 1, 2, 0, 2, 3};
    GltfMaker file;
    file.set_positions(square);
    SUBCASE("u8") { file.set_indices(std::vector<std::uint8_t>(expected.begin(), expected.end()), u8_type); }
    SUBCASE("u16") { file.set_indices(std::vector<std::uint16_t>(expected.begin(), expected.end()), u16_type); }
    SUBCASE("u32") { file.set_indices(expected, u32_type); }
    SUBCASE("none") { file.set_positions({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0}); }
    const Scene scene = file.load();
    REQUIRE(scene.triangle_count() == 2);
    CHECK(scene.triangle(0, 0) == std::array<Vec3f, 3>{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}});
    CHECK(scene.triangle(0, 1) == std::array<Vec3f, 3>{{{0, 0, 0}, {1, 1, 0}, {0, 1, 0}}});
}

TEST_CASE("triangle strips turn every other triangle, fans begin each at the next corner") {
    GltfMaker file;
    file.set_positions({0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0});
    SUBCASE("strip") {
        file.primitive()["mode"] = strip;
        CHECK(loaded_indices(file) == Indices{0, 1, 2, 1, 3, 2, 2, 3, 4});
    }
    SUBCASE("fan") {
        file.primitive()["mode"] = fan;
        CHECK(loaded_indices(file) == Indices{1, 2, 0, 2, 3, 0, 3, 4, 0});
    }
    SUBCASE("indexed strip") {
        file.primitive()["mode"] = strip;
        file.set_indices(std::vector<std::uint8_t>{4, 3, 2, 1}, u8_type);
        CHECK(loaded_indices(file) == Indices{4, 3, 2, 3, 1, 2});
    }
}

TEST_CASE("points and lines are passed over") {
    GltfMaker file = square_file();
    nlohmann::json other = file.primitive();
    for (int mode : {points, lines}) {
        other["mode"] = mode;
        file.root["meshes"][0]["primitives"].insert(file.root["meshes"][0]["primitives"].begin(), other);
    }
    CHECK(loaded_positions(file) == square);
}

TEST_CASE("corners that make no whole triangle are left over") {
    GltfMaker file;
    file.set_positions(square);
    CHECK(loaded_indices(file).size() == 3);
    file.set_indices(std::vector<std::uint8_t>{0, 1}, u8_type);
    CHECK(file.load().meshes.empty());
}

TEST_CASE("interleaved positions are read with their stride") {
    std::vector<float> interleaved;
    for (std::size_t i = 0; i < square.size(); i += 3)
        interleaved.insert(interleaved.end(), {square[i], square[i + 1], square[i + 2], -7, -8});
    GltfMaker file;
    const int view = file.add_view(interleaved);
    file.root["bufferViews"][std::size_t(view)]["byteStride"] = 20;
    file.primitive()["attributes"]["POSITION"] = file.add_accessor(view, float_type, 4, "VEC3");
    CHECK(loaded_positions(file) == square);
    // The last element may end the view: no whole stride behind it.
    file.root["bufferViews"][std::size_t(view)]["byteLength"] = 3 * 20 + 12;
    CHECK(loaded_positions(file) == square);
}

TEST_CASE("odd offsets are read like even ones") {
    GltfMaker file;
    file.binary.push_back('?');
    file.set_positions(square);
    file.primitive()["indices"] =
        file.add_accessor(file.add_view(std::vector<char>{'?', 2, 0, 1, 0, 0, 0}), u16_type, 3, "SCALAR");
    file.root["accessors"][1]["byteOffset"] = 1;
    CHECK(loaded_positions(file) == square);
    CHECK(loaded_indices(file) == Indices{2, 1, 0});
}

TEST_CASE("sparse values replace elements") {
    GltfMaker file;
    file.set_positions(square);
    const int at = file.add_view(std::vector<std::uint16_t>{1, 3}), values = file.add_view(std::vector<float>{9, 8, 7, 6, 5, 4});
    nlohmann::json& accessor = file.root["accessors"][0];
    accessor["sparse"] = {
        {"count", 2}, {"indices", {{"bufferView", at}, {"componentType", u16_type}}}, {"values", {{"bufferView", values}}}};
    CHECK(loaded_positions(file) == std::vector<float>{0, 0, 0, 9, 8, 7, 1, 1, 0, 6, 5, 4});
    accessor.erase("bufferView");  // then all others are zero
    CHECK(loaded_positions(file) == std::vector<float>{0, 0, 0, 9, 8, 7, 0, 0, 0, 6, 5, 4});
}

TEST_CASE("sparse indices are honoured too") {
    GltfMaker file = square_file();
    const int at = file.add_view(std::vector<std::uint8_t>{5}), values = file.add_view(std::vector<std::uint16_t>{1});
    file.root["accessors"][1]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", at}, {"componentType", u8_type}}}, {"values", {{"bufferView", values}}}};
    CHECK(loaded_indices(file) == Indices{0, 1, 2, 0, 2, 1});
}

TEST_CASE("a matrix and the TRS properties it is made of give the same vertices") {
    GltfMaker by_matrix = square_file(), by_properties = square_file();
    // A third of a turn about (1, 1, 1), x to y to z to x, after a scale of 2, 4, 8; then a shift.
    by_properties.node(0)["rotation"] = {0.5, 0.5, 0.5, 0.5};
    by_properties.node(0)["scale"] = {2, 4, 8};
    by_properties.node(0)["translation"] = {10, 20, 30};
    by_matrix.node(0)["matrix"] = {0, 2, 0, 0, 0, 0, 4, 0, 8, 0, 0, 0, 10, 20, 30, 1};
    const std::vector<float> expected = {10, 20, 30, 10, 22, 30, 10, 22, 34, 10, 20, 34};
    CHECK(loaded_positions(by_matrix) == expected);
    CHECK(loaded_positions(by_properties) == expected);
    by_properties.node(0)["rotation"] = {3, 3, 3, 3};  // of any length
    CHECK(loaded_positions(by_properties) == expected);
}

TEST_CASE("nested nodes apply the inner transform first") {
    GltfMaker file = square_file();
    file.root["nodes"] = {{{"children", {1}}, {"scale", {2, 2, 2}}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}};
    CHECK(loaded_positions(file) == std::vector<float>{2, 0, 0, 4, 0, 0, 4, 2, 0, 2, 2, 0});
}

TEST_CASE("transforms are accumulated in double and rounded once") {
    GltfMaker file = square_file();
    // 2^24 + 1 + 1: in floats each sum would fall back to 2^24.
    file.root["nodes"] = {{{"children", {1}}, {"translation", {16777216, 0, 0}}}, {{"mesh", 0}, {"translation", {1, 0, 0}}}};
    CHECK(loaded_positions(file)[3] == 16777218.0f);
}

TEST_CASE("a negative scale mirrors the vertices and leaves the indices") {
    GltfMaker file = square_file();
    file.node(0)["scale"] = {-1, 1, 1};
    CHECK(loaded_positions(file) == std::vector<float>{0, 0, 0, -1, 0, 0, -1, 1, 0, 0, 1, 0});
    CHECK(loaded_indices(file) == Indices{0, 1, 2, 0, 2, 3});
}

TEST_CASE("every instance becomes a mesh, depth first") {
    GltfMaker file = square_file();
    file.root["scenes"][0]["nodes"] = {1, 2};
    // Node 0 has two parents and stands at both places.
    file.root["nodes"] = {{{"mesh", 0}},
                          {{"children", {3, 0}}, {"translation", {10, 0, 0}}},
                          {{"children", {0}}, {"translation", {20, 0, 0}}},
                          {{"mesh", 0}, {"translation", {0, 5, 0}}}};
    const Scene scene = file.load();
    REQUIRE(scene.meshes.size() == 3);
    CHECK(scene.triangle(0, 0)[0] == Vec3f{10, 5, 0});
    CHECK(scene.triangle(1, 0)[0] == Vec3f{10, 0, 0});
    CHECK(scene.triangle(2, 0)[0] == Vec3f{20, 0, 0});
    CHECK(scene.triangle_count() == 6);
}

TEST_CASE("the default scene is the one named, else the first, else all roots") {
    GltfMaker file = square_file();
    file.root["nodes"] = {
        {{"mesh", 0}}, {{"children", {0}}, {"translation", {1, 0, 0}}}, {{"mesh", 0}, {"translation", {2, 0, 0}}}};
    file.root["scenes"] = {{{"nodes", {2}}}, {{"nodes", {1}}}};
    file.root["scene"] = 1;
    CHECK(loaded_positions(file)[0] == 1);
    file.root.erase("scene");
    CHECK(loaded_positions(file)[0] == 2);
    file.root.erase("scenes");
    const Scene scene = file.load();
    REQUIRE(scene.meshes.size() == 2);  // node 0 stands only below node 1
    CHECK(scene.triangle(0, 0)[0][0] == 1);
    CHECK(scene.triangle(1, 0)[0][0] == 2);
}

TEST_CASE("a .gltf file may hold its buffer in a data: URI or beside it") {
    const TempFolder folder;
    GltfMaker file;
    file.set_positions({0, 0, 0, 1, 0, 0, 0, 1, 0});
    SUBCASE("data:") {
        file.root["buffers"] = {
            {{"byteLength", 36},
             {"uri", "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}}};
    }
    SUBCASE("a file with a space in its name") {
        folder.write("the buffer.bin", file.binary);
        file.root["buffers"] = {{{"byteLength", 36}, {"uri", "the%20buffer.bin"}}};
    }
    const Scene scene = load_gltf(folder.write("made.gltf", file.root.dump()));
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].positions == std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0});
}

TEST_CASE("images that are missing or lie outside their buffer do not keep the geometry from loading") {
    GltfMaker file = square_file();
    file.root["images"] = {{{"uri", "missing.png"}}, {{"bufferView", 2}, {"mimeType", "image/png"}}};
    file.root["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 1000000}, {"byteLength", 1000000}});
    CHECK(loaded_positions(file) == square);
}

TEST_CASE("min and max of an accessor are not trusted") {
    GltfMaker file = square_file();
    file.root["accessors"][0]["min"] = {5, 5, 5};
    file.root["accessors"][0]["max"] = {"not", "even", "numbers"};
    CHECK(loaded_positions(file) == square);
}

TEST_CASE("the prepared scenes load with the triangle counts of SCENES.md") {
    struct Expected {
        std::string name;
        std::size_t triangle_count;
    };
    const Expected table[] = {
        {"npm_snowden", 109'259},
        {"npm_teapot", 992},
        {"spot", 5'856},
        {"stanford_bunny", 69'451},
        {"stanford_dragon", 871'414},
        {"spaceship", 257'486},
        {"stk_ravenbridge_mansion", 287'083},
        {"spot_extreme_scales", 52'704},
        {"teapot_in_stadium", 187'642},
        {"smallpine", 1'650},
        {"stk_cocoa_temple", 530'329},
        {"tiles_tree", 2'076},
        {"tracts300_tubes", 142'760},
        {"kicad_dsub62", 94'176},
        {"occt_TR12J_OCC64K", 67'498},
        {"occt_motor", 13'506},
        {"2cylinderengine", 121'496},
        {"ldraw_car", 25'767},
        {"ldraw_eiffel", 135'950},
        {"ldraw_townhall", 1'307'423},
        {"tiles_village", 10'868},
    };
    const std::filesystem::path folder = GNOMON_SHARED_SCENES;
    if (!std::filesystem::is_directory(folder)) {
        MESSAGE("skipped: no folder of scenes at \"" << folder.string() << "\"");
        return;
    }
    std::set<std::string> listed;
    for (const Expected& expected : table) {
        CAPTURE(expected.name);
        listed.insert(expected.name);
        const Scene scene = load_gltf((folder / expected.name).string() + ".glb");
        CHECK(scene.triangle_count() == expected.triangle_count);
        CHECK(std::ranges::all_of(scene.meshes, indices_are_valid));
    }
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".glb") CHECK_MESSAGE(listed.contains(entry.path().stem().string()), entry.path());
}
