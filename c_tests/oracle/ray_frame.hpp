// A ray with its axes renamed so that z is the one along which it moves the most.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "gnomon.h"
#include "scene/scene.hpp"

namespace harness {

using Triangle = std::array<Vec3f, 3>;

inline bool is_finite(const Vec3f& point) {
    return std::all_of(point.begin(), point.end(), [](float x) { return std::isfinite(x); });
}

/// z is the axis of the largest |direction|, the first of equals (x before y before z); x and y follow it cyclically.
struct RayFrame {
    std::array<std::size_t, 3> axes;
    Vec3f origin, direction;

    explicit RayFrame(const GnomonRay& ray) {
        std::size_t z = 0;
        for (std::size_t axis = 1; axis < 3; ++axis)
            if (std::abs(ray.direction[axis]) > std::abs(ray.direction[z])) z = axis;
        axes = {(z + 1) % 3, (z + 2) % 3, z};
        origin = {ray.origin[axes[0]], ray.origin[axes[1]], ray.origin[axes[2]]};
        direction = {ray.direction[axes[0]], ray.direction[axes[1]], ray.direction[axes[2]]};
    }

    /// Whether all components are finite and the direction is not zero.
    bool is_line() const { return is_finite(origin) && is_finite(direction) && direction[2] != 0; }

    Vec3f rename(const Vec3f& point) const { return {point[axes[0]], point[axes[1]], point[axes[2]]}; }
    Triangle rename(const Triangle& triangle) const { return {rename(triangle[0]), rename(triangle[1]), rename(triangle[2])}; }
};

}  // namespace harness
