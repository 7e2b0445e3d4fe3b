// The widest instruction set of this CPU, by gnomon's names.
#pragma once

#include <string>

namespace harness {

inline std::string cpu_isa() {
    if (__builtin_cpu_supports("avx512vl")) return "avx512";
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) return "avx2";
    return __builtin_cpu_supports("sse4.2") ? "sse42" : "scalar";
}

}  // namespace harness
