# SPDX-License-Identifier: LGPL-2.1-or-later
"""Tests how runs are judged and ranked, the sentences on them, and the picture, on made-up points."""

from __future__ import annotations

import math
import unittest
from typing import Any, Mapping, Sequence, cast

import modules  # noqa: F401  finds the next one
from billet_tools.trade import picture, reference as reference_module, report, results
from billet_tools.trade.outputs import Output
from billet_tools.trade.reference import mesh_of
from billet_tools.scene import Changes, Scene
from billet_tools.text import first_sentence, quoted, shortened, wrapped

DEFAULTS = "subsection Bodies\nsubsection (name of a body)\nsubsection Mesh\nset Layers = 4\nend\nend\nend\n"
SCENE = Scene("subsection Bodies\nsubsection bar\nsubsection Mesh\nset Layers = 4\nend\nend\nend\n", DEFAULTS)


class Result:
    """`force`: as part of the reference's."""

    coarser_work = 0.0

    def __init__(
        self,
        force: float = 1.0,
        elements: int = 4,
        seconds: float = 1.0,
        status: str = "ok",
        penetration: float = 0.01,
        drift: float = 0.0,
        reason: str = "",
        steps: int = 10,
    ) -> None:
        self.force, self.elements, self.core_seconds, self.seconds = (
            force,
            elements,
            seconds,
            [seconds, seconds],
        )
        self.status, self.reason, self.penetration, self.drift = status, reason, penetration, drift
        self.steps, self.newton = steps, 10
        self.linear = self.cuts = 0


class Force:
    name, meaning = "force", "a part"

    def error(self, result: Result, reference: float) -> float:
        return abs(result.force - reference)

    def excess(self, result: Result, reference: float) -> float:
        return result.force / reference - 1


class Shape:
    """Right whatever the forces are."""

    name, meaning = "shape", "always the same"

    def error(self, result: Result, reference: float) -> float:
        return 0.02


class Reference:
    """`meshes`: {layers: error of that mesh alone}."""

    def __init__(
        self, uncertainty: float = 0.01, meshes: Mapping[str, float] | None = None, output: str = "force"
    ) -> None:
        self.values, self.uncertainty = {output: 1.0}, {output: uncertainty}
        self.meshes = meshes or {}
        self.rows = [["force", "mesh", "", [], None, None, uncertainty]]
        self.remarks: list[str] = []

    def mesh_alone(self, scene: Scene) -> dict[str, float] | None:
        error = self.meshes.get(scene.get("Bodies/bar/Mesh/Layers"))
        return None if error is None else {"force": error}

    def uncertainty_by_axis(self) -> list[tuple[str, str, float]]:
        return [("force", "mesh", self.uncertainty["force"])]


def point(curve: str, value: str, changes: Changes | None = None, **result: Any) -> report.Point:
    changes = changes or {}
    made = report.Point(curve, value, changes, SCENE.changed(changes), is_base=not curve)
    made.result = cast(results.Result, Result(**result))
    return made


def judge(
    p: report.Point,
    output: Force | Shape,
    reference: Reference,
    forces: tuple[Force, Reference] | None = None,
) -> None:
    report.judge(
        p,
        cast("list[Output]", [output]),
        {output.name: 1.0},
        cast(reference_module.Reference, reference),
        SCENE,
        report.Limits(),
        cast(report.Forces, forces),
    )


def layers(n: int, **more: str) -> dict[str, str]:
    return {"Bodies/bar/Mesh/Layers": str(n), **more}


def sweep(
    points: Sequence[report.Point],
    reference: Reference,
    target: float | None = None,
    output: Force | Shape = Force(),
    forces: Reference | None = None,
) -> report.Sweep:
    """`forces`: the reference that knows them where they are not the output."""
    for p in points:
        p.work = p.result.elements * 10.0
        judging = (Force(), forces or reference) if forces or output.name == "force" else None
        judge(p, output, reference, judging)
    return report.Sweep(
        points,
        cast(reference_module.Reference, reference),
        cast("list[Output]", [output]),
        {output.name: 1.0},
        SCENE,
        "work",
        target,
    )


class Judging(unittest.TestCase):
    def test_marks(self) -> None:
        points = [
            point("", "as written"),
            point("penalty", "0.001", force=0.05, elements=1, penetration=0.098),
            point("penalty", "0.1", force=0.79, elements=1),
            point("penalty", "0.2", force=0.81, elements=2),
            point("element", "mean dilatation", force=1.21),
            point("element", "other", force=1.19),
            point("penalty", "0.01", force=1.0, penetration=0.6),
        ]
        s = sweep(points, Reference())
        self.assertEqual([p.status for p in points], ["ok", "soft", "soft", "ok", "locked", "ok", "pierced"])
        self.assertEqual(
            points[1].reason,
            "forces are 95 % too small in the mean, nodes 0.098 facets deep; the error is 95 %",
        )
        self.assertTrue(math.isnan(points[1].error))
        # The cheapest of all are on no front.
        self.assertEqual([p.value for p in s.front], ["0.2", "as written"])
        self.assertIn("`penalty = 0.001` soft (forces are 95 % too small", " ".join(s.words()))
        shape = Force()
        shape.name = "shape"
        other = point("mass scaling", "8", force=1.51)
        reference = Reference()
        reference.values["shape"] = 1.0
        reference.uncertainty["shape"] = 0.01
        judge(other, shape, reference)
        self.assertEqual(other.status, "useless")

    def by_shape(
        self, forces: Reference | None, *ratios: float, known: float = 0.01
    ) -> tuple[report.Sweep, list[str]]:
        points = [point("", "as written", elements=8)] + [
            point("element", str(r), force=r, elements=4) for r in ratios
        ]
        s = sweep(points, Reference(known, output="shape"), 0.05, Shape(), forces)
        return s, [p.status for p in points[1:]]

    def test_forces_judge_where_they_are_no_output(self) -> None:
        s, found = self.by_shape(Reference(0.01), 2.39, 0.7, 1.1)
        self.assertEqual(found, ["locked", "soft", "ok"])
        self.assertTrue(math.isnan(s.points[1].error))
        self.assertEqual([p.value for p in s.front], ["1.1"])
        self.assertEqual(s.chosen and s.chosen.value, "1.1")
        self.assertIn("`element = 2.39` locked (forces are 139 % too large in the mean)", " ".join(s.words()))
        # Nor do they choose: without them the error of the shape is all there is.
        self.assertEqual(self.by_shape(None, 2.39, 0.7)[1], ["ok", "ok"])

    def test_forces_that_are_not_known_well(self) -> None:
        for uncertainty, expected in (
            (0.33, ["locked", "ok", "ok", "soft"]),
            (0.6, ["locked", "ok", "ok", "ok"]),
            (1.2, ["ok"] * 4),
            (math.nan, ["ok"] * 4),
        ):
            with self.subTest(uncertainty):
                self.assertEqual(self.by_shape(Reference(uncertainty), 2.39, 1.3, 0.7, 0.5)[1], expected)
        # They are marked, too, where of the outputs nothing is known.
        s, found = self.by_shape(Reference(0.1), 2.39, known=0.8)
        self.assertEqual((found, s.is_blind), (["locked"], True))
        self.assertEqual(self.by_shape(Reference(0.6), 2.39, known=0.8)[1], ["ok"])

    def test_reference_that_is_not_known(self) -> None:
        points = [point("", "as written", force=2.0), point("penalty", "10", force=0.3)]
        s = sweep(points, Reference(0.8), 0.05)
        self.assertEqual([p.status for p in points], ["ok", "ok"])
        self.assertEqual((s.front, s.chosen), ([], None))
        said = " ".join(s.words())
        self.assertIn("The reference is known to 80 % only", said)
        self.assertIn("--reference-mesh 1,2,4", said)
        self.assertNotIn("as it is written", said)
        self.assertIn("No choice within 5 %", said)
        self.assertNotIn("What each parameter buys", s.page("", "", [], ""))
        # Nor does one that nothing is known of.
        self.assertTrue(sweep([point("", "as written")], Reference(math.nan)).is_blind)

    def test_reasons_are_whole_sentences(self) -> None:
        reason = (
            "scene.prm: the step from time 0 to 1e-06 failed after 0 accepted steps and 18 cuts: given up"
            " after 20 iterations, since at their pace 60 will not do; the largest residual is in body"
            " 'blank' at (38.4833, 46.7199, -2.4e-10). The step cannot be cut below 'Minimum step' = 1e-06:"
            " try a softer penalty"
        )
        self.assertEqual(first_sentence(reason), reason[: reason.index(". The step")])
        self.assertEqual(first_sentence(""), "")
        self.assertEqual(first_sentence("inside out."), "inside out")
        self.assertLessEqual(len(first_sentence("much " * 200)), 400)

    def test_cells_are_short(self) -> None:
        self.assertEqual(shortened("one two, three"), "one two, three")
        self.assertEqual(shortened("one two, three", 2), "one two ...")
        self.assertEqual(shortened("one two three, four five", 4), "one two three ...")
        self.assertEqual(len(shortened("much " * 200).split()), 25)

    def test_messages_are_quoted(self) -> None:
        page = quoted([("one scene", "word " * 40), ("two scenes", "said")])
        self.assertLessEqual(max(map(len, page.splitlines())), 100)
        self.assertIn("- two scenes:\n\n  ```text\n  said\n  ```", page)
        self.assertEqual(wrapped(page), page)

    def test_lines_end_in_time(self) -> None:
        self.assertEqual(wrapped("one two\nthree", 9), "one two\nthree")
        self.assertEqual(wrapped("one\ntwo three", 9), "one two\nthree")
        self.assertEqual(wrapped("- one two\n- three four\n", 8), "- one\n  two\n- three\n  four\n")
        # no mark at the start of a line, no break within code, links and formulas
        self.assertEqual(wrapped("three - two 5. `a b`", 7), "three -\ntwo 5.\n`a b`")
        self.assertEqual(wrapped("see [the page](x) now", 8), "see\n[the page](x)\nnow")
        for text in ("# one two three", "| one | two |", "```\none two three\n```", "$$\na b c d e f\n$$"):
            self.assertEqual(wrapped(text, 5), text)


class Cancellation(unittest.TestCase):
    def points(self) -> list[report.Point]:
        # The mesh takes 3 % away, long steps add 2.5 %: together they seem to be right.
        return [
            point("", "as written", force=1.025, elements=8),
            point("mesh", "0.5", layers(2), force=0.995, elements=2),
            point("steps", "80", {"Time stepping/Maximum step": "0.01"}, force=1.004, elements=16),
            point(
                "mesh 0.5 × steps",
                "80",
                layers(2, **{"Time stepping/Maximum step": "0.01"}),
                force=0.97,
                elements=3,
            ),
        ]

    def test_finer_mesh_with_all_else_the_same(self) -> None:
        points = self.points()
        s = sweep(points, Reference(0.01), 0.02)
        self.assertEqual(list(s.cancelled), [id(points[1])])
        self.assertAlmostEqual(s.ranked(points[1]), 0.025)
        self.assertIs(s.chosen, points[2])
        said = " ".join(s.words())
        self.assertIn(
            (
                "Not to be relied on, since errors of opposite sign cancel: `mesh = 0.5`, off"
                " by < 1 % where 2.5 % would be expected, that of `as written`"
            ),
            said,
        )
        self.assertIn("errors cancel", s.page("", "", [], ""))
        self.assertIn("Most accuracy is bought by `steps = 80`", said)

    def test_what_an_uncertain_reference_cannot_tell(self) -> None:
        # A coarser mesh that seems better by less than is known; a gain that is less than is known; one that
        # is more.
        points = [
            point("", "as written", force=1.018, elements=8),
            point("mesh", "0.5", layers(2), force=1.011, elements=2),
        ]
        said = " ".join(sweep(points, Reference(0.01), 0.03).words())
        self.assertIn("(a gain below the reference's uncertainty)", said)
        # of what buys most, and of what is chosen
        self.assertEqual(said.count("That mesh is coarser than the scene's"), 2)
        points = [
            point("", "as written", force=1.04, elements=8),
            point("steps", "80", {"Time stepping/Maximum step": "0.01"}, force=1.02, elements=8),
        ]
        said = " ".join(sweep(points, Reference(0.01)).words())
        self.assertIn("Most accuracy is bought by `steps = 80`", said)
        self.assertNotIn("a gain below", said)
        self.assertNotIn("coarser", said)

    def test_mesh_alone(self) -> None:
        points = self.points()
        s = sweep(points, Reference(0.01, {"2": 0.035}), 0.02)
        self.assertAlmostEqual(s.ranked(points[1]), 0.035)
        self.assertIn("3.5 % would be expected, which its mesh alone makes", " ".join(s.words()))

    def test_shorter_steps_on_the_same_mesh(self) -> None:
        def steps(n: int, **changes: str) -> dict[str, str]:
            return {"Time stepping/Maximum step": str(1 / n), **changes}

        # As of the billet: 60 bricks get worse with each refinement of the steps, by less than the reference
        # is uncertain.
        points = [
            point("", "as written", force=1.014, elements=480, steps=15),
            point("steps", "40", steps(40), force=1.0099, elements=480, steps=40),
            point("steps", "80", steps(80), force=1.01025, elements=480, steps=80),
            point("mesh", "0.5", layers(2), force=0.9899, elements=60, steps=14),
            *(
                point("mesh 0.5 × steps", str(n), steps(n, **layers(2)), force=f, elements=60, steps=n)
                for n, f in ((10, 0.9907), (20, 0.9882), (40, 0.9874))
            ),
        ]
        s = sweep(points, Reference(0.0101), 0.0215)
        self.assertEqual(list(s.cancelled), [id(points[3]), id(points[4])])
        self.assertAlmostEqual(s.ranked(points[4]), 0.0126)
        self.assertIs(s.chosen, points[1])
        said = " ".join(s.words())
        self.assertIn("Most accuracy is bought by `steps = 40`", said)
        self.assertIn(
            (
                "`mesh 0.5 × steps = 10`, off by < 1 % where 1.3 % would be expected, that of `mesh 0.5 ×"
                " steps = 40`, in shorter steps"
            ),
            said,
        )
        self.assertIn("| (< 1 %) |", s.page("", "", [], ""))
        # Within a target that leaves room for the larger error, too, what does not cancel is preferred at the
        # same cost.
        s = sweep(points, Reference(0.0101), 0.03)
        self.assertIs(s.chosen, points[5])
        s = sweep(points[:5] + points[6:], Reference(0.0101), 0.03)
        self.assertIs(s.chosen, points[6])
        # A cheaper one counts with the larger error.
        points[4].result.elements = 59
        s = sweep(points, Reference(0.0101), 0.03)
        self.assertIn("the cheapest is `mesh 0.5 × steps = 10`: error 1.3 %", s.choice(0.03))
        self.assertNotIn("coarser", s.choice(0.03))
        # Other scenes, steps that are hardly shorter, and errors that come and go tell nothing.
        for others in (
            [point("penalty", "0.1", steps(80, Penalty="0.1"), force=1.03, steps=80)],
            [point("steps", "50", steps(50), force=1.0125, steps=50)],
            [
                point("steps", "60", steps(60), force=1.02, steps=60),
                point("steps", "90", steps(90), force=1.0101, steps=90),
            ],
        ):
            self.assertEqual(sweep(points[:2] + others, Reference(0.0101)).cancelled, {})

    def test_within_the_uncertainty_nothing_is_told(self) -> None:
        self.assertEqual(sweep(self.points(), Reference(0.03, {"2": 0.035})).cancelled, {})


class Meshes(unittest.TestCase):
    def test_other_elements_make_other_errors(self) -> None:
        defaults = (
            "subsection Bodies\nsubsection (name of a body)\nset Element = assumed strain\nsubsection"
            " Mesh\nset Layers = 4\nset Arguments =\nend\nend\nend\n"
        )

        def scene(*lines: str) -> Scene:
            return Scene(
                "subsection Bodies\nsubsection bar\n" + "".join(line + "\n" for line in lines) + "end\nend\n",
                defaults,
            )

        mesh = ("subsection Mesh", "set Layers = 4", "set Arguments = 1, 2 : 3", "end")
        self.assertEqual(
            mesh_of(scene(*mesh)),
            mesh_of(scene("set Element = assumed strain", "subsection Mesh", "set Arguments = 1,2:3", "end")),
        )
        self.assertNotEqual(mesh_of(scene(*mesh)), mesh_of(scene("set Element = one point", *mesh)))
        self.assertNotEqual(
            mesh_of(scene(*mesh)), mesh_of(scene("subsection Mesh", "set Arguments = 1, 3 : 3", "end"))
        )


class Pictures(unittest.TestCase):
    def test_legend_is_whole(self) -> None:
        points = Cancellation().points() + [
            point(
                "a parameter of one's own with a very long name that wants lines",
                v,
                {"Solver/X": v},
                force=1.003,
            )
            for v in "123"
        ]
        for p in points[4:]:
            p.result.elements = 1
        figure = picture.picture_of(sweep(points, Reference(0.01), 0.05), "Title")
        figure.canvas.draw()
        legend, frame = figure.legends[0].get_window_extent(), figure.bbox
        self.assertLessEqual(legend.x1, frame.x1)
        self.assertGreaterEqual(legend.y0, 0)
        for axes in figure.axes:
            self.assertLessEqual(axes.get_tightbbox(figure.canvas.get_renderer()).x1, legend.x0 + 1)
        picture.pyplot.close(figure)


unittest.main()
