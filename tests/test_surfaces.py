#!/usr/bin/python3
"""Surfaces, sections and deformed shapes that results/plot draws of .vtu files.

Usage: test_surfaces.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import subprocess
import sys
import types
import unittest

import numpy as np

from study_programs import ROOT
from vtu_files import MapTest

sys.path.insert(0, str(ROOT / "results"))
import maps  # noqa: E402  (stands beside the plots)
import surfaces  # noqa: E402
from vtu import Map, MapError, distances  # noqa: E402

PLATE = ["--problem", "plate_hole", "--method", "lsfdm", "--levels", "21"]


def plot(*arguments):
    return subprocess.run([str(ROOT / "results" / "plot"), *map(str, arguments)], capture_output=True,
                          text=True, check=False)


def area_of(triangles):
    x, y = triangles.x[triangles.get_masked_triangles()], triangles.y[triangles.get_masked_triangles()]
    return np.abs((x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0])).sum() / 2


def scattered(count, dim, seed=1):
    return np.random.default_rng(seed).random((count, dim))


class Surfaces(unittest.TestCase):
    def test_distances_are_those_of_all_pairs(self):
        places = scattered(500, 3)
        pairs = np.sort(np.linalg.norm(places[:, None] - places[None], axis=2), axis=1)
        for rank in (1, 4):
            np.testing.assert_allclose(distances(places, rank), pairs[:, rank], rtol=1e-12)

    def test_nodes_at_one_place_count_once(self):
        places = np.array([[0, 0, 0], [0, 0, 0], [1, 0, 0], [3, 0, 0]], float)
        np.testing.assert_array_equal(distances(places, 1), [1, 1, 1, 2])

    def test_a_hole_stays_open(self):
        grid = np.stack(np.meshgrid(*[np.linspace(-1, 1, 41)] * 2), axis=-1).reshape(-1, 2)
        angles = np.arange(40) * np.pi / 20
        # Nodes on the circle, and those of the grid that keep half a spacing from it.
        places = np.vstack([grid[np.hypot(*grid.T) > 0.425], 0.4 * np.column_stack([np.cos(angles), np.sin(angles)])])
        triangles = surfaces.surface(places)
        polygon = 0.4**2 * 20 * np.sin(np.pi / 20)
        self.assertAlmostEqual(area_of(triangles), 4 - polygon, delta=1e-12)
        self.assertEqual(len(surfaces.outline(triangles)), 160 + 40)

    def test_random_nodes_leave_few_gaps(self):
        # The hull of 4000 random nodes lacks about 1 % of the square, and some wide triangles beside it.
        self.assertGreater(area_of(surfaces.surface(scattered(4000, 2))), 0.97)

    def test_missing_values_leave_gaps(self):
        grid = np.stack(np.meshgrid(*[np.arange(5.0)] * 2), axis=-1).reshape(-1, 2)
        values = np.where((grid == 2).all(axis=1), np.nan, 1.0)
        area = area_of(surfaces.surface(grid, values))
        self.assertTrue(12 <= area <= 14, area)  # six triangles about a node, or four, or eight: 2 to 4
        self.assertIsNone(surfaces.surface(grid, np.full(25, np.inf)))
        self.assertIsNone(surfaces.surface(np.column_stack([np.arange(5.0), np.zeros(5)])))

    def test_a_section_takes_the_nodes_on_the_plane_alone(self):
        grid = np.stack(np.meshgrid(*[np.arange(5) / 4] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        nodes = Map(grid, {"number": np.arange(125.0)}, "")
        for text, axis, shown in (("x=0.25", 0, [1, 2]), ("y=0", 1, [0, 2]), ("z=1", 2, [0, 1])):
            cut, axes = surfaces.on_plane(nodes, text)
            self.assertEqual(axes, shown)
            np.testing.assert_array_equal(cut.arrays["number"],
                                          np.flatnonzero(grid[:, axis] == float(text[2:])))

    def test_a_section_between_layers_takes_one_of_them_whole(self):
        # Layers far apart against the spacing within: half a nearest distance would take no node.
        grid = np.stack(np.meshgrid(*[np.arange(9) / 80] * 2, np.arange(9) / 8, indexing="ij"), axis=-1).reshape(-1, 3)
        for text, layer in (("z=0.3", 0.25), ("z=0.32", 0.375), ("z=0.3125", 0.25)):
            cut, _ = surfaces.on_plane(Map(grid, {}, ""), text)
            self.assertEqual((len(cut.positions), set(cut.positions[:, 2])), (81, {layer}))

    def test_a_section_beside_the_nodes_takes_a_layer(self):
        places = scattered(8000, 3)
        cut, _ = surfaces.on_plane(Map(places, {}, ""), "z=0.5")
        nearest = distances(places, 1)
        near = np.abs(places[:, 2] - 0.5) <= nearest / 2
        np.testing.assert_array_equal(cut.positions, places[near])

    def test_what_is_no_plane_or_misses_the_nodes_is_refused(self):
        nodes = Map(scattered(100, 3), {}, "")
        for text, word in (("w=0", "w=0"), ("y", "--plane y=0"), ("y=one", "y=one"), ("=1", "=1"), ("y=nan", "y=nan"),
                           ("y=7", "y runs from 0")):
            with self.assertRaisesRegex(MapError, word):
                surfaces.on_plane(nodes, text)


class Pictures(MapTest):
    def draw(self, path, *arguments):
        result = plot(path, "-o", self.directory / "png", *arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [line.rsplit("/", 1)[1].removeprefix(path.stem) for line in result.stdout.split("\n")[:-1]]

    def test_a_plate_is_drawn_filled_and_deformed(self):
        ((path, _),) = self.maps("convergence", *PLATE).items()
        self.assertEqual(self.draw(path, "--filled", "--array", "sigma_xx", "--array", "condition_two"),
                         ["_sigma_xx.png", "_condition_two.png"])
        self.assertEqual(self.draw(path, "--warp", "100", "--array", "displacement"), ["_displacement_warp-100.png"])
        self.assertEqual(self.draw(path, "--warp", "1e2", "--filled", "--array", "u"), ["_u_warp-100.png"])

    def test_a_cube_is_cut(self):
        files = self.maps("convergence", "--problem", "poisson_cube", "--method", "mfpm", "--levels", "7")
        (path,) = files
        self.assertEqual(self.draw(path, "--plane", "y=0.5", "--array", "u"), ["_u_plane-y0.5.png"])
        for arguments, word in ((["--filled"], "--plane"), (["--warp", "1"], "displacement"),
                                (["--plane", "y=2"], "y runs from 0 to 1"),
                                (["--plane", "y=0", "--array", "condition_two"], "no surface")):
            result = plot(path, "-o", self.directory / "png", *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn(word, result.stderr)

    def test_the_axes_hold_all_nodes_moved_or_not(self):
        files = self.maps("convergence", "--problem", "thick_sphere", "--method", "lsfdm", "--cloud", "scattered",
                          "--levels", "6")
        (path,) = files
        for plane in (None, "z=0"):
            view = maps.View(path, types.SimpleNamespace(plane=plane, filled=None, warp=20.0))
            (axes, *_) = view.draw("von_mises").axes
            for axis, letter in enumerate("xyz"[:len(view.shown)]):
                low, high = getattr(axes, f"get_{letter}lim")()
                for places in (view.before, view.after):
                    self.assertLessEqual(low, places[:, axis].min())
                    self.assertGreaterEqual(high, places[:, axis].max())

    def test_sheets_of_what_is_no_collection_are_refused_in_one_line(self):
        broken, empty, lost = (self.directory / name for name in ("broken.pvd", "empty.pvd", "lost.pvd"))
        broken.write_text("<VTKFile", encoding="utf-8")
        empty.write_text("<VTKFile/>", encoding="utf-8")
        lost.write_text('<VTKFile><DataSet timestep="1" file="none.vtu"/></VTKFile>', encoding="utf-8")
        for file, word in ((broken, "not a .pvd"), (empty, "no frames"), (lost, "none.vtu"),
                           (self.directory / "none.pvd", "No such file"), ("map.vtu", "--sheet"), ("a.csv", "--sheet")):
            drawn = plot(file, "--sheet")
            self.assertEqual(drawn.returncode, 2, drawn.stderr)
            self.assertEqual(len(drawn.stderr.splitlines()), 1, drawn.stderr)
            self.assertIn(word, drawn.stderr)

    def test_lines_and_tables_are_refused(self):
        files = self.maps("convergence", "--problem", "bvp_1d", "--method", "mfpm", "--levels", "7")
        (path,) = files
        self.table.write_text(self.result.stdout, encoding="utf-8")
        for file, arguments in ((path, ["--warp", "1"]), (path, ["--warp", "nan"]), (path, ["--filled"]), (path, ["--plane", "x=0"]),
                                (self.table, ["--warp", "0"]), (self.table, ["--filled"]),
                                (self.table, ["--plane", "x=0"])):
            result = plot(file, "-o", self.directory / "png", *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn(arguments[0], result.stderr)


if __name__ == "__main__":
    unittest.main()
