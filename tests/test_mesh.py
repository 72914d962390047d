"""A plate with a hole meshed by Gmsh runs through the studies without a step typed by hand."""
import csv
import io
import pathlib
import subprocess
import tempfile
import unittest

from study_programs import ROOT, run


class PlateMeshedByGmsh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.meshes = []
        for factor in (1.0, 0.5):
            mesh = pathlib.Path(cls.folder.name) / f"plate_{factor}.msh"
            subprocess.run(["gmsh", "-2", "-clscale", str(factor), "-o", str(mesh),
                            str(ROOT / "problems" / "data" / "plate_hole.geo")],
                           check=True, capture_output=True)
            cls.meshes.append(mesh)

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def rows(self, study, *arguments):
        clouds = ",".join(f"file[path={mesh}]" for mesh in self.meshes)
        done = run(study, "--problem", "plate_hole", "--cloud", clouds, "--csv", "-", *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return list(csv.DictReader(io.StringIO(done.stdout)))

    def test_convergence_reports_errors_that_fall_with_the_mesh_size(self):
        rows = self.rows("convergence", "--method", "rbf_fd[degree=3],lsfdm")
        for method in ("rbf_fd[degree=3]", "lsfdm"):
            errors = [float(row["value"]) for row in rows
                      if row["method"] == method and row["quantity"] == "displacement_error"]
            self.assertEqual(len(errors), 2)
            self.assertLess(errors[1], 0.7 * errors[0], method)
            self.assertLess(errors[1], 0.1, method)

    def test_timing_runs_on_the_mesh_too(self):
        rows = self.rows("timing", "--method", "mfpm_original", "--algorithms", "cells")
        self.assertEqual({row["status"] for row in rows}, {"ok"})
        voronoi = [float(row["value"]) for row in rows if row["quantity"] == "voronoi"]
        self.assertTrue(all(seconds > 0 for seconds in voronoi))


if __name__ == "__main__":
    unittest.main()
