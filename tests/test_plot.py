#!/usr/bin/python3
"""results/plot draws what a table holds, the same way each time, and complains in one line."""
import csv
import importlib.machinery
import importlib.util
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

PLOT = pathlib.Path(__file__).resolve().parent.parent / "results" / "plot"
CONTRACT = ("study,problem,method,stencil,cloud,form,solver,level,nodes,unknowns,spacing,quantity,value,"
            "rate,status,reason").split(",")
TIMES = ("threads,t_cloud,t_prepare,t_neighbours,t_stencils,t_weights,t_assemble,t_solve,t_total,"
         "peak_mb,residual").split(",")


def loaded():
    """The script as a module."""
    loader = importlib.machinery.SourceFileLoader("plot", str(PLOT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("plot", loader))
    loader.exec_module(module)
    return module


def plot(*arguments):
    return subprocess.run([str(PLOT), *map(str, arguments)], capture_output=True, text=True, check=False)


class PlotTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.directory = pathlib.Path(self.scratch.name)
        self.table = self.directory / "table.csv"

    def write(self, rows, columns=CONTRACT):
        with open(self.table, "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, columns, restval="")
            writer.writeheader()
            writer.writerows(rows)

    def error_rows(self, method="mfpm", order=2, quantity="u_error", levels=(11, 21, 41)):
        return [{"study": "convergence", "problem": "poisson_square", "method": method,
                 "stencil": "nearest[k=9,ties=cut]", "cloud": "grid", "form": "collocation",
                 "solver": "umfpack", "level": n, "nodes": n * n, "unknowns": n * n, "spacing": 1 / n,
                 "quantity": quantity, "value": n**-order, "status": "ok"} for n in levels]

    def assert_refused(self, result, *words):
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def test_work_precision_gives_errors_against_time_with_a_front_that_nothing_beats(self):
        rows = [{**row, "t_total": 10.0**k, "front": ""} for method in ("mfpm", "lsfdm")
                for k, row in enumerate(self.error_rows(method))]
        rows[1]["value"] = 10  # slower and worse than the first
        self.write(rows, CONTRACT + TIMES + ["front"])
        result = plot(self.table, "-o", self.directory)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertTrue((self.directory / "convergence_poisson-square_u-error_time.png").stat().st_size)
        sys.path.insert(0, str(PLOT.parent))
        import fronts
        points = [(1, 0.5), (2, 0.7), (3, 0.1), (4, 0.1)]
        front = fronts.front_of([{"level": i, "t_total": t, "value": v} for i, (t, v) in enumerate(points)])
        self.assertEqual(front, [(1, 0.5), (3, 0.1)])

    def test_scaling_gives_stages_and_memory_against_nodes(self):
        rows = [{**row, "per_node": 1, "exponent": "1.02"} for quantity in ("weights", "total", "memory")
                for row in self.error_rows(order=-2, quantity=quantity)]
        self.write(rows, CONTRACT + ["per_node", "exponent"])
        result = plot(self.table, "-o", self.directory)
        self.assertEqual(result.returncode, 0, result.stderr)
        (drawn,) = self.directory.glob("*.svg")
        self.assertIn("1.02", drawn.read_text(encoding="utf-8"))
        self.write(rows[:1], CONTRACT + ["per_node", "exponent"])
        self.assert_refused(plot(self.table, "-o", self.directory), "nothing to draw")

    def test_error_table_gives_a_png_and_an_svg_per_quantity(self):
        self.write(self.error_rows() + self.error_rows(quantity="u_max_error"))
        result = plot(self.table, "-o", self.directory / "figures")
        self.assertEqual(result.returncode, 0, result.stderr)
        files = sorted(p.name for p in (self.directory / "figures").iterdir())
        stems = ["convergence_poisson-square_grid_u-error", "convergence_poisson-square_grid_u-max-error"]
        self.assertEqual(files, sorted(s + e for s in stems for e in (".png", ".svg")))
        self.assertTrue((self.directory / "figures" / files[0]).read_bytes().startswith(b"\x89PNG"))
        self.assertEqual(result.stdout.split(), [str(self.directory / "figures" / s) + e
                                                 for s in stems for e in (".png", ".svg")])

    def test_the_same_table_gives_the_same_bytes(self):
        self.write(self.error_rows() + self.error_rows("gfdm", 1))
        for run in ("one", "two"):
            self.assertEqual(plot(self.table, "-o", self.directory / run).returncode, 0)
        for path in (self.directory / "one").iterdir():
            self.assertEqual(path.read_bytes(), (self.directory / "two" / path.name).read_bytes(), path.name)

    def test_no_figure_of_one_table_replaces_that_of_another(self):
        self.write(self.error_rows())
        other = self.directory / "other.csv"
        other.write_bytes(self.table.read_bytes())
        self.assert_refused(plot(self.table, other, "-o", self.directory / "figures"),
                            "convergence_poisson-square_grid_u-error", "-o")

    def test_a_method_has_one_style_whatever_stands_beside_it(self):
        module = loaded()
        styles = [module.method_style(name) for name in module.METHODS]
        self.assertEqual(len(set(styles)), len(styles))
        self.assertEqual(module.method_style("mfpm"), module.method_style("mfpm[order=4]"))
        self.assertEqual(module.method_style("unheard_of"), module.method_style("unheard_of"))

    def test_triangles_show_the_orders_of_the_curves(self):
        module = loaded()
        h = module.np.array([0.1, 0.2, 0.4])
        curves = {i: module.np.column_stack([h, h**order]) for i, order in enumerate((1.9, 4.1, 2.05))}
        self.assertEqual(module.observed_orders(curves, 1.0), [2, 4])
        by_unknowns = {0: module.np.column_stack([h**-2, h**3])}
        reversed_rows = {0: by_unknowns[0][::-1]}
        self.assertEqual(module.observed_orders(reversed_rows, -0.5), [3])

    def test_the_power_of_unknowns_tells_the_dimension(self):
        module = loaded()
        for dimension in (1, 2, 3):
            rows = [{"spacing": 1 / n, "unknowns": n**dimension} for n in (10.0, 20.0, 40.0)]
            self.assertAlmostEqual(module.power_of(rows, "unknowns"), -1 / dimension)

    def test_timing_tables_give_bars_of_phases_and_stages(self):
        rows = []
        for algorithm in ("sort", "cells"):
            for row in self.error_rows(quantity="search") + self.error_rows(quantity="inversion"):
                row.update({name: 0.1 for name in TIMES}, algorithm=algorithm, study="timing")
                rows.append(row)
        self.write(rows, CONTRACT + TIMES + ["algorithm"])
        result = plot(self.table)
        self.assertEqual(result.returncode, 0, result.stderr)
        names = {pathlib.Path(line).name for line in result.stdout.split()}
        self.assertEqual(names, {f"timing_poisson-square_grid_{kind}.{suffix}"
                                 for kind in ("phases", "stages") for suffix in ("png", "svg")})
        module = loaded()
        bars = module.phase_bars([r for r in module.read_rows(self.table) if r["level"] == 41])
        self.assertEqual([label for label, _ in bars[41]], ["mfpm, sort", "mfpm, cells"])
        self.assertAlmostEqual(bars[41][0][1]["search"], 41**-2)

    def test_curves_alone_are_drawn_when_asked_for(self):
        rows = [dict(row, **{name: 0.1 for name in TIMES}) for row in self.error_rows()]
        self.write(rows, CONTRACT + TIMES)
        result = plot(self.table, "--curves")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([pathlib.Path(line).name for line in result.stdout.split()],
                         [f"convergence_poisson-square_grid_u-error.{suffix}" for suffix in ("png", "svg")])
        self.assert_refused(plot("map.vtu", "--curves"), "--curves", "map.vtu")

    def test_each_algorithm_has_a_panel_a_level_with_the_shares_that_fit(self):
        module = loaded()
        columns = {"sort": {41: [("mfpm", {"search": 9.0, "matrix": 1.0, "inversion": 0.001})]},
                   "cells": {41: [("mfpm", {"search": 0.03, "inversion": 0.01})]}}
        figures = []
        module.save = lambda figure, *_: figures.append(figure)
        self.assertTrue(module.draw_bars(columns, module.PHASES, "title", self.directory, "name"))
        panels = figures[0].axes
        self.assertEqual([axes.get_title("left") for axes in panels], ["level 41, sort", "level 41, cells"])
        self.assertEqual([[text.get_text() for text in axes.texts] for axes in panels],
                         [["90 %", "10 %"], ["75 %", "25 %"]])
        self.assertGreater(panels[0].get_xlim()[1], 100 * panels[1].get_xlim()[1])
        self.assertEqual([text.get_text() for text in panels[1].get_legend().get_texts()],
                         ["search", "matrix", "inversion"])

    def test_failed_rows_leave_the_curve_to_the_others(self):
        rows = self.error_rows()
        rows[1].update(value="", status="failed", reason="singular, at node 3")
        self.write(rows)
        self.assertEqual(plot(self.table).returncode, 0)

    def test_only_the_quantity_asked_for_is_drawn(self):
        self.write(self.error_rows() + self.error_rows(quantity="u_max_error"))
        result = plot(self.table, "--quantity", "u_max_error")
        self.assertEqual(len(result.stdout.split()), 2)
        self.assertTrue(all(re.search("u-max-error", line) for line in result.stdout.split()))

    def test_bad_requests_are_refused_in_one_line(self):
        self.write(self.error_rows())
        self.assert_refused(plot(self.directory / "none.csv"), "none.csv", "No such file")
        self.assert_refused(plot(self.table, "--quantity", "w_error"), "w_error", "u_error")
        self.assert_refused(plot(self.table, "--colour", "red"), "--colour")
        self.assert_refused(plot(self.table, "-o", "/proc/none"), "/proc/none")
        self.assert_refused(plot(), "FILE.csv")

    def test_a_foreign_table_is_refused_with_the_columns_it_lacks(self):
        self.table.write_text("study,problem\na,b\n", encoding="utf-8")
        self.assert_refused(plot(self.table), "method", "spacing")

    def test_a_word_for_a_number_is_refused_with_its_line(self):
        rows = self.error_rows()
        rows[2]["value"] = "small"
        self.write(rows)
        self.assert_refused(plot(self.table), "line 4", "value", "small")

    def test_a_table_without_values_is_refused(self):
        self.write([])
        self.assert_refused(plot(self.table), "nothing to draw")


if __name__ == "__main__":
    unittest.main()
