#include "compare/json.hpp"

#include <cmath>

#include "compare/options.hpp"

namespace harness {
namespace {

using Json = nlohmann::ordered_json;

Json build_json(const SceneResult& scene, const BuildReport& build) {
    const double per_triangle = static_cast<double>(build.bytes) / static_cast<double>(build.triangles);
    return {{"scene", scene.name},      {"triangles", build.triangles},
            {"engine", build.engine},   {"structure", build.structure},
            {"quality", build.quality}, {"precision", build.precision},
            {"isa", build.isa},         {"compact", build.compact},
            {"threads", build.threads}, {"seconds", build.seconds},
            {"bytes", build.bytes},     {"bytes_per_triangle", number(per_triangle)},
            {"nodes", build.nodes},     {"references", build.references},
            {"depth", build.depth}};
}

Json speed_json(const SceneResult& scene, const Speed& speed) {
    const BuildReport& build = scene.builds[speed.build];
    return {{"scene", scene.name},
            {"engine", build.engine},
            {"structure", build.structure},
            {"quality", build.quality},
            {"precision", build.precision},
            {"isa", build.isa},
            {"compact", build.compact},
            {"call", call_form_name(speed.call)},
            {"threads", speed.threads},
            {"rays", speed.ray_count},
            {"ray_kind", speed.ray_kind},
            {"mrays_per_s", number(speed.mrays_per_s())},
            {"ns_per_ray", number(speed.ns_per_ray)},
            {"ratio_to_embree", speed.ratio_to_embree ? number(*speed.ratio_to_embree) : Json(nullptr)},
            {"embree_call", speed.embree_call.empty() ? Json(nullptr) : Json(speed.embree_call)}};
}

Json errors_json(const SceneResult& scene, const Errors& errors) {
    const BuildReport& build = scene.builds[errors.build];
    return {{"scene", scene.name},
            {"engine", build.engine},
            {"structure", build.structure},
            {"quality", build.quality},
            {"precision", build.precision},
            {"ray_kind", errors.ray_kind},
            {"rays", errors.ray_count},
            {"missed", errors.missed},
            {"false_hits", errors.false_hits},
            {"wrong_primitive", errors.wrong_primitive},
            {"outside_contract", errors.outside_contract},
            {"ties", errors.ties},
            {"t_ulp_median", number(errors.t_ulps.median)},
            {"t_ulp_p99", number(errors.t_ulps.p99)},
            {"t_ulp_max", number(errors.t_ulps.max)},
            {"uv_p99", number(errors.uv.p99)},
            {"uv_max", number(errors.uv.max)}};
}

}  // namespace

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json heading_json(const Machine& machine, const Versions& versions) {
    return {
        {"machine", {{"cpu", machine.cpu}, {"cores", machine.cores}, {"isa", machine.isa}, {"os", machine.os}}},
        {"versions",
         {{"gnomon", versions.gnomon},
          {"embree", versions.embree},
          {"rustc", versions.rustc},
          {"compiler", versions.compiler},
          {"commit", versions.commit}}},
    };
}

Json to_json(const Machine& machine, const Versions& versions, const std::vector<SceneResult>& scenes) {
    Json json = heading_json(machine, versions);
    for (const char* rows : {"builds", "speeds", "errors"}) json[rows] = Json::array();
    for (const SceneResult& scene : scenes) {
        for (const BuildReport& build : scene.builds) json["builds"].push_back(build_json(scene, build));
        for (const Speed& speed : scene.speeds) json["speeds"].push_back(speed_json(scene, speed));
        for (const Errors& errors : scene.errors) json["errors"].push_back(errors_json(scene, errors));
    }
    return json;
}

}  // namespace harness
