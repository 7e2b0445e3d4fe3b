// gnomon-light: how fast gnomon_irradiance and plain Monte Carlo come near the closed form.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "backend/trace_loop.hpp"
#include "compare/json.hpp"
#include "harness/write_file.hpp"
#include "light/convergence.hpp"

namespace {

using namespace harness;

nlohmann::ordered_json row_json(const ConvergenceRow& row) {
    return {{"lamp", row.lamp},          {"estimator", row.estimator}, {"samples", row.sample_count},
            {"places", row.place_count}, {"rms_error", row.rms_error}, {"rms_standard_error", row.rms_standard_error},
            {"seconds", row.seconds}};
}

void print(const std::vector<ConvergenceRow>& rows) {
    std::printf("%-10s %-18s %9s %7s %12s %14s %12s\n", "lamp", "estimator", "samples", "places", "rms error", "rms std error",
                "seconds");
    for (const ConvergenceRow& row : rows)
        std::printf("%-10s %-18s %9llu %7zu %12.3e %14.3e %12.3e\n", row.lamp.c_str(), row.estimator.c_str(),
                    static_cast<unsigned long long>(row.sample_count), row.place_count, row.rms_error, row.rms_standard_error,
                    row.seconds);
}

}  // namespace

int main(int argc, char** argv) {
    std::uint64_t most_samples = 1 << 20, seed = 1;
    std::string json_path;
    CLI::App app{
        "Estimates what arrives from a lamp partly behind a screen, by gnomon_irradiance and by plain Monte Carlo, against\n"
        "the closed form. Exit status: 0; 2 for unusable input.",
        "gnomon-light"};
    app.add_option("--most-samples", most_samples, "of an estimate; from 256 on, four times as many each")
        ->check(CLI::Range(std::uint64_t{1} << 8, std::uint64_t{1} << 32))
        ->capture_default_str();
    app.add_option("--seed", seed, "of places and samples")->capture_default_str();
    app.add_option("--json", json_path, "writes all figures to this file");
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    }
    try {
        const Clock::time_point start = Clock::now();
        const std::vector<ConvergenceRow> rows = measure_convergence(
            most_samples, seed, [](const std::string& what) { std::fprintf(stderr, "gnomon-light: %s\n", what.c_str()); });
        print(rows);
        if (json_path.empty()) return 0;
        nlohmann::ordered_json json = heading_json(this_machine(), these_versions());
        json["seed"] = seed;
        json["seconds"] = seconds_since(start);
        for (const ConvergenceRow& row : rows) json["convergence"].push_back(row_json(row));
        write_file(json_path, json.dump(2) + "\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "gnomon-light: %s\n", error.what());
        return 2;
    }
}
