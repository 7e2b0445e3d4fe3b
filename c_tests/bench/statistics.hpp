// Repeats of a measurement in one figure.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "compare/results.hpp"

namespace harness {

inline double median(const std::vector<double>& values) { return quantile(values, 0.5); }

inline double least(const std::vector<double>& values) {
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : *std::min_element(values.begin(), values.end());
}

/// The median of the quotients repeat by repeat: what slows a whole repeat down cancels out.
inline double median_ratio(const std::vector<double>& numerators, const std::vector<double>& denominators) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < std::min(numerators.size(), denominators.size()); ++i) {
        ratios.push_back(numerators[i] / denominators[i]);
    }
    return median(ratios);
}

}  // namespace harness
