// A mean and how far it may be off.
#pragma once

#include <cmath>
#include <cstddef>

namespace harness {

/// Of independent samples (Welford 1962).
struct Mean {
    std::size_t count = 0;
    double mean = 0, sum_of_squares = 0;  // of the distances from the mean

    void add(double x) {
        ++count;
        const double distance = x - mean;
        mean += distance / static_cast<double>(count);
        sum_of_squares += distance * (x - mean);
    }
    double standard_error() const {
        const auto n = static_cast<double>(count);
        return count < 2 ? 0 : std::sqrt(sum_of_squares / (n * (n - 1)));
    }
};

/// The chance to be off by more is 1 in 16,000.
constexpr double most_standard_errors = 4;

}  // namespace harness
