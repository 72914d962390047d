#!/usr/bin/python3
"""The study dispersion: its table, its numbers against those of the notes, what it refuses.

Usage: test_dispersion.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import csv
import io
import math
import subprocess
import unittest

from study_programs import CONTRACT, DEADLINE, ROOT, StudyTest, rows_of, run

COLUMNS = ["wave", "direction", "branch", "low", "high", "time", "directions", "sampled"]
WAVES = ["0.1", "0.3", "0.5", "0.7", "1"]
SUMMARY = ["symbol_growth", "symbol_radius", "stable_courant"]
PLANE = ["--problem", "bar_2d", "--method", "lsfdm", "--levels", "41"]


class Dispersion(StudyTest):
    def rows(self, *arguments, status=0):
        result = run("dispersion", *arguments, "--csv", "-")
        self.assertEqual(result.returncode, status, result.stderr)
        return rows_of(result.stdout)

    def values(self, rows, quantity, **columns):
        """Numbers of a quantity, in the order of the rows."""
        return [float(r["value"]) for r in rows if r["quantity"] == quantity
                and all(r[c] == v for c, v in columns.items())]

    def test_columns_are_those_of_the_contract_and_of_waves(self):
        result = run("dispersion", "--method", "mfpm", "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(next(csv.reader(io.StringIO(result.stdout))), [*CONTRACT, *COLUMNS, "version"])
        rows = rows_of(result.stdout)
        self.assertEqual([r["wave"] for r in rows if r["quantity"] == "phase_velocity"], WAVES)
        self.assertEqual({r["branch"] for r in rows}, {"P", "all"})
        self.assertEqual({r["time"] for r in rows}, {"central[dt=1e-5]"})
        self.assertEqual([r["quantity"] for r in rows[-3:]], SUMMARY)

    def test_pairs_of_projections_in_1d_give_the_figures_of_the_notes(self):
        """omega / xi of (4.38) with 101 nodes and steps of 1e-5, four digits."""
        for method, k, known in (
                ("mfpm", 3, [.9959, .9634, .9003, .8103, .6366]),
                ("mfpm[projection=linear+quadratic]", 5, [.9844, .8649, .6551, .4074, .1544]),
                ("mfpm[projection=constant+linear]", 5, [.9861, .8804, .6974, .4895, .2847])):
            rows = self.rows("--method", method, "--stencil", f"nearest[k={k}]", "--levels", "101")
            found = self.values(rows, "phase_velocity")
            for value, expected in zip(found, known, strict=True):
                self.assertAlmostEqual(value, expected, delta=0.51e-4)
            for value in self.values(rows, "dissipation"):
                self.assertLess(abs(value), 1e-9)

    def test_three_points_need_the_points_of_the_closed_form(self):
        """sin(y) / y = 0.99 at y = xi h / 2; the radius is 4 and the limit of the step h / c."""
        rows = self.rows("--method", "mfpm", "--stencil", "nearest[k=3]", "--time", "exact")
        (points,) = self.values(rows, "points_per_wavelength")
        half = math.pi / points
        self.assertAlmostEqual(math.sin(half) / half, 0.99, delta=1e-8)
        self.assertAlmostEqual(*self.values(rows, "symbol_radius"), 4, delta=1e-9)
        self.assertAlmostEqual(*self.values(rows, "stable_courant"), 1, delta=1e-9)
        self.assertEqual(self.values(rows, "symbol_growth"), [0])

    def test_steps_of_the_limit_make_three_points_exact(self):
        """With dt = h / c central differences and three points cancel each other's errors."""
        rows = self.rows("--method", "mfpm", "--stencil", "nearest[k=3]", "--time", "central[courant=1]",
                         "--waves", "0.2,0.6")
        for quantity in ("phase_velocity", "group_velocity"):
            for value in self.values(rows, quantity):
                self.assertAlmostEqual(value, 1, delta=1e-9)

    def test_a_grid_has_its_symmetry_in_all_directions(self):
        rows = self.rows(*PLANE, "--waves", "0.4", "--directions", "8")
        for branch in ("P", "S"):
            for quantity in ("phase_velocity", "group_velocity", "points_per_wavelength"):
                values = self.values(rows, quantity, branch=branch)
                self.assertEqual(len(values), 8)
                for i, value in enumerate(values):
                    self.assertAlmostEqual(value, values[(8 - i) % 8], delta=1e-7 * abs(value))
                    self.assertAlmostEqual(value, values[(4 - i) % 8], delta=1e-7 * abs(value))
            ends = [self.values(rows, f"points_per_wavelength_{end}", branch=branch)[0] for end in ("worst", "best")]
            each = self.values(rows, "points_per_wavelength", branch=branch)
            self.assertEqual(ends, [max(each), min(each)])

    def test_several_nodes_of_an_irregular_cloud_give_a_median_and_a_range(self):
        rows = self.rows(*PLANE, "--cloud", "perturbed", "--nodes", "9", "--waves", "0.2")
        self.assertEqual({r["sampled"] for r in rows}, {"9"})
        for row in rows:
            self.assertLessEqual(float(row["low"]), float(row["value"]))
            self.assertLessEqual(float(row["value"]), float(row["high"]))
        self.assertGreater(self.values(rows, "symbol_growth")[0], 0)

    def test_threads_do_not_change_a_bit(self):
        arguments = [*PLANE, "--cloud", "perturbed", "--nodes", "9", "--waves", "0.2", "--csv", "-"]
        one, two = (run("dispersion", *arguments, "--threads", n) for n in (1, 2))
        self.assertEqual(one.stdout, two.stdout)

    def test_a_solid_has_three_branches(self):
        rows = self.rows("--problem", "bar_3d", "--method", "lsfdm", "--levels", "21", "--waves", "0.05",
                         "--directions", "2", "--time", "exact")
        self.assertEqual([r["direction"] for r in rows[:9:3]], ["0:90"] * 3)
        self.assertEqual({r["branch"] for r in rows}, {"P", "S1", "S2", "all"})
        for value in self.values(rows, "phase_velocity"):
            self.assertAlmostEqual(value, 1, delta=0.05)

    def test_a_table_is_continued_only_with_the_same_options(self):
        method = ["--method", "mfpm", "--csv", self.table]
        run("dispersion", *method, "--waves", "0.1,0.2")
        before = self.table.read_bytes()
        run("dispersion", *method, "--waves", "0.1,0.2", "--resume", self.table)
        self.assertEqual(self.table.read_bytes(), before)
        run("dispersion", *method, "--waves", "0.1,0.3", "--resume", self.table)
        waves = [r["wave"] for r in rows_of(self.table.read_text()) if r["quantity"] == "phase_velocity"]
        self.assertEqual(waves, ["0.1", "0.3"])

    def script(self, name, *arguments):
        return subprocess.run([ROOT / "results" / name, *map(str, arguments)], capture_output=True, text=True,
                              check=False, timeout=DEADLINE)

    def test_tables_are_drawn_as_relations_and_by_direction(self):
        run("dispersion", "--method", "mfpm,gfdm", "--csv", self.table)
        result = self.script("plot", self.table, "-o", self.directory)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.directory / "dispersion_bar-1d_grid_relation.png").exists())
        waves = ",".join(f"{0.1 * i:.1f}" for i in range(1, 9))
        run("dispersion", *PLANE, "--waves", waves, "--directions", "8", "--csv", self.table)
        result = self.script("plot", self.table, "-o", self.directory)
        self.assertEqual(result.returncode, 0, result.stderr)
        for kind in ("directions", "points"):
            self.assertTrue((self.directory / f"dispersion_bar-2d_grid_{kind}.png").exists())
        run("dispersion", *PLANE, "--waves", "0.1", "--directions", "2", "--csv", self.table)
        result = self.script("plot", self.table, "-o", self.directory)
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (2, 1))

    def test_points_puts_a_line_per_method_and_stencil(self):
        run("dispersion", "--method", "mfpm,delta", "--stencil", "nearest[k=3]", "--csv", self.table)
        result = self.script("points", self.table)
        self.assertEqual(result.returncode, 0, result.stderr)
        head, _, mfpm, delta = result.stdout.splitlines()
        self.assertEqual(head, "| method | grid: P | grid: growth | grid: step |")
        self.assertEqual(mfpm, "| `mfpm` | 12.8 | 0 | 1 |")
        self.assertIn("none", delta)
        self.assertEqual(self.script("points", self.directory / "absent.csv").returncode, 2)

    def test_what_does_not_fit_is_refused_in_one_line(self):
        for option, value, *words in (("--waves", "0.1,x", "'x'"), ("--waves", "0", "above 0"),
                                      ("--waves", "1.1", "up to 1"), ("--directions", "0", "directions"),
                                      ("--nodes", "-1", "nodes"), ("--time", "later", "later"),
                                      ("--time", "central[dt=0]", "dt")):
            self.assert_refused([option, value], *words, study="dispersion")

    def test_problems_without_waves_are_skipped(self):
        (row,) = self.rows("--problem", "poisson_square", "--method", "mfpm", "--levels", "11")
        self.assertEqual(row["status"], "skipped")
        self.assertIn("not a transient problem", row["reason"])


if __name__ == "__main__":
    unittest.main()
