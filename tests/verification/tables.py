#!/usr/bin/env python3
"""tables.py RECORD PAGE [--part]: renews the tables of PAGE, which stand between marker comments.

A problem's table becomes what was recorded of it; with --part, what was recorded takes the place
of the rows of the same quantity and mesh, and the others stay.
"""
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

compare = Path(__file__).parent / "calculix" / "compare.py"


def error(figure):
    if figure["reference"] == 0:
        return f"{figure['error']:+.1e}"
    return f"{100 * figure['error']:+.2g} %" if abs(figure["error"]) >= 1e-5 else f"{figure['error']:+.1e}"


def row(figure):
    order = f"{figure['order']:.2f}" if figure["order"] else ""
    reference = f"{figure['reference']:.6g}" if figure["reference"] else "0"
    return (f"| {figure['quantity']} | {figure['mesh']} | {reference} | {figure['source']} "
            f"| {figure['number']:.6g} | {error(figure)} | {order} |")


def between(page, name):
    return page.split(f"<!-- {name} -->")[1].split(f"<!-- end of {name} -->")[0]


def merged(table, newer):
    """Two tables of one head: rows by their first two cells, in the order of the older one."""
    rows = {}
    for line in (table + "\n" + newer).strip().split("\n"):
        rows[tuple(line.split(" | ")[:2])] = line
    return "\n".join(rows.values())


def problem_table(figures, page, is_part):
    """One heading a problem, in the order of their numbers; problems without figures stay as they
    stand on the page."""
    sections = {}
    for section in between(page, "problems").split("### ")[1:]:
        name, rows = section.split("\n", 1)
        sections[name] = rows.strip()
    problems = {}
    for figure in figures:
        problems.setdefault(figure["problem"], []).append(figure)
    for name, group in problems.items():
        head = ["| quantity | mesh | reference | source | Trocar | error | order |",
                "|---|---|---|---|---|---|---|"]
        table = "\n".join(head + [row(figure) for figure in group])
        sections[name] = merged(sections.get(name, ""), table) if is_part else table
    def number(name):
        match = re.match(r"V(\d+)", name)
        return int(match[1]) if match else 1000
    return "\n\n".join(f"### {name}\n\n{sections[name]}"
                       for name in sorted(sections, key=lambda n: (number(n), n)))


def put(page, name, text):
    begin, end = f"<!-- {name} -->", f"<!-- end of {name} -->"
    before, rest = page.split(begin)
    return before + begin + "\n" + text.strip() + "\n" + end + rest.split(end)[1]


def main():
    record, page_file, is_part = sys.argv[1], Path(sys.argv[2]), "--part" in sys.argv[3:]
    figures = [json.loads(line) for line in open(record, encoding="utf-8")]
    page = page_file.read_text(encoding="utf-8")
    page = put(page, "problems",
               problem_table([f for f in figures if f["problem"] != "Beside CalculiX"], page,
                             is_part))
    if any(f["problem"] == "Beside CalculiX" for f in figures) and shutil.which("ccx"):
        table = subprocess.run([sys.executable, compare, record], check=True, capture_output=True,
                               text=True).stdout
        page = put(page, "calculix",
                   merged(between(page, "calculix"), table) if is_part else table)
    page_file.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
