#!/usr/bin/python3
"""Maps: what --vtk writes, and what results/plot draws of it.

Usage: test_maps.py [BUILD_DIRECTORY]; without it the variable STRONGPOINT_BUILD names it.
"""
import base64
import math
import re
import struct
import subprocess
import sys
import unittest
import xml.etree.ElementTree as ElementTree

from study_programs import QUICK, ROOT, StudyTest, rows_of, run

FORMATS = {"Float64": ("d", 8), "Int64": ("q", 8), "UInt8": ("B", 1)}
GRID = ["--problem", "field", "--method", "mfpm", "--stencil", "nearest[k=9]", "--cloud", "grid", "--levels",
        "9"]


def numbers(element):
    """The numbers of a DataArray in VTK's inline binary format."""
    raw = base64.b64decode(element.text)
    letter, size = FORMATS[element.get("type")]
    (count,) = struct.unpack_from("<Q", raw)
    assert count == len(raw) - 8 and element.get("format") == "binary"
    return struct.unpack(f"<{count // size}{letter}", raw[8:])


def plot(*arguments):
    return subprocess.run([str(ROOT / "results" / "plot"), *map(str, arguments)], capture_output=True,
                          text=True, check=False)


class MapTest(StudyTest):
    def maps(self, study, *arguments):
        """The .vtu files of a run, each with its element tree."""
        self.result = run(study, *arguments, "--csv", "-", "--vtk", self.directory / "maps" / "new")
        self.assertEqual(self.result.returncode, 0, self.result.stderr)
        files = sorted((self.directory / "maps" / "new").iterdir())
        return {path: ElementTree.parse(path).getroot() for path in files}


@unittest.skipUnless(sys.byteorder == "little", "reads little-endian files")
class Files(MapTest):
    def arrays(self, root):
        return {a.get("Name"): numbers(a) for a in root.findall(".//PointData/DataArray")}

    def test_a_form_with_points_beside_the_nodes_writes_numbers_of_the_nodes_only(self):
        ((_, root),) = self.maps("convergence", "--problem", "poisson_square", "--method", "mls[h=1.3]", "--form",
                                 "mlpg", "--levels", "7").items()
        arrays = self.arrays(root)
        self.assertEqual({name: len(values) for name, values in arrays.items()},
                         {"u": 49, "stencil_size": 49, "zone": 49})
        self.assertEqual(sum(arrays["zone"]), 24)

    def test_a_file_holds_every_node_as_a_vertex_with_its_numbers(self):
        ((_, root),) = self.maps("conditioning", *GRID).items()
        self.assertEqual((root.tag, root.get("type"), root.get("byte_order"), root.get("header_type")),
                         ("VTKFile", "UnstructuredGrid", "LittleEndian", "UInt64"))
        piece = root.find("UnstructuredGrid/Piece")
        self.assertEqual((piece.get("NumberOfPoints"), piece.get("NumberOfCells")), ("81", "81"))
        positions = numbers(piece.find("Points/DataArray"))
        self.assertEqual(positions, tuple(c for i in range(9) for j in range(9) for c in (i / 8, j / 8, 0)))
        cells = {a.get("Name"): numbers(a) for a in piece.findall("Cells/DataArray")}
        self.assertEqual(cells, {"connectivity": tuple(range(81)), "offsets": tuple(range(1, 82)),
                                 "types": (1,) * 81})
        codes = root.find(".//FieldData/Array[@Name='case']").text.split()
        self.assertEqual(bytes(map(int, codes)),
                         b"field, mfpm, stencil nearest[k=9], cloud grid, level 9\0")

    def test_numbers_of_stencils_are_those_of_the_table(self):
        ((_, root),) = self.maps("conditioning", *GRID).items()
        arrays = self.arrays(root)
        self.assertEqual(list(arrays), ["condition_two", "condition_one", "lebesgue_1", "lebesgue_2", "residual",
                                        "laplacian_centre", "stencil_size", "zone"])
        table = {r["quantity"]: float(r["value"]) for r in rows_of(self.result.stdout) if r["zone"] == "all"}
        for name in list(arrays)[:5]:
            self.assertEqual(max(arrays[name]), table[f"{name}_max"])
        wrong = sum(centre >= 0 for centre in arrays["laplacian_centre"]) / 81
        self.assertEqual(wrong, table["centre_sign_wrong"])
        self.assertEqual(sum(arrays["zone"]), 32)
        self.assertEqual((arrays["stencil_size"][40], min(arrays["stencil_size"])), (9, 9))

    def test_singular_stencils_are_infinite(self):
        ((_, root),) = self.maps("conditioning", *GRID[:4], "--stencil", "nearest[k=4,ties=cut]", *GRID[6:]).items()
        arrays = self.arrays(root)
        self.assertTrue(all(math.isinf(c) for c in arrays["condition_two"]))
        self.assertNotIn("lebesgue_1", arrays)
        self.assertEqual(set(arrays["stencil_size"]), {4})

    def test_convergence_writes_the_fields_of_each_case(self):
        files = self.maps("convergence", *QUICK)
        self.assertEqual(len(files), 2)
        for path, root in files.items():
            self.assertRegex(path.name, r"^convergence_poisson_square_mfpm_[\w.-]+_grid_(9|11)_[0-9a-f]{8}\.vtu$")
            arrays = self.arrays(root)
            self.assertEqual(list(arrays), ["u", "stencil_size", "zone"])
            x = numbers(root.find(".//Points/DataArray"))
            for i, (u, zone) in enumerate(zip(arrays["u"], arrays["zone"])):
                exact = math.sin(2 * x[3 * i] + 1) * math.cos(3 * x[3 * i + 1])
                # The boundary is prescribed; inside, level 9 has an error below two hundredths.
                self.assertAlmostEqual(u, exact, delta=1e-12 if zone else 0.02)

    def test_local_accuracy_writes_the_errors_of_its_table(self):
        ((_, root),) = self.maps("local_accuracy", *GRID).items()
        arrays = self.arrays(root)
        self.assertEqual(list(arrays), ["dx_error", "dy_error", "dxx_error", "dxy_error", "dyy_error", "zone"])
        x = numbers(root.find(".//Points/DataArray"))
        for zone, name in ((0, "dx_interior"), (1, "dx_boundary")):
            chosen = [i for i, z in enumerate(arrays["zone"]) if z == zone]
            exact = [2 * math.cos(2 * x[3 * i] + 1) * math.cos(3 * x[3 * i + 1]) for i in chosen]
            error = math.hypot(*(arrays["dx_error"][i] for i in chosen)) / math.hypot(*exact)
            told = next(float(r["value"]) for r in rows_of(self.result.stdout) if r["quantity"] == name)
            self.assertAlmostEqual(error, told, delta=1e-12)

    def test_one_dimension_and_three_are_written_too(self):
        for problem, nodes in (("bvp_1d", 9), ("poisson_cube", 729)):
            files = self.maps("convergence", "--problem", problem, "--method", "mfpm", "--levels", "9")
            root = next(r for p, r in files.items() if problem in p.name)
            self.assertEqual(len(numbers(root.find(".//Points/DataArray"))), 3 * nodes)

    def test_a_case_a_file_even_when_specs_look_alike(self):
        files = self.maps("convergence", *QUICK[:4], "--levels", "9", "--stencil",
                          "nearest[k=9],nearest[k=9,ties=cut],grow_until", "--cloud", "grid,perturbed")
        self.assertEqual(len(files), 6)

    def test_the_map_of_another_scaling_replaces_none(self):
        self.maps("conditioning", *GRID)
        files = self.maps("conditioning", *GRID, "--scaling", "row")
        first = {next(iter(self.arrays(root))) for root in files.values()}
        self.assertEqual(first, {"condition_two", "condition_two_row"})

    def test_what_cannot_be_written_is_refused_before_anything_runs(self):
        self.table.write_text("a file", encoding="utf-8")
        self.assert_refused([*QUICK, "--vtk", self.table], "--vtk", str(self.table))
        self.assert_refused(["--smoke", "--vtk", self.directory], "--vtk", "timing", study="timing")


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
        two = base64.b64encode(struct.pack("<Qdd", 16, 1, 2)).decode()
        short.write_text(re.sub('(Name="zone"[^>]*>\n)[^<]*', r"\g<1>" + two, text), encoding="utf-8")
        title = self.directory / "title.vtu"
        title.write_text(re.sub('(Name="case"[^>]*>\n)', r"\g<1>300 ", text), encoding="utf-8")
        for arguments, word in (((short,), "2 numbers for 81 nodes"), ((title,), "title.vtu"),
                                ((path, "--array", "colour"), "condition_two"),
                                ((path, "--quantity", "u_error"), "--quantity"),
                                ((broken,), "broken.vtu"), ((self.directory / "none.vtu",), "No such file")):
            result = plot(*arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
            self.assertIn(word, result.stderr)


if __name__ == "__main__":
    unittest.main()
