// The results as one JSON object.
#pragma once

#include <nlohmann/json.hpp>

#include "hard/options.hpp"
#include "hard/results.hpp"

namespace harness {

/// A figure that does not exist is null.
nlohmann::ordered_json hard_json(const HardOptions& options, const HardResults& results);

}  // namespace harness
