"""A bracket meshed by Gmsh runs from a case file, and agrees with finite elements on the same mesh."""
import csv
import io
import pathlib
import shutil
import subprocess
import tempfile
import unittest
import xml.etree.ElementTree

from plane_fem import PlaneElasticity
from study_programs import ROOT, run

DATA = ROOT / "problems" / "data"


class BracketMeshedByGmsh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.place = pathlib.Path(cls.folder.name)
        cls.mesh = cls.place / "bracket.msh"
        subprocess.run(["gmsh", "-2", "-format", "msh2", "-clscale", "0.5", "-o", str(cls.mesh), str(DATA / "bracket.geo")],
                       check=True, capture_output=True)
        cls.case = cls.place / "bracket.toml"
        shutil.copy(DATA / "bracket.toml", cls.case)
        bracket = PlaneElasticity(cls.mesh, 210e9, 0.3, "plane_stress")
        for axis in range(2):
            bracket.hold("wall", axis)
        bracket.pull("hook", [0, -1e6])
        bracket.weigh([0, -7.7e4])
        # Within 0.2 % of the limit under refinement.
        cls.tip = bracket.at(bracket.solve(), (0.5, 0.12))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def rows(self, *arguments, case=None):
        done = run("convergence", "--problem", f"elastic[case={case or self.case}]", "--csv", "-", *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return list(csv.DictReader(io.StringIO(done.stdout)))

    def case_with(self, old, new):
        text = self.case.read_text(encoding="utf-8")
        self.assertIn(old, text)
        changed = self.place / "changed.toml"
        changed.write_text(text.replace(old, new), encoding="utf-8")
        return changed

    def assert_tip(self, rows, method, tolerance):
        values = {row["quantity"]: float(row["value"]) for row in rows if row["method"] == method}
        for axis, name in enumerate(("ux_tip", "uy_tip")):
            self.assertAlmostEqual(values[name], self.tip[axis], delta=tolerance * abs(self.tip[1]), msg=name)
        self.assertGreater(values["max_displacement"], abs(values["uy_tip"]))
        self.assertGreater(values["max_von_mises"], values["von_mises_middle"])

    def test_flux_balances_agree_with_finite_elements_on_the_mesh_s_own_nodes(self):
        rows = self.rows("--method", "lsfdm,rbf_fd[degree=4]", "--form", "flux")
        self.assertEqual({row["cloud"] for row in rows}, {"file"})
        self.assert_tip(rows, "lsfdm", 0.005)
        self.assert_tip(rows, "rbf_fd[degree=4]", 0.005)

    def test_collocation_agrees_as_well_as_it_can(self):
        # Tractions are the weak spot of plain collocation: second order is 4 % off, third 0.5 %.
        rows = self.rows("--method", "lsfdm,lsfdm[order=3]")
        self.assert_tip(rows, "lsfdm", 0.06)
        self.assert_tip(rows, "lsfdm[order=3]", 0.02)

    def test_other_clouds_fill_the_same_outline(self):
        rows = self.rows("--method", "lsfdm", "--form", "flux", "--cloud", "scattered", "--levels", "61")
        self.assert_tip(rows, "lsfdm", 0.02)

    def test_fields_are_written_for_paraview(self):
        self.rows("--method", "lsfdm", "--vtk", self.place / "maps")
        file, = (self.place / "maps").glob("*.vtu")
        names = {array.get("Name") for array in xml.etree.ElementTree.parse(file).iter("DataArray")}
        self.assertLessEqual({"displacement", "sigma_xx", "von_mises", "zone"}, names)

    def refusal(self, case):
        done = run("convergence", "--problem", f"elastic[case={case}]")
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)
        return done.stderr

    def test_wrong_and_missing_groups_are_named(self):
        message = self.refusal(self.case_with("[load.hook]", "[load.hok]"))
        self.assertIn("changed.toml, line 14", message)
        self.assertIn("'hok'", message)
        self.assertIn("wall, hook, top, bottom, wide_hole, narrow_hole", message)
        self.assertIn("free to move along x and along y",
                      self.refusal(self.case_with("[support.wall]\nux = 0\nuy = 0\n", "")))
        self.assertIn("nope.msh", self.refusal(self.case_with("bracket.msh", "nope.msh")))
        self.assertIn("nope.toml", self.refusal(self.place / "nope.toml"))

    def test_a_boundary_without_a_group_is_named(self):
        script = (DATA / "bracket.geo").read_text(encoding="utf-8")
        shorter = self.place / "shorter.geo"
        shorter.write_text(script.replace('Physical Curve("top") = {3};', ""), encoding="utf-8")
        subprocess.run(["gmsh", "-2", "-o", str(self.place / "shorter.msh"), str(shorter)], check=True,
                       capture_output=True)
        message = self.refusal(self.case_with("bracket.msh", "shorter.msh"))
        self.assertIn("has no side", message)
        self.assertIn("groups in the file: wall, hook, bottom, wide_hole, narrow_hole", message)

    def test_without_a_case_file_the_option_is_named(self):
        done = run("convergence", "--problem", "elastic")
        self.assertEqual(done.returncode, 2)
        self.assertIn("case=", done.stderr)

    def test_structured_clouds_are_skipped_with_a_remedy(self):
        rows = self.rows("--method", "lsfdm", "--cloud", "grid", "--levels", "9")
        self.assertEqual({row["status"] for row in rows}, {"skipped"})
        self.assertIn("--cloud file", rows[0]["reason"])


class PlateWithASlit(unittest.TestCase):
    """Pulled at both sides, a slit opens; stencils that reach across hold it together."""

    SCRIPT = """
w = 0.004; h = 0.03;
Point(1) = {0, 0, 0, h}; Point(2) = {1, 0, 0, h}; Point(3) = {1, 1, 0, h}; Point(4) = {0.5 + w, 1, 0, h};
Point(5) = {0.5 + w, 0.5, 0, h / 3}; Point(6) = {0.5 - w, 0.5, 0, h / 3};
Point(7) = {0.5 - w, 1, 0, h}; Point(8) = {0, 1, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 5};
Line(5) = {5, 6}; Line(6) = {6, 7}; Line(7) = {7, 8}; Line(8) = {8, 1};
Curve Loop(1) = {1:8}; Plane Surface(1) = {1};
Physical Curve("bottom") = {1}; Physical Curve("right") = {2}; Physical Curve("left") = {8};
Physical Curve("top_right") = {3}; Physical Curve("slit_right") = {4}; Physical Curve("tip") = {5};
Physical Curve("slit_left") = {6}; Physical Curve("top_left") = {7};
Physical Surface("plate") = {1};
"""
    CASE = """
mesh = "slit.msh"
[material]
young = 1
poisson = 0.3
[support.bottom]
ux = 0
uy = 0
[load.left]
traction = [-0.01, 0]
[load.right]
traction = [0.01, 0]
[probe]
left = [0, 1]
right = [1, 1]
"""

    def test_visible_stencils_let_it_open(self):
        with tempfile.TemporaryDirectory() as folder:
            place = pathlib.Path(folder)
            (place / "slit.geo").write_text(self.SCRIPT, encoding="utf-8")
            (place / "slit.toml").write_text(self.CASE, encoding="utf-8")
            subprocess.run(["gmsh", "-2", "-format", "msh2", str(place / "slit.geo")], check=True,
                           capture_output=True)
            plate = PlaneElasticity(place / "slit.msh", 1, 0.3, "plane_strain")
            for axis in range(2):
                plate.hold("bottom", axis)
            plate.pull("left", [-0.01, 0])
            plate.pull("right", [0.01, 0])
            displacements = plate.solve()
            exact = [plate.at(displacements, corner)[0] for corner in ((0, 1), (1, 1))]
            done = run("convergence", "--problem", f"elastic[case={place / 'slit.toml'}]", "--method", "lsfdm",
                       "--stencil", "nearest,visible", "--form", "flux", "--csv", "-")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        errors = {}
        for row in csv.DictReader(io.StringIO(done.stdout)):
            for value, name in zip(exact, ("ux_left", "ux_right")):
                if row["quantity"] == name:
                    errors.setdefault(row["stencil"], []).append(abs(float(row["value"]) / value - 1))
        self.assertLess(max(errors["visible"]), 0.02)
        self.assertGreater(max(errors["nearest"]), 0.1)


if __name__ == "__main__":
    unittest.main()
