# SPDX-License-Identifier: LGPL-2.1-or-later
"""billet-fit on points of known laws, with and without noise: constants, stability, lines for a scene that
the program reads, refusals."""

from __future__ import annotations

import io
import os
import re
import subprocess
import sys
import tempfile
import unittest
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path

import numpy

import modules  # noqa: F401  finds the next one
from billet_tools import UserError
from billet_tools.fit import laws
from billet_tools.fit.command import run
from billet_tools.fit.data import Data, Points, read_data
from billet_tools.fit.fitting import fit_all

TRELOAR = laws.ogden([0.63, 0.0012, -0.01], [1.3, 5, -2])  # Ogden's fit of Treloar's data (Ogden 1972)
RANGES = {"uniaxial": 7.0, "equibiaxial": 4.5, "planar": 5.0}


def sample(law: laws.Law, noise: float = 0.0, n: int = 25) -> Data:
    """Returns points of a law, in compression, too, with errors of this part."""
    random = numpy.random.default_rng(3)
    data = {}
    for mode, greatest in RANGES.items():
        stretches = numpy.concatenate([numpy.linspace(0.6, 0.95, 5), numpy.linspace(1.05, greatest, n)])
        errors = 1 + noise * random.standard_normal(len(stretches))
        data[mode] = Points(stretches, law.stress(mode, stretches) * errors)
    return data


def write(data: Data, file: Path) -> None:
    """Writes a table with a comment, empty cells and strains of one mode."""
    modes = list(data)
    kinds = ["strain" if mode == "planar" else "stretch" for mode in modes]
    rows = ["# measured", ",".join(f"{mode}_{kind}, {mode}_stress" for mode, kind in zip(modes, kinds))]
    for i in range(max(len(points.stretches) for points in data.values()) + 1):
        cells = []
        for mode, kind in zip(modes, kinds):
            points = data[mode]
            if i < len(points.stretches):
                stretch = points.stretches[i] - (1 if kind == "strain" else 0)
                cells += [f"{float(stretch)!r}", f"{float(points.stresses[i])!r}"]
            else:
                cells += ["", ""]
        rows.append(",".join(cells))
    file.write_text("\n".join(rows))


def command(*arguments: str) -> tuple[int, str, str]:
    """Returns exit code and both outputs of the program."""
    out, errors = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(errors):
        code = run(arguments)
    return code, out.getvalue(), errors.getvalue()


class Laws(unittest.TestCase):
    """Stresses against separate evaluations of the formulas, and stability."""

    def test_stresses(self) -> None:
        for mode, stretch, stress in (
            ("uniaxial", 2.0, 0.6027),
            ("uniaxial", 7.0, 3.9952),
            ("equibiaxial", 4.0, 1.8977),
            ("planar", 7.0, 4.0735),
        ):
            self.assertAlmostEqual(float(TRELOAR.stress(mode, numpy.array([stretch]))[0]), stress, 4)
        mooney = laws.mooney_rivlin(0.293, 0.177)
        self.assertAlmostEqual(float(mooney.stress("equibiaxial", numpy.array([2.0]))[0]), 3.94144, 5)
        yeoh = laws.yeoh(0.184343, -0.0021273, 4.95955e-5)
        self.assertAlmostEqual(float(yeoh.stress("uniaxial", numpy.array([7.0]))[0]), 4.2739, 4)

    def test_arruda_boyce(self) -> None:
        law = laws.arruda_boyce(0.27, 3.5)
        n = 3.5**2
        series = 1 + 3 / (5 * n) + 99 / (175 * n**2) + 513 / (875 * n**3) + 42039 / (67375 * n**4)
        self.assertAlmostEqual(law.shear_modulus() / 0.27, series, 12)

    def test_stability(self) -> None:
        self.assertEqual(TRELOAR.warn(), [])
        softening = laws.yeoh(1, -0.1, 0)
        self.assertEqual(len(softening.warn()), 3)
        low, high = softening.stable_range("planar")
        self.assertTrue(0.5 < low < 0.9 and 1.2 < high < 2)


class Fits(unittest.TestCase):
    """Constants that are recovered."""

    def test_exact(self) -> None:
        for law in (
            laws.mooney_rivlin(0.293, 0.177),
            laws.yeoh(0.184343, -0.0021273, 4.95955e-5),
            laws.arruda_boyce(0.27, 3.5),
            TRELOAR,
        ):
            best = fit_all(sample(law), [law.name], 3, True)[0]
            self.assertLess(best.error, 1e-6, law.name)
            self.assertAlmostEqual(best.law.shear_modulus() / law.shear_modulus(), 1, 4, law.name)

    def test_constants(self) -> None:
        found = fit_all(sample(laws.arruda_boyce(0.27, 3.5)), ["Arruda-Boyce"], 3, True)[0].law
        self.assertEqual(found.lines, [("Chain modulus", "0.27"), ("Locking stretch", "3.5")])
        found = fit_all(sample(TRELOAR), ["Ogden"], 3, True)[0].law
        terms = sorted(zip(found.exponents, found.moduli))
        for (exponent, modulus), exact in zip(terms, [(-2, -0.01), (1.3, 0.63), (5, 0.0012)]):
            self.assertAlmostEqual(exponent / exact[0], 1, 2)
            self.assertAlmostEqual(modulus / exact[1], 1, 2)

    def test_noise(self) -> None:
        fits = fit_all(sample(TRELOAR, 0.02), ["Mooney-Rivlin", "Yeoh", "Ogden", "Arruda-Boyce"], 3, True)
        self.assertEqual(fits[0].law.name, "Ogden")
        self.assertTrue(0.01 < fits[0].error < 0.025)
        self.assertAlmostEqual(fits[0].law.shear_modulus() / TRELOAR.shear_modulus(), 1, 1)
        for mode, greatest in RANGES.items():
            stretches = numpy.linspace(1.2, greatest, 20)
            ratio = fits[0].law.stress(mode, stretches) / TRELOAR.stress(mode, stretches)
            self.assertLess(float(numpy.abs(ratio - 1).max()), 0.04, mode)

    def test_noisy_constants(self) -> None:
        law = laws.mooney_rivlin(0.293, 0.177)
        found = fit_all(sample(law, 0.02), ["Mooney-Rivlin"], 3, True)[0].law
        self.assertLess(abs(found.moduli[0] / law.moduli[0] - 1), 0.02)
        self.assertLess(abs(found.moduli[1] / law.moduli[1] - 1), 0.02)

    def test_weights(self) -> None:
        data = sample(TRELOAR)
        relative, absolute = (fit_all(data, ["Yeoh"], 3, kind)[0].law for kind in (True, False))
        at = numpy.array([7.0])
        exact = TRELOAR.stress("uniaxial", at)
        errors = [abs(float((law.stress("uniaxial", at) / exact)[0]) - 1) for law in (relative, absolute)]
        self.assertLess(errors[1], errors[0])


class Command(unittest.TestCase):
    """The program."""

    def setUp(self) -> None:
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.file = Path(self.folder.name) / "data.csv"

    def test_lines_are_a_scene(self) -> None:
        write(sample(TRELOAR, 0.01), self.file)
        code, out, _ = command(str(self.file), "--poisson", "0.4995")
        self.assertEqual(code, 0)
        self.assertGreater(self.file.with_suffix(".png").stat().st_size, 10000)
        materials = re.findall(r"(?m)(?:^set .*\n)+", out)
        self.assertEqual(len(materials), 4)
        for lines in materials:
            scene = Path(self.folder.name) / "cube.prm"
            scene.write_text(
                "subsection Bodies\nsubsection cube\nsubsection Mesh\nset Primitive = hyper_cube\nend\n"
                "set Symmetry planes = x = 0 ; y = 0 ; z = 0\n"
                f"subsection Material\n{lines}end\nend\nend\n"
                "subsection Time stepping\nset End time = 1\nend\n"
            )
            program = os.environ["BILLET"]
            checked = subprocess.run(
                [program, "--check", str(scene)], capture_output=True, text=True, cwd=self.folder.name
            )
            self.assertEqual(checked.returncode, 0, checked.stderr)

    def test_round_trip(self) -> None:
        data = sample(TRELOAR)
        write(data, self.file)
        read = read_data(self.file)
        self.assertEqual(list(read), list(data))
        for mode, points in data.items():
            self.assertLess(float(numpy.abs(read[mode].stretches - points.stretches).max()), 1e-12)

    def test_one_law(self) -> None:
        write({"uniaxial": sample(TRELOAR)["uniaxial"]}, self.file)
        picture = Path(self.folder.name) / "other.png"
        code, out, _ = command(str(self.file), "--law", "Yeoh", "--picture", str(picture))
        self.assertEqual((code, out.count("set Elasticity"), picture.exists()), (0, 1, True))

    def test_refusals(self) -> None:
        for text, part in (
            ("", "no rows"),
            ("uniaxial_stretch,uniaxial_force\n1,2\n", "unknown column 'uniaxial_force'"),
            ("uniaxial_stretch\n1\n", "not one stretch and one stress"),
            ("uniaxial_stretch,uniaxial_stress\n1.5,x\n", "row 1, uniaxial: 'x' is no number"),
            ("uniaxial_stretch,uniaxial_stress\n-1,2\n", "must be > 0"),
            ("uniaxial_stretch,uniaxial_stress\n1,0\n", "no points"),
            ("uniaxial_stretch;uniaxial_stress\n1,5;0,2\n", "its cells are separated by ';'"),
            ("uniaxial_stretch,uniaxial_stress\n1.5,0.2,7\n", "row 1 has more cells"),
            ("uniaxial_stretch,uniaxial_stress\n1.5,-0.2\n", "row 1, uniaxial: the stress -0.2 at"),
            ("uniaxial_stretch,uniaxial_stress\n1,0.05\n", "without stress the stretch is 1"),
        ):
            self.file.write_text(text)
            with self.assertRaises(UserError) as caught:
                read_data(self.file)
            self.assertIn(part, str(caught.exception))
        self.assertEqual(command(str(self.file))[0], 2)
        self.assertIn("--poisson", command(str(self.file), "--poisson", "0.5")[2])

    def test_help_without_packages(self) -> None:
        program = Path(__file__).resolve().parents[2] / "tools/billet-fit"
        cases: tuple[tuple[list[str], int, str], ...] = (
            (["--help"], 0, "Fits constants of laws of rubber"),
            ([], 2, "the following arguments are required: data"),
            (["data.csv", "--poisson", "0.5"], 2, "--poisson: a number > -1"),
        )
        for arguments, code, part in cases:
            said = [sys.executable, "-S", "-B", str(program), *arguments]  # -S: no packages
            done = subprocess.run(said, capture_output=True, text=True)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(part, done.stdout + done.stderr)
            self.assertNotIn("It wants numpy", done.stderr)


if __name__ == "__main__":
    unittest.main()
