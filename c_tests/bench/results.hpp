// What gnomon-bench found, as plain data: tables, JSON and HTML are ways of showing it.
//
// A ratio of speeds is Embree's time over gnomon's: above 1, gnomon is faster. A ratio of builds is gnomon's time over Embree's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "backend/backend.hpp"

namespace harness {

struct BuildTiming {
    std::string contender;  // see contenders.hpp
    BuildReport report;     // seconds: the median
    double least_seconds = 0;
    std::size_t repeats = 0;           // 0: built once, cold, for tracing alone
    std::optional<double> time_ratio;  // to `reference`
    std::string reference;             // Embree's contender of the like quality
};

struct RaySetInfo {
    std::string view;  // "outside", "inside"; "" for random rays
    std::string kind;  // "primary", "bounce", "shadow", "random"
    std::size_t ray_count = 0, batch_ray_count = 0;
    double hit_share = 0;
    double nodes_per_ray = 0, triangles_per_ray = 0;  // what gnomon takes for the closest hit, of shadow rays too
};

/// What a ray's closest hit takes, on average.
struct RayWork {
    double nodes = 0, cells = 0, primitives = 0;
};

/// One contender in one call form over one set of rays.
struct Timing {
    std::size_t ray_set, build;  // indices into SceneBench
    CallForm call;
    std::uint32_t threads;
    std::size_t ray_count;
    double ns_per_ray, least_ns_per_ray;   // median and minimum of the repeats
    std::optional<double> ratio;           // median of the repeats' ratios to `reference`
    std::string reference;                 // "embree fresh rtcIntersect1"; for two threads gnomon itself on one
    std::optional<std::size_t> differing;  // answers hit or miss, occluded or not, unlike Embree's
};

struct SceneBench {
    std::string name;
    std::size_t triangle_count = 0;
    bool generated = false;
    std::vector<BuildTiming> builds;
    std::vector<RaySetInfo> ray_sets;
    std::vector<Timing> timings;
    std::vector<std::string> not_built;  // contenders that answered GNOMON_ERROR_UNSUPPORTED
};

/// What a call costs where there is next to nothing to trace.
struct CallCost {
    std::string scene;   // "empty", "one triangle"
    std::string engine;  // "gnomon auto", "gnomon brute_force", "gnomon wide_bvh", "embree"
    double least_ns, median_ns;
};

/// One engine at one step of the growth.
struct Growth {
    std::string engine;
    std::size_t triangle_count = 0;
    double build_seconds = 0, bytes_per_triangle = 0;
    std::vector<std::pair<std::string, double>> ns_per_ray;  // by kind, fresh
    double step = 0, n_log_n_step = 0;                       // build seconds over those of the step before; 0 for the first
    bool within_n_log_n = true;
};

struct Degenerate {
    std::string scene, engine;
    std::size_t triangle_count = 0, ray_count = 0;  // rays traced before time was up
    double build_seconds = 0, mean_us = 0, worst_us = 0;
    std::string failure;  // why there is no figure
};

enum class BarVerdict { pass, short_of, shown, not_built, not_measured };

/// One row of performance.md's "Figures to beat", or of those that structures are held against.
struct Bar {
    std::string what, bar, stretch, measured;  // bar: "" where nothing is asked
    std::optional<double> value, worst;        // the median, or what else is held against the bar; the scene farthest off
    std::string worst_where;
    std::size_t sample_count = 0;
    BarVerdict verdict = BarVerdict::not_measured;
};

/// Every structure on one scene; ratios are the scalar BVH's time over the structure's.
struct StructureScene {
    struct Work {
        std::size_t ray_set, build;  // indices into SceneBench
        RayWork per_ray;
    };
    SceneBench bench;
    std::vector<Work> work;
};

/// A grid of one resolution.
struct GridStep {
    double asked;                                            // cells a triangle
    double cells, references, build_seconds, bytes;          // a triangle, but for the seconds
    std::vector<std::pair<std::string, double>> ns_per_ray;  // by kind, fresh
};

/// Grids from one cell to far too many, and beside them the scalar BVH.
struct GridSweep {
    std::string scene;
    std::size_t triangle_count = 0;
    std::vector<GridStep> steps;
    std::vector<std::pair<std::string, double>> bvh_ns_per_ray;
};

/// What a structure is for, and where it did best and worst.
struct StructureSummary {
    std::string structure, text;
};

/// Which structure when.
struct StructureBench {
    std::vector<StructureScene> scenes;
    std::vector<GridSweep> grid_sweeps;
    std::vector<Growth> growth;
    std::vector<Bar> bars;
    std::vector<StructureSummary> summaries;
};

struct BenchResults {
    std::vector<SceneBench> scenes;
    std::vector<CallCost> call_costs;
    std::vector<Growth> growth;
    std::vector<Degenerate> degenerate;
    StructureBench structures;
    std::vector<Bar> bars;
    std::vector<std::string> notes;  // what was left out, and why
    double seconds = 0;
};

}  // namespace harness
