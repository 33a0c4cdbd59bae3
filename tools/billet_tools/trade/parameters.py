# SPDX-License-Identifier: LGPL-2.1-or-later
"""Parameters of the study: what can be changed in a scene. A parameter turns an argument, a factor or a word,
into changes of the scene; one that the scene cannot use refuses. `billet --check` says whether the program
accepts a change."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from typing import Callable, Mapping

from .. import UserError
from ..scene import Changes, Scene

Maker = Callable[[Scene, str], Changes]  # of an argument as text; raises CannotTurn
Words = Callable[[str], list[str]]  # what the program allows for a path of a scene, as Program.words()


class CannotTurn(Exception):
    """Reason why the scene cannot use a parameter or one of its values."""


@dataclass
class Parameter:
    """Parameter of a study with its values. A choice takes its values from the program's words for the
    parameter of scenes at `path`, `without` some."""

    name: str
    meaning: str
    arguments: list[str]
    make: Maker
    path: str = ""
    without: tuple[str, ...] = ()

    def turned(self, scene: Scene, argument: str) -> Changes:
        """Calls make(); its errors about the argument name the parameter."""
        try:
            return self.make(scene, argument)
        except UserError as error:
            raise UserError(f"the parameter '{self.name}': {error}") from None


PARAMETERS: dict[str, Parameter] = {}  # choices have no values yet: see known_parameters()
OLD_NAMES = {"kinematics": "elasticity", "largest step": "maximum step"}


def parameter(name: str, meaning: str, *arguments: object) -> Callable[[Maker], Maker]:
    def keep(make: Maker) -> Maker:
        PARAMETERS[name] = Parameter(name, meaning, [str(a) for a in arguments], make)
        return make

    return keep


def choice(
    name: str, meaning: str, path: str, without: tuple[str, ...] = ("automatic",)
) -> Callable[[Maker], Maker]:
    """Returns the decorator of a parameter with the words of the program. In `path`, NAME stands for a name
    of the user."""

    def keep(make: Maker) -> Maker:
        PARAMETERS[name] = Parameter(name, meaning, [], make, path, without)
        return make

    return keep


def known_parameters(words: Words) -> dict[str, Parameter]:
    """Returns all parameters; choices have the values that the program allows."""
    return {
        name: (
            replace(known, arguments=[word for word in words(known.path) if word not in known.without])
            if known.path
            else known
        )
        for name, known in PARAMETERS.items()
    }


def number(text: str, allowed: str = "a number > 0", option: str = "") -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not (value > 0.0 and math.isfinite(value)):
        raise UserError(f"{option or 'the value'} is '{text}'; allowed is {allowed}")
    return value


def shown(value: float) -> str:
    return f"{value:.6g}"


def need(condition: object, why: str) -> None:
    if not condition:
        raise CannotTurn(why)


# --- mesh -----------------------------------------------------------------------------------------

# Arguments (from 0) of deal.II's generators that are numbers of elements. Other generators are refined.
COUNTS = {
    "subdivided_hyper_rectangle": (0,),
    "subdivided_hyper_cube": (0,),
    "subdivided_cylinder": (0,),
    "cylinder_shell": (3, 4),
    "hyper_shell": (3,),
    "quarter_hyper_shell": (3,),
    "half_hyper_shell": (3,),
    "concentric_hyper_shells": (3, 5),
}


def plane_axes(planes: str) -> set[int]:
    """Axes along which a body lies between two symmetry planes, so that one layer of elements may be all
    there is."""
    axes = re.findall(r"(?:^|;)\s*([xyz])\s*=", planes)
    return {"xyz".index(axis) for axis in axes if axes.count(axis) > 1}


def scaled(count: int, factor: float) -> int:
    return max(1, round(count * factor))


def scaled_mesh(scene: Scene, body: str, factor: float) -> Changes:
    """Changes that make the elements of a body so many times smaller along each edge."""
    mesh = f"Bodies/{body}/Mesh/"
    changes = {}
    source = scene.get(mesh + "Source")
    primitive = scene.get(mesh + "Primitive")
    flat = plane_axes(scene.get(f"Bodies/{body}/Symmetry planes"))
    if source == "extruded primitive" and 2 not in flat:
        changes[mesh + "Layers"] = scaled(int(scene.get(mesh + "Layers")), factor)
    if source != "file" and primitive in COUNTS:
        arguments = [a.strip() for a in scene.get(mesh + "Arguments").split(":")]
        for place in COUNTS[primitive]:
            if place >= len(arguments):
                continue
            counts = [int(c) for c in arguments[place].split(",")]
            # One element between two symmetry planes is the third dimension of a plane problem.
            arguments[place] = ", ".join(
                str(c if c == 1 and axis in flat and len(counts) == 3 else scaled(c, factor))
                for axis, c in enumerate(counts)
            )
        if any(arguments[p] != "0" for p in COUNTS[primitive] if p < len(arguments)):
            return {**changes, mesh + "Arguments": " : ".join(arguments)}
    levels = math.log2(factor)
    refinements = int(scene.get(mesh + "Refinements")) + round(levels)
    need(abs(levels - round(levels)) < 1e-9, f"the mesh of '{body}' changes by factors of 2 only")
    need(
        refinements >= 0,
        (
            f"the mesh of '{body}' cannot be coarser by {factor:g}: its Refinements are "
            f"{scene.get(mesh + 'Refinements')}"
        ),
    )
    return {**changes, mesh + "Refinements": refinements}


def scaled_meshes(scene: Scene, factor: float) -> Changes:
    """Changes that make the elements of all bodies so many times smaller along each edge."""
    changes: dict[str, object] = {}
    for body in scene.names("Bodies"):
        changes.update(scaled_mesh(scene, body, factor))
    return changes


@parameter("mesh", "elements along each edge, factor of the scene's", 0.5, 1, 2)
def make_mesh(scene: Scene, argument: str) -> Changes:
    return scaled_meshes(scene, number(argument))


# --- steps ----------------------------------------------------------------------------------------


def implicit(scene: Scene) -> None:
    need(not scene.is_explicit, "of implicit scenes")


def explicit(scene: Scene) -> None:
    need(scene.is_explicit, "of explicit scenes")


def longest_steps(scene: Scene) -> int:
    """Returns the number of steps of the maximum length in the scene."""
    key = "Initial step" if scene.get("Time stepping/Step control") == "fixed" else "Maximum step"
    return max(1, math.ceil(scene.end_time / scene.step(key) - 1e-9))


def equal_steps(scene: Scene, n: float) -> Changes:
    """n equal steps. The step does not follow the iterations, but one that fails is cut and soon as long
    again."""
    step = shown(scene.end_time / n)
    changes = {
        "Time stepping/Step control": "automatic",
        "Time stepping/Initial step": step,
        "Time stepping/Maximum step": step,
        "Time stepping/Growth iterations": 9998,
        "Time stepping/Shrink iterations": 9999,
    }
    if scene.scheme == "implicit dynamics":
        changes["Implicit dynamics/Error tolerance"] = 0
    elif scene.knows("Time stepping/Error tolerance"):
        changes["Time stepping/Error tolerance"] = 0
    return changes


@parameter("steps", "so many equal steps", 10, 20, 40, 80)
def make_steps(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return equal_steps(scene, number(argument))


@parameter("maximum step", "of automatic steps, factor of the scene's", 0.125, 0.25, 0.5, 1, 2)
def make_max_step(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    need(scene.get("Time stepping/Step control") != "fixed", "of automatic steps")
    need(
        "Time stepping/Maximum step" in scene.entries
        or number(argument) <= 1
        or scene.end_time / 4 >= scene.step("Maximum step"),
        "the maximum step is already a large part of the end time",
    )
    largest = number(argument) * scene.step("Maximum step")
    return {
        "Time stepping/Maximum step": shown(largest),
        "Time stepping/Initial step": shown(min(largest, scene.step("Initial step"))),
    }


@parameter("error tolerance", "of a step, by which its length is chosen", 1e-2, 3e-3, 1e-3, 3e-4, 1e-4)
def make_error_tolerance(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    if scene.scheme == "implicit dynamics":
        return {"Implicit dynamics/Error tolerance": argument}
    need(scene.knows("Time stepping/Error tolerance"), "of implicit dynamics")
    return {"Time stepping/Error tolerance": argument}


@parameter("spectral radius", "what a step leaves of the highest frequencies", 0, 0.5, 0.8, 1)
def make_spectral_radius(scene: Scene, argument: str) -> Changes:
    need(scene.scheme == "implicit dynamics", "of implicit dynamics")
    need(scene.get("Implicit dynamics/Method") == "generalised-alpha", "of the generalised-alpha method")
    return {"Implicit dynamics/Spectral radius": argument}


@choice("mass", "matrix of implicit dynamics", "Implicit dynamics/Mass")
def make_mass(scene: Scene, argument: str) -> Changes:
    need(scene.scheme == "implicit dynamics", "of implicit dynamics")
    return {"Implicit dynamics/Mass": argument}


@parameter("safety factor", "part of the stable step", 0.95, 0.75, 0.5, 0.25)
def make_safety(scene: Scene, argument: str) -> Changes:
    explicit(scene)
    return {"Explicit dynamics/Safety factor": argument}


@parameter(
    "contact resolution", "how much finer than stability asks for steps resolve contact penalties", 1, 2, 4
)
def make_resolution(scene: Scene, argument: str) -> Changes:
    explicit(scene)
    need(scene.pairs, "there is no contact")
    return {"Explicit dynamics/Contact resolution": argument}


@parameter("mass scaling", "steps so many times longer by mass that is added", 1.5, 2, 4, 8)
def make_mass_scaling(scene: Scene, argument: str) -> Changes:
    explicit(scene)
    # Its own first step is known once the scene has run.
    step = scene.first_step or scene.end_time / 1e4
    return {"Explicit dynamics/Mass scaling step": shown(number(argument) * step)}


@parameter("bulk viscosity", "linear and quadratic, factor of the scene's", 0.25, 0.5, 1, 2)
def make_viscosity(scene: Scene, argument: str) -> Changes:
    explicit(scene)
    return {
        f"Explicit dynamics/{kind} bulk viscosity": shown(
            number(argument) * scene.number(f"Explicit dynamics/{kind} bulk viscosity")
        )
        for kind in ("Linear", "Quadratic")
    }


@choice(
    "instructions",
    "instruction set of the element kernels: changes the cost, not the result",
    "Explicit dynamics/Instruction set",
)
def make_instructions(scene: Scene, argument: str) -> Changes:
    explicit(scene)
    return {"Explicit dynamics/Instruction set": argument}


@choice(
    "number type",
    "what elements compute with: float halves the width of numbers, to seven digits",
    "Explicit dynamics/Number type",
)
def make_number_type(scene: Scene, argument: str) -> Changes:
    explicit(scene)
    return {"Explicit dynamics/Number type": argument}


# --- contact --------------------------------------------------------------------------------------


def pairs(scene: Scene, of_bodies: bool = False) -> list[str]:
    found = scene.pairs
    need(found, "there is no contact")
    if of_bodies:
        found = [pair for pair in found if pair == "General contact/" or scene.get(pair + "Second body")]
        need(found, "no bodies touch each other")
    return found


def has_friction(scene: Scene) -> bool:
    return any(
        scene.number(pair + "Friction coefficient") > 0 or scene.number(pair + "Maximum shear stress") > 0
        for pair in pairs(scene)
    )


def scaled_penalties(scene: Scene, factor: float) -> Changes:
    changes: dict[str, object] = {}
    for pair in pairs(scene):
        if not scene.is_set(pair + "Penetration tolerance") and scene.penetration_tolerance(pair) > 0:
            changes[pair + "Penetration tolerance"] = "automatic"  # which a penalty alone would end
        for key in ("Normal penalty", "Tangential penalty"):
            if scene.get(pair + key):
                changes[pair + key] = shown(factor * scene.number(pair + key))
    return changes


@parameter("penalty", "factor of the scene's, normal and tangential", 0.1, 0.3, 1, 3, 10)
def make_penalty(scene: Scene, argument: str) -> Changes:
    return scaled_penalties(scene, number(argument))


@parameter(
    "augmentation",
    "until nodes are no farther from their faces than this, in facet sizes; 0: penalties alone",
    0,
    1e-1,
    1e-2,
    1e-3,
    1e-4,
)
def make_augmentation(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return {pair + "Penetration tolerance": argument for pair in pairs(scene)}


# The numerical tangent is the exact one, at a high cost.
@choice("tangent", "contact tangent", "Solver/Contact tangent", without=("automatic", "numerical"))
def make_tangent(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    need(has_friction(scene) or not argument.startswith("symmetrised"), "there is no friction to symmetrise")
    return {"Solver/Contact tangent": argument}


@choice("facets", "what nodes of bodies touch", "Contact pairs/NAME/Facets")
def make_facets(scene: Scene, argument: str) -> Changes:
    return {pair + "Facets": argument for pair in pairs(scene, True)}


@choice("passes", "of nodes against facets: of one side, or of both", "Contact pairs/NAME/Passes")
def make_passes(scene: Scene, argument: str) -> Changes:
    changes = {}
    for pair in pairs(scene, True):
        if not scene.is_explicit and scene.get(pair + "Facets") in ("automatic", "overlap"):
            changes[pair + "Facets"] = "planed"
        changes[pair + "Passes"] = argument
    return changes


@parameter("smoothing", "of nodes against facets, part of a facet", 0.05, 0.1, 0.25, 0.5)
def make_smoothing(scene: Scene, argument: str) -> Changes:
    changes = {}
    for pair in pairs(scene, True):
        if not scene.is_explicit and scene.get(pair + "Facets") in ("automatic", "overlap"):
            changes[pair + "Facets"] = "planed"
        changes[pair + "Smoothing"] = argument
    return changes


@parameter("search margin", "in facet sizes: changes the cost, not the result", 0.1, 0.25, 0.5, 1, 2)
def make_margin(scene: Scene, argument: str) -> Changes:
    return {pair + "Search margin": argument for pair in pairs(scene, True)}


# --- solver ---------------------------------------------------------------------------------------


def newton_tolerance(tolerance: float) -> Changes:
    """Returns the tolerances of force and energy, in the ratio of the defaults, 1e-6 and 1e-10."""
    return {
        "Solver/Force tolerance": shown(tolerance),
        "Solver/Energy tolerance": shown(0.1 * tolerance**1.5),
    }


@parameter("tolerance", "of Newton's method", 1e-2, 1e-3, 1e-4, 1e-6, 1e-8)
def make_tolerance(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return newton_tolerance(number(argument))


@choice("predictor", "where iterations start", "Solver/Predictor")
def make_predictor(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return {"Solver/Predictor": argument}


@choice("line search", "of Newton's method", "Solver/Line search")
def make_line_search(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return {"Solver/Line search": argument}


@choice("solver", "linear solver", "Solver/Linear solver")
def make_solver(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return {"Solver/Linear solver": argument}


def iterative(scene: Scene) -> Changes:
    """Returns the iterative solver of the scene, or else the one that every matrix allows."""
    solver = scene.get("Solver/Linear solver")
    return {} if solver in ("CG", "GMRES") else {"Solver/Linear solver": "GMRES"}


@parameter(
    "linear tolerance", "of an iterative solver (GMRES, unless the scene names one)", 1e-2, 1e-4, 1e-6, 1e-10
)
def make_linear_tolerance(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return {**iterative(scene), "Solver/Linear tolerance": argument}


@choice("forcing", "how exactly an iterative solver solves", "Solver/Forcing term")
def make_forcing(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    return {**iterative(scene), "Solver/Forcing term": argument}


# --- bodies ---------------------------------------------------------------------------------------


@choice("element", "of all bodies", "Bodies/NAME/Element")
def make_element(scene: Scene, argument: str) -> Changes:
    return {f"Bodies/{body}/Element": argument for body in scene.names("Bodies")}


@choice("elasticity", "of all bodies' laws", "Bodies/NAME/Material/Elasticity")
def make_elasticity(scene: Scene, argument: str) -> Changes:
    return {f"Bodies/{body}/Material/Elasticity": argument for body in scene.names("Bodies")}


@choice("material tangent", "of bodies whose exact one is unsymmetric", "Solver/Material tangent")
def make_material_tangent(scene: Scene, argument: str) -> Changes:
    implicit(scene)
    need(scene.knows("Solver/Material tangent"), "this billet has no such parameter")
    return {"Solver/Material tangent": argument}


# --- all at once ----------------------------------------------------------------------------------


MESH_TARGET = ("Target error of", "Finest mesh level")


def without_target(scene: Scene) -> dict[str, object]:
    """Changes that leave the mesh as given."""
    return {path: None for path in MESH_TARGET if path in scene.entries}


@choice("profile", "one word for many parameters", "Profile")
def make_profile(scene: Scene, argument: str) -> Changes:
    need(scene.knows("Profile"), "this billet has no such parameter")
    return {"Profile": argument, **without_target(scene), "Target error": None}


@parameter("target error", "by which the program chooses parameters itself", 0.1, 0.03, 0.01, 0.003)
def make_target_error(scene: Scene, argument: str) -> Changes:
    need(scene.knows("Target error"), "this billet has no such parameter")
    return {**without_target(scene), "Target error": argument, "Profile": None}


@parameter(
    "target error of everything",
    "the mesh included: the program runs levels of the given mesh until their difference is small enough",
    0.1,
    0.03,
    0.01,
)
def make_target_of_everything(scene: Scene, argument: str) -> Changes:
    need(scene.knows("Target error of"), "this billet has no such parameter")
    return {"Target error": argument, "Target error of": "everything", "Profile": None}


# --- what users name ------------------------------------------------------------------------------


def own_parameter(text: str) -> Parameter:
    """A parameter from '[NAME: ]path/to/parameter=v1,v2 [& other/path=w1,w2]', values separated by '|' where
    they hold commas."""
    name, marked, rest = text.partition(": ")
    if not marked or "=" in name or "/" in name:
        name, rest = "", text
    columns = {}
    for part in rest.split("&"):
        path, equals, values = part.partition("=")
        path = "/".join(" ".join(p.split()) for p in path.split("/"))
        if not equals or not path:
            raise UserError(
                f"--parameter is '{text}'; allowed is 'path/to/parameter=value,value' or "
                "'name: path/to/parameter=value,value & other/path=value,value'"
            )
        columns[path] = [v.strip() for v in values.split("|" if "|" in values else ",")]
    first = next(iter(columns.values()))
    if any(len(values) != len(first) for values in columns.values()):
        raise UserError(f"--parameter: '{text}' names different numbers of values")

    def make(_: Scene, argument: str) -> Changes:
        place = first.index(argument)
        return {path: values[place] for path, values in columns.items()}

    return Parameter(name or next(iter(columns)).split("/")[-1].lower(), ", ".join(columns), first, make)


def asked_parameter(text: str, known: Mapping[str, Parameter]) -> Parameter:
    """A parameter from 'name' or 'name=argument,argument'."""
    name, equals, arguments = text.partition("=")
    name = name.strip()
    if name not in known:
        name = OLD_NAMES.get(name, name)
    if name not in known:
        raise UserError(
            f"there is no parameter '{name}'; there are {', '.join(known)}. "
            "--list says which ones the scene can use; --parameter 'path/to/parameter=value,value' adds one"
        )
    found = known[name]
    if not equals:
        return found
    named = [a.strip() for a in arguments.split("|" if "|" in arguments else ",") if a.strip()]
    return replace(found, arguments=named)


# --- the reference --------------------------------------------------------------------------------


def reference_settings(scene: Scene) -> Changes:
    """Returns settings of the reference that no sequence converges: tight tolerances and exact options."""
    changes: dict[str, object] = {
        path: None for path in ("Profile", "Target error", *MESH_TARGET) if path in scene.entries
    }
    for body in scene.names("Bodies"):
        path = f"Bodies/{body}/Material/Elasticity"
        if scene.entries.get(path, "Hencky") != "Hencky":
            changes[path] = "Hencky"
    if scene.is_explicit:
        if scene.number("Explicit dynamics/Mass scaling step") > 0:
            changes["Explicit dynamics/Mass scaling step"] = 0
        return changes
    return {**changes, **newton_tolerance(min(1e-8, scene.number("Solver/Force tolerance") or 1e-8))}
