#!/usr/bin/python3
"""No finished case of a study is lost: killed and resumed runs, signals, full disks.

Usage: test_resume.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import contextlib
import json
import signal
import subprocess
import time
import unittest

from study_programs import DEADLINE, QUICK, StudyTest, command, rows_of, run, untimed


class Interruptions(StudyTest):
    GRID = ["--problem", "poisson_square", "--method", "mfpm,gfdm,lsfdm,rbf_fd", "--cloud",
            "grid,perturbed", "--levels", "9,17,33,49"]

    def started(self, rows, *arguments):
        """A run that has written at least so many rows."""
        process = subprocess.Popen(command("convergence", *self.GRID, "--csv", self.table, *arguments),
                                   stderr=subprocess.PIPE, text=True)
        self.addCleanup(process.stderr.close)
        deadline = time.monotonic() + DEADLINE
        while time.monotonic() < deadline and process.poll() is None:
            with contextlib.suppress(FileNotFoundError):  # the probe whether it can be written comes and goes
                if self.table.read_bytes().count(b"\n") > rows:
                    break
            time.sleep(0.001)
        return process

    def uninterrupted(self):
        path = self.directory / "whole.csv"
        self.assertEqual(run("convergence", *self.GRID, "--csv", path).returncode, 0)
        return path.read_bytes()

    def assert_same_table(self, whole):
        self.assertEqual(untimed(self.table.read_bytes()), untimed(whole))

    def test_a_killed_run_resumes_to_the_table_of_an_uninterrupted_one(self):
        whole = self.uninterrupted()
        process = self.started(4)
        process.send_signal(signal.SIGKILL)
        self.assertEqual(process.wait(), -signal.SIGKILL)
        left = self.table.read_bytes()
        complete = untimed(left[:left.rindex(b"\n") + 1])
        self.assertLess(len(complete), len(untimed(whole)))
        self.assertEqual(complete, untimed(whole)[:len(complete)])
        for _ in range(2):  # the second time there is nothing left to do
            result = run("convergence", *self.GRID, "--resume", self.table, "--csv", self.table)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assert_same_table(whole)
            self.assertTrue(self.table.read_bytes().startswith(left[:left.rindex(b"\n") + 1]))

    def test_resume_keeps_what_is_there_and_ignores_a_torn_line(self):
        whole = self.uninterrupted()
        lines = whole.splitlines(keepends=True)
        # A value nobody could compute shows that a complete case is not run again.
        marked = lines[1].replace(rows_of(whole.decode())[0]["value"].encode(), b"0.125")
        self.assertNotEqual(marked, lines[1])
        self.table.write_bytes(lines[0] + marked + lines[2] + lines[3][:-9])
        result = run("convergence", *self.GRID, "--resume", self.table)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = rows_of(self.table.read_text(encoding="utf-8"))
        self.assertEqual(rows[0]["value"], "0.125")
        self.assertEqual([r["value"] for r in rows[1:]], [r["value"] for r in rows_of(whole.decode())[1:]])
        self.assertIn("slope", result.stdout)

    def test_resume_runs_failed_cases_and_gaps_again_and_keeps_the_order(self):
        whole = self.uninterrupted()
        header, *lines = whole.splitlines(keepends=True)
        first = lines[0].replace(b",ok,", b",failed,")
        self.table.write_bytes(b"".join([header, first, *lines[1:9], *lines[10:]]))
        result = run("convergence", *self.GRID, "--resume", self.table, "--csv", self.table)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_same_table(whole)

    def test_resume_reruns_rows_of_another_code_version_and_keeps_a_copy(self):
        whole = run("convergence", *QUICK, "--csv", "-").stdout
        version = rows_of(whole)[0]["version"]
        old = whole.replace("," + version, ",other").replace("0.", "7.")
        self.table.write_text(old, encoding="utf-8")
        result = run("convergence", *QUICK, "--resume", self.table, "--csv", self.table)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_same_table(whole)
        self.assertEqual((self.directory / "table.csv.old").read_text(encoding="utf-8"), old)

    def test_rows_of_other_options_of_a_study_are_kept_in_a_copy(self):
        arguments = ["--method", "mfpm", "--levels", "5", "--csv", self.table]
        self.assertEqual(run("conditioning", *arguments).returncode, 0)
        old = self.table.read_bytes()
        result = run("conditioning", *arguments, "--scaling", "row", "--resume", self.table)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("table.csv.old", result.stderr)
        self.assertEqual((self.directory / "table.csv.old").read_bytes(), old)
        by_rows = self.table.read_bytes()
        self.assertEqual(run("conditioning", *arguments, "--resume", self.table).returncode, 0)
        copies = [(self.directory / f"table.csv.{name}").read_bytes() for name in ("old", "old2")]
        self.assertEqual(copies, [old, by_rows])

    def test_skipped_cases_are_kept_whatever_the_seeds(self):
        arguments = ["--method", "fdm", "--cloud", "scattered", "--levels", "5", "--csv", self.table]
        self.assertEqual(run("local_accuracy", *arguments, "--seeds", "1").returncode, 0)
        old = self.table.read_bytes()
        self.assertEqual({r["status"] for r in rows_of(old.decode())}, {"skipped"})
        result = run("local_accuracy", *arguments, "--seeds", "2", "--resume", self.table)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(self.table.read_bytes(), old)

    def test_resume_of_a_file_that_is_not_there_starts_afresh(self):
        result = run("convergence", *QUICK, "--resume", self.table)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_same_table(run("convergence", *QUICK, "--csv", "-").stdout)

    def test_resume_streams_the_whole_table_in_order(self):
        whole = self.uninterrupted()
        header, *lines = whole.splitlines(keepends=True)
        self.table.write_bytes(header + b"".join(lines[4:]))
        result = run("convergence", *self.GRID, "--resume", self.table, "--csv", "-")
        self.assertEqual(untimed(result.stdout), untimed(whole))

    def test_resume_refuses_a_table_with_other_columns(self):
        self.table.write_text("study,problem,colour\na,b,c\n", encoding="utf-8")
        self.assert_refused([*QUICK, "--resume", self.table], "--resume", "colour", "method")
        self.assertEqual(self.table.read_text(encoding="utf-8"), "study,problem,colour\na,b,c\n")

    def test_a_table_read_from_a_cloud_file_resumes_too(self):
        nodes = [(i / 6, j / 6) for i in range(7) for j in range(7)]
        lines = ["x,y,tag,nx,ny"]
        for x, y in nodes:
            sides = [("left", -1, 0)] * (x == 0) + [("right", 1, 0)] * (x == 1)
            sides += [("bottom", 0, -1)] * (y == 0) + [("top", 0, 1)] * (y == 1)
            lines.append(f"{x},{y}," + (",".join(map(str, sides[0])) if sides else ",,"))
        arguments = self.cloud_file("\n".join(lines) + "\n")
        first = run("convergence", *arguments, "--resume", self.table)
        self.assertEqual(first.returncode, 0, first.stdout + first.stderr)
        written = self.table.read_text(encoding="utf-8")
        self.assertEqual({r["level"] for r in rows_of(written)}, {"7"})
        (self.directory / "cloud.csv").unlink()  # so that running the case again would fail
        again = run("convergence", *arguments, "--resume", self.table)
        self.assertEqual(again.returncode, 0, again.stdout)
        self.assertEqual(self.table.read_text(encoding="utf-8"), written)

    def test_a_polite_signal_ends_the_run_with_its_tables_written(self):
        file = self.directory / "table.json"
        for number in (signal.SIGINT, signal.SIGTERM):
            with self.subTest(number):
                self.table.unlink(missing_ok=True)
                process = self.started(2, "--json", file)
                process.send_signal(number)
                message = process.stderr.read()
                self.assertEqual(process.wait(), 130, message)
                self.assertEqual(len(message.splitlines()), 1, message)
                self.assertIn("--resume", message)
                rows = rows_of(self.table.read_text(encoding="utf-8"))
                self.assertGreaterEqual(len(rows), 2)
                self.assertEqual(len(json.loads(file.read_text(encoding="utf-8"))["rows"]), len(rows))


class FullDisks(StudyTest):
    def test_rows_that_cannot_be_written_go_to_standard_output(self):
        result = run("convergence", *QUICK, "--csv", "/dev/full")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn("No space left", result.stderr)
        self.assertEqual(untimed(result.stdout),
                         untimed(run("convergence", *QUICK, "--csv", "-").stdout))

    def test_a_full_standard_output_is_told(self):
        for arguments in (["--csv", "-"], ["--json", "-"], [], ["--list"], ["--help"]):
            with self.subTest(arguments), open("/dev/full", "w", encoding="utf-8") as full:
                result = subprocess.run(command("convergence", *QUICK, *arguments), stdout=full,
                                        stderr=subprocess.PIPE, text=True, check=False, timeout=DEADLINE)
                self.assertEqual(result.returncode, 1)
                self.assertIn("No space left", result.stderr)

    def test_json_that_cannot_be_written_is_told(self):
        result = run("convergence", *QUICK, "--json", "/dev/full")
        self.assertEqual(result.returncode, 1)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        self.assertIn("u_error", result.stdout)


if __name__ == "__main__":
    unittest.main()
