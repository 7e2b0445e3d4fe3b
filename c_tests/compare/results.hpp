// What a run found, as plain data: the table, the JSON and the HTML report are three ways of showing it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "backend/backend.hpp"

namespace harness {

/// How fast one engine traced one set of rays in one call form.
struct Speed {
    std::size_t build;  // index into SceneResult::builds
    CallForm call;
    std::uint32_t threads;
    std::size_t ray_count;
    std::string ray_kind;
    double ns_per_ray;                      // median of the repeats
    std::optional<double> ratio_to_embree;  // Embree's ns over these; absent without Embree
    std::string embree_call;                // Embree's function behind the ratio

    double mrays_per_s() const { return 1e3 / ns_per_ray; }
};

struct Quantiles {
    double median, p99, max;  // NaN where there is nothing to rank
};

/// One engine's answers against the exact oracle.
struct Errors {
    std::size_t build;
    std::string ray_kind;
    std::size_t ray_count;
    std::size_t missed = 0, false_hits = 0, wrong_primitive = 0, outside_contract = 0, ties = 0;
    Quantiles t_ulps, uv;  // uv in units of 2^-24

    std::size_t wrong_decisions() const { return missed + false_hits + wrong_primitive; }
};

struct SceneResult {
    std::string name;
    std::size_t triangle_count = 0;
    std::vector<BuildReport> builds;
    std::vector<Speed> speeds;
    std::vector<Errors> errors;
    std::string picture_png;  // the bytes of a PNG file; empty where none was asked for
};

/// The value below which a share `q` of the values lies; NaN of none.
double quantile(std::vector<double> values, double q);

}  // namespace harness
