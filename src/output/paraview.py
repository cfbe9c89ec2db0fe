"""Shows SERIES_NAME.pvd in ParaView: faces in the colour of paper, creases as tubes, mountains red and valleys blue.

In ParaView: File > Load State..., this file. In a shell, for a picture of the last state, or of the one with this number:

    pvpython SERIES_NAME-paraview.py PICTURE.png [STATE]
"""
import math
import os
import sys

from paraview import simple

SERIES = os.path.join(os.path.dirname(os.path.abspath(__file__)), "SERIES_NAME.pvd")
MOUNTAIN, FLAT, VALLEY = (0.78, 0.22, 0.18), (0.92, 0.91, 0.88), (0.11, 0.38, 0.69)
PAPER, BACK = [1.0, 0.98, 0.94], [0.94, 0.84, 0.66]


def part(reader, array, low, high):
    """The cells whose number in this array is in a range; none where it is NaN."""
    cells = simple.Threshold(Input=reader, Scalars=["CELLS", array])
    cells.LowerThreshold, cells.UpperThreshold = low, high
    return cells


def sharpest_fold(reader):
    """The largest fold angle of all states, pi at most: the end of the scale of colours."""
    largest = 0.0
    for time in reader.TimestepValues:
        reader.UpdatePipeline(time)
        low, high = reader.CellData["fold_angle"].GetRange()
        largest = max([largest] + [abs(angle) for angle in (low, high) if angle == angle and abs(angle) < 1e9])
    return min(largest, math.pi) or 1.0


def colours(largest):
    """The scale of fold angles, as wide on both sides of flat."""
    scale = simple.GetColorTransferFunction("fold_angle")
    scale.AutomaticRescaleRangeMode = "Never"
    scale.RGBPoints = [-largest, *MOUNTAIN, 0.0, *FLAT, largest, *VALLEY]
    scale.ColorSpace = "RGB"
    return scale


def show(reader, view):
    """Adds faces, edges and creases to a view; returns how the creases are shown."""
    low, high = reader.GetDataInformation().GetBounds()[::2], reader.GetDataInformation().GetBounds()[1::2]
    size = sum((b - a) ** 2 for a, b in zip(low, high)) ** 0.5
    faces = simple.Show(part(reader, "edge", -1, -1), view)
    simple.ColorBy(faces, None)
    faces.DiffuseColor, faces.AmbientColor, faces.BackfaceDiffuseColor = PAPER, PAPER, BACK
    faces.BackfaceRepresentation = "Surface"
    edges = simple.Show(part(reader, "edge", 0, 2**31 - 1), view)
    simple.ColorBy(edges, None)
    edges.DiffuseColor = edges.AmbientColor = [0.35, 0.35, 0.35]
    edges.LineWidth = 1.0
    lines = simple.ExtractSurface(Input=part(reader, "fold_angle", -1e9, 1e9))
    tubes = simple.Tube(Input=lines, Radius=0.003 * size)
    tubes.Scalars, tubes.VaryRadius = ["POINTS", ""], "Off"
    creases = simple.Show(tubes, view)
    simple.ColorBy(creases, ("CELLS", "fold_angle"))
    return creases


def legend(bar, largest):
    """The words and numbers beside the scale of colours."""
    edge = math.floor(100 * largest) / 100  # a number just within the range
    bar.Title, bar.ComponentTitle = "fold angle (rad): mountain < 0 < valley", ""
    bar.TitleColor = bar.LabelColor = [0.0, 0.0, 0.0]
    bar.UseCustomLabels, bar.CustomLabels, bar.AddRangeLabels = True, [-edge, 0.0, edge], False
    bar.LabelFormat = "%.2f"


def main():
    reader = simple.OpenDataFile(SERIES)
    largest = sharpest_fold(reader)
    view = simple.GetActiveViewOrCreate("RenderView")
    view.UseColorPaletteForBackground, view.Background = 0, [1.0, 1.0, 1.0]
    if len(sys.argv) > 1:
        view.ViewSize = [1200, 800]
    scene = simple.GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.GoToLast()
    if len(sys.argv) > 2:
        scene.AnimationTime = view.ViewTime = float(sys.argv[2])
    creases = show(reader, view)
    scale = colours(largest)
    legend(simple.GetScalarBar(scale, view), largest)
    creases.SetScalarBarVisibility(view, True)
    view.ResetActiveCameraToNegativeZ()
    camera = simple.GetActiveCamera()
    camera.Elevation(-40)
    camera.Azimuth(25)
    simple.ResetCamera(view)
    simple.Render(view)
    if len(sys.argv) > 1:
        simple.SaveScreenshot(sys.argv[1], view)


main()
