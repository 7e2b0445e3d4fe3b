"""The chapter on light: what gnomon-light and gnomon-render wrote, as a picture and as the page's section."""

import base64
import html
import io
import math

import matplotlib
from matplotlib.lines import Line2D
from matplotlib.ticker import EngFormatter

from figures import unique
from picture import COLOURS, QUIET, STYLE, TEXT, Panels, name_ticks, polished

# In the order in which gnomon-light measures them.
ESTIMATOR_COLOURS = {"gnomon_irradiance": COLOURS["wide_bvh"], "plain, lamp": COLOURS["kd_tree"], "plain, cosine": COLOURS["bsp_tree"],
                     "plain, sphere": COLOURS["octree"]}
METHOD_NAMES = {"path": "Path tracing", "whitted": "Whitted’s method"}
# Between the least or largest figure and the end of the scale.
SIDE_MARGIN = 2


def light_data(light, furnace):
    """What the page holds as JSON; either may be None."""
    return {"convergence": light["convergence"] if light else [], "light_seconds": light["seconds"] if light else None,
            "furnace": [{"method": method["method"], **row} for method in (furnace["methods"] if furnace else []) for row in method["classes"]]}


def draw_errors(panels, axes, rows, key, figures, title):
    """`figures`: those of all panels over this one's scale."""
    for estimator in unique(row["estimator"] for row in rows):
        own = [row for row in rows if row["estimator"] == estimator]
        colour = ESTIMATOR_COLOURS[estimator]
        axes.plot([row[key] for row in own], [row["rms_error"] for row in own], color=colour, linewidth=1.4)
        axes.plot([row[key] for row in own], [row["rms_standard_error"] for row in own], color=colour, linewidth=0.9, linestyle=":")
        for row in own:
            gid = f"row-{len(panels.titles)}"
            panels.titles[gid] = (f"{estimator}, {row['lamp']}: {row['samples']:,} samples, {row['seconds']:.2g} s, error {row['rms_error']:.2g}, "
                                  f"stated {row['rms_standard_error']:.2g}")
            axes.plot(row[key], row["rms_error"], linestyle="none", gid=gid, marker="o", markersize=5, color=colour)
    errors = [value for row in rows for value in (row["rms_error"], row["rms_standard_error"]) if value]
    axes.set(xscale="log", yscale="log", xlim=(min(figures) / SIDE_MARGIN, max(figures) * SIDE_MARGIN),
             ylim=(min(errors) / SIDE_MARGIN, max(errors) * SIDE_MARGIN))
    if key == "samples":
        first, last = min(figures), max(figures)
        level = next(row["rms_error"] for row in rows)  # where the first line begins
        axes.plot([first, last], [level, level * math.sqrt(first / last)], color=QUIET, linewidth=0.8, linestyle="--", zorder=0)
    for axis in (axes.xaxis, axes.yaxis):
        name_ticks(axis)
    if key == "samples":
        axes.xaxis.set_major_formatter(EngFormatter(sep=""))  # a million as 1M: with all zeros it does not fit beside the next
    axes.set_title(title, loc="left", fontsize=11, color=TEXT)
    axes.set_xlabel(key)
    axes.set_ylabel("error (down is better)")
    axes.grid(True, which="major", linewidth=0.8)
    axes.set_axisbelow(True)


def convergence_picture(rows):
    """A row of panels for each lamp: error against samples and against seconds."""
    lamps = unique(row["lamp"] for row in rows)
    with matplotlib.rc_context(STYLE):
        panels = Panels(2, len(lamps), sharex="col")
        for index, lamp in enumerate(lamps):
            own = [row for row in rows if row["lamp"] == lamp]
            for axes, key, name in zip(panels.axes[2 * index:], ("samples", "seconds"), ("samples", "time")):
                draw_errors(panels, axes, own, key, [row[key] for row in rows], f"A {lamp}: error against {name}")
        entries = [Line2D([], [], color=ESTIMATOR_COLOURS[name], marker="o", label=name) for name in unique(row["estimator"] for row in rows)]
        entries += [Line2D([], [], color=TEXT, linestyle=":", label="stated standard error"),
                    Line2D([], [], color=QUIET, linestyle="--", label="1 / √samples")]
        panels.figure.legend(handles=entries, loc="lower center", ncol=3, frameon=False)
        panels.figure.tight_layout(rect=(0, 0.2 / (1 + len(lamps)), 1, 1), w_pad=1.5)
        file = io.StringIO()
        panels.figure.savefig(file, format="svg", metadata={"Date": None})
    return polished(file.getvalue(), panels.titles, "Error of estimates of irradiance against samples and against seconds")


def rendering(method, png):
    name = METHOD_NAMES[method]
    picture = base64.b64encode(png).decode("ascii")
    return f'<figure><h3>{name}</h3><img alt="The box by {html.escape(name)}" src="data:image/png;base64,{picture}"></figure>\n'


def chapter(data, renderings):
    """The section, or "" where nothing was measured. `renderings`: {method: the PNG's bytes}."""
    parts = []
    if data["convergence"]:
        parts.append("<figure><h3>Irradiance against the closed form</h3><figcaption>A lamp behind a screen of which the visible part is known in "
                     "closed form; errors are root mean squares over many places, relative to the whole lamp. Dots are true errors, dotted "
                     f"lines what the estimate itself says.</figcaption>\n{convergence_picture(data['convergence'])}</figure>\n"
                     '<div id="convergence"></div>\n')
    if renderings:
        parts.append(f'<div class="renderings">\n{"".join(rendering(method, png) for method, png in renderings.items())}</div>\n')
    if data["furnace"]:
        parts.append('<div id="furnace"></div>\n')
    return f'<section class="scene" id="light">\n<h2>Light</h2>\n{"".join(parts)}</section>\n' if parts else ""
