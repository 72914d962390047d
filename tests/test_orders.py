#!/usr/bin/python3
"""Orders of accuracy that theory gives come out of the study programs; medians over seeds are what they say."""
import itertools
import math
import statistics
import subprocess
import unittest

from study_programs import ROOT, StudyTest, rows_of, run

TOLERANCE = 0.4  # on an observed order, over a factor of four in spacing
# Stencils of high order span many spacings and are nearly symmetric at levels that round-off leaves, so
# that the next term of the error, one order higher, still counts.
EXCESS_OF_HIGH_ORDERS = 1 + TOLERANCE
SEEDS = ["--seeds", "3"]


def round_off(level, order):
    """What is left of a relative error when a derivative's weights, about h^-order, multiply rounded values."""
    return 1e-15 * (level - 1)**order


def slope(points):
    """Least-squares slope of log(error) against log(1/(level-1))."""
    x, y = zip(*((-math.log(level - 1), math.log(error)) for level, error in points))
    return statistics.linear_regression(x, y).slope


def slopes_of(rows):
    """Observed order by (method, quantity), where there are two levels at least."""
    curves = {}
    for row in rows:
        curves.setdefault((row["method"], row["quantity"]), []).append((int(row["level"]), float(row["value"])))
    return {key: slope(points) for key, points in curves.items() if len(points) > 1}


def order_of(quantity):
    """Order of the derivative that dx_interior and its kin judge."""
    name = quantity.split("_")[0]
    return 0 if name == "value" else len(name) - 1


class Orders(StudyTest):
    def interior_orders(self, order, methods, levels):
        result = run("local_accuracy", "--problem", f"field[order={order}]", "--method", methods, "--cloud",
                     "perturbed[amount=0.4]", "--levels", levels, *SEEDS, "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = [row for row in rows_of(result.stdout) if row["quantity"].endswith("_interior")]
        found = slopes_of(row for row in rows
                          if float(row["value"]) > 10 * round_off(int(row["level"]), order_of(row["quantity"])))
        self.assertGreater(len(found), 0.9 * len({(row["method"], row["quantity"]) for row in rows}))
        for (method, quantity), observed in found.items():
            yield method, quantity, observed - (order + 1 - order_of(quantity))

    def methods_of(self, order):
        phs = order + 1 + order % 2  # smooth enough for every derivative judged
        return f"mfpm[order={order}],gmls[degree={order}],rbf_fd[phs={max(3, phs)},degree={order}]"

    def test_every_derivative_up_to_order_4_has_the_order_of_theory(self):
        for order in (1, 2, 3, 4):
            for method, quantity, excess in self.interior_orders(order, self.methods_of(order), "31,61,121"):
                self.assertLess(abs(excess), TOLERANCE, f"{method} {quantity}")

    def test_every_derivative_of_orders_5_to_8_has_at_least_the_order_of_theory(self):
        for order in (5, 6, 7, 8):
            for method, quantity, excess in self.interior_orders(order, self.methods_of(order), "21,31,41,61"):
                self.assertGreater(excess, -TOLERANCE, f"{method} {quantity}")
                self.assertLess(excess, EXCESS_OF_HIGH_ORDERS, f"{method} {quantity}")

    def test_a_bell_weight_does_not_cost_order(self):
        for order in (3, 4, 6):
            for method, quantity, excess in self.interior_orders(order, f"lsfdm[order={order}]", "21,31,41"):
                self.assertGreater(excess, -TOLERANCE, f"{method} {quantity}")
                self.assertLess(excess, EXCESS_OF_HIGH_ORDERS, f"{method} {quantity}")

    def test_poisson_converges_with_the_degree_of_rbf_fd(self):
        for degree, levels in ((2, "21,41,81"), (4, "21,41,81"), (6, "21,41,81"), (8, "21,41")):
            result = run("convergence", "--problem", "poisson_square", "--cloud", "perturbed", "--method",
                         f"rbf_fd[degree={degree}]", "--levels", levels, "--csv", "-")
            found = slopes_of(row for row in rows_of(result.stdout) if row["quantity"] == "u_error")
            for observed in found.values():
                self.assertGreater(observed, degree - 0.5, f"degree {degree}")


class Seeds(StudyTest):
    def values(self, *arguments):
        result = run("local_accuracy", "--method", "mfpm", "--levels", "11", *arguments, "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return rows_of(result.stdout)

    def test_the_value_is_the_median_and_the_band_the_range_over_seeds(self):
        single = [self.values("--cloud", f"perturbed[seed={seed}]", "--seeds", "1") for seed in (5, 6, 7)]
        joined = self.values("--cloud", "perturbed[seed=5]", *SEEDS)
        for row, *others in zip(joined, *single):
            values = sorted(float(other["value"]) for other in others)
            self.assertEqual([float(row[c]) for c in ("low", "value", "high")], values, row["quantity"])
            self.assertEqual(row["seeds"], "3")
            self.assertEqual([other["seeds"] for other in others], ["1"] * 3)

    def test_a_cloud_without_random_numbers_is_run_once(self):
        for row in self.values("--cloud", "grid", *SEEDS):
            self.assertEqual(row["seeds"], "1")
            self.assertEqual({row["low"], row["high"]}, {row["value"]})

    def test_seeds_that_do_not_fit_are_refused_before_a_table_is_touched(self):
        self.table.write_text("an earlier table\n", encoding="utf-8")
        last = 2**31 - 1  # the largest seed
        for arguments, words in ((["--seeds", "0"], ["--seeds 0", "1 to 1000"]), (["--seeds", "few"], ["--seeds few"]),
                                 (["--cloud", f"perturbed[seed={last}]", "--seeds", "2"], ["--seeds 2", str(last)]),
                                 (["--cloud", "scattered", "--seed", last - 1], ["--seeds 3", str(last)])):
            self.assert_refused([*arguments, "--csv", self.table], *words, study="local_accuracy")
            self.assertEqual(self.table.read_text(encoding="utf-8"), "an earlier table\n")

    def test_rows_of_another_number_of_seeds_are_not_resumed(self):
        arguments = ["--method", "mfpm", "--levels", "11", "--cloud", "perturbed", "--csv", self.table]
        self.assertEqual(run("local_accuracy", *arguments, "--seeds", "1").returncode, 0)
        self.assertEqual(run("local_accuracy", *arguments, *SEEDS, "--resume", self.table).returncode, 0)
        self.assertEqual({row["seeds"] for row in rows_of(self.table.read_text(encoding="utf-8"))}, {"3"})


class Summary(StudyTest):
    def test_the_table_of_orders_gives_the_worst_slope_of_each_order_by_zone(self):
        rows = ["study,problem,method,stencil,cloud,level,spacing,quantity,value,status"]
        for level, h in ((11, 0.1), (21, 0.05)):
            for quantity, order in (("dx_interior", 2), ("dy_interior", 3), ("dx_boundary", 1), ("dxy_interior", 0)):
                rows.append(f"local_accuracy,field,m,s,grid,{level},{h},{quantity},{h**order},ok")
        rows.append("local_accuracy,field,none,s,grid,11,,all,,skipped")
        self.table.write_text("\n".join(rows) + "\n", encoding="utf-8")
        result = subprocess.run([ROOT / "results" / "orders", self.table], capture_output=True, text=True, check=True)
        self.assertEqual(result.stdout.splitlines(),
                         ["| method | grid: order 1 | grid: order 2 |", "|---|---|---|",
                          "| `m` | 2.0 / 1.0 | 0.0 |", "| `none` | skipped | skipped |"])

    def test_cases_that_differ_in_more_than_the_level_are_not_joined_to_a_slope(self):
        # Second order everywhere, but the constant depends on all that tells cases apart.
        rows, constant = ["study,problem,method,stencil,cloud,form,solver,level,spacing,quantity,value,status"], 1
        for axes in itertools.product("p", ("m", "n"), ("s", "t"), ("grid", "random"), ("weak", "strong"), "u"):
            problem, method, stencil, cloud, form, solver = axes
            constant *= 3
            for level, h in ((11, 0.1), (21, 0.05)):
                rows.append(f"convergence,{problem},{method},{stencil},{cloud},{form},{solver},{level},{h},"
                            f"u_error,{constant * h**2},ok")
        self.table.write_text("\n".join(rows) + "\n", encoding="utf-8")
        result = subprocess.run([ROOT / "results" / "orders", self.table], capture_output=True, text=True, check=True)
        lines = [f"| `{m}`, {s}, {f} | 2.0 | 2.0 |"
                 for m, s, f in itertools.product("mn", "st", ("weak", "strong"))]
        self.assertEqual(result.stdout.splitlines(),
                         ["| method | grid: u_error | random: u_error |", "|---|---|---|", *lines])

    def test_a_file_that_is_no_table_is_refused_in_one_line(self):
        result = subprocess.run([ROOT / "results" / "orders", self.table], capture_output=True, text=True, check=False)
        self.assertEqual(result.returncode, 2)
        self.assertEqual(len(result.stderr.splitlines()), 1)


if __name__ == "__main__":
    unittest.main()
