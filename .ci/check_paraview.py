"""Opens a series of a run in ParaView itself, counts its steps, reads its arrays, and draws one of them off screen.

    xvfb-run -a pvpython .ci/check_paraview.py SERIES.pvd PICTURE.png
"""
import math
import sys
import xml.etree.ElementTree as xml

from paraview import simple

# as in the SVG pictures: mountains (negative fold angles) red, valleys blue
MOUNTAIN, FLAT, VALLEY = (200, 55, 45), (235, 232, 224), (29, 98, 176)


def fold_colours(mesh):
    """The colours of fold angles, as wide on both sides of flat as the sharpest fold; and that fold."""
    angles = mesh.GetCellData().GetArray("fold_angle")
    known = [angles.GetValue(k) for k in range(angles.GetNumberOfTuples()) if angles.GetValue(k) == angles.GetValue(k)]
    sharpest = max((abs(angle) for angle in known), default=1.0) or 1.0
    colours = simple.GetColorTransferFunction("fold_angle")
    colours.AutomaticRescaleRangeMode = "Never"
    points = zip((-sharpest, 0.0, sharpest), (MOUNTAIN, FLAT, VALLEY))
    colours.RGBPoints = [number for angle, rgb in points for number in (angle, *(part / 255 for part in rgb))]
    colours.ColorSpace = "RGB"
    colours.NanColor = [0.85, 0.85, 0.8]
    return colours, sharpest


def main():
    series, picture = sys.argv[1:]
    sets = xml.parse(series).getroot().findall(".//DataSet")
    reader = simple.OpenDataFile(series)
    reader.UpdatePipeline()
    steps = list(reader.TimestepValues)
    wanted = sorted({float(step.get("timestep")) for step in sets})
    assert steps == wanted, f"ParaView sees the steps {steps}, the file has {wanted}"
    shown_step = steps[len(steps) // 3]
    reader.UpdatePipeline(shown_step)
    mesh = simple.servermanager.Fetch(reader)
    while not hasattr(mesh, "GetPoints"):
        mesh = mesh.GetBlock(0)
    arrays = [mesh.GetCellData().GetArrayName(k) for k in range(mesh.GetCellData().GetNumberOfArrays())]
    assert mesh.GetNumberOfPoints() > 0 and mesh.GetNumberOfCells() > 0, "ParaView sees nothing"
    assert "fold_angle" in arrays, f"ParaView sees no fold angles, only {arrays}"
    view = simple.CreateRenderView(ViewSize=[1200, 800], OrientationAxesVisibility=0)
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    simple.GetAnimationScene().AnimationTime = view.ViewTime = shown_step
    shown = simple.Show(reader, view)
    simple.ColorBy(shown, ("CELLS", "fold_angle"))
    shown.LineWidth = 3
    colours, sharpest = fold_colours(mesh)
    bar = simple.GetScalarBar(colours, view)
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.Title, bar.ComponentTitle = "fold angle (rad): mountain < 0 < valley", ""
    edge = math.floor(100 * sharpest) / 100  # a number just within the range
    bar.UseCustomLabels, bar.CustomLabels, bar.AddRangeLabels = True, [-edge, 0.0, edge], False
    bar.LabelFormat = "%.2f"
    shown.SetScalarBarVisibility(view, True)
    view.ResetActiveCameraToPositiveZ()
    camera = simple.GetActiveCamera()
    camera.Elevation(-40)
    camera.Azimuth(25)
    simple.ResetCamera(view)
    camera.Zoom(1.4)
    simple.SaveScreenshot(picture, view)
    print(f"ParaView: {len(steps)} steps, {mesh.GetNumberOfPoints()} points, arrays {', '.join(arrays)}")


main()
