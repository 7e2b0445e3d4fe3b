// How fast estimates of irradiance come near the closed form.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "light/half_hidden.hpp"

namespace harness {

/// Over many places, all errors relative to what arrives without the screen.
struct ConvergenceRow {
    std::string lamp, estimator;
    std::uint64_t sample_count;
    std::size_t place_count;
    double rms_error, rms_standard_error;
    double seconds;  // of one estimate on one thread
};

/// gnomon_irradiance and plain Monte Carlo on the same places, at 2^8, 2^10, ... samples up to `most_samples`.
std::vector<ConvergenceRow> measure_convergence(std::uint64_t most_samples, std::uint64_t seed,
                                                const std::function<void(const std::string&)>& tell);

}  // namespace harness
