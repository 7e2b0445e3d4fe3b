#include "oracle/cull.hpp"

#include <algorithm>
#include <cmath>

namespace harness {
namespace {

/// The low 21 bits, two zeros between each.
std::uint64_t spread_bits(std::uint64_t bits) {
    bits &= 0x1FFFFF;
    bits = (bits | bits << 32) & 0x001F00000000FFFF;
    bits = (bits | bits << 16) & 0x001F0000FF0000FF;
    bits = (bits | bits << 8) & 0x100F00F00F00F00F;
    bits = (bits | bits << 4) & 0x10C30C30C30C30C3;
    bits = (bits | bits << 2) & 0x1249249249249249;
    return bits;
}

std::uint64_t morton_code(const Triangle& triangle, const CullBox& scene) {
    const double extent = std::max({scene.half[0], scene.half[1], scene.half[2]});
    std::uint64_t code = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double sum = static_cast<double>(triangle[0][axis]) + triangle[1][axis] + triangle[2][axis];
        const double position = extent > 0 ? (sum / 3 - scene.centre[axis]) / extent : 0.0;  // in [-1, 1]
        code |= spread_bits(static_cast<std::uint64_t>((position + 1) * 0x0FFFFF)) << axis;
    }
    return code;
}

std::vector<StoredTriangle> finite_triangles(const Scene& scene) {
    std::vector<StoredTriangle> triangles;
    triangles.reserve(scene.triangle_count());
    for (std::uint32_t geometry = 0; geometry < scene.meshes.size(); ++geometry) {
        for (std::uint32_t primitive = 0; primitive < scene.meshes[geometry].triangle_count(); ++primitive) {
            const Triangle triangle = scene.triangle(geometry, primitive);
            if (std::all_of(triangle.begin(), triangle.end(), is_finite)) triangles.push_back({triangle, geometry, primitive});
        }
    }
    return triangles;
}

CullBox bounds(const std::vector<StoredTriangle>& triangles, std::size_t first, std::size_t end) {
    BoxBuilder builder;
    for (std::size_t i = first; i < end; ++i) builder.add(triangles[i].vertices);
    return builder.box();
}

void sort_along_curve(std::vector<StoredTriangle>& triangles) {
    if (triangles.empty()) return;
    const CullBox scene = bounds(triangles, 0, triangles.size());
    std::vector<std::pair<std::uint64_t, std::size_t>> order(triangles.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = {morton_code(triangles[i].vertices, scene), i};
    std::sort(order.begin(), order.end());
    std::vector<StoredTriangle> sorted;
    sorted.reserve(triangles.size());
    for (const auto& [code, index] : order) sorted.push_back(triangles[index]);
    triangles = std::move(sorted);
}

}  // namespace

void BoxBuilder::add(const Triangle& triangle) {
    for (const Vec3f& vertex : triangle) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower_[axis] = std::min(lower_[axis], vertex[axis]);
            upper_[axis] = std::max(upper_[axis], vertex[axis]);
        }
    }
}

CullBox BoxBuilder::box() const {
    CullBox box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double lower = lower_[axis], upper = upper_[axis];
        box.centre[axis] = (lower + upper) / 2;
        box.half[axis] = (upper - lower) / 2;
    }
    return box;
}

Line::Line(const GnomonRay& ray) {
    const double largest = std::abs(RayFrame(ray).direction[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        origin_[axis] = ray.origin[axis];
        direction_[axis] = ray.direction[axis] / largest;
    }
}

// A line misses a box iff the cross product of its direction and some axis separates them (Gottschalk, Lin, Manocha 1996,
// "OBBTree"): no division, so that no infinity or NaN can arise from finite coordinates.
//
// The box is grown by a margin. A triangle that f32 decides to be hit has a point p with |x(p)| and |y(p)| within the band of
// filter.cpp: with R the largest coordinate of the box, from the origin, at most 6u R and an absolute term. The point of the line
// beside p is in the box grown by that. 16u R leaves 10u R for the roundings here, each of them below 2^-50 R.
bool Line::may_meet(const CullBox& box) const {
    constexpr double relative_margin = 16 * 0x1p-24;
    constexpr double absolute_margin = 0x1p-140;  // above the band's 2^-148; its 2^-148 |az| is far below u R
    const Vec3d to_centre{box.centre[0] - origin_[0], box.centre[1] - origin_[1], box.centre[2] - origin_[2]};
    const double reach = std::max(
        {std::abs(to_centre[0]) + box.half[0], std::abs(to_centre[1]) + box.half[1], std::abs(to_centre[2]) + box.half[2]});
    const double margin = reach * relative_margin + absolute_margin;
    const auto overlaps = [&](std::size_t i, std::size_t j) {
        const double distance = std::abs(direction_[j] * to_centre[i] - direction_[i] * to_centre[j]);
        return distance <= std::abs(direction_[j]) * (box.half[i] + margin) + std::abs(direction_[i]) * (box.half[j] + margin);
    };
    return overlaps(0, 1) && overlaps(1, 2) && overlaps(2, 0);
}

CullTree::CullTree(const Scene& scene) : triangles_(finite_triangles(scene)) {
    sort_along_curve(triangles_);
    for (std::size_t width = block_size; !triangles_.empty(); width *= block_size) {
        std::vector<CullBox> level;
        for (std::size_t first = 0; first < triangles_.size(); first += width)
            level.push_back(bounds(triangles_, first, std::min(first + width, triangles_.size())));
        levels_.push_back(std::move(level));
        if (levels_.back().size() <= block_size) break;
    }
}

}  // namespace harness
