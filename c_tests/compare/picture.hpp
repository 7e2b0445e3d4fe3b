// What a scene looks like, so that people see that it loaded right.
#pragma once

#include <string>

#include "backend/backend.hpp"
#include "rays/rays.hpp"

namespace harness {

constexpr int picture_width = 480, picture_height = 360;

/// The bytes of a PNG file: the scene as grey clay, lit from the camera's upper left, transparent where there is nothing.
std::string render_picture(Backend& backend, const Camera& camera);

}  // namespace harness
