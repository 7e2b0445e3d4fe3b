// The words of the command line and of the reports for the library's numbers.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gnomon.h"

namespace harness {

struct NamedValue {
    std::string_view name;
    std::uint32_t value;
};

inline constexpr std::array structure_names = {
    NamedValue{"auto", GNOMON_STRUCTURE_AUTO},       NamedValue{"brute_force", GNOMON_STRUCTURE_BRUTE_FORCE},
    NamedValue{"grid", GNOMON_STRUCTURE_GRID},       NamedValue{"octree", GNOMON_STRUCTURE_OCTREE},
    NamedValue{"kd_tree", GNOMON_STRUCTURE_KD_TREE}, NamedValue{"bsp_tree", GNOMON_STRUCTURE_BSP_TREE},
    NamedValue{"bvh", GNOMON_STRUCTURE_BVH},         NamedValue{"wide_bvh", GNOMON_STRUCTURE_WIDE_BVH},
};
inline constexpr std::array quality_names = {
    NamedValue{"low", GNOMON_QUALITY_LOW},
    NamedValue{"medium", GNOMON_QUALITY_MEDIUM},
    NamedValue{"high", GNOMON_QUALITY_HIGH},
};
inline constexpr std::array precision_names = {
    NamedValue{"fast", GNOMON_PRECISION_FAST},
    NamedValue{"accurate", GNOMON_PRECISION_ACCURATE},
    NamedValue{"exact", GNOMON_PRECISION_EXACT},
};
inline constexpr std::array isa_names = {
    NamedValue{"auto", GNOMON_ISA_AUTO}, NamedValue{"scalar", GNOMON_ISA_SCALAR}, NamedValue{"sse42", GNOMON_ISA_SSE42},
    NamedValue{"avx2", GNOMON_ISA_AVX2}, NamedValue{"avx512", GNOMON_ISA_AVX512},
};

/// The number itself where it has no name.
inline std::string name_of(std::span<const NamedValue> names, std::uint32_t value) {
    for (const NamedValue& named : names) {
        if (named.value == value) return std::string(named.name);
    }
    return std::to_string(value);
}

}  // namespace harness
