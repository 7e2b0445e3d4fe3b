// The results as one JSON object, for other programs and for the report.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "compare/machine.hpp"
#include "compare/results.hpp"

namespace harness {

/// Null where the value is not finite.
nlohmann::ordered_json number(double value);

/// Where and with what a program measured: { "machine": ..., "versions": ... }.
nlohmann::ordered_json heading_json(const Machine& machine, const Versions& versions);

/// A figure that does not exist is null.
nlohmann::ordered_json to_json(const Machine& machine, const Versions& versions, const std::vector<SceneResult>& scenes);

}  // namespace harness
