// What must not change a hit: powers of two, the names of axes, the order of a triangle's vertices.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "rays/aim.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

/// A trial looked at in another way, and how its hits come from those of the original.
struct Image {
    explicit Image(const Trial& original) : trial(original), t_scales(original.rays.size(), 1.0f) {}

    Trial trial;
    std::vector<float> t_scales;  // one a ray
    /// Which weight of the original hit is u and which v: 1 for u, 2 for v, 0 for 1 - u - v, which no hit holds.
    std::size_t u_from = 1, v_from = 2;

    /// Ids, t, u and v; the normal is a product of two lengths, which may leave the range of floats.
    bool fits(std::size_t ray, const GnomonHit& original, const GnomonHit& hit) const {
        if (hit.geometry_id != original.geometry_id || hit.primitive_id != original.primitive_id) return false;
        if (!is_hit(hit)) return true;
        const std::array weights = {0.0f, original.u, original.v};
        const bool u_fits = u_from == 0 || hit.u == weights[u_from];
        const bool v_fits = v_from == 0 || hit.v == weights[v_from];
        return hit.t == original.t * t_scales[ray] && u_fits && v_fits;
    }
};

/// A trial with the answers of every engine, against which those to its images are held. FAST is held to nothing: its roundings
/// may depend on all of this.
class Original {
public:
    Original(CaseRun& run, const Trial& trial) : run_(run) {
        run_.each_engine(trial.scene, [&](const HardEngine& engine, Backend& backend, CaseRow&) {
            hits_[engine.label()] = answers_of(backend, trial.rays).hits;
        });
    }

    void compare(const Image& image) {
        const auto& [scene, rays] = image.trial;
        run_.each_engine(scene, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
            const std::vector<GnomonHit>& before = hits_.at(engine.label());
            const std::vector<GnomonHit> hits = answers_of(backend, rays).hits;
            for (std::size_t i = 0; i < hits.size(); ++i) {
                if (!engine.is_gnomon() && !embree_takes(rays[i])) continue;
                ++row.checked;
                if (image.fits(i, before[i], hits[i])) continue;
                if (engine.is_gnomon() && !engine.is_exacting()) {
                    ++row.failed;
                } else {
                    run_.fail(row, scene, rays[i], hit_text(hits[i]) + ", from " + hit_text(before[i]));
                }
            }
        });
    }

private:
    CaseRun& run_;
    std::map<std::string, std::vector<GnomonHit>> hits_;  // by the engine's label
};

/// Random rays, and rays at vertices and edges, of a closed mesh and of a soup, with few rays for each of many images.
Trial small_trial(CaseRun& run, std::size_t image_count) {
    constexpr std::size_t least_rays = 40;
    const std::size_t count = std::max(least_rays, run.ray_count(image_count));
    Trial trial = soup_trial(0.3, count / 2, run.rng);
    const Scene sphere = generate_scene("icosphere", 80);
    trial.scene.meshes[0].indices.resize(3 * std::size_t{200});
    trial.scene.meshes.push_back(sphere.meshes[0]);
    for (std::size_t i = 0; i < count / 2; ++i) {
        const auto triangle = sphere.triangle(0, static_cast<std::uint32_t>(run.rng.below(sphere.triangle_count())));
        const Vec3f target = between({triangle[0], triangle[1]}, i % 2 == 0 ? 0 : run.rng.uniform());
        trial.rays.push_back(ray_towards(to_float(2.0 * unit_direction(run.rng)), target));
    }
    return trial;
}

/// From `least` to `most`: all in a full run, else every 20th.
std::vector<int> exponents(const CaseRun& run, int least, int most) {
    std::vector<int> list;
    for (int k = least; k <= most; k += run.is_full() ? 1 : 20) list.push_back(k);
    return list;
}

void run_scene_scales(CaseRun& run) {
    const std::vector<int> scales = exponents(run, -100, 100);
    const Trial trial = small_trial(run, scales.size());
    Original original(run, trial);
    for (const int k : scales) {
        Image image(trial);
        image.trial.scene.name += " x 2^" + std::to_string(k);
        for (Mesh& mesh : image.trial.scene.meshes)
            for (float& x : mesh.positions) x = std::ldexp(x, k);
        for (GnomonRay& ray : image.trial.rays)
            for (float& x : ray.origin) x = std::ldexp(x, k);
        std::ranges::fill(image.t_scales, std::ldexp(1.0f, k));
        original.compare(image);
    }
}

/// A component that 2^-120 makes a denormal loses bits, and is another direction then.
bool stays_normal(const GnomonRay& ray) {
    return std::ranges::all_of(ray.direction, [](float x) { return x == 0 || std::abs(x) >= 0x1p-5f; });
}

void run_direction_scales(CaseRun& run) {
    const std::vector<int> scales = exponents(run, -120, 100);
    Trial trial = small_trial(run, scales.size());
    std::erase_if(trial.rays, [](const GnomonRay& ray) { return !stays_normal(ray); });
    // The same rays once for each scale.
    const std::vector<GnomonRay> rays = trial.rays;
    for (std::size_t i = 1; i < scales.size(); ++i) trial.rays.insert(trial.rays.end(), rays.begin(), rays.end());
    Image image(trial);
    for (std::size_t i = 0; i < trial.rays.size(); ++i) {
        const int k = scales[i / rays.size()];
        for (float& x : image.trial.rays[i].direction) x = std::ldexp(x, k);
        image.t_scales[i] = std::ldexp(1.0f, -k);
    }
    Original(run, trial).compare(image);
}

/// Coordinates renamed, then mirrored where a bit of `mirrors` is set.
void rename_axes(float* point, const std::array<std::size_t, 3>& axes, unsigned mirrors) {
    const Vec3f old{point[0], point[1], point[2]};
    for (std::size_t axis = 0; axis < 3; ++axis) point[axis] = (mirrors >> axis & 1) != 0 ? -old[axes[axis]] : old[axes[axis]];
}

void run_axes(CaseRun& run) {
    constexpr std::size_t image_count = 48;
    const Trial trial = small_trial(run, image_count);
    Original original(run, trial);
    std::array<std::size_t, 3> axes{0, 1, 2};
    do {
        for (unsigned mirrors = 0; mirrors < 8; ++mirrors) {
            Image image(trial);
            image.trial.scene.name +=
                " axes " + std::to_string(100 * axes[0] + 10 * axes[1] + axes[2]) + "/" + std::to_string(mirrors);
            for (Mesh& mesh : image.trial.scene.meshes)
                for (std::size_t i = 0; i < mesh.positions.size(); i += 3) rename_axes(&mesh.positions[i], axes, mirrors);
            for (GnomonRay& ray : image.trial.rays) {
                rename_axes(ray.origin, axes, mirrors);
                rename_axes(ray.direction, axes, mirrors);
            }
            original.compare(image);
        }
    } while (std::ranges::next_permutation(axes).found);
}

void run_vertex_order(CaseRun& run) {
    struct Order {
        std::array<std::size_t, 3> corners;  // of the original, one for each of the new
        std::size_t u_from, v_from;
    };
    constexpr std::array orders = {Order{{1, 2, 0}, 2, 0}, Order{{2, 0, 1}, 0, 1}, Order{{0, 2, 1}, 2, 1}};
    const Trial trial = small_trial(run, orders.size());
    Original original(run, trial);
    for (const Order& order : orders) {
        Image image(trial);
        image.u_from = order.u_from;
        image.v_from = order.v_from;
        image.trial.scene.name += " from corner " + std::to_string(order.corners[0]);
        for (std::size_t mesh = 0; mesh < trial.scene.meshes.size(); ++mesh) {
            const std::vector<std::uint32_t>& old = trial.scene.meshes[mesh].indices;
            std::vector<std::uint32_t>& indices = image.trial.scene.meshes[mesh].indices;
            for (std::size_t i = 0; i < old.size(); ++i) indices[i] = old[i / 3 * 3 + order.corners[i % 3]];
        }
        original.compare(image);
    }
}

}  // namespace

std::vector<HardCase> symmetry_cases() {
    const std::string bar = "the same bits, but FAST";
    return {
        {26, "scene x 2^k, k from -100 to 100", bar, run_scene_scales},
        {27, "direction x 2^k, k from -120 to 100", bar, run_direction_scales},
        {28, "axis permutations and mirrors", bar, run_axes},
        {29, "vertex rotation and flip", bar, run_vertex_order},
    };
}

}  // namespace harness
