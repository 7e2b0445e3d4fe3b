// The ends of the range of floats: denormals, with and without the host's flush to zero, and meshes with what is no number.
#include <immintrin.h>

#include <cmath>
#include <limits>

#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "rays/aim.hpp"
#include "scene/load.hpp"

namespace harness {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

/// A soup of the size 2^exponent, its rays with directions of the size 2^direction_exponent.
Trial scaled_soup(int exponent, int direction_exponent, std::size_t count, Rng& rng) {
    Trial trial = soup_trial(0.3, count, rng);
    trial.scene.name += " of 2^" + std::to_string(exponent);
    for (float& x : trial.scene.meshes[0].positions) x = std::ldexp(x, exponent);
    for (GnomonRay& ray : trial.rays) {
        for (float& x : ray.origin) x = std::ldexp(x, exponent);
        for (float& x : ray.direction) x = std::ldexp(x, direction_exponent);
    }
    std::erase_if(trial.rays, [](const GnomonRay& ray) { return !has_direction(ray); });
    return trial;
}

std::vector<Trial> denormal_trials(CaseRun& run) {
    constexpr std::array exponents = {std::pair{-127, 0}, std::pair{-140, -140}, std::pair{0, -127}, std::pair{-120, -145}};
    std::vector<Trial> trials;
    for (const auto& [exponent, direction_exponent] : exponents)
        trials.push_back(scaled_soup(exponent, direction_exponent, run.ray_count(exponents.size()), run.rng));
    return trials;
}

void run_denormals(CaseRun& run) {
    for (const Trial& trial : denormal_trials(run)) run.judge(trial);
}

/// The host's flush to zero and denormals are zero, while it lives.
class FlushToZero {
public:
    FlushToZero() : before_(_mm_getcsr()) { _mm_setcsr(before_ | flags); }
    ~FlushToZero() { _mm_setcsr(before_); }
    FlushToZero(const FlushToZero&) = delete;
    FlushToZero& operator=(const FlushToZero&) = delete;

    /// Whether the control bits are still as this set them; the others tell of exceptions.
    bool holds() const {
        constexpr unsigned exception_bits = 0x3F;
        return ((_mm_getcsr() ^ (before_ | flags)) & ~exception_bits) == 0;
    }

private:
    static constexpr unsigned flags = _MM_FLUSH_ZERO_ON | 0x0040;  // the second: denormals are zero
    unsigned before_;
};

/// The answers under FTZ and DAZ are the ones without; `is_promised` where the contract says so.
void compare_flushed(CaseRun& run, const Trial& trial, bool is_promised) {
    run.each_engine(trial.scene, [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
        const Answers before = answers_of(backend, trial.rays);
        Answers flushed;
        bool holds;
        {
            const FlushToZero flush;
            flushed = answers_of(backend, trial.rays);
            holds = flush.holds();
        }
        ++row.checked;
        if (!holds) run.fail(row, trial.scene, trial.rays.front(), "MXCSR is not as the host left it");
        for (std::size_t i = 0; i < trial.rays.size(); ++i) {
            ++row.checked;
            if (is_same_hit(before.hits[i], flushed.hits[i]) && before.occluded[i] == flushed.occluded[i]) continue;
            if (is_promised || !engine.is_gnomon()) {
                run.fail(row, trial.scene, trial.rays[i],
                         "flushed " + hit_text(flushed.hits[i]) + ", else " + hit_text(before.hits[i]));
            } else {
                ++row.failed;
            }
        }
    });
}

void run_flushed_ordinary(CaseRun& run) {
    compare_flushed(run, soup_trial(0.3, run.ray_count(2), run.rng), true);
    compare_flushed(run, edge_trial(0, run.ray_count(2), run.rng), true);
}

void run_flushed_denormals(CaseRun& run) {
    for (const Trial& trial : denormal_trials(run)) compare_flushed(run, trial, false);
}

/// Every tenth triangle gets one such coordinate.
Trial with_coordinate(float bad, CaseRun& run) {
    Trial trial = soup_trial(0.3, run.ray_count(4), run.rng);
    trial.scene.name += " with " + std::to_string(bad);
    Mesh& mesh = trial.scene.meshes[0];
    for (std::size_t triangle = 0; triangle < mesh.triangle_count(); triangle += 10)
        mesh.positions[3 * mesh.indices[3 * triangle + triangle % 3] + triangle % 3] = bad;
    return trial;
}

/// The status that a build ends with.
GnomonStatus build_status(const HardEngine& engine, const Scene& scene, std::uint32_t invalid_triangles) {
    GnomonBuildOptions options = engine.options;
    options.invalid_triangles = invalid_triangles;
    try {
        make_gnomon(scene, options);
        return GNOMON_OK;
    } catch (const BuildError& error) {
        return error.status;
    }
}

void run_broken_meshes(CaseRun& run) {
    const GnomonRay none = ray_of({0, 0, 0}, {0, 0, 1});
    for (const float bad : {nan_value, infinity, -infinity}) {
        const Trial trial = with_coordinate(bad, run);
        run.judge(trial);  // built with such triangles skipped
        run.each_engine(trial.scene, [&](const HardEngine& engine, Backend&, CaseRow& row) {
            ++row.checked;
            if (build_status(engine, trial.scene, GNOMON_INVALID_REJECT) != GNOMON_ERROR_INVALID_ARGUMENT)
                run.fail(row, trial.scene, none, "a coordinate that is not finite is not refused");
        });
    }
    Scene scene = generate_scene("icosphere", 80);
    run.each_engine(scene, [&](const HardEngine& engine, Backend&, CaseRow& row) {
        if (!engine.is_gnomon()) return;
        Scene bad_index = scene;
        bad_index.meshes[0].indices[5] = static_cast<std::uint32_t>(scene.meshes[0].vertex_count());
        ++row.checked;
        if (build_status(engine, bad_index, GNOMON_INVALID_SKIP) != GNOMON_ERROR_INVALID_ARGUMENT)
            run.fail(row, scene, none, "an index out of range is not refused");
    });
}

void run_large_coordinates(CaseRun& run) {
    run.judge(scaled_soup(120, 0, run.ray_count(3), run.rng));
    run.judge(scaled_soup(124, 100, run.ray_count(3), run.rng));
    run.judge(with_coordinate(1e38f, run));
}

void run_largest_coordinates(CaseRun& run) { run.judge(with_coordinate(3e38f, run)); }

}  // namespace

std::vector<HardCase> range_cases() {
    const std::string bar = "EXACT 0 wrong; 0 outside the contract";
    return {
        {30, "denormal vertices and directions", bar, run_denormals},
        {30, "ordinary scenes under FTZ and DAZ, MXCSR unchanged", "the same bits", run_flushed_ordinary},
        {30, "denormals under FTZ and DAZ", "the same bits", run_flushed_denormals,
         "gradual underflow is expected to be on, as gnomon.h says: FTZ and DAZ make zeros of denormal coordinates"},
        {32, "NaN, infinity and bad indices in the mesh", "refused or skipped; 0 wrong of the rest", run_broken_meshes},
        {32, "coordinates up to 1e38", bar, run_large_coordinates},
        {32, "coordinates of 3e38", bar, run_largest_coordinates},
    };
}

}  // namespace harness
