# SPDX-License-Identifier: LGPL-2.1-or-later
"""What benchmarks compute and say of what they ran."""

from __future__ import annotations

import ast
import math
import sys
import unittest
from pathlib import Path
from typing import Iterable, Iterator, Sequence

from hand_set import beside_hand_set
from precision_picture import Point, front_of, without_luck
from precision_references import Ring, beam_deflection, press_fit_force, pressurised_bore
from precision_scenes import difference, on_arc
from profile_words import no_better, with_looser, without_errors
from silent_errors_runs import OF_THE_MESH, Case, Kept, Reference, Runner, Sections, force_curve
from billet_tools.scene import scene_text

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path.insert(0, str(HERE.parent))
import prose  # noqa: E402


def texts_of(script: Path) -> Iterator[str]:
    """Returns the strings of a script, with a word for each value that it puts in; not its docstrings."""

    def walk(node: ast.AST) -> Iterator[str]:
        if isinstance(node, ast.JoinedStr):
            yield "".join(part.value if isinstance(part, ast.Constant) else "X" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value
        elif not (isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)):
            for child in ast.iter_child_nodes(node):
                yield from walk(child)

    return walk(ast.parse(script.read_text(encoding="utf-8")))


class Sentences(unittest.TestCase):
    def test_what_scripts_write_is_short(self) -> None:
        """As tests/prose.py asks of pages: the next run of a script must not write longer sentences."""
        scripts = [*HERE.glob("*.py"), *(ROOT / "tests/extremes/extremes").glob("*.py")]
        scripts += (ROOT / "tools/billet_tools/trade").glob("*.py")
        for script in scripts:
            for text in texts_of(script):
                if "subsection" in text or "--" in text[:20]:  # scenes and commands
                    continue
                faults = [fault for fault in prose.faults_of(text) if "columns" not in fault.what]
                self.assertEqual(faults, [], script.name)

    def test_text_is_found(self) -> None:
        self.assertIn("one X two", list(texts_of(Path(__file__))))
        self.assertEqual(f"one {len('ab')} two", "one 2 two")


class Counting(unittest.TestCase):
    def test_what_cannot_be_compared_is_not_counted(self) -> None:
        said = beside_hand_set([1.0, 1.5, 1.6, math.nan], [0.9, 2.0, 1.7, math.nan])
        self.assertIn("2 of 3 take at most 1.5 times the work", said)
        self.assertIn("1 of 3 take at most 1.5 times the CPU seconds", said)
        self.assertIn("For 1 no run by hand is within the target", said)
        self.assertNotIn("not counted", beside_hand_set([1.0], [2.0]))


class Profiles(unittest.TestCase):
    def test_no_better(self) -> None:
        errors = {
            "a": {"fast": 0.02, "balanced": 0.019, "accurate": 0.001},
            "b": {"fast": 0.02, "balanced": 0.002, "accurate": 0.001},
            "c": {"fast": 0.01, "balanced": 0.01, "accurate": 0.009},
            "d": {"fast": math.nan, "balanced": 0.01, "accurate": 0.01},
        }
        self.assertIn("In 2 of 3 scenes whose errors are known", no_better(errors))
        self.assertIn("These are a, c.", no_better(errors))
        self.assertIn("In 1 of these accurate, which augments, has at most half", no_better(errors))
        self.assertEqual(no_better({"b": errors["b"]}), "")

    def test_reasons(self) -> None:
        self.assertEqual(without_errors({}), "")
        self.assertIn("| a | given up |", without_errors({"a": "given up"}))
        self.assertEqual(with_looser({}), "")
        self.assertIn("| a | 0.0001 |", with_looser({"a": 1e-4}))


class Told(Runner):
    """Runs by the text of their scenes: end forces at times 0.5 and 1, exit code, warnings."""

    def __init__(self, runs: Iterable[tuple[Sections, tuple[float, int | None, Sequence[str]]]]) -> None:
        self.runs = {scene_text(scene): what for scene, what in runs}

    def run(self, scene: Sections, seconds: int = 0) -> Kept:
        force, code, keys = self.runs[scene_text(scene)]
        history = {
            "time": [0.5, 1.0],
            "c.force_x": [0.0, 0.0],
            "c.force_y": [0.0, 0.0],
            "c.force_z": [0.5 * force, force],
        }
        return Kept(
            {
                "code": code,
                "stderr": "said" if code else "",
                "seconds": 1,
                "history": history,
                "bodies": {},
                "records": [{"key": key, "severity": "warning"} for key in keys],
            }
        )


class SilentErrors(unittest.TestCase):
    def outcome(
        self,
        force: float,
        code: int | None = 0,
        keys: Sequence[str] = (),
        first: float = 100.0,
        second: float = 100.0,
    ) -> str:
        scenes = [{"a": i} for i in range(3)]
        runner = Told(zip(scenes, [(force, code, keys), (first, 0, ()), (second, 0, ())]))
        reference = Reference(scenes[1], scenes[2], frozenset(OF_THE_MESH), force_curve(["c"]))
        return runner.outcome(Case("family", "name", scenes[0], (reference,)))[0]

    def test_outcomes(self) -> None:
        self.assertEqual(self.outcome(98), "right")
        self.assertEqual(self.outcome(90), "wrong")
        self.assertEqual(self.outcome(0), "wrong")
        self.assertEqual(self.outcome(90, keys=["penalty-too-low"]), "warned")
        # the reference has this element, too
        self.assertEqual(self.outcome(90, keys=["element-too-stiff"]), "wrong")
        self.assertEqual(self.outcome(90, first=106), "unclear")
        self.assertEqual(self.outcome(90, code=3), "stopped")
        self.assertEqual(self.outcome(90, code=None), "no end")
        self.assertEqual(self.outcome(90, code=-11), "crashed")

    def test_clock(self) -> None:
        """A run that touches at half of its time, beside a reference that touches at once."""
        run, reference = (Told([({}, what)]).run({}) for what in ((100.0, 0, ()), (100.0, 0, ())))
        self.assertAlmostEqual(force_curve(["c"])(run, reference), 0)
        self.assertAlmostEqual(force_curve(["c"], lambda time: 2 * time - 1)(run, reference), 0.5)
        self.assertAlmostEqual(force_curve(["c"], lambda time: 2 * time - 1)(run, reference, True), 0)


class Precision(unittest.TestCase):
    def test_beam(self) -> None:
        """A small force bends by F L³/(3 E I), shears by 6/5 F L/(G A); a large one as Mattiasson has it."""
        small = beam_deflection(100, 1, 1, 1e5, 1e-6)
        self.assertAlmostEqual(small / (1e-6 * (1e6 / 3 / (1e5 / 12) + 1.2 * 100 / 5e4)), 1, 8)
        # Mattiasson (1981), P L²/(E I) = 3: 0.60325 of the length without shear or strain.
        self.assertAlmostEqual(beam_deflection(100, 0.1, 1, 1e5, 2.5e-3) / 100, 0.60325, 5)

    def test_rings(self) -> None:
        """Lamé's displacement and pressure, and full plasticity beyond 2/√3 σ ln(b/a)."""
        a, b, young, poisson = 10.0, 20.0, 210e3, 0.3
        elastic = (1 + poisson) * a**2 / young / (b**2 - a**2) * ((1 - 2 * poisson) * a + b**2 / a)
        found = pressurised_bore(Ring(a, b, young, poisson), 1e-3, 50, 1)
        self.assertAlmostEqual(found / (1e-3 * elastic), 1, 4)
        lame = (
            2e5
            / 0.91
            * 1e-6
            / 20
            * (20**2 - 10**2)
            * (30**2 - 20**2)
            / (2 * 20**2 * (30**2 - 10**2))
        )
        fit = press_fit_force(Ring(10, 20 + 1e-6, 2e5, 0.3), Ring(20, 30, 2e5, 0.3), 50)
        self.assertAlmostEqual(fit / (20 * lame), 1, 4)
        mild = Ring(a, b, young, poisson, 240.0)
        self.assertLess(pressurised_bore(mild, 188, 50, 20), 0.05)
        with self.assertRaises(RuntimeError):
            pressurised_bore(mild, 196, 50, 20)

    def test_difference(self) -> None:
        self.assertAlmostEqual(difference([(0.5, 9.0), (1.0, 2.2)], [(1.0, 2.0)]), 0.1)
        self.assertAlmostEqual(difference([(0.5, 1.1), (1.0, 1.9)], [(0.25, 0.5), (1.0, 2.0)]), 0.1 / 1.5)

    def test_front(self) -> None:
        points = [
            Point("a", "b", 1, *p) for p in ((1, 0.1), (2, 0.2), (3, 0.01), (4, 0.001), (0.5, math.nan))
        ]
        self.assertEqual([p.seconds for p in front_of(points)], [1, 3, 4])
        self.assertEqual([p.seconds for p in front_of(points, 0.02)], [1, 3])

    def test_luck(self) -> None:
        """A coarse mesh that is better than a finer one of its setting counts no more than that."""
        runs = ((1, 0.1), (2, 0.01), (4, 0.05), (8, math.nan))
        points = [Point("a", "b", n, n, error) for n, error in runs] + [Point("a", "c", 1, 1, 0.001)]
        self.assertEqual([p.error for p in without_luck(points)], [0.1, 0.05, 0.05, 0.001])

    def test_midpoints(self) -> None:
        middle = on_arc((10.0, 0.0, 1.0), (0.0, 10.0, 2.0))
        self.assertAlmostEqual(math.hypot(*middle[:2]), 10)
        self.assertAlmostEqual(middle[2], 1.5)


if __name__ == "__main__":
    unittest.main()
