// What was measured of structures, as JSON.
#pragma once

#include <nlohmann/json.hpp>

#include "bench/results.hpp"

namespace harness {

/// The rows of a bench are in "scenes", "builds", "ray_sets" and "speeds" as those of the other scenes are, without Embree.
nlohmann::ordered_json structures_json(const StructureBench& structures);

}  // namespace harness
