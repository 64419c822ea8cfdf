"""A scene made at random from a seed, for scripts/random_scenes: the text of its TOML file, and the mesh file that some of them name."""
import itertools
import math
import random

MESH_FILE, METRICS_FILE, RECORDING_FILE = "mesh.msh", "metrics.csv", "run.trocar"


def millimetres(v):
    return "[" + ", ".join(f'"{x:.6g} mm"' for x in v) + "]"


def numbers(v):
    return "[" + ", ".join(f"{x:.6g}" for x in v) + "]"


def body(draw):
    """(text, size in mm) of a box from the origin, of a plate one or two cells thick, or of a ball or cylinder in a box."""
    kind, is_plate = draw.choice([("box", False), ("box", False), ("box", True), ("ball", False), ("cylinder", False)])
    elements = draw.choice(["hex8", "tet4-kuhn"] + ["tet4-five"] * (kind == "box"))
    size, cells = [draw.uniform(20, 60) for _ in range(3)], [draw.randint(3, 12) for _ in range(3)]
    if is_plate:
        size[2], cells[2] = draw.uniform(2, 6), draw.randint(1, 2)
    if kind != "box":
        size[:2] = [draw.uniform(15, 40)] * 2
        cells[:2] = [2 * draw.randint(2, 5)] * 2
    text = f'[tissue.shape]\nkind = "{kind}"\nelements = "{elements}"\ncells = {cells}\n'
    if kind == "box":
        return text + f"low = [0, 0, 0]\nhigh = {millimetres(size)}\n", size
    radius = size[0] / 2
    if kind == "ball":
        size[2] = size[0]
        return text + f'centre = {millimetres([radius] * 3)}\nradius = "{radius} mm"\n', size
    return text + f'centre = {millimetres([radius, radius, 0])}\nradius = "{radius} mm"\nheight = "{size[2]} mm"\n', size


def file_part(draw, low):
    """(positions, elements, size) of a block in mm that begins at `low`: hexahedra or the six tetrahedra of each, its inner nodes moved at random."""
    cells, size = [draw.randint(2, 7) for _ in range(3)], [draw.uniform(15, 45) for _ in range(3)]
    jitter, has_tets = draw.choice([0, 0.1, 0.2]), draw.random() < 0.5
    nodes, elements = [], []
    for place in itertools.product(*(range(c + 1) for c in cells)):
        moved = [draw.uniform(-jitter, jitter) if 0 < p < c else 0 for p, c in zip(place, cells)]
        nodes.append([o + (p + m) * s / c for o, p, m, s, c in zip(low, place, moved, size, cells)])
    step = [(cells[1] + 1) * (cells[2] + 1), cells[2] + 1, 1]
    for place in itertools.product(*(range(c) for c in cells)):
        first = sum(p * s for p, s in zip(place, step))
        if has_tets:
            for i, j, k in itertools.permutations(step):
                corners = [first, first + i, first + i + j, first + i + j + k]
                is_odd = (i, j, k) in [(step[1], step[0], step[2]), (step[0], step[2], step[1]), (step[2], step[1], step[0])]
                elements.append([corners[c] for c in ((0, 2, 1, 3) if is_odd else (0, 1, 2, 3))])
        else:
            square = [0, step[0], step[0] + step[1], step[1]]
            elements.append([first + s for s in square] + [first + s + step[2] for s in square])
    return nodes, elements, size


def file_body(draw):
    """(text, size, mesh file): one or two blocks side by side, in any order of nodes and elements, of regions "a" and "b"."""
    nodes, elements, size = [], [], [0, 0, 0]
    for _ in range(draw.randint(1, 2)):
        part, cells, extent = file_part(draw, [size[0] + (2 if size[0] else 0), 0, 0])
        elements += [[c + len(nodes) for c in corners] for corners in cells]
        nodes += part
        size = [nodes[-1][0], max(size[1], extent[1]), max(size[2], extent[2])]
    number = list(range(1, len(nodes) + 1))
    draw.shuffle(number)
    draw.shuffle(elements)
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", "2", '3 1 "a"', '3 2 "b"', "$EndPhysicalNames", "$Nodes", str(len(nodes))]
    lines += [" ".join([str(n)] + [repr(x) for x in nodes[i]]) for n, i in sorted((n, i) for i, n in enumerate(number))]
    lines += ["$EndNodes", "$Elements", str(len(elements))]
    for e, corners in enumerate(elements):
        region = 1 if sum(nodes[c][2] for c in corners) < 0.4 * size[2] * len(corners) else 2
        lines.append(" ".join(map(str, [e + 1, 4 if len(corners) == 4 else 5, 2, region, region] + [number[c] for c in corners])))
    text = f'mesh = "{MESH_FILE}"\nscale = "1 mm"\nrenumber = {draw.choice(["true", "false"])}\n'
    return text, size, "\n".join(lines + ["$EndElements", ""])


def plane_body(draw):
    """(text, size in mm) of a rectangle in z = 0."""
    size = [draw.uniform(30, 80), draw.uniform(30, 60), 0]
    text = f'thickness = "{draw.uniform(1, 8):.3g} mm"\n[tissue.shape]\nkind = "{draw.choice(["rectangle", "triangular-rectangle"])}"\n'
    return text + f"high = {millimetres(size)}\ncells = [{draw.randint(5, 40)}, {draw.randint(5, 30)}, 1]\n", size


def material(draw, table, viscous_share):
    """(text, whether it is viscoelastic)"""
    constants = {
        "neo-hookean": "", "linear": "", "mooney-rivlin": 'c10 = "600 Pa"\nc01 = "100 Pa"\n', "yeoh": 'c1 = "500 Pa"\nc2 = "200 Pa"\nc3 = "50 Pa"\n',
        "ogden": 'ogden = [{ mu = "1 kPa", alpha = 2.5 }, { mu = "300 Pa", alpha = -2 }]\n',
        "transversely-isotropic": f'eta = "2 kPa"\nfibre = {numbers([draw.uniform(-1, 1) for _ in range(3)])}\n',
        "holzapfel-gasser-ogden": 'k1 = "1 kPa"\nk2 = 0.8\nkappa = 0.1\nfibre_angle = "30 deg"\n'}
    model = draw.choice(["neo-hookean"] * 4 + sorted(constants))
    text = f'[{table}]\nmodel = "{model}"\npoisson_ratio = {draw.choice([0.3, 0.45, 0.45, 0.48, 0.49])}\n' + constants[model]
    if model not in ("mooney-rivlin", "yeoh", "ogden"):
        text += f'young_modulus = "{draw.uniform(1, 20):.3g} kPa"\n'
    is_viscous = draw.random() < viscous_share
    return text + 'prony = [{ share = 0.4, time = "0.1 s" }]\n' * is_viscous, is_viscous


def solver(draw, is_viscous):
    """(text, whether tissue sleeps)"""
    text = f'[solver]\ngravity = {numbers(draw.choice([(0, 0, 0), (0, 0, -9.81), (3, -4, -5)]))}\nmass_damping = "{draw.choice([0, 5, 15, 60])} 1/s"\n'
    text += f'precision = "{draw.choice(["double", "double", "single"])}"\nhexahedron = "{draw.choice(["one-point", "one-point", "enhanced", "full"])}"\n'
    has_pressures, has_bounds = draw.random() < 0.3, draw.random() < 0.25
    text += f'tetrahedron = "{"nodal-pressure" if has_pressures else "linear"}"\nstable_step = "{"element-bound" if has_bounds else "frequency"}"\n'
    extra = draw.choice(["", "", "", "multirate", "scaling", "sleep"])
    if extra == "multirate" and not (is_viscous or has_pressures or has_bounds):
        text += "multirate = true\n"
    if extra == "scaling":
        text += f'mass_scaling_step = "{draw.choice([0.3, 0.6, 1])} ms"\n'
    does_sleep = extra == "sleep" and not is_viscous
    return text + 'sleep = "0.05 mm"\n' * does_sleep, does_sleep


def supports(draw, size, duration):
    foot = [999, 999, size[2] / 4] if size[2] else [999, size[1] / 4, 1]
    text = f'[[region]]\nname = "foot"\nlow = [-1, -1, -1]\nhigh = {millimetres(foot)}\n'
    text += f'[[support]]\nregion = "foot"\nfix = "{draw.choice(["xyz", "xyz", "xyz", "z"])}"\n'
    if draw.random() < 0.2:
        text += f'[[region]]\nname = "flank"\nlow = {millimetres([0.8 * size[0], -99, size[2] / 3])}\nhigh = [1, 1, 1]\n[[support]]\nregion = "flank"\n'
        text += f'path = [{{ time = 0, displacement = [0, 0, 0] }}, {{ time = {duration}, displacement = ["3 mm", "1 mm", "0 mm"] }}]\n'
    return text


def load(draw, size, duration):
    """A force or a pressure, or both, on what lies high or far along y; it may come on late."""
    low = [-999, -999, 0.7 * size[2]] if size[2] else [-999, 0.7 * size[1], -1]
    text = f'[[region]]\nname = "loaded"\nlow = {millimetres(low)}\nhigh = [1, 1, 1]\n[[load]]\nregion = "loaded"\n'
    text += f"force = {numbers([draw.uniform(-0.3, 0.3) for _ in range(3)])}\n"
    text += f"pressure = {draw.choice([0, 0, 100, -100, 300])}\n"
    if draw.random() < 0.5:
        text += f"path = [{{ time = 0, factor = {draw.choice([0, 0.5])} }}, {{ time = {duration / 2}, factor = 1 }}]\n"
    return text


def key(time_s, position, direction, forward=None, action="none"):
    text = f'{{ time = {time_s:.6g}, position = {millimetres(position)}, direction = {numbers(direction)}, action = "{action}"'
    return text + (f", forward = {numbers(forward)}" if forward else "") + " }"


def scalpel_keys(draw, x, y, top, down, middle, duration):
    """A cut along a line that may turn back, bend or leave the tissue."""
    angle, depth = draw.uniform(0, 2 * math.pi), draw.uniform(0.1, 1.2) * top
    way = [math.cos(angle), math.sin(angle), draw.uniform(-0.3, 0.3) if top else 0]
    start = [x, y, top + 5] if draw.random() < 0.5 else [x - 40 * way[0], y - 40 * way[1], top - depth]
    at, speed, n_legs = [x, y, top - depth], draw.choice([100, 300, 800]), draw.choice([1, 1, 2, 4])
    keys = [key(0, start, down, way), key(middle, at, down, way)]
    for leg in range(n_legs):
        far = min(60, speed * (duration - middle) / n_legs)
        at = [at[k] + far * way[k] for k in range(3)]
        down = [down[0] + draw.uniform(-0.4, 0.4), down[1], -1]
        keys.append(key(middle + (leg + 1) * (duration - middle) / n_legs, at, down, way))
        angle += draw.choice([0.5, -0.5, math.pi])
        way = [math.cos(angle), math.sin(angle), way[2]]
    return keys


def plane_instrument(draw, name, size, duration):
    """In the plane z = 0: what a probe touches from the side, what a grasper holds and a scalpel cuts from above."""
    kind = draw.choice(["probe", "grasper", "scalpel", "scalpel"])
    x, y, middle = draw.uniform(0.1, 0.9) * size[0], draw.uniform(0.1, 0.9) * size[1], draw.uniform(0.3, 0.6) * duration
    text = f'[[instrument]]\nkind = "{kind}"\nname = "{name}"\n'
    if kind == "probe":
        text += f'radius = "{draw.uniform(2, 6):.3g} mm"\n'
        keys = [key(0, [x, size[1] + 15, 0], [0, -1, 0]), key(middle, [x, size[1], 0], [0, -1, 0]), key(duration, [x + 5, size[1] + 9, 0], [0, -1, 0])]
    elif kind == "grasper":
        text += f'radius = "2 mm"\ngrip_radius = "{draw.uniform(6, 12):.3g} mm"\n'
        keys = [key(0, [x, size[1] + 9, 0], [0, -1, 0], action="open"), key(0.21, [x, size[1], 0], [0, -1, 0], action="close"),
                key(0.5, [x, size[1] + 4, 0], [0, -1, 0])]
    else:
        text += 'radius = "1 mm"\nblade_length = "8 mm"\n'
        keys = scalpel_keys(draw, x, y, 0, [0, 0, -1], middle, duration)
    return text + "path = [\n  " + ",\n  ".join(keys) + " ]\n"


def instrument(draw, name, size, duration):
    kind = draw.choice(["probe", "grasper", "scalpel", "scalpel", "scissors"])
    x, y, top = draw.uniform(0.1, 0.9) * size[0], draw.uniform(0.1, 0.9) * size[1], size[2]
    down, middle = [draw.uniform(-0.3, 0.3), draw.uniform(-0.3, 0.3), -1], draw.uniform(0.3, 0.6) * duration
    text = f'[[instrument]]\nkind = "{kind}"\nname = "{name}"\n'
    if kind == "probe":
        text += f'radius = "{draw.uniform(2, 6):.3g} mm"\n'
        keys = [key(0, [x, y, top + 25], down), key(middle, [x, y, (1 - draw.uniform(0, 0.15)) * top], down),
                key(duration, [x + draw.uniform(-8, 8), y, top + 5], down)]
    elif kind == "grasper":
        text += f'radius = "2 mm"\ngrip_radius = "{draw.uniform(6, 12):.3g} mm"\n'
        keys = [key(0, [x, y, top + 20], down), key(0.3 * duration, [x, y, top + 1], down, action="open"),
                key(0.3 * duration + 0.2, [x, y, top + 1], down, action="close"), key(0.3 * duration + 0.5, [x, y, top + 10], down)]
    elif kind == "scissors":
        text += f'radius = "1.5 mm"\nblade_length = "{draw.uniform(10, 25):.3g} mm"\n'
        keys = [key(0, [x, y, top + 25], down, action="open"), key(0.21, [x, y, top - draw.uniform(0, 10)], down),
                key(0.41, [x, y, top - 5], down, action="close"), key(0.61, [x, y, top + 9], down)]
    else:
        text += f'radius = "1 mm"\nblade_length = "{draw.uniform(10, 80):.3g} mm"\n'
        keys = scalpel_keys(draw, x, y, top, down, middle, duration)
    return text + "path = [\n  " + ",\n  ".join(keys) + " ]\n"


def scene(seed):
    """(text of the scene file, text of MESH_FILE or None)"""
    draw, mesh = random.Random(seed), None
    duration, family = draw.choice([0.2, 0.3, 0.5]), draw.choice(["shape", "shape", "file", "file", "plane"])
    if family == "file":
        shape, size, mesh = file_body(draw)
    else:
        shape, size = body(draw) if family == "shape" else plane_body(draw)
    tissue, is_viscous = material(draw, "tissue.material", 0.2)
    if mesh and draw.random() < 0.5:
        second, is_second_viscous = material(draw, "tissue.region_material.material", 0.2)
        tissue, is_viscous = f'{tissue}[[tissue.region_material]]\nregion = "b"\n{second}', is_viscous or is_second_viscous
    steps, does_sleep = solver(draw, is_viscous)
    touches = draw.random() < 0.5 and not does_sleep and family != "plane"
    parts = [f'name = "seed {seed}"\n[time]\nduration = {duration}\nframe_rate = {draw.choice([30, 60, 100])}\n[tissue]\n' + shape, tissue, steps,
             f'[contact]\nfriction = {draw.choice([0, 0.1, 0.5])}\ntissue = {"true" if touches else "false"}\n',
             f'[cutting]\nadvance = {draw.choice([0.25, 0.5, 1, 2])}\nresistance = "{draw.choice([0, 5, 30])} N/m"\n'
             f"least_step_ratio = {draw.choice([0.3, 0.75, 0.75, 0.9])}\nsplit_step_ratio = {draw.choice([0, 0.35, 0.35, 0.5])}\n", '[checkpoint]\nevery = "0.1 s"\n', supports(draw, size, duration)]
    if draw.random() < 0.3:
        parts.append('[start]\nstate = "equilibrium"\n')
    add = plane_instrument if family == "plane" else instrument
    parts += [add(draw, f"i{k}", size, duration) for k in range(draw.choice([0, 1, 2, 2, 3, 4]))]
    parts.append(f'[[output]]\nkind = "metrics"\nfile = "{METRICS_FILE}"\n')
    if draw.random() < 0.5:
        parts.append(f'[[output]]\nkind = "recording"\nfile = "{RECORDING_FILE}"\n')
    if draw.random() < 0.3:
        parts.append(load(draw, size, duration))
    if draw.random() < 0.3 and family != "file":
        middle = [s / 2 for s in size]
        parts.append(f'[[marker]]\nname = "middle"\nposition = {millimetres(middle)}\n')
    return "\n".join(parts), mesh
