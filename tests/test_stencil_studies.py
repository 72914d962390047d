#!/usr/bin/python3
"""The studies of stencils: conditioning and selection.

Usage: test_stencil_studies.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import csv
import io
import itertools
import unittest

from study_programs import CONTRACT, TIMES, StudyTest, names_in, rows_of, run

STATISTICS = ["min", "median", "p99", "max"]
GRID = ["--problem", "field", "--method", "mfpm", "--stencil", "nearest[k=9]", "--cloud", "grid"]
SIZES = ["size_min", "size_mean", "size_max", "condition_median", "condition_max", "over_limit"]
ERRORS = ["u_error", "u_max_error"]
POISSON = ["--problem", "poisson_square", "--levels", "11", "--csv", "-"]


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


class Selection(StudyTest):
    def test_table_holds_sizes_conditions_errors_and_times(self):
        result = run("selection", *POISSON, "--stencil", "nearest[k=9],grow_until")
        self.assertEqual(result.returncode, 0, result.stderr)
        header = next(csv.reader(io.StringIO(result.stdout)))
        self.assertEqual(header, [*CONTRACT, *TIMES, "version"])
        for stencil in ("nearest[k=9]", "grow_until"):
            rows = [r for r in rows_of(result.stdout) if r["stencil"] == stencil]
            self.assertEqual([r["quantity"] for r in rows], SIZES + ERRORS)
            sizes = [float(r["value"]) for r in rows[:3]]
            self.assertEqual(sizes, sorted(sizes))
            for row in rows:
                self.assertEqual((row["status"], row["rate"]), ("ok", ""))
                self.assertGreaterEqual(float(row["t_total"]), float(row["t_stencils"]))

    def test_a_field_is_judged_at_every_node_by_the_errors_of_local_accuracy(self):
        arguments = [*GRID, "--levels", "9", "--csv", "-"]
        result = run("selection", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = rows_of(result.stdout)
        errors = rows_of(run("local_accuracy", *arguments).stdout)
        self.assertEqual([r["quantity"] for r in rows], SIZES + [r["quantity"] for r in errors])
        self.assertEqual([r["value"] for r in rows[len(SIZES):]], [r["value"] for r in errors])
        conditions = rows_of(run("conditioning", *arguments).stdout)
        self.assertEqual(rows[SIZES.index("condition_max")]["value"],
                         next(r["value"] for r in conditions if r["quantity"] == "condition_two_max"))
        for row in rows:
            self.assertGreater(float(row["t_weights"]), 0)
            self.assertEqual((row["t_assemble"], row["t_solve"]), ("0", "0"))

    def test_growing_rules_are_expanded_over_limits_scalings_and_norms(self):
        result = run("selection", *POISSON, "--cond-max", "1e3,4e8", "--scaling", "both,row", "--norm",
                     "two,one")
        self.assertEqual(result.returncode, 0, result.stderr)
        stencils = list(dict.fromkeys(r["stencil"] for r in rows_of(result.stdout)))
        self.assertEqual(len(stencils), 2 * 2 * 2 * 2 + 5)
        self.assertEqual(stencils[0], "grow_until[of=nearest[k=9]]")
        self.assertIn("grow_until[cond_max=4e8,scaling=row,norm=one,of=nearest[k=15]]", stencils)
        self.assertEqual(stencils[-5:], ["block", "star", "radius", "nearest[k=9]", "nearest[k=15]"])
        again = run("selection", *POISSON, "--stencil", stencils[9])
        self.assertEqual({r["stencil"] for r in rows_of(again.stdout)}, {stencils[9]})

    def test_stencils_that_stop_at_the_cap_above_the_limit_are_counted(self):
        # Every interior node of a grid has 12 with nine nodes, and nine is as far as they may grow.
        result = run("selection", *POISSON, "--method", "mfpm", "--stencil",
                     "grow_until[cond_max=11,cap=9,of=nearest[k=9]],grow_until[cond_max=13],nearest")
        self.assertEqual(result.returncode, 0, result.stderr)
        over = [r for r in rows_of(result.stdout) if r["quantity"] == "over_limit"]
        self.assertEqual([r["value"] for r in over], ["81", "0", ""])
        self.assertIn("no limit", over[2]["reason"])

    def test_bad_limits_are_refused_and_so_are_limits_beside_rules(self):
        self.assert_refused(["--cond-max", "1e3,high"], "--cond-max", "high", study="selection")
        self.assert_refused(["--cond-max", "[1e3"], "--cond-max", "[1e3", study="selection")
        for study in ("selection", "conditioning"):
            self.assert_refused(["--scaling", "columns"], "--scaling", "columns", "row", study=study)
        self.assert_refused(["--stencil", "nearest", "--norm", "one"], "--norm", "--stencil",
                            study="selection")


if __name__ == "__main__":
    unittest.main()
