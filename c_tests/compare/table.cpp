#include "compare/table.hpp"

#include "compare/options.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

using Row = TextTable::Row;

Row engine_cells(const BuildReport& build) { return {build.engine, build.structure, build.quality, build.precision}; }

std::string build_table(const SceneResult& scene) {
    TextTable table(5,
                    {"engine", "structure", "quality", "precision", "isa", "threads", "seconds", "bytes/tri", "nodes", "depth"});
    for (const BuildReport& build : scene.builds) {
        Row row = engine_cells(build);
        const double per_triangle = static_cast<double>(build.bytes) / static_cast<double>(build.triangles);
        row.insert(row.end(),
                   {build.isa, std::to_string(build.threads), figure(build.seconds, "%.4f"), figure(per_triangle, "%.1f"),
                    build.nodes ? grouped(build.nodes) : "-", build.depth ? std::to_string(build.depth) : "-"});
        table.add(std::move(row));
    }
    return "builds (median)\n" + table.text();
}

std::string speed_table(const SceneResult& scene) {
    TextTable table(
        6, {"rays", "engine", "structure", "quality", "precision", "call", "ns/ray", "Mray/s", "x Embree", "Embree's call"});
    for (const Speed& speed : scene.speeds) {
        Row row = engine_cells(scene.builds[speed.build]);
        row.insert(row.begin(), speed.ray_kind);
        row.insert(row.end(), {call_form_name(speed.call), figure(speed.ns_per_ray, "%.1f"), figure(speed.mrays_per_s(), "%.3f"),
                               speed.ratio_to_embree ? figure(*speed.ratio_to_embree, "%.2f") : "-", speed.embree_call});
        table.add(std::move(row));
    }
    return "speed (median; x Embree: above 1 is faster than Embree's default mode)\n" + table.text();
}

std::string error_table(const SceneResult& scene) {
    TextTable table(5, {"rays", "engine", "structure", "quality", "precision", "judged", "missed", "false", "wrong",
                        "outside contract", "ties", "t ulp median", "p99", "max"});
    for (const Errors& errors : scene.errors) {
        const BuildReport& build = scene.builds[errors.build];
        Row row = engine_cells(build);
        row.insert(row.begin(), errors.ray_kind);
        row.insert(row.end(), {grouped(errors.ray_count), grouped(errors.missed), grouped(errors.false_hits),
                               grouped(errors.wrong_primitive), build.engine == "gnomon" ? grouped(errors.outside_contract) : "-",
                               grouped(errors.ties), figure(errors.t_ulps.median, "%.3g"), figure(errors.t_ulps.p99, "%.3g"),
                               figure(errors.t_ulps.max, "%.3g")});
        table.add(std::move(row));
    }
    return "errors (against the exact oracle)\n" + table.text();
}

}  // namespace

std::string to_table(const SceneResult& scene) {
    std::string text = scene.name + ": " + grouped(scene.triangle_count) + " triangles\n\n" + build_table(scene);
    if (!scene.speeds.empty()) text += "\n" + speed_table(scene);
    if (!scene.errors.empty()) text += "\n" + error_table(scene);
    return text;
}

}  // namespace harness
