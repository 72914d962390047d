#!/usr/bin/python3
"""Spectra of waves in bars are those that an independent implementation measured, and the table says how found."""
import subprocess
import unittest

from study_programs import ROOT, StudyTest, rows_of, run

# The notes' omega_h / omega at these shares of the modes of bar_1d, N = 101. The 5-point figures are those
# of one-sided 5-point rows at the ends; linear+quadratic then has complex eigenvalues.
SHARES = ["5", "10", "25", "50", "75", "100"]
RATIOS = {
    ("mfpm", "block[width=3]"): (0.9995, 0.9972, 0.9785, 0.9081, 0.7939, 0.6462),
    ("mfpm[projection=linear+quadratic]", "block[width=5]"): (0.9982, 0.9894, 0.7098, 0.4911, 0.4130, 0.3330),
    ("mfpm[projection=constant+linear]", "block[width=5]"): (0.9985, 0.9909, 0.9292, 0.6209, 0.4623, 0.4017),
}
FOUR_DIGITS = 5.1e-5
# The notes' growth rates of bar_2d at 51 x 11, which depend on ties and corners: two digits, within a tenth.
GROWTH = [("gfdm[weight=quartic_spline]", "star", 0.075), ("gfdm", "star", 0.078),
          ("lsfdm", "nearest[k=15,ties=cut]", 0.090), ("mfpm", "nearest[k=9,ties=cut]", 0.19),
          ("mfpm_original", "nearest[k=9]", 0.53), ("mfpm", "nearest[k=15,ties=cut]", 2.1), ("mfpm", "block", 2.9)]
TENTH = 0.1


class Eigenvalues(StudyTest):
    def records(self, *arguments):
        result = run("eigenvalues", *arguments, "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        return rows_of(result.stdout)

    def values(self, *arguments):
        return {row["quantity"]: float(row["value"]) for row in self.records(*arguments)
                if row["value"] and not row["mode"]}

    def test_frequencies_of_a_bar_are_those_of_the_notes(self):
        for (method, stencil), expected in RATIOS.items():
            rows = self.records("--method", method, "--stencil", stencil)
            ratios = [row for row in rows if row["quantity"] == "frequency_ratio"]
            self.assertEqual([row["share"] for row in ratios], SHARES)
            for row, ratio in zip(ratios, expected):
                self.assertAlmostEqual(float(row["value"]), ratio, delta=FOUR_DIGITS, msg=f"{method} {row['share']}")

    def test_centred_rows_at_the_ends_make_five_points_stable(self):
        method = ["--method", "mfpm[projection=linear+quadratic]", "--stencil"]
        shifted = self.values(*method, "block[width=5]")
        shrunk = self.values(*method, "block[width=5,ends=shrink]")
        self.assertGreater(shifted["growth_rate"], 1)
        self.assertGreater(shifted["largest_imaginary"], 1)
        self.assertEqual((shrunk["growth_rate"], shrunk["largest_imaginary"]), (0, 0))

    def test_growth_rates_of_a_plane_bar_are_those_of_the_notes(self):
        for method, stencil, expected in GROWTH:
            rate = self.values("--problem", "bar_2d", "--levels", 51, "--method", method,
                               "--stencil", stencil)["growth_rate"]
            self.assertLess(abs(rate / expected - 1), TENTH, f"{method} {stencil}: {rate}")

    def test_engines_agree_and_a_few_eigenvalues_do_not_pretend_to_be_all(self):
        case = ["--problem", "bar_2d", "--levels", 51, "--method", "mfpm", "--stencil", "nearest[k=9]"]
        dense = self.values(*case, "--engine", "dense")
        few = self.values(*case, "--engine", "spectra")
        for quantity in ("spectral_radius", "largest_real", "growth_rate", "stable_step", "step_growth_rate"):
            self.assertAlmostEqual(few[quantity] / dense[quantity], 1, delta=1e-2, msg=quantity)
        self.assertNotIn("non_normality", few)
        self.assertGreater(dense["non_normality"], 1)

    def test_threads_change_no_bit(self):
        for engine in ("dense", "spectra"):
            tables = [self.values("--problem", "bar_2d", "--levels", 31, "--method", "mfpm", "--stencil",
                                  "nearest[k=9]", "--engine", engine, "--threads", n) for n in (1, 2)]
            self.assertEqual(*tables)

    def test_damping_keeps_steps_from_growing_where_the_operator_grows(self):
        case = ["--problem", "bar_2d", "--levels", 31, "--method", "lsfdm", "--stencil", "nearest[k=15]",
                "--time", "central[courant=0.5]"]
        free = self.values(*case)
        damped = self.values(*case, "--damping", "hyper[g=0.02]")
        self.assertGreater(free["step_growth_rate"], 0.01)
        self.assertLess(damped["step_growth_rate"], 1e-6)

    def test_all_modes_are_given_and_resumed(self):
        arguments = ["--levels", 21, "--modes", "all", "--csv", self.table]
        self.assertEqual(run("eigenvalues", *arguments).returncode, 0)
        first = self.table.read_text(encoding="utf-8")
        modes = {row["mode"] for row in rows_of(first) if row["mode"]}
        self.assertEqual(modes, {f"mode_{n}" for n in range(1, 20)})
        self.assertEqual(run("eigenvalues", *arguments, "--resume", self.table).returncode, 0)
        self.assertEqual(self.table.read_text(encoding="utf-8"), first)

    def test_figures_are_drawn_of_frequencies_and_modes(self):
        fields = self.directory / "fields"
        arguments = ["--levels", 21, "--modes", "all", "--csv", self.table, "--vtk", fields]
        self.assertEqual(run("eigenvalues", *arguments).returncode, 0)
        drawn = subprocess.run([ROOT / "results" / "spectra", self.table, *fields.glob("*.vtu"), "-o",
                                self.directory], capture_output=True, text=True, check=False)
        self.assertEqual(drawn.returncode, 0, drawn.stderr)
        for name in ("spectra_frequencies.png", "spectra_modes.png"):
            self.assertGreater((self.directory / name).stat().st_size, 1000)

    def test_options_that_do_not_fit_are_refused(self):
        self.assert_refused(["--modes", "5,x"], "--modes", "'x'", study="eigenvalues")
        self.assert_refused(["--modes", "0"], "--modes", "'0'", study="eigenvalues")
        self.assert_refused(["--engine", "fast"], "fast", "dense", study="eigenvalues")


if __name__ == "__main__":
    unittest.main()
