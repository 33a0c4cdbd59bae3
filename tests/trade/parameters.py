# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters: what they change, and in which scenes they can."""

from __future__ import annotations

import unittest

from modules import ROOT
from billet_tools import UserError
from billet_tools.trade import parameters
from billet_tools.trade.reference import GIVEN, Plan, mesh_factors
from billet_tools.scene import Changes, Scene, read_scene

DEFAULTS = """subsection Bodies
 subsection (name of a body)
  set Element = assumed strain
  subsection Mesh
   set Source = primitive
   set Primitive = hyper_rectangle
   set Refinements = 0
   set Layers = 1
  end
 end
end
subsection Contact pairs
 subsection (name of a contact pair)
  set Facets = automatic
  set Normal penalty = 10
  set Tangential penalty =
  set Penetration tolerance = 0
 end
end
subsection Time stepping
 set Initial step = 0.01
 set Maximum step = 0.1
 set Step control = automatic
end
subsection Solver
 set Force tolerance = 1e-6
end
subsection Explicit dynamics
 set Safety factor = 0.75
end
"""


def shipped(name: str) -> Scene:
    return Scene(read_scene(ROOT / "prm" / f"{name}.prm"), DEFAULTS)


def body(mesh: str, planes: str = "") -> Scene:
    return Scene(
        (
            f"subsection Bodies\nsubsection b\nset Symmetry planes = {planes}\nsubsection"
            f" Mesh\n{mesh}\nend\nend\nend"
        ),
        DEFAULTS,
    )


def not_asked(changes: Changes) -> int:
    raise AssertionError("factors that are given need no count of elements")


class TestMesh(unittest.TestCase):
    def test_extruded(self) -> None:
        scene = shipped("billet_upsetting")
        self.assertEqual(
            parameters.make_mesh(scene, "2"),
            {"Bodies/billet/Mesh/Layers": 10, "Bodies/billet/Mesh/Refinements": 2},
        )
        self.assertEqual(
            parameters.make_mesh(scene, "0.5"),
            {"Bodies/billet/Mesh/Layers": 2, "Bodies/billet/Mesh/Refinements": 0},
        )
        for factor in ("0.25", "1.5"):
            with self.assertRaises(parameters.CannotTurn):
                parameters.make_mesh(scene, factor)
        with self.assertRaises(UserError):
            parameters.make_mesh(scene, "-1")

    def test_counts(self) -> None:
        # one element along y between two planes stays one
        changes = parameters.make_mesh(shipped("ironing"), "1.5")
        self.assertEqual(changes["Bodies/slab/Mesh/Arguments"], "54, 1, 9 : 0, 0, 0 : 18, 0.5, 3 : true")
        self.assertEqual(changes["Bodies/die/Mesh/Arguments"], "15, 1, 6 : -2, 0, 0 : 2, 0.5, 1.5 : true")
        tube = parameters.make_mesh(shipped("tube_impact"), "2")
        self.assertEqual(tube["Bodies/left/Mesh/Arguments"], "0, 0 : 0.09 : 0.1 : 4 : 0 : 60 : true")
        self.assertEqual(tube["Bodies/right/Mesh/Layers"], 30)
        thick = body(
            "set Primitive = subdivided_hyper_rectangle\nset Arguments = 4, 1, 2 : 0, 0, 0 : 1, 1, 1", "y = 0"
        )
        self.assertEqual(
            parameters.make_mesh(thick, "2"), {"Bodies/b/Mesh/Arguments": "8, 2, 4 : 0, 0, 0 : 1, 1, 1"}
        )

    def test_files(self) -> None:
        self.assertEqual(
            parameters.make_mesh(body("set Source = file\nset File = a.msh"), "4"),
            {"Bodies/b/Mesh/Refinements": 2},
        )


class TestParameters(unittest.TestCase):
    def test_equal_steps(self) -> None:
        changes = parameters.make_steps(shipped("ironing"), "35")
        self.assertEqual(changes["Time stepping/Initial step"], "0.1")
        self.assertEqual(changes["Time stepping/Maximum step"], "0.1")
        with self.assertRaises(parameters.CannotTurn):
            parameters.make_steps(shipped("taylor_bar"), "10")

    def test_penalties(self) -> None:
        scene = shipped("wagoner_punch").changed({"Contact pairs/blank on die/Tangential penalty": 4})
        self.assertEqual(
            parameters.make_penalty(scene, "10"),
            {
                "Contact pairs/blank on punch/Normal penalty": "1e+06",
                "Contact pairs/blank on die/Normal penalty": "1e+06",
                "Contact pairs/blank on die/Tangential penalty": "40",
            },
        )
        # of the default
        self.assertEqual(
            parameters.make_penalty(shipped("ironing"), "3"), {"Contact pairs/face/Normal penalty": "30"}
        )

    def test_contact_of_everything(self) -> None:
        scene = shipped("ironing").changed(
            {"Contact": "all", "General contact/Normal penalty": 5, "Contact pairs/face/Normal penalty": None}
        )
        self.assertEqual(
            parameters.make_penalty(scene, "3"),
            {"Contact pairs/face/Normal penalty": "15", "General contact/Normal penalty": "15"},
        )
        self.assertIn("General contact/", parameters.pairs(scene, True))

    def test_only_what_a_scene_can_use(self) -> None:
        cannot = {
            "billet_upsetting": ["facets", "safety factor", "mass", "error tolerance"],
            "hertz_cylinders": ["instructions", "number type"],
            "taylor_bar": ["steps", "tangent", "solver", "facets", "augmentation"],
            "wagoner_punch_mu_0": ["search margin"],
        }
        for name, those in cannot.items():
            for parameter in those:
                argument = (parameters.PARAMETERS[parameter].arguments or ["a word"])[0]
                with self.assertRaises(parameters.CannotTurn, msg=f"{name}: {parameter}"):
                    parameters.PARAMETERS[parameter].make(shipped(name), argument)
        with self.assertRaises(parameters.CannotTurn):
            parameters.make_tangent(shipped("hertz_cylinders"), "symmetrised mean")
        self.assertTrue(parameters.make_tangent(shipped("billet_upsetting"), "symmetrised mean"))

    def test_tolerances_keep_their_ratio(self) -> None:
        self.assertEqual(
            parameters.newton_tolerance(1e-6),
            {"Solver/Force tolerance": "1e-06", "Solver/Energy tolerance": "1e-10"},
        )

    def test_own_parameter(self) -> None:
        parameter = parameters.own_parameter(
            "pace: Time stepping/Growth factor=1.2, 2 & Time stepping/Growth  iterations=3,6"
        )
        self.assertEqual((parameter.name, parameter.arguments), ("pace", ["1.2", "2"]))
        self.assertEqual(
            parameter.make(Scene(""), "2"),
            {"Time stepping/Growth factor": "2", "Time stepping/Growth iterations": "6"},
        )
        self.assertEqual(
            parameters.own_parameter("Bodies/b/Mesh/Arguments=1, 2 : 3|2, 4 : 3").arguments,
            ["1, 2 : 3", "2, 4 : 3"],
        )
        for wrong in ("nothing", "a=1,2 & b=1"):
            with self.assertRaises(UserError):
                parameters.own_parameter(wrong)

    def test_choices(self) -> None:
        """Choices have the words of the program but for those that they leave out; others keep their own."""
        allowed = {
            "Bodies/NAME/Element": ["assumed strain", "newest"],
            "Solver/Contact tangent": ["automatic", "exact", "numerical", "continuum"],
        }
        known = parameters.known_parameters(lambda path: allowed.get(path, []))
        self.assertEqual(known["element"].arguments, ["assumed strain", "newest"])
        self.assertEqual(known["tangent"].arguments, ["exact", "continuum"])
        self.assertEqual(known["elasticity"].arguments, [])
        self.assertEqual(known["penalty"].arguments, parameters.PARAMETERS["penalty"].arguments)
        self.assertEqual(list(known), list(parameters.PARAMETERS))

    def test_old_names(self) -> None:
        """Old names of parameters stand for the new ones, unless the user has named one so."""
        known = dict(parameters.PARAMETERS)
        self.assertEqual(parameters.asked_parameter("kinematics=Hencky", known).name, "elasticity")
        self.assertEqual(parameters.asked_parameter("largest step=1,2", known).name, "maximum step")
        own = parameters.own_parameter("kinematics: a/b=1,2")
        self.assertIs(parameters.asked_parameter("kinematics", {**known, "kinematics": own}), own)

    def test_unknown_parameter(self) -> None:
        with self.assertRaisesRegex(UserError, "no parameter 'speed'; there are mesh, steps,"):
            parameters.asked_parameter("speed=1", parameters.PARAMETERS)
        self.assertEqual(
            parameters.asked_parameter("tangent=exact, symmetrised mean", parameters.PARAMETERS).arguments,
            ["exact", "symmetrised mean"],
        )


class TestPlan(unittest.TestCase):
    def test_factors(self) -> None:
        scene = shipped("billet_upsetting")
        self.assertEqual(mesh_factors(scene, None, lambda changes: 3840), [1, 2, 4])
        self.assertEqual(mesh_factors(scene, None, lambda changes: 30720), [0.5, 1, 2])
        self.assertEqual(mesh_factors(scene, "1,1.5,2.25", not_asked), [1, 1.5, 2.25])
        for wrong in ("2,4", "1", "1,2,3", "0,1"):
            with self.assertRaises(UserError):
                mesh_factors(scene, wrong, not_asked)

    def test_runs(self) -> None:
        plan = Plan(shipped("billet_upsetting"), lambda scene: 100, steps=8)
        self.assertEqual(
            [label for label, _ in plan.runs()],
            [
                "centre",
                "16 steps",
                "32 steps",
                "mesh 2",
                "mesh 4",
                "penalty × 4",
                "penalty × 16",
                "all of them",
            ],
        )
        self.assertEqual(plan.centre.get("Solver/Force tolerance"), "1e-08")
        self.assertEqual(plan.cross.get("Bodies/billet/Mesh/Layers"), "10")
        self.assertEqual(plan.cross.get("Contact pairs/billet on die/Normal penalty"), "1.4e+06")
        self.assertEqual(plan.cross.get("Time stepping/Maximum step"), "0.0625")

    def test_augmented_and_given(self) -> None:
        plan = Plan(shipped("hertz_cylinders"), lambda scene: 1, GIVEN)
        self.assertEqual([axis.name for axis in plan.axes], ["step", "penetration tolerance"])

        self.assertEqual(
            [scene.get("Contact pairs/faces/Penetration tolerance") for _, scene in plan.axes[1].levels],
            ["0.001", "0.00025", "6.25e-05"],
        )
        self.assertEqual((plan.axes[1].centre, plan.centre.get("Solver/Maximum augmentations")), (1, "100"))
        # Bodies that touch in an implicit scene: augmented, though the scene is not.
        plan = Plan(shipped("ironing"), lambda scene: 1, GIVEN)
        self.assertEqual(
            [scene.get("Contact pairs/face/Penetration tolerance") for _, scene in plan.axes[-1].levels],
            ["0.01", "0.0025", "0.000625"],
        )

    def test_explicit(self) -> None:
        scene = shipped("taylor_bar").changed(
            {"Bodies/bar/Material/Elasticity": "hypoelastic", "Explicit dynamics/Mass scaling step": 1e-7}
        )
        plan = Plan(scene, lambda scene: 1)
        self.assertEqual(
            [scene.get("Explicit dynamics/Safety factor") for _, scene in plan.axes[0].levels],
            ["0.75", "0.375", "0.1875"],
        )
        self.assertEqual(plan.centre.get("Bodies/bar/Material/Elasticity"), "Hencky")
        self.assertEqual(plan.centre.get("Explicit dynamics/Mass scaling step"), "0")


unittest.main()
