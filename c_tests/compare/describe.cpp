#include "compare/describe.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace harness {
namespace {

std::string hex(float value) {
    char buffer[32];
    std::snprintf(buffer, sizeof buffer, "%a", static_cast<double>(value));
    return buffer;
}

std::string triangle_text(std::uint32_t geometry_id, std::uint32_t primitive_id, float t) {
    return "geometry " + std::to_string(geometry_id) + ", primitive " + std::to_string(primitive_id) + ", t " + hex(t);
}

}  // namespace

std::string ray_text(const GnomonRay& ray) {
    const std::array words = {ray.origin[0],    ray.origin[1],    ray.origin[2],    ray.t_min,
                              ray.direction[0], ray.direction[1], ray.direction[2], ray.t_max};
    std::string text;
    for (const float word : words) text += (text.empty() ? "" : ",") + hex(word);
    return text;
}

std::string hit_text(const GnomonHit& hit) {
    if (hit.geometry_id == GNOMON_INVALID_ID) return "miss";
    return triangle_text(hit.geometry_id, hit.primitive_id, hit.t) + ", u " + hex(hit.u) + ", v " + hex(hit.v);
}

std::string truth_text(const Oracle& oracle, const GnomonRay& ray) {
    constexpr std::size_t listed = 3;
    const std::vector<Candidate> hits = oracle.hits(ray);
    std::string text;
    for (std::size_t i = 0; i < std::min(listed, hits.size()); ++i) {
        text += (i == 0 ? "" : "; then ") + triangle_text(hits[i].geometry_id, hits[i].primitive_id, hits[i].t);
        if (hits[i].in_band) text += " (in the band)";
    }
    if (hits.size() > listed) text += "; and " + std::to_string(hits.size() - listed) + " more";
    return hits.empty() ? "miss" : text;
}

std::string verdict_text(const Verdict& verdict) {
    std::string text;
    const auto add = [&text](bool holds, const char* what) {
        if (holds) text += (text.empty() ? "" : ", ") + std::string(what);
    };
    add(verdict.missed, "missed");
    add(verdict.false_hit, "false hit");
    add(verdict.wrong_primitive, "wrong primitive");
    add(verdict.tie, "tie");
    add(verdict.outside_contract, "outside the contract");
    return text.empty() ? "right" : text;
}

}  // namespace harness
