"""Kernel sources, compiled for processors that not everyone has, must define nothing that other files define too."""

import os
import pathlib
import subprocess
import unittest

BUILD = pathlib.Path(os.environ["STRONGPOINT_BUILD"])
PATHS = ("scalar", "avx2", "avx512")


def shared_symbols(file):
    """Names of the functions of an object file that the linker may take from any of several files."""
    listing = subprocess.run(["nm", "-C", file], capture_output=True, text=True, check=True).stdout
    symbols = (line.split(maxsplit=2) for line in listing.splitlines())
    return [symbol[2] for symbol in symbols if len(symbol) == 3 and symbol[1] in "Ww"]


class SimdSymbols(unittest.TestCase):
    def test_kernels_share_nothing_with_other_files(self):
        for path in PATHS:
            files = list(BUILD.glob(f"*/CMakeFiles/strongpoint_*_{path}.dir/**/*.o"))
            self.assertTrue(files, f"no kernel is compiled for {path}")
            for file in files:
                for symbol in shared_symbols(file):
                    self.assertIn(f"strongpoint::{path}::", symbol, file.name)


if __name__ == "__main__":
    unittest.main()
