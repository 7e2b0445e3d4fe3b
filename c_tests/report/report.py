#!/usr/bin/env python3
"""Joins the results of gnomon-compare, gnomon-hard, gnomon-light and gnomon-render into a page and a picture of speed against error."""

import argparse
import json
import pathlib
import sys

from figures import report_data
from light import METHOD_NAMES, chapter, light_data
from page import page
from picture import speed_against_error


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--compare", type=pathlib.Path, required=True, help="what gnomon-compare --json wrote")
    parser.add_argument("--hard", type=pathlib.Path, help="what gnomon-hard --json wrote; without it the page has no hard cases")
    parser.add_argument("--light", type=pathlib.Path, help="what gnomon-light --json wrote, as optional as all that follow")
    parser.add_argument("--furnace", type=pathlib.Path, help="what gnomon-render --furnace wrote")
    for method, name in METHOD_NAMES.items():
        parser.add_argument(f"--{method}-png", type=pathlib.Path, help=f"a picture of gnomon-render: {name}")
    parser.add_argument("--html", type=pathlib.Path, required=True, help="the page to write")
    parser.add_argument("--svg", type=pathlib.Path, required=True, help="the picture to write")
    parser.add_argument("--chart-js", type=pathlib.Path, default="/usr/share/javascript/chart.js/chart.min.js",
                        help="Chart.js 3, put into the page; tables alone where it is missing")
    return parser.parse_args()


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


def main():
    arguments = parse_arguments()
    compare = load(arguments.compare)
    if not compare["errors"]:
        sys.exit(f"report.py: {arguments.compare} has no errors: gnomon-compare was told to judge no rays")
    optional = lambda path: load(path) if path else None
    data = {**report_data(compare, optional(arguments.hard)), **light_data(optional(arguments.light), optional(arguments.furnace))}
    pictures = {method: getattr(arguments, f"{method}_png") for method in METHOD_NAMES}
    light = chapter(data, {method: path.read_bytes() for method, path in pictures.items() if path})
    picture = speed_against_error(data)
    chart_js = arguments.chart_js.read_text(encoding="utf-8") if arguments.chart_js.exists() else ""
    arguments.svg.write_text(picture, encoding="utf-8")
    arguments.html.write_text(page(data, picture, light, chart_js), encoding="utf-8")


if __name__ == "__main__":
    main()
