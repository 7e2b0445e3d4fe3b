// Plain Monte Carlo, which knows no closed form: what gnomon_irradiance is compared with.
#pragma once

#include <string>
#include <vector>

#include "light/half_hidden.hpp"

namespace harness {

struct PlainEstimate {
    double illuminance_lx, standard_error_lx;
};

/// How directions are chosen: each with its density, by the library's gnomon_sample_*.
enum class PlainSampling {
    sphere,             // of all directions
    cosine_hemisphere,  // as a Lambertian surface scatters
    lamp,               // gnomon_sample_triangle or, where the lamp is a sphere, _cone
};
const char* name_of(PlainSampling sampling);

/// The lamp alone, as a surface. Throws std::runtime_error with the library's words.
SceneHandle build_lamp(const HalfHidden& place);

/// Rays that find the lamp and are not stopped by the screen before. Throws as above.
PlainEstimate plain_irradiance(const HalfHidden& place, const GnomonScene* lamp, const GnomonScene* screen,
                               PlainSampling sampling, std::uint64_t sample_count, std::uint64_t seed);

}  // namespace harness
