#!/usr/bin/python3
"""Maps: what results/plot draws of the files that --vtk writes.

Usage: test_maps.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import re
import subprocess
import unittest

from study_programs import ROOT
from vtu_files import GRID, MapTest


def plot(*arguments):
    return subprocess.run([str(ROOT / "results" / "plot"), *map(str, arguments)], capture_output=True,
                          text=True, check=False)


class Pictures(MapTest):
    def test_a_map_gives_a_picture_an_array(self):
        ((path, _),) = self.maps("conditioning", *GRID).items()
        result = plot(path, "-o", self.directory / "png")
        self.assertEqual(result.returncode, 0, result.stderr)
        pictures = list((self.directory / "png").iterdir())
        self.assertEqual(len(pictures), 8)
        for picture in pictures:
            self.assertTrue(picture.read_bytes().startswith(b"\x89PNG"))
            self.assertRegex(picture.name, "^" + re.escape(path.stem) + r"_\w+\.png$")

    def test_several_files_are_drawn_by_one_command(self):
        files = self.maps("conditioning", *GRID[:-1], "5,7")
        result = plot(*files, "-o", self.directory / "png", "--array", "zone", "--array", "residual")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(set(result.stdout.split())), 4)

    def test_only_the_array_asked_for_is_drawn_whatever_the_dimension_and_the_gaps(self):
        singular = "nearest[k=2,ties=cut]"
        for dim, stencil in ((1, "nearest"), (1, singular), (2, singular), (3, "nearest")):
            files = self.maps("conditioning", "--problem", f"field[dim={dim}]", "--method", "mfpm",
                              "--stencil", stencil, "--cloud", "grid", "--levels", "5")
            for path in files:
                result = plot(path, "-o", self.directory / "png", "--array", "condition_two")
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertEqual(len(result.stdout.split()), 1)

    def test_bad_requests_are_refused_in_one_line(self):
        ((path, _),) = self.maps("conditioning", *GRID).items()
        broken = self.directory / "broken.vtu"
        broken.write_text("<VTKFile", encoding="utf-8")
        text = path.read_text(encoding="utf-8")
        short = self.directory / "short.vtu"
        short.write_text(re.sub('(Name="zone"[^>]*>\n)[^<]*', r"\g<1>AAAA", text), encoding="utf-8")
        for arguments, word in (((short,), "24 bytes"),
                                ((path, "--array", "colour"), "condition_two"),
                                ((path, "--quantity", "u_error"), "--quantity"),
                                ((broken,), "broken.vtu"), ((self.directory / "none.vtu",), "No such file")):
            result = plot(*arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()
