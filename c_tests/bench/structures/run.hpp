// Which structure when: every structure on scenes that suit some and not others.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "bench/options.hpp"
#include "bench/results.hpp"

namespace harness {

/// `print` gets the text of each part as soon as it is there.
StructureBench measure_structures(const BenchOptions& options, std::vector<std::string>& notes,
                                  const std::function<void(const std::string&)>& print);

}  // namespace harness
