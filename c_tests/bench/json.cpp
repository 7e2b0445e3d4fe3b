#include "bench/json.hpp"

#include "bench/bar.hpp"
#include "bench/structures/json.hpp"
#include "bench/trace.hpp"
#include "compare/json.hpp"

namespace harness {
namespace {

using Json = nlohmann::ordered_json;

Json optional_number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }
Json optional_text(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json scene_json(const SceneBench& scene) {
    return {{"scene", scene.name},
            {"triangles", scene.triangle_count},
            {"generated", scene.generated},
            {"not_built", scene.not_built}};
}

Json build_json(const SceneBench& scene, const BuildTiming& build) {
    const BuildReport& report = build.report;
    const double per_triangle = static_cast<double>(report.bytes) / static_cast<double>(scene.triangle_count);
    return {{"scene", scene.name},
            {"triangles", report.triangles},
            {"contender", build.contender},
            {"engine", report.engine},
            {"structure", report.structure},
            {"quality", report.quality},
            {"precision", report.precision},
            {"isa", report.isa},
            {"threads", report.threads},
            {"repeats", build.repeats},
            {"seconds", report.seconds},
            {"least_seconds", build.least_seconds},
            {"time_ratio_to_embree", optional_number(build.time_ratio)},
            {"reference", optional_text(build.reference)},
            {"bytes", report.bytes},
            {"bytes_per_triangle", number(per_triangle)},
            {"nodes", report.nodes},
            {"references", report.references},
            {"depth", report.depth},
            {"sah_cost", number(report.sah_cost)}};
}

Json ray_set_json(const SceneBench& scene, const RaySetInfo& set) {
    return {{"scene", scene.name},
            {"view", optional_text(set.view)},
            {"ray_kind", set.kind},
            {"rays", set.ray_count},
            {"batch_rays", set.batch_ray_count},
            {"hit_share", number(set.hit_share)},
            {"nodes_per_ray", number(set.nodes_per_ray)},
            {"triangles_per_ray", number(set.triangles_per_ray)}};
}

Json timing_json(const SceneBench& scene, const Timing& timing) {
    const BuildTiming& build = scene.builds[timing.build];
    const RaySetInfo& set = scene.ray_sets[timing.ray_set];
    return {{"scene", scene.name},
            {"view", optional_text(set.view)},
            {"ray_kind", set.kind},
            {"contender", build.contender},
            {"engine", build.report.engine},
            {"structure", build.report.structure},
            {"quality", build.report.quality},
            {"precision", build.report.precision},
            {"isa", build.report.isa},
            {"call", form_name(timing.call)},
            {"threads", timing.threads},
            {"rays", timing.ray_count},
            {"ns_per_ray", number(timing.ns_per_ray)},
            {"least_ns_per_ray", number(timing.least_ns_per_ray)},
            {"ratio", optional_number(timing.ratio)},
            {"reference", optional_text(timing.reference)},
            {"differing_answers", timing.differing ? Json(*timing.differing) : Json(nullptr)}};
}

Json degenerate_json(const Degenerate& row) {
    const bool failed = !row.failure.empty();
    return {{"scene", row.scene},
            {"engine", row.engine},
            {"triangles", row.triangle_count},
            {"build_seconds", failed ? Json(nullptr) : number(row.build_seconds)},
            {"mean_us", failed ? Json(nullptr) : number(row.mean_us)},
            {"worst_us", failed ? Json(nullptr) : number(row.worst_us)},
            {"rays", row.ray_count},
            {"failure", optional_text(row.failure)}};
}

}  // namespace

Json kinds_json(const std::vector<std::pair<std::string, double>>& figures) {
    Json json = Json::object();
    for (const auto& [kind, value] : figures) json[kind] = number(value);
    return json;
}

Json growth_json(const Growth& growth) {
    const bool first = growth.step == 0;
    return {{"engine", growth.engine},
            {"triangles", growth.triangle_count},
            {"build_seconds", growth.build_seconds},
            {"bytes_per_triangle", number(growth.bytes_per_triangle)},
            {"ns_per_ray", kinds_json(growth.ns_per_ray)},
            {"step", first ? Json(nullptr) : number(growth.step)},
            {"n_log_n_step", first ? Json(nullptr) : number(growth.n_log_n_step)},
            {"within_n_log_n", growth.within_n_log_n}};
}

Json bar_json(const Bar& bar) {
    return {{"what", bar.what},
            {"bar", optional_text(bar.bar)},
            {"stretch", optional_text(bar.stretch)},
            {"measured", optional_text(bar.measured)},
            {"value", optional_number(bar.value)},
            {"worst", optional_number(bar.worst)},
            {"worst_where", optional_text(bar.worst_where)},
            {"samples", bar.sample_count},
            {"verdict", verdict_name(bar.verdict)}};
}

void push_scene(Json& json, const SceneBench& scene) {
    json["scenes"].push_back(scene_json(scene));
    for (const BuildTiming& build : scene.builds) json["builds"].push_back(build_json(scene, build));
    for (const RaySetInfo& set : scene.ray_sets) json["ray_sets"].push_back(ray_set_json(scene, set));
    for (const Timing& timing : scene.timings) json["speeds"].push_back(timing_json(scene, timing));
}

Json bench_json(const BenchResults& results) {
    Json json = heading_json(this_machine(), these_versions());
    json["seconds"] = results.seconds;
    json["notes"] = results.notes;
    for (const char* rows : {"scenes", "builds", "ray_sets", "speeds", "calls", "growth", "degenerate", "bars"}) {
        json[rows] = Json::array();
    }
    for (const SceneBench& scene : results.scenes) push_scene(json, scene);
    for (const CallCost& cost : results.call_costs) {
        json["calls"].push_back({{"scene", cost.scene},
                                 {"engine", cost.engine},
                                 {"least_ns", number(cost.least_ns)},
                                 {"median_ns", number(cost.median_ns)}});
    }
    for (const Growth& growth : results.growth) json["growth"].push_back(growth_json(growth));
    for (const Degenerate& row : results.degenerate) json["degenerate"].push_back(degenerate_json(row));
    for (const Bar& bar : results.bars) json["bars"].push_back(bar_json(bar));
    json["structures"] = structures_json(results.structures);
    return json;
}

}  // namespace harness
