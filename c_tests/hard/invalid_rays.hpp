// The ways in which a ray can be no ray.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "gnomon.h"

namespace harness {

struct InvalidRay {
    std::string name;
    std::function<GnomonRay(GnomonRay)> spoil;
};

/// NaN and both infinities in each field where they are not valid: t_max may be inf and t_min -inf.
inline const std::vector<InvalidRay>& invalid_rays() {
    static const std::vector<InvalidRay> kinds = [] {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        std::vector<InvalidRay> list;
        for (const float bad : {std::numeric_limits<float>::quiet_NaN(), infinity, -infinity}) {
            for (int axis = 0; axis < 3; ++axis) {
                const auto at = "[" + std::to_string(axis) + "] = " + std::to_string(bad);
                list.push_back({"origin" + at, [=](GnomonRay ray) {
                                    ray.origin[axis] = bad;
                                    return ray;
                                }});
                list.push_back({"direction" + at, [=](GnomonRay ray) {
                                    ray.direction[axis] = bad;
                                    return ray;
                                }});
            }
            if (bad != -infinity)
                list.push_back({"t_min = " + std::to_string(bad), [=](GnomonRay ray) {
                                    ray.t_min = bad;
                                    return ray;
                                }});
            if (bad != infinity)
                list.push_back({"t_max = " + std::to_string(bad), [=](GnomonRay ray) {
                                    ray.t_max = bad;
                                    return ray;
                                }});
        }
        return list;
    }();
    return kinds;
}

}  // namespace harness
