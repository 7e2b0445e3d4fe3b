"""Runs gnomon-bench on a small scene and checks what it writes.

    smoke.py GNOMON_BENCH OUTPUT_FOLDER
"""

import json
import pathlib
import subprocess
import sys

import markdown

# Rays that pass an edge or start on one may be decided either way.
MOST_DIFFERING_SHARE = 1e-3

VERDICTS = {"pass", "short", "shown", "not built", "not measured"}

SHAPES = {
    "scenes": {"scene", "triangles", "generated", "not_built"},
    "builds": {"scene", "contender", "engine", "quality", "isa", "threads", "seconds", "time_ratio_to_embree", "bytes_per_triangle"},
    "ray_sets": {"scene", "view", "ray_kind", "rays", "hit_share", "nodes_per_ray", "triangles_per_ray"},
    "speeds": {"scene", "view", "ray_kind", "contender", "call", "threads", "rays", "ns_per_ray", "ratio", "reference", "differing_answers"},
    "calls": {"scene", "engine", "least_ns", "median_ns"},
    "growth": {"engine", "triangles", "build_seconds", "bytes_per_triangle", "ns_per_ray", "step", "within_n_log_n"},
    "degenerate": {"scene", "engine", "build_seconds", "mean_us", "worst_us", "rays", "failure"},
    "bars": {"what", "bar", "stretch", "measured", "value", "worst", "samples", "verdict"},
}


STRUCTURE_SHAPES = {
    **{name: SHAPES[name] for name in ("scenes", "builds", "ray_sets", "speeds", "growth", "bars")},
    "work": {"scene", "view", "ray_kind", "contender", "nodes_per_ray", "cells_per_ray", "primitives_per_ray"},
    "grids": {"scene", "triangles", "asked_cells_per_triangle", "cells_per_triangle", "references_per_triangle", "build_seconds",
              "bytes_per_triangle", "ns_per_ray", "bvh_ns_per_ray"},
    "summaries": {"structure", "text"},
}
STRUCTURES = {"brute_force", "grid", "octree", "kd_tree", "bsp_tree", "bvh", "wide_bvh"}
# Each triangle at most once, and each at least once: the scene has no triangle of zero area and no copies.
SINGLE_REFERENCE = {"brute_force", "bvh", "wide_bvh"}


def check(holds, what):
    if not holds:
        sys.exit(f"smoke.py: {what}")


def check_shape(results, shapes):
    for name, keys in shapes.items():
        check(results[name], f"no {name}")
        for row in results[name]:
            check(keys <= row.keys(), f"{name}: without {sorted(keys - row.keys())}: {row}")


def check_figures(results):
    check({row["verdict"] for row in results["bars"]} <= VERDICTS, "an unknown verdict")
    for row in results["speeds"]:
        check(row["ns_per_ray"] > 0, f"no time: {row}")
    rows = [row for row in results["ray_sets"] if row["ray_kind"] == "primary"]
    check({row["view"] for row in rows} == {"outside", "inside"}, "a view is missing")
    for row in rows:
        check(row["hit_share"] > 0.5, f"a view sees next to nothing: {row}")
        check(row["nodes_per_ray"] > 1 and row["triangles_per_ray"] > 0.5, f"rays that hit take nothing: {row}")


def check_structures(results):
    check(not results["scenes"][0]["not_built"], "a structure is missing")
    triangles = results["scenes"][0]["triangles"]
    for rows in ("builds", "work", "speeds", "growth"):
        names = {row.get("contender", row.get("engine")).split(" ")[0] for row in results[rows]}
        names |= {row["structure"] for row in results[rows] if rows in ("builds", "speeds")}
        check(names == STRUCTURES, f"{rows} has {sorted(names)}")
    for row in results["builds"]:
        single = row["structure"] in SINGLE_REFERENCE
        check(row["references"] == triangles if single else row["references"] >= triangles, f"references of {row}")
    for row in results["work"]:
        check_work(row, row["contender"].split(" ")[0], triangles)
    check({row["verdict"] for row in results["bars"]} <= VERDICTS, "an unknown verdict")


def check_work(row, structure, triangles):
    """Random rays may all miss; brute force asks every triangle, a grid has cells and no nodes, a BVH nodes and no cells."""
    nodes, cells, primitives = (row[f"{unit}_per_ray"] for unit in ("nodes", "cells", "primitives"))
    if structure == "brute_force":
        check(nodes == cells == 0 and primitives == triangles, f"work of {row}")
        return
    check(0 < primitives < triangles / 4, f"triangles tested: {row}")
    check((cells if structure == "grid" else nodes) > 0, f"neither nodes nor cells: {row}")
    check(nodes < triangles and cells < triangles, f"as many steps as triangles: {row}")


def check_grids(rows):
    cells = [row["cells_per_triangle"] for row in rows]
    check(cells == sorted(cells), f"finer grids have fewer cells: {cells}")
    check(round(cells[0] * rows[0]["triangles"]) == 1, f"the coarsest grid is not one cell: {rows[0]}")


def check_answers(results):
    for row in results["speeds"]:
        share = (row["differing_answers"] or 0) / row["rays"]
        check(share <= MOST_DIFFERING_SHARE, f"{share:.2%} of the answers differ from Embree's: {row}")


def main():
    bench, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    paths = {"--json": folder / "bench.json", "--html": folder / "report.html"}
    subprocess.run([bench, "gen:shells:5000", "--ray-count=4000", "--repeats=1", "--build-repeats=1", "--most-triangles=1000",
                    *(f"{option}={path}" for option, path in paths.items())], check=True, stdout=subprocess.DEVNULL)
    results = json.loads(paths["--json"].read_text())
    check(results["machine"]["cores"] > 0 and results["versions"]["gnomon"], "no machine or versions")
    check_shape(results, SHAPES)
    check_figures(results)
    check_answers(results)
    structures = results["structures"]
    check_shape(structures, STRUCTURE_SHAPES)
    check_structures(structures)
    check_grids(structures["grids"])
    check_answers(structures)
    check("shells" in markdown.to_markdown(results), "markdown.py leaves the scene out")
    check("</html>" in paths["--html"].read_text(), "the report has no end")


if __name__ == "__main__":
    main()
