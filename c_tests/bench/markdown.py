"""Prints the README's tables from what gnomon-bench wrote.

    markdown.py BENCH_JSON...       several: runs of different scenes or parts, put together
"""

import json
import pathlib
import statistics
import sys

KINDS = ["primary", "bounce", "shadow", "random"]


def table(header, rows):
    lines = [header, ["---"] * len(header), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def figure(value, digits=2):
    return "–" if value is None else f"{value:.{digits}f}"


def find(rows, **wanted):
    return next((row for row in rows if all(row[key] == value for key, value in wanted.items())), None)


def ratio(results, scene, view, kind, call, threads=1):
    row = find(results["speeds"], scene=scene, view=view, ray_kind=kind, contender="gnomon", call=call, threads=threads)
    return row and row["ratio"]


def in_views(kind, value, digits=2):
    """Outside / inside; random rays have no view."""
    shown = [None] if kind == "random" else ["outside", "inside"]
    return " / ".join(figure(value(view), digits) for view in shown)


def views(results, scene, kind, call):
    return in_views(kind, lambda view: ratio(results, scene, view, kind, call))


def scene_row(results, scene):
    name = scene["scene"]
    ours, theirs = (find(results["builds"], scene=name, contender=contender) for contender in ("gnomon", "embree"))
    bytes_a_triangle = [figure(build and build["bytes_per_triangle"], 0) for build in (ours, theirs)]
    return [name, f"{scene['triangles']:,}", *(views(results, name, kind, "fresh") for kind in KINDS),
            *(views(results, name, kind, "batch") for kind in KINDS), figure(ours["time_ratio_to_embree"], 1),
            " / ".join(bytes_a_triangle)]


def scene_table(results):
    header = ["scene", "triangles", *KINDS, *(f"batch {kind}" for kind in KINDS), "build", "bytes a triangle"]
    return table(header, [scene_row(results, scene) for scene in results["scenes"]])


def work_cell(results, scene, kind, key):
    def value(view):
        row = find(results["ray_sets"], scene=scene, view=view, ray_kind=kind)
        return row and row[key]
    return in_views(kind, value, 1)


def work_table(results):
    """What finding a ray's closest hit takes, of shadow rays too."""
    figures = [(unit, kind) for unit in ("nodes", "triangles") for kind in KINDS]
    return table(["scene", *(f"{unit} {kind}" for unit, kind in figures)],
                 [[scene["scene"], *(work_cell(results, scene["scene"], kind, f"{unit}_per_ray") for unit, kind in figures)]
                  for scene in results["scenes"]])


def bar_table(results):
    header = ["what", "bar", "stretch", "measured", ""]
    return table(header, [[bar["what"], bar["bar"] or "–", bar["stretch"] or "–", bar["measured"] or "–", bar["verdict"]]
                          for bar in results["bars"]])


def growth_table(results):
    header = ["engine", "triangles", "build s", "bytes a triangle", *(f"ns {kind}" for kind in KINDS)]
    return table(header, [[row["engine"], f"{row['triangles']:,}", figure(row["build_seconds"], 4), figure(row["bytes_per_triangle"], 1),
                           *(figure(row["ns_per_ray"].get(kind), 0) for kind in KINDS)] for row in results["growth"]])


def structure_ratio(structures, scene, contender):
    """The median over the scene's rays."""
    ratios = [row["ratio"] for row in structures["speeds"] if row["scene"] == scene and row["contender"] == contender]
    return statistics.median(ratios) if ratios else None


def structure_table(structures):
    """Times the scalar BVH's speed."""
    contenders = list(dict.fromkeys(row["contender"] for row in structures["speeds"] if row["quality"] == "medium"))
    return table(["scene", *contenders], [[scene["scene"], *(figure(structure_ratio(structures, scene["scene"], contender))
                                                             for contender in contenders)] for scene in structures["scenes"]])


def heading(results):
    machine, versions = results["machine"], results["versions"]
    return (f"{machine['cpu']}, {machine['cores']} cores, {machine['isa']}; gnomon {versions['commit']}, "
            f"Embree {versions['embree'] or 'missing'}, {versions['rustc']}")


def to_markdown(results):
    tables = [scene_table(results), work_table(results), bar_table(results)] if results["bars"] else []
    if results["growth"]:
        tables.append(growth_table(results))
    if results["structures"]["scenes"]:
        tables += [structure_table(results["structures"]), bar_table(results["structures"])]
    return "\n\n".join([heading(results), *tables])


def merged(runs):
    """Bars are those of the last run: they cannot be put together."""
    results = runs[-1]
    for run in runs[:-1]:
        for name, rows in run.items():
            if isinstance(rows, list) and name not in ("bars", "notes"):
                results[name] = rows + results[name]
    return results


if __name__ == "__main__":
    print(to_markdown(merged([json.loads(pathlib.Path(path).read_text()) for path in sys.argv[1:]])))
