#include "hard/cases.hpp"

#include <algorithm>

namespace harness {

const std::vector<HardCase>& hard_cases() {
    static const std::vector<HardCase> cases = [] {
        std::vector<HardCase> all;
        for (const auto& part :
             {closed_mesh_cases(), aligned_cases(), interval_cases(), shape_cases(), symmetry_cases(), range_cases(),
              invalid_ray_cases(), crowd_cases(), agreement_cases(), walk_cases(), report_cases()})
            all.insert(all.end(), part.begin(), part.end());
        std::ranges::stable_sort(all, {}, &HardCase::number);
        return all;
    }();
    return cases;
}

}  // namespace harness
