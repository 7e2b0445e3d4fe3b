// A lamp partly behind a screen, where what arrives is known in closed form.
#pragma once

#include "api/handles.hpp"
#include "gnomon.h"
#include "harness/rng.hpp"
#include "scene/scene.hpp"

namespace harness {

enum class LampKind {
    rectangle,             // of two triangles, above the horizon
    rectangle_on_horizon,  // which cuts it
    sphere,
};
const char* name_of(LampKind kind);

inline constexpr float lamp_luminance_nt = 1000;

/// The screen is a half plane as far as the lamp is concerned, so that what it leaves of the lamp is a polygon, or a disc cut by
/// a plane through the point.
struct HalfHidden {
    Mesh rectangle;             // shines down; empty where the lamp is a sphere
    GnomonSphereSource sphere;  // of radius 0 where it is a rectangle
    Mesh screen;
    Vec3f point, normal;
    double whole_lx, visible_lx;  // of the lamp, and of what the screen leaves: 20 to 80 % of it, roughly
};
HalfHidden half_hidden(LampKind kind, Rng& rng);

/// Points into `place`, which must outlive it.
class LampSources {
public:
    explicit LampSources(const HalfHidden& place);
    LampSources(const LampSources&) = delete;
    LampSources& operator=(const LampSources&) = delete;

    const GnomonSources& get() const { return sources_; }

private:
    GnomonAreaSource area_;
    GnomonSources sources_;
};

/// At the place's receiver. Throws std::runtime_error with the library's words.
GnomonIrradiance irradiance_at(const HalfHidden& place, const GnomonScene* scene, std::uint64_t sample_count, std::uint64_t seed,
                               std::uint32_t thread_count = 0);

/// The meshes as the geometries 0, 1, ...; throws as above.
SceneHandle build_meshes(const std::vector<Mesh>& meshes, std::uint32_t structure = GNOMON_STRUCTURE_AUTO,
                         std::uint32_t precision = GNOMON_PRECISION_ACCURATE);

/// An axis-aligned rectangle of two triangles at height z, whose front is up or down.
Mesh horizontal_rectangle(const Vec3f& lower, const Vec3f& upper, bool faces_up);

}  // namespace harness
