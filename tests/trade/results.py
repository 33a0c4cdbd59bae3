# SPDX-License-Identifier: LGPL-2.1-or-later
"""Outputs of runs against closed forms, on distorted meshes."""

from __future__ import annotations

import json
import math
import unittest
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Callable, Mapping, cast

import numpy
from numpy.typing import ArrayLike

import modules  # noqa: F401  finds the next ones
from billet_tools import UserError, output
from billet_tools.trade import outputs, results
from billet_tools.output import Array, Fields
from billet_tools.scene import Scene
from billet_tools.trade.options import parse
from billet_tools.trade.sweep import make_force, make_outputs, refuse_outputs

Make = Callable[[Array], Array]  # a field of places

trapezoid = getattr(numpy, "trapezoid", None) or numpy.trapz
CORNERS = numpy.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]], float
)


def block(n: int, displacement: Make, body: int = 0, shift: float = 0.0, **more: Make) -> Fields:
    """Fields of a unit cube of n³ sheared bricks, each with nodes of its own."""
    cells = [(CORNERS + [i, j, k]) / n for i in range(n) for j in range(n) for k in range(n)]
    places = numpy.concatenate(cells)
    places = places + [0.2 * 1, 0, 0] * places[:, [2]] + [shift, 0, 0]
    fields = {
        "places": places,
        "displacement": displacement(places),
        "body": numpy.full(len(places), float(body)),
        "cells": numpy.arange(len(places)).reshape(-1, 8),
    }
    return {**fields, **{name: make(places) for name, make in more.items()}}


def join(a: Fields, b: Fields) -> Fields:
    return {
        name: numpy.concatenate([a[name], b[name] + (len(a["places"]) if name == "cells" else 0)])
        for name in a
    }


class MadeUp:
    """Result with everything that an output reads."""

    def __init__(self, fields: Fields | None = None, history: Mapping[str, ArrayLike] | None = None) -> None:
        self.fields, self.history = fields, {k: numpy.array(v, float) for k, v in (history or {}).items()}
        self.body_meshes = (
            {int(b): results.BodyMesh(fields, b) for b in numpy.unique(fields["body"])} if fields else {}
        )


def run_of(fields: Fields | None = None, history: Mapping[str, ArrayLike] | None = None) -> results.Result:
    return cast(results.Result, MadeUp(fields, history))


def linear(places: Array) -> Array:
    return places @ numpy.diag([0.1, -0.05, 0.2])


class TestFields(unittest.TestCase):
    def test_sampling(self) -> None:
        mesh = run_of(block(3, linear)).body_meshes[0]
        fields = block(3, linear)
        for place in ([0.31, 0.4, 0.7], [0.5, 0.5, 0.5]):
            (found,), distance = mesh.at(numpy.array(place), fields["displacement"])
            numpy.testing.assert_allclose(found, linear(numpy.array([place]))[0], atol=1e-9)
            self.assertAlmostEqual(distance, 0.0)
        # Outside: a point near by, which VTK finds in the element's own coordinates.
        (found,), distance = mesh.at(numpy.array([0.5, 0.5, -0.25]), fields["displacement"])
        self.assertAlmostEqual(distance, 0.25, delta=0.01)
        numpy.testing.assert_allclose(found, [0.05, -0.025, 0.0], atol=0.006)
        numpy.testing.assert_allclose(mesh.volumes, 1 / 27)

    def test_profile(self) -> None:
        run = run_of(block(4, linear))
        profile = outputs.Profile("0.1, 0.5, 0.2 to 1, 0.5, 0.2", "stretch")
        numpy.testing.assert_allclose(profile.values(run), math.log(1.1), atol=1e-6)
        self.assertAlmostEqual(profile.error(run_of(block(4, lambda x: 0 * x)), profile.values(run)), 1.0)
        for wrong in ("1,2,3", "0,0,0 to 0,0,0", "0,0 to 1,1,1"):
            with self.assertRaises(UserError):
                outputs.Profile(wrong, "stretch")

    def test_plastic_profile(self) -> None:
        """Element means, smoothed at the nodes: inside the body of second order for a field that is
        linear."""

        def strain(places: Array) -> Array:
            return numpy.repeat(places.reshape(-1, 8, 3).mean(axis=1)[:, 1], 8)

        run = run_of(block(8, linear, equivalent_plastic_strain=strain))
        profile = outputs.Profile("0.5, 0.25, 0.5 to 0.5, 0.75, 0.5", "plastic")
        numpy.testing.assert_allclose(
            profile.values(run)[:, None].ravel(), numpy.linspace(0.25, 0.75, 41), atol=1e-6
        )
        with self.assertRaisesRegex(UserError, "nothing yields"):
            profile.values(run_of(block(2, linear)))

    def test_shape(self) -> None:
        """A body that is stretched and one that flies: the flight is no deformation, and its error is
        measured by that."""

        def both(stretch: float, flight: float) -> results.Result:
            return run_of(
                join(block(3, lambda x: stretch * x), block(2, lambda x: 0 * x + [flight, 0, 0], 1, 5.0))
            )

        right = both(0.1, 3.0)
        shape = outputs.Shape(right)
        exact = shape.values(right)
        self.assertEqual(shape.error(right, exact), 0.0)
        centred = right.body_meshes[0].centres - right.body_meshes[0].centres.mean(axis=0)
        # of both, one of which has none
        deformation = math.sqrt(0.5 * numpy.mean(numpy.sum((0.1 * centred) ** 2, axis=1)))
        self.assertAlmostEqual(shape.scale(exact), deformation)
        off = both(0.1, 3.01)
        self.assertAlmostEqual(shape.error(off, exact), 0.01 * math.sqrt(0.5) / deformation)

    def test_rebound(self) -> None:
        scene = Scene("subsection Tools\nsubsection ram\nsubsection Motion\nset Mass = 2\nend\nend\nend")
        history: dict[str, ArrayLike] = {
            "time": [0, 1, 1.5],
            **{f"ram.travel_{a}": v for a, v in zip("xyz", ([0, 0, 0], [0, 0, 0], [0, -1, -3]))},
        }
        run = run_of(
            block(2, linear, velocity=lambda x: 0 * x + [0, 3, 0] + numpy.outer(x[:, 1] - 0.5, [7, 0, 0])),
            history,
        )
        rebound = outputs.Rebound(scene)
        numpy.testing.assert_allclose(rebound.values(run), [[0, 3, 0], [0, 0, -4]], atol=1e-12)
        self.assertAlmostEqual(rebound.norm(rebound.values(run)), math.sqrt(12.5))

    def test_facets(self) -> None:
        fields = block(4, linear, contact_pair=lambda x: numpy.where(x[:, 2] > 1 - 1e-9, 0.0, -1.0))
        self.assertAlmostEqual(results.facet_size(fields), 0.25)
        self.assertTrue(math.isnan(results.facet_size(block(1, linear))))


class TestEnergy(unittest.TestCase):
    scene = Scene("subsection Time stepping\nset Scheme = explicit\nset End time = 1\nend")

    def run_with(self, stored: float, kinetic: float | None) -> results.Result:
        times = numpy.linspace(0, 1, 11)
        zero = numpy.zeros(11)
        history = {
            "time": times,
            "elastic_energy": stored * times,
            "plastic_work": zero,
            "friction_dissipation": stored * times,
        }
        return run_of(history=history if kinetic is None else {**history, "kinetic_energy": kinetic + zero})

    def test_error(self) -> None:
        energy = outputs.Energy(self.scene)
        exact = energy.values(self.run_with(0.5, 1.5))  # of mean 1/2 and 3/2, from 1/200 to 1
        self.assertAlmostEqual(energy.error(self.run_with(0.5, 1.5), exact), 0.0)
        self.assertAlmostEqual(energy.error(self.run_with(0.5, 1.3), exact), 0.1, delta=1e-3)
        self.assertAlmostEqual(energy.error(self.run_with(0.6, 1.5), exact), 0.05, delta=1e-3)
        self.assertEqual(energy.values(self.run_with(0.5, None)).shape, (200, 1))


class TestForce(unittest.TestCase):
    scene = Scene(
        "subsection Tools\nsubsection die\nend\nend\nsubsection Time stepping\nset End time = 1\nend"
    )

    def run_with(self, n: int, factor: float = 1.0, first: float = 1.0) -> results.Result:
        times = numpy.arange(1, n + 1) / n
        return run_of(
            history={
                "time": times,
                "die.force_x": 0 * times,
                "die.force_z": factor * (5 + times**2) * numpy.where(times == times[0], first, 1),
            }
        )

    def test_error(self) -> None:
        centre = self.run_with(20)
        force = outputs.Force(centre, self.scene, None, 0.05)
        exact = force.values(centre)
        self.assertEqual(force.columns, ["die.force_x", "die.force_z"])
        self.assertAlmostEqual(force.error(centre, exact), 0.0)
        self.assertAlmostEqual(force.error(self.run_with(20, 1.03), exact), 0.03)
        self.assertAlmostEqual(force.excess(self.run_with(20, 1.3), exact), 0.3)
        # Long steps are judged at their ends, where they were computed: no error of interpolation.
        self.assertAlmostEqual(force.error(self.run_with(4, 1.03), exact), 0.03)
        self.assertAlmostEqual(force.error(self.run_with(1, 1.03), exact), 0.03)
        # Times before the first step of the reference count for no run.
        self.assertLess(force.error(self.run_with(200, 1.0, 5.0), exact), 1e-9)

    def test_corners(self) -> None:
        """Runs are judged by their own errors, not those of interpolation, if all steps end at a corner of
        the curve."""

        def run(n: int, off: float) -> results.Result:
            times = numpy.arange(1, n + 1) / n
            return run_of(
                history={
                    "time": times,
                    "die.force_z": off * (1 + times) + numpy.where(times < 0.5, times, 4 - 6 * times),
                }
            )

        centre, finest = run(10, 0.04), run(40, 0.01)
        force = outputs.Force(centre, self.scene, None, 0.05, finest)
        exact = force.values(run(10, 0.0))
        for n in (10, 20, 40):
            self.assertLess(force.error(run(n, 0.0), exact), 1e-12)
            off, times = force.error(run(n, 0.01), exact), numpy.arange(1, n + 1) / n
            inside = times > 0.1 - 1e-9
            curve = numpy.where(times < 0.5, times, 4 - 6 * times)[inside]
            expected = trapezoid(0.01 * (1 + times[inside]), times[inside]) / trapezoid(
                numpy.abs(curve), times[inside]
            )
            self.assertAlmostEqual(off, expected, delta=1e-9)
        # At the ends of the centre's steps alone a finer run would be judged by an interpolated corner.
        coarse = outputs.Force(centre, self.scene, None, 0.05)
        self.assertGreater(coarse.error(run(40, 0.0), exact), 0.01)

    def test_columns(self) -> None:
        with self.assertRaisesRegex(UserError, "no column 'die.force_y'; it has die.force_x, die.force_z"):
            outputs.Force(self.run_with(5), self.scene, ["die.force_y"], 0.05)

    def test_forces_of_supports(self) -> None:
        """They count without tools and pairs: by themselves in statics if a support moves, else if asked
        for."""
        at_rest = """subsection Bodies
  subsection beam
    subsection Supports
      subsection wall
        set Boundary ids = 0
      end
      subsection end
        set Displacement = 0 ; 0 ; 0.0
      end
    end
  end
end
"""
        columns = ["beam.support wall.force_z", "beam.support end.force_z"]
        history: dict[str, list[float]] = {"time": [0.5, 1], "beam.symmetry plane y = 0.force_y": [7, 7]}
        for column in columns:
            history[column] = [1, 2]

        def columns_of(scene: Scene, *arguments: str, tool: str = "") -> list[str]:
            of_tool: dict[str, list[float]] = {f"{tool}.force_z": [1, 2]} if tool else {}
            run = run_of(history={**history, **of_tool})
            force = make_force(parse(["scene.prm", *arguments]), scene, run)
            return list(force.columns) if force else []

        rest = Scene(at_rest)
        moving = rest.changed({"Bodies/beam/Supports/end/Displacement": "0 ; 0 ; -0.5*t"})
        self.assertEqual(columns_of(moving), columns)
        self.assertEqual(columns_of(moving, tool="die"), ["die.force_z"])
        self.assertEqual(columns_of(moving, "--force", columns[1]), [columns[1]])
        explicit = moving.changed({"Time stepping/Scheme": "explicit", "Time stepping/End time": 1})
        for scene in (rest, explicit):
            self.assertEqual(columns_of(scene), [])
            self.assertEqual(columns_of(scene, "--outputs", "force"), columns)
            self.assertEqual(columns_of(scene, "--explain", "--force", columns[0]), [columns[0]])
        self.assertEqual(columns_of(Scene("")), [])
        refuse_outputs({"force": 1.0}, rest)
        with self.assertRaisesRegex(UserError, "no pair of bodies and no support, hence no force"):
            refuse_outputs({"force": 1.0}, Scene(""))
        # Columns that are named count in dynamics, too, where energies do otherwise.
        for more, name in ((f"--force={columns[0]}", "force"), ("--ranks=1", "energy")):
            options = parse(["scene.prm", "--explain", more])
            run = run_of(history=history)
            found = make_outputs(options, explicit, run, make_force(options, explicit, run), True)[0]
            self.assertEqual([output.name for output in found], [name])

    def test_explicit_force_is_smoothed(self) -> None:
        scene = self.scene.changed({"Time stepping/Scheme": "explicit"})
        times = numpy.linspace(0, 1, 2001)

        def ringing(amplitude: float) -> results.Result:
            return run_of(
                history={"time": times, "die.force_z": 1 + amplitude * numpy.sin(2 * math.pi * 20 * times)}
            )

        force = outputs.Force(ringing(0.0), scene, None, 0.05)
        exact = force.values(ringing(0.0))
        self.assertLess(force.error(ringing(1.0), exact), 0.01)  # whole periods; but for the ends
        self.assertAlmostEqual(
            force.error(run_of(history={"time": times, "die.force_z": 1.1 + 0 * times}), exact), 0.1
        )


class TestReactions(unittest.TestCase):
    """Columns of supports: their moments stand for forces that are round-off beside them."""

    @staticmethod
    def columns(force: float, moment: float) -> list[str]:
        history = {
            "time": numpy.array([1.0]),
            "bar.support end.force_z": numpy.array([force]),
            "bar.support end.moment_z": numpy.array([moment]),
        }
        mesh = SimpleNamespace(centres=numpy.array([[0.0, 3.0, 4.0]]))  # at a distance of 5
        run = SimpleNamespace(history=history, body_meshes={"bar": mesh})
        return outputs.reactions(cast(results.Result, run))

    def test_torsion(self) -> None:
        self.assertEqual(self.columns(1e-9, 2.0), ["bar.support end.moment_z"])

    def test_push(self) -> None:
        for moment in (0.0, 4.9e3):
            self.assertEqual(self.columns(1.0, moment), ["bar.support end.force_z"])
        self.assertEqual(self.columns(1.0, 5.1e3), ["bar.support end.moment_z"])


class TestHistory(unittest.TestCase):
    def test_drift(self) -> None:
        history = {
            "kinetic_energy": numpy.array([4.0, 1.0]),
            "plastic_work": numpy.array([0.0, 2.5]),
            "external_work": numpy.array([9.0, 9.0]),
            "energy_drift": numpy.array([0.0, -0.2]),
        }
        self.assertAlmostEqual(output.max_drift(history), 0.05)
        self.assertTrue(math.isnan(output.max_drift({})))

    def test_cut_off_line(self) -> None:
        with TemporaryDirectory() as folder:
            file = Path(folder, "history.csv")
            file.write_text("step,time\n1,0.5\n2,0.")
            self.assertEqual(output.read_history(file)["time"].tolist(), [0.5, 0.0])
            file.write_text("step,time\n1,0.5\n2")
            self.assertEqual(output.read_history(file)["time"].tolist(), [0.5])
            self.assertEqual(output.read_history(Path(folder, "none.csv")), {})

    def test_what_failed_has_worked(self) -> None:
        """Iterations of a step that failed for good stand in no history, but in the message that ended the
        run, as do explicit steps."""
        with TemporaryDirectory() as folder:
            place = Path(folder)
            (place / "stderr").write_text("error[solution-failed]: scene.prm: the step failed")
            (place / "results").mkdir()

            def fail(key: str, **values: float) -> None:
                record = {
                    "key": key,
                    "severity": "error",
                    "message": "scene.prm: the step failed",
                    "values": values,
                }
                (place / "results/diagnostics.jsonl").write_text(
                    '{"key": "penalty-too-low", "severity": "warning"}\n'
                    + json.dumps(record)
                    + '\n{"summary"'
                )

            fail("solution-failed", **{"Newton iterations": 12, "steps": 0})
            kept = results.collect(place, 3, 10)
            self.assertEqual((kept["status"], kept["newton"], kept["steps"]), ("diverged", 12, 0))
            (place / "results").mkdir()
            (place / "results/history.csv").write_text("step,time,total_iterations\n1,0.5,7\n")
            fail("solution-failed", **{"Newton iterations": 12, "steps": 1})
            self.assertEqual(results.collect(place, 3, 10)["newton"], 12)
            (place / "results").mkdir()
            (place / "results/history.csv").write_text("step,time,total_iterations\n1,0.5,7\n")
            self.assertEqual(results.collect(place, 0, 10)["newton"], 7)
            (place / "results").mkdir()
            fail("energy-drift", steps=100)
            kept = results.collect(place, 3, 10)
            self.assertEqual((kept["status"], kept["steps"]), ("drifted", 100))

    def test_failures(self) -> None:
        for code in (0, 6, 7):  # without complaint, with warnings, beside the target error
            self.assertEqual(results.failure(code, "", 1, {})[0], "ok")
        self.assertEqual(
            results.failure(3, "", 1, {"key": "solution-failed", "message": "a: no convergence"}),
            ("diverged", "a: no convergence"),
        )
        self.assertEqual(
            results.failure(3, "error[solution-failed]: a: no convergence", 1, {}),
            ("diverged", "a: no convergence"),
        )
        self.assertEqual(
            results.failure(3, "", 1, {"key": "energy-drift", "message": "by 9 %"})[0], "drifted"
        )
        self.assertEqual(results.failure(2, "error[bad-input]: x", 0, {}), ("refused", "x"))
        self.assertEqual(
            results.failure(None, "", 0.3, {}),
            (
                "out of time",
                "at time 0.3: a longer --time-limit, or a smaller pilot (--mesh, --until), may do",
            ),
        )
        self.assertEqual(results.failure(-11, "", 0.3, {})[0], "crashed")


unittest.main()
