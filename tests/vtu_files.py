"""What the tests of .vtu files share: running a study with --vtk, and VTK's reader."""
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from study_programs import StudyTest, run

GRID = ["--problem", "field", "--method", "mfpm", "--stencil", "nearest[k=9]", "--cloud", "grid", "--levels",
        "9"]


class VtuFile:
    """A file as VTK reads it."""

    def __init__(self, path):
        reader = vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(path))
        reader.Update()
        self.grid = reader.GetOutput()
        data = self.grid.GetPointData()
        self.positions = vtk_to_numpy(self.grid.GetPoints().GetData())
        self.arrays = {data.GetArrayName(i): vtk_to_numpy(data.GetArray(i)) for i in range(data.GetNumberOfArrays())}
        self.case = self.grid.GetFieldData().GetAbstractArray("case").GetValue(0)


class MapTest(StudyTest):
    def maps(self, study, *arguments):
        """The paths of the .vtu files of a run, each with what VTK reads in it."""
        self.result = run(study, *arguments, "--csv", "-", "--vtk", self.directory / "maps" / "new")
        self.assertEqual(self.result.returncode, 0, self.result.stderr)
        return {path: VtuFile(path) for path in sorted((self.directory / "maps" / "new").iterdir())}
