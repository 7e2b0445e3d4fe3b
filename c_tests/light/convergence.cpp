#include "light/convergence.hpp"

#include <algorithm>
#include <cmath>

#include "backend/trace_loop.hpp"
#include "light/plain.hpp"

namespace harness {
namespace {

constexpr std::uint64_t least_samples = 1 << 8;
constexpr std::size_t fewest_places = 16, most_places = 256;
// So that a row of few samples has more places, and a smoother figure.
constexpr std::uint64_t samples_of_row = 1 << 22;

struct Estimator {
    std::string name;
    std::function<PlainEstimate(const HalfHidden&, const GnomonScene* lamp, const GnomonScene* screen, std::uint64_t sample_count,
                                std::uint64_t seed)>
        estimate;
};

std::vector<Estimator> estimators() {
    std::vector<Estimator> all{{"gnomon_irradiance", [](const auto& place, auto*, auto* screen, auto sample_count, auto seed) {
                                    const GnomonIrradiance answer = irradiance_at(place, screen, sample_count, seed, 1);
                                    return PlainEstimate{answer.illuminance_lx, answer.standard_error_lx};
                                }}};
    for (const PlainSampling sampling : {PlainSampling::lamp, PlainSampling::cosine_hemisphere, PlainSampling::sphere})
        all.push_back({name_of(sampling), [=](const auto& place, auto* lamp, auto* screen, auto sample_count, auto seed) {
                           return plain_irradiance(place, lamp, screen, sampling, sample_count, seed);
                       }});
    return all;
}

ConvergenceRow measure(LampKind kind, const Estimator& estimator, std::uint64_t sample_count, std::uint64_t seed) {
    const std::size_t place_count = std::clamp(std::size_t(samples_of_row / sample_count), fewest_places, most_places);
    Rng rng(seed + sample_count);  // so that a row is not the beginning of the next one, and the same for every estimator
    double errors = 0, stated = 0, seconds = 0;
    for (std::size_t i = 0; i < place_count; ++i) {
        const HalfHidden place = half_hidden(kind, rng);
        const SceneHandle lamp = build_lamp(place), screen = build_meshes({place.screen});
        const Clock::time_point start = Clock::now();
        const PlainEstimate answer = estimator.estimate(place, lamp.get(), screen.get(), sample_count, rng.next());
        seconds += seconds_since(start);
        errors += std::pow((answer.illuminance_lx - place.visible_lx) / place.whole_lx, 2);
        stated += std::pow(answer.standard_error_lx / place.whole_lx, 2);
    }
    const double count = double(place_count);
    return {name_of(kind),  estimator.name, sample_count, place_count, std::sqrt(errors / count), std::sqrt(stated / count),
            seconds / count};
}

}  // namespace

std::vector<ConvergenceRow> measure_convergence(std::uint64_t most_samples, std::uint64_t seed,
                                                const std::function<void(const std::string&)>& tell) {
    std::vector<ConvergenceRow> rows;
    for (const LampKind kind : {LampKind::rectangle, LampKind::sphere}) {
        for (const Estimator& estimator : estimators()) {
            tell(std::string(name_of(kind)) + ", " + estimator.name);
            for (std::uint64_t sample_count = least_samples; sample_count <= most_samples; sample_count *= 4)
                rows.push_back(measure(kind, estimator, sample_count, seed));
        }
    }
    return rows;
}

}  // namespace harness
