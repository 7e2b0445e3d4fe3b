// A scene as the renderer sees it: surfaces with materials, lights in photometric units, cameras. Lengths in metres.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace render {

using harness::Vec3d;
using harness::Vec3f;

/// Linear, Rec. 709 primaries. For light each channel is in the quantity's unit, so that (L, L, L) is white of L nt; its
/// luminance is 0.2126 R + 0.7152 G + 0.0722 B.
using Rgb = std::array<float, 3>;

struct Texture {
    int width, height;
    std::vector<Rgb> texels;  // row by row from the top, linear
    bool repeats_u = true, repeats_v = true;
};

enum class MaterialKind { diffuse, mirror, glass };

struct Material {
    std::string name;
    MaterialKind kind = MaterialKind::diffuse;
    Rgb base_color{1, 1, 1};      // in [0, 1]: reflectance of diffuse and mirror, transmittance of glass
    int base_color_texture = -1;  // index into RenderScene::textures, multiplies base_color
    float index_of_refraction = 1.5F;
    Rgb emission_nt{0, 0, 0};  // radiated by the front side, by both where is_double_sided
    bool is_double_sided = false;
};

/// The geometry_id is its index.
struct Surface {
    harness::Mesh mesh;      // world space
    std::vector<float> uvs;  // u v for each vertex, or empty
    std::uint32_t material_id;
};

struct Camera {
    std::string name;
    Vec3d position, right, up, forward;  // orthonormal
    double half_height, half_width;      // of the image plane at distance 1; of the view itself where is_orthographic
    bool is_orthographic = false;
};

struct PointLight {
    Vec3f position;
    Rgb intensity_cd;
    float range_m;  // INFINITY: none
};
struct SpotLight {
    Vec3f position, direction;
    Rgb intensity_cd;
    float range_m, inner_cone_rad, outer_cone_rad;
};
struct DirectionalLight {
    Vec3f direction;  // that the light travels in
    Rgb illuminance_lx;
};

struct RenderScene {
    std::string name;
    std::vector<Surface> surfaces;
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<Camera> cameras;
    std::vector<PointLight> point_lights;
    std::vector<SpotLight> spot_lights;
    std::vector<DirectionalLight> directional_lights;
    Rgb environment_nt{0, 0, 0};  // from every direction that hits nothing

    bool has_light() const;  // a lamp, an emissive material that a triangle has, or an environment
};

}  // namespace render
