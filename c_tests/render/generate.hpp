// Scenes of our own, with lamps and materials.
#pragma once

#include "render/render_scene.hpp"

namespace render {

/// Diffuse, of reflectance 0.5: what has no material gets it.
Material grey_material();

/// A room of 5.5 m, open towards the camera, with a red and a green wall, an area lamp of 5000 nt (1.3 m x 1.05 m, 21 klm) below
/// the ceiling, a ball of glass and one that mirrors. After Goral, Torrance, Greenberg and Battaile 1984.
RenderScene make_cornell();

/// Three balls that reflect or transmit all light, diffuse, mirror and glass, under a sky of 1 nt: seen from anywhere all of it
/// is 1 nt.
RenderScene make_furnace();

}  // namespace render
