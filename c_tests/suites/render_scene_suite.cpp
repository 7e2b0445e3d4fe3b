// What gnomon-render takes from a glTF file, and what it refuses.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "rays/vector.hpp"
#include "render/camera.hpp"
#include "render/generate.hpp"
#include "render/load.hpp"
#include "render/png.hpp"
#include "suites/gltf_maker.hpp"
#include "suites/mutate_glb.hpp"

using namespace render;
using harness::operator-;
using harness::GltfMaker;
using harness::SceneError;
using harness::TempFolder;
using nlohmann::json;
using Remarks = std::vector<std::string>;

namespace {

constexpr double pi = std::numbers::pi;

struct Loaded {
    RenderScene scene;
    Remarks remarks;  // without the file's name
};

Loaded load(const GltfMaker& maker, const TempFolder& folder = {}) {
    const std::string path = folder.write("made.glb", maker.glb());
    Loaded result;
    result.scene = load_render_scene(path, result.remarks);
    for (std::string& remark : result.remarks) {
        REQUIRE(remark.starts_with(path + ": "));
        remark = remark.substr(path.size() + 2);
    }
    return result;
}

/// What the loader says, without the file's name; "loaded" when it does not mind.
std::string error_of(const GltfMaker& maker) {
    const TempFolder folder;
    const std::string path = folder.write("made.glb", maker.glb());
    try {
        Remarks remarks;
        load_render_scene(path, remarks);
    } catch (const SceneError& error) {
        const std::string message = error.what();
        return message.starts_with(path + ": ") ? message.substr(path.size() + 2) : "without the file's name: " + message;
    }
    return "loaded";
}

/// A square with a material and texture coordinates, three lamps and two cameras, each at a node of its own.
GltfMaker lit_file() {
    GltfMaker maker = harness::square_file();
    maker.primitive()["attributes"]["TEXCOORD_0"] =
        maker.add_accessor(maker.add_view(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}), harness::float_type, 4, "VEC2");
    maker.primitive()["material"] = 0;
    maker.root["materials"] =
        json::parse(R"([{"name": "paint", "pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 0.75, 1]}}])");
    maker.root["cameras"] = json::parse(R"([
        {"name": "wide", "type": "perspective", "perspective": {"yfov": 1, "aspectRatio": 2, "znear": 0.1}},
        {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0.1, "zfar": 9}}])");
    maker.root["extensions"]["KHR_lights_punctual"]["lights"] = json::parse(R"([
        {"type": "point", "intensity": 40, "color": [1, 0.5, 0.25], "range": 7},
        {"type": "spot", "intensity": 9, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "directional", "intensity": 1000}])");
    maker.root["nodes"] = json::parse(R"([{"mesh": 0},
        {"camera": 0, "name": "front", "translation": [0, 0, 5]}, {"camera": 1},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [1, 2, 3]},
        {"extensions": {"KHR_lights_punctual": {"light": 1}}},
        {"extensions": {"KHR_lights_punctual": {"light": 2}}}])");
    maker.root["scenes"] = json::parse(R"([{"nodes": [0, 1, 2, 3, 4, 5]}])");
    return maker;
}

/// Two texels, black and a grey of `byte`, in a row.
std::string png_bytes(const TempFolder& folder, std::uint8_t byte) {
    const std::string path = folder.file("written.png");
    write_png({2, 1, {{0, 0, 0}, {byte, byte, byte}}}, path);
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The lit file with a texture whose image is `png`.
GltfMaker textured_file(const std::string& png) {
    GltfMaker maker = lit_file();
    maker.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 0;
    maker.root["textures"] = json::parse(R"([{"source": 0}])");
    maker.root["images"] = {
        {{"bufferView", maker.add_view(std::vector<char>(png.begin(), png.end()))}, {"mimeType", "image/png"}}};
    return maker;
}

/// `maker` with one value of its JSON replaced or added.
GltfMaker with(GltfMaker maker, const std::string& pointer, const std::string& value) {
    maker.root[json::json_pointer(pointer)] = json::parse(value);
    return maker;
}

bool is_near(const Vec3d& a, const Vec3d& b) { return harness::length(a - b) <= 1e-15 * std::max(1.0, harness::length(b)); }
bool is_near(const Vec3f& a, const Vec3d& b) {
    return harness::length(harness::to_double(a) - b) <= 0x1p-23 * std::max(1.0, harness::length(b));
}

/// The refusal is one line that begins with the file.
bool loads_soundly(const std::string& path) {
    try {
        Remarks remarks;
        const RenderScene scene = load_render_scene(path, remarks);
        for (const Surface& surface : scene.surfaces) {
            CHECK(surface.material_id < scene.materials.size());
            CHECK((surface.uvs.empty() || surface.uvs.size() / 2 == surface.mesh.vertex_count()));
        }
        for (const Material& material : scene.materials) {
            CHECK(material.base_color_texture < int(scene.textures.size()));
            CHECK(std::isfinite(material.emission_nt[0]));
            CHECK(material.base_color[0] <= 1);
        }
        for (const Texture& texture : scene.textures)
            CHECK(texture.texels.size() == std::size_t(texture.width) * std::size_t(texture.height));
        for (const SpotLight& light : scene.spot_lights) CHECK(light.inner_cone_rad < light.outer_cone_rad);
        CHECK(!scene.cameras.empty());
        for (const std::string& remark : remarks) CHECK(remark.find('\n') == std::string::npos);
        return true;
    } catch (const SceneError& error) {
        const std::string message = error.what();
        CHECK_MESSAGE(message.starts_with(path + ": "), message);
        CHECK_MESSAGE(message.find('\n') == std::string::npos, message);
        return false;
    }
}

}  // namespace

TEST_CASE("a file's cameras stand where their nodes put them") {
    const auto [scene, remarks] = load(lit_file());
    CHECK(remarks.empty());
    REQUIRE(scene.cameras.size() == 2);
    const Camera& wide = scene.cameras[0];
    CHECK(wide.name == "front");
    CHECK(wide.position == Vec3d{0, 0, 5});
    CHECK(wide.forward == Vec3d{0, 0, -1});
    CHECK(wide.up == Vec3d{0, 1, 0});
    CHECK(wide.right == Vec3d{1, 0, 0});
    CHECK(wide.half_height == std::tan(0.5));
    CHECK(wide.half_width == 2 * std::tan(0.5));
    CHECK_FALSE(wide.is_orthographic);
    CHECK(scene.cameras[1].is_orthographic);
    CHECK(scene.cameras[1].half_width == 3);
    CHECK(scene.cameras[1].half_height == 2);
    const auto unnamed = load(with(lit_file(), "/nodes/1", R"({"camera": 0})"));
    CHECK(unnamed.scene.cameras[0].name == "wide");
}

TEST_CASE("neither scales nor mirrors change what a camera or a lamp looks at") {
    // A quarter turn about y takes -z to -x.
    const std::string turned = R"("rotation": [0, 0.7071067811865476, 0, 0.7071067811865476])";
    for (const char* scale : {"[1, 1, 1]", "[1e-3, 5, 200]", "[-2, 1, 1]", "[1e-30, 1e-30, 1e-30]"}) {
        CAPTURE(scale);
        const std::string node = "{" + turned + R"(, "translation": [4, 5, 6], "scale": )" + scale;
        const GltfMaker camera = with(lit_file(), "/nodes/1", node + R"(, "camera": 0})");
        const auto [scene, remarks] =
            load(with(camera, "/nodes/4", node + R"(, "extensions": {"KHR_lights_punctual": {"light": 1}}})"));
        CHECK(is_near(scene.cameras[0].position, Vec3d{4, 5, 6}));
        CHECK(is_near(scene.cameras[0].forward, Vec3d{-1, 0, 0}));
        CHECK(is_near(scene.cameras[0].up, Vec3d{0, 1, 0}));
        CHECK(is_near(scene.cameras[0].right, Vec3d{0, 0, -1}));
        CHECK(scene.cameras[0].half_height == std::tan(0.5));
        CHECK(is_near(scene.spot_lights[0].direction, Vec3d{-1, 0, 0}));
        CHECK(scene.spot_lights[0].intensity_cd == Rgb{9, 9, 9});
    }
}

TEST_CASE("lamps have their units, colours, ranges and cones") {
    const auto [scene, remarks] = load(lit_file());
    REQUIRE(scene.point_lights.size() == 1);
    CHECK(scene.point_lights[0].position == Vec3f{1, 2, 3});
    CHECK(scene.point_lights[0].intensity_cd == Rgb{40, 20, 10});
    CHECK(scene.point_lights[0].range_m == 7);
    REQUIRE(scene.spot_lights.size() == 1);
    CHECK(scene.spot_lights[0].inner_cone_rad == 0.25F);
    CHECK(scene.spot_lights[0].outer_cone_rad == 0.5F);
    CHECK(scene.spot_lights[0].direction == Vec3f{0, 0, -1});
    CHECK(std::isinf(scene.spot_lights[0].range_m));
    REQUIRE(scene.directional_lights.size() == 1);
    CHECK(scene.directional_lights[0].illuminance_lx == Rgb{1000, 1000, 1000});
    CHECK(scene.directional_lights[0].direction == Vec3f{0, 0, -1});
    CHECK(scene.environment_nt == Rgb{0, 0, 0});
}

TEST_CASE("a lamp that says nothing but its type has the extension's defaults") {
    const auto [scene, remarks] = load(with(lit_file(), "/extensions/KHR_lights_punctual/lights/1", R"({"type": "spot"})"));
    CHECK(scene.spot_lights[0].intensity_cd == Rgb{1, 1, 1});
    CHECK(std::isinf(scene.spot_lights[0].range_m));
    CHECK(scene.spot_lights[0].inner_cone_rad == 0);
    CHECK(scene.spot_lights[0].outer_cone_rad == float(pi / 4));
}

TEST_CASE("a cone as wide as a half-space, written as a float, is one") {
    CHECK(error_of(with(lit_file(), "/extensions/KHR_lights_punctual/lights/1/spot/outerConeAngle", "1.57079637")) == "loaded");
}

TEST_CASE("a lamp at two nodes is two, one at none is left out with a remark, and so is a camera") {
    GltfMaker maker = lit_file();
    maker.root["nodes"][4]["extensions"]["KHR_lights_punctual"]["light"] = 0;
    maker.root["nodes"][2].erase("camera");
    const auto [scene, remarks] = load(maker);
    CHECK(scene.point_lights.size() == 2);
    CHECK(scene.spot_lights.empty());
    CHECK(remarks == Remarks{"cameras[1] is at no node of the scene: it is left out",
                             "extensions.KHR_lights_punctual.lights[1] is at no node of the scene: it is left out"});
}

TEST_CASE("factors decide between diffuse, mirror and glass") {
    const auto kind_of = [](const std::string& material) {
        return load(with(lit_file(), "/materials/0", material)).scene.materials[0].kind;
    };
    CHECK(kind_of("{}") == MaterialKind::diffuse);  // metallic 1 and roughness 1
    CHECK(kind_of(R"({"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0}})") == MaterialKind::diffuse);
    CHECK(kind_of(R"({"pbrMetallicRoughness": {"roughnessFactor": 0.5}})") == MaterialKind::diffuse);
    CHECK(kind_of(R"({"pbrMetallicRoughness": {"roughnessFactor": 0.49}})") == MaterialKind::mirror);
    CHECK(kind_of(R"({"pbrMetallicRoughness": {"metallicFactor": 0.5, "roughnessFactor": 0}})") == MaterialKind::mirror);
    CHECK(kind_of(R"({"extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.5}}})") == MaterialKind::glass);
    CHECK(kind_of(R"({"extensions": {"KHR_materials_transmission": {}}})") == MaterialKind::diffuse);
}

TEST_CASE("a material has its colour, index of refraction, emission and sides") {
    const auto [plain, no_remarks] = load(lit_file());
    CHECK(plain.materials[0].name == "paint");
    CHECK(plain.materials[0].base_color == Rgb{0.25F, 0.5F, 0.75F});
    CHECK(plain.materials[0].index_of_refraction == 1.5F);
    CHECK(plain.materials[0].emission_nt == Rgb{0, 0, 0});
    CHECK_FALSE(plain.materials[0].is_double_sided);
    const auto [scene, remarks] =
        load(with(lit_file(), "/materials/0", R"({"emissiveFactor": [1, 0.5, 0], "doubleSided": true, "extensions": {
        "KHR_materials_emissive_strength": {"emissiveStrength": 2000}, "KHR_materials_ior": {"ior": 2.4}}})"));
    CHECK(scene.materials[0].emission_nt == Rgb{2000, 1000, 0});
    CHECK(scene.materials[0].index_of_refraction == 2.4F);
    CHECK(scene.materials[0].is_double_sided);
    CHECK(load(with(lit_file(), "/materials/0", R"({"emissiveFactor": [1, 1, 1]})")).scene.materials[0].emission_nt ==
          Rgb{1, 1, 1});
}

TEST_CASE("no surface reflects more than all") {
    const auto [scene, remarks] = load(with(lit_file(), "/materials/0/pbrMetallicRoughness/baseColorFactor", "[0.5, 1.5, 1, 1]"));
    CHECK(scene.materials[0].base_color == Rgb{0.5F, 1, 1});
    CHECK(remarks ==
          Remarks{"materials[0].pbrMetallicRoughness.baseColorFactor is above 1, which no surface reflects: taken as 1"});
}

TEST_CASE("primitives without a material share one that is grey") {
    GltfMaker maker = lit_file();
    maker.root["meshes"][0]["primitives"].push_back(maker.primitive());
    maker.root["meshes"][0]["primitives"].push_back(maker.primitive());
    for (std::size_t i : {0, 2}) maker.root["meshes"][0]["primitives"][i].erase("material");
    const auto [scene, remarks] = load(maker);
    REQUIRE(scene.surfaces.size() == 3);
    REQUIRE(scene.materials.size() == 2);
    CHECK(scene.surfaces[0].material_id == 1);
    CHECK(scene.surfaces[1].material_id == 0);
    CHECK(scene.surfaces[2].material_id == 1);
    CHECK(scene.materials[1].base_color == Rgb{0.5F, 0.5F, 0.5F});
}

TEST_CASE("a mirroring node keeps the front in front") {
    const auto front = [](const std::string& scale) {
        const auto [scene, remarks] = load(with(lit_file(), "/nodes/0/scale", scale));
        const harness::Scene geometry{"", {scene.surfaces[0].mesh}};
        const auto [a, b, c] = geometry.triangle(0, 0);
        const Vec3d p = harness::to_double(a), q = harness::to_double(b), r = harness::to_double(c);
        return harness::cross(q - p, r - p)[2];
    };
    CHECK(front("[1, 1, 1]") == 1);
    CHECK(front("[-1, 1, 1]") == 1);
    CHECK(front("[-1, -1, 1]") == 1);
    CHECK(front("[1, 1, -1]") == -1);  // seen from z, the mirror image's back
}

TEST_CASE("a texture is linear, wraps as its sampler says, and comes with coordinates") {
    const TempFolder folder;
    const std::string png = png_bytes(folder, 188);
    const auto [scene, remarks] = load(textured_file(png));
    CHECK(remarks.empty());
    CHECK(scene.materials[0].base_color_texture == 0);
    CHECK(scene.surfaces[0].uvs == std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0});
    REQUIRE(scene.textures.size() == 1);
    const Texture& texture = scene.textures[0];
    CHECK(texture.width == 2);
    CHECK(texture.height == 1);
    CHECK(texture.texels[0] == Rgb{0, 0, 0});
    CHECK(texture.texels[1][0] == doctest::Approx(0.5029).epsilon(1e-4));  // ((188 / 255 + 0.055) / 1.055)^2.4
    CHECK(texture.repeats_u);
    CHECK(texture.repeats_v);

    GltfMaker wrapped = textured_file(png);
    wrapped.root["textures"][0]["sampler"] = 0;
    wrapped.root["samplers"] = json::parse(R"([{"wrapS": 33071, "wrapT": 33648}])");
    const Texture clamped = load(wrapped).scene.textures[0];
    CHECK_FALSE(clamped.repeats_u);
    CHECK(clamped.repeats_v);
    CHECK(clamped.height == 2);  // itself and its mirror image
    wrapped.root["samplers"] = json::parse(R"([{"wrapS": 33648}])");
    const Texture mirrored = load(wrapped).scene.textures[0];
    CHECK(mirrored.width == 4);
    CHECK(mirrored.height == 1);
    CHECK(mirrored.texels[3] == mirrored.texels[0]);
    CHECK(mirrored.texels[2] == mirrored.texels[1]);
}

TEST_CASE("images may be embedded in the JSON or lie beside the file") {
    const TempFolder folder;
    GltfMaker maker = textured_file("");
    folder.write("a b.png", png_bytes(folder, 255));
    maker.root["images"][0] = {{"uri", "a%20b.png"}};
    CHECK(load(maker, folder).scene.textures[0].texels[1] == Rgb{1, 1, 1});
    // One white pixel.
    maker.root["images"][0] = {
        {"uri",
         "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGP4DwABAQEAG7buVgAAAABJRU5ErkJggg=="}};
    const auto [scene, remarks] = load(maker);
    CHECK(remarks.empty());
    REQUIRE(scene.textures.size() == 1);
    CHECK(scene.textures[0].texels == std::vector<Rgb>{{1, 1, 1}});
}

TEST_CASE("a texture that cannot be had is left out with a remark, and its factor stays") {
    const TempFolder folder;
    GltfMaker maker = textured_file(png_bytes(folder, 255));
    std::string expected;
    SUBCASE("no such file") {
        maker.root["images"][0] = {{"uri", "wood.png"}};
        expected = "images[0] (wood.png): no such file: the texture is left out";
    }
    SUBCASE("no image") {
        maker = textured_file("GIF89a");
        expected = "images[0]: neither PNG nor JPEG that can be decoded: unknown image type: the texture is left out";
    }
    SUBCASE("no base64") {
        maker.root["images"][0] = {{"uri", "data:image/png;base64,"}};
        expected = "images[0]: a data URI that cannot be decoded: the texture is left out";
    }
    SUBCASE("view past its buffer") {
        maker.root["bufferViews"].back()["byteLength"] = 100'000;
        expected = "images[0]: bufferView 3: 100000 bytes from 92 on pass the end of buffer 0, which has ";
    }
    SUBCASE("a format of another extension") {
        maker.root["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
        expected = "textures[0] has no source that is known here: it is left out";
    }
    const auto [scene, remarks] = load(maker);
    REQUIRE(remarks.size() == 1);
    CHECK_MESSAGE(remarks[0].starts_with(expected), remarks[0]);
    CHECK(scene.materials[0].base_color_texture == -1);
    CHECK(scene.materials[0].base_color == Rgb{0.25F, 0.5F, 0.75F});
    CHECK(scene.textures.empty());
}

TEST_CASE("texture coordinates: the set that the texture names, bytes as fractions, none with a remark") {
    const TempFolder folder;
    const GltfMaker maker = textured_file(png_bytes(folder, 255));
    GltfMaker bytes = maker;
    bytes.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["texCoord"] = 1;
    bytes.primitive()["attributes"]["TEXCOORD_1"] =
        bytes.add_accessor(bytes.add_view(std::vector<std::uint8_t>{0, 255, 51, 0, 0, 0, 0, 0}), harness::u8_type, 4, "VEC2");
    CHECK(load(bytes).scene.surfaces[0].uvs == std::vector<float>{0, 1, 0.2F, 0, 0, 0, 0, 0});
    bytes.root["accessors"].back()["count"] = 3;
    CHECK(error_of(bytes) == "mesh 0 primitive 0: TEXCOORD_1 has 3 elements for 4 vertices");
    bytes.root["accessors"].back()["type"] = "VEC3";
    CHECK(error_of(bytes).starts_with("mesh 0 primitive 0: accessor 3: TEXCOORD is not VEC2 of"));

    GltfMaker none = maker;
    none.primitive()["attributes"].erase("TEXCOORD_0");
    const auto [scene, remarks] = load(none);
    CHECK(scene.surfaces[0].uvs.empty());
    CHECK(remarks == Remarks{"meshes[0].primitives[0] has no TEXCOORD_0: its texture is left out"});
}

TEST_CASE("an emissive texture counts by its mean") {
    const TempFolder folder;
    GltfMaker maker = textured_file(png_bytes(folder, 255));
    maker.root["materials"][0]["emissiveFactor"] = {1, 1, 0};
    maker.root["materials"][0]["emissiveTexture"] = {{"index", 0}};
    const auto [scene, remarks] = load(maker);
    CHECK(scene.materials[0].emission_nt == Rgb{0.5F, 0.5F, 0});
    CHECK(remarks == Remarks{"materials[0].emissiveTexture: its mean is radiated everywhere"});
}

TEST_CASE("what is wrong with a member is said with its place") {
    const TempFolder folder;
    const GltfMaker good = textured_file(png_bytes(folder, 255));
    REQUIRE(error_of(good) == "loaded");
    const std::string lights = "/extensions/KHR_lights_punctual/lights", named = "extensions.KHR_lights_punctual.lights";
    const std::string pbr = "/materials/0/pbrMetallicRoughness", named_pbr = "materials[0].pbrMetallicRoughness";
    const struct {
        std::string pointer, value, message;
    } cases[] = {
        {lights + "/0/intensity", "-5", named + "[0].intensity is -5: not a finite number of at least 0"},
        {lights + "/0/intensity", "null", named + "[0].intensity is null: not a finite number of at least 0"},
        {lights + "/0/intensity", "1e39", named + "[0].intensity is 1e+39: not a finite number of at least 0"},
        {lights + "/0/intensity", R"("bright")", named + "[0].intensity is \"bright\": not a finite number of at least 0"},
        {lights + "/0/color/1", "-0.5", named + "[0].color[1] is -0.5: not a finite number of at least 0"},
        {lights + "/0/color", "[1, 1]", named + "[0].color is [1,1]: not 3 numbers"},
        {lights + "/0/color/0", "1e38", named + "[0]: intensity times color is beyond the range of floats"},
        {lights + "/0/range", "0", named + "[0].range is 0: not a finite number above 0"},
        {lights + "/0/range", "-1", named + "[0].range is -1: not a finite number above 0"},
        {lights + "/0/range", "1e-60", named + "[0].range is 1e-60: not a finite number above 0"},
        {lights + "/0/type", R"("area")", named + "[0].type is \"area\": not point, spot or directional"},
        {lights + "/0", "{}", named + "[0] has no type"},
        {lights + "/0", "3", named + "[0] is 3: not an object"},
        {lights, "{}", named + " is {}: not an array of objects"},
        {lights + "/1/spot/innerConeAngle", "0.5",
         named + "[1].spot: innerConeAngle 0.500000 is not less than outerConeAngle 0.500000"},
        {lights + "/1/spot/innerConeAngle", "-0.1", named + "[1].spot.innerConeAngle is -0.1: not an angle from 0 to pi / 2"},
        {lights + "/1/spot/outerConeAngle", "1.6", named + "[1].spot.outerConeAngle is 1.6: not an angle from 0 to pi / 2"},
        {"/nodes/3/extensions/KHR_lights_punctual/light", "3",
         "nodes[3].extensions.KHR_lights_punctual.light is 3: not one of the file's 3 lights"},
        {"/nodes/3/extensions/KHR_lights_punctual/light", "-1",
         "nodes[3].extensions.KHR_lights_punctual.light is -1: not one of the file's 3 lights"},
        {"/nodes/1/camera", "2", "nodes[1].camera is 2: not one of the file's 2 cameras"},
        {"/nodes/1/scale", "[1, 1, 0]", "node 1: its matrix leaves no direction for a camera or lamp to look in"},
        {"/nodes/3/scale", "[1, 0, 1]", "node 3: its matrix leaves no direction for a camera or lamp to look in"},
        {"/nodes/3/translation", "[1e39, 0, 0]", "node 3: its place is beyond the range of floats"},
        {"/cameras/0/perspective/yfov", "0", "cameras[0].perspective.yfov is 0: not an angle above 0 and below pi"},
        {"/cameras/0/perspective/yfov", "3.2", "cameras[0].perspective.yfov is 3.2: not an angle above 0 and below pi"},
        {"/cameras/0/perspective", "{}", "cameras[0].perspective has no yfov"},
        {"/cameras/0/perspective/aspectRatio", "0", "cameras[0].perspective.aspectRatio is 0: not a finite number above 0"},
        {"/cameras/0/type", R"("fisheye")", "cameras[0].type is \"fisheye\": not perspective or orthographic"},
        {"/cameras/1/orthographic/xmag", "0", "cameras[1].orthographic.xmag is 0: not a finite number above 0"},
        {"/cameras/1/orthographic/ymag", "-2", "cameras[1].orthographic.ymag is -2: not a finite number above 0"},
        {"/materials/0/emissiveFactor", "[0, -1, 0]", "materials[0].emissiveFactor[1] is -1: not a finite number of at least 0"},
        {"/materials/0/emissiveFactor", "[0, null, 0]",
         "materials[0].emissiveFactor[1] is null: not a finite number of at least 0"},
        {"/materials/0/extensions/KHR_materials_emissive_strength", R"({"emissiveStrength": -1})",
         "materials[0].extensions.KHR_materials_emissive_strength.emissiveStrength is -1: not a finite number of at least 0"},
        {"/materials/0",
         R"({"emissiveFactor": [1e38, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 1e3}}})",
         "materials[0]: emissiveFactor times emissiveStrength is beyond the range of floats"},
        {pbr + "/baseColorFactor/0", "-0.1", named_pbr + ".baseColorFactor[0] is -0.1: not a finite number of at least 0"},
        {pbr + "/metallicFactor", "1.5", named_pbr + ".metallicFactor is 1.5: not a number from 0 to 1"},
        {pbr + "/roughnessFactor", "-1", named_pbr + ".roughnessFactor is -1: not a number from 0 to 1"},
        {"/materials/0/extensions", R"({"KHR_materials_ior": {"ior": 0.5}})",
         "materials[0].extensions.KHR_materials_ior.ior is 0.5: not an index of refraction of at least 1"},
        {"/materials/0/extensions",
         R"({"KHR_materials_ior": {"ior": 0}, "KHR_materials_transmission": {"transmissionFactor": 1}})",
         "materials[0].extensions.KHR_materials_ior.ior is 0: not an index of refraction of at least 1"},
        {"/materials/0/extensions", R"({"KHR_materials_transmission": {"transmissionFactor": 2}})",
         "materials[0].extensions.KHR_materials_transmission.transmissionFactor is 2: not a number from 0 to 1"},
        {"/materials/0/doubleSided", "1", "materials[0].doubleSided is 1: not true or false"},
        {"/materials/0/name", "1", "materials[0].name is 1: not a string"},
        {pbr + "/baseColorTexture/index", "1", named_pbr + ".baseColorTexture.index is 1: not one of the file's 1 textures"},
        {pbr + "/baseColorTexture", "{}", named_pbr + ".baseColorTexture has no index"},
        {"/textures/0/source", "5", "textures[0].source is 5: not one of the file's 1 images"},
        {"/textures/0/sampler", "0", "textures[0].sampler is 0: not one of the file's 0 samplers"},
        {"/images/0/bufferView", "9", "images[0].bufferView is 9: not one of the file's 4 bufferViews"},
        {"/meshes/0/primitives/0/material", "1",
         "mesh 0 primitive 0: meshes[0].primitives[0].material is 1: not one of the file's 1 materials"},
    };
    for (const auto& [pointer, value, message] : cases) {
        CAPTURE(pointer);
        CAPTURE(value);
        CHECK(error_of(with(good, pointer, value)) == message);
    }
}

TEST_CASE("a number that no JSON can hold is refused") {
    const TempFolder folder;
    for (const char* bad : {"NaN", "Infinity", "1e999"}) {
        CAPTURE(bad);
        std::string text = lit_file().root.dump();
        text.replace(text.find("1000"), 4, bad);
        CHECK_FALSE(loads_soundly(folder.write("made.gltf", text)));
    }
}

TEST_CASE("without light there is a sky, without a camera a view from outside, and both are said") {
    const TempFolder folder;
    const std::string path = folder.write("square.glb", harness::square_file().glb());
    Remarks remarks;
    const RenderScene scene = load_render_scene(path, remarks);
    CHECK(scene.name == "square");
    CHECK(scene.environment_nt == Rgb{1000, 1000, 1000});
    REQUIRE(scene.cameras.size() == 1);
    CHECK(scene.cameras[0].name == "default");
    CHECK(remarks == Remarks{path + ": no light: under a sky of 1000 nt", path + ": no camera: seen from outside"});
    remarks.clear();
    CHECK(load_render_scene(path, remarks, 0.0F).environment_nt == Rgb{0, 0, 0});
    CHECK(load_render_scene(path, remarks, 5.0F).environment_nt == Rgb{5, 5, 5});
    CHECK(remarks.size() == 2);  // of the camera alone
}

TEST_CASE("only what can be seen by makes light") {
    RenderScene scene;
    CHECK_FALSE(scene.has_light());
    scene.materials = {grey_material()};
    scene.materials[0].emission_nt = {0, 0, 1};
    CHECK_FALSE(scene.has_light());  // no triangle has it
    scene.surfaces = {{{"", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}}, {}, 0}};
    CHECK(scene.has_light());
    scene.materials[0].emission_nt = {0, 0, 0};
    CHECK_FALSE(scene.has_light());
    scene.environment_nt = {0, 1, 0};
    CHECK(scene.has_light());
}

TEST_CASE("the view fits a picture of any shape and keeps all that the camera sees") {
    const Camera camera = load(lit_file()).scene.cameras[0];  // 2 to 1
    CHECK(aspect_of(camera) == doctest::Approx(2));
    for (const auto& [width, height] : {std::pair{200, 100}, std::pair{400, 100}, std::pair{100, 100}, std::pair{1, 1000}}) {
        const Camera view = fitted(camera, width, height);
        CHECK(view.half_width / view.half_height == doctest::Approx(double(width) / height));
        CHECK(view.half_width >= camera.half_width * (1 - 1e-15));
        CHECK(view.half_height >= camera.half_height);
    }
    CHECK(fitted(camera, 200, 100).half_height == camera.half_height);
    Camera open = camera;
    open.half_width = 0;
    CHECK(fitted(open, 100, 100).half_height == camera.half_height);
}

TEST_CASE("every generator makes a scene to render") {
    for (const harness::GeneratorInfo& generator : harness::generators()) {
        CAPTURE(generator.name);
        Remarks remarks;
        const RenderScene scene = load_render_scene("gen:" + generator.name + ":500", remarks);
        CHECK(scene.name == generator.name);
        CHECK(scene.has_light());
        CHECK(scene.materials.size() == 1);
        CHECK(scene.materials[0].base_color == Rgb{0.5F, 0.5F, 0.5F});
        CHECK(remarks.size() == 2);
    }
    Remarks remarks;
    CHECK_THROWS_WITH_AS(load_render_scene("gen:cornell:5", remarks), "gen:cornell:5: of gen:cornell there is one size only",
                         SceneError);
    CHECK_THROWS_WITH_AS(load_render_scene("room.obj", remarks), doctest::Contains("room.obj: neither a .glb or .gltf file"),
                         SceneError);
    CHECK_THROWS_WITH_AS(load_render_scene("room.glb", remarks), "room.glb: no such file", SceneError);
}

TEST_CASE("cornell and furnace need no remark") {
    Remarks remarks;
    const RenderScene cornell = load_render_scene("gen:cornell", remarks);
    CHECK(cornell.has_light());
    CHECK(cornell.environment_nt == Rgb{0, 0, 0});
    CHECK(cornell.cameras.size() == 1);
    const RenderScene furnace = load_render_scene("gen:furnace", remarks);
    CHECK(furnace.environment_nt == Rgb{1, 1, 1});
    CHECK(furnace.surfaces.size() == 3);
    for (const Material& material : furnace.materials) {
        CHECK(material.base_color == Rgb{1, 1, 1});
        CHECK(material.emission_nt == Rgb{0, 0, 0});
    }
    CHECK(remarks.empty());
}

TEST_CASE("every model of assimp's loads or is refused in one line") {
    if (!std::filesystem::is_directory(GNOMON_ASSIMP_MODELS)) {
        MESSAGE("skipped: no assimp models at \"" << GNOMON_ASSIMP_MODELS << "\"");
        return;
    }
    int loaded_count = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(GNOMON_ASSIMP_MODELS)) {
        const std::string path = entry.path().string();
        if (!path.ends_with(".glb") && !path.ends_with(".gltf")) continue;
        CAPTURE(path);
        loaded_count += loads_soundly(path);
    }
    CHECK(loaded_count > 10);
    Remarks remarks;
    const RenderScene box = load_render_scene(GNOMON_ASSIMP_MODELS "/BoxTextured-glTF-Binary/BoxTextured.glb", remarks);
    REQUIRE(box.textures.size() == 1);
    CHECK(box.textures[0].width == 211);
    CHECK(box.surfaces[0].uvs.size() == 2 * box.surfaces[0].mesh.vertex_count());
    CHECK(load_render_scene(GNOMON_ASSIMP_MODELS "/cameras/Cameras.gltf", remarks).cameras.size() == 2);
}

TEST_CASE("mutated files load or are refused") {
    const TempFolder folder;
    GltfMaker maker = textured_file(png_bytes(folder, 255));
    maker.root["textures"][0]["sampler"] = 0;
    maker.root["samplers"] = json::parse(R"([{"wrapS": 33648, "wrapT": 33071}])");
    maker.root["materials"][0]["emissiveFactor"] = {1, 0.5, 0};
    maker.root["materials"][0]["extensions"] = json::parse(
        R"({"KHR_materials_emissive_strength": {"emissiveStrength": 5}, "KHR_materials_ior": {"ior": 1.3},
            "KHR_materials_transmission": {"transmissionFactor": 0.7}})");
    const std::string base = maker.glb();
    REQUIRE(loads_soundly(folder.write("base.glb", base)));
    int loaded_count = 0, refused_count = 0;
    for (std::uint64_t seed = 0; seed < 4'000; ++seed) {
        CAPTURE(seed);
        const std::string path = folder.write("mutated.glb", harness::mutate_glb(base, seed));
        ++(loads_soundly(path) ? loaded_count : refused_count);
    }
    CHECK(loaded_count > 100);
    CHECK(refused_count > 2'000);
}
