#include "hard/bars.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "compare/results.hpp"
#include "compare/text_table.hpp"
#include "oracle/judge.hpp"

namespace harness {
namespace {

constexpr double fast_ulps_median = 0.7, accurate_cost = 1.06, exact_cost = 1.10, invalid_cost = 2;

bool is_cells_or_nodes(const HardEngine& engine) {
    return engine.is_gnomon() && (engine.structure == "grid" || engine.structure == "octree" || engine.structure == "kd_tree" ||
                                  engine.structure == "bsp_tree");
}

/// gnomon's counts in the cases of some numbers.
struct Sum {
    std::size_t row_count = 0, checked = 0, failed = 0, broken = 0;

    std::string text(const char* what) const { return grouped(failed) + " " + what + " in " + grouped(checked); }
};

Sum sum_of(const HardResults& results, std::initializer_list<int> numbers, bool exacting_alone = false) {
    Sum sum;
    for (const CaseRow& row : results.cases) {
        if (!row.engine.is_gnomon() || (exacting_alone && !row.engine.is_exacting())) continue;
        if (std::ranges::find(numbers, row.number) == numbers.end()) continue;
        ++sum.row_count;
        sum.checked += row.checked;
        sum.failed += row.failed;
        sum.broken += row.broken;
    }
    return sum;
}

void add_count_bar(std::vector<HardBar>& bars, const char* id, const char* text, const Sum& sum, const char* what) {
    if (sum.row_count != 0) bars.push_back({id, text, sum.text(what), "0", sum.failed == 0});
}

/// The greatest of a figure over the rows of a precision, and where; 0 where it has none.
struct Worst {
    double value = 0;
    std::string where;
};
template <class Figure>
Worst worst_of(const HardResults& results, const std::string& precision, Figure figure) {
    Worst worst;
    for (const PopulationRow& row : results.populations) {
        if (!row.engine.is_gnomon() || row.engine.precision != precision) continue;
        const double value = figure(row);
        if (value > worst.value) worst = {value, row.name};
    }
    return worst;
}

bool has_precision(const HardResults& results, const std::string& precision) {
    return std::ranges::any_of(results.populations, [&](const PopulationRow& row) { return row.engine.precision == precision; });
}

const PopulationRow* embree_robust(const HardResults& results, const std::string& population) {
    const auto found = std::ranges::find_if(results.populations, [&](const PopulationRow& row) {
        return row.name == population && row.engine.engine == "embree_robust";
    });
    return found == results.populations.end() ? nullptr : &*found;
}

void add_rounding_bars(std::vector<HardBar>& bars, const HardResults& results) {
    for (const std::string precision : {"accurate", "exact"}) {
        if (!has_precision(results, precision)) continue;
        const Worst t = worst_of(results, precision, [](const PopulationRow& row) { return row.errors.t_ulps.max; });
        const Worst uv = worst_of(results, precision, [](const PopulationRow& row) { return row.errors.uv.max; });
        bars.push_back({"B3", precision + ": worst t in ulps, worst u and v in 2^-24",
                        figure(t.value, "%.4f") + " (" + t.where + "), " + figure(uv.value, "%.4f") + " (" + uv.where + ")",
                        "<= 0.51, <= 0.52", t.value <= t_ulps_promised && uv.value <= uv_error_promised});
    }
    if (!has_precision(results, "fast")) return;
    const Worst median = worst_of(results, "fast", [](const PopulationRow& row) { return row.errors.t_ulps.median; });
    const Worst soup = worst_of(
        results, "fast", [](const PopulationRow& row) { return row.name.starts_with("soup") ? row.errors.t_ulps.median : 0; });
    bars.push_back({"B3", "fast: median of t in ulps, of soups and the worst",
                    figure(soup.value, "%.3f") + ", " + figure(median.value, "%.4g") + " (" + median.where + ")", "<= 0.7",
                    median.value <= fast_ulps_median, BarKind::comparison});
    const Worst ratio = worst_of(results, "fast", [&](const PopulationRow& row) {
        const PopulationRow* embree = embree_robust(results, row.name);
        return embree == nullptr ? 0 : row.errors.t_ulps.p99 / embree->errors.t_ulps.p99;
    });
    if (!ratio.where.empty())
        bars.push_back({"B3", "fast: worst p99 of t over Embree robust's", figure(ratio.value, "%.2f") + " (" + ratio.where + ")",
                        "<= 1", ratio.value <= 1, BarKind::comparison});
}

void add_decision_bars(std::vector<HardBar>& bars, const HardResults& results) {
    std::size_t rays = 0, wrong = 0, outside = 0;
    std::string above_embree;
    for (const PopulationRow& row : results.populations) {
        if (!row.engine.is_gnomon()) continue;
        outside += row.errors.outside_contract;
        if (row.engine.precision == "exact") {
            rays += row.errors.ray_count;
            wrong += row.errors.wrong_decisions();
        }
        const PopulationRow* embree = embree_robust(results, row.name);
        const bool is_above = embree != nullptr && row.engine.precision == "accurate" &&
                              (row.errors.missed > embree->errors.missed || row.errors.false_hits > embree->errors.false_hits ||
                               row.errors.wrong_primitive > embree->errors.wrong_primitive);
        if (is_above && above_embree.find(row.name) == std::string::npos)
            above_embree += (above_embree.empty() ? "" : ", ") + row.name;
    }
    if (rays != 0)
        bars.push_back({"B4", "exact: missed, false and wrong primitive on the populations",
                        grouped(wrong) + " in " + grouped(rays), "0", wrong == 0});
    if (!results.populations.empty())
        bars.push_back({"B4", "outside the contract on the populations", grouped(outside), "0", outside == 0});
    if (has_precision(results, "accurate") && has_precision(results, ""))
        bars.push_back({"B4", "accurate: populations with a raw rate above Embree robust's",
                        above_embree.empty() ? "none" : above_embree, "none", above_embree.empty(), BarKind::comparison});
    std::size_t broken = 0, checked = 0;
    for (const CaseRow& row : results.cases) {
        broken += row.broken;
        checked += row.engine.is_gnomon() ? row.checked : 0;
    }
    if (checked != 0)
        bars.push_back(
            {"B4", "outside the contract in the hard cases", grouped(broken) + " in " + grouped(checked), "0", broken == 0});
}

/// What structures and calls disagree in, over everything that ran.
void add_agreement_bars(std::vector<HardBar>& bars, const HardResults& results) {
    std::size_t compared = 0, differences = 0, lost = 0, disagreements = 0;
    const auto add = [&](const auto& row, std::size_t count) {
        if (!row.engine.is_gnomon()) return;
        disagreements += row.disagreements;
        if (!row.engine.is_exacting()) return;
        compared += count;
        differences += row.differences;
        if (is_cells_or_nodes(row.engine)) lost += row.differences;
    };
    for (const PopulationRow& row : results.populations) add(row, row.errors.ray_count);
    for (const CaseRow& row : results.cases) add(row, row.checked);
    if (compared != 0)
        bars.push_back({"B5", "answers that differ between structures, instruction sets, calls, threads, qualities",
                        grouped(differences) + " in " + grouped(compared), "0", differences == 0});
    const Sum retraced = sum_of(results, {18, 19});
    bars.push_back({"B6", "re-traces that fail, and rays that intersect and occluded see differently",
                    grouped(retraced.failed) + " in " + grouped(retraced.checked) + ", " + grouped(disagreements), "0, 0",
                    retraced.failed == 0 && disagreements == 0});
    if (compared != 0)
        bars.push_back(
            {"B13", "answers of grid, octree, kd-tree and BSP tree that are not brute force's", grouped(lost), "0", lost == 0});
}

std::vector<double> ratios(const HardResults& results, double PrecisionCost::*precision) {
    std::vector<double> values;
    for (const PrecisionCost& cost : results.costs) {
        const double ratio = cost.*precision / cost.fast_ns;
        if (std::isfinite(ratio)) values.push_back(ratio);
    }
    return values;
}

void add_cost_bar(std::vector<HardBar>& bars, const HardResults& results, const char* name, double PrecisionCost::*precision,
                  double most) {
    const std::vector<double> values = ratios(results, precision);
    if (values.empty()) return;
    const double median = quantile(values, 0.5);
    bars.push_back({"B12", std::string(name) + " over fast in ns a ray, median of scenes and kinds of rays",
                    figure(median, "%.3f") + " (from " + figure(quantile(values, 0), "%.2f") + " to " +
                        figure(quantile(values, 1), "%.2f") + ")",
                    "<= " + figure(most, "%.2f"), median <= most, BarKind::timing});
}

}  // namespace

std::vector<HardBar> judge_hard_bars(const HardResults& results) {
    std::vector<HardBar> bars;
    add_count_bar(bars, "B1", "leaks of closed meshes", sum_of(results, {1, 2, 3, 4, 5, 8, 9, 10}), "leaks");
    add_count_bar(bars, "B2", "axis, border and in-plane rays", sum_of(results, {11, 12, 13}), "wrong");
    add_rounding_bars(bars, results);
    add_decision_bars(bars, results);
    add_agreement_bars(bars, results);
    add_count_bar(bars, "B7", "hits that powers of two change, but FAST's", sum_of(results, {26, 27}, true), "changed");
    add_count_bar(bars, "B8", "invalid rays and meshes", sum_of(results, {31, 33}), "wrong");
    if (results.invalid.miss_ns > 0) {
        const double ratio = results.invalid.invalid_ns / results.invalid.miss_ns;
        bars.push_back({"B8", "the slowest invalid ray over an ordinary miss", figure(ratio, "%.2f"), "<= 2",
                        ratio <= invalid_cost, BarKind::timing});
    }
    add_count_bar(bars, "B9", "hits of triangles without area", sum_of(results, {25}), "hits");
    add_count_bar(bars, "B10", "secondary rays from the returned bound: self-hits and leaks", sum_of(results, {41}), "wrong");
    add_count_bar(bars, "B11", "hits of duplicates that are not the lowest", sum_of(results, {34}), "hits");
    add_cost_bar(bars, results, "accurate", &PrecisionCost::accurate_ns, accurate_cost);
    add_cost_bar(bars, results, "exact", &PrecisionCost::exact_ns, exact_cost);
    std::ranges::stable_sort(bars, {}, [](const HardBar& bar) { return std::stoi(bar.id.substr(1)); });
    return bars;
}

bool is_correct(const std::vector<HardBar>& bars) {
    return std::ranges::all_of(bars, [](const HardBar& bar) { return bar.pass || bar.kind != BarKind::correctness; });
}

}  // namespace harness
