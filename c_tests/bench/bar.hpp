// One row of the bars: figures held against what is asked for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "bench/results.hpp"

namespace harness {

/// One figure of one scene.
struct Sample {
    double value;
    std::string where;
};
using Samples = std::vector<Sample>;

/// Whether rays of this set measure calls rather than traversal: a camera that sees next to nothing, or bounces of which nearly
/// all leave the scene at once.
bool is_blind(const RaySetInfo& set);

/// Triangles of what counts as a build of 10^6.
bool is_about_a_million(std::size_t triangle_count);

/// The median must not be below `least`, nor any scene below `least_anywhere`.
Bar speed_bar(const std::string& what, const Samples& samples, double least, const std::string& stretch,
              std::optional<double> least_anywhere = {});

/// What counts, the median or the worst, must not be above `most`.
enum class Counts { median, worst };
Bar cost_bar(const std::string& what, const Samples& samples, Counts counts, double most, const std::string& unit,
             const std::string& stretch);

/// The median for its own sake: nothing is asked of it.
Bar shown_bar(const std::string& what, const Samples& samples);

/// "pass", "short", "shown", "not built", "not measured".
std::string verdict_name(BarVerdict verdict);

}  // namespace harness
