// A page of text, scripts and results in one self-contained file.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace harness {

/// `page` with its marks {{RESULTS}} and {{CHART_JS}} filled in; the latter with nothing where Chart.js is not installed.
std::string fill_page(std::string_view page, const nlohmann::ordered_json& results);

}  // namespace harness
