# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sources of error and their runs, bars that follow from them, budgets, and lines to paste."""

from __future__ import annotations

import math
import unittest
from pathlib import Path
from typing import Mapping, Sequence, cast

import numpy

import modules  # noqa: F401  finds the next ones
from billet_tools import UserError
from billet_tools.scene import Scene, entries
from billet_tools.trade import bars, cheapest, parameters, sources
from billet_tools.trade.budget import Budget
from billet_tools.trade.explain import in_order, is_shallower
from billet_tools.trade.explanation import Explanation
from billet_tools.trade.outputs import Output
from billet_tools.trade.paste import lines_to_paste
from billet_tools.trade.results import Result
from billet_tools.trade.sources import Given, Source, Variant

DEFAULTS = """subsection Bodies
  subsection (name of a body)
    set Element = assumed strain
    subsection Mesh
      set Source = primitive
      set Primitive = hyper_rectangle
      set Refinements = 0
      set Layers = 1
      set Section area = 0
      set Height = 1
    end
  end
end
subsection Contact pairs
  subsection (name of a contact pair)
    set Normal penalty =
    set Penetration tolerance =
  end
end
subsection Time stepping
  set Step control = automatic
end
subsection Solver
  set Force tolerance = 1e-6
end
"""
BAR = """subsection Bodies
  subsection bar
    subsection Mesh
      set Source = extruded primitive
      set Primitive = quarter_hyper_ball
      set Refinements = 1
      set Layers = 4
      set Height = 2
    end
  end
end
subsection Contact pairs
  subsection top
    set Normal penalty = 10
  end
end
"""


def checked(volume: float, smooth: float | None) -> Given:
    report = {"bodies": [{"name": "bar", "volume": volume, "smooth volume": smooth}]}
    return Given([0.25, 1.0], 0.02, {"report": report})


def by_name(scene: Scene, given: Given) -> dict[str, Source]:
    return {source.name: source for source in sources.sources_of(scene, given)}


def finer(source: Source) -> Mapping[str, object]:
    assert source.finer is not None
    return source.finer.changes


def deep(**depths: Sequence[float]) -> Result:
    """A run whose facets are two long, with depths at three times."""
    history = {f"{name}.deepest_penetration": numpy.array(values) for name, values in depths.items()}
    run = Result(Path(), {"facet": 2.0})
    run.history = {"time": numpy.array([0.25, 0.5, 1.0]), **history}
    return run


class TestSources(unittest.TestCase):
    def test_implicit(self) -> None:
        found = by_name(Scene(BAR, DEFAULTS), checked(3.0, 3.2))
        self.assertEqual(list(found), ["mesh", "geometry", "steps", "penetration", "iterations"])
        # All but the steps end where the scene's own do.
        for name, source in found.items():
            stops = "0.125, 0.25, 0.625" if name == "steps" else "0.25"
            self.assertEqual(finer(source)["Time stepping/Stops"], stops)
        self.assertEqual(float(str(finer(found["steps"])["Time stepping/Maximum step"])), 0.375)
        self.assertEqual(finer(found["mesh"])["Bodies/bar/Mesh/Layers"], 8)
        assert found["mesh"].coarser is not None
        self.assertEqual(found["mesh"].coarser.changes["Bodies/bar/Mesh/Refinements"], 0)
        self.assertEqual(finer(found["penetration"])["Contact pairs/top/Normal penalty"], "40")
        self.assertEqual(finer(found["iterations"])["Solver/Force tolerance"], "1e-08")
        # The area of the smooth section: its volume over its height.
        self.assertEqual(finer(found["geometry"])["Bodies/bar/Mesh/Section area"], "1.6")

    def test_augmented(self) -> None:
        scene = Scene(BAR, DEFAULTS).changed({"Contact pairs/top/Penetration tolerance": 0.1})
        changes = finer(by_name(scene, checked(3.0, 3.0))["penetration"])
        self.assertEqual(changes["Contact pairs/top/Penetration tolerance"], "0.005")  # of 0.02 that is left
        self.assertNotIn("Contact pairs/top/Normal penalty", changes)

    def test_tolerance_is_never_looser(self) -> None:
        """A deep penetration that is no contact's leaves the scene's tolerance. A small one leaves nothing to
        try."""
        path = "Contact pairs/top/Penetration tolerance"
        scene = Scene(BAR, DEFAULTS)
        for tolerance, tried in (("1e-5", "2.5e-06"), ("automatic", "0.005"), ("0.1", "0.005")):
            found = by_name(scene.changed({path: tolerance}), checked(3.0, 3.0))["penetration"]
            self.assertEqual(finer(found)[path], tried)
            unknown = by_name(scene.changed({path: tolerance}), Given())["penetration"]
            self.assertEqual(finer(unknown)[path], "2.5e-06" if tolerance == "1e-5" else "0.001")
        for tolerance, left in (("2e-6", 0.02), ("automatic", 1e-6), ("automatic", 0.0)):
            given = Given(penetration=left)
            found = by_name(scene.changed({path: tolerance}), given)["penetration"]
            self.assertEqual(found.variants, [])
            self.assertIn("too small to reduce", explained([found], Run(1.0)).bars[0].method)

    def test_automatic_augmentation(self) -> None:
        """Statics that sets no penalty augments by itself, which a penalty in the scene would end."""
        defaults = DEFAULTS.replace("set Normal penalty =\n", "set Normal penalty = 10\n")
        scene = Scene(BAR, defaults).changed({"Contact pairs/top/Normal penalty": None})
        self.assertEqual(scene.get("Contact pairs/top/Normal penalty"), "10")
        changes = finer(by_name(scene, Given(penetration=0.01))["penetration"])
        self.assertEqual(changes["Contact pairs/top/Penetration tolerance"], "0.0025")
        self.assertNotIn("Contact pairs/top/Normal penalty", changes)
        shallow = Given(penetration=0.01, depths={"pair top.deepest_penetration": 0.0009})
        self.assertEqual(by_name(scene, shallow)["penetration"].variants, [])
        stiffer = parameters.scaled_penalties(scene, 3.0)
        self.assertEqual(stiffer["Contact pairs/top/Penetration tolerance"], "automatic")
        self.assertEqual(stiffer["Contact pairs/top/Normal penalty"], "30")
        explicit = scene.changed({"Time stepping/Scheme": "explicit"})
        self.assertEqual(explicit.penetration_tolerance("Contact pairs/top/"), 0.0)

    def test_penetration_after_a_ramp(self) -> None:
        """The rest of an initial penetration during a ramp is not that of the contact."""
        ramp = {"Contact pairs/top/Initial penetration": "ramp", "Contact pairs/top/Ramp time": 0.5}
        self.assertEqual(sources.end_of_ramps(Scene(BAR, DEFAULTS)), 0.0)
        begin = sources.end_of_ramps(Scene(BAR, DEFAULTS).changed(ramp))
        self.assertEqual(begin, 0.5)
        base = deep(top=[0.4, 0.002, 0.004], side=[0.0, 0.0, 0.0])
        self.assertEqual(
            base.depths(begin), {"top.deepest_penetration": 0.002, "side.deepest_penetration": 0.0}
        )
        self.assertEqual(base.depths(2.0), {})
        for later, is_less in ((0.001, True), (0.004, False), (0.01, False)):
            self.assertEqual(is_shallower(deep(top=[0.4, later, 0.0]), base, begin), is_less)
        # One contact has less at the cost of another.
        two = deep(top=[0.0, 0.002, 0.004], side=[0.0, 0.1, 0.2])
        self.assertFalse(is_shallower(deep(top=[0.0, 0.001, 0.001], side=[0.0, 0.3, 0.3]), two, 0.0))
        self.assertTrue(is_shallower(deep(top=[0.0, 0.001, 0.001], side=[0.0, 0.1, 0.2]), two, 0.0))

    def test_steps_that_estimates_choose(self) -> None:
        scene = Scene(BAR, DEFAULTS).changed({"Target error": 0.01})
        self.assertEqual(list(sources.same_steps(scene, [0.25, 1.0])), ["Time stepping/Stops"])
        fixed = Scene(BAR, DEFAULTS).changed({"Time stepping/Step control": "fixed"})
        self.assertNotIn("Time stepping/Maximum step", sources.same_steps(fixed, [0.5, 1.0]))

    def test_geometry_that_cannot_be_told(self) -> None:
        given = by_name(
            Scene(BAR, DEFAULTS).changed({"Bodies/bar/Mesh/Source": "primitive"}), checked(3.0, 3.2)
        )
        self.assertEqual(given["geometry"].variants, [])
        self.assertIn("make 'bar' 6.2 % too small", given["geometry"].remarks[0])
        area = Scene(BAR, DEFAULTS).changed({"Bodies/bar/Mesh/Section area": 3})
        self.assertIn("has the volume of the smooth", by_name(area, checked(3.0, 3.0))["geometry"].remarks[0])
        self.assertNotIn("geometry", by_name(Scene(BAR, DEFAULTS), checked(3.0, None)))

    def test_section_that_grows_into_its_neighbour(self) -> None:
        def report(*gaps: float) -> dict[str, sources.Any]:
            pairs = [{"name": f"pair {i}", "gap": {"least": gap}} for i, gap in enumerate(gaps)]
            bodies = [{"low": [0, 0, 0], "high": [1, 1, 5]}]
            return {"report": {"pairs": [*pairs, {"name": "self"}], "bodies": bodies}}

        self.assertEqual(sources.moved_pair(report(0.0, 0.2), report(0.0, 0.1)), "pair 1")
        self.assertEqual(sources.moved_pair(report(0.0, 0.2), report(1e-7, 0.2)), "")
        self.assertEqual(sources.moved_pair({}, {}), "")

    def test_explicit(self) -> None:
        scene = Scene(BAR, DEFAULTS).changed(
            {
                "Time stepping/Scheme": "explicit",
                "Explicit dynamics/Safety factor": 0.8,
                "Explicit dynamics/Number type": "float",
                "Explicit dynamics/Mass scaling step": 1e-6,
                "Bodies/bar/Element": "one point",
                "Bodies/bar/Material/Elasticity": "hypoelastic",
            }
        )
        found = by_name(scene, checked(3.0, None))
        self.assertEqual(
            list(found), ["mesh", "steps", "penetration", "elements", "law", "numbers", "added mass"]
        )
        self.assertEqual(finer(found["steps"]), {"Explicit dynamics/Safety factor": "0.4"})
        self.assertEqual(finer(found["numbers"]), {"Explicit dynamics/Number type": "double"})
        self.assertTrue(found["elements"].is_of_mesh)
        self.assertTrue(math.isinf(found["elements"].ratio))

    def test_order_of_runs(self) -> None:
        """The runs that tell most for their cost come first."""
        variants = [(Source("a", None, weight=w), Variant("", {}, {})) for w in (8.0, 3.0, 1.0)]
        self.assertEqual(in_order(variants, [16.0, 1.0, 1.0]), [1, 2, 0])
        self.assertEqual(in_order(variants, [1.0, 1.0, 1.0]), [0, 1, 2])


class Number(Output):
    """The force of a run that is a number."""

    name, meaning = "force", "its size"

    def values(self, result: Result) -> sources.Any:
        return cast(sources.Any, result).force

    def norm(self, values: sources.Any) -> float:
        return abs(float(values))


class Run:
    def __init__(self, force: float, seconds: float = 1.0, **estimates: float) -> None:
        self.force, self.core_seconds, self.estimates = force, seconds, estimates


class Shape(Number):
    name = "shape"


def explained(found: list[Source], base: Run, **runs: Run) -> Explanation:
    results = {name.replace("_", " "): cast(Result, run) for name, run in runs.items()}
    missing = {"missing": "beyond the budget"}
    scene = Scene(BAR, DEFAULTS)
    return Explanation(scene, cast(Result, base), [Number()], {"force": 1.0}, found, results, missing)


def variant(label: str) -> Variant:
    return Variant(label, {"Solver/" + label: 1}, {"Solver/" + label: 1})


class TestBars(unittest.TestCase):
    def test_bars(self) -> None:
        """The mesh is off by 16 % of 1/h², the steps the other way round."""
        found = [
            Source("steps", variant("half")),
            Source("mesh", variant("fine"), variant("coarse")),
            Source("law", variant("missing")),
            Source("numbers", variant("double"), ratio=math.inf),
        ]
        whole = explained(
            found,
            Run(1.0, mesh=0.1),
            half=Run(1.04, 2.0),
            fine=Run(0.88, 10.0),
            coarse=Run(1.48),
            double=Run(0.99, 3.0),
        )
        told = {bar.source.name: bar for bar in whole.bars}
        self.assertEqual([bar.source.name for bar in whole.bars], ["mesh", "steps", "numbers", "law"])
        mesh = told["mesh"]
        self.assertAlmostEqual(mesh.order or 0.0, 2.0)
        self.assertAlmostEqual(mesh.error, 0.16)
        self.assertAlmostEqual(mesh.left or 0.0, 0.04)
        self.assertAlmostEqual(mesh.high, 0.17)
        self.assertAlmostEqual(mesh.price, 10.0)
        self.assertAlmostEqual(told["steps"].error, 0.08)  # order 1
        self.assertAlmostEqual(told["steps"].low, 0.04 * 4 / 3)
        self.assertAlmostEqual(told["steps"].high, 0.04 / (1 - math.sqrt(0.5)))
        self.assertAlmostEqual(told["numbers"].error, 0.01)
        self.assertEqual(told["law"].why, "missing: beyond the budget")
        self.assertAlmostEqual(whole.sum, 0.25)
        self.assertAlmostEqual(whole.signed_sum, 0.09)
        words = " ".join(whole.words())
        for part in (
            "about 25 % off in force",
            "It is 9 % off with their signs",
            "The largest source is mesh, 16 %",
            "takes 10 times the scene's seconds; it leaves 4 %",
            "The cheapest gain: a run with 'half'",
            "for want of a run: law",
            "10 % for mesh",
        ):
            self.assertIn(part, words)
        self.assertEqual(len(str(whole.rows()[0][1])), 30)
        self.assertEqual(len(str(whole.rows()[1][1])), 15)
        self.assertIn("set fine = 1", whole.lines()[0][1])
        self.assertEqual(len(bars.picture_of(whole, "").axes[0].get_yticks()), 4)  # with the sum

    def test_ranges_that_overlap(self) -> None:
        found = [Source("a", variant("half")), Source("b", variant("fine"))]
        overlap = explained(found, Run(1.0), half=Run(1.04), fine=Run(1.035))
        self.assertIn("Its range overlaps that of b", " ".join(overlap.words()))
        clear = explained(found, Run(1.0), half=Run(1.04), fine=Run(1.001))
        self.assertNotIn("overlaps", " ".join(clear.words()))

    def test_large_difference(self) -> None:
        found = [Source("mesh", variant("fine")), Source("geometry", variant("missing"))]
        words = " ".join(explained(found, Run(1.0), fine=Run(1.3)).words())
        self.assertIn("A difference of 60 % is too large to extrapolate", words)
        self.assertNotIn("for want of a run", words)  # the geometry is in the mesh's bar
        self.assertNotIn("too large", " ".join(explained(found, Run(1.0), fine=Run(1.2)).words()))
        # The output that may be known better differs from the one in use.
        self.assertIn("Other --outputs, such as shape, may be known better", words)
        runs = {"fine": cast(Result, Run(1.3))}
        shape = Explanation(
            Scene(BAR, DEFAULTS), cast(Result, Run(1.0)), [Shape()], {"shape": 1.0}, found, runs, {}
        )
        self.assertIn("A finer scene (--mesh 2), explained again, may be known", " ".join(shape.words()))

    def test_no_convergence(self) -> None:
        bar = explained(
            [Source("mesh", variant("fine"), variant("coarse"))], Run(1.0), fine=Run(1.1), coarse=Run(0.95)
        ).bars[0]
        self.assertEqual((bar.left, bar.high), (None, math.inf))
        self.assertAlmostEqual(bar.error, 0.1)
        self.assertIn("no convergence", bar.method)

    def test_geometry_is_not_the_meshs(self) -> None:
        found = [
            Source("mesh", variant("fine"), variant("coarse")),
            Source("geometry", variant("area"), ratio=math.inf),
        ]
        runs = {"fine": Run(0.88), "coarse": Run(1.48)}
        told = {b.source.name: b for b in explained(found, Run(1.0), area=Run(0.9), **runs).bars}
        self.assertAlmostEqual(told["geometry"].error, 0.1)
        self.assertAlmostEqual(told["mesh"].error, 0.06)
        told = {b.source.name: b for b in explained(found, Run(1.0), **runs).bars}
        self.assertAlmostEqual(told["mesh"].error, 0.16)

    def test_elements_are_of_the_mesh(self) -> None:
        found = [
            Source("mesh", variant("fine")),
            Source("elements", variant("strain"), ratio=math.inf, is_of_mesh=True),
        ]
        whole = explained(found, Run(1.0), fine=Run(1.05), strain=Run(1.03))
        self.assertAlmostEqual(whole.sum, 0.1)
        self.assertEqual(whole.rows()[1][0], "elements (part of the mesh's)")


class TestCheapest(unittest.TestCase):
    """Steps that are cheap to halve, and a mesh that is not."""

    def whole(self, **more: Run) -> Explanation:
        scene = Scene(BAR, DEFAULTS)
        given = Given([0.25, 0.5, 1.0])
        mesh, steps = sources.mesh_source(scene), sources.step_source(scene, given)
        runs = {
            "mesh, one level finer": Run(1.03, 10.0),
            "mesh, one level coarser": Run(0.88),
            "steps of half the length": Run(1.04, 1.5),
        }
        results = {label: cast(Result, run) for label, run in {**runs, **more}.items()}
        return Explanation(
            scene, cast(Result, Run(1.0)), [Number()], {"force": 1.0}, [mesh, steps], results, {}
        )

    def test_prediction(self) -> None:
        """Errors of 4 % and 8 %; halved steps leave 4 %, a level of the mesh 1 %."""
        given = Given([0.25, 0.5, 1.0])
        whole = self.whole()
        self.assertAlmostEqual(whole.sum, 0.12)
        for target, error, price, largest in ((0.061, 0.06, 2.25, "0.125"), (0.13, 0.12, 1.0, None)):
            found = cheapest.predict(whole, given, target)
            assert found is not None
            self.assertAlmostEqual(found.predicted, error)
            self.assertAlmostEqual(found.price, price)
            self.assertEqual(found.changes.get("Time stepping/Maximum step"), largest)
        both = cheapest.predict(whole, given, 0.04)
        assert both is not None
        self.assertEqual(both.changes["Bodies/bar/Mesh/Refinements"], 2)
        self.assertIn("steps of half the length (2 times so)", both.label)
        self.assertIsNone(cheapest.predict(whole, given, 0.001))

    def test_choice(self) -> None:
        """The limit is 1.12, known to the ranges of both."""
        whole = self.whole()
        good, dear = cheapest.Candidate("good", {"A": 1}), cheapest.Candidate("dear", {"A": 2})
        late = cheapest.Candidate("late", {"A": 3})
        runs = {"good": cast(Result, Run(1.10, 3.0)), "dear": cast(Result, Run(1.12, 5.0))}

        def choose(target: float) -> cheapest.Cheapest:
            return cheapest.Cheapest(whole, [good, dear, late], runs, {"late": "beyond the budget"}, target)

        self.assertAlmostEqual(choose(0.2).uncertainty, 0.0025 + 0.04 * (1 / (1 - math.sqrt(0.5)) - 2))
        self.assertIs(choose(0.09).chosen, good)
        self.assertTrue(choose(0.09).is_shown)
        self.assertIn("cheapest that was tried is good**: 2 % off, 3 times", choose(0.09).words())
        self.assertIs(choose(0.01).chosen, dear)
        self.assertFalse(choose(0.01).is_shown)
        self.assertIn("Nothing is shown to be within 1 %", choose(0.01).words())
        self.assertEqual(choose(0.01).lines(), "set A = 2\n")
        self.assertEqual(choose(0.2).lines(), "")  # the scene as it is
        self.assertEqual(choose(0.2).rows()[-1][2], "beyond the budget")

    def test_predicted_run_that_is_off(self) -> None:
        """It is neither left out where another one is within the target, nor where none is."""
        predicted = cheapest.Candidate("by the bars: fine", {"A": 1}, predicted=0.01)
        good = cheapest.Candidate("good", {"A": 2})
        runs = {"by the bars: fine": cast(Result, Run(1.09, 4.0)), "good": cast(Result, Run(1.119, 5.0))}

        def words(*candidates: cheapest.Candidate) -> str:
            return cheapest.Cheapest(self.whole(), candidates, runs, {}, 0.02).words()

        surprise = (
            "The bars predict 1 % for 'by the bars: fine'. It is 3 % off: their limit may be wrong by 2 %."
        )
        self.assertIn(surprise, words(predicted, good))
        self.assertNotIn("The best", words(predicted, good))
        alone = words(predicted)
        self.assertIn("Nothing tried is within 2 %", alone)
        best = "The best that was tried is by the bars: fine. It is 3 % off, at 4 times the scene's cost."
        self.assertIn(f"{best} {surprise}", alone)
        self.assertNotIn("wrong by", words(good))
        self.assertIn("The best that was tried is the scene as it is. It is 12 % off", words())


class TestBudget(unittest.TestCase):
    def test_units(self) -> None:
        for text, seconds in (("20 minutes", 1200), ("90 s", 90), ("1.5 h", 5400), ("1min", 60)):
            self.assertEqual(Budget(text).seconds, seconds)
        for text in ("soon", "20", "0 s", "2.5 runs", "0 runs", "-3 s", "3 days"):
            with self.assertRaisesRegex(UserError, f"--budget is '{text}'"):
                Budget(text)

    def test_runs(self) -> None:
        budget = Budget("3 runs")
        self.assertEqual([budget.take(1e9, 2), budget.take(1.0, 2), budget.take(1.0)], [True, False, True])
        self.assertFalse(budget.take(0.0))

    def test_seconds(self) -> None:
        budget = Budget("100 s")
        self.assertEqual([budget.take(101.0), budget.take(90.0, 50)], [False, True])
        self.assertTrue(Budget().take(1e12, 1000))


class TestPaste(unittest.TestCase):
    def test_lines(self) -> None:
        scene = Scene(BAR + "set Profile = fast\n", DEFAULTS)
        changes = {
            "Bodies/bar/Mesh/Layers": 8,
            "Bodies/bar/Mesh/Refinements": 1,  # as it is
            "Solver/Force tolerance": "1e-8",
            "Profile": None,
            "Target error": None,  # it has none
        }
        text = lines_to_paste(changes, scene)
        self.assertTrue(text.startswith("# remove 'Profile' from the scene\n"))
        self.assertEqual(entries(text), {"Bodies/bar/Mesh/Layers": "8", "Solver/Force tolerance": "1e-8"})
        self.assertIn("set Layers = 8  # in place of 4\n", text)
        self.assertIn("set Force tolerance = 1e-8\n", text)
        both = entries(scene.text + text)
        self.assertEqual((both["Bodies/bar/Mesh/Layers"], both["Bodies/bar/Mesh/Height"]), ("8", "2"))
        self.assertEqual(lines_to_paste({"Bodies/bar/Mesh/Layers": 4}, scene), "")


unittest.main()
