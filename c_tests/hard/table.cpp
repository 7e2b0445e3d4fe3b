#include "hard/table.hpp"

#include <algorithm>
#include <array>

#include "compare/text_table.hpp"

namespace harness {
namespace {

using Row = TextTable::Row;

/// Engines that a line sums up: "gnomon exact".
std::string group_of(const HardEngine& engine) {
    return engine.is_gnomon() ? engine.engine + " " + engine.precision : engine.engine;
}

Row figures(const PopulationRow& row) {
    const Errors& errors = row.errors;
    return {grouped(errors.missed),
            grouped(errors.false_hits),
            grouped(errors.wrong_primitive),
            row.engine.is_gnomon() ? grouped(errors.outside_contract) : "-",
            figure(errors.t_ulps.median, "%.3g"),
            figure(errors.t_ulps.p99, "%.3g"),
            figure(errors.t_ulps.max, "%.3g"),
            figure(errors.uv.p99, "%.3g"),
            figure(errors.uv.max, "%.3g")};
}

/// A group's failures in a case: raw, and the engines' worst; "-" of none.
std::string failures_of(const std::vector<CaseRow>& rows, const std::string& group) {
    const CaseRow* worst = nullptr;
    std::size_t broken = 0;
    for (const CaseRow& row : rows) {
        if (group_of(row.engine) != group) continue;
        broken += row.broken;
        if (worst == nullptr || row.failed > worst->failed) worst = &row;
    }
    if (worst == nullptr) return "-";
    return grouped(worst->failed) + (broken != 0 ? " (!)" : "");
}

/// The rows of each case, in order.
std::vector<std::vector<CaseRow>> by_case(const std::vector<CaseRow>& rows) {
    std::vector<std::vector<CaseRow>> cases;
    for (const CaseRow& row : rows) {
        if (cases.empty() || cases.back().front().name != row.name) cases.emplace_back();
        cases.back().push_back(row);
    }
    return cases;
}

/// The limit that goes with most failures.
std::string limit_of(const std::vector<CaseRow>& rows) {
    return std::ranges::max(rows, {}, [](const CaseRow& row) { return row.limit.empty() ? 0 : row.failed + 1; }).limit;
}

}  // namespace

std::string population_text(const std::vector<PopulationRow>& rows) {
    TextTable table(2, {"population", "engine", "engines", "rays", "missed", "false", "wrong", "outside", "t ulp median", "p99",
                        "max", "u, v p99", "max"});
    struct Line {
        std::string population, group;
        std::size_t engine_count, ray_count;
        Row figures;
    };
    std::vector<Line> lines;
    for (const PopulationRow& row : rows) {
        const Row values = figures(row);
        const auto same = std::ranges::find_if(lines, [&](const Line& line) {
            return line.population == row.name && line.group == group_of(row.engine) && line.figures == values;
        });
        if (same == lines.end()) {
            lines.push_back({row.name, group_of(row.engine), 1, row.errors.ray_count, values});
        } else {
            ++same->engine_count;
        }
    }
    for (const Line& line : lines) {
        Row row = {line.population, line.group, std::to_string(line.engine_count), grouped(line.ray_count)};
        row.insert(row.end(), line.figures.begin(), line.figures.end());
        table.add(std::move(row));
    }
    return "populations (t in ulps, u and v in 2^-24)\n" + table.text();
}

std::string case_text(const std::vector<CaseRow>& rows) {
    constexpr std::array groups = {"gnomon fast", "gnomon accurate", "gnomon exact", "embree", "embree_robust"};
    TextTable table(3, {"case", "", "bar", "checked", "fast", "accurate", "exact", "embree", "robust"});
    TextTable limits(2, {"case", "limits of gnomon"});
    for (const std::vector<CaseRow>& case_rows : by_case(rows)) {
        const CaseRow& first = case_rows.front();
        Row row = {std::to_string(first.number), first.name, first.bar, grouped(first.checked) + " " + first.unit};
        for (const char* group : groups) row.push_back(failures_of(case_rows, group));
        table.add(std::move(row));
        if (const std::string limit = limit_of(case_rows); !limit.empty()) limits.add({std::to_string(first.number), limit});
    }
    return "hard cases (failures of each group's worst engine, nothing forgiven; (!): outside gnomon's contract)\n" +
           table.text() + "\n" + limits.text();
}

std::string bars_text(const std::vector<HardBar>& bars) {
    TextTable table(5, {"bar", "", "measured", "asked", ""});
    for (const HardBar& bar : bars) table.add({bar.id, bar.text, bar.measured, bar.bar, bar.pass ? "pass" : "short"});
    return "bars\n" + table.text();
}

}  // namespace harness
