#include "bench/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

namespace harness {
namespace {

const std::vector<std::string> part_names = {"scenes", "calls", "growth", "degenerate", "structures"};

void declare(CLI::App& app, BenchOptions& options) {
    app.add_option("SCENE", options.scenes,
                   "a .glb or .gltf file, or gen:NAME[:TRIANGLES]; without any, the shared scenes and generated ones");
    app.add_option("--parts", options.parts,
                   "scenes: builds and rays; calls: what a call costs; growth: 10^3 to 10^7 triangles; degenerate: hard scenes; "
                   "structures: which one when")
        ->delimiter(',')
        ->check(CLI::IsMember(part_names))
        ->default_val(part_names);
    app.add_flag("--structures", options.structures_alone, "the part about structures alone: as --parts structures");
    app.add_flag("--quick", options.quick, "fewer scenes, rays and repeats");
    app.add_option("--ray-count", options.ray_count,
                   "rays of each kind and view (30,000; quick: 15,000); batches have five times as many, structures half");
    app.add_option("--repeats", options.repeats, "interleaved repeats; medians are shown (5; quick: 3)")
        ->check(CLI::Range(1, 1000));
    app.add_option("--build-repeats", options.build_repeats, "interleaved builds after a warm-up")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    app.add_option("--threads", options.threads, "threads of builds and of the batches set against one thread")
        ->check(CLI::Range(1, 1024))
        ->capture_default_str();
    app.add_option("--most-triangles", options.most_triangles,
                   "of the growth's last step, and of degenerate scenes up to 10^6 (10^7; quick: 10^6)")
        ->check(CLI::Range(std::size_t{1'000}, std::size_t{100'000'000}));
    app.add_option("--json", options.json_path, "writes everything, machine-readable");
    app.add_option("--html", options.html_path, "writes a report with a chart");
}

void fill_defaults(BenchOptions& options) {
    if (options.structures_alone) options.parts = {"structures"};
    if (options.ray_count == 0) options.ray_count = options.quick ? 15'000 : 30'000;
    if (options.repeats == 0) options.repeats = options.quick ? 3 : 5;
    if (options.most_triangles == 0) options.most_triangles = options.quick ? 1'000'000 : 10'000'000;
}

}  // namespace

bool BenchOptions::has_part(const std::string& part) const { return std::find(parts.begin(), parts.end(), part) != parts.end(); }

std::optional<BenchOptions> parse_bench_options(int argc, char** argv, int& status) {
    BenchOptions options;
    CLI::App app{
        "Measures gnomon beside Embree, on the same rays and interleaved, against the project's bars.\n"
        "Exit status: 0, however the figures are; 2 for unusable input.",
        "gnomon-bench"};
    declare(app, options);
    try {
        app.parse(argc, argv);
        fill_defaults(options);
        return options;
    } catch (const CLI::Success& success) {
        status = app.exit(success);
    } catch (const CLI::Error& error) {
        std::fprintf(stderr, "gnomon-bench: %s\n", error.what());
        status = 2;
    }
    return {};
}

}  // namespace harness
