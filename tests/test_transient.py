#!/usr/bin/python3
"""Runs in time as a user runs them: killed and continued, noise, frames, rates, bad input.

Usage: test_transient.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import signal
import subprocess
import time
import unittest
import xml.etree.ElementTree

import numpy as np

from study_programs import DEADLINE, ROOT, command, rows_of, run
from vtu_files import MapTest, VtuFile

BAR = ["--problem", "bar_2d", "--method", "mfpm", "--stencil", "nearest[k=9]"]
SHORT = [*BAR, "--levels", "11", "--t-end", "0.5"]
LONG = [*BAR, "--levels", "11", "--time", "central[dt=1e-4]", "--t-end", "4"]
ALWAYS = ["--checkpoint-every", "0"]  # a state a step: some seconds, so that a run can be killed under way


def values(rows):
    return {row["quantity"]: row["value"] for row in rows}


def timeless(row):
    """Free of what differs from run to run."""
    return {name: text for name, text in row.items() if name == "t_end" or not name.startswith("t_") and name != "peak_mb"}


class TransientTest(MapTest):
    def setUp(self):
        super().setUp()
        self.states = self.directory / "states"

    def ok(self, *arguments):
        self.result = run("convergence", *arguments, "--csv", "-")
        self.assertEqual(self.result.returncode, 0, self.result.stdout + self.result.stderr)
        return rows_of(self.result.stdout)

    def failure(self, *arguments):
        """The one reason of a case that fails."""
        result = run("convergence", *arguments, "--csv", "-")
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        (reason,) = {row["reason"] for row in rows_of(result.stdout)}
        return reason


class Killed(TransientTest):
    NOISY = [*LONG[:-1], "0.6", "--noise", "20"]

    def saved(self):
        return sorted(self.states.glob("*.checkpoint")) if self.states.exists() else []

    def kill(self, number, arguments, files=1, often=ALWAYS):
        """Starts a run, waits until states of so many runs of its case are saved, sends a signal."""
        process = subprocess.Popen(command("convergence", *arguments, "--checkpoint", self.states, *often, "--csv",
                                           self.table),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline and process.poll() is None and len(self.saved()) < files:
            time.sleep(0.001)
        time.sleep(0.05)
        self.assertIsNone(process.poll(), "the run ended before it could be killed")
        process.send_signal(number)
        process.wait()
        self.assertEqual(len(self.saved()), files)

    def go_on(self, arguments):
        rows = self.ok(*arguments, "--checkpoint", self.states)
        self.assertIn("continues after step", self.result.stderr)
        self.assertEqual(list(self.states.iterdir()), [])
        return rows

    def test_a_killed_run_continues_to_the_bits_of_an_uninterrupted_one(self):
        whole = [timeless(row) for row in self.ok(*LONG)]
        for number in (signal.SIGKILL, signal.SIGTERM):
            with self.subTest(number):
                self.kill(number, LONG)
                self.assertEqual([timeless(row) for row in self.go_on(LONG)], whole)

    def test_a_run_killed_twice_and_in_its_noise_continues_too(self):
        whole = [timeless(row) for row in self.ok(*self.NOISY)]
        self.assertNotEqual(values(whole)["growth_rate"], "")
        self.kill(signal.SIGKILL, self.NOISY)
        self.kill(signal.SIGKILL, self.NOISY, files=2, often=["--checkpoint-every", "0.01"])
        rows = self.go_on(self.NOISY)
        self.assertEqual(len(self.result.stderr.splitlines()), 2, self.result.stderr)
        self.assertEqual([timeless(row) for row in rows], whole)

    def test_a_signal_saves_the_state_however_seldom_states_are_saved(self):
        arguments = [*LONG, "--frames", "400", "--vtk", self.directory / "maps"]
        process = subprocess.Popen(command("convergence", *arguments, "--checkpoint", self.states, "--csv", self.table),
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline and not list(self.directory.glob("maps/*.pvd")):
            time.sleep(0.001)  # until it takes steps; it saves no state for seconds
        self.assertEqual(self.saved(), [])
        process.send_signal(signal.SIGTERM)
        self.assertEqual(process.wait(), 130)
        self.assertEqual(len(self.saved()), 1)
        self.go_on(arguments)

    def test_frames_of_a_killed_run_are_those_of_an_uninterrupted_one(self):
        frames = ["--frames", "40", "--vtk"]
        self.ok(*LONG, *frames, self.directory / "whole")
        arguments = [*LONG, *frames, self.directory / "killed"]
        self.kill(signal.SIGKILL, arguments)
        self.go_on(arguments)
        whole = sorted((self.directory / "whole").iterdir())
        self.assertEqual(len(whole), 41)
        for path in whole:
            self.assertEqual(path.read_bytes(), (self.directory / "killed" / path.name).read_bytes(), path.name)

    def test_states_that_fit_no_run_are_told(self):
        self.kill(signal.SIGKILL, LONG)
        (path,) = self.saved()
        state = path.read_bytes()
        arguments = [*LONG, "--checkpoint", self.states]
        changed = bytearray(state)
        changed[-100] ^= 1
        for damaged in (state[:-1], state[:200], state[:5], b"", bytes(changed), b"x" + state):
            path.write_bytes(damaged)
            reason = self.failure(*arguments)
            for word in (str(path), "damaged", "delete it"):
                self.assertIn(word, reason)
            self.assertEqual(path.read_bytes(), damaged)
        path.write_bytes(state)
        other = [*LONG, "--damping", "hyper", "--checkpoint", self.states]
        self.kill(signal.SIGKILL, [*LONG, "--damping", "hyper"], files=2)
        (other_path,) = set(self.saved()) - {path}
        other_path.write_bytes(state)
        reason = self.failure(*other)
        for word in (str(other_path), "another run", "damping none", "delete it"):
            self.assertIn(word, reason)
        self.go_on_alone(path, other_path, arguments)

    def go_on_alone(self, path, other, arguments):
        """The other run's state is left alone."""
        self.ok(*arguments)
        self.assertIn("continues", self.result.stderr)
        self.assertEqual(self.saved(), [other])
        self.assertFalse(path.exists())

    def test_a_full_disk_does_not_end_the_run(self):
        self.kill(signal.SIGKILL, LONG)
        (path,) = self.saved()
        path.unlink()
        path.symlink_to("/dev/full")
        rows = self.ok(*LONG, "--checkpoint", self.states, *ALWAYS)
        (line,) = self.result.stderr.splitlines()
        self.assertIn("No space left", line)
        self.assertIn("goes on", line)
        self.assertEqual(values(rows), values(self.ok(*LONG)))


class Noise(TransientTest):
    def test_noise_is_not_measured_unless_it_is_asked_for(self):
        (row,) = [row for row in self.ok(*SHORT) if row["quantity"] == "growth_rate"]
        self.assertEqual((row["value"], row["status"]), ("", "ok"))
        self.assertIn("--noise", row["reason"])

    def test_noise_grows_undamped_and_dies_out_with_hyperviscosity(self):
        noisy = [*BAR, "--levels", "41", "--t-end", "0.1", "--time", "central[courant=.5]",
                 "--noise", "10"]
        growth = [float(values(self.ok(*noisy, "--damping", damping))["growth_rate"]) for damping in ("none", "hyper")]
        self.assertGreater(growth[0], 0.05)
        self.assertLess(growth[1], -0.01)

    def test_real_spectra_keep_noise_as_it_is(self):
        rows = self.ok("--problem", "bar_1d", "--method", "mfpm", "--stencil", "nearest[k=3]", "--levels", "41", "--time",
                       "central[courant=0.5]", "--noise", "100")
        self.assertAlmostEqual(float(values(rows)["growth_rate"]), 0, delta=1e-3)


class Frames(TransientTest):
    def test_the_last_instant_is_written_as_steady_cases_are(self):
        ((path, file),) = self.maps("convergence", *SHORT).items()
        names = ["u", "v", "displacement", "sigma_xx", "sigma_yy", "tau_xy", "von_mises", "sigma_xx_exact"]
        self.assertEqual(list(file.arrays), [*names, "stencil_size", "condition_two", "zone"])
        self.assertEqual(file.grid.GetFieldData().GetArray("TimeValue").GetValue(0), 0.5)
        self.assertIn("t = 0.5", file.case)
        exact = file.arrays["sigma_xx_exact"]
        error = np.linalg.norm(file.arrays["sigma_xx"] - exact) / np.linalg.norm(exact)
        self.assertAlmostEqual(error, float(values(rows_of(self.result.stdout))["stress_error"]), delta=1e-12)
        self.assertNotEqual(set(self.maps("convergence", *SHORT, "--damping", "hyper")), {path})

    def test_frames_are_equally_spaced_and_collected_with_their_times(self):
        arguments = [*SHORT, "--time", "central[dt=0.005]", "--frames", "4"]
        result = run("convergence", *arguments, "--vtk", self.directory / "maps")
        self.assertEqual(result.returncode, 0, result.stdout)
        (collection,) = (self.directory / "maps").glob("*.pvd")
        entries = list(xml.etree.ElementTree.parse(collection).iter("DataSet"))
        self.assertEqual([float(e.get("timestep")) for e in entries], [0.125, 0.25, 0.375, 0.5])
        for entry in entries:
            file = VtuFile(collection.parent / entry.get("file"))
            self.assertEqual(file.grid.GetFieldData().GetArray("TimeValue").GetValue(0), float(entry.get("timestep")))
        self.assertEqual(len(list((self.directory / "maps").iterdir())), 5)
        for options, count in ((["--sheet"], 1), ([], 4)):
            drawn = subprocess.run([str(ROOT / "results" / "plot"), str(collection), "--array", "sigma_xx", *options,
                                    "-o", str(self.directory / "png")], capture_output=True, text=True, check=False)
            self.assertEqual(drawn.returncode, 0, drawn.stderr)
            self.assertEqual(len(drawn.stdout.splitlines()), count)

    def test_frames_that_cannot_be_are_refused(self):
        self.assert_refused([*SHORT, "--frames", "3"], "--frames 3", "--vtk")
        self.assert_refused([*SHORT, "--frames", "0", "--vtk", self.directory], "frames=0")
        reason = self.failure(*SHORT, "--frames", "2000", "--vtk", self.directory)
        self.assertIn("steps", reason)


class Rows(TransientTest):
    def test_errors_alone_have_a_rate(self):
        rows = self.ok(*BAR, "--levels", "11,21", "--t-end", "1", "--noise", "1")
        rated = {row["quantity"] for row in rows if row["rate"]}
        self.assertEqual(rated, {"stress_error"})
        self.assertEqual(len(rows), 8)

    def test_a_run_that_explodes_says_when(self):
        rows = self.ok(*BAR[:2], "--method", "mfpm[order=2]", "--stencil", "block", "--levels", "21", "--time",
                       "central[courant=0.5]", "--t-end", "40", "--vtk", self.directory / "maps", "--frames", "100")
        found = values(rows)
        self.assertEqual([found[name] for name in ("stress_error", "energy_ratio")], ["", ""])
        survived = int(found["steps_survived"])
        for row in rows:
            self.assertEqual(row["status"], "ok")
            if row["quantity"] in ("stress_error", "energy_ratio"):
                self.assertEqual(row["reason"], f"diverged at step {survived + 1}")
        steps = int(rows[0]["steps"])
        self.assertLess(survived, steps)
        frames = list((self.directory / "maps").glob("*.vtu"))
        self.assertTrue(0 < len(frames) < 100)

    def test_a_table_resumes_only_what_ran_alike(self):
        self.assertEqual(run("convergence", *SHORT, "--csv", self.table).returncode, 0)
        written = self.table.read_bytes()
        self.assertEqual(run("convergence", *SHORT, "--resume", self.table).returncode, 0)
        self.assertEqual(self.table.read_bytes(), written)
        for number, options in enumerate((["--t-end", "0.4"], ["--damping", "hyper"], ["--noise", "0.5"],
                                          ["--time", "central[dt=0.004]"])):
            with self.subTest(options):
                self.table.write_bytes(written)
                base = SHORT[:-2] if options[0] == "--t-end" else SHORT
                result = run("convergence", *base, *options, "--resume", self.table)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn("table.csv.old", result.stderr)
                self.assertNotEqual(self.table.read_bytes(), written, number)


class BadInput(TransientTest):
    def test_options_that_do_not_fit_are_refused(self):
        for arguments, *words in ((["--time", "central[dt=-1]"], "dt=-1"), (["--time", "central[dt=0]"], "dt=0"),
                                  (["--time", "central[dt=1e-3,courant=0.5]"], "courant", "give one"),
                                  (["--time", "leap"], "leap", "central"), (["--t-end", "-1"], "t-end=-1"),
                                  (["--t-end", "soon"], "soon"), (["--damping", "rayleigh"], "rayleigh", "hyper"),
                                  (["--damping", "hyper[g=-1]"], "g=-1"), (["--noise", "0"], "noise=0"),
                                  (["--checkpoint", "/proc/none"], "--checkpoint /proc/none"),
                                  (["--checkpoint-every", "-1"], "checkpoint-every=-1")):
            with self.subTest(arguments):
                self.assert_refused([*BAR, *arguments], *words)

    def test_steps_that_cannot_be_are_told_with_a_remedy(self):
        reason = self.failure(*BAR, "--levels", "21", "--time", "central[dt=0.1]")
        for word in ("0.1", "dt=0.0", "courant="):
            self.assertIn(word, reason)
        self.assertIn("too many", self.failure(*BAR, "--levels", "11", "--time", "central[dt=1e-12]", "--t-end", "9"))

    def test_discretisations_without_a_motion_are_skipped_with_a_reason(self):
        rows = self.ok("--problem", "bar_1d", "--method", "mls[h=1.3]", "--form", "least_squares", "--levels", "11")
        self.assertEqual({row["status"] for row in rows}, {"skipped"})
        self.assertIn("least squares", rows[0]["reason"])

    def test_blocks_that_are_joined_move_as_one(self):
        rows = self.ok("--problem", "bar_2d", "--method", "fdm[order=4]", "--cloud", "blocks[split=2]", "--levels",
                       "17,25", "--time", "central[courant=0.5]")
        errors = [float(row["value"]) for row in rows if row["quantity"] == "stress_error"]
        self.assertLess(errors[1], errors[0] / 2)

    def test_studies_of_steady_problems_say_so(self):
        result = run("timing", "--problem", "bar_2d", "--levels", "11", "--csv", "-")
        self.assertEqual({row["status"] for row in rows_of(result.stdout)}, {"skipped"})
        self.assertIn("steady", result.stdout)

    def test_what_there_is_in_time_is_listed(self):
        text = run("convergence", "--list").stdout
        for word in ("--time", "central", "courant=", "--damping", "hyper", "g=0.02", "stiffness", "eta=0.02"):
            self.assertIn(word, text)
        self.assertNotIn("--damping", run("conditioning", "--list").stdout)


if __name__ == "__main__":
    unittest.main()
