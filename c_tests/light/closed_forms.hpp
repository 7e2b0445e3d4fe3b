// What arrives from an evenly bright shape, in closed form: written apart from the library, which is judged by it.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace harness {

/// The projected solid angle [sr] of a planar polygon above the horizon of `normal`, a unit vector; positive where its vertices
/// go clockwise, seen from the point. Source: Lambert 1760, "Photometria".
double projected_polygon_sr(const Vec3d& point, const Vec3d& normal, const std::vector<Vec3d>& vertices);

/// Of the part of a sphere on the side of `side`, a unit vector across a plane through the point; all of it above the horizon.
/// The contour integral of r x dr / 2 around that part of the disc: an arc of its border and one of the plane's great circle.
double projected_half_sphere_sr(const Vec3d& point, const Vec3d& normal, const Vec3d& centre, double radius, const Vec3d& side);

}  // namespace harness
