// What a run of gnomon-hard found, as plain data.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "compare/results.hpp"
#include "hard/engines.hpp"

namespace harness {

/// One engine's answers to one population.
struct PopulationRow {
    std::string name;
    HardEngine engine;
    Errors errors;
    std::size_t differences = 0;    // answers that are not brute force's to the bit; counted of gnomon but FAST
    std::size_t disagreements = 0;  // rays that intersect and occluded see differently
};

/// One engine in one case. `failed` is raw: nothing is forgiven. `broken` is what of it gnomon's contract does not allow.
struct CaseRow {
    int number;
    std::string name;
    HardEngine engine;
    std::size_t checked = 0, failed = 0, broken = 0;
    std::size_t differences = 0, disagreements = 0;  // as in PopulationRow
    std::string unit, bar, limit;
};

/// What a figure of a bar says about gnomon.
enum class BarKind { correctness, comparison, timing };

struct HardBar {
    std::string id, text, measured, bar;
    bool pass;
    BarKind kind = BarKind::correctness;
};

/// What precision costs on one kind of rays of one scene.
struct PrecisionCost {
    std::string scene, ray_kind;
    double fast_ns, accurate_ns, exact_ns;  // medians; NaN of a precision that was not measured
};

/// How long rays take that can hit nothing.
struct InvalidCost {
    double miss_ns = 0, invalid_ns = 0;  // of an ordinary miss, and of the slowest kind of invalid ray; 0: not measured
};

struct HardResults {
    std::vector<PopulationRow> populations;
    std::vector<CaseRow> cases;
    std::vector<PrecisionCost> costs;
    InvalidCost invalid;
    std::vector<HardBar> bars;
    std::vector<std::string> notes;
    double seconds = 0;
};

}  // namespace harness
