#include "bench/table.hpp"

#include "bench/bar.hpp"
#include "bench/timing_table.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

using Row = TextTable::Row;

std::string build_table(const SceneBench& scene) {
    TextTable table(
        3, {"engine", "structure", "isa", "seconds", "least", "x Embree's time", "against", "bytes/tri", "nodes", "depth"});
    for (const BuildTiming& build : scene.builds) {
        if (build.repeats == 0) continue;
        const double per_triangle = static_cast<double>(build.report.bytes) / static_cast<double>(scene.triangle_count);
        table.add({build.contender, build.report.structure, build.report.isa, figure(build.report.seconds, "%.4f"),
                   figure(build.least_seconds, "%.4f"), build.time_ratio ? figure(*build.time_ratio, "%.2f") : "-",
                   build.reference.empty() ? "-" : build.reference, figure(per_triangle, "%.1f"),
                   build.report.nodes ? grouped(build.report.nodes) : "-",
                   build.report.depth ? std::to_string(build.report.depth) : "-"});
    }
    for (const std::string& name : scene.not_built) table.add({name, "not built"});
    const std::uint32_t threads = scene.builds.empty() ? 0 : scene.builds.front().report.threads;
    return "builds (" + std::to_string(threads) + " threads, interleaved, median; below 1 is faster than Embree)\n" +
           table.text();
}

std::string ratio_table(const SceneBench& scene) { return timing_table(scene, "x Embree", ratio_cell).text(); }

std::string ns_table(const SceneBench& scene) {
    TextTable table = timing_table(scene, "ns a ray", ns_cell);
    Row hits = {"rays that hit", ""}, nodes = {"gnomon's nodes a ray", "closest"}, triangles = {"triangles a ray", "closest"};
    for (const RaySetInfo& set : scene.ray_sets) {
        hits.push_back(figure(100 * set.hit_share, "%.0f %%"));
        nodes.push_back(figure(set.nodes_per_ray, "%.1f"));
        triangles.push_back(figure(set.triangles_per_ray, "%.1f"));
    }
    for (Row* row : {&hits, &nodes, &triangles}) table.add(std::move(*row));
    Row differing = {"answers unlike Embree's", ""};
    for (std::size_t set = 0; set < scene.ray_sets.size(); ++set) {
        std::string text = "-";
        for (const Timing& timing : scene.timings) {
            const bool own = scene.builds[timing.build].contender == "gnomon" && timing.call == CallForm::fresh;
            if (own && timing.ray_set == set && timing.differing) text = grouped(*timing.differing);
        }
        differing.push_back(text);
    }
    table.add(std::move(differing));
    return table.text();
}

}  // namespace

std::string scene_text(const SceneBench& scene) {
    return scene.name + ": " + grouped(scene.triangle_count) + " triangles\n\n" + build_table(scene) +
           "\nspeed (median of the repeats' ratios, above 1 is faster than Embree's default; HIGH: than Embree's HIGH; batch: "
           "camera "
           "rays against\nEmbree's best, others against its prefilled single calls; threads: against one thread)\n" +
           ratio_table(scene) + "\n" + ns_table(scene);
}

std::string call_cost_text(const std::vector<CallCost>& costs) {
    TextTable table(2, {"scene", "engine", "ns, least", "median"});
    for (const CallCost& cost : costs) {
        table.add({cost.scene, cost.engine, figure(cost.least_ns, "%.1f"), figure(cost.median_ns, "%.1f")});
    }
    return "what a closest-hit call costs, fresh\n" + table.text();
}

std::string growth_text(const std::vector<Growth>& steps) {
    Row header = {"engine", "triangles", "build s", "step", "n log n", "", "bytes/tri"};
    if (!steps.empty()) {
        for (const auto& [kind, ns] : steps.front().ns_per_ray) header.push_back("ns " + kind);
    }
    TextTable table(1, header);
    for (const Growth& step : steps) {
        const bool first = step.step == 0;
        Row row = {step.engine,
                   grouped(step.triangle_count),
                   figure(step.build_seconds, "%.5f"),
                   first ? "-" : figure(step.step, "%.1f"),
                   first ? "-" : figure(step.n_log_n_step, "%.1f"),
                   first                 ? ""
                   : step.within_n_log_n ? "ok"
                                         : "worse",
                   figure(step.bytes_per_triangle, "%.1f")};
        for (const auto& [kind, ns] : step.ns_per_ray) row.push_back(figure(ns, "%.0f"));
        table.add(std::move(row));
    }
    return "growth (least build time; step: over the time of the step before)\n" + table.text();
}

std::string degenerate_text(const std::vector<Degenerate>& rows) {
    TextTable table(2, {"scene", "engine", "triangles", "build s", "mean us a ray", "worst", "rays"});
    for (const Degenerate& row : rows) {
        if (!row.failure.empty()) {
            table.add({row.scene, row.engine, grouped(row.triangle_count), row.failure});
            continue;
        }
        table.add({row.scene, row.engine, grouped(row.triangle_count), figure(row.build_seconds, "%.4f"),
                   figure(row.mean_us, "%.2f"), figure(row.worst_us, "%.2f"), grouped(row.ray_count)});
    }
    return "degenerate scenes (each ray's least time of three)\n" + table.text();
}

std::string bars_text(const std::vector<Bar>& bars, const std::string& heading) {
    TextTable table(6, {"what", "bar", "stretch", "", "measured", "of"});
    for (const Bar& bar : bars) {
        table.add({bar.what, bar.bar.empty() ? "-" : bar.bar, bar.stretch.empty() ? "-" : bar.stretch, verdict_name(bar.verdict),
                   bar.measured.empty() ? "-" : bar.measured, std::to_string(bar.sample_count)});
    }
    return "bars (" + heading + ")\n" + table.text();
}

}  // namespace harness
