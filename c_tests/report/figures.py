"""The figures of the report: what gnomon-compare and gnomon-hard wrote, joined."""

import statistics

ENGINE = ("engine", "structure", "precision")
DECISIONS = ("missed", "false_hits", "wrong_primitive")


def engine_of(row):
    """Embree has one structure and no precision: what a row says of them is left out."""
    return tuple(row[key] for key in ENGINE) if row["engine"] == "gnomon" else (row["engine"], "", "")


def label_of(engine):
    name, structure, precision = engine
    return f"{structure} {precision}".replace("_", " ") if name == "gnomon" else name.replace("_", " ").capitalize()


def per_million(row):
    return sum(row[key] for key in DECISIONS) * 1e6 / row["rays"]


def points(compare):
    """A row for each engine on each scene's rays of a kind: how fast, and how far from the truth. Qualities other than medium and
    call forms after the first are left out."""
    speeds = {}
    for row in compare["speeds"]:
        if row["quality"] == "medium":
            speeds.setdefault((row["scene"], row["ray_kind"], engine_of(row)), row["mrays_per_s"])
    return [{**{key: row[key] for key in ("scene", "ray_kind", *ENGINE, "rays", *DECISIONS, "t_ulp_p99")},
             "mrays_per_s": speeds[row["scene"], row["ray_kind"], engine_of(row)]}
            for row in compare["errors"] if row["quality"] == "medium"]


def unique(values):
    return list(dict.fromkeys(values))


def median_of(rows, key):
    values = [row[key] for row in rows if row[key] is not None]
    return statistics.median(values) if values else None


def summed(rows, engine):
    return {**dict(zip(ENGINE, engine)), "rays": sum(row["rays"] for row in rows),
            **{key: sum(row[key] for row in rows) for key in DECISIONS}}


def joined(rows):
    """A row for each engine over scenes and kinds of rays: the geometric mean of the speeds, which keeps their ratios, the median of
    the p99 of t, the sums of decisions."""
    dots = []
    for engine in unique(map(engine_of, rows)):
        own = [row for row in rows if engine_of(row) == engine]
        dots.append({**summed(own, engine), "mrays_per_s": statistics.geometric_mean(row["mrays_per_s"] for row in own),
                     "t_ulp_p99": median_of(own, "t_ulp_p99")})
    return dots


def in_common(rows):
    """The rows of the engines that most scenes have, on the scenes that have all those: so that no mean is one of other scenes."""
    scenes_of = {}
    for row in rows:
        scenes_of.setdefault(engine_of(row), set()).add(row["scene"])
    scene_count = len(set().union(*scenes_of.values()))
    scenes_of = {engine: scenes for engine, scenes in scenes_of.items() if 2 * len(scenes) >= scene_count}
    scenes = set.intersection(*scenes_of.values())
    return [row for row in rows if engine_of(row) in scenes_of and row["scene"] in scenes]


def charts(rows):
    """The dots of all scenes in common and of each scene, of all kinds of rays and of each; a name is None for all."""
    common = in_common(rows)
    kinds = [None, *unique(row["ray_kind"] for row in rows)]
    scenes = [None, *unique(row["scene"] for row in rows)]
    return [{"scene": scene, "ray_kind": kind,
             "dots": joined([row for row in (rows if scene else common)
                             if scene in (None, row["scene"]) and kind in (None, row["ray_kind"])])}
            for scene in scenes for kind in kinds]


def on_hard_rays(dots, populations):
    """The same engines at the same speed, with their decisions on the rays of all populations; of several instruction sets the
    sum."""
    found = []
    for dot in dots:
        own = [row for row in populations if engine_of(row) == engine_of(dot)]
        if own:
            found.append({**dot, **summed(own, engine_of(dot)), "t_ulp_p99": None})
    return found


def settings(compare):
    """How the scenes' rays were traced, from the rows themselves."""
    speeds, errors = compare["speeds"], compare["errors"]
    return {"rays": max(row["rays"] for row in speeds), "judged": max(row["rays"] for row in errors),
            "call": speeds[0]["call"], "threads": max(row["threads"] for row in speeds)}


def left_out(rows):
    """{structure: scenes without it}, of those that some scene has."""
    scenes_of = {}
    for row in rows:
        scenes_of.setdefault(row["structure"], set()).add(row["scene"])
    scenes = set().union(*scenes_of.values())
    return {structure: sorted(scenes - own) for structure, own in scenes_of.items() if own != scenes}


def report_data(compare, hard):
    """All that the page and the picture show; `hard` may be None."""
    rows = points(compare)
    drawn = charts(rows)
    hard = hard or {"populations": [], "cases": [], "bars": []}
    return {
        "machine": compare["machine"], "versions": compare["versions"], "settings": settings(compare), "left_out": left_out(rows),
        "common_scenes": unique(row["scene"] for row in in_common(rows)),
        "charts": drawn, "hard_dots": on_hard_rays(drawn[0]["dots"], hard["populations"]),
        **{key: hard[key] for key in ("populations", "cases", "bars")},
    }
