// gnomon's ACCURATE and EXACT answers on every scene there is, each judged by the exact oracle; beside them, Embree's on the same
// rays.
#define DOCTEST_CONFIG_IMPLEMENT_WITH_MAIN
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "backend/names.hpp"
#include "compare/run.hpp"
#include "harness/ray_count.hpp"
#include "oracle/judge.hpp"
#include "scene/load.hpp"

using namespace harness;

namespace {

Options options() {
    Options options;
    options.structures = {GNOMON_STRUCTURE_BVH, GNOMON_STRUCTURE_WIDE_BVH};
    options.precisions = {GNOMON_PRECISION_ACCURATE, GNOMON_PRECISION_EXACT};
    options.qualities = {GNOMON_QUALITY_LOW, GNOMON_QUALITY_MEDIUM, GNOMON_QUALITY_HIGH};
    options.ray_kinds = {"primary", "bounce", "shadow", "random"};
    options.calls = {CallForm::prefilled};
    options.ray_count = options.oracle_ray_count = ray_count_or(5'000);
    options.repeats = 1;
    return options;
}

void print_heading() {
    std::printf("%-24s %-8s %-26s %8s %8s %8s %8s %8s %12s\n", "scene", "rays", "engine", "missed", "false", "wrong", "ties",
                "outside", "max t ulp");
}

void print_row(const std::string& scene, const BuildReport& build, const Errors& errors) {
    const std::string ours = build.engine == "gnomon" ? " " + build.structure + " " + build.precision : "";
    const std::string engine = build.engine + ours + " " + build.quality;
    std::printf("%-24s %-8s %-26s %8zu %8zu %8zu %8zu %8zu %12.4g\n", scene.c_str(), errors.ray_kind.c_str(), engine.c_str(),
                errors.missed, errors.false_hits, errors.wrong_primitive, errors.ties, errors.outside_contract,
                errors.t_ulps.max);
}

void check_scene(const std::string& spec) {
    CAPTURE(spec);
    Notes notes;
    const SceneResult result = run_scene(spec, options(), notes);
    for (const Errors& errors : result.errors) {
        const BuildReport& build = result.builds[errors.build];
        print_row(result.name, build, errors);
        if (build.engine != "gnomon") continue;
        CAPTURE(errors.ray_kind);
        CAPTURE(build.precision);
        CAPTURE(build.quality);
        CHECK(errors.outside_contract == 0);
        if (build.precision == "exact") CHECK(errors.wrong_decisions() == 0);
        CHECK_FALSE(errors.t_ulps.max > t_ulps_promised);  // NaN where no ray was judged with a t
    }
    std::fflush(stdout);
    for (const std::string& warning : notes.warnings) MESSAGE(warning);
    for (const std::string& fault : notes.faults) FAIL_CHECK(fault);
    CHECK_FALSE(result.errors.empty());
    for (const std::uint32_t precision : options().precisions) {
        const std::string name = name_of(precision_names, precision);
        CHECK(std::ranges::any_of(result.builds, [&](const BuildReport& build) { return build.precision == name; }));
    }
}

/// With fewer triangles where each ray meets them all.
std::string spec_of(const GeneratorInfo& generator) {
    return "gen:" + generator.name + (generator.name == "identical" ? ":20" : "");
}

std::vector<std::string> scene_files(const std::filesystem::path& folder) {
    std::vector<std::string> files;
    if (std::filesystem::is_directory(folder))
        for (const auto& entry : std::filesystem::directory_iterator(folder))
            if (entry.path().extension() == ".glb") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST_CASE("precise_answers_on_generated_scenes_keep_the_contract") {
    print_heading();
    for (const GeneratorInfo& generator : generators()) check_scene(spec_of(generator));
}

TEST_CASE("precise_answers_on_scene_files_keep_the_contract") {
    const std::vector<std::string> files = scene_files(GNOMON_SHARED_SCENES);
    if (files.empty()) {
        MESSAGE("skipped: no .glb file in \"" GNOMON_SHARED_SCENES "\"");
        return;
    }
    print_heading();
    for (const std::string& file : files) check_scene(file);
}
