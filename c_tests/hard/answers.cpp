#include "hard/answers.hpp"

#include <cstring>

namespace harness {

Rng rng_of(const HardOptions& options, const std::string& name) {
    std::uint64_t seed = Rng(options.seed).next();
    for (const char letter : name) seed = Rng(seed ^ static_cast<unsigned char>(letter)).next();
    return Rng(seed);
}

bool Answers::agree(std::size_t ray) const { return (occluded[ray] != 0) == is_hit(hits[ray]); }

Answers answers_of(Backend& backend, const std::vector<GnomonRay>& rays) {
    Answers answers{std::vector<GnomonHit>(rays.size()), std::vector<std::uint8_t>(rays.size())};
    backend.prepare(rays);
    backend.intersect(CallForm::prefilled, answers.hits, 1);
    backend.occluded(CallForm::prefilled, answers.occluded, 1);
    return answers;
}

bool is_same_hit(const GnomonHit& a, const GnomonHit& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

std::size_t Reference::count_differences(const HardEngine& engine, const std::vector<GnomonHit>& hits) {
    if (!engine.is_exacting()) return 0;
    const auto [reference, is_first] = hits_.try_emplace(engine.precision, hits);
    std::size_t differences = 0;
    for (std::size_t i = 0; i < hits.size(); ++i) differences += !is_same_hit(hits[i], reference->second[i]);
    return is_first ? 0 : differences;
}

}  // namespace harness
