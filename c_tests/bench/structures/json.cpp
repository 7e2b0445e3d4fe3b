#include "bench/structures/json.hpp"

#include "bench/json.hpp"
#include "compare/json.hpp"

namespace harness {
namespace {

using Json = nlohmann::ordered_json;

Json work_json(const SceneBench& scene, const StructureScene::Work& work) {
    const RaySetInfo& set = scene.ray_sets[work.ray_set];
    return {{"scene", scene.name},
            {"view", set.view.empty() ? Json(nullptr) : Json(set.view)},
            {"ray_kind", set.kind},
            {"contender", scene.builds[work.build].contender},
            {"nodes_per_ray", number(work.per_ray.nodes)},
            {"cells_per_ray", number(work.per_ray.cells)},
            {"primitives_per_ray", number(work.per_ray.primitives)}};
}

Json grid_json(const GridSweep& sweep, const GridStep& step) {
    return {{"scene", sweep.scene},
            {"triangles", sweep.triangle_count},
            {"asked_cells_per_triangle", step.asked},
            {"cells_per_triangle", number(step.cells)},
            {"references_per_triangle", number(step.references)},
            {"build_seconds", number(step.build_seconds)},
            {"bytes_per_triangle", number(step.bytes)},
            {"ns_per_ray", kinds_json(step.ns_per_ray)},
            {"bvh_ns_per_ray", kinds_json(sweep.bvh_ns_per_ray)}};
}

}  // namespace

Json structures_json(const StructureBench& structures) {
    Json json = Json::object();
    for (const char* rows : {"scenes", "builds", "ray_sets", "speeds", "work", "grids", "growth", "bars", "summaries"}) {
        json[rows] = Json::array();
    }
    for (const auto& [bench, work] : structures.scenes) {
        push_scene(json, bench);
        for (const StructureScene::Work& row : work) json["work"].push_back(work_json(bench, row));
    }
    for (const GridSweep& sweep : structures.grid_sweeps) {
        for (const GridStep& step : sweep.steps) json["grids"].push_back(grid_json(sweep, step));
    }
    for (const Growth& growth : structures.growth) json["growth"].push_back(growth_json(growth));
    for (const Bar& bar : structures.bars) json["bars"].push_back(bar_json(bar));
    for (const StructureSummary& summary : structures.summaries)
        json["summaries"].push_back({{"structure", summary.structure}, {"text", summary.text}});
    return json;
}

}  // namespace harness
