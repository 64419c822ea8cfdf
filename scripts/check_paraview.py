"""What ParaView's own reader finds in a recording written by `trocar replay --vtu`; run by scripts/check_paraview.

    pvbatch check_paraview.py plane|block SERIES.pvd SUMMARY.json PICTURE.png
"""
import json
import sys

from paraview import simple
from paraview.numpy_support import vtk_to_numpy

MM = 1e-3


def expect(is_true, sentence):
    if not is_true:
        sys.exit("check_paraview: FAILED: " + sentence)
    print("  " + sentence)


def frame(reader, time):
    """(positions, displacements) of the grid at a time."""
    reader.UpdatePipeline(time)
    grid = reader.GetClientSideObject().GetOutputDataObject(0)
    return vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(grid.GetPointData().GetArray("displacement")), grid.GetNumberOfCells()


def check_sizes(reader, times, first_sizes, summary):
    """The first frame is as the scene says, the last one as the summary says; displacements have three finite components for every point."""
    X, u, n_cells = frame(reader, times[0])
    expect((len(X), n_cells) == first_sizes, f"the first frame has {first_sizes[0]} points and {first_sizes[1]} cells")
    X, u, n_cells = frame(reader, times[-1])
    n_points, n_elements = summary["mesh"]["nodes"], sum(summary["mesh"]["elements"].values())
    expect((len(X), n_cells) == (n_points, n_elements), f"the last frame has the summary's {n_points} points and {n_elements} cells")
    expect(u.shape == X.shape and bool(abs(u).max() < 1), "every point has a finite displacement of three components")


def check_plane(reader, times, summary):
    """20 x 16 nodes, two triangles a cell. The side x+ is pulled by 2 mm until 2.4 s and by 12 mm from 3.4 s on."""
    check_sizes(reader, times, (20 * 16, 2 * 19 * 15), summary)
    expect(summary["wound"]["partner_nodes"] > 0 and summary["mesh"]["nodes"] == 320 + summary["wound"]["partner_nodes"], "the cut's partner nodes are the points that were added")
    for time, pull in ((2.0, 2 * MM), (4.0, 12 * MM)):
        X, u, _ = frame(reader, time)
        side = (X - u)[:, 0] > 70 * MM - 1e-9  # points are shown where they are: X + u
        expect(side.sum() == 16 and bool(abs(u[side] - [pull, 0, 0]).max() < 1e-12), f"at {time} s the 16 nodes of the side x+ are displaced by {pull / MM:g} mm")


def check_block(reader, times, summary):
    """6 x 6 x 6 cells of six tetrahedra, held below, sagging under its weight."""
    check_sizes(reader, times, (7 ** 3, 6 * 6 ** 3), summary)
    X, u, _ = frame(reader, times[-1])
    height = (X - u)[:, 2]
    expect(bool(abs(u[height < 1e-9]).max() == 0), "held nodes have no displacement")
    expect(bool((u[height > 99 * MM][:, 2] < 0).all()), "every node of the upper side has sunk")


def render(reader, time, picture):
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [960, 640]
    view.ViewTime = time
    shown = simple.Show(reader, view)
    simple.ColorBy(shown, ("POINTS", "displacement", "Magnitude"))
    shown.RescaleTransferFunctionToDataRange(False, True)
    shown.SetRepresentationType("Surface With Edges")
    shown.SetScalarBarVisibility(view, True)
    view.CameraPosition = [0.25, -0.35, 0.3] if picture.endswith("block.png") else [0.038, 0.02, 0.13]
    view.CameraFocalPoint = [0, 0, 0.04] if picture.endswith("block.png") else [0.038, 0.02, 0]
    view.CameraViewUp = [0, 0, 1] if picture.endswith("block.png") else [0, 1, 0]
    simple.Render(view)
    simple.SaveScreenshot(picture, view)


def main():
    kind, series, summary_file, picture = sys.argv[1:]
    summary = json.load(open(summary_file))
    reader = simple.PVDReader(FileName=series)
    times = list(reader.TimestepValues)
    wanted = [0.2 * (k + 1) for k in range(round(summary["duration_s"] / 0.2))]
    print(f"{kind}: ParaView {simple.GetParaViewVersion().major}.{simple.GetParaViewVersion().minor}, {series}")
    expect(len(times) == len(wanted) and all(abs(t - w) < 1e-9 for t, w in zip(times, wanted)), f"{len(times)} time steps, every 0.2 s until {times[-1]:g} s")
    {"plane": check_plane, "block": check_block}[kind](reader, times, summary)
    render(reader, times[-1], picture)
    print("  picture: " + picture)


main()
