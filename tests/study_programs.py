"""What the tests of the study programs share: where the programs are and how they are run."""
import csv
import io
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
if len(sys.argv) > 1 and os.path.isdir(sys.argv[1]):
    BUILD = pathlib.Path(sys.argv.pop(1))
else:
    BUILD = pathlib.Path(os.environ.get("STRONGPOINT_BUILD", ROOT / "build"))
CONTRACT = ("study,problem,method,stencil,cloud,form,solver,level,nodes,unknowns,spacing,quantity,value,"
            "rate,status,reason").split(",")
TIMES = ("threads,t_cloud,t_prepare,t_neighbours,t_stencils,t_weights,t_assemble,t_solve,t_total,"
         "peak_mb,residual").split(",")
QUICK = ["--problem", "poisson_square", "--method", "mfpm", "--levels", "9,11"]
DEADLINE = 120  # seconds; generous, as a sanitised build is slow


def names_in(path):
    """The names listed in a .def file."""
    return re.findall(r"^[A-Z]+\((\w+)\)", (ROOT / path).read_text(encoding="utf-8"), re.M)


STUDIES = names_in("studies/studies.def")


def command(study, *arguments):
    return [str(BUILD / "studies" / study), *map(str, arguments)]


def run(study, *arguments, **options):
    return subprocess.run(command(study, *arguments), capture_output=True, text=True, check=False,
                          timeout=DEADLINE, **options)


def rows_of(text):
    return list(csv.DictReader(io.StringIO(text)))


def untimed(text):
    """The records of a table without the columns that differ from run to run."""
    header, *records = csv.reader(io.StringIO(text.decode() if isinstance(text, bytes) else text))
    kept = [i for i, name in enumerate(header) if name not in TIMES]
    return [[record[i] for i in kept] for record in [header, *records]]


class StudyTest(unittest.TestCase):
    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory()
        self.addCleanup(self.scratch.cleanup)
        self.directory = pathlib.Path(self.scratch.name)
        self.table = self.directory / "table.csv"

    def assert_refused(self, arguments, *words, study="convergence"):
        """Exit status 2, nothing on standard output, one line that holds the words."""
        result = run(study, *arguments)
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)

    def assert_failed_rows(self, arguments, *words, ok_rows=0):
        """Exit status 1 and failed rows without a value whose reason holds the words."""
        result = run("convergence", *arguments, "--csv", "-")
        self.assertEqual(result.returncode, 1, result.stderr)
        rows = rows_of(result.stdout)
        failed = [row for row in rows if row["status"] == "failed"]
        self.assertTrue(failed)
        self.assertEqual(len(rows) - len(failed), ok_rows)
        self.assertEqual({row["quantity"] for row in failed}, {"u_error", "u_max_error"})
        for row in failed:
            self.assertEqual((row["value"], row["rate"]), ("", ""))
            for word in words:
                self.assertIn(word, row["reason"])

    def cloud_file(self, text):
        path = self.directory / "cloud.csv"
        path.write_text(text, encoding="utf-8")
        return ["--problem", "poisson_square", "--method", "mfpm", "--cloud", f"file[path={path}]"]
