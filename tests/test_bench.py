#!/usr/bin/python3
"""How scripts/bench judges what a benchmark measured."""
import importlib.machinery
import importlib.util
import pathlib
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "bench"
LOADER = importlib.machinery.SourceFileLoader("bench", str(SCRIPT))
bench = importlib.util.module_from_spec(importlib.util.spec_from_loader("bench", LOADER))
LOADER.exec_module(bench)


def measured(ratio, **changes):
    """What Google Benchmark writes of a goal of 6, stretch 9."""
    return {"name": "goal/knn/2d/iterations:1/manual_time", "ratio": ratio, "goal": 6.0, "stretch": 9.0,
            "subject": 1e-6, "rival": ratio * 1e-6, "label": "against nanoflann; k=15 N=100000", **changes}


class Verdicts(unittest.TestCase):
    def test_a_goal_is_met_from_its_ratio_on_and_stretched_from_the_next(self):
        for ratio, verdict in ((5.9, "short"), (6.0, "met"), (8.9, "met"), (9.0, "stretch")):
            self.assertEqual(bench.judged(measured(ratio))["verdict"], verdict)

    def test_a_goal_without_a_stretch_is_met_at_most(self):
        self.assertEqual(bench.judged(measured(50.0, stretch=0.0))["verdict"], "met")

    def test_the_line_names_goal_ratio_and_rival(self):
        row = bench.judged(measured(7.5))
        line = bench.line_of(row)
        for word in ("met", "knn/2d", "7.50", "goal 6", "stretch 9", "nanoflann"):
            self.assertIn(word, line)
        self.assertEqual((row["rival"], row["setting"]), ("nanoflann", "k=15 N=100000"))

    def test_answers_that_differ_are_told_and_judge_nothing(self):
        row = bench.judged({"name": "goal/knn/2d/iterations:1/manual_time", "error_occurred": True,
                            "error_message": "row 7 differs"})
        self.assertEqual(row["verdict"], "failed")
        self.assertIn("row 7 differs", bench.line_of(row))

    def test_of_several_passes_each_side_keeps_its_least_time(self):
        goals = {}
        for subject, rival in ((2e-6, 9e-6), (1e-6, 12e-6), (3e-6, 8e-6)):
            bench.keep_least(goals, measured(rival / subject, subject=subject, rival=rival))
        (kept,) = goals.values()
        self.assertEqual((kept["subject"], kept["rival"], kept["ratio"]), (1e-6, 8e-6, 8.0))

    def test_answers_that_differ_in_any_pass_are_told(self):
        wrong = {"name": "goal/knn/2d/iterations:1/manual_time", "error_occurred": True, "error_message": "row 7 differs"}
        for order in ((measured(7.5), wrong), (wrong, measured(7.5))):
            goals = {}
            for one in order:
                bench.keep_least(goals, dict(one))
            self.assertEqual([bench.judged(kept)["verdict"] for kept in goals.values()], ["failed"])

    def test_the_tables_go_where_they_are_wanted(self):
        with tempfile.TemporaryDirectory() as directory:
            output = pathlib.Path(directory) / "elsewhere"
            bench.write([bench.judged(measured(7.5))], [("cpu", "one of a kind")], output)
            self.assertIn("knn/2d,met,7.50", (output / "goals.csv").read_text(encoding="utf-8"))
            self.assertIn("- cpu: one of a kind", (output / "goals.md").read_text(encoding="utf-8"))

    def test_every_program_has_its_source_and_every_main_is_a_program(self):
        sources = (SCRIPT.parent.parent / "bench").glob("*.cpp")
        mains = {file.stem for file in sources if "int main(" in file.read_text(encoding="utf-8")}
        self.assertEqual(set(bench.known_programs()), mains)


if __name__ == "__main__":
    unittest.main()
