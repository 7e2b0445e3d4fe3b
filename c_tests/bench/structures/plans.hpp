// Every structure as a contender. It is called as its structure, with " low" or " high" after it where it is not MEDIUM.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "bench/contenders.hpp"

namespace harness {

/// The binary BVH, MEDIUM: what the structures are set against.
inline constexpr const char* reference_structure = "bvh";

/// Beyond it a BSP tree is not built: it would take minutes.
constexpr std::size_t most_bsp_triangles = 100'000;

enum class Qualities { medium_alone, all };

/// The reference first. Without the BSP tree where there are too many triangles for it; of it and of brute force MEDIUM alone.
std::vector<Plan> structure_plans(const BenchOptions& options, std::size_t triangle_count, Qualities qualities);

/// A structure's name and its quality.
Plan structure_plan(const std::string& structure, std::uint32_t quality, const BenchOptions& options);

}  // namespace harness
