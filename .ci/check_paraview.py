"""Opens a series of a run in ParaView itself, counts its steps, reads its arrays, and draws one of them off screen.

    xvfb-run -a pvpython .ci/check_paraview.py SERIES.pvd PICTURE.png
"""
import sys
import xml.etree.ElementTree as xml

from paraview import simple


def main():
    series, picture = sys.argv[1:]
    sets = xml.parse(series).getroot().findall(".//DataSet")
    reader = simple.OpenDataFile(series)
    reader.UpdatePipeline()
    steps = list(reader.TimestepValues)
    wanted = sorted({float(step.get("timestep")) for step in sets})
    assert steps == wanted, f"ParaView sees the steps {steps}, the file has {wanted}"
    reader.UpdatePipeline(steps[-1])
    mesh = simple.servermanager.Fetch(reader)
    while not hasattr(mesh, "GetPoints"):
        mesh = mesh.GetBlock(0)
    arrays = [mesh.GetCellData().GetArrayName(k) for k in range(mesh.GetCellData().GetNumberOfArrays())]
    assert mesh.GetNumberOfPoints() > 0 and mesh.GetNumberOfCells() > 0, "ParaView sees nothing"
    assert "fold_angle" in arrays, f"ParaView sees no fold angles, only {arrays}"
    view = simple.CreateRenderView(ViewSize=[1200, 800], OrientationAxesVisibility=0)
    view.UseColorPaletteForBackground = 0
    view.Background = [1, 1, 1]
    simple.GetAnimationScene().AnimationTime = view.ViewTime = steps[len(steps) // 3]
    shown = simple.Show(reader, view)
    simple.ColorBy(shown, ("CELLS", "fold_angle"))
    shown.LineWidth = 3
    shown.RescaleTransferFunctionToDataRange(True)
    colours = simple.GetColorTransferFunction("fold_angle")
    colours.NanColor = [0.85, 0.85, 0.8]
    bar = simple.GetScalarBar(colours, view)
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.Title, bar.ComponentTitle = "fold angle (rad)", ""
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
