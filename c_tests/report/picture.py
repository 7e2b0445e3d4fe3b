"""The picture of speed against error, as SVG: a panel for each error, a dot for each engine, structure and precision."""

import io
import re
import xml.etree.ElementTree as xml

import matplotlib
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullLocator

from figures import DECISIONS, engine_of, label_of, per_million

SVG = "http://www.w3.org/2000/svg"
TEXT, QUIET, RULE, CARD = "#22252a", "#666c75", "#e2e3e0", "#ffffff"
# What a reader's dark mode makes of these; a viewer that knows no media queries shows the light ones.
DARK = {TEXT: "#dfe1e4", QUIET: "#969ca6", RULE: "#33373d", CARD: "#1d2024"}
# The page's colours and shapes (report_scatter.inc): Okabe and Ito 2008.
COLOURS = {"wide_bvh": "#0072b2", "bvh": "#56b4e9", "kd_tree": "#009e73", "bsp_tree": "#e69f00", "octree": "#cc79a7", "grid": "#d55e00",
           "brute_force": "#8a7a1e"}
SHAPES = {"fast": "^", "accurate": "o", "exact": "D"}
PEER_SHAPES = {"embree": "x", "embree_robust": "+"}
# A decade lies between a panel's least count and its row of zeros.
ZERO_ROW = 0.1
# Between the slowest or fastest dot and the end of the scale.
SIDE_MARGIN = 1.3

STYLE = {"svg.fonttype": "none", "svg.hashsalt": "gnomon", "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "font.size": 10,
         "text.color": TEXT, "axes.labelcolor": TEXT, "axes.edgecolor": QUIET, "xtick.color": QUIET, "ytick.color": QUIET,
         "axes.facecolor": CARD, "figure.facecolor": CARD, "savefig.facecolor": CARD, "grid.color": RULE,
         "axes.spines.top": False, "axes.spines.right": False}


def marker(row):
    if row["engine"] != "gnomon":
        return {"marker": PEER_SHAPES[row["engine"]], "color": TEXT, "markersize": 9, "markeredgewidth": 2}
    colour = COLOURS[row["structure"]]
    filled = row["precision"] == "accurate"
    return {"marker": SHAPES[row["precision"]], "color": colour, "markersize": 6 if filled else 8, "markeredgewidth": 1.6,
            "markerfacecolor": colour if filled else "none"}


def words(row, error):
    figure = f"t within {error:.3g} ulp for 99 %" if error is not None else \
        f"{sum(row[key] for key in DECISIONS):,} of {row['rays']:,} rays wrong"
    return f"{label_of(engine_of(row))}: {row['mrays_per_s']:.3g} Mray/s, {figure}"


class Panels:
    """Axes side by side, in one row or more, and what each dot says under the pointer."""

    def __init__(self, count, row_count=1, **shared):
        self.figure = Figure(figsize=(3.6 * count, 4 * row_count))
        self.axes = list(self.figure.subplots(row_count, count, squeeze=False, **shared).flat)
        self.titles = {}

    def dot(self, axes, row, y, text):
        gid = f"dot-{len(self.titles)}"
        self.titles[gid] = text
        axes.plot(row["mrays_per_s"], y, linestyle="none", gid=gid, **marker(row))

    def scales(self, axes, title, label, y_range):
        speeds = [line.get_xdata()[0] for line in axes.lines if line.get_gid()]
        axes.set(xscale="log", yscale="log", xlim=(min(speeds) / SIDE_MARGIN, max(speeds) * SIDE_MARGIN), ylim=y_range)
        for axis in (axes.xaxis, axes.yaxis):
            name_ticks(axis)
        axes.set_title(title, loc="left", fontsize=11, color=TEXT)
        axes.set_xlabel("Mray/s (right is faster)")
        axes.set_ylabel(label)
        axes.grid(True, which="major", linewidth=0.8)
        axes.set_axisbelow(True)


def name_ticks(axis):
    """At 1, 2, 5, 10, ...; over more than two decades at powers of ten."""
    low, high = axis.get_view_interval()
    axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 100 * low else (1,)))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:,g}"))
    axis.set_minor_locator(NullLocator())


def marked_level(axes, level, text):
    axes.axhline(level, color=QUIET, linewidth=0.8, linestyle="--", zorder=0)
    axes.annotate(text, (0.02, level), xycoords=("axes fraction", "data"), xytext=(0, -17), textcoords="offset points", fontsize=9,
                  color=QUIET)


def draw_distance(panels, axes, rows):
    shown = [row for row in rows if row["t_ulp_p99"] is not None]
    for row in shown:
        panels.dot(axes, row, row["t_ulp_p99"], words(row, row["t_ulp_p99"]))
    panels.scales(axes, "Distance t: 99 % within", "ulp (down is better)", (0.2, 3 * max(row["t_ulp_p99"] for row in shown)))
    marked_level(axes, 0.5, "0.5 ulp: rounding alone")


def draw_decisions(panels, axes, rows, title):
    """Zeros have no place on a log scale: a row below the least count that could be seen, which says of how many rays."""
    rays = min(row["rays"] for row in rows)
    zero = ZERO_ROW * 1e6 / rays
    for row in rows:
        panels.dot(axes, row, max(per_million(row), zero), words(row, None))
    panels.scales(axes, title, "per million rays (down is better)", (zero / 6, max(3 * max(map(per_million, rows)), 1e3 * zero)))
    marked_level(axes, zero, f"0 of {rays:,}")
    axes.yaxis.set_major_locator(FixedLocator([10.0 ** power for power in range(-3, 7) if 10.0 ** power > 2 * zero]))


def legend(figure, rows):
    found = {(row["engine"], row["structure"]) for row in rows}
    blank = {"linestyle": "none", "markersize": 8, "markeredgewidth": 1.6}
    entries = [Line2D([], [], marker="s", color=colour, label=structure.replace("_", " "), **blank)
               for structure, colour in COLOURS.items() if ("gnomon", structure) in found]
    entries += [Line2D([], [], marker=shape, color=TEXT, markerfacecolor=TEXT if precision == "accurate" else "none",
                       label=precision.upper(), **blank)
                for precision, shape in SHAPES.items() if any(row["precision"] == precision for row in rows)]
    entries += [Line2D([], [], marker=shape, color=TEXT, label=label_of((engine, "", "")), **blank)
                for engine, shape in PEER_SHAPES.items() if any(row["engine"] == engine for row in rows)]
    figure.legend(handles=entries, loc="lower center", ncol=(len(entries) + 1) // 2, frameon=False, handletextpad=0.2, columnspacing=1.4)


def polished(svg, titles, description):
    """The same drawing with what each dot says, a description for those who do not see it, and a dark mode; without what matplotlib
    says of itself."""
    xml.register_namespace("", SVG)
    xml.register_namespace("xlink", "http://www.w3.org/1999/xlink")
    root = xml.fromstring(svg)
    for metadata in root.findall(f"{{{SVG}}}metadata"):
        root.remove(metadata)
    for node in root.iter():
        for name in {"d", "x", "y", "transform"} & node.attrib.keys():
            node.set(name, re.sub(r"(\.\d\d)\d+", r"\1", " ".join(node.get(name).split())))  # hundredths of a point
        if node.tag != f"{{{SVG}}}text":
            node.text = (node.text or "").strip()
        node.tail = "\n"
    for group in root.iter(f"{{{SVG}}}g"):
        if group.get("id") in titles:
            title = xml.Element(f"{{{SVG}}}title")
            title.text = titles[group.get("id")]
            group.insert(0, title)
    root.set("role", "img")
    title = xml.Element(f"{{{SVG}}}title")
    title.text = description
    root.insert(0, title)
    style = xml.Element(f"{{{SVG}}}style")
    style.text = "@media (prefers-color-scheme: dark) {" + " ".join(
        f'[style*="{use}: {light}"] {{ {use}: {dark} !important }}' for light, dark in DARK.items() for use in ("fill", "stroke")) + "}"
    root.insert(1, style)
    return xml.tostring(root, encoding="unicode") + "\n"


def counted(number, noun):
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def speed_against_error(data):
    """The picture as text. The third panel, of hard rays, is there where they were traced."""
    rows, hard = data["charts"][0]["dots"], data["hard_dots"]
    scenes = len(data["common_scenes"])
    with matplotlib.rc_context(STYLE):
        panels = Panels(3 if hard else 2, sharex=True)
        draw_distance(panels, panels.axes[0], rows)
        draw_decisions(panels, panels.axes[1], rows, f"Wrong hits on {counted(scenes, 'scene')}")
        if hard:
            draw_decisions(panels, panels.axes[2], hard, "Wrong hits on hard rays")
        legend(panels.figure, rows)
        panels.figure.tight_layout(rect=(0, 0.13, 1, 1), w_pad=1.5)
        file = io.StringIO()
        panels.figure.savefig(file, format="svg", metadata={"Date": None})
    description = f"Speed against error of gnomon's structures and precisions and of Embree, over {counted(scenes, 'scene')}"
    return polished(file.getvalue(), panels.titles, description)
