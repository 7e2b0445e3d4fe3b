// Answers of engines to the same rays, and how they differ from each other.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hard/engines.hpp"
#include "harness/rng.hpp"

namespace harness {

/// The random numbers of a population or a case: its own, so that they are the same whatever else runs.
Rng rng_of(const HardOptions& options, const std::string& name);

/// An engine's answers to all rays, one call each.
struct Answers {
    std::vector<GnomonHit> hits;
    std::vector<std::uint8_t> occluded;

    bool agree(std::size_t ray) const;
};
Answers answers_of(Backend& backend, const std::vector<GnomonRay>& rays);

inline bool is_hit(const GnomonHit& hit) { return hit.geometry_id != GNOMON_INVALID_ID; }

/// To the bit, the normal included.
bool is_same_hit(const GnomonHit& a, const GnomonHit& b);

/// The first answers of each exacting precision, against which those of later engines are held to the bit.
class Reference {
public:
    std::size_t count_differences(const HardEngine& engine, const std::vector<GnomonHit>& hits);

private:
    std::map<std::string, std::vector<GnomonHit>> hits_;  // by precision
};

}  // namespace harness
