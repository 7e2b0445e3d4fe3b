// Which triangles a line may come near: blocks of triangles under boxes, left out only when the line provably misses the box.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "gnomon.h"
#include "oracle/ray_frame.hpp"
#include "scene/scene.hpp"

namespace harness {

/// Centre and half extent are exact to within the margin of Line::may_meet.
struct CullBox {
    Vec3d centre, half;
};

class BoxBuilder {
public:
    void add(const Triangle& triangle);
    CullBox box() const;

private:
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    Vec3f lower_{infinity, infinity, infinity}, upper_{-infinity, -infinity, -infinity};
};

/// The whole line of a valid ray.
class Line {
public:
    explicit Line(const GnomonRay& ray);

    /// False only where neither exact arithmetic nor f32 could see the line meet a triangle inside the box.
    bool may_meet(const CullBox& box) const;

private:
    Vec3d origin_, direction_;  // direction scaled to a largest component of 1
};

struct StoredTriangle {
    Triangle vertices;
    std::uint32_t geometry_id, primitive_id;
};

/// All triangles with finite vertices, along a Morton curve, in blocks of blocks.
class CullTree {
public:
    explicit CullTree(const Scene& scene);

    const std::vector<StoredTriangle>& triangles() const { return triangles_; }

    /// Calls visit(triangle) for every triangle in a block that the line may meet.
    template <typename Visit>
    void for_each_near(const Line& line, Visit&& visit) const {
        if (!levels_.empty()) descend(line, levels_.size() - 1, 0, levels_.back().size(), visit);
    }

private:
    static constexpr std::size_t block_size = 8;

    template <typename Visit>
    void descend(const Line& line, std::size_t level, std::size_t first, std::size_t end, Visit& visit) const {
        for (std::size_t i = first; i < end; ++i) {
            if (!line.may_meet(levels_[level][i])) continue;
            const std::size_t child = i * block_size;
            if (level == 0) {
                for (std::size_t t = child; t < block_end(child, triangles_.size()); ++t) visit(triangles_[t]);
            } else {
                descend(line, level - 1, child, block_end(child, levels_[level - 1].size()), visit);
            }
        }
    }

    static std::size_t block_end(std::size_t first, std::size_t count) { return std::min(first + block_size, count); }

    std::vector<StoredTriangle> triangles_;
    std::vector<std::vector<CullBox>> levels_;  // levels_[0][i] bounds the triangles from i * block_size on
};

}  // namespace harness
