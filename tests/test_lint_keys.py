#!/usr/bin/python3
"""What scripts/lint leaves out: files that passed and that are, with all they include, what they were."""
import importlib.machinery
import importlib.util
import os
import pathlib
import tempfile
import unittest

SCRIPT = pathlib.Path(__file__).resolve().parent.parent / "scripts" / "lint_keys"
LOADER = importlib.machinery.SourceFileLoader("lint_keys", str(SCRIPT))
lint_keys = importlib.util.module_from_spec(importlib.util.spec_from_loader("lint_keys", LOADER))
LOADER.exec_module(lint_keys)

MADE = 2_000_000_000  # when the object was made, in nanoseconds


class Keys(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.before = os.getcwd()
        os.chdir(self.folder.name)
        for name in ("build", "scripts", "methods"):
            os.mkdir(name)
        for name in (*lint_keys.RULES, "methods/a.cpp", "methods/a.hpp"):
            self.write(name, name)

    def tearDown(self):
        os.chdir(self.before)
        self.folder.cleanup()

    def write(self, name, text, when=MADE - 1):
        pathlib.Path(name).write_text(text, encoding="utf-8")
        os.utime(name, ns=(when, when))

    def key(self, validity="VALID", options="", version="14"):
        lint_keys.state.cache_clear()
        database = [{"file": os.path.abspath("methods/a.cpp"), "command": f"g++ {options} -o a.o -c ../methods/a.cpp"},
                    {"file": os.path.abspath("build/made.cpp"), "command": "g++ -o made.o -c made.cpp"}]
        listing = f"a.o: #deps 2, deps mtime {MADE} ({validity})\n    ../methods/a.cpp\n    ../methods/a.hpp\n\n"
        [(path, key)] = lint_keys.keys(database, listing, version)
        self.assertEqual(path, "methods/a.cpp")
        return key

    def test_a_file_that_did_not_change_keeps_its_key(self):
        self.assertEqual(self.key(), self.key())
        self.assertNotEqual(self.key(), "unknown")

    def test_the_key_changes_with_all_that_the_tool_reads(self):
        keys = [self.key(), self.key(options="-DX"), self.key(version="15")]
        for name in ("methods/a.cpp", "methods/a.hpp", *lint_keys.RULES):
            self.write(name, "other")
            keys.append(self.key())
        self.assertEqual(len(set(keys)), len(keys))
        self.assertNotIn("unknown", keys)

    def test_a_key_is_unknown_where_the_build_is_behind(self):
        self.assertEqual(self.key(validity="STALE"), "unknown")
        self.write("methods/a.hpp", "newer than the object", when=MADE + 1)
        self.assertEqual(self.key(), "unknown")
        os.remove("methods/a.hpp")
        self.assertEqual(self.key(), "unknown")


if __name__ == "__main__":
    unittest.main()
