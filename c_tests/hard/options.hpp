// What the command line of gnomon-hard asks for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace harness {

struct HardOptions {
    std::size_t ray_count = 40'000;
    std::uint64_t seed = 1;
    std::vector<std::string> populations, cases;            // names and numbers
    std::vector<std::string> structures, precisions, isas;  // gnomon's, by the harness's names
    bool timing = true;
    std::string json_path, failures_path;

    /// Whether cases of a million triangles are worth their time.
    bool is_full() const { return ray_count >= 20'000; }
};

/// Empty where the program has no more to do: after --help, or after one line about what is wrong. `status` is then its exit
/// status.
std::optional<HardOptions> parse_hard_options(int argc, char** argv, int& status);

}  // namespace harness
