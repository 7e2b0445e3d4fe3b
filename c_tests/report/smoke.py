"""Makes the report of small results and checks that it says all of them, in a page and a picture that need nothing else.

    smoke.py CHART_JS OUTPUT_FOLDER
"""

import base64
import importlib.util
import itertools
import json
import math
import pathlib
import re
import subprocess
import sys
import xml.etree.ElementTree as xml
from html.parser import HTMLParser

HERE = pathlib.Path(__file__).parent
STRUCTURES = ("brute_force", "grid", "wide_bvh")
PRECISIONS = ("fast", "accurate", "exact")
ENGINES = [("embree", "bvh", ""), ("embree_robust", "bvh", ""), *(("gnomon", *pair) for pair in itertools.product(STRUCTURES, PRECISIONS))]
SCENES, KINDS = ("pond", "mill", "a \"quoted\" </script> name"), ("primary", "shadow")
SKIPPED = 77  # ctest's SKIP_RETURN_CODE
# README.md shows it.
MOST_SVG_BYTES = 60_000


def check(holds, what):
    if not holds:
        sys.exit(f"smoke.py: {what}")


def engine_fields(engine):
    return {**dict(zip(("engine", "structure", "precision"), engine)), "isa": "avx2"}


def compare_results():
    """Figures that differ from row to row; brute force on the first scene alone."""
    figure = itertools.count(1)
    speeds, errors = [], []
    for scene, kind, engine in itertools.product(SCENES, KINDS, ENGINES):
        if engine[1] == "brute_force" and scene != SCENES[0]:
            continue
        row = {"scene": scene, "ray_kind": kind, "quality": "medium", **engine_fields(engine)}
        number = next(figure)
        speeds.append({**row, "call": "single", "threads": 1, "rays": 5000, "mrays_per_s": 1 + number / 128})
        errors.append({**row, "rays": 1000, "missed": number if engine[0] != "gnomon" else 0, "false_hits": 0, "wrong_primitive": 0,
                       "outside_contract": 0, "t_ulp_p99": None if kind == "shadow" else 0.5 + number / 256})
    return {"machine": {"cpu": "a cpu", "cores": 2, "isa": "avx2", "os": "an os"},
            "versions": {"gnomon": "0.1.0", "embree": "3.13.5", "rustc": "rustc 1.95", "compiler": "GCC", "commit": "abc"},
            "builds": [], "speeds": speeds, "errors": errors}


def hard_results():
    populations, cases = [], []
    for index, engine in enumerate(ENGINES):
        populations.append({"name": "needles", **engine_fields(engine), "rays": 40000, "missed": 3 * index, "false_hits": 0,
                            "wrong_primitive": index, "outside_contract": 0, "t_ulp_median": 0.25, "t_ulp_p99": 0.5 + index,
                            "t_ulp_max": 7.5 + index, "uv_p99": 0.5, "uv_max": 0.5 + index / 64})
        cases.append({"number": 2, "name": "aimed at vertices", **engine_fields(engine), "checked": 12345, "failed": index,
                      "unit": "rays", "bar": "0", "limit": "a limit"})
    bars = [{"id": "B1", "text": "closed-mesh leaks", "measured": "0 of 4711", "bar": "0", "pass": True}]
    return {"seed": 1, "rays": 40000, "seconds": 1.5, "populations": populations, "cases": cases, "bars": bars}


def light_results():
    figure = itertools.count(1)
    rows = [{"lamp": lamp, "estimator": estimator, "samples": samples, "places": 16, "rms_error": 1 / (samples + next(figure)),
             "rms_standard_error": 0.9 / samples, "seconds": samples / 1e7}
            for lamp in ("rectangle", "sphere") for estimator in ("gnomon_irradiance", "plain, lamp") for samples in (256, 1024)]
    classes = [{"class": "diffuse", "mean": 0.125, "standard_error": 0.25, "sample_count": 4, "pixel_count": 4711}]
    return {"seed": 1, "seconds": 2.5, "convergence": rows}, {"methods": [{"method": "path", "classes": classes}, {"method": "whitted", "classes": classes}]}


# One grey pixel.
PNG = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==")


class Page(HTMLParser):
    """The page's elements, properly nested, and the texts of its scripts."""

    EMPTY = {"meta", "br", "img", "link", "input"}

    def __init__(self, text):
        super().__init__()
        self.open, self.links, self.data = [], [], {}
        self.feed(text)
        check(not self.open, f"never closed: {self.open}")

    def handle_starttag(self, tag, attributes):
        self.links += [value for name, value in attributes if name in ("src", "href")]
        if tag not in self.EMPTY:
            self.open.append((tag, dict(attributes).get("id")))

    def handle_endtag(self, tag):
        check(self.open and self.open[-1][0] == tag, f"</{tag}> after {self.open[-3:]}")
        self.open.pop()

    def handle_startendtag(self, tag, attributes):
        self.links += [value for name, value in attributes if name in ("src", "href")]

    def handle_data(self, data):
        if self.open:
            self.data[self.open[-1][1]] = self.data.get(self.open[-1][1], "") + data


def check_page(text, compare, hard):
    page = Page(text)
    links = [link for link in page.links if not link.startswith("data:image/png;base64,")]
    check(not links, f"the page asks for {links}")
    check(not re.search(r"url\((?!#)|@import", text.split("<script>")[0]), "the style asks for something")
    results = json.loads(page.data["results"])
    dots = {(chart["scene"], chart["ray_kind"], dot["engine"], dot["structure"], dot["precision"]): dot
            for chart in results["charts"] for dot in chart["dots"]}
    for speed, error in zip(compare["speeds"], compare["errors"]):
        structure = error["structure"] if error["engine"] == "gnomon" else ""
        where = [error["scene"], error["ray_kind"], error["engine"], structure, error["precision"]]
        dot = dots[tuple(where)]
        check(math.isclose(dot["mrays_per_s"], speed["mrays_per_s"]), f"speed of {where}")
        check(all(dot[key] == error[key] for key in ("rays", "missed", "t_ulp_p99")), f"errors of {where}")
    check(all(results[key] == hard[key] for key in ("populations", "cases", "bars")), "hard results differ")
    check_summary(results, dots, compare)


def check_light(text, light, furnace):
    page = Page(text)
    results = json.loads(page.data["results"])
    check(results["convergence"] == light["convergence"], "convergence differs")
    check(len(results["furnace"]) == 2 and all(row["mean"] == 0.125 for row in results["furnace"]), f"furnace: {results['furnace']}")
    check(page.links.count("data:image/png;base64," + base64.b64encode(PNG).decode("ascii")) == 2, "the pictures are not both in the page")
    for row in light["convergence"]:
        check(text.count(f"error {row['rms_error']:.2g}, stated") >= 2, f"{row} is not in both panels")


def check_summary(results, dots, compare):
    """Over the scenes, of the engines that most of them have: brute force is on one."""
    check(results["common_scenes"] == list(SCENES), f"common scenes: {results['common_scenes']}")
    check(all(structure != "brute_force" for scene, _, _, structure, _ in dots if scene is None), "brute force is in the summary")
    check(results["left_out"]["brute_force"] == sorted(SCENES[1:]), f"left out: {results['left_out']}")
    own = [row for row in compare["errors"] if row["engine"] == "embree"]
    summary = dots[None, None, "embree", "", ""]
    check(summary["missed"] == sum(row["missed"] for row in own) and summary["rays"] == 1000 * len(own), f"sums: {summary}")
    speeds = [row["mrays_per_s"] for row in compare["speeds"] if row["engine"] == "embree"]
    check(math.isclose(summary["mrays_per_s"] ** len(speeds), math.prod(speeds)), f"mean speed: {summary}")
    (hard,) = [dot for dot in results["hard_dots"] if dot["engine"] == "embree_robust"]
    check(hard["missed"] == 3 and hard["mrays_per_s"] == dots[None, None, "embree_robust", "", ""]["mrays_per_s"], f"hard: {hard}")


def check_picture(text, dots):
    """A dot in each of three panels for each engine of the summary, with its figures in words."""
    root = xml.fromstring(text)
    check(len(text.encode()) < MOST_SVG_BYTES, f"the picture has {len(text)} bytes")
    links = [value for node in root.iter() for name, value in node.attrib.items() if name.endswith("href") and not value.startswith("#")]
    check(not links and "http" not in re.sub(r'xmlns(:\w+)?="[^"]*"', "", text), f"the picture asks for something: {links}")
    titles = [node.text for node in root.iter("{http://www.w3.org/2000/svg}title")]
    for dot in dots:
        speed = f"{dot['mrays_per_s']:.3g} Mray/s"
        check(sum(speed in title for title in titles) >= 3, f"{speed} is not in each panel")
    words = " ".join(titles)
    check(f"{sum(dot['missed'] for dot in dots if dot['engine'] == 'embree'):,} of {dots[0]['rays']:,} rays wrong" in words, "no counts")
    check(f"0 of {dots[0]['rays']:,}" in "".join(root.itertext()), "the row of zeros does not say of how many")


def run(arguments):
    subprocess.run([sys.executable, HERE / "report.py", *arguments], check=True)


def main():
    if not importlib.util.find_spec("matplotlib"):
        print("skipped: matplotlib is missing (Debian: python3-matplotlib)")
        sys.exit(SKIPPED)
    chart_js, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    compare, hard = compare_results(), hard_results()
    for name, results in (("compare", compare), ("hard", hard)):
        (folder / f"{name}.json").write_text(json.dumps(results), encoding="utf-8")
    outputs = ["--chart-js", chart_js, "--html", folder / "index.html", "--svg", folder / "speed.svg"]
    run(["--compare", folder / "compare.json", *outputs])
    check("hard rays" not in (folder / "speed.svg").read_text(encoding="utf-8"), "a panel of hard rays that were not traced")
    run(["--compare", folder / "compare.json", "--hard", folder / "hard.json", *outputs])
    page = (folder / "index.html").read_text(encoding="utf-8")
    check('id="light"' not in page, "a chapter on light that was not measured")
    check_page(page, compare, hard)
    light, furnace = light_results()
    for name, results in (("light", light), ("furnace", furnace)):
        (folder / f"{name}.json").write_text(json.dumps(results), encoding="utf-8")
    (folder / "box.png").write_bytes(PNG)
    run(["--compare", folder / "compare.json", "--hard", folder / "hard.json", "--light", folder / "light.json", "--furnace",
         folder / "furnace.json", "--path-png", folder / "box.png", "--whitted-png", folder / "box.png", *outputs])
    page = (folder / "index.html").read_text(encoding="utf-8")
    check_page(page, compare, hard)
    check_light(page, light, furnace)
    results = json.loads(Page(page).data["results"])
    check_picture((folder / "speed.svg").read_text(encoding="utf-8"), results["charts"][0]["dots"])


if __name__ == "__main__":
    main()
