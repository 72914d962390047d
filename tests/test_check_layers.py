#!/usr/bin/python3
"""scripts/check_layers accepts this tree and names each kind of offence in a made-up one."""

import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
CHECK = ROOT / "scripts" / "check_layers"


def check(root):
    """Exit status and lines of the check of a tree."""
    done = subprocess.run([sys.executable, CHECK, root], capture_output=True, text=True, check=False)
    return done.returncode, done.stdout.splitlines()


class CheckLayers(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)
        self.root = pathlib.Path(self.directory.name)
        self.write("methods/core/method.hpp", "#pragma once\n#include <vector>\n")
        self.write("problems/plate.cpp", '#include "methods/core/method.hpp"\n')
        self.write("tests/plate.cpp", '#include "studies/support/study.hpp"\n')

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def expect_one_offence(self, path, text, word):
        self.write(path, text)
        status, lines = check(self.root)
        self.assertEqual(status, 1, lines)
        self.assertEqual(len(lines), 2, lines)  # the offence and the count
        self.assertTrue(lines[0].startswith(path + ":"), lines)
        self.assertIn(word, lines[0])

    def test_this_tree_is_clean(self):
        status, lines = check(ROOT)
        self.assertEqual((status, lines), (0, ["check_layers: ok"]))

    def test_a_clean_tree_is_accepted(self):
        self.assertEqual(check(self.root), (0, ["check_layers: ok"]))

    def test_methods_do_not_know_problems(self):
        self.expect_one_offence("methods/gfdm.cpp", '#include "problems/core/problem.hpp"\n', "problems")

    def test_problems_do_not_know_studies(self):
        self.expect_one_offence("problems/core/x.hpp", '  #  include "studies/support/row.hpp"\n', "studies")

    def test_studies_do_not_know_tests(self):
        self.expect_one_offence("studies/timing.cpp", '#include "tests/oracle.hpp"\n', "tests")

    def test_a_core_header_knows_no_concrete_method(self):
        self.expect_one_offence("methods/core/list.hpp", '#include "methods/gfdm.hpp"\n', "core header")

    def test_includes_are_written_from_the_root(self):
        self.expect_one_offence("methods/gfdm.cpp", '#include "core/method.hpp"\n', "from the root")

    def test_an_absolute_include_is_refused(self):
        place = "/" + "home/someone/method.hpp"
        self.expect_one_offence("methods/gfdm.cpp", f'#include "{place}"\n', "absolute")

    def test_a_place_of_one_machine_is_refused(self):
        place = "/" + "home/someone/data.csv"
        self.expect_one_offence("scripts/run", f"cat {place}\n", "one machine")

    def test_a_tree_without_rooms_is_bad_usage(self):
        with tempfile.TemporaryDirectory() as empty:
            self.assertEqual(check(empty)[0], 2)


if __name__ == "__main__":
    unittest.main()
