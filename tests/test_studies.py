#!/usr/bin/python3
"""The contract of the study programs: tables, exit statuses, messages.

Usage: test_studies.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import csv
import io
import json
import math
import re
import unittest

from study_programs import CONTRACT, QUICK, STUDIES, TIMES, StudyTest, names_in, rows_of, run, untimed


class Tables(StudyTest):
    def test_csv_has_the_columns_of_the_contract(self):
        result = run("convergence", *QUICK, "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        header, *records = list(csv.reader(io.StringIO(result.stdout)))
        self.assertEqual(header[:len(CONTRACT)], CONTRACT)
        self.assertEqual(header[-1], "version")
        self.assertEqual({len(record) for record in records}, {len(header)})
        rows = rows_of(result.stdout)
        self.assertEqual([(r["level"], r["quantity"]) for r in rows],
                         [(n, q) for n in ("9", "11") for q in ("u_error", "u_max_error")])
        for row in rows:
            self.assertEqual((row["study"], row["problem"], row["method"], row["status"]),
                             ("convergence", "poisson_square", "mfpm", "ok"))
            self.assertEqual(int(row["nodes"]), int(row["level"])**2)
            self.assertAlmostEqual(float(row["spacing"]), 1 / int(row["level"]))
            self.assertTrue(0 < float(row["value"]) < 1)

    def test_rate_is_the_observed_order_against_the_previous_level(self):
        rows = rows_of(run("convergence", *QUICK, "--csv", "-").stdout)
        coarse, fine = (r for r in rows if r["quantity"] == "u_error")
        self.assertEqual(coarse["rate"], "")
        expected = (math.log(float(coarse["value"]) / float(fine["value"]))
                    / math.log(float(coarse["spacing"]) / float(fine["spacing"])))
        self.assertAlmostEqual(float(fine["rate"]), expected, places=9)

    def test_timing_adds_the_timing_columns(self):
        result = run("timing", "--smoke", "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        header = next(csv.reader(io.StringIO(result.stdout)))
        self.assertEqual(header[:len(CONTRACT) + len(TIMES)], CONTRACT + TIMES)
        for row in rows_of(result.stdout):
            if row["t_total"]:
                stages = sum(float(row[t]) for t in TIMES if t.startswith("t_") and t != "t_total")
                self.assertAlmostEqual(float(row["t_total"]), stages)

    def test_timing_says_what_solved_a_system(self):
        result = run("timing", "--problem", "poisson_square", "--levels", "9", "--algorithms", "none",
                     "--solver", "auto", "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        named = {row["quantity"]: row["solved_by"] for row in rows_of(result.stdout)}
        self.assertEqual(named, {"voronoi": "", "voronoi_share": "", "total": "", "iterations": "frontal"})

    def test_specs_with_commas_are_quoted_and_can_be_pasted_back(self):
        spec = "zoned[interior=gfdm,boundary=rbf_fd]"
        stencil = "zoned[interior=nearest[k=11],boundary=nearest[k=17]]"
        arguments = ["--problem", "poisson_square", "--method", spec, "--stencil", stencil, "--levels",
                     "9", "--csv", "-"]
        result = run("convergence", *arguments)
        row = rows_of(result.stdout)[0]
        self.assertEqual(row["method"], spec)
        again = run("convergence", "--problem", row["problem"], "--method", row["method"], "--stencil",
                    row["stencil"], "--levels", "9", "--csv", "-")
        self.assertEqual(untimed(again.stdout), untimed(result.stdout))

    def test_json_holds_the_same_rows_and_their_provenance(self):
        file = self.directory / "table.json"
        result = run("convergence", *QUICK, "--csv", "-", "--json", file)
        document = json.loads(file.read_text(encoding="utf-8"))
        from_csv = rows_of(result.stdout)
        self.assertEqual(len(document["rows"]), len(from_csv))
        for ours, theirs in zip(document["rows"], from_csv):
            self.assertEqual(list(ours), list(theirs))
            for column, value in ours.items():
                if isinstance(value, (int, float)):
                    self.assertEqual(value, float(theirs[column]), column)
                else:
                    self.assertEqual(value or "", theirs[column], column)
        provenance = document["provenance"]
        self.assertEqual(provenance["study"], "convergence")
        self.assertTrue(provenance["command_line"].startswith("convergence --problem poisson_square"))
        self.assertEqual(provenance["code_version"], from_csv[0]["version"])
        for member in ("compiler", "compiler_flags", "build_type", "eigen", "fmt", "nanoflann",
                       "umfpack", "cpu", "simd", "cores", "threads", "clock", "date"):
            self.assertIn(member, provenance)
        for figure in ("copy_gigabytes_per_second", "umfpack_laplacian_100x100_seconds"):
            self.assertGreater(float(provenance[figure]), 0)
        self.assertRegex(provenance["date"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ$")

    def test_standard_output_can_take_the_json(self):
        result = run("convergence", *QUICK, "--json", "-")
        self.assertEqual(len(json.loads(result.stdout)["rows"]), 4)

    def test_without_csv_a_readable_table_of_modest_width_is_printed(self):
        result = run("convergence", *QUICK)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stderr, "")
        for word in ("poisson_square", "mfpm", "u_error", "slope"):
            self.assertIn(word, result.stdout)
        self.assertLessEqual(max(map(len, result.stdout.splitlines())), 110)
        for study in ("convergence", "local_accuracy"):  # labels of both lengths, as many levels as fit
            result = run(study, "--method", "mfpm", "--cloud", "grid", "--levels", "5,6,7,8,9")
            self.assertEqual(max(map(len, result.stdout.splitlines())), 110)

    def test_a_case_written_twice_is_run_once_and_levels_ascend(self):
        result = run("convergence", "--problem", "poisson_square", "--method", "mfpm,mfpm", "--levels",
                     "11,9,11", "--csv", "-")
        self.assertEqual([r["level"] for r in rows_of(result.stdout)], ["9", "9", "11", "11"])

    def test_all_takes_every_registered_method(self):
        result = run("convergence", "--problem", "poisson_square", "--method", "all", "--levels", "9",
                     "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        by_method = {r["method"]: r for r in rows_of(result.stdout)}
        self.assertEqual(list(by_method), names_in("methods/methods.def"))
        self.assertEqual(by_method["mfpm"]["status"], "ok")

    def test_all_skips_what_needs_an_option_and_says_which(self):
        result = run("convergence", "--problem", "poisson_square", "--method", "mfpm", "--levels", "9",
                     "--cloud", "all", "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        by_cloud = {r["cloud"]: r for r in rows_of(result.stdout)}
        self.assertEqual(list(by_cloud), names_in("problems/core/layouts/layouts.def"))
        self.assertEqual((by_cloud["file"]["status"], by_cloud["grid"]["status"]), ("skipped", "ok"))
        self.assertIn("path", by_cloud["file"]["reason"])
        self.assert_refused(["--cloud", "file"], "--cloud", "path")

    def test_a_problem_of_another_kind_is_one_skipped_row_a_case(self):
        result = run("convergence", "--problem", "field", "--method", "mfpm", "--levels", "9", "--csv", "-")
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = rows_of(result.stdout)
        self.assertEqual([(r["status"], r["quantity"]) for r in rows], [("skipped", "all")])
        self.assertNotEqual(rows[0]["reason"], "")

    def test_seed_of_the_command_line_enters_the_cloud_spec(self):
        arguments = ["--problem", "poisson_square", "--method", "mfpm", "--levels", "9", "--csv", "-"]
        by_option = run("convergence", *arguments, "--cloud", "random", "--seed", "7")
        by_spec = run("convergence", *arguments, "--cloud", "random[seed=7]")
        self.assertEqual(untimed(by_option.stdout), untimed(by_spec.stdout))
        self.assertIn("random[seed=7]", by_spec.stdout)

    def test_one_and_two_threads_give_the_same_table(self):
        one, two = (run("convergence", *QUICK, "--threads", n, "--csv", "-").stdout for n in (1, 2))
        self.assertEqual(untimed(one), untimed(two))


class Lists(StudyTest):
    def test_list_names_everything_that_is_registered(self):
        result = run("convergence", "--list")
        self.assertEqual(result.returncode, 0, result.stderr)
        words = set(re.findall(r"\w+", result.stdout))
        for path in ("methods/methods.def", "methods/rules/rules.def", "methods/weights/weights.def",
                     "problems/problems.def", "problems/core/layouts/layouts.def",
                     "problems/core/forms/forms.def"):
            self.assertEqual([n for n in names_in(path) if n not in words], [], path)
        for name in ("umfpack", "brute", "nanoflann"):
            self.assertIn(name, words)

    def test_help_names_the_options_of_the_contract(self):
        for study in STUDIES:
            text = run(study, "--help").stdout
            for option in ("--problem", "--method", "--stencil", "--cloud", "--levels", "--form",
                           "--solver", "--threads", "--repeat", "--seed", "--neighbours", "--vtk", "--csv",
                           "--json", "--list", "--smoke", "--resume"):
                self.assertIn(option, text, study)

    def test_every_study_survives_its_smoke_run(self):
        for study in STUDIES:
            with self.subTest(study):
                result = run(study, "--smoke", "--csv", "-")
                self.assertEqual(result.returncode, 0, result.stderr + result.stdout)
                self.assertIn("ok", {r["status"] for r in rows_of(result.stdout)})


class Refusals(StudyTest):
    def test_unknown_names_are_refused_with_the_known_ones(self):
        self.assert_refused(["--method", "mfpn"], "--method", "mfpn", "mfpm", "rbf_fd")
        self.assert_refused(["--problem", "poison"], "--problem", "poison", "poisson_square")
        self.assert_refused(["--stencil", "closest"], "--stencil", "closest", "nearest")
        self.assert_refused(["--cloud", "mesh"], "--cloud", "mesh", "perturbed")
        self.assert_refused(["--form", "weak"], "--form", "weak", "collocation")
        self.assert_refused(["--solver", "pardiso"], "--solver", "pardiso", "umfpack")
        self.assert_refused(["--neighbours", "octree"], "--neighbours", "octree", "nanoflann")

    def test_unknown_keys_are_refused_with_the_known_ones(self):
        self.assert_refused(["--method", "mfpm[ordre=2]"], "--method", "ordre", "order")
        self.assert_refused(["--stencil", "nearest[n=9]"], "--stencil", "'n'", "ties")

    def test_malformed_specs_are_refused(self):
        for spec in ("mfpm[order=2", "mfpm]", "mfpm[order]", "mfpm,", "[order=2]", "mfpm[order=2]x"):
            with self.subTest(spec):
                self.assert_refused(["--method", spec], "--method", "malformed")

    def test_levels_must_be_positive_integers(self):
        for levels in ("0", "-3", "ten", "9,,11", "9.5", "all", "99999999999999999999"):
            with self.subTest(levels):
                self.assert_refused([f"--levels={levels}"], "--levels", "positive integers")

    def test_numbers_out_of_range_are_refused_with_the_range(self):
        self.assert_refused(["--threads", "0"], "--threads", "0", "from 1 to")
        self.assert_refused(["--repeat", "many"], "--repeat", "many", "from 1 to")
        self.assert_refused(["--cloud", "perturbed[amount=much]", "--csv", "-"], "--cloud", "amount", "much")
        self.assert_refused(["--stencil", "nearest[k=-1]"], "--stencil", "k=-1")
        self.assert_refused(["--seed=-1"], "--seed", "-1", "from 0 to")

    def test_unknown_and_incomplete_options_are_refused(self):
        self.assert_refused(["--methods", "mfpm"], "--methods", "--method,")
        self.assert_refused(["plate_hole"], "plate_hole", "--problem")
        self.assert_refused(["--csv"], "--csv")
        self.assert_refused(["--csv", "--json", "x"], "--csv", "--json")
        self.assert_refused(["--levels", "9", "--levels", "11"], "--levels", "2 times")

    def test_output_that_cannot_be_opened_is_refused_before_anything_runs(self):
        path = self.directory / "none" / "table.csv"
        self.assert_refused([*QUICK, "--csv", path], "--csv", str(path), "No such file")
        self.assert_refused([*QUICK, "--json", path], "--json", str(path))
        self.assert_refused([*QUICK, "--csv", self.directory], "--csv", str(self.directory))
        self.assert_refused([*QUICK, "--csv", "-", "--json", "-"], "--json", "--csv")
        self.assert_refused([*QUICK, "--resume", "-"], "--resume")
        for option in ("--csv", "--resume"):
            self.assert_refused([*QUICK, option, self.table, "--json", f"{self.directory}/./table.csv"], "--json", option)

    def test_a_refused_command_leaves_an_existing_table_alone(self):
        self.table.write_text("precious", encoding="utf-8")
        self.assert_refused(["--method", "mfpn", "--csv", self.table])
        self.assert_refused([*QUICK, "--csv", self.table, "--json", self.directory / "no" / "x.json"])
        self.assertEqual(self.table.read_text(encoding="utf-8"), "precious")


class FailedCases(StudyTest):
    def test_level_one_is_a_failed_row_beside_the_others(self):
        self.assert_failed_rows(["--problem", "poisson_square", "--method", "mfpm", "--levels", "1,9"],
                                "level 1", ok_rows=2)

    def test_a_stencil_that_is_too_small_is_a_failed_row(self):
        self.assert_failed_rows([*QUICK, "--stencil", "nearest[k=3]"], "node", "larger k")

    def test_a_missing_cloud_file_is_a_failed_row(self):
        self.assert_failed_rows(["--problem", "poisson_square", "--method", "mfpm", "--cloud",
                                 "file[path=nope.csv]"], "nope.csv")

    def test_a_wrong_column_of_a_cloud_file_is_named(self):
        self.assert_failed_rows(self.cloud_file("x,y,colour\n0,0,left\n1,0,bottom\n"), "colour")

    def test_coincident_nodes_are_named(self):
        nodes = [(i / 4, j / 4) for i in range(5) for j in range(5)] + [(0.25, 0.25)]
        sides = {(0, "left"), (1, "right")}
        lines = ["x,y,tag"]
        for x, y in nodes:
            tag = next((s for at, s in sides if x == at), None)
            tag = tag or ("bottom" if y == 0 else "top" if y == 1 else "")
            lines.append(f"{x},{y},{tag}")
        self.assert_failed_rows(self.cloud_file("\n".join(lines) + "\n"), "0.25")

    def test_a_coordinate_that_is_not_a_number_is_named(self):
        self.assert_failed_rows(self.cloud_file("x,y,tag\n0,0,left\nnan,0.5,\n1,1,right\n"), "nan")


if __name__ == "__main__":
    unittest.main()
