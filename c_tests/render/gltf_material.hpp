// A material of a glTF file, as one of the three kinds that are rendered.
#pragma once

#include <string>
#include <vector>

#include "render/gltf_texture.hpp"

namespace render {

/// transmissionFactor >= 0.5 (KHR_materials_transmission) makes glass of its index of refraction (KHR_materials_ior),
/// metallicFactor >= 0.5 with roughnessFactor < 0.5 a mirror, all else is diffuse: of the factors alone, textures of them are not
/// looked at. Nothing is see-through but glass. Emission is emissiveFactor times emissiveStrength
/// (KHR_materials_emissive_strength), in nt; of an emissive texture its mean, so that the flux is about right.
///
/// A base colour above 1 would make light of nothing: it becomes 1, with a remark. Throws SceneError for factors that are
/// negative, not finite or outside the specification's range, and an index of refraction below 1.
Material read_material(const JsonObject& material, TextureReader& textures, const RenderScene& scene,
                       std::vector<std::string>& remarks);

}  // namespace render
