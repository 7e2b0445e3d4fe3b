// The generators behind generate_scene(). Each makes about `triangle_count` triangles and the same scene on every call.
#pragma once

#include <cstddef>

#include "scene/scene.hpp"

namespace harness {

// generate_closed.cpp: one surface without a border
Scene make_icosphere(std::size_t triangle_count);
Scene make_uv_sphere(std::size_t triangle_count);
Scene make_cube_grid(std::size_t triangle_count);
Scene make_torus(std::size_t triangle_count);
Scene make_fan_valence(std::size_t triangle_count);
Scene make_shells(std::size_t triangle_count);

// generate_loose.cpp: triangles and tubes that hold nothing together
Scene make_soup(std::size_t triangle_count);
Scene make_needles(std::size_t triangle_count);
Scene make_identical(std::size_t triangle_count);
Scene make_hair(std::size_t triangle_count);

// generate_places.cpp: ground, and things on it
Scene make_height_field(std::size_t triangle_count);
Scene make_terrain(std::size_t triangle_count);
Scene make_teapot_in_stadium(std::size_t triangle_count);
Scene make_interior(std::size_t triangle_count);

}  // namespace harness
