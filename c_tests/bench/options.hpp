// What the command line of gnomon-bench asks for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace harness {

struct BenchOptions {
    std::vector<std::string> scenes;  // empty: the default ones
    std::vector<std::string> parts;   // of part_names
    bool structures_alone = false;    // parts is then {"structures"}
    bool quick = false;
    std::size_t ray_count = 0;
    std::uint32_t repeats = 0;
    std::uint32_t build_repeats = 3;
    std::uint32_t threads = 2;
    std::size_t most_triangles = 0;  // of the growth's last step, and of degenerate scenes up to 10^6
    std::string json_path, html_path;

    bool has_part(const std::string& part) const;
};

/// Empty where the program has no more to do: after --help, or after one line about what is wrong. `status` is then its exit
/// status.
std::optional<BenchOptions> parse_bench_options(int argc, char** argv, int& status);

}  // namespace harness
