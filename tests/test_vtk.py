#!/usr/bin/python3
"""What --vtk writes, read back by VTK.

Usage: test_vtk.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import unittest

import numpy as np

from study_programs import QUICK, rows_of, run
from vtu_files import GRID, MapTest

VTK_VERTEX = 1


class Steady(MapTest):
    """Cases that solve a problem."""

    def only(self, *arguments):
        ((_, file),) = self.maps("convergence", *arguments).items()
        return file

    def value(self, quantity):
        return next(float(r["value"]) for r in rows_of(self.result.stdout) if r["quantity"] == quantity)

    def test_convergence_writes_fields_errors_and_stencils_of_each_case(self):
        files = self.maps("convergence", *QUICK)
        self.assertEqual(len(files), 2)
        for path, file in files.items():
            self.assertRegex(path.name, r"^convergence_poisson_square_mfpm_[\w.-]+_grid_(9|11)_[0-9a-f]{8}\.vtu$")
            self.assertEqual(list(file.arrays), ["u", "u_error", "stencil_size", "condition_two", "zone"])
            exact = np.sin(2 * file.positions[:, 0] + 1) * np.cos(3 * file.positions[:, 1])
            np.testing.assert_allclose(file.arrays["u_error"], np.abs(file.arrays["u"] - exact), atol=1e-14)
            self.assertLess(file.arrays["u_error"].max(), 0.02)  # level 9 errs by less

    def test_errors_of_nodes_are_those_of_the_table(self):
        for problem in ("bvp_1d", "poisson_square", "poisson_cube"):
            with self.subTest(problem):
                files = self.maps("convergence", "--problem", problem, "--method", "mfpm", "--levels", "9")
                file = next(f for p, f in files.items() if problem in p.name)
                most = file.arrays["u_error"].max() / np.abs(file.arrays["u"]).max()
                # The table divides by the largest exact value, which differs by the error.
                self.assertAlmostEqual(most / self.value("u_max_error"), 1, delta=2 * most)

    def test_stresses_of_a_plate_are_those_of_the_table(self):
        file = self.only("--problem", "plate_hole", "--method", "lsfdm", "--levels", "21")
        names = ["sigma_xx", "sigma_yy", "tau_xy", "von_mises"]
        self.assertEqual(list(file.arrays), ["u", "v", "displacement", *names, "u_error", "v_error",
                                             *(n + "_error" for n in names), "stencil_size", "condition_two", "zone"])
        x, y = file.positions[:, 0], file.positions[:, 1]
        # Kirsch's stress along the tension of 100, the hole's radius being 0.2.
        q, angle = (0.2 / np.hypot(x, y))**2, np.arctan2(y, x)
        exact = 100 * (1 - q * (1.5 * np.cos(2 * angle) + np.cos(4 * angle)) + 1.5 * q**2 * np.cos(4 * angle))
        error = file.arrays["sigma_xx"] - exact
        np.testing.assert_allclose(file.arrays["sigma_xx_error"], np.abs(error), atol=1e-10)
        self.assertAlmostEqual(np.linalg.norm(error) / np.linalg.norm(exact), self.value("stress_xx_error"), delta=1e-12)
        sides = np.linalg.norm([file.arrays["u_error"], file.arrays["v_error"]])
        self.assertAlmostEqual(sides / np.linalg.norm(file.arrays["displacement"]), self.value("displacement_error"),
                               delta=1e-3)  # the table divides by the exact one
        np.testing.assert_array_equal(file.arrays["displacement"],
                                      np.column_stack([file.arrays["u"], file.arrays["v"], 0 * x]))

    def test_elastic_problems_show_stresses_and_the_errors_they_know(self):
        for problem, dim, known in (("thick_cylinder[unknowns=mixed]", 2, True), ("thick_sphere", 3, True),
                                    ("elastic_cube", 3, True), ("cook", 2, False), ("block_bore", 3, False)):
            with self.subTest(problem):
                files = self.maps("convergence", "--problem", problem, "--method", "lsfdm", "--form", "flux",
                                  "--cloud", "scattered", "--levels", "6")
                file = next(f for p, f in files.items() if problem.split("[")[0] in p.name)
                stresses = ["sigma_xx", "sigma_yy", "tau_xy"] if dim == 2 else [
                    "sigma_xx", "sigma_yy", "sigma_zz", "tau_xy", "tau_xz", "tau_yz"]
                fields = list("uvw"[:dim]) + (["p"] if "mixed" in problem else [])
                errors = [n + "_error" for n in [*fields, *stresses, "von_mises"]] if known else []
                self.assertEqual(list(file.arrays), [*fields, "displacement", *stresses, "von_mises", *errors,
                                                     "stencil_size", "condition_two", "zone"])
                for name in list(file.arrays)[:-3]:
                    self.assertTrue(np.isfinite(file.arrays[name]).all(), name)
                if known:  # a coarse cloud, but no other solution: the pressure is 1, the stresses about that
                    self.assertLess(np.median(file.arrays["von_mises_error"]), 0.3 * file.arrays["von_mises"].max())

    def test_nodes_without_a_stencil_have_no_number_of_one(self):
        file = self.only("--problem", "poisson_square[bc=mixed]", "--method", "mfpm", "--stencil",
                         "nearest[k=9,ties=cut]", "--levels", "9")
        x, y = file.positions[:, 0], file.positions[:, 1]
        given = (x == 0) | (y == 0) | (y == 1)  # Dirichlet, as at the corners
        for name in ("stencil_size", "condition_two"):
            np.testing.assert_array_equal(np.isnan(file.arrays[name]), given)
        np.testing.assert_array_equal(file.arrays["stencil_size"][~given], 9)
        self.assertEqual(file.arrays["zone"].sum(), 32)

    def test_conditions_are_those_of_the_study_of_conditions(self):
        arguments = ["--problem", "poisson_square", "--method", "mls", "--levels", "9", "--cloud", "perturbed"]
        steady = self.only(*arguments)
        judged = next(f for p, f in self.maps("conditioning", *arguments).items() if "conditioning" in p.name)
        for name in ("condition_two", "stencil_size"):
            np.testing.assert_array_equal(steady.arrays[name], judged.arrays[name])

    def test_points_beside_the_nodes_add_no_numbers(self):
        file = self.only("--problem", "poisson_square", "--method", "mls[h=1.3]", "--form", "mlpg", "--levels", "7")
        self.assertEqual({name: len(values) for name, values in file.arrays.items()},
                         {"u": 49, "u_error": 49, "stencil_size": 49, "condition_two": 49, "zone": 49})
        self.assertEqual(file.arrays["zone"].sum(), 24)
        self.assertTrue(np.isfinite(file.arrays["condition_two"]).all())

    def test_a_method_of_all_nodes_has_no_condition_of_a_node(self):
        file = self.only("--problem", "poisson_square", "--method", "kansa", "--levels", "7")
        self.assertNotIn("condition_two", file.arrays)
        inside = file.arrays["zone"] == 0
        self.assertEqual(set(file.arrays["stencil_size"][inside]), {49})

    def test_positions_in_every_dimension(self):
        for problem, dim in (("bvp_1d", 1), ("poisson_square", 2), ("poisson_cube", 3)):
            files = self.maps("convergence", "--problem", problem, "--method", "mfpm", "--levels", "9")
            file = next(f for p, f in files.items() if problem in p.name)
            axes = [np.arange(9) / 8] * dim
            expected = np.zeros((9**dim, 3))
            expected[:, :dim] = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, dim)
            np.testing.assert_array_equal(file.positions, expected)

    def test_a_full_disk_fails_the_case(self):
        arguments = [*QUICK[:4], "--levels", "9", "--vtk", self.directory / "maps", "--csv", "-"]
        self.assertEqual(run("convergence", *arguments).returncode, 0)
        (path,) = (self.directory / "maps").iterdir()
        path.unlink()
        path.symlink_to("/dev/full")
        result = run("convergence", *arguments)
        self.assertEqual(result.returncode, 1, result.stderr)
        for row in rows_of(result.stdout):
            self.assertEqual((row["status"], row["value"]), ("failed", ""))
            self.assertIn(f"{path}': No space left", row["reason"])


class Stencils(MapTest):
    """Studies of stencils and of derivatives."""

    def test_a_file_holds_every_node_as_a_vertex(self):
        ((_, file),) = self.maps("conditioning", *GRID).items()
        self.assertEqual((file.grid.GetNumberOfPoints(), file.grid.GetNumberOfCells()), (81, 81))
        self.assertEqual({file.grid.GetCellType(i) for i in range(81)}, {VTK_VERTEX})
        self.assertEqual([file.grid.GetCell(i).GetPointId(0) for i in range(81)], list(range(81)))
        self.assertEqual(file.case, "field, mfpm, stencil nearest[k=9], cloud grid, level 9")

    def test_numbers_of_stencils_are_those_of_the_table(self):
        ((_, file),) = self.maps("conditioning", *GRID).items()
        self.assertEqual(list(file.arrays), ["condition_two", "condition_one", "lebesgue_1", "lebesgue_2", "residual",
                                             "laplacian_centre", "stencil_size", "zone"])
        table = {r["quantity"]: float(r["value"]) for r in rows_of(self.result.stdout) if r["zone"] == "all"}
        for name in list(file.arrays)[:5]:
            self.assertEqual(file.arrays[name].max(), table[f"{name}_max"])
        self.assertEqual((file.arrays["laplacian_centre"] >= 0).sum() / 81, table["centre_sign_wrong"])
        self.assertEqual(file.arrays["zone"].sum(), 32)
        self.assertEqual((file.arrays["stencil_size"][40], file.arrays["stencil_size"].min()), (9, 9))

    def test_singular_stencils_are_infinite(self):
        ((_, file),) = self.maps("conditioning", *GRID[:4], "--stencil", "nearest[k=4,ties=cut]", *GRID[6:]).items()
        self.assertTrue(np.isinf(file.arrays["condition_two"]).all())
        self.assertNotIn("lebesgue_1", file.arrays)
        self.assertEqual(set(file.arrays["stencil_size"]), {4})

    def test_local_accuracy_writes_the_errors_of_its_table(self):
        ((_, file),) = self.maps("local_accuracy", *GRID).items()
        self.assertEqual(list(file.arrays), ["dx_error", "dy_error", "dxx_error", "dxy_error", "dyy_error", "zone"])
        exact = 2 * np.cos(2 * file.positions[:, 0] + 1) * np.cos(3 * file.positions[:, 1])
        for zone, name in ((0, "dx_interior"), (1, "dx_boundary")):
            chosen = file.arrays["zone"] == zone
            error = np.linalg.norm(file.arrays["dx_error"][chosen]) / np.linalg.norm(exact[chosen])
            told = next(float(r["value"]) for r in rows_of(self.result.stdout) if r["quantity"] == name)
            self.assertAlmostEqual(error, told, delta=1e-12)

    def test_a_case_a_file_even_when_specs_look_alike(self):
        files = self.maps("convergence", *QUICK[:4], "--levels", "9", "--stencil",
                          "nearest[k=9],nearest[k=9,ties=cut],grow_until", "--cloud", "grid,perturbed")
        self.assertEqual(len(files), 6)

    def test_the_map_of_another_scaling_replaces_none(self):
        self.maps("conditioning", *GRID)
        files = self.maps("conditioning", *GRID, "--scaling", "row")
        self.assertEqual({next(iter(file.arrays)) for file in files.values()}, {"condition_two", "condition_two_row"})

    def test_what_cannot_be_written_is_refused_before_anything_runs(self):
        self.table.write_text("a file", encoding="utf-8")
        self.assert_refused([*QUICK, "--vtk", self.table], "--vtk", str(self.table))
        self.assert_refused(["--smoke", "--vtk", self.directory], "--vtk", "timing", study="timing")


if __name__ == "__main__":
    unittest.main()
