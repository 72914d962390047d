#!/usr/bin/python3
"""The studies of stencils: conditioning.

Usage: test_stencil_studies.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import csv
import io
import itertools
import unittest

from study_programs import CONTRACT, StudyTest, names_in, rows_of, run

STATISTICS = ["min", "median", "p99", "max"]
GRID = ["--problem", "field", "--method", "mfpm", "--stencil", "nearest[k=9]", "--cloud", "grid"]


class Conditioning(StudyTest):
    def values(self, *arguments, status=0):
        """Rows by quantity and zone."""
        result = run("conditioning", *arguments, "--csv", "-")
        self.assertEqual(result.returncode, status, result.stderr)
        return {(r["quantity"], r["zone"]): r for r in rows_of(result.stdout)}

    def test_columns_are_those_of_the_contract_and_the_zone(self):
        result = run("conditioning", *GRID, "--levels", "9,11", "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(next(csv.reader(io.StringIO(result.stdout))), [*CONTRACT, "zone", "version"])
        figures = ("condition_two", "condition_one", "lebesgue_1", "lebesgue_2", "residual")
        expected = {f"{f}_{s}" for f, s in itertools.product(figures, STATISTICS)} | {"centre_sign_wrong"}
        for level in ("9", "11"):
            for zone in ("all", "interior", "boundary"):
                rows = [r for r in rows_of(result.stdout) if (r["level"], r["zone"]) == (level, zone)]
                self.assertEqual({r["quantity"] for r in rows}, expected)
                self.assertEqual({(r["rate"], r["status"], r["reason"]) for r in rows}, {("", "ok", "")})

    def test_a_perfect_grid_has_the_conditions_of_the_notes(self):
        rows = self.values(*GRID, "--levels", "11")
        for quantity, zone, expected, digits in (("max", "interior", 12.0, 1), ("min", "boundary", 79.5, 1),
                                                 ("max", "boundary", 334, 0), ("max", "all", 334, 0)):
            value = float(rows[f"condition_two_{quantity}", zone]["value"])
            self.assertEqual(round(value, digits), expected)
        self.assertEqual(float(rows["centre_sign_wrong", "interior"]["value"]), 0)
        self.assertLess(float(rows["residual_max", "all"]["value"]), 1e-12)

    def test_row_scaling_is_another_quantity_that_grows_as_the_spacing_shrinks(self):
        coarse, fine = (self.values(*GRID, "--levels", n, "--scaling", "row") for n in (11, 21))
        self.assertNotIn(("condition_two_max", "all"), coarse)
        ratio = (float(fine["condition_two_row_max", "interior"]["value"])
                 / float(coarse["condition_two_row_max", "interior"]["value"]))
        self.assertAlmostEqual(ratio, 2, delta=0.1)

    def test_a_singular_stencil_is_a_reason_and_no_failure(self):
        rows = self.values("--problem", "field", "--method", "mfpm", "--stencil", "nearest[k=4,ties=cut]",
                           "--cloud", "grid", "--levels", "9")
        for quantity in ("condition_two_max", "condition_one_max", "lebesgue_2_max", "centre_sign_wrong"):
            row = rows[quantity, "all"]
            self.assertEqual((row["status"], row["value"]), ("ok", ""))
            self.assertNotEqual(row["reason"], "")
        self.assertIn("81 of 81 stencils", rows["condition_two_max", "all"]["reason"])
        self.assertIn("larger k", rows["lebesgue_2_max", "all"]["reason"])

    def test_every_method_and_every_problem_is_served_or_says_why(self):
        rows = run("conditioning", "--method", "all", "--levels", "9", "--csv", "-")
        self.assertEqual(rows.returncode, 0, rows.stderr + rows.stdout)
        by_method = {r["method"]: r["status"] for r in rows_of(rows.stdout)}
        self.assertEqual(list(by_method), names_in("methods/methods.def"))
        self.assertEqual(by_method["mfpm"], "ok")
        rows = run("conditioning", "--problem", "all", "--method", "mfpm", "--cloud", "grid", "--levels",
                   "9", "--csv", "-")
        self.assertEqual(rows.returncode, 0, rows.stderr + rows.stdout)
        self.assertEqual(list(dict.fromkeys(r["problem"] for r in rows_of(rows.stdout))),
                         names_in("problems/problems.def"))

    def test_one_and_two_threads_give_the_same_table(self):
        one, two = (run("conditioning", "--levels", "11", "--threads", n, "--csv", "-").stdout for n in (1, 2))
        self.assertEqual(one, two)


if __name__ == "__main__":
    unittest.main()
