"""Reads the .vtu files that a study writes with --vtk, by VTK's own reader."""
import re
from dataclasses import dataclass

import numpy as np
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkIdList, vtkLogger, vtkOutputWindow, vtkPoints, vtkStringOutputWindow
from vtkmodules.vtkCommonDataModel import vtkPolyData, vtkStaticPointLocator
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

# What follows the class and address in a message of VTK.
MESSAGE = re.compile(r"\(0x[0-9a-f]+\): (.*)")


class MapError(Exception):
    """What is wrong with the request, in one line."""


@dataclass
class Map:
    """Nodes with numbers."""
    positions: np.ndarray  # (N, 3)
    arrays: dict  # name: (N) or (N, components)
    title: str

    def at(self, chosen, positions=None):
        """The same at some of the nodes, perhaps moved."""
        positions = self.positions if positions is None else positions
        return Map(positions[chosen], {name: a[chosen] for name, a in self.arrays.items()}, self.title)


def parsed(path):
    """The grid in a file; VTK says what is wrong with it in a window of messages."""
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
    messages = vtkStringOutputWindow()
    vtkOutputWindow.SetInstance(messages)
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    # An infinite range, which VTK writes beside vectors but cannot read, is none of our numbers.
    found = [m for m in MESSAGE.findall(messages.GetOutput()) if "InformationKey" not in m]
    if found:
        raise MapError(f"'{path}' is not a .vtu file written by a study: {found[0]}")
    return reader.GetOutput()


def read_vtu(path):
    """The nodes of a file written by a study."""
    try:
        with open(path, "rb"):
            pass
    except OSError as error:
        raise MapError(f"cannot read '{path}': {error.strerror}; give a file written with --vtk") from None
    grid = parsed(path)
    if grid.GetNumberOfPoints() == 0:
        raise MapError(f"'{path}' holds no nodes")
    data = grid.GetPointData()
    arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
    case = grid.GetFieldData().GetAbstractArray("case")
    title = case.GetValue(0) if case is not None and case.GetNumberOfValues() > 0 else ""
    if isinstance(title, bytes):  # paths may hold any byte
        title = title.decode(errors="replace")
    return Map(vtk_to_numpy(grid.GetPoints().GetData()), arrays, title)


def distances(places, rank):
    """Distance of each node (N, 3) to its nearest neighbours elsewhere, of these the `rank`-th."""
    distinct, which = np.unique(places, axis=0, return_inverse=True)
    points = vtkPoints()
    points.SetData(numpy_to_vtk(distinct))
    cloud = vtkPolyData()
    cloud.SetPoints(points)
    locator = vtkStaticPointLocator()
    locator.SetDataSet(cloud)
    locator.BuildLocator()
    found = vtkIdList()
    result = np.zeros(len(distinct))
    for i, place in enumerate(distinct):
        locator.FindClosestNPoints(rank + 1, place, found)
        near = [found.GetId(j) for j in range(found.GetNumberOfIds())]
        result[i] = np.linalg.norm(distinct[near] - place, axis=1).max(initial=0)
    return result[which.ravel()]
