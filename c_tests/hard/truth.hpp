// The exact oracle's word on a list of rays, found once and held against the answers of many engines.
#pragma once

#include <string>
#include <vector>

#include "gnomon.h"
#include "oracle/oracle.hpp"

namespace harness {

class Truth {
public:
    /// Both must live as long.
    Truth(const Scene& scene, const std::vector<GnomonRay>& rays);

    /// All triangles that a ray hits or could be taken to hit, whatever its interval.
    const std::vector<Candidate>& candidates(std::size_t ray) const { return candidates_[ray]; }

    /// Whether the exact point of another hit within the interval comes before that of the triangle answered; as far as doubles
    /// tell.
    bool is_beaten(std::size_t ray, const GnomonHit& answer) const;

    /// One verdict a ray. Engines mostly agree: an answer that was judged before is not judged again.
    std::vector<Verdict> judge(const std::vector<GnomonHit>& hits, Contract contract);

    /// An answer beside the truth, in words.
    std::string describe(std::size_t ray, const GnomonHit& answer, const Verdict& verdict) const;

private:
    struct Judged {
        GnomonHit answer;
        Contract contract;
        Verdict verdict;
    };

    Verdict judge_one(std::size_t ray, const GnomonHit& answer, Contract contract);

    const std::vector<GnomonRay>& rays_;
    Oracle oracle_;
    std::vector<std::vector<Candidate>> candidates_;
    std::vector<std::vector<Judged>> judged_;
};

}  // namespace harness
