#!/usr/bin/python3
"""The study of stability, and what results/safe makes of its tables.

Known growth rates are those of another code with the same definitions, at 51 x 11 nodes.
"""
import subprocess
import unittest

from study_programs import CONTRACT, ROOT, StudyTest, rows_of, run

QUANTITIES = ["growth_rate", "growing_frequency", "smallest_g", "smallest_eta", "node_time", "stable_step",
              "steps_survived", "damped_g", "stable_step_damped", "steps_survived_damped", "stress_error", "verdict"]
SMALL = ["--problem", "bar_2d", "--levels", "11", "--t-end", "2"]


def judged(*arguments):
    """Rows by quantity; one case."""
    done = run("stability", *arguments, "--csv", "-")
    if done.returncode != 0:
        raise AssertionError(f"{arguments}: {done.stderr}")
    return {row["quantity"]: row for row in rows_of(done.stdout)}


def number(rows, quantity):
    return float(rows[quantity]["value"])


class Stability(StudyTest):
    def test_every_quantity_has_a_row(self):
        rows = judged(*SMALL, "--method", "lsfdm", "--stencil", "nearest[k=15]", "--cloud", "perturbed")
        self.assertEqual(list(rows), QUANTITIES)
        self.assertEqual({row["seeds"] for row in rows.values()}, {"3"})
        self.assertEqual({row["t_end"] for row in rows.values()}, {"2"})

    def test_the_worst_seed_counts(self):
        arguments = [*SMALL, "--method", "lsfdm", "--stencil", "nearest[k=15]"]
        all_seeds = judged(*arguments, "--cloud", "perturbed")
        single = [judged(*arguments, "--cloud", f"perturbed[seed={seed}]", "--seeds", "1") for seed in (1, 2, 3)]
        for quantity, worst in (("growth_rate", max), ("smallest_g", max), ("stable_step_damped", min)):
            values = [number(rows, quantity) for rows in single]
            self.assertEqual(number(all_seeds, quantity), worst(values))
            self.assertEqual(float(all_seeds[quantity]["low"]), min(values))
            self.assertEqual(float(all_seeds[quantity]["high"]), max(values))

    def test_a_cloud_without_random_nodes_is_judged_once(self):
        rows = judged(*SMALL, "--method", "mfpm", "--cloud", "grid")
        self.assertEqual(rows["growth_rate"]["seeds"], "1")

    def test_what_no_damping_stops_is_a_verdict_and_no_failure(self):
        rows = judged("--problem", "bar_2d", "--levels", "21", "--method", "mfpm", "--stencil", "nearest[k=9]",
                      "--cloud", "perturbed[amount=0.45]", "--t-end", "30")
        self.assertEqual(number(rows, "verdict"), 2)
        self.assertEqual((rows["smallest_g"]["value"], rows["smallest_g"]["status"]), ("", "ok"))
        self.assertIn("no strength stops the growth", rows["smallest_g"]["reason"])
        self.assertIn("diverged at step", rows["steps_survived"]["reason"])

    def test_a_steady_problem_is_skipped(self):
        done = run("stability", "--problem", "poisson_square", "--levels", "11", "--csv", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual({row["status"] for row in rows_of(done.stdout)}, {"skipped"})

    def test_more_unknowns_than_dense_algebra_takes_are_skipped(self):
        done = run("stability", "--problem", "bar_2d", "--levels", "101", "--method", "mfpm", "--cloud",
                   "grid", "--csv", "-")
        self.assertEqual(done.returncode, 0, done.stderr)
        for row in rows_of(done.stdout):
            self.assertEqual(row["status"], "skipped")
            self.assertIn("lower --levels", row["reason"])

    def test_a_resumed_table_is_run_again_for_another_end(self):
        arguments = [*SMALL, "--method", "mfpm", "--cloud", "grid", "--csv", self.table]
        self.assertEqual(run("stability", *arguments).returncode, 0)
        first = self.table.read_text(encoding="utf-8")
        self.assertEqual(run("stability", *arguments, "--resume", self.table).returncode, 0)
        self.assertEqual(self.table.read_text(encoding="utf-8"), first)
        arguments[arguments.index("--t-end") + 1] = "3"
        self.assertEqual(run("stability", *arguments, "--resume", self.table).returncode, 0)
        self.assertEqual({r["t_end"] for r in rows_of(self.table.read_text(encoding="utf-8"))}, {"3"})

    def test_options_out_of_range_are_refused(self):
        self.assert_refused(["--t-end", "0"], "t-end", study="stability")
        self.assert_refused(["--seeds", "0"], "seeds", study="stability")


class Known(unittest.TestCase):
    """Growth per second of the bar with 51 x 11 nodes, within 7 % where the stencils are the same."""

    def check_growth(self, known, method, stencil):
        rows = judged("--problem", "bar_2d", "--levels", "51", "--cloud", "grid", "--t-end", "0.1", "--method", method,
                      "--stencil", stencil)
        self.assertAlmostEqual(number(rows, "growth_rate") / known, 1, delta=0.07)
        self.assertLess(number(rows, "smallest_eta"), 0.15 if known > 1 else 0.02)

    def test_stars(self):
        self.check_growth(0.075, "gfdm[weight=quartic_spline]", "star")
        self.check_growth(0.078, "gfdm", "star")
        self.check_growth(0.53, "mfpm_original", "star")

    def test_nearest_nodes_with_ties_cut(self):
        self.check_growth(0.19, "mfpm", "nearest[k=9,ties=cut]")
        self.check_growth(2.1, "mfpm", "nearest[k=15,ties=cut]")

    def test_fifteen_nodes_and_more(self):
        self.check_growth(0.090, "lsfdm", "nearest[k=15]")

    def test_index_blocks(self):
        self.check_growth(2.9, "mfpm", "block")


class Safe(StudyTest):
    """results/safe on tables made up."""
    COLUMNS = [*CONTRACT, "seeds", "low", "high", "t_end", "tolerance", "version"]

    def table_of(self, *cases):
        lines = [",".join(self.COLUMNS)]
        for method, cloud, values, status in cases:
            for quantity, value in values.items():
                row = dict.fromkeys(self.COLUMNS, "")
                row.update(study="stability", problem="bar_2d", level="41", method=method, stencil="star", cloud=cloud,
                           quantity=quantity, value=str(value), status=status)
                lines.append(",".join(row[column] for column in self.COLUMNS))
        self.table.write_text("\n".join(lines) + "\n", encoding="utf-8")

    @staticmethod
    def case(growth, g, error, verdict):
        return {"growth_rate": growth, "smallest_g": g, "damped_g": 1.5 * g if g != "" else "",
                "stable_step_damped": 0.5, "stress_error": error, "verdict": verdict}

    def safe(self):
        return subprocess.run([ROOT / "results" / "safe", self.table, "-o", self.directory / "out.md"],
                              capture_output=True, text=True, check=False)

    def test_the_most_accurate_and_the_least_damped_safe_settings_are_named(self):
        self.table_of(("best", "grid", self.case(2, "", 0.01, 2), "ok"),
                      ("exact", "grid", self.case(1, 0.1, 0.02, 1), "ok"),
                      ("mild", "grid", self.case(1, 0.01, 0.05, 1), "ok"),
                      ("other", "grid", {"all": ""}, "skipped"))
        done = self.safe()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("| `bar_2d grid` | 2 of 3 | recommended, smallest error | `exact star` | 0.15 | 0.02 | 0.50 |", done.stdout)
        self.assertIn("| `bar_2d grid` | 2 of 3 | smallest g | `mild star` | 0.015 | 0.05 | 0.50 |", done.stdout)
        self.assertNotIn("`best star`", done.stdout)
        self.assertEqual((self.directory / "out.md").read_text(encoding="utf-8"), done.stdout)
        for suffix in ("png", "svg"):
            self.assertGreater((self.directory / f"out_map.{suffix}").stat().st_size, 0)

    def test_what_wants_short_steps_is_not_recommended(self):
        slow = self.case(1, 0.3, 0.02, 1) | {"stable_step_damped": 0.3}
        self.table_of(("slow", "grid", slow, "ok"), ("quick", "grid", self.case(1, 0.01, 0.05, 1), "ok"))
        done = self.safe()
        self.assertIn("| recommended, smallest g | `quick star` |", done.stdout)
        self.assertIn("| smallest error | `slow star` |", done.stdout)

    def test_the_step_that_is_told_holds_with_the_g_that_is_told(self):
        rounded = self.case(1, 0.0674, 0.02, 1) | {"stable_step_damped": 0.676}  # 0.1011 was run
        self.table_of(("one", "grid", rounded, "ok"))
        # x^2 + 8 g x = 1: 0.6752 with 0.1011, 0.6532 with 0.11.
        self.assertIn("| `one star` | 0.11 | 0.02 | 0.65 |", self.safe().stdout)

    def test_a_setting_has_to_be_safe_at_every_level(self):
        self.table_of(("one", "grid", self.case(1, 0.1, 0.02, 1), "ok"), ("one", "grid", self.case(1, "", "", 2), "ok"))
        self.assertIn("| 0 of 1 | - | none |", self.safe().stdout)

    def test_a_kind_without_a_safe_setting_says_so(self):
        self.table_of(("one", "grid", self.case(2, "", "", 2), "ok"))
        self.assertIn("| `bar_2d grid` | 0 of 1 | - | none |", self.safe().stdout)

    def test_only_settings_safe_on_all_kinds_close_the_list(self):
        self.table_of(("both", "grid", self.case(1, 0.1, 0.02, 1), "ok"),
                      ("both", "scattered", self.case(1, 0.2, 0.06, 1), "ok"),
                      ("half", "grid", self.case(1, 0.1, 0.02, 1), "ok"),
                      ("half", "scattered", self.case(1, "", "", 2), "ok"))
        lines = self.safe().stdout.splitlines()
        self.assertEqual(lines[-1], "| `both star` | 2 | 0.3 | 1 |")
        self.assertFalse(any(line.startswith("| `half star`") for line in lines))

    def test_a_table_of_another_study_is_refused(self):
        self.table.write_text("study,problem\nconvergence,cook\n", encoding="utf-8")
        done = self.safe()
        self.assertEqual(done.returncode, 2)
        self.assertIn("is no table of the study stability", done.stderr)


if __name__ == "__main__":
    unittest.main()
