// Where and with what a comparison ran.
#pragma once

#include <string>

namespace harness {

struct Machine {
    std::string cpu;
    unsigned cores = 0;
    std::string isa;  // the widest of the CPU, by gnomon's names
    std::string os;
};
Machine this_machine();

/// Empty where unknown.
struct Versions {
    std::string gnomon, embree, rustc, compiler, commit;
};
Versions these_versions();

}  // namespace harness
