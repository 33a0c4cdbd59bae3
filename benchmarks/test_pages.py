# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tests the computations of benchmarks, and their sentences on runs."""

from __future__ import annotations

import math
import re
import unittest
from pathlib import Path
from typing import Iterable, Sequence

from hand_set import beside_hand_set
from level_errors import by_levels
from precision_picture import Point as PrecisionPoint
from precision_picture import front_of, without_luck
from precision_references import Ring, beam_deflection, press_fit_force, pressurised_bore
from precision_scenes import difference, on_arc
from profile_runs import LEFT_OUT
from profile_words import (
    Point,
    above,
    beside_hand,
    cheapest,
    is_beaten,
    missed_by,
    on_front,
    reasons,
    with_looser,
    within_limits,
    without_errors,
)
from silent_errors_runs import OF_THE_MESH, Case, Kept, Reference, Runner, Sections, force_curve
from billet_tools.scene import scene_text

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent


class Counting(unittest.TestCase):
    def test_what_cannot_be_compared_is_not_counted(self) -> None:
        said = beside_hand_set([1.0, 1.5, 1.6, math.nan], [0.9, 2.0, 1.7, math.nan])
        self.assertIn("2 of 3 take at most 1.5 times the work", said)
        self.assertIn("1 of 3 take at most 1.5 times the CPU seconds", said)
        self.assertIn("For 1 no run by hand is within the target", said)
        self.assertNotIn("not counted", beside_hand_set([1.0], [2.0]))


class Levels(unittest.TestCase):
    def test_rules_of_the_program(self) -> None:
        """The rules are those of tests/output/body_levels.cc."""
        self.assertTrue(math.isnan(by_levels([], [0.1])))
        self.assertAlmostEqual(by_levels([0.03], [0.04, 0.01]), 0.01)  # of order 2
        self.assertAlmostEqual(by_levels([0.03], [0.4, 0.01]), 0.01)  # no higher one
        self.assertAlmostEqual(by_levels([0.03], [0.01, 0.02]), 0.03)  # of order 1
        self.assertAlmostEqual(by_levels([0.03], [0.0, 0.0]), 0.03)
        self.assertAlmostEqual(by_levels([0.12, 0.03], [1.0, 1.0, 1.0]), 0.0125)  # with safety
        self.assertAlmostEqual(by_levels([0.6, 0.03], [1.0, 1.0, 1.0]), 0.0125)
        self.assertEqual(by_levels([0.04, 0.03], [1.0, 1.0, 1.0]), 0.04)  # below order 1/2
        self.assertEqual(by_levels([0.02, 0.03], [1.0, 1.0, 1.0]), 0.03)
        self.assertEqual(by_levels([0.02, 0.0], [1.0, 1.0, 1.0]), 0.0)
        self.assertEqual(by_levels([0.0, 0.0], [1.0, 1.0, 1.0]), 0.0)


class Profiles(unittest.TestCase):
    POINTS = {
        "a": {"fast": Point(10, 0.06), "balanced": Point(20, 0.01), "accurate": Point(90, 0.003)},
        "b": {"fast": Point(10, 0.01), "balanced": Point(20, 0.01), "accurate": Point(80, 0.001)},
        "c": {"fast": Point(10, math.nan), "balanced": Point(20, 0.03), "accurate": Point(80, 0.001)},
    }

    def test_each_shipped_scene_is_named(self) -> None:
        """It is measured, or the page says why it is not."""
        page = (ROOT / "doc/results/profiles.md").read_text(encoding="utf-8")
        measured = set(re.findall(r"^\| (\w+)(?: \(cut\))? \| fast \|", page, re.MULTILINE))
        shipped = {path.stem for path in (ROOT / "prm").glob("*.prm")}
        self.assertEqual(sorted(shipped - measured), sorted(LEFT_OUT))
        for name, why in LEFT_OUT.items():
            self.assertIn(f"| {name} | {why} |", page)

    def test_limits(self) -> None:
        said = within_limits(self.POINTS)
        self.assertIn("| fast | 5 % | 1 of 2 | 6 % | a (6 %) |", said)
        self.assertIn("| balanced | 2 % | 2 of 3 | 1 % | c (3 %) |", said)
        self.assertIn("| accurate | 0.2 % | 2 of 3 | 0.1 % | a (0.3 %) |", said)

    def test_above(self) -> None:
        self.assertEqual(above({"a": 0.03, "b": 0.02, "c": math.nan}, 0.02), "a (3 %), c (–)")
        self.assertEqual(above({"b": 0.02}, 0.02), "none")

    def test_cheapest(self) -> None:
        hand = [Point(5, 0.1), Point(8, 0.02, "some"), Point(20, 0.001), Point(3, math.nan)]
        best = cheapest(hand, 0.0195)
        self.assertEqual(best and best.words, "some")
        self.assertIsNone(cheapest(hand, 1e-5))
        said = beside_hand(self.POINTS, {"a": hand, "b": hand, "c": []})
        self.assertIn("| fast | 2 of 2 | 0 | none |", said)
        self.assertIn("| accurate | 0 of 2 | 1 | a (4.5), b (4) |", said)

    def test_missed(self) -> None:
        hand = [Point(5, 0.1), Point(8, 0.02), Point(20, 0.001)]
        missed = missed_by(self.POINTS, {"a": hand, "b": hand, "c": []})
        self.assertEqual(missed["a"], ["fast: error", "accurate: error", "accurate: work"])
        self.assertEqual(missed["c"], ["balanced: error"])
        said = reasons(missed, {"a": "long steps"})
        self.assertIn("| a | fast: error, accurate: error, accurate: work | long steps |", said)
        self.assertIn("| c | balanced: error | not known |", said)
        self.assertEqual(reasons({}, {}), "")

    def test_front(self) -> None:
        self.assertTrue(is_beaten(Point(20, 0.01), [Point(10, 0.01)]))
        self.assertTrue(is_beaten(Point(10, 0.02), [Point(10, 0.01)]))
        self.assertFalse(is_beaten(Point(10, 0.01), [Point(10, 0.01), Point(20, 0.001), Point(5, 0.1)]))
        said = on_front(self.POINTS)
        self.assertIn("In 1 of 2 scenes whose errors are known", said)
        self.assertIn("- balanced is beaten in b.", said)
        self.assertNotIn("fast is beaten", said)

    def test_reasons(self) -> None:
        self.assertEqual(without_errors({}), "")
        self.assertIn("- `a`:\n\n  ```text\n  given up\n", without_errors({"a": "given up"}))
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
            PrecisionPoint("a", "b", 1, *p)
            for p in ((1, 0.1), (2, 0.2), (3, 0.01), (4, 0.001), (0.5, math.nan))
        ]
        self.assertEqual([p.seconds for p in front_of(points)], [1, 3, 4])
        self.assertEqual([p.seconds for p in front_of(points, 0.02)], [1, 3])

    def test_luck(self) -> None:
        """A coarse mesh that is better than a finer one of its setting counts no more than that."""
        runs = ((1, 0.1), (2, 0.01), (4, 0.05), (8, math.nan))
        points = [PrecisionPoint("a", "b", n, n, error) for n, error in runs] + [
            PrecisionPoint("a", "c", 1, 1, 0.001)
        ]
        self.assertEqual([p.error for p in without_luck(points)], [0.1, 0.05, 0.05, 0.001])

    def test_midpoints(self) -> None:
        middle = on_arc((10.0, 0.0, 1.0), (0.0, 10.0, 2.0))
        self.assertAlmostEqual(math.hypot(*middle[:2]), 10)
        self.assertAlmostEqual(middle[2], 1.5)


if __name__ == "__main__":
    unittest.main()
