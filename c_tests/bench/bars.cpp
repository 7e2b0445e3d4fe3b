#include "bench/bars.hpp"

#include <algorithm>
#include <array>
#include <functional>

#include "bench/bar.hpp"
#include "bench/growth.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

constexpr std::array ray_kinds = {"primary", "bounce", "shadow", "random"};
constexpr std::array built_up = {"spaceship", "mansion", "dsub62", "2cylinderengine"};  // architecture and CAD
constexpr std::size_t large_scene = 500'000;
constexpr double most_us_per_degenerate_ray = 20;

std::string lowercase(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool is_built_up(const SceneBench& scene) {
    const std::string name = lowercase(scene.name);
    return std::any_of(built_up.begin(), built_up.end(), [&](const char* part) { return name.find(part) != std::string::npos; });
}

struct Wanted {
    std::string kind;
    CallForm call = CallForm::fresh;
    bool scaling = false;  // two threads against one
    std::size_t least_triangles = 0;
    bool built_up_only = false;
    std::function<bool(const BuildTiming&)> build = [](const BuildTiming& build) { return build.contender == "gnomon"; };
};

void collect(const SceneBench& scene, const Wanted& wanted, Samples& samples) {
    for (const Timing& timing : scene.timings) {
        const RaySetInfo& set = scene.ray_sets[timing.ray_set];
        const bool fits = (wanted.kind.empty() || set.kind == wanted.kind) && timing.call == wanted.call && timing.ratio &&
                          (timing.threads > 1) == wanted.scaling && wanted.build(scene.builds[timing.build]) && !is_blind(set);
        if (fits) samples.push_back({*timing.ratio, scene.name + (set.view.empty() ? "" : " " + set.view)});
    }
}

Samples samples_of(const BenchResults& results, const Wanted& wanted) {
    for (const bool generated : {false, true}) {
        Samples samples;
        for (const SceneBench& scene : results.scenes) {
            if (scene.generated != generated || scene.triangle_count < wanted.least_triangles) continue;
            if (wanted.built_up_only && !is_built_up(scene)) continue;
            collect(scene, wanted, samples);
        }
        if (!samples.empty()) return samples;
    }
    return {};
}

bool is_not_built(const BenchResults& results, const std::string& contender) {
    return std::any_of(results.scenes.begin(), results.scenes.end(), [&](const SceneBench& scene) {
        return std::find(scene.not_built.begin(), scene.not_built.end(), contender) != scene.not_built.end();
    });
}

/// A row without a figure because the library has nothing to measure.
Bar unless_built(Bar bar, bool not_built) {
    if (bar.sample_count == 0 && not_built) bar.verdict = BarVerdict::not_built;
    return bar;
}

Samples build_samples(const BenchResults& results, const std::string& contender) {
    Samples samples;
    for (const SceneBench& scene : results.scenes) {
        if (!is_about_a_million(scene.triangle_count)) continue;
        for (const BuildTiming& build : scene.builds) {
            if (build.contender == contender && build.time_ratio) samples.push_back({*build.time_ratio, scene.name});
        }
    }
    return samples;
}

Samples byte_samples(const BenchResults& results, const std::string& contender) {
    Samples samples;
    for (const SceneBench& scene : results.scenes) {
        for (const BuildTiming& build : scene.builds) {
            if (build.contender != contender) continue;
            samples.push_back({static_cast<double>(build.report.bytes) / static_cast<double>(scene.triangle_count), scene.name});
        }
    }
    return samples;
}

void add_single_call_bars(std::vector<Bar>& bars, const BenchResults& results) {
    for (const char* kind : ray_kinds) {
        bars.push_back(speed_bar(std::string("fresh, ") + kind, samples_of(results, {.kind = kind}), 1.12, "1.3", 0.97));
    }
    for (const char* kind : ray_kinds) {
        const Samples samples = samples_of(results, {.kind = kind, .call = CallForm::prefilled});
        bars.push_back(speed_bar(std::string("prefilled, ") + kind, samples, 1.03, "1.2", 0.92));
    }
    const auto is_fast = [](const BuildTiming& build) { return build.contender == "gnomon fast"; };
    const auto is_avx2 = [](const BuildTiming& build) {
        return build.report.isa == "avx2" && (build.contender == "gnomon" || build.contender == "gnomon avx2");
    };
    const auto is_high = [](const BuildTiming& build) { return build.contender == "gnomon high"; };
    for (const char* kind : ray_kinds) {
        const Samples samples = samples_of(results, {.kind = kind, .build = is_fast});
        bars.push_back(speed_bar(std::string("fresh, FAST, ") + kind, samples, 1.17, "1.35"));
    }
    for (const char* kind : ray_kinds) {
        const Samples samples = samples_of(results, {.kind = kind, .build = is_avx2});
        bars.push_back(speed_bar(std::string("fresh, AVX2, ") + kind, samples, 1.08, "1.35"));
    }
    for (const char* kind : ray_kinds) {
        const Samples samples = samples_of(results, {.kind = kind, .built_up_only = true, .build = is_high});
        const Bar bar = speed_bar(std::string("fresh, HIGH / Embree HIGH, architecture and CAD, ") + kind, samples, 1.2, "1.5");
        bars.push_back(unless_built(bar, is_not_built(results, "gnomon high")));
    }
}

void add_batch_bars(std::vector<Bar>& bars, const BenchResults& results) {
    struct BatchBar {
        const char *kind, *stretch;
        double least;
    };
    for (const auto& [kind, stretch, least] : {BatchBar{"bounce", "2.0", 1.6}, {"random", "3.0", 2.2}, {"shadow", "2.5", 2.0}}) {
        const Samples samples = samples_of(results, {.kind = kind, .call = CallForm::batch, .least_triangles = large_scene});
        bars.push_back(speed_bar("batch / Embree prefilled, >= 500k triangles, " + std::string(kind), samples, least, stretch));
    }
    const Samples camera = samples_of(results, {.kind = "primary", .call = CallForm::batch});
    bars.push_back(speed_bar("batch of camera rays / Embree's best", camera, 1.4, "1.8"));
    for (const char* kind : {"bounce", "random", "shadow"}) {
        const Samples samples = samples_of(results, {.kind = kind, .call = CallForm::batch, .scaling = true});
        bars.push_back(speed_bar("batch, two threads / one, " + std::string(kind), samples, 1.85, "1.95"));
    }
}

void add_build_bars(std::vector<Bar>& bars, const BenchResults& results) {
    bars.push_back(cost_bar("bytes a triangle", byte_samples(results, "gnomon"), Counts::worst, 50, "", ""));
    bars.push_back(cost_bar("compact bytes", byte_samples(results, "gnomon compact"), Counts::worst, 36, "", "30"));
    bars.push_back(cost_bar("build of 10^6 triangles, MEDIUM / Embree MEDIUM", build_samples(results, "gnomon"), Counts::median,
                            1.2, "x the time", "0.8x"));
    const Bar high = cost_bar("build of 10^6 triangles, HIGH / Embree HIGH", build_samples(results, "gnomon high"),
                              Counts::median, 1.0, "x the time", "0.6x");
    bars.push_back(unless_built(high, is_not_built(results, "gnomon high")));
}

void add_limit_bars(std::vector<Bar>& bars, const BenchResults& results) {
    Samples steps;
    for (const Growth& growth : results.growth) {
        if (growth.engine != "gnomon" || growth.step == 0) continue;
        steps.push_back({growth.step / growth.n_log_n_step, grouped(growth.triangle_count) + " triangles"});
    }
    bars.push_back(cost_bar("build time of 10 times the triangles / n log n", steps, Counts::worst, growth_margin, "", ""));
    Samples rays;
    for (const Degenerate& row : results.degenerate) {
        if (row.engine == "gnomon" && row.ray_count > 0) rays.push_back({row.worst_us, row.scene});
    }
    bars.push_back(cost_bar("slowest ray of degenerate scenes", rays, Counts::worst, most_us_per_degenerate_ray, " us", ""));
}

}  // namespace

std::vector<Bar> judge_bars(const BenchResults& results) {
    std::vector<Bar> bars;
    add_single_call_bars(bars, results);
    add_batch_bars(bars, results);
    add_build_bars(bars, results);
    add_limit_bars(bars, results);
    return bars;
}

}  // namespace harness
