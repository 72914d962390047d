#!/usr/bin/python3
"""What results/worst makes of tables over several seeds."""
import subprocess
import tempfile
import unittest

from study_programs import CONTRACT, ROOT, run


def worst(*arguments):
    return subprocess.run([str(ROOT / "results" / "worst"), *map(str, arguments)], capture_output=True, text=True,
                          check=False)


def line(**given):
    """A row of a table, t_total last."""
    row = dict.fromkeys([*CONTRACT, "t_total"], "")
    row.update({"problem": "cook", "method": "lsfdm", "status": "ok", "level": "9", "quantity": "v_error"}, **given)
    return ",".join(f'"{value}"' for value in row.values())


class Worst(unittest.TestCase):
    def markdown(self, *lines):
        with tempfile.NamedTemporaryFile("w", suffix=".csv") as file:
            file.write("\n".join([",".join([*CONTRACT, "t_total"]), *lines]) + "\n")
            file.flush()
            done = worst(file.name)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout.splitlines()

    def test_largest_errors_and_ranges_of_other_quantities_are_shown(self):
        text = self.markdown(
            line(cloud="scattered[seed=1]", nodes="90", value="0.25", t_total="2"),
            line(cloud="scattered[seed=1]", nodes="90", quantity="v", value="3", t_total="2"),
            line(cloud="scattered[seed=2]", nodes="92", value="0.5", t_total="4"),
            line(cloud="scattered[seed=2]", nodes="92", quantity="v", value="2", t_total="4"))
        self.assertEqual(text, ["| method | nodes | v_error | v | t_total |", "|---|---|---|---|---|",
                                "| `lsfdm` | 90-92 | 5.0e-01 | 2 to 3 | 3 |"])

    def test_seeds_that_failed_are_counted(self):
        text = self.markdown(line(cloud="scattered[seed=1]", nodes="90", value="0.25", t_total="2"),
                             line(cloud="scattered[seed=2]", status="failed"))
        self.assertEqual(text[2], "| `lsfdm` | 90 | 2.5e-01 (1 failed) | 2 |")

    def test_other_options_of_a_cloud_are_kept_apart(self):
        text = self.markdown(line(cloud="perturbed[amount=0.1,seed=1]", nodes="90", value="1"),
                             line(cloud="perturbed[amount=0.2,seed=1]", nodes="90", value="2"))
        self.assertEqual(text[2:], ["| `lsfdm` | `perturbed[amount=0.1]` | 90 | 1.0e+00 | - |",
                                    "| `lsfdm` | `perturbed[amount=0.2]` | 90 | 2.0e+00 | - |"])

    def test_a_study_s_own_table_is_read(self):
        with tempfile.NamedTemporaryFile(suffix=".csv") as file:
            run("convergence", "--problem", "poisson_square", "--method", "mfpm", "--levels", "9", "--cloud",
                "scattered[seed=1],scattered[seed=2]", "--csv", file.name)
            done = worst(file.name, "--quantity", "u_error")
            refused = worst(file.name, "--quantity", "v")
        self.assertEqual(len(done.stdout.splitlines()), 3)
        self.assertIn("has no quantity 'v'", refused.stderr)
        self.assertEqual(refused.returncode, 2)


if __name__ == "__main__":
    unittest.main()
