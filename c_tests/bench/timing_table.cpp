#include "bench/timing_table.hpp"

#include <algorithm>

#include "bench/trace.hpp"

namespace harness {
namespace {

/// A contender in a call form: a row over all ray sets.
struct Line {
    std::size_t build;
    CallForm call;
    std::uint32_t threads;
    bool operator==(const Line&) const = default;
};

std::vector<Line> lines_of(const SceneBench& scene) {
    std::vector<Line> lines;
    for (const Timing& timing : scene.timings) {
        const Line line{timing.build, timing.call, timing.threads};
        if (std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(line);
    }
    return lines;
}

const Timing* find_timing(const SceneBench& scene, const Line& line, std::size_t ray_set) {
    for (const Timing& timing : scene.timings) {
        if (Line{timing.build, timing.call, timing.threads} == line && timing.ray_set == ray_set) return &timing;
    }
    return nullptr;
}

/// Two decimals, and more of a ratio that they would make 0.
std::string ratio_text(double ratio) { return figure(ratio, ratio < 0.05 ? "%.4f" : "%.2f"); }

}  // namespace

TextTable timing_table(const SceneBench& scene, const std::string& heading, const TimingCell& cell) {
    TextTable::Row header = {heading, "call"};
    for (const RaySetInfo& set : scene.ray_sets) header.push_back((set.view.empty() ? "" : set.view + " ") + set.kind);
    TextTable table(2, header);
    for (const Line& line : lines_of(scene)) {
        TextTable::Row row = {scene.builds[line.build].contender, form_name(line.call) + (line.threads > 1 ? ", threads" : "")};
        bool any = false;
        for (std::size_t set = 0; set < scene.ray_sets.size(); ++set) {
            const Timing* timing = find_timing(scene, line, set);
            row.push_back(timing ? cell(*timing) : "-");
            any |= row.back() != "-";
        }
        if (any) table.add(std::move(row));
    }
    return table;
}

std::string ratio_cell(const Timing& timing) { return timing.ratio ? ratio_text(*timing.ratio) : "-"; }
std::string ns_cell(const Timing& timing) { return figure(timing.ns_per_ray, "%.0f"); }

}  // namespace harness
