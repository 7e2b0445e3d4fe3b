// The results as one self-contained page.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "compare/results.hpp"

namespace harness {

/// The page of report.html.inc around the results that to_json() made and the scenes' pictures. Tables alone where Chart.js is
/// not installed.
std::string to_html(const nlohmann::ordered_json& results, const std::vector<SceneResult>& scenes);

}  // namespace harness
