// Files that are broken, or look so: each is refused in one line, or loads, and then the library says what it makes of it.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "api/handles.hpp"
#include "harness/triangles.hpp"
#include "suites/gltf_maker.hpp"
#include "suites/mutate_glb.hpp"

using namespace harness;

namespace {

/// What becomes of a file.
struct Outcome {
    bool loads;
    std::size_t triangle_count = 0;
    bool rejected =
        false;  // gnomon refuses it by default, for a coordinate that is not finite, and builds it with GNOMON_INVALID_SKIP
};
constexpr Outcome refused{false};
constexpr Outcome loads(std::size_t triangle_count) { return {true, triangle_count}; }
constexpr Outcome loads_but_rejected(std::size_t triangle_count) { return {true, triangle_count, true}; }

struct Case {
    std::string file;
    Outcome outcome;
};

constexpr std::size_t spot_triangles = 5856;

const std::vector<Case> prepared_cases = {
    {"b01_index_eq_vertex_count.glb", refused},
    {"b03_index_u32_max.glb", refused},
    {"b05_inf_one_vertex.glb", loads_but_rejected(spot_triangles)},
    {"b07_huge_coords.glb", loads(spot_triangles)},
    {"b09_all_zero_area.glb", loads(spot_triangles)},
    {"b11_bufferview_past_end.glb", refused},
    {"b13_accessor_count_overflow.glb", refused},
    {"b15_view_offset_misaligned.glb", loads(spot_triangles)},
    {"b17_position_vec2.glb", refused},
    {"b19_index_float.glb", refused},
    {"b21_accessor_ref_oob.glb", refused},
    {"b23_child_ref_oob.glb", refused},
    {"b25_node_self_child.glb", refused},
    {"b27_singular_matrix.glb", loads(spot_triangles)},
    {"b29_inf_matrix.glb", loads_but_rejected(spot_triangles)},
    {"b31_dag_two_parents.glb", loads(2 * spot_triangles)},
    {"b33_tristrip_mode.glb", loads(3 * spot_triangles - 2)},
    {"b35_lying_minmax.glb", loads(spot_triangles)},
    {"b37_no_scene.glb", loads(spot_triangles)},
    {"b39_sparse.glb", loads(spot_triangles)},
    {"b41_u32_valid_nonindexed.glb", loads(2930 / 3)},
    {"b51_truncated_json.glb", refused},
    {"b53_bad_magic.glb", refused},
    {"b55_length_too_big.glb", refused},
    {"b57_json_garbage.glb", refused},
    {"b60_missing_external_bin.gltf", refused},
    {"b62_bad_base64.gltf", refused},
};

const std::vector<Case> assimp_cases = {
    {"BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", loads_but_rejected(12)},
    {"IndexOutOfRange/IndexOutOfRange.gltf", refused},
    {"IndexOutOfRange/AllIndicesOutOfRange.gltf", refused},
    {"MissingBin/BoxTextured.gltf", refused},
    {"RecursiveNodes/RecursiveNodes.gltf", refused},
    {"IncorrectVertexArrays/Cube.gltf", loads(46)},  // leaves over what makes no whole triangle
    {"SchemaFailures/sceneWrongType.gltf", refused},
    {"TestNoRootNode/NoScene.gltf", refused},
    {"TestNoRootNode/SceneWithoutNodes.gltf", loads(0)},
    {"draco/2CylinderEngine.gltf", refused},
    {"wrongTypes/badArray.gltf", refused},
    {"wrongTypes/badString.gltf", refused},
    // The wrong type stands in a material, a texture or a sampler: no part of the geometry.
    {"wrongTypes/badExtension.gltf", loads(12)},
    {"wrongTypes/badNumber.gltf", loads(12)},
    {"wrongTypes/badObject.gltf", loads(12)},
    {"wrongTypes/badUint.gltf", loads(12)},
};

/// Null when the library refuses, with its status in `status`.
SceneHandle build(const Scene& scene, std::uint32_t invalid_triangles, GnomonStatus& status) {
    const BuilderHandle builder = new_builder();
    for (const Mesh& mesh : scene.meshes) {
        const GnomonTriangles triangles = triangles_of(mesh);
        std::uint32_t geometry_id;
        status = gnomon_scene_builder_add_triangles(builder.get(), &triangles, &geometry_id);
        if (status != GNOMON_OK) return nullptr;
    }
    GnomonBuildOptions options;
    gnomon_build_options_init(&options);
    options.structure = GNOMON_STRUCTURE_WIDE_BVH;
    options.invalid_triangles = invalid_triangles;
    GnomonScene* built = nullptr;
    status = gnomon_scene_build(builder.get(), &options, &built);
    return SceneHandle(built);
}

bool has_nan(const GnomonHit& hit) {
    return std::isnan(hit.t) || std::isnan(hit.u) || std::isnan(hit.v) ||
           std::any_of(std::begin(hit.normal), std::end(hit.normal), [](float x) { return std::isnan(x); });
}

/// Towards the middles of some triangles, from each side of the axes; a middle that is not finite makes an invalid ray, which
/// must miss.
std::vector<GnomonRay> rays_at(const Scene& scene) {
    std::vector<GnomonRay> rays;
    for (std::uint32_t geometry_id = 0; geometry_id < scene.meshes.size(); ++geometry_id) {
        const std::size_t triangle_count = scene.meshes[geometry_id].triangle_count(), step = triangle_count / 16 + 1;
        for (std::size_t i = 0; i < triangle_count; i += step) {
            const auto p = scene.triangle(geometry_id, std::uint32_t(i));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                for (float sign : {-1.0f, 1.0f}) {
                    GnomonRay ray{{}, 0, {}, std::numeric_limits<float>::infinity()};
                    for (std::size_t k = 0; k < 3; ++k) ray.origin[k] = p[0][k] / 3 + p[1][k] / 3 + p[2][k] / 3;
                    ray.origin[axis] -= 10 * sign;
                    ray.direction[axis] = sign;
                    rays.push_back(ray);
                }
            }
        }
    }
    return rays;
}

/// Traces rays at the scene; no part of an answer may be NaN, and both queries agree.
void check_queries(const GnomonScene* built, const Scene& scene) {
    for (const GnomonRay& ray : rays_at(scene)) {
        GnomonHit hit;
        const bool found = gnomon_intersect(built, &ray, &hit);
        const bool consistent = found == gnomon_occluded(built, &ray) && found == (hit.geometry_id != GNOMON_INVALID_ID);
        CAPTURE(ray.origin[0]);
        CAPTURE(ray.origin[1]);
        CAPTURE(ray.origin[2]);
        CHECK_FALSE(has_nan(hit));
        CHECK(consistent);
    }
}

void check_library(const Scene& scene, bool rejected) {
    GnomonStatus status = GNOMON_OK;
    const SceneHandle strict = build(scene, GNOMON_INVALID_REJECT, status);
    if (rejected) {
        CHECK(status == GNOMON_ERROR_INVALID_ARGUMENT);
        CHECK(std::string(gnomon_last_error()).find("triangle") != std::string::npos);
    } else {
        REQUIRE_MESSAGE(status == GNOMON_OK, gnomon_last_error());
        check_queries(strict.get(), scene);
    }
    const SceneHandle skipping = build(scene, GNOMON_INVALID_SKIP, status);
    REQUIRE_MESSAGE(status == GNOMON_OK, gnomon_last_error());
    GnomonSceneStats stats;
    REQUIRE(gnomon_scene_stats(skipping.get(), sizeof stats, &stats) == GNOMON_OK);
    CHECK((stats.skipped_count > 0) == rejected);
    CHECK(stats.triangle_count + stats.skipped_count == scene.triangle_count());
    check_queries(skipping.get(), scene);
}

/// One line that begins with the file.
bool is_clear(const std::string& message, const std::string& path) {
    return message.starts_with(path + ": ") && message.size() > path.size() + 2 && message.find('\n') == std::string::npos;
}

void check_case(const std::filesystem::path& folder, const Case& expected) {
    CAPTURE(expected.file);
    const std::string path = (folder / expected.file).string();
    Scene scene;
    try {
        scene = load_gltf(path);
    } catch (const SceneError& error) {
        CHECK_MESSAGE(!expected.outcome.loads, error.what());
        CHECK_MESSAGE(is_clear(error.what(), path), error.what());
        return;
    }
    REQUIRE(expected.outcome.loads);
    CHECK(scene.triangle_count() == expected.outcome.triangle_count);
    check_library(scene, expected.outcome.rejected);
}

std::string read_file(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// Whether it loads; fails the test when a refusal is not clear or what loads is not sound.
bool loads_soundly(const std::string& path) {
    try {
        const Scene scene = load_gltf(path);
        for (const Mesh& mesh : scene.meshes)
            CHECK(std::ranges::all_of(mesh.indices, [&](std::uint32_t index) { return index < mesh.vertex_count(); }));
        return true;
    } catch (const SceneError& error) {
        CHECK_MESSAGE(is_clear(error.what(), path), error.what());
        return false;
    }
}

/// Every feature that the loader reads: strips, sparse values, strides, nested nodes.
GltfMaker rich_file() {
    GltfMaker maker = square_file();
    const int at = maker.add_view(std::vector<std::uint16_t>{2}), values = maker.add_view(std::vector<float>{1, 2, 3});
    maker.root["accessors"][0]["sparse"] = {
        {"count", 1}, {"indices", {{"bufferView", at}, {"componentType", u16_type}}}, {"values", {{"bufferView", values}}}};
    maker.root["bufferViews"][0]["byteStride"] = 12;
    maker.root["meshes"][0]["primitives"].push_back({{"attributes", {{"POSITION", 0}}}, {"mode", strip}});
    maker.root["nodes"] = {{{"children", {1, 2}}, {"scale", {2, 2, 2}}, {"translation", {1, 0, 0}}, {"rotation", {0, 0, 0, 1}}},
                           {{"mesh", 0}},
                           {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}}};
    return maker;
}

/// The most memory that this process has held, in bytes.
std::size_t peak_bytes() {
    rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return std::size_t(usage.ru_maxrss) * 1024;
}

}  // namespace

TEST_CASE("prepared broken files load or are refused as the table says") {
    const std::filesystem::path folder = std::filesystem::path(GNOMON_SHARED_SCENES) / "broken";
    if (!std::filesystem::is_directory(folder)) {
        MESSAGE("skipped: no folder of broken scenes at \"" << folder.string() << "\"");
        return;
    }
    for (const Case& expected : prepared_cases) check_case(folder, expected);
    for (const auto& entry : nlohmann::json::parse(read_file(folder / "MANIFEST.json"))) {
        const std::string file = entry.at("file");
        const bool listed = std::ranges::any_of(prepared_cases, [&](const Case& known) { return known.file == file; });
        CHECK_MESSAGE(listed, file << " is in the manifest and not in the table");
    }
}

TEST_CASE("assimp's broken files load or are refused as the table says") {
    const std::filesystem::path folder = GNOMON_ASSIMP_MODELS;
    if (!std::filesystem::is_directory(folder)) {
        MESSAGE("skipped: no assimp models at \"" << folder.string() << "\"");
        return;
    }
    for (const Case& expected : assimp_cases) check_case(folder, expected);
}

TEST_CASE("a coordinate that is not finite loads and is the library's to refuse") {
    for (float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        GltfMaker file;
        std::vector<float> positions = square;
        positions[11] = bad;  // in the second triangle alone
        file.set_positions(positions);
        file.set_indices(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, u8_type);
        check_library(file.load(), true);
    }
}

TEST_CASE("references, ranges and types are refused by name") {
    GltfMaker file = square_file();
    auto& root = file.root;
    std::string expected;
    SUBCASE("no POSITION") {
        file.primitive()["attributes"] = {{"NORMAL", 0}};
        expected = "mesh 0 primitive 0: no POSITION";
    }
    SUBCASE("index") {
        file.set_indices(std::vector<std::uint16_t>{0, 1, 4}, u16_type);
        expected = "mesh 0 primitive 0: index 4 at position 2 is out of range: 4 vertices";
    }
    SUBCASE("mesh") {
        file.node(0)["mesh"] = 1;
        expected = "node 0: mesh 1 does not exist: 1 meshes";
    }
    SUBCASE("root node") {
        root["scenes"][0]["nodes"] = {7};
        expected = "scene 0: node 7 does not exist: 1 nodes";
    }
    SUBCASE("accessor past its view") {
        root["accessors"][0]["count"] = 5;
        expected = "mesh 0 primitive 0: accessor 0: 5 elements from byte 0 on pass the end of bufferView 0, which has 48 bytes";
    }
    SUBCASE("accessor offset past its view") {
        root["accessors"][0]["byteOffset"] = 49;
        expected = "mesh 0 primitive 0: accessor 0: 4 elements from byte 49 on pass the end of bufferView 0, which has 48 bytes";
    }
    SUBCASE("view of no buffer") {
        root["bufferViews"][0]["buffer"] = 1;
        expected = "mesh 0 primitive 0: accessor 0: bufferView 0: buffer 1 does not exist";
    }
    SUBCASE("stride within the element") {
        root["bufferViews"][0]["byteStride"] = 8;
        expected = "mesh 0 primitive 0: accessor 0: byteStride 8 is less than the element's 12 bytes";
    }
    SUBCASE("positions of integers") {
        root["accessors"][0]["componentType"] = u16_type;
        expected = "mesh 0 primitive 0: accessor 0: POSITION is not VEC3 of FLOAT (componentType 5126)";
    }
    SUBCASE("signed indices") {
        root["accessors"][1]["componentType"] = byte_type;
        expected =
            "mesh 0 primitive 0: accessor 1: componentType 5120 is not an index type: UNSIGNED_BYTE, _SHORT or _INT (5121, 5123, "
            "5125)";
    }
    SUBCASE("indices of vectors") {
        root["accessors"][1]["type"] = "VEC3";
        expected = "mesh 0 primitive 0: accessor 1: indices are not SCALAR";
    }
    SUBCASE("positions without data") {
        root["accessors"][0].erase("bufferView");
        expected = "mesh 0 primitive 0: accessor 0: no bufferView and not sparse";
    }
    SUBCASE("mode") {
        file.primitive()["mode"] = 7;
        expected = "mesh 0 primitive 0: mode 7 does not exist";
    }
    SUBCASE("mesh without primitives") {
        root["meshes"][0].erase("primitives");
        expected = "mesh 0 has no primitives";
    }
    SUBCASE("id beyond 32 bits") {
        file.node(0)["mesh"] = 4294967296;
        expected = "nodes[0].mesh is not a whole number from 0 to 2^31 - 1";
    }
    SUBCASE("children that are no list") {
        file.node(0)["children"] = 1;
        expected = "nodes[0].children is not an array of whole numbers from 0 to 2^31 - 1";
    }
    SUBCASE("draco") {
        file.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
        expected = "meshes[0].primitives[0].extensions: KHR_draco_mesh_compression is not supported";
    }
    SUBCASE("meshopt") {
        root["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0}};
        expected = "bufferViews[0].extensions: EXT_meshopt_compression is not supported";
    }
    SUBCASE("version") {
        root["asset"]["version"] = "1.0";
        expected = "glTF version 1.0, not 2";
    }
    CHECK(file.error() == expected);
}

TEST_CASE("a chunk that passes the end of its file is refused") {
    // The header agrees with the file; the BIN chunk claims four bytes more.
    std::string file = square_file().glb();
    file.resize(file.size() - 4);
    const auto length = std::uint32_t(file.size());
    std::memcpy(&file[8], &length, sizeof length);
    const TempFolder folder;
    CHECK_THROWS_WITH_AS(load_gltf(folder.write("short.glb", file)),
                         doctest::Contains("truncated: a chunk of 60 bytes, of which only 56 are there"), SceneError);
}

TEST_CASE("transforms that are no affine maps are refused by node") {
    GltfMaker file = square_file();
    std::string expected;
    SUBCASE("projective") {
        file.node(0)["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        expected = "node 0: matrix is not affine: its last row is not 0 0 0 1";
    }
    SUBCASE("short matrix") {
        file.node(0)["matrix"] = {1, 0, 0};
        expected = "node 0: matrix has 3 numbers, not 16";
    }
    SUBCASE("short scale") {
        file.node(0)["scale"] = {1, 1};
        expected = "node 0: scale has 2 numbers, not 3";
    }
    SUBCASE("no rotation") {
        file.node(0)["rotation"] = {0, 0, 0, 0};
        expected = "node 0: rotation has length 0";
    }
    SUBCASE("overflow") {
        file.root["nodes"] = {{{"children", {1}}, {"scale", {1e200, 1, 1}}}, {{"mesh", 0}, {"scale", {1e200, 1, 1}}}};
        expected = "node 1: the product of the matrices down to it is not finite";
    }
    CHECK(file.error() == expected);
}

TEST_CASE("node graphs that would not end are refused") {
    GltfMaker file = square_file();
    nlohmann::json& nodes = file.root["nodes"] = nlohmann::json::array();
    std::string expected;
    SUBCASE("cycle of two") {
        nodes = {{{"children", {1}}}, {{"children", {0}}}};
        expected = "node 0: it is its own descendant";
    }
    SUBCASE("cycle without a scene") {
        nodes = {{{"children", {1}}}, {{"children", {0}}}};
        file.root.erase("scenes");
        file.root.erase("scene");
        expected = "no scene, and every node is another's child";
    }
    SUBCASE("chain") {
        for (int i = 1; i <= 2000; ++i) nodes.push_back({{"children", {i}}});
        nodes.push_back({{"mesh", 0}});
        expected = "node 1000: deeper than 1000 levels";
    }
    SUBCASE("doubling") {
        for (int i = 1; i <= 60; ++i) nodes.push_back({{"children", {i, i}}});
        nodes.push_back({{"mesh", 0}});
        expected = "node 60: more than 1048576 node instances";
    }
    CHECK(file.error() == expected);
}

TEST_CASE("files that ask for much memory are refused before it is used") {
    GltfMaker file = square_file();
    std::string expected;
    const std::size_t before = peak_bytes();
    SUBCASE("instances of instances") {
        // 10^4 primitives of 2^18 triangles each: 2.6 * 10^9 in a file of 2 MB.
        file.set_indices(std::vector<std::uint8_t>(3 << 18), u8_type);
        const nlohmann::json primitive = file.primitive();
        for (int i = 1; i < 10'000; ++i) file.root["meshes"][0]["primitives"].push_back(primitive);
        expected = "more than 2^31 triangles or vertices at node 0";
    }
    SUBCASE("zeros") {
        const int at = file.add_view(std::vector<std::uint32_t>{0});
        file.root["accessors"][0] = {
            {"count", 2147483647},
            {"componentType", float_type},
            {"type", "VEC3"},
            {"sparse",
             {{"count", 1}, {"indices", {{"bufferView", at}, {"componentType", u32_type}}}, {"values", {{"bufferView", 0}}}}}};
        expected = "mesh 0 primitive 0: accessor 0: sparse without a bufferView: 2147483647 elements, of at most 16777216";
    }
    SUBCASE("nesting") {
        nlohmann::json nested = 1;
        for (int i = 0; i < 500; ++i) nested = nlohmann::json::array({nested});
        file.node(0)["extensions"]["X"] = nested;
        expected = "JSON nested deeper than 64";
    }
    CHECK(file.error() == expected);
    CHECK(peak_bytes() - before < std::size_t(256) << 20);
}

TEST_CASE("mutated files load or are refused") {
    const TempFolder folder;
    write_glb(generate_scene("shells", 160), folder.file("shells.glb"));
    const std::string bases[] = {read_file(folder.file("shells.glb")), rich_file().glb()};
    const std::size_t before = peak_bytes();
    std::size_t loaded_count = 0, refused_count = 0;
    for (const std::string& base : bases) {
        REQUIRE(loads_soundly(folder.write("base.glb", base)));
        for (std::uint64_t seed = 0; seed < 2'000; ++seed) {
            CAPTURE(seed);
            const std::string path = folder.write("mutated.glb", mutate_glb(base, seed));
            ++(loads_soundly(path) ? loaded_count : refused_count);
        }
    }
    // Some mutations touch a name or a coordinate and load; most do not.
    CHECK(loaded_count > 100);
    CHECK(refused_count > 1'000);
    CHECK(peak_bytes() - before < std::size_t(256) << 20);
}
