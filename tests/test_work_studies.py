#!/usr/bin/python3
"""The studies of work: time against error, and time against the number of nodes.

Usage: test_work_studies.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import csv
import io
import math
import unittest

from study_programs import CONTRACT, TIMES, StudyTest, rows_of, run

POISSON = ["--problem", "poisson_square", "--method", "mfpm,lsfdm", "--levels", "9,17,33"]


class WorkPrecision(StudyTest):
    def test_the_rows_of_the_front_are_those_that_none_beats(self):
        result = run("work_precision", *POISSON, "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        header = next(csv.reader(io.StringIO(result.stdout)))
        self.assertEqual(header, [*CONTRACT, *TIMES, "front", "version"])
        rows = [row for row in rows_of(result.stdout) if row["quantity"] == "u_error"]
        self.assertEqual(len(rows), 6)
        for row in rows:
            time, error = float(row["t_total"]), float(row["value"])
            is_beaten = any(float(r["t_total"]) <= time and float(r["value"]) <= error
                            for r in rows if r is not row)
            self.assertEqual(row["front"], "" if is_beaten else "front", row)

    def test_the_table_of_times_is_that_of_the_rows(self):
        self.assertEqual(run("work_precision", *POISSON, "--csv", self.table).returncode, 0)
        rows = rows_of(self.table.read_text(encoding="utf-8"))
        text = run("work_precision", *POISSON, "--resume", self.table).stdout
        table = text[text.index("time [s] to reach u_error"):]
        best = table.split("best", 1)[1].split("\n", 1)[0].split()
        fast = min(float(row["t_total"]) for row in rows
                   if row["quantity"] == "u_error" and float(row["value"]) <= 1e-2)
        self.assertAlmostEqual(float(best[0]) / fast, 1, delta=0.06)  # two digits are printed
        self.assertEqual(best[-1], "-")


def slope(rows, quantity):
    """Least-squares slope of the logarithm of a quantity over that of the number of nodes."""
    points = [(math.log(int(row["nodes"])), math.log(float(row["value"])))
              for row in rows if row["quantity"] == quantity]
    middle = [sum(values) / len(points) for values in zip(*points)]
    return (sum((x - middle[0]) * (y - middle[1]) for x, y in points)
            / sum((x - middle[0]) ** 2 for x, _ in points))


class Scaling(StudyTest):
    def test_each_stage_has_a_row_with_its_share_per_node_and_its_exponent(self):
        result = run("scaling", "--levels", "20,40,80", "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = rows_of(result.stdout)
        self.assertEqual([row["quantity"] for row in rows if row["level"] == "40"],
                         ["cloud", "prepare", "neighbours", "stencils", "weights", "assemble", "solve",
                          "total", "memory"])
        for row in rows:
            if row["quantity"] == "total":
                per_node = 1e6 * float(row["value"]) / int(row["nodes"])
                self.assertAlmostEqual(float(row["per_node"]) / per_node, 1, places=3)
            if row["quantity"] == "weights":  # what the slope is depends on what else the machine does
                self.assertAlmostEqual(float(row["exponent"]), slope(rows, "weights"), delta=2e-3)

    def test_stages_after_the_last_one_are_not_run(self):
        rows = rows_of(run("scaling", "--levels", "20", "--upto", "weights", "--csv", "-").stdout)
        self.assertEqual([row["quantity"] for row in rows][-3:], ["weights", "total", "memory"])
        self.assertEqual({row["t_solve"] for row in rows}, {"0"})
        self.assert_refused(["--upto", "lunch"], "--upto", "lunch", "assemble", study="scaling")

    def test_large_adds_a_level_to_the_default_ones(self):
        self.assertIn("--large", run("scaling", "--help").stdout)
        rows = rows_of(run("scaling", "--large", "--levels", "20", "--csv", "-").stdout)
        self.assertEqual({row["level"] for row in rows}, {"20"})


if __name__ == "__main__":
    unittest.main()
