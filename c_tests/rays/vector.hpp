// Three doubles as a vector: what cameras and sampling need, no more.
#pragma once

#include <cmath>

#include "scene/scene.hpp"

namespace harness {

inline Vec3d operator+(const Vec3d& a, const Vec3d& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3d operator-(const Vec3d& a, const Vec3d& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3d operator-(const Vec3d& a) { return {-a[0], -a[1], -a[2]}; }
inline Vec3d operator*(double s, const Vec3d& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vec3d& a, const Vec3d& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vec3d& a) { return std::hypot(a[0], a[1], a[2]); }
inline Vec3d normalized(const Vec3d& a) { return (1 / length(a)) * a; }
inline Vec3d to_double(const Vec3f& a) { return {a[0], a[1], a[2]}; }
inline Vec3d to_double(const float (&a)[3]) { return {a[0], a[1], a[2]}; }
inline Vec3f to_float(const Vec3d& a) { return {float(a[0]), float(a[1]), float(a[2])}; }

}  // namespace harness
