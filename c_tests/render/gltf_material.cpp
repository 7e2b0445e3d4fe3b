#include "render/gltf_material.hpp"

#include <algorithm>
#include <cmath>

#include "scene/load.hpp"

namespace render {

namespace {

MaterialKind kind_of(const JsonObject& material) {
    const JsonObject pbr = material.object("pbrMetallicRoughness");
    const double metallic = pbr.number("metallicFactor", 1, fraction), roughness = pbr.number("roughnessFactor", 1, fraction);
    const double transmission =
        material.object("extensions").object("KHR_materials_transmission").number("transmissionFactor", 0, fraction);
    if (transmission >= 0.5) return MaterialKind::glass;
    return metallic >= 0.5 && roughness < 0.5 ? MaterialKind::mirror : MaterialKind::diffuse;
}

Rgb read_base_color(const JsonObject& pbr, std::vector<std::string>& remarks) {
    const std::vector<double> factor = pbr.numbers("baseColorFactor", {1, 1, 1, 1}, not_negative);
    if (*std::max_element(factor.begin(), factor.begin() + 3) > 1)
        remarks.push_back(pbr.path() + ".baseColorFactor is above 1, which no surface reflects: taken as 1");
    Rgb color;
    for (std::size_t i = 0; i < 3; ++i) color[i] = float(std::min(factor[i], 1.0));
    return color;
}

/// The specification's 0 means a surface that reflects everything, which no glass does.
float read_index_of_refraction(const JsonObject& material, MaterialKind kind) {
    const JsonObject ior = material.object("extensions").object("KHR_materials_ior");
    const double index = ior.number("ior", 1.5, not_negative);
    const bool is_unused_zero = index == 0 && kind != MaterialKind::glass;
    if (index < 1 && !is_unused_zero) ior.fail("ior", "an index of refraction of at least 1");
    return is_unused_zero ? 1.5F : float(index);
}

Rgb mean_of(const Texture& texture) {
    std::array<double, 3> sum{};
    for (const Rgb& texel : texture.texels)
        for (std::size_t i = 0; i < 3; ++i) sum[i] += texel[i];
    const auto count = double(texture.texels.size());
    return {float(sum[0] / count), float(sum[1] / count), float(sum[2] / count)};
}

Rgb read_emission(const JsonObject& material, TextureReader& textures, const RenderScene& scene,
                  std::vector<std::string>& remarks) {
    const std::vector<double> factor = material.numbers("emissiveFactor", {0, 0, 0}, not_negative);
    const double strength =
        material.object("extensions").object("KHR_materials_emissive_strength").number("emissiveStrength", 1, not_negative);
    if (strength * *std::ranges::max_element(factor) == 0) return {0, 0, 0};
    Rgb mean{1, 1, 1};
    if (const int texture = textures.read(material, "emissiveTexture"); texture >= 0) {
        mean = mean_of(scene.textures[std::size_t(texture)]);
        remarks.push_back(material.path() + ".emissiveTexture: its mean is radiated everywhere");
    }
    Rgb emission;
    for (std::size_t i = 0; i < 3; ++i) emission[i] = float(factor[i] * strength * mean[i]);
    if (!std::isfinite(emission[0] + emission[1] + emission[2]))
        throw harness::SceneError(material.path() + ": emissiveFactor times emissiveStrength is beyond the range of floats");
    return emission;
}

}  // namespace

Material read_material(const JsonObject& material, TextureReader& textures, const RenderScene& scene,
                       std::vector<std::string>& remarks) {
    const JsonObject pbr = material.object("pbrMetallicRoughness");
    Material result;
    result.name = material.text("name", "");
    result.kind = kind_of(material);
    result.base_color = read_base_color(pbr, remarks);
    result.base_color_texture = textures.read(pbr, "baseColorTexture");
    result.index_of_refraction = read_index_of_refraction(material, result.kind);
    result.emission_nt = read_emission(material, textures, scene, remarks);
    result.is_double_sided = material.flag("doubleSided", false);
    if (material.text("alphaMode", "OPAQUE") != "OPAQUE") remarks.push_back(material.path() + ".alphaMode: taken as OPAQUE");
    return result;
}

}  // namespace render
