#!/usr/bin/env python3
"""Makes configs/meshes/liver.msh: a liver-like organ of about 15 cm from an implicit surface, meshed with gmsh.

    scripts/make_liver_mesh.py [EDGE_MM] [OUTPUT]

The organ is a smooth union of ellipsoids (right lobe, left lobe, thin lower edge) with a hollow underside. Marching tetrahedra gives a
triangulated surface, gmsh remeshes it and fills it with tetrahedra. The boundary triangles of the upper back (where the ligaments hold the liver)
become the physical surface "attachment". Needs numpy and the gmsh program (Debian packages python3-numpy, gmsh).
"""
import argparse
import os
import struct
import subprocess
import tempfile

import numpy as np

MM = 1e-3
# Axes of the body: x to the patient's left, y to the back, z to the head. Centre, semi-axes in mm.
ELLIPSOIDS = [
    ((-26.0, 4.0, 2.0), (50.0, 40.0, 33.0)),
    ((4.0, 0.0, 6.0), (46.0, 33.0, 25.0)),
    ((40.0, -2.0, 12.0), (42.0, 24.0, 15.0)),
    ((-30.0, -22.0, -14.0), (38.0, 26.0, 20.0)),
]
HOLLOW = ((14.0, 20.0, -34.0), (46.0, 34.0, 26.0))
BLEND = 10.0  # mm over which neighbouring ellipsoids melt into each other


def ellipsoid_distance(p, centre, axes):
    """First-order signed distance [mm] to an ellipsoid."""
    q = (p - np.array(centre)) / np.array(axes)
    k0 = np.linalg.norm(q, axis=-1)
    k1 = np.linalg.norm(q / np.array(axes), axis=-1)
    return k0 * (k0 - 1.0) / np.maximum(k1, 1e-9)


def smooth_min(a, b):
    h = np.clip(0.5 + 0.5 * (b - a) / BLEND, 0, 1)
    return b * (1 - h) + a * h - BLEND * h * (1 - h)


def organ_distance(p):
    """Negative inside the organ [mm]."""
    d = ellipsoid_distance(p, *ELLIPSOIDS[0])
    for ellipsoid in ELLIPSOIDS[1:]:
        d = smooth_min(d, ellipsoid_distance(p, *ellipsoid))
    return -smooth_min(-d, ellipsoid_distance(p, *HOLLOW))


def marching_tetrahedra(spacing):
    """Closed triangle surface of organ_distance = 0: points (n, 3) [mm], triangles (m, 3)."""
    low, high = np.array([-90.0, -65.0, -50.0]), np.array([95.0, 60.0, 50.0])
    n = np.ceil((high - low) / spacing).astype(int) + 1
    axes = [low[i] + spacing * np.arange(n[i]) for i in range(3)]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), -1).reshape(-1, 3)
    value = organ_distance(grid)
    value[np.abs(value) < 0.05 * spacing] = 0.05 * spacing  # keeps cut points off the grid points

    def number(i, j, k):
        return (i * n[1] + j) * n[2] + k

    i, j, k = np.meshgrid(*[np.arange(m - 1) for m in n], indexing="ij")
    corner = [number(i + a, j + b, k + c).ravel() for a in (0, 1) for b in (0, 1) for c in (0, 1)]
    tets = [(0, 4, 6, 7), (0, 6, 2, 7), (0, 2, 3, 7), (0, 3, 1, 7), (0, 1, 5, 7), (0, 5, 4, 7)]
    points, triangles, known = [], [], {}

    def cut_point(a, b):
        key = (min(a, b), max(a, b))
        if key not in known:
            s = value[key[0]] / (value[key[0]] - value[key[1]])
            known[key] = len(points)
            points.append(grid[key[0]] + s * (grid[key[1]] - grid[key[0]]))
        return known[key]

    for tet in tets:
        ids = np.stack([corner[c] for c in tet], -1)
        inside = (value[ids] < 0).sum(1)
        for row in ids[(inside > 0) & (inside < 4)]:
            ins = [v for v in row if value[v] < 0]
            out = [v for v in row if value[v] >= 0]
            if len(ins) == 2:
                a, b, c, d = (cut_point(ins[0], out[0]), cut_point(ins[0], out[1]),
                              cut_point(ins[1], out[1]), cut_point(ins[1], out[0]))
                faces = [(a, b, c), (a, c, d)]
            else:
                lone, others = (ins[0], out) if len(ins) == 1 else (out[0], ins)
                faces = [tuple(cut_point(lone, v) for v in others)]
            outward = np.mean(grid[out], 0) - np.mean(grid[ins], 0)
            for f in faces:
                p, q, r = (points[v] for v in f)
                triangles.append(f if np.dot(np.cross(q - p, r - p), outward) > 0 else f[::-1])
    return np.array(points), np.array(triangles)


def write_stl(points, triangles, path):
    with open(path, "wb") as file:
        file.write(b"\0" * 80 + struct.pack("<I", len(triangles)))
        for t in triangles:
            file.write(struct.pack("<12fH", 0, 0, 0, *points[t].ravel(), 0))


def gmsh_fill(stl, edge, folder):
    """Remeshes the surface and fills it; returns points [mm], boundary triangles, tetrahedra."""
    script, result = os.path.join(folder, "organ.geo"), os.path.join(folder, "organ.msh")
    with open(script, "w") as file:
        file.write(f"""
Merge "{stl}";
ClassifySurfaces{{Pi, 1, 1, Pi}};
CreateGeometry;
Surface Loop(1) = Surface{{:}};
Volume(1) = {{1}};
Mesh.CharacteristicLengthMin = {edge};
Mesh.CharacteristicLengthMax = {edge};
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1;
Mesh.Optimize = 3;
Mesh.OptimizeThreshold = 0.4;
Mesh.Smoothing = 5;
Mesh.MshFileVersion = 2.2;
Mesh.SaveAll = 1;
""")
    subprocess.run(["gmsh", "-3", script, "-o", result, "-nt", "2"], check=True, stdout=subprocess.DEVNULL)
    with open(result) as file:
        lines = file.read().split("\n")
    start = lines.index("$Nodes")
    n = int(lines[start + 1])
    rows = [line.split() for line in lines[start + 2:start + 2 + n]]
    number = {int(r[0]): i for i, r in enumerate(rows)}
    points = np.array([[float(v) for v in r[1:]] for r in rows])
    start = lines.index("$Elements")
    triangles, tets = [], []
    for line in lines[start + 2:start + 2 + int(lines[start + 1])]:
        row = [int(v) for v in line.split()]
        if row[1] == 2:
            triangles.append([number[v] for v in row[-3:]])
        elif row[1] == 4:
            tets.append([number[v] for v in row[-4:]])
    return points, np.array(triangles), np.array(tets)


def order_along_z_curve(points, tets):
    """Numbers nodes and tetrahedra along a space-filling (Morton) curve, so that neighbours lie near each other in memory."""
    used = np.unique(tets)
    points, tets = points[used], np.searchsorted(used, tets)

    def morton(p):
        q = ((p - points.min(0)) / (points.max(0) - points.min(0)).max() * 1023).astype(np.int64)
        key = np.zeros(len(p), np.int64)
        for bit in range(10):
            for axis in range(3):
                key |= ((q[:, axis] >> bit) & 1) << (3 * bit + axis)
        return key

    order = np.argsort(morton(points), kind="stable")
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    points, tets = points[order], rank[tets]
    tets = tets[np.argsort(morton(points[tets].mean(1)), kind="stable")]
    return points, tets, used, rank


def write_msh(points, attachment, tets, path):
    """Gmsh 2.2, binary."""
    with open(path, "wb") as file:
        file.write(b"$MeshFormat\n2.2 1 8\n" + struct.pack("<i", 1) + b"\n$EndMeshFormat\n")
        file.write(b'$PhysicalNames\n2\n2 1 "attachment"\n3 2 "liver"\n$EndPhysicalNames\n')
        file.write(b"$Nodes\n%d\n" % len(points))
        for i, p in enumerate(points):
            file.write(struct.pack("<iddd", i + 1, *p))
        file.write(b"\n$EndNodes\n$Elements\n%d\n" % (len(attachment) + len(tets)))
        first = 1
        for kind, tag, elements in ((2, 1, attachment), (4, 2, tets)):
            file.write(struct.pack("<iii", kind, len(elements), 2))
            for i, e in enumerate(elements):
                file.write(struct.pack(f"<{3 + len(e)}i", first + i, tag, 1, *(e + 1)))
            first += len(elements)
        file.write(b"\n$EndElements\n")


def main():
    here = os.path.dirname(os.path.abspath(__file__))
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("edge", metavar="EDGE_MM", type=float, nargs="?", default=4.0)
    arguments.add_argument("output", metavar="OUTPUT", nargs="?", default=os.path.join(here, "..", "configs", "meshes", "liver.msh"))
    asked = arguments.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        stl = os.path.join(folder, "organ.stl")
        write_stl(*marching_tetrahedra(2.5), stl)
        points, triangles, tets = gmsh_fill(stl, asked.edge, folder)
    points, tets, used, rank = order_along_z_curve(points, tets)
    triangles = rank[np.searchsorted(used, triangles)]
    centre = points[triangles].mean(1)
    # The bare area: upper back of the right lobe, and the underside on which the organ rests.
    held = ((centre[:, 1] > 16) & (centre[:, 2] > -12)) | (centre[:, 2] < -22)
    d = points[tets]
    volume = np.einsum("ni,ni->n", np.cross(d[:, 1] - d[:, 0], d[:, 2] - d[:, 0]), d[:, 3] - d[:, 0]) / 6
    assert (volume > 0).all(), "gmsh made an inverted element"
    write_msh(points * MM, triangles[held], tets, asked.output)
    print(f"{len(points)} nodes, {len(tets)} tetrahedra, {volume.sum() / 1000:.1f} mL, "
          f"box {np.ptp(points, axis=0)} mm, {held.sum()} of {len(triangles)} boundary triangles held")


if __name__ == "__main__":
    main()
