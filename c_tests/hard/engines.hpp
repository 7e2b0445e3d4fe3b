// Everything that answers rays here: gnomon in each structure, precision and instruction set, and Embree in both its modes.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "backend/backend.hpp"
#include "hard/options.hpp"

namespace harness {

struct HardEngine {
    std::string engine;                     // "gnomon", "embree", "embree_robust"
    std::string structure, precision, isa;  // as the harness names them; precision and isa of gnomon alone
    GnomonBuildOptions options;             // gnomon's

    bool is_gnomon() const { return engine == "gnomon"; }
    /// Held to bits and roundings: FAST is to its decisions alone.
    bool is_exacting() const { return is_gnomon() && precision != "fast"; }
    std::string label() const;
};

// The words of the command line. "wide_bvh_compact" is a wide BVH with leaves of unique vertices.
std::vector<std::string> structure_words();
std::vector<std::string> precision_words();
std::vector<std::string> isa_words();

/// Those that the options ask for and this machine can run; what is left out is said in `notes`. gnomon comes first, brute force
/// before all others of a precision.
std::vector<HardEngine> hard_engines(const HardOptions& options, std::vector<std::string>& notes);

/// Throws BuildError.
std::unique_ptr<Backend> make_backend(const HardEngine& engine, const Scene& scene);

}  // namespace harness
