// The results as one JSON object, for other programs, the report and markdown.py.
#pragma once

#include <nlohmann/json.hpp>

#include "bench/results.hpp"

namespace harness {

/// A figure that does not exist is null.
nlohmann::ordered_json bench_json(const BenchResults& results);

}  // namespace harness
