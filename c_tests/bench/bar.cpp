#include "bench/bar.hpp"

#include <algorithm>

#include "bench/statistics.hpp"
#include "compare/text_table.hpp"

namespace harness {
namespace {

/// A camera that sees less, or bounces of which nearly all leave the scene at once, measure calls rather than traversal.
constexpr double least_hit_share_of_camera = 0.5, least_hit_share_of_bounces = 0.05;

double median_of(const Samples& samples) {
    std::vector<double> values;
    for (const Sample& sample : samples) values.push_back(sample.value);
    return median(values);
}

bool by_value(const Sample& a, const Sample& b) { return a.value < b.value; }

/// False where there is no figure.
bool fill_speed(Bar& bar, const Samples& samples) {
    bar.sample_count = samples.size();
    if (samples.empty()) return false;
    bar.value = median_of(samples);
    const Sample& worst = *std::min_element(samples.begin(), samples.end(), by_value);
    bar.worst = worst.value;
    bar.worst_where = worst.where;
    bar.measured = figure(*bar.value, "%.2f") + " (worst " + figure(worst.value, "%.2f") + ", " + worst.where + ")";
    return true;
}

}  // namespace

bool is_blind(const RaySetInfo& set) {
    return (set.kind == "primary" && set.hit_share < least_hit_share_of_camera) ||
           (set.kind == "bounce" && set.hit_share < least_hit_share_of_bounces);
}

bool is_about_a_million(std::size_t triangle_count) { return triangle_count >= 800'000 && triangle_count <= 1'100'000; }

Bar speed_bar(const std::string& what, const Samples& samples, double least, const std::string& stretch,
              std::optional<double> least_anywhere) {
    Bar bar;
    bar.what = what;
    bar.bar = ">= " + figure(least, "%.2f");
    if (least_anywhere) bar.bar += ", none < " + figure(*least_anywhere, "%.2f");
    bar.stretch = stretch;
    if (!fill_speed(bar, samples)) return bar;
    const bool pass = *bar.value >= least && (!least_anywhere || *bar.worst >= *least_anywhere);
    bar.verdict = pass ? BarVerdict::pass : BarVerdict::short_of;
    return bar;
}

Bar cost_bar(const std::string& what, const Samples& samples, Counts counts, double most, const std::string& unit,
             const std::string& stretch) {
    Bar bar;
    bar.what = what;
    bar.bar = "<= " + figure(most, "%.3g") + unit;
    bar.stretch = stretch;
    bar.sample_count = samples.size();
    if (samples.empty()) return bar;
    const Sample& worst = *std::max_element(samples.begin(), samples.end(), by_value);
    bar.value = median_of(samples);
    bar.worst = worst.value;
    bar.worst_where = worst.where;
    const double counted = counts == Counts::median ? *bar.value : *bar.worst;
    bar.measured = figure(counted, "%.2f") + unit;
    if (counts == Counts::median && samples.size() > 1)
        bar.measured += " (worst " + figure(worst.value, "%.2f") + ", " + worst.where + ")";
    if (counts == Counts::worst) bar.measured += " (" + worst.where + ")";
    bar.verdict = counted <= most ? BarVerdict::pass : BarVerdict::short_of;
    return bar;
}

Bar shown_bar(const std::string& what, const Samples& samples) {
    Bar bar;
    bar.what = what;
    if (fill_speed(bar, samples)) bar.verdict = BarVerdict::shown;
    return bar;
}

std::string verdict_name(BarVerdict verdict) {
    switch (verdict) {
        case BarVerdict::pass:
            return "pass";
        case BarVerdict::short_of:
            return "short";
        case BarVerdict::shown:
            return "shown";
        case BarVerdict::not_built:
            return "not built";
        default:
            return "not measured";
    }
}

}  // namespace harness
