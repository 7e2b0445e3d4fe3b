// Seeded damage to a binary glTF file.
#pragma once

#include <cstdint>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "harness/rng.hpp"
#include "scene/glb.hpp"

namespace harness {

/// Changes one to eight bytes of file[from, to).
inline void flip_bytes(std::string& file, std::size_t from, std::size_t to, Rng& rng) {
    for (std::uint64_t i = 0, count = 1 + rng.below(8); i < count; ++i)
        file[from + rng.below(to - from)] ^= char(1 + rng.below(255));
}

/// Replaces one number of the JSON by one that is negative, large, fractional, or no number.
inline void replace_number(nlohmann::json& root, Rng& rng) {
    static const nlohmann::json replacements[] = {-1,         0,          1,          3,          255,        5123, 5126,
                                                  2147483647, 2147483648, 4294967295, 4294967296, UINT64_MAX, 0.5,  1e39,
                                                  -1e39,      1e-320,     nullptr,    "x",        {}};
    std::vector<std::string> numbers;  // JSON pointers
    const nlohmann::json flat = root.flatten();
    for (const auto& [pointer, value] : flat.items())
        if (value.is_number()) numbers.push_back(pointer);
    if (numbers.empty()) return;
    root[nlohmann::json::json_pointer(numbers[rng.below(numbers.size())])] = replacements[rng.below(std::size(replacements))];
}

/// Replaces one to three numbers of the JSON.
inline std::string replace_numbers(const GlbChunks& chunks, Rng& rng) {
    nlohmann::json root = nlohmann::json::parse(chunks.json);
    for (std::uint64_t i = 0, count = 1 + rng.below(3); i < count; ++i) replace_number(root, rng);
    return join_glb({root.dump(), chunks.binary});
}

/// Bytes changed anywhere, in the JSON or in the headers; the end cut off; or numbers of the JSON replaced in a container that is
/// right again.
inline std::string mutate_glb(const std::string& glb, std::uint64_t seed) {
    constexpr std::size_t json_begin = 20;
    Rng rng(seed);
    std::string file = glb;
    const GlbChunks chunks = split_glb(glb);
    switch (seed % 5) {
        case 0:
            flip_bytes(file, 0, file.size(), rng);
            return file;
        case 1:
            flip_bytes(file, json_begin, json_begin + chunks.json.size(), rng);
            return file;
        case 2:
            flip_bytes(file, 0, json_begin, rng);
            return file;
        case 3:
            file.resize(rng.below(file.size()));
            return file;
        default:
            return replace_numbers(chunks, rng);
    }
}

}  // namespace harness
