// Closed meshes seen from inside: every ray must hit something.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "gnomon.h"
#include "harness/rng.hpp"
#include "oracle/oracle.hpp"
#include "scene/scene.hpp"

namespace harness {

/// A closed mesh and points that are inside it for certain.
class Room {
public:
    Room(Scene scene, Rng& rng);

    const Scene& scene() const { return scene_; }
    const Vec3f& point(Rng& rng) const { return points_[rng.below(points_.size())]; }

    /// Two vertices of a random triangle; each edge has two triangles.
    std::pair<Vec3f, Vec3f> edge(Rng& rng) const;

private:
    Scene scene_;
    std::vector<Vec3f> points_;
};

/// How a class of accuracy.md aims from inside.
using Aim = GnomonRay (*)(const Room&, Rng&);

/// `count` rays with a direction: far from the origin a target may round to the point inside.
std::vector<GnomonRay> aim_all(const Room& room, Aim aim, std::size_t count, Rng& rng);

/// One of accuracy.md's classes of rays in closed meshes.
struct RoomClass {
    int number;
    std::string name;
    std::vector<Scene> (*make_meshes)();
    Aim aim;
};
const std::vector<RoomClass>& room_classes();

}  // namespace harness
