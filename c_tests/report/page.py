"""The report as one self-contained page: report.html around the data, with the style and scripts of gnomon-compare's page."""

import html
import json
import pathlib
import re

HERE = pathlib.Path(__file__).parent
COMPARE = HERE.parent / "compare"
METHOD = HERE.parent.parent / "docs" / "METHOD.md"


def included(name):
    """What the C++ pages include: a raw string literal without its delimiters."""
    text = (COMPARE / name).read_text(encoding="utf-8")
    return text.removeprefix('R"html(').rstrip().removesuffix(')html"')


def method():
    """METHOD.md's paragraphs, each "**Term.** text", as a list of definitions."""
    entries = re.findall(r"^\*\*(.+?)\.\*\*\s+(.+?)(?:\n\n|\Z)", METHOD.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    definitions = ((html.escape(term), re.sub(r"`(.+?)`", r"<code>\1</code>", html.escape(text, quote=False))) for term, text in entries)
    return "".join(f"    <dt>{term}</dt>\n    <dd>{text.strip()}</dd>\n" for term, text in definitions)


def script_safe(text):
    """JSON inside a script element: no string of it may end the element."""
    return text.replace("</", "<\\/")


def page(data, picture, light, chart_js):
    """`light`, the chapter, may be empty, and `chart_js`: the page then has tables alone."""
    marks = {
        "STYLE": included("report_style.inc") + (HERE / "report.css").read_text(encoding="utf-8"),
        "PICTURE": picture,
        "LIGHT": light,
        "METHOD": method(),
        "RESULTS": script_safe(json.dumps(data, ensure_ascii=False)),
        "CHART_JS": chart_js,
        "SCRIPT": included("report_common.inc") + included("report_scatter.inc") + (HERE / "report.js").read_text(encoding="utf-8"),
    }
    parts = (HERE / "report.html").read_text(encoding="utf-8").split("{{")
    return parts[0] + "".join(marks[mark] + rest for mark, rest in (part.split("}}", 1) for part in parts[1:]))
