// Light: quantities, solid angles, sampled directions, and what arrives from sources; and every misuse named.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <numbers>
#include <string>
#include <thread>
#include <vector>

#include "api/fixtures.hpp"

using namespace harness;

namespace {

constexpr double kPi = std::numbers::pi;
const float kOrigin[3] = {0, 0, 0};
const float kUp[3] = {0, 0, 1};

doctest::Approx near(double value) { return doctest::Approx(value).epsilon(1e-12); }

/// The call is refused with just that sentence.
void refuses(GnomonStatus status, const std::string& message) {
    CHECK(status == GNOMON_ERROR_INVALID_ARGUMENT);
    CHECK(last_error() == message);
}

/// Likewise of a call that gives a number.
void refuses(double number, const std::string& message) {
    CHECK(std::isnan(number));
    CHECK(last_error() == message);
}

GnomonSources no_sources() {
    GnomonSources sources{};
    sources.struct_size = sizeof sources;
    return sources;
}

GnomonSources of(const std::vector<GnomonPointSource>& points) {
    GnomonSources sources = no_sources();
    sources.points = points.data(), sources.point_count = points.size();
    return sources;
}
GnomonSources of(const std::vector<GnomonSpotSource>& spots) {
    GnomonSources sources = no_sources();
    sources.spots = spots.data(), sources.spot_count = spots.size();
    return sources;
}
GnomonSources of(const std::vector<GnomonDirectionalSource>& directionals) {
    GnomonSources sources = no_sources();
    sources.directionals = directionals.data(), sources.directional_count = directionals.size();
    return sources;
}
GnomonSources of(const std::vector<GnomonSphereSource>& spheres) {
    GnomonSources sources = no_sources();
    sources.spheres = spheres.data(), sources.sphere_count = spheres.size();
    return sources;
}
GnomonSources of(const std::vector<GnomonAreaSource>& areas) {
    GnomonSources sources = no_sources();
    sources.areas = areas.data(), sources.area_count = areas.size();
    return sources;
}

const GnomonPointSource kPoint{{0, 0, 2}, 100, 0};
const GnomonSpotSource kSpot{{0, 0, 2}, 100, {0, 0, -1}, 0, 0, 0.5f};
const GnomonDirectionalSource kDirectional{{0, 0, -1}, 100};
const GnomonSphereSource kSphere{{0, 0, 2}, 0.5f, 100};

/// (-1, -1, 2) to (1, 1, 2), shining down.
const TriangleMesh kCeiling{{-1, -1, 2, -1, 1, 2, 1, 1, 2, 1, -1, 2}, {0, 1, 2, 0, 2, 3}};

GnomonAreaSource lamp(const TriangleMesh& mesh, float luminance_nt = 100) { return {mesh.view(), luminance_nt, 0}; }

GnomonIrradianceOptions irradiance_options(std::uint64_t sample_count) {
    GnomonIrradianceOptions options;
    gnomon_irradiance_options_init(&options);
    options.sample_count = sample_count;
    return options;
}

/// At the origin, from above.
GnomonIrradiance irradiance(const GnomonScene* scene, const GnomonSources& sources,
                            const GnomonIrradianceOptions* options = nullptr) {
    GnomonIrradiance answer;
    std::memset(&answer, 0xA5, sizeof answer);
    REQUIRE_MESSAGE(gnomon_irradiance(scene, &sources, kOrigin, kUp, options, &answer) == GNOMON_OK, last_error());
    return answer;
}

bool same_bits(const GnomonIrradiance& a, const GnomonIrradiance& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

void irradiance_fails(const GnomonSources& sources, const std::string& message, const float (&point)[3] = kOrigin,
                      const float (&normal)[3] = kUp) {
    const SceneHandle scene = build_scene({unit_triangle(-1)});
    for (const GnomonScene* each : {static_cast<const GnomonScene*>(nullptr), static_cast<const GnomonScene*>(scene.get())}) {
        GnomonIrradiance answer{7, 7, 7};
        refuses(gnomon_irradiance(each, &sources, point, normal, nullptr, &answer), message);
        CHECK(same_bits(answer, {7, 7, 7}));
    }
}

template <class Source>
void source_fails(Source source, const std::string& message) {
    const Source good = [] {
        if constexpr (std::is_same_v<Source, GnomonPointSource>) return kPoint;
        if constexpr (std::is_same_v<Source, GnomonSpotSource>) return kSpot;
        if constexpr (std::is_same_v<Source, GnomonDirectionalSource>) return kDirectional;
        if constexpr (std::is_same_v<Source, GnomonSphereSource>) return kSphere;
        if constexpr (std::is_same_v<Source, GnomonAreaSource>) return lamp(kCeiling);
    }();
    irradiance_fails(of(std::vector<Source>{good, good, good, source}), message);
}

}  // namespace

TEST_CASE("luminous_quantities_follow_from_radiant_ones") {
    CHECK(GNOMON_MAX_LUMINOUS_EFFICACY_LM_PER_W == 683);
    CHECK(gnomon_photopic_luminosity(555) == 1);
    CHECK(gnomon_photopic_luminosity(510) == near(0.503));
    CHECK(gnomon_photopic_luminosity(510.5) == near((gnomon_photopic_luminosity(510) + gnomon_photopic_luminosity(511)) / 2));
    for (const double dark : {359.0, 831.0, -1.0, HUGE_VAL, std::nan("")}) CHECK(gnomon_photopic_luminosity(dark) == 0);
    CHECK(gnomon_luminous_flux_lm(2, 555) == 1366);
    CHECK(gnomon_luminous_flux_lm(1, 1064) == 0);
}

TEST_CASE("efficacy_of_a_spectrum_is_that_of_its_line_or_its_mean") {
    const auto efficacy = [](const std::vector<double>& wavelengths_nm, const std::vector<double>& powers) {
        double value = 7;
        REQUIRE(gnomon_luminous_efficacy_lm_per_w(wavelengths_nm.data(), powers.data(), powers.size(), &value) == GNOMON_OK);
        return value;
    };
    CHECK(efficacy({555}, {3}) == 683);
    CHECK(efficacy({1000, 2000}, {1, 1}) == 0);
    // Equal energy: the sum of V over its nanometres, 106.857, over the width.
    CHECK(efficacy({360, 830}, {5, 5}) == doctest::Approx(683 * 106.857 / 470).epsilon(1e-5));
    CHECK(efficacy({360, 830}, {1e308, 1e308}) == near(efficacy({360, 830}, {5, 5})));
    CHECK(efficacy({360, 830}, {5e-324, 5e-324}) == near(efficacy({360, 830}, {5, 5})));
    CHECK(efficacy({555, 556, 557}, {0, 1, 0}) == doctest::Approx(683 * gnomon_photopic_luminosity(556)).epsilon(1e-3));
}

TEST_CASE("spectra_that_are_none_are_named") {
    double value = 7;
    const auto fails = [&](std::vector<double> wavelengths_nm, const std::vector<double>& powers, const std::string& message) {
        refuses(gnomon_luminous_efficacy_lm_per_w(wavelengths_nm.data(), powers.data(), powers.size(), &value), message);
    };
    fails({}, {}, "a spectrum needs a power for each of at least one wavelength: 0 wavelengths, 0 powers");
    fails({500, 500}, {1, 1}, "wavelength 1 is 500 nm, not finite, above 0 and above the one before it");
    fails({500, std::nan("")}, {1, 1}, "wavelength 1 is NaN nm, not finite, above 0 and above the one before it");
    fails({0}, {1}, "wavelength 0 is 0 nm, not finite, above 0 and above the one before it");
    fails({500, 600, 700}, {1, 1, -2}, "spectral power 2 is -2, not a finite number from 0 on");
    fails({500, 600}, {HUGE_VAL, 1}, "spectral power 0 is inf, not a finite number from 0 on");
    fails({500, 600}, {0, 0}, "the spectrum has no power at any wavelength");
    const double one = 1;
    refuses(gnomon_luminous_efficacy_lm_per_w(nullptr, &one, 1, &value), "wavelengths_nm is null, but the count is 1");
    refuses(gnomon_luminous_efficacy_lm_per_w(&one, nullptr, 1, &value), "spectral_powers is null, but the count is 1");
    refuses(gnomon_luminous_efficacy_lm_per_w(&one, &one, 1, nullptr), "efficacy_out is null");
    CHECK(value == 7);
}

TEST_CASE("intensities_and_exitances_of_even_sources") {
    CHECK(gnomon_isotropic_intensity_cd(815) == doctest::Approx(64.9).epsilon(1e-3));
    CHECK(gnomon_isotropic_intensity_cd(4 * kPi) == near(1));
    CHECK(gnomon_isotropic_flux_lm(gnomon_isotropic_intensity_cd(815)) == near(815));
    CHECK(gnomon_isotropic_intensity_w_per_sr(4 * kPi) == near(1));
    CHECK(gnomon_isotropic_flux_w(1) == near(4 * kPi));
    CHECK(gnomon_lambertian_luminance_nt(kPi) == near(1));
    CHECK(gnomon_lambertian_exitance_lm_per_m2(1) == near(kPi));
    CHECK(gnomon_lambertian_radiance_w_per_m2_sr(kPi) == near(1));
    CHECK(gnomon_lambertian_exitance_w_per_m2(2) == near(2 * kPi));
}

TEST_CASE("flux_of_a_spot_is_the_integral_of_what_it_sends") {
    for (const auto& [inner, outer] : {std::pair{0.0, kPi / 2}, {0.3, 0.9}, {0.5, 0.5001}}) {
        double flux = 7, intensity = 7, sum = 0;
        REQUIRE(gnomon_spot_flux_lm(10, inner, outer, &flux) == GNOMON_OK);
        REQUIRE(gnomon_spot_intensity_cd(flux, inner, outer, &intensity) == GNOMON_OK);
        CHECK(intensity == near(10));
        constexpr int kRings = 100'000;
        const double width = outer / kRings;
        for (int ring = 0; ring < kRings; ++ring) {
            const double theta = (ring + 0.5) * width;
            sum += 10 * gnomon_spot_attenuation(theta, inner, outer) * gnomon_differential_solid_angle_sr(theta, width, 2 * kPi);
        }
        CHECK(flux == doctest::Approx(sum).epsilon(1e-4));
    }
}

TEST_CASE("attenuation_of_spots_and_ranges_is_that_of_gltf") {
    CHECK(gnomon_spot_attenuation(0.2, 0.3, 0.9) == 1);
    CHECK(gnomon_spot_attenuation(0.9, 0.3, 0.9) == 0);
    const double share = (std::cos(0.6) - std::cos(0.9)) / (std::cos(0.3) - std::cos(0.9));
    CHECK(gnomon_spot_attenuation(0.6, 0.3, 0.9) == near(share * share));
    CHECK(gnomon_range_attenuation(1, 2) == 1 - 1.0 / 16);
    CHECK(gnomon_range_attenuation(2, 2) == 0);
    CHECK(gnomon_range_attenuation(3, 2) == 0);
    CHECK(gnomon_range_attenuation(1e30, 0) == 1);
    CHECK(gnomon_range_attenuation(1e30, HUGE_VAL) == 1);
}

TEST_CASE("cones_of_spots_that_are_none_are_named") {
    const std::string rest = ", not 0 <= inner < outer <= pi / 2 (KHR_lights_punctual)";
    double value = 7;
    refuses(gnomon_spot_attenuation(0.1, 0.5, 0.5), "inner_cone_rad is 0.5 and outer_cone_rad 0.5" + rest);
    refuses(gnomon_spot_attenuation(0.1, -0.5, 0.5), "inner_cone_rad is -0.5 and outer_cone_rad 0.5" + rest);
    refuses(gnomon_spot_flux_lm(1, 0, 1.75, &value), "inner_cone_rad is 0 and outer_cone_rad 1.75" + rest);
    refuses(gnomon_spot_intensity_cd(1, 0, std::nan(""), &value), "inner_cone_rad is 0 and outer_cone_rad NaN" + rest);
    refuses(gnomon_spot_flux_lm(1, 0, 1, nullptr), "flux_lm_out is null");
    refuses(gnomon_spot_intensity_cd(1, 0, 1, nullptr), "intensity_cd_out is null");
    CHECK(value == 7);
}

TEST_CASE("solid_angles_of_patches_cones_caps_and_spheres") {
    CHECK(gnomon_differential_solid_angle_sr(kPi / 2, 0.5, 0.25) == 0.125);
    CHECK(gnomon_patch_solid_angle_sr(0, kPi, 0, 2 * kPi) == near(4 * kPi));
    CHECK(gnomon_patch_solid_angle_sr(0, kPi / 2, 0, kPi / 2) == near(kPi / 2));
    CHECK(gnomon_cone_solid_angle_sr(kPi) == near(4 * kPi));
    CHECK(gnomon_cone_solid_angle_sr(kPi / 3) == near(kPi));
    CHECK(gnomon_cone_solid_angle_sr(1e-9) == near(kPi * 1e-18));
    CHECK(gnomon_cap_solid_angle_sr(1, 1) == near(2 * kPi));
    CHECK(gnomon_sphere_solid_angle_sr(2, 1) == near(2 * kPi * (1 - std::sqrt(0.75))));
    CHECK(gnomon_sphere_solid_angle_sr(1, 1) == near(2 * kPi));
    CHECK(gnomon_sphere_solid_angle_sr(0.5, 1) == near(4 * kPi));
    for (const double bad : {-0.1, 3.2, std::nan("")}) CHECK(std::isnan(gnomon_cone_solid_angle_sr(bad)));
    for (const double bad : {-0.1, 2.1, std::nan("")}) CHECK(std::isnan(gnomon_cap_solid_angle_sr(bad, 1)));
    for (const double bad : {-0.1, std::nan("")}) CHECK(std::isnan(gnomon_sphere_solid_angle_sr(1, bad)));
}

TEST_CASE("solid_angles_of_triangles_polygons_and_boxes") {
    const float a[3] = {1, 0, 0}, b[3] = {0, 1, 0}, c[3] = {0, 0, 1};
    CHECK(gnomon_triangle_solid_angle_sr(kOrigin, a, b, c) == near(kPi / 2));
    CHECK(gnomon_triangle_solid_angle_sr(kOrigin, c, b, a) == near(kPi / 2));
    const float third[3] = {0.25f, 0.25f, 0.5f}, beside[3] = {2, -1, 0};
    CHECK(gnomon_triangle_solid_angle_sr(third, a, b, c) == near(2 * kPi));
    CHECK(gnomon_triangle_solid_angle_sr(beside, a, b, c) == 0);
    // A cube's face from its centre; an L of three squares of it.
    const std::vector<float> face{-1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
    const std::vector<float> l{-1, -1, 1, 1, -1, 1, 1, 0, 1, 0, 0, 1, 0, 1, 1, -1, 1, 1};
    const auto polygon = [](const std::vector<float>& vertices) {
        double value = 7;
        REQUIRE(gnomon_polygon_solid_angle_sr(kOrigin, vertices.data(), vertices.size() / 3, &value) == GNOMON_OK);
        return value;
    };
    CHECK(polygon(face) == near(4 * kPi / 6));
    CHECK(polygon(l) == near(kPi / 2));
    CHECK(polygon({1, 0, 0, 0, 1, 0}) == 0);
    CHECK(polygon({}) == 0);
    const float lower[3] = {-1, -1, -1}, upper[3] = {1, 1, 1}, on_face[3] = {1, 0, 0}, on_edge[3] = {1, 1, 0}, far[3] = {0, 0, 2};
    CHECK(gnomon_box_solid_angle_sr(kOrigin, lower, upper) == near(4 * kPi));
    CHECK(gnomon_box_solid_angle_sr(on_face, lower, upper) == near(2 * kPi));
    CHECK(gnomon_box_solid_angle_sr(on_edge, lower, upper) == near(kPi));
    CHECK(gnomon_box_solid_angle_sr(upper, lower, upper) == near(kPi / 2));
    CHECK(gnomon_box_solid_angle_sr(far, lower, upper) == near(polygon(face)));
    CHECK(gnomon_box_solid_angle_sr(kOrigin, upper, lower) == 0);
}

TEST_CASE("what_has_no_solid_angle_is_named") {
    const float a[3] = {1, 0, 0}, b[3] = {0, 1, 0}, bad[3] = {0, kNan, 1}, far[3] = {kInfinity, 0, 0};
    refuses(gnomon_triangle_solid_angle_sr(nullptr, a, b, kUp), "point is null");
    refuses(gnomon_triangle_solid_angle_sr(kOrigin, nullptr, b, kUp), "a is null");
    refuses(gnomon_triangle_solid_angle_sr(kOrigin, a, nullptr, kUp), "b is null");
    refuses(gnomon_triangle_solid_angle_sr(kOrigin, a, b, nullptr), "c is null");
    refuses(gnomon_triangle_solid_angle_sr(bad, a, b, kUp), "point is (0, NaN, 1), which is not finite");
    refuses(gnomon_triangle_solid_angle_sr(kOrigin, a, far, kUp), "b is (inf, 0, 0), which is not finite");
    refuses(gnomon_box_solid_angle_sr(nullptr, a, b), "point is null");
    refuses(gnomon_box_solid_angle_sr(kOrigin, nullptr, b), "lower is null");
    refuses(gnomon_box_solid_angle_sr(kOrigin, a, nullptr), "upper is null");
    refuses(gnomon_box_solid_angle_sr(kOrigin, far, b), "lower is (inf, 0, 0), which is not finite");
    double value = 7;
    const std::vector<float> vertices{1, 0, 0, 0, 1, 0, 0, kNan, 1};
    refuses(gnomon_polygon_solid_angle_sr(nullptr, vertices.data(), 3, &value), "point is null");
    refuses(gnomon_polygon_solid_angle_sr(kOrigin, nullptr, 3, &value), "vertices is null, but the count is 3");
    refuses(gnomon_polygon_solid_angle_sr(kOrigin, vertices.data(), 3, nullptr), "solid_angle_sr_out is null");
    refuses(gnomon_polygon_solid_angle_sr(kOrigin, vertices.data(), 3, &value),
            "vertex 2: position is (0, NaN, 1), which is not finite");
    refuses(gnomon_polygon_solid_angle_sr(kOrigin, vertices.data(), SIZE_MAX, &value),
            "vertices: 18446744073709551615 of 12 bytes each do not fit in memory");
    CHECK(value == 7);
}

namespace {

/// Each way to sample a direction around +z, with its density where it is the same all over.
struct Sampling {
    std::string name;
    std::function<GnomonStatus(const float*, double, double, GnomonDirectionSample*)> sample;
    double density_per_sr, least_z;
};

const std::vector<Sampling>& samplings() {
    static const float a[3] = {1, 0, 1}, b[3] = {0, 1, 1}, c[3] = {-1, -1, 1};
    static const std::vector<Sampling> all{
        {"sphere", [](const float*, double u, double v, auto* out) { return gnomon_sample_sphere(u, v, out); }, 1 / (4 * kPi),
         -1},
        {"hemisphere", gnomon_sample_hemisphere, 1 / (2 * kPi), 0},
        {"cosine", gnomon_sample_cosine_hemisphere, 0, 0},
        {"cone", [](const float* axis, double u, double v, auto* out) { return gnomon_sample_cone(axis, 0.5, u, v, out); },
         1 / gnomon_cone_solid_angle_sr(0.5), std::cos(0.5)},
        {"triangle",
         [](const float*, double u, double v, auto* out) { return gnomon_sample_triangle(kOrigin, a, b, c, u, v, out); },
         1 / gnomon_triangle_solid_angle_sr(kOrigin, a, b, c), 0.5},
    };
    return all;
}

}  // namespace

TEST_CASE("sampled_directions_are_unit_vectors_with_their_density") {
    const float steep[3] = {0, 0, 1e-30f};
    for (const Sampling& sampling : samplings()) {
        CAPTURE(sampling.name);
        for (const double u : {0.0, 0.25, 0.75, 1.0}) {
            for (const double v : {0.0, 0.125, 0.625, 1.0}) {
                GnomonDirectionSample sample{}, same{};
                REQUIRE(sampling.sample(kUp, u, v, &sample) == GNOMON_OK);
                const float* d = sample.direction;
                CHECK(std::hypot(double(d[0]), d[1], d[2]) == doctest::Approx(1).epsilon(1e-7));
                CHECK(d[2] >= sampling.least_z - 1e-7);
                const double expected = sampling.density_per_sr > 0 ? sampling.density_per_sr : double(d[2]) / kPi;
                CHECK(sample.density_per_sr == doctest::Approx(expected).epsilon(1e-6));
                REQUIRE(sampling.sample(steep, u, v, &same) == GNOMON_OK);
                CHECK(std::memcmp(&sample, &same, sizeof sample) == 0);
            }
        }
    }
    GnomonDirectionSample sample{};
    const float a[3] = {1, 0, 0}, b[3] = {2, 0, 0}, c[3] = {1, 1, 0};
    REQUIRE(gnomon_sample_triangle(kOrigin, a, b, c, 0.5, 0.5, &sample) == GNOMON_OK);
    CHECK(sample.density_per_sr == 0);
}

TEST_CASE("numbers_and_directions_that_nothing_is_sampled_from_are_named") {
    GnomonDirectionSample sample{{7, 7, 7}, 7};
    for (const Sampling& sampling : samplings()) {
        CAPTURE(sampling.name);
        refuses(sampling.sample(kUp, 1.5, 0, &sample), "u is 1.5, not in [0, 1]");
        refuses(sampling.sample(kUp, std::nan(""), 0, &sample), "u is NaN, not in [0, 1]");
        refuses(sampling.sample(kUp, 0, -0.5, &sample), "v is -0.5, not in [0, 1]");
        refuses(sampling.sample(kUp, 0, 0, nullptr), "sample_out is null");
    }
    const float bad[3] = {0, kNan, 1};
    refuses(gnomon_sample_hemisphere(nullptr, 0, 0, &sample), "normal is null");
    refuses(gnomon_sample_cosine_hemisphere(nullptr, 0, 0, &sample), "normal is null");
    refuses(gnomon_sample_cone(nullptr, 1, 0, 0, &sample), "axis is null");
    refuses(gnomon_sample_hemisphere(kOrigin, 0, 0, &sample), "normal is (0, 0, 0), which is zero");
    refuses(gnomon_sample_cosine_hemisphere(bad, 0, 0, &sample), "normal is (0, NaN, 1), which is not finite");
    refuses(gnomon_sample_cone(kOrigin, 1, 0, 0, &sample), "axis is (0, 0, 0), which is zero");
    refuses(gnomon_sample_cone(kUp, 0, 0, 0, &sample), "half_angle_rad is 0, not in (0, pi]");
    refuses(gnomon_sample_cone(kUp, 3.25, 0, 0, &sample), "half_angle_rad is 3.25, not in (0, pi]");
    refuses(gnomon_sample_triangle(nullptr, kUp, kUp, kUp, 0, 0, &sample), "point is null");
    refuses(gnomon_sample_triangle(kOrigin, nullptr, kUp, kUp, 0, 0, &sample), "a is null");
    refuses(gnomon_sample_triangle(kOrigin, kUp, nullptr, kUp, 0, 0, &sample), "b is null");
    refuses(gnomon_sample_triangle(kOrigin, kUp, kUp, nullptr, 0, 0, &sample), "c is null");
    refuses(gnomon_sample_triangle(kOrigin, kUp, kUp, bad, 0, 0, &sample), "c is (0, NaN, 1), which is not finite");
    CHECK((sample.direction[0] == 7 && sample.density_per_sr == 7));
}

TEST_CASE("irradiance_options_have_their_defaults") {
    GnomonIrradianceOptions options;
    gnomon_irradiance_options_init(&options);
    CHECK((options.struct_size == sizeof options && options.thread_count == 0 && options.sample_count == 4096 &&
           options.seed == 0));
    gnomon_irradiance_options_init(nullptr);
    CHECK(last_error() == "options_out is null");
}

TEST_CASE("each_kind_of_source_lights_what_is_below_it") {
    // Howell's C-11, four times: a corner of a 1 by 1 rectangle at height 2.
    const double corner = std::atan(1 / std::sqrt(5.0)) / std::sqrt(5.0);
    const SceneHandle empty = build_scene({});
    for (const GnomonScene* scene : {static_cast<const GnomonScene*>(nullptr), static_cast<const GnomonScene*>(empty.get())}) {
        CHECK(irradiance(scene, no_sources()).illuminance_lx == 0);
        CHECK(irradiance(scene, of(std::vector{kPoint})).illuminance_lx == near(25));
        CHECK(irradiance(scene, of(std::vector{kSpot})).illuminance_lx == near(25));
        CHECK(irradiance(scene, of(std::vector{kDirectional})).illuminance_lx == 100);
        CHECK(irradiance(scene, of(std::vector{kSphere})).illuminance_lx == near(100 * kPi / 16));
        CHECK(irradiance(scene, of(std::vector{lamp(kCeiling)})).illuminance_lx == near(100 * 4 * corner));
        const std::vector<GnomonPointSource> two{kPoint, kPoint};
        GnomonSources all = of(two);
        all.directionals = &kDirectional, all.directional_count = 1;
        const GnomonIrradiance sum = irradiance(scene, all);
        CHECK(sum.illuminance_lx == near(150));
        CHECK(sum.standard_error_lx == 0);
        CHECK(sum.ray_count == (scene != nullptr ? 3 : 0));
    }
}

TEST_CASE("lamps_seen_end_on_send_nothing") {
    const SceneHandle beside = build_scene({unit_triangle(-1)});
    const float tilted[3] = {-0.3f, -0.25f, 1};
    const std::vector<std::vector<float>> points{
        {0.25f, 0.5f, 2}, {5, 0, 2}, {1, 0, 2}, {1, 1, 2}};             // inside, outside, edge, vertex
    const TriangleMesh needle{{1, 0, 1, 2, 0, 3, 1, 0, 1}, {0, 1, 2}};  // without an area
    for (const TriangleMesh* mesh : {&kCeiling, &needle}) {
        GnomonAreaSource both_sides = lamp(*mesh);
        both_sides.is_two_sided = 1;
        const std::vector<GnomonAreaSource> lamps{both_sides};
        const GnomonSources sources = of(lamps);
        for (const std::vector<float>& point : points) {
            for (const GnomonScene* scene :
                 {static_cast<const GnomonScene*>(nullptr), static_cast<const GnomonScene*>(beside.get())}) {
                GnomonIrradiance answer{7, 7, 7};
                REQUIRE(gnomon_irradiance(scene, &sources, point.data(), tilted, nullptr, &answer) == GNOMON_OK);
                CHECK((answer.illuminance_lx == 0 && answer.standard_error_lx == 0 && answer.ray_count == 0));
            }
        }
    }
}

TEST_CASE("what_is_in_the_way_is_dark_in_every_configuration") {
    const TriangleMesh half{{-3, -3, 1, 0, -3, 1, 0, 3, 1, -3, 3, 1}, {0, 1, 2, 0, 2, 3}};
    const TriangleMesh whole{{-3, -3, 1, 3, -3, 1, 3, 3, 1, -3, 3, 1}, {0, 1, 2, 0, 2, 3}};
    const std::vector<GnomonAreaSource> ceiling{lamp(kCeiling)};
    GnomonSources all = of(ceiling);
    all.points = &kPoint, all.point_count = 1;
    all.spots = &kSpot, all.spot_count = 1;
    all.directionals = &kDirectional, all.directional_count = 1;
    all.spheres = &kSphere, all.sphere_count = 1;
    const double lit = irradiance(nullptr, of(ceiling)).illuminance_lx;
    GnomonIrradiance first{};
    for (const Configuration& configuration : all_configurations()) {
        CAPTURE(configuration.name);
        // The lamp is part of the scene.
        const GnomonIrradiance dark = irradiance(build_scene({whole, kCeiling}, configuration.options).get(), all);
        CHECK((dark.illuminance_lx == 0 && dark.standard_error_lx == 0));
        const SceneHandle open = build_scene({kCeiling}, configuration.options);
        CHECK(irradiance(open.get(), of(ceiling)).illuminance_lx == lit);
        const GnomonIrradiance partly = irradiance(build_scene({half, kCeiling}, configuration.options).get(), of(ceiling));
        CHECK(std::abs(partly.illuminance_lx - lit / 2) < 4 * partly.standard_error_lx);
        CHECK((partly.ray_count == 4096 && partly.standard_error_lx < 0.01 * lit));
        if (first.ray_count == 0) first = partly;
        CHECK(same_bits(partly, first));
    }
}

TEST_CASE("seeds_differ_and_threads_do_not") {
    const TriangleMesh half{{-3, -3, 1, 0, -3, 1, 0, 3, 1, -3, 3, 1}, {0, 1, 2, 0, 2, 3}};
    const SceneHandle scene = build_scene({half});
    const std::vector<GnomonAreaSource> ceiling{lamp(kCeiling)};
    for (const std::uint64_t sample_count : {2u, 4096u, 4097u, 100'000u}) {
        CAPTURE(sample_count);
        GnomonIrradianceOptions options = irradiance_options(sample_count);
        options.thread_count = 1;
        const GnomonIrradiance alone = irradiance(scene.get(), of(ceiling), &options);
        CHECK(alone.ray_count == sample_count);
        for (const std::uint32_t thread_count : {0u, 2u, 7u}) {
            options.thread_count = thread_count;
            CHECK(same_bits(irradiance(scene.get(), of(ceiling), &options), alone));
        }
        options.seed = 1;
        if (sample_count > 2) CHECK(irradiance(scene.get(), of(ceiling), &options).illuminance_lx != alone.illuminance_lx);
    }
    const GnomonIrradiance expected = irradiance(scene.get(), of(ceiling));
    std::vector<GnomonIrradiance> answers(4);
    std::vector<std::thread> threads;
    for (GnomonIrradiance& answer : answers) {
        threads.emplace_back([&] {
            const GnomonSources sources = of(ceiling);
            gnomon_irradiance(scene.get(), &sources, kOrigin, kUp, nullptr, &answer);
        });
    }
    for (std::thread& thread : threads) thread.join();
    for (const GnomonIrradiance& answer : answers) CHECK(same_bits(answer, expected));
}

TEST_CASE("null_pointers_of_irradiance_are_named") {
    const GnomonSources sources = no_sources();
    GnomonIrradiance answer{7, 7, 7};
    refuses(gnomon_irradiance(nullptr, nullptr, kOrigin, kUp, nullptr, &answer), "sources is null");
    refuses(gnomon_irradiance(nullptr, &sources, nullptr, kUp, nullptr, &answer), "point is null");
    refuses(gnomon_irradiance(nullptr, &sources, kOrigin, nullptr, nullptr, &answer), "normal is null");
    refuses(gnomon_irradiance(nullptr, &sources, kOrigin, kUp, nullptr, nullptr), "irradiance_out is null");
    GnomonSources without = no_sources();
    without.point_count = 1;
    irradiance_fails(without, "points is null, but the count is 1");
    without = no_sources(), without.spot_count = 2;
    irradiance_fails(without, "spots is null, but the count is 2");
    without = no_sources(), without.directional_count = 3;
    irradiance_fails(without, "directionals is null, but the count is 3");
    without = no_sources(), without.sphere_count = 4;
    irradiance_fails(without, "spheres is null, but the count is 4");
    without = no_sources(), without.area_count = 5;
    irradiance_fails(without, "areas is null, but the count is 5");
    CHECK(same_bits(answer, {7, 7, 7}));
}

TEST_CASE("sizes_and_counts_that_are_wrong_are_named") {
    GnomonSources small = no_sources();
    small.struct_size = 4;
    irradiance_fails(small,
                     "GnomonSources: struct_size is 4, not 88; set it to sizeof(GnomonSources), as an _init function does");
    const SceneHandle scene = build_scene({unit_triangle(1)});
    const std::vector<GnomonSphereSource> spheres{kSphere};
    const std::vector<GnomonPointSource> points{kPoint};
    const GnomonSources sources = of(spheres);
    GnomonIrradiance answer{7, 7, 7};
    for (const std::uint64_t sample_count : {0u, 1u}) {
        const GnomonIrradianceOptions options = irradiance_options(sample_count);
        refuses(gnomon_irradiance(scene.get(), &sources, kOrigin, kUp, &options, &answer),
                "sample_count is " + std::to_string(sample_count) + ", not at least 2, for a standard error");
        // Where nothing is sampled it does not matter.
        CHECK(irradiance(scene.get(), of(points), &options).ray_count == 1);
        CHECK(irradiance(nullptr, sources, &options).ray_count == 0);
    }
    GnomonIrradianceOptions options = irradiance_options(16);
    options.struct_size = 3;
    refuses(gnomon_irradiance(nullptr, &sources, kOrigin, kUp, &options, &answer),
            "GnomonIrradianceOptions: struct_size is 3, not 24; set it to sizeof(GnomonIrradianceOptions), as an _init function "
            "does");
    CHECK(same_bits(answer, {7, 7, 7}));
}

TEST_CASE("receivers_that_are_none_are_named") {
    const std::vector<GnomonPointSource> points{kPoint};
    irradiance_fails(of(points), "point is (0, NaN, 1), which is not finite", {0, kNan, 1});
    irradiance_fails(of(points), "point is (inf, 0, 0), which is not finite", {kInfinity, 0, 0});
    irradiance_fails(of(points), "normal is (0, 0, 0), which is zero", {0, 0, 0}, {0, 0, 0});
    irradiance_fails(of(points), "normal is (0, 0, NaN), which is not finite", {0, 0, 0}, {0, 0, kNan});
}

TEST_CASE("sources_that_are_none_are_named_with_their_number") {
    const auto with = [](auto source, auto change) {
        change(source);
        return source;
    };
    source_fails(with(kPoint, [](auto& s) { s.intensity_cd = -1; }),
                 "point source 3: intensity_cd is -1, not a finite number from 0 on");
    source_fails(with(kPoint, [](auto& s) { s.intensity_cd = kInfinity; }),
                 "point source 3: intensity_cd is inf, not a finite number from 0 on");
    source_fails(with(kPoint, [](auto& s) { s.range_m = -2; }),
                 "point source 3: range_m is -2, not above 0 (0 and infinity: no range)");
    source_fails(with(kPoint, [](auto& s) { s.range_m = kNan; }),
                 "point source 3: range_m is NaN, not above 0 (0 and infinity: no range)");
    source_fails(with(kPoint, [](auto& s) { s.position[0] = kNan; }),
                 "point source 3: position is (NaN, 0, 2), which is not finite");
    source_fails(with(kPoint, [](auto& s) { s.position[2] = 0; }),
                 "point source 3: the receiver lies at the source, where there is no irradiance");
    source_fails(with(kSpot, [](auto& s) { s.intensity_cd = kNan; }),
                 "spot source 3: intensity_cd is NaN, not a finite number from 0 on");
    source_fails(with(kSpot, [](auto& s) { s.direction[2] = 0; }), "spot source 3: direction is (0, 0, 0), which is zero");
    source_fails(with(kSpot, [](auto& s) { s.inner_cone_rad = 0.5f; }),
                 "spot source 3: inner_cone_rad is 0.5 and outer_cone_rad 0.5, not 0 <= inner < outer <= pi / 2 "
                 "(KHR_lights_punctual)");
    source_fails(with(kSpot, [](auto& s) { s.outer_cone_rad = 1.75f; }),
                 "spot source 3: inner_cone_rad is 0 and outer_cone_rad 1.75, not 0 <= inner < outer <= pi / 2 "
                 "(KHR_lights_punctual)");
    source_fails(with(kSpot, [](auto& s) { s.range_m = kNan; }),
                 "spot source 3: range_m is NaN, not above 0 (0 and infinity: no range)");
    source_fails(with(kSpot, [](auto& s) { s.position[2] = 0; }),
                 "spot source 3: the receiver lies at the source, where there is no irradiance");
    source_fails(with(kDirectional, [](auto& s) { s.illuminance_lx = -1; }),
                 "directional source 3: illuminance_lx is -1, not a finite number from 0 on");
    source_fails(with(kDirectional, [](auto& s) { s.direction[1] = kInfinity; }),
                 "directional source 3: direction is (0, inf, -1), which is not finite");
    source_fails(with(kDirectional, [](auto& s) { s.direction[2] = 0; }),
                 "directional source 3: direction is (0, 0, 0), which is zero");
    source_fails(with(kSphere, [](auto& s) { s.radius = -1; }), "sphere source 3: radius is -1, not a finite number from 0 on");
    source_fails(with(kSphere, [](auto& s) { s.luminance_nt = kNan; }),
                 "sphere source 3: luminance_nt is NaN, not a finite number from 0 on");
    source_fails(with(kSphere, [](auto& s) { s.centre[1] = kInfinity; }),
                 "sphere source 3: centre is (0, inf, 2), which is not finite");
}

TEST_CASE("lamps_that_are_none_are_named_with_their_triangle") {
    const TriangleMesh& ceiling = kCeiling;
    source_fails(lamp(ceiling, -1), "area source 3: luminance_nt is -1, not a finite number from 0 on");
    GnomonAreaSource both = lamp(ceiling);
    both.is_two_sided = 2;
    source_fails(both, "area source 3: is_two_sided is 2, which has no meaning");
    const TriangleMesh beyond{ceiling.positions, {0, 1, 2, 0, 2, 4}};
    source_fails(lamp(beyond), "area source 3: triangle 1: index 4 is out of range, there are 4 vertices");
    TriangleMesh broken = ceiling;
    broken.positions[10] = kNan;
    source_fails(lamp(broken), "area source 3: triangle 1: vertex is (1, NaN, 2), which is not finite");
    GnomonAreaSource without = lamp(ceiling);
    without.triangles.indices = nullptr;
    source_fails(without, "area source 3: 2 triangles without indices need three vertices each, there are 4");
    without = lamp(ceiling);
    without.triangles.positions = nullptr;
    source_fails(without, "area source 3: positions is null, but the count is 4");
    GnomonAreaSource unknown = lamp(ceiling);
    unknown.triangles.index_format = 9;
    source_fails(unknown, "area source 3: index_format is 9, which has no meaning");
}
