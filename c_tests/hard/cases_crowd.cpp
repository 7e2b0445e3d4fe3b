// Many triangles where a structure can't tell them apart, or of sizes that it can't be good to at once.
#include <cmath>

#include "backend/trace_loop.hpp"
#include "compare/describe.hpp"
#include "hard/cases.hpp"
#include "rays/aim.hpp"
#include "rays/degenerate_scenes.hpp"
#include "rays/vector.hpp"
#include "scene/load.hpp"
#include "scene/mesh_parts.hpp"

namespace harness {
namespace {

constexpr std::size_t crowd = 1'000'000, small_crowd = 10'000;
constexpr std::size_t crowd_rays = 50;  // each may have to meet every triangle

std::size_t crowd_size(const CaseRun& run) { return run.is_full() ? crowd : small_crowd; }

/// One precision: a crowd's builds take most of the time.
bool is_chosen_for_crowds(const HardEngine& engine) { return !engine.is_gnomon() || engine.precision == "accurate"; }

/// However badly a structure copes with a crowd, it may not cost more than asking every triangle, with room for a busy machine,
/// nor take minutes to build.
constexpr double most_build_seconds = 120, most_ns_per_triangle = 100;

/// The same answers from every structure, in bounded time.
void expect_bounded(CaseRun& run, const Scene& scene, const std::vector<GnomonRay>& rays) {
    Reference reference;
    const auto check = [&](const HardEngine& engine, Backend& backend, CaseRow& row) {
        Answers answers;
        const double seconds = timed([&] { answers = answers_of(backend, rays); });
        const std::size_t differences = reference.count_differences(engine, answers.hits);
        row.checked += rays.size();
        row.differences += differences;
        for (std::size_t i = 0; i < differences; ++i)
            run.fail(row, scene, rays.front(), "answers are not those of other structures");
        const double most_seconds = 2e-9 * most_ns_per_triangle * static_cast<double>(rays.size() * scene.triangle_count()) + 1;
        row.failed += backend.report().seconds > most_build_seconds || seconds > most_seconds;
    };
    run.each_engine(scene, check, is_chosen_for_crowds);
}

/// Of triangles that lie on each other the one with the lowest ids, which `is_lowest` tells, is hit.
void expect_lowest(CaseRun& run, const Scene& scene, const std::vector<GnomonRay>& rays, bool (*is_lowest)(const GnomonHit&),
                   const CaseRun::Choice& is_chosen) {
    const auto check = [&](const HardEngine&, Backend& backend, CaseRow& row) {
        const std::vector<GnomonHit> hits = answers_of(backend, rays).hits;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if (!is_hit(hits[i])) continue;
            ++row.checked;
            if (!is_lowest(hits[i])) run.fail(row, scene, rays[i], "not the lowest id: " + hit_text(hits[i]));
        }
    };
    run.each_engine(scene, check, is_chosen);
}

void run_duplicates(CaseRun& run) {
    const auto all = [](const HardEngine&) { return true; };
    const Trial trial = soup_trial(0.1, run.ray_count(2), run.rng);

    Scene twice = trial.scene;
    twice.name += " twice";
    std::vector<std::uint32_t>& indices = twice.meshes[0].indices;
    indices.clear();
    for (std::size_t i = 0; i < trial.scene.meshes[0].indices.size(); i += 3)
        for (int copy = 0; copy < 2; ++copy)
            indices.insert(indices.end(), trial.scene.meshes[0].indices.begin() + static_cast<std::ptrdiff_t>(i),
                           trial.scene.meshes[0].indices.begin() + static_cast<std::ptrdiff_t>(i + 3));
    expect_lowest(
        run, twice, trial.rays, [](const GnomonHit& hit) { return hit.primitive_id % 2 == 0; }, all);

    Scene two_meshes = trial.scene;
    two_meshes.name += " as two meshes";
    two_meshes.meshes.push_back(two_meshes.meshes[0]);
    expect_lowest(
        run, two_meshes, trial.rays, [](const GnomonHit& hit) { return hit.geometry_id == 0; }, all);

    const Scene identical = generate_scene("identical", crowd_size(run));
    const std::vector<GnomonRay> rays = degenerate_rays(identical, crowd_rays);
    expect_lowest(
        run, identical, rays, [](const GnomonHit& hit) { return hit.primitive_id == 0; }, is_chosen_for_crowds);
    expect_bounded(run, identical, rays);
}

/// Triangles of every size and orientation around one point.
Scene concentric(std::size_t triangle_count, Rng& rng) {
    Mesh mesh{"concentric", {}, {}};
    for (std::size_t i = 0; i < triangle_count; ++i) {
        const double size = std::exp2(rng.uniform(-6, 0));
        const Vec3d a = size * unit_direction(rng), b = size * unit_direction(rng);
        const std::uint32_t first = add_vertex(mesh, a);
        add_triangle(mesh, first, add_vertex(mesh, b), add_vertex(mesh, -(a + b)));
    }
    return {"concentric " + std::to_string(triangle_count), {std::move(mesh)}};
}

void run_equal_centroids(CaseRun& run) {
    const Scene few = concentric(500, run.rng);
    run.judge(few, aimed_rays(few, run.ray_count(2), run.rng));
    const Scene shells = generate_scene("shells", 1'280);
    run.judge(shells, aimed_rays(shells, run.ray_count(2), run.rng));
    const Scene many = concentric(crowd_size(run), run.rng);
    expect_bounded(run, many, aimed_rays(many, crowd_rays, run.rng));
}

void run_flat_scenes(CaseRun& run) {
    for (const DegenerateScene& degenerate : degenerate_scenes()) {
        if (!degenerate.name.starts_with("all ")) continue;
        Scene few = degenerate.make(500), many = degenerate.make(crowd_size(run));
        few.name += ", few";
        run.judge(few, degenerate_rays(few, run.ray_count(3)));
        expect_bounded(run, many, degenerate_rays(many, crowd_rays));
    }
}

/// Slivers from one side of a cube to the other.
Scene diagonals(Rng& rng) {
    Mesh mesh{"diagonals", {}, {}};
    for (int i = 0; i < 500; ++i) {
        const Vec3d end = unit_direction(rng), beside = 1e-2 * unit_direction(rng);
        const std::uint32_t first = add_vertex(mesh, end);
        add_triangle(mesh, first, add_vertex(mesh, -end), add_vertex(mesh, beside - end));
    }
    return {"diagonals", {std::move(mesh)}};
}

void run_unlike_sizes(CaseRun& run) {
    const Scene stadium = generate_scene("teapot_in_stadium", 3'000), slivers = diagonals(run.rng);
    for (const Scene* scene : {&stadium, &slivers}) run.judge(*scene, aimed_rays(*scene, run.ray_count(2), run.rng));
    const Scene crowded = generate_scene("teapot_in_stadium", crowd_size(run));
    expect_bounded(run, crowded, aimed_rays(crowded, crowd_rays, run.rng));
    for (const DegenerateScene& degenerate : degenerate_scenes()) {
        if (!degenerate.name.starts_with("one huge")) continue;
        const Scene scene = degenerate.make(crowd_size(run));
        expect_bounded(run, scene, degenerate_rays(scene, crowd_rays));
    }
}

/// Vertices at multiples of a power of two, where halves, cells and planes are too.
void run_edges_on_planes(CaseRun& run) {
    const std::vector<Scene> scenes = {generate_scene("cube_grid", 768), generate_scene("cube_grid", 3'072),
                                       generate_scene("height_field", 2 * 32 * 32)};
    for (const Scene& scene : scenes) run.judge(scene, aimed_rays(scene, run.ray_count(scenes.size()), run.rng));
}

}  // namespace

std::vector<HardCase> crowd_cases() {
    const std::string bar = "0 outside the contract; bounded time";
    const std::string limit = "a BSP tree is asked up to 30,000 triangles: it takes too long to build of more";
    return {
        {34, "duplicate triangles, x 2 and 10^6 times, and duplicate geometry", "the lowest id", run_duplicates, limit, "hits"},
        {36, "equal centroids, nested shells", bar, run_equal_centroids, limit},
        {37, "all triangles in a plane, on a line, in a point", bar, run_flat_scenes, limit},
        {38, "one huge and many tiny triangles, a teapot in a stadium, long diagonals", bar, run_unlike_sizes, limit},
        {39, "edges exactly on split planes and cell faces", "EXACT 0 wrong; 0 outside the contract", run_edges_on_planes},
    };
}

}  // namespace harness
