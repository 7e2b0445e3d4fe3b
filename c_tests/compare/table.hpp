// The results for a terminal.
#pragma once

#include <string>

#include "compare/results.hpp"

namespace harness {

/// Builds, speeds and errors of one scene as aligned columns.
std::string to_table(const SceneResult& scene);

}  // namespace harness
