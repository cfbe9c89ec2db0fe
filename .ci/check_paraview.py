"""Opens a series of a run in ParaView itself, counts its steps, and reads its arrays.

    pvpython .ci/check_paraview.py SERIES.pvd
"""
import sys
import xml.etree.ElementTree as xml

from paraview import simple


def main():
    series = sys.argv[1]
    sets = xml.parse(series).getroot().findall(".//DataSet")
    reader = simple.OpenDataFile(series)
    reader.UpdatePipeline()
    steps = list(reader.TimestepValues)
    wanted = sorted({float(step.get("timestep")) for step in sets})
    assert steps == wanted, f"ParaView sees the steps {steps}, the file has {wanted}"
    reader.UpdatePipeline(steps[len(steps) // 3])
    mesh = simple.servermanager.Fetch(reader)
    while not hasattr(mesh, "GetPoints"):
        mesh = mesh.GetBlock(0)
    arrays = [mesh.GetCellData().GetArrayName(k) for k in range(mesh.GetCellData().GetNumberOfArrays())]
    assert mesh.GetNumberOfPoints() > 0 and mesh.GetNumberOfCells() > 0, "ParaView sees nothing"
    assert "fold_angle" in arrays, f"ParaView sees no fold angles, only {arrays}"
    print(f"ParaView: {len(steps)} steps, {mesh.GetNumberOfPoints()} points, arrays {', '.join(arrays)}")


main()
