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


def check(holds, what):
    if not holds:
        sys.exit(f"smoke.py: {what}")


def check_shape(results):
    check(results["machine"]["cores"] > 0 and results["versions"]["gnomon"], "no machine or versions")
    for name, keys in SHAPES.items():
        check(results[name], f"no {name}")
        for row in results[name]:
            check(keys <= row.keys(), f"{name}: without {sorted(keys - row.keys())}: {row}")


def check_figures(results):
    check({row["verdict"] for row in results["bars"]} <= {"pass", "short", "not built", "not measured"}, "an unknown verdict")
    for row in results["speeds"]:
        check(row["ns_per_ray"] > 0, f"no time: {row}")
    rows = [row for row in results["ray_sets"] if row["ray_kind"] == "primary"]
    check({row["view"] for row in rows} == {"outside", "inside"}, "a view is missing")
    for row in rows:
        check(row["hit_share"] > 0.5, f"a view sees next to nothing: {row}")
        check(row["nodes_per_ray"] > 1 and row["triangles_per_ray"] > 0.5, f"rays that hit take nothing: {row}")


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
    check_shape(results)
    check_figures(results)
    check_answers(results)
    check("shells" in markdown.to_markdown(results), "markdown.py leaves the scene out")
    check("</html>" in paths["--html"].read_text(), "the report has no end")


if __name__ == "__main__":
    main()
