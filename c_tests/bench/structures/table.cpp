#include "bench/structures/table.hpp"

#include "bench/timing_table.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

using Row = TextTable::Row;

std::string build_table(const SceneBench& scene) {
    TextTable table(
        2, {"structure", "isa", "seconds", "builds", "bytes/tri", "references/tri", "nodes, cells", "depth", "SAH cost"});
    const double triangle_count = static_cast<double>(scene.triangle_count);
    for (const BuildTiming& build : scene.builds) {
        const BuildReport& report = build.report;
        table.add({build.contender, report.isa, figure(report.seconds, "%.4f"),
                   build.repeats ? std::to_string(build.repeats) : "1, cold",
                   figure(static_cast<double>(report.bytes) / triangle_count, "%.1f"),
                   figure(static_cast<double>(report.references) / triangle_count, "%.2f"), grouped(report.nodes),
                   grouped(report.depth), figure(report.sah_cost, "%.1f")});
    }
    for (const std::string& name : scene.not_built) table.add({name, "not built"});
    return table.text();
}

std::string work_table(const StructureScene& scene, const std::string& heading, double RayWork::*unit) {
    const auto cell = [&](const Timing& timing) -> std::string {
        for (const StructureScene::Work& work : scene.work) {
            const bool same = work.build == timing.build && work.ray_set == timing.ray_set;
            if (same && work.per_ray.*unit > 0) return figure(work.per_ray.*unit, "%.1f");
        }
        return "-";
    };
    return timing_table(scene.bench, heading, cell).text();
}

/// Figures by kind, each with its name in a header.
using KindFigures = std::vector<std::pair<std::string, double>>;

void add_kinds(Row& header, const KindFigures& figures) {
    for (const auto& [kind, ns] : figures) header.push_back("ns " + kind);
}

void add_figures(Row& row, const KindFigures& figures) {
    for (const auto& [kind, ns] : figures) row.push_back(figure(ns, "%.0f"));
}

}  // namespace

std::string structure_scene_text(const StructureScene& scene) {
    return scene.bench.name + ": " + grouped(scene.bench.triangle_count) + " triangles\n\n" + build_table(scene.bench) + "\n" +
           timing_table(scene.bench, "x BVH", ratio_cell).text() + "\n" + timing_table(scene.bench, "ns a ray", ns_cell).text() +
           "\n" + work_table(scene, "nodes a closest hit", &RayWork::nodes) + "\n" +
           work_table(scene, "cells a closest hit", &RayWork::cells) + "\n" +
           work_table(scene, "triangles a closest hit", &RayWork::primitives);
}

std::string grid_sweep_text(const GridSweep& sweep) {
    Row header = {"cells/tri asked", "cells/tri", "references/tri", "build s", "bytes/tri"};
    add_kinds(header, sweep.bvh_ns_per_ray);
    TextTable table(0, header);
    for (const GridStep& step : sweep.steps) {
        Row row = {figure(step.asked, "%.3g"), figure(step.cells, "%.3g"), figure(step.references, "%.2f"),
                   figure(step.build_seconds, "%.4f"), figure(step.bytes, "%.1f")};
        add_figures(row, step.ns_per_ray);
        table.add(std::move(row));
    }
    Row bvh = {"BVH", "-", "-", "-", "-"};
    add_figures(bvh, sweep.bvh_ns_per_ray);
    table.add(std::move(bvh));
    return "grids of " + sweep.scene + ", " + grouped(sweep.triangle_count) + " triangles\n" + table.text();
}

std::string structure_growth_text(const std::vector<Growth>& steps) {
    Row header = {"structure", "triangles", "build s", "bytes/tri"};
    if (!steps.empty()) add_kinds(header, steps.front().ns_per_ray);
    TextTable table(1, header);
    for (const Growth& step : steps) {
        Row row = {step.engine, grouped(step.triangle_count), figure(step.build_seconds, "%.5f"),
                   figure(step.bytes_per_triangle, "%.1f")};
        add_figures(row, step.ns_per_ray);
        table.add(std::move(row));
    }
    return "growth of an evenly spread soup (least build time)\n" + table.text();
}

std::string summaries_text(const std::vector<StructureSummary>& summaries) {
    TextTable table(2, {"structure", "when"});
    for (const StructureSummary& summary : summaries) table.add({summary.structure, summary.text});
    return table.text();
}

}  // namespace harness
