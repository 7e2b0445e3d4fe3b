// The results as one JSON object, for other programs, the report and markdown.py.
#pragma once

#include <nlohmann/json.hpp>

#include "bench/results.hpp"

namespace harness {

/// A figure that does not exist is null.
nlohmann::ordered_json bench_json(const BenchResults& results);

// Parts of it.
nlohmann::ordered_json growth_json(const Growth& growth);
nlohmann::ordered_json bar_json(const Bar& bar);
nlohmann::ordered_json kinds_json(const std::vector<std::pair<std::string, double>>& figures);

/// Appends to the arrays "scenes", "builds", "ray_sets" and "speeds".
void push_scene(nlohmann::ordered_json& json, const SceneBench& scene);

}  // namespace harness
