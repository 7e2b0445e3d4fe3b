// The results as one self-contained page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace harness {

/// The page of bench.html.inc around what bench_json() made. Tables alone where Chart.js is not installed.
std::string bench_html(const nlohmann::ordered_json& results);

}  // namespace harness
