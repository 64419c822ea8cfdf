#!/usr/bin/env python3
"""Runs CalculiX on the meshes and materials of beside_calculix_test.cpp and prints its numbers.

compare.py [RECORD]: with the JSON lines that the test recorded, a Markdown table of both programs'
numbers; without, one line a number. Needs ccx (Debian package calculix-ccx).
"""
import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

KUHN = [(0, 1, 3, 7), (0, 5, 1, 7), (0, 3, 2, 7), (0, 2, 6, 7), (0, 4, 5, 7), (0, 6, 4, 7)]
HEX = [(0, 1, 3, 2, 4, 5, 7, 6)]


def box(size, n, cells):
    """Nodes and elements in the order of mesh/generate_box.cpp, from 1."""
    nodes = [tuple(s * i / m for s, i, m in zip(size, (i, j, k), n))
             for k in range(n[2] + 1) for j in range(n[1] + 1) for i in range(n[0] + 1)]
    row, layer = n[0] + 1, (n[0] + 1) * (n[1] + 1)
    elements = []
    for k in range(n[2]):
        for j in range(n[1]):
            for i in range(n[0]):
                corner = [1 + i + (c & 1) + row * (j + (c >> 1 & 1)) + layer * (k + (c >> 2))
                          for c in range(8)]
                elements += [[corner[c] for c in cell] for cell in cells]
    return nodes, elements


def rectangle(nx, ny):
    """Cook's membrane of make_rectangle's triangles."""
    nodes = [(48 * x, 44 * x + y * (44 - 28 * x), 0.0)
             for y in (j / ny for j in range(ny + 1)) for x in (i / nx for i in range(nx + 1))]
    elements = []
    for j in range(ny):
        for i in range(nx):
            a = 1 + j * (nx + 1) + i
            elements += [[a, a + 1, a + nx + 2], [a, a + nx + 2, a + nx + 1]]
    return nodes, elements


def share(x, size, n, axis):
    """Of a node in a uniform traction on a face across `axis`."""
    s = 1.0
    for j in range(3):
        if j != axis:
            s *= (0.5 if min(x[j], size[j] - x[j]) < 1e-9 * size[j] else 1.0) / n[j]
    return s


class Deck:
    def __init__(self, mesh, element, section="*SOLID SECTION, ELSET=ALL, MATERIAL=M"):
        self.nodes, elements = mesh
        self.text = ["*NODE, NSET=NALL"]
        self.text += [f"{i + 1}, " + ", ".join(f"{c:.15g}" for c in x)
                      for i, x in enumerate(self.nodes)]
        self.text += [f"*ELEMENT, TYPE={element}, ELSET=ALL"]
        self.text += [f"{e + 1}, " + ", ".join(map(str, c)) for e, c in enumerate(elements)]
        self.section = section

    def where(self, test):
        return [i + 1 for i, x in enumerate(self.nodes) if test(*x)]

    def node_set(self, name, nodes):
        self.text += [f"*NSET, NSET={name}"] + [f"{i}," for i in nodes]

    def material(self, *lines):
        self.text += ["*MATERIAL, NAME=M", *lines, "*DENSITY", "1000.", *self.section.split("\n")]

    def neo_hookean(self, E, nu):
        mu, K = E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))
        self.material("*HYPERELASTIC, NEO HOOKE", f"{mu / 2:.15g}, {2 / K:.15g}")

    def elastic(self, E, nu):
        self.material("*ELASTIC", f"{E:.15g}, {nu:.15g}")

    def run(self):
        """Numbers of the .dat file: one list a print block, one tuple a line."""
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "deck.inp").write_text("\n".join(self.text) + "\n")
            out = subprocess.run(["ccx", "-i", "deck"], cwd=folder, capture_output=True, text=True)
            dat = Path(folder, "deck.dat")
            text = dat.read_text() if dat.exists() else ""
        blocks = []
        for line in text.splitlines():
            if re.search(r"(set|for all)", line):
                blocks.append([])
            elif blocks and re.match(r"^[\s\d.E+-]+$", line) and line.strip():
                blocks[-1].append([float(w) for w in line.split()])
        if not any(blocks):
            sys.exit("ccx printed nothing:\n" + out.stdout[-2000:])
        return [b for b in blocks if b]


TIGHT = ["*CONTROLS, PARAMETERS=FIELD", "1e-8, 1e-8,,, 1e-8, 1e-8, 1e-8"]


def step(deck, kind, conditions, nonlinear):
    deck.text += (["*STEP, NLGEOM, INC=10000"] + TIGHT if nonlinear else ["*STEP, INC=10000"])
    deck.text += [*kind, *conditions, "*END STEP"]


def clamp(nodes, first=1, last=3, value=0.0):
    return ["*BOUNDARY"] + [f"{i}, {first}, {last}, {value:.15g}" for i in nodes]


def pull(deck, size, n, axis, direction, force):
    lines = ["*CLOAD"]
    for i, x in enumerate(deck.nodes):
        if x[axis] > size[axis] * (1 - 1e-9):
            lines.append(f"{i + 1}, {direction}, {force * share(x, size, n, axis):.15g}")
    return lines


def small_cantilever():
    size, n = (.1, .02, .02), (10, 2, 2)
    deck = Deck(box(size, n, KUHN), "C3D4")
    deck.node_set("TIP", deck.where(lambda x, y, z: x > .0999 and abs(y - .01) + abs(z - .01) < 1e-9))
    deck.elastic(3000, .3)
    step(deck, ["*STATIC"],
         clamp(deck.where(lambda x, y, z: x < 1e-9)) + pull(deck, size, n, 0, 3, -1e-4)
         + ["*NODE PRINT, NSET=TIP", "U"], False)
    return {"C1 small cantilever, tip u_z [m]": deck.run()[-1][-1][3]}


def gravity_cantilever():
    size, n = (.06, .02, .02), (12, 4, 4)
    deck = Deck(box(size, n, KUHN), "C3D4")
    deck.node_set("TIP", deck.where(lambda x, y, z: x > .0599 and abs(y - .01) + abs(z - .01) < 1e-9))
    deck.neo_hookean(1e4, .45)
    step(deck, ["*STATIC", ".1, 1."],
         clamp(deck.where(lambda x, y, z: x < 1e-9))
         + ["*DLOAD", "ALL, GRAV, 9.81, 0., 0., -1.", "*NODE PRINT, NSET=TIP", "U"], True)
    _, ux, _, uz = deck.run()[-1][-1]
    return {"C2 gravity cantilever, tip u_z [m]": uz, "C2 gravity cantilever, tip u_x [m]": ux}


def bonded_cube(lift, cells=KUHN, element="C3D4", remark=""):
    size, n = (.1, .1, .1), (4, 4, 4)
    deck = Deck(box(size, n, cells), element)
    top, bottom = deck.where(lambda x, y, z: z > .0999), deck.where(lambda x, y, z: z < 1e-9)
    deck.node_set("TOP", top)
    deck.neo_hookean(3000, .45)
    step(deck, ["*STATIC", ".1, 1."],
         clamp(bottom) + clamp(top, 1, 2) + clamp(top, 3, 3, lift)
         + ["*NODE PRINT, NSET=TOP, TOTALS=ONLY", "RF"], True)
    name = f"C3 bonded cube{remark} at {100 * lift / .1:+.0f} %, force [N]"
    return {name: deck.run()[-1][-1][-1]}


def uniaxial(stretch):
    deck = Deck(box((1, 1, 1), (1, 1, 1), HEX), "C3D8")
    top = deck.where(lambda x, y, z: x > .999)
    deck.node_set("TOP", top)
    mu, K = 1000.0, 49000.0
    deck.material("*HYPERELASTIC, NEO HOOKE", f"{mu / 2}, {2 / K:.15g}")
    planes = [clamp(deck.where(lambda *x, j=j: x[j] < 1e-9), j + 1, j + 1) for j in range(3)]
    step(deck, ["*STATIC", ".1, 1."],
         sum(planes, []) + clamp(top, 1, 1, stretch - 1)
         + ["*NODE PRINT, NSET=TOP, TOTALS=ONLY", "RF"], True)
    return {f"C4 uniaxial stretch {stretch}, P11 [Pa]": deck.run()[-1][-1][0]}


def cook():
    n = 16
    deck = Deck(rectangle(n, n), "CPE3", "*SOLID SECTION, ELSET=ALL, MATERIAL=M\n3.")
    deck.node_set("MID", deck.where(lambda x, y, z: abs(x - 48) + abs(y - 52) < 1e-9))
    deck.elastic(70, 1 / 3)
    load = ["*CLOAD"]
    for i in deck.where(lambda x, y, z: x > 48 - 1e-9):
        is_end = min(deck.nodes[i - 1][1] - 44, 60 - deck.nodes[i - 1][1]) < 1e-9
        load.append(f"{i}, 2, {300 / n / (2 if is_end else 1):.15g}")
    step(deck, ["*STATIC"],
         clamp(deck.where(lambda x, y, z: x < 1e-9), 1, 2) + load + ["*NODE PRINT, NSET=MID", "U"],
         False)
    return {"C5 Cook's membrane, plane strain, u_y": deck.run()[-1][-1][2]}


def bar_wave(kind, label):
    size, n = (.1, .01, .01), (20, 2, 2)
    deck = Deck(box(size, n, KUHN), "C3D4")
    deck.node_set("TIP", deck.where(lambda x, y, z: x > .0999 and abs(y - .005) + abs(z - .005) < 1e-9))
    deck.elastic(3000, .3)
    deck.text += ["*AMPLITUDE, NAME=A", "0., 1., 10., 1."]
    load = pull(deck, size, n, 0, 1, 1e-5)
    load[0] = "*CLOAD, AMPLITUDE=A"
    step(deck, kind,
         clamp(deck.where(lambda x, y, z: x < 1e-9)) + load
         + ["*NODE PRINT, NSET=TIP, FREQUENCY=1", "U"], False)
    return {f"C6 pulled bar, u_x of the end at .08 s [m], {label}": deck.run()[-1][-1][1]}


def all_numbers():
    numbers = {}
    for part in (small_cantilever(), gravity_cantilever(), bonded_cube(.02), bonded_cube(-.02),
                 *(bonded_cube(lift, HEX, "C3D8", " of hexahedra") for lift in (.02, -.02)),
                 uniaxial(.8), uniaxial(1.5), cook(),
                 bar_wave(["*DYNAMIC, EXPLICIT", "1e-4, .08"], "explicit"),
                 bar_wave(["*DYNAMIC, DIRECT, ALPHA=0.", "5e-4, .08"], "implicit")):
        numbers.update(part)
    return numbers


def main():
    numbers = all_numbers()
    if len(sys.argv) < 2:
        for name, value in numbers.items():
            print(f"{name}: {value:.7g}")
        return
    ours = {}
    for line in open(sys.argv[1], encoding="utf-8"):
        figure = json.loads(line)
        ours[figure["quantity"]] = figure
    print("| problem | mesh | CalculiX | Trocar | difference |\n|---|---|---|---|---|")
    for name, value in numbers.items():
        if name in ours:
            number = ours[name]["number"]
            print(f"| {name} | {ours[name]['mesh']} | {value:.7g} | {number:.7g} "
                  f"| {number / value - 1:+.1e} |")


if __name__ == "__main__":
    main()
