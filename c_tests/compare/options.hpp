// What the command line asks for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "backend/backend.hpp"

namespace harness {

struct Options {
    std::vector<std::string> scenes;
    std::vector<std::uint32_t> structures, precisions, qualities;  // GNOMON_ values
    std::vector<std::string> ray_kinds;
    std::vector<CallForm> calls;
    std::size_t ray_count = 250'000;
    std::size_t oracle_ray_count = 2'000;
    std::uint32_t threads = 1;
    std::uint32_t repeats = 5;
    std::uint32_t build_repeats = 3;
    std::map<std::uint32_t, std::size_t> most_triangles;  // by GNOMON_STRUCTURE_; without an entry, any number
    std::uint32_t isa = GNOMON_ISA_AUTO;
    bool compact = false;
    std::string json_path, html_path, failures_path;
    std::optional<GnomonRay> replay;
};

/// Empty where the program has no more to do: after --help, or after one line about what is wrong. `status` is then its exit
/// status.
std::optional<Options> parse_options(int argc, char** argv, int& status);

/// "single", "prefilled", "batch".
std::string call_form_name(CallForm form);

}  // namespace harness
