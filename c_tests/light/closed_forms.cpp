#include "light/closed_forms.hpp"

#include <algorithm>
#include <cmath>

#include "rays/vector.hpp"

namespace harness {
namespace {

/// Relative to the point, without what lies below the horizon.
std::vector<Vec3d> above_horizon(const Vec3d& point, const Vec3d& normal, const std::vector<Vec3d>& vertices) {
    std::vector<Vec3d> kept;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const Vec3d from = vertices[i] - point, to = vertices[(i + 1) % vertices.size()] - point;
        const double height = dot(normal, from), next_height = dot(normal, to);
        if (height > 0) kept.push_back(from);
        if ((height > 0) != (next_height > 0)) kept.push_back(from + (height / (height - next_height)) * (to - from));
    }
    return kept;
}

}  // namespace

double projected_polygon_sr(const Vec3d& point, const Vec3d& normal, const std::vector<Vec3d>& vertices) {
    const std::vector<Vec3d> rays = above_horizon(point, normal, vertices);
    double sum = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Vec3d across = cross(rays[(i + 1) % rays.size()], rays[i]);
        const double area = length(across);
        if (area > 0) sum += std::atan2(area, dot(rays[i], rays[(i + 1) % rays.size()])) * dot(normal, across) / area;
    }
    return -sum / 2;
}

double projected_half_sphere_sr(const Vec3d& point, const Vec3d& normal, const Vec3d& centre, double radius, const Vec3d& side) {
    const double distance = length(centre - point);
    const Vec3d axis = (1 / distance) * (centre - point);
    const double sine = radius / distance, cosine = std::sqrt((1 - sine) * (1 + sine));
    const double height = dot(side, axis), slope = std::sqrt((1 - height) * (1 + height));
    // Where the plane cuts the border of the disc, as an angle around the axis from the middle of the visible part.
    const double cut = std::acos(std::clamp(-height * cosine / (slope * sine), -1.0, 1.0));
    const Vec3d middle = (1 / slope) * (side - height * axis);
    const Vec3d border = (cut * sine * sine) * axis - (sine * cosine * std::sin(cut)) * middle;
    const Vec3d chord = std::asin(std::min(1.0, sine * std::sin(cut))) * side;
    return dot(normal, border + chord);
}

}  // namespace harness
