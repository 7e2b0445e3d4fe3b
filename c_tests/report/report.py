#!/usr/bin/env python3
"""Joins the results of gnomon-compare and gnomon-hard into a page and a picture of speed against error."""

import argparse
import json
import pathlib
import sys

from figures import report_data
from page import page
from picture import speed_against_error


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--compare", type=pathlib.Path, required=True, help="what gnomon-compare --json wrote")
    parser.add_argument("--hard", type=pathlib.Path, help="what gnomon-hard --json wrote; without it the page has no hard cases")
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
    data = report_data(compare, load(arguments.hard) if arguments.hard else None)
    picture = speed_against_error(data)
    chart_js = arguments.chart_js.read_text(encoding="utf-8") if arguments.chart_js.exists() else ""
    arguments.svg.write_text(picture, encoding="utf-8")
    arguments.html.write_text(page(data, picture, chart_js), encoding="utf-8")


if __name__ == "__main__":
    main()
