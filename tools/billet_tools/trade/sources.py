# SPDX-License-Identifier: LGPL-2.1-or-later
"""Sources of error in a scene, and runs in which one of them alone is smaller or larger."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Callable, Mapping, NamedTuple, Sequence

from ..scene import Changes, Scene
from ..text import number
from . import parameters

MESH, GEOMETRY, ELEMENTS = "mesh", "geometry", "elements"
MOST_STOPS = 2000  # steps of a scene whose times other runs are made to share


class Variant(NamedTuple):
    """Run with its label, its changes, and the changes that a user would make for it."""

    label: str
    changes: Changes
    paste: Changes


@dataclass
class Source:
    """`ratio`: by which the finer run makes the source smaller and the coarser one larger; infinite if the
    finer run takes it away. `weight`: how much of the error it makes as a rule, which sets the order of the
    runs. `is_of_mesh`: a part of the mesh's error, which the sum has already."""

    name: str
    finer: Variant | None
    coarser: Variant | None = None
    ratio: float = 2.0
    weight: float = 1.0
    is_of_mesh: bool = False
    remarks: list[str] = field(default_factory=list)

    @property
    def variants(self) -> list[Variant]:
        return [v for v in (self.finer, self.coarser) if v is not None]


def midpoints(times: Sequence[float]) -> list[float]:
    """Ends of steps of half the length."""
    found = []
    for before, time in zip([0.0, *times], times):
        found += [0.5 * (before + time), time]
    return found


def has_error_control(scene: Scene) -> bool:
    """Returns whether error estimates control the steps."""
    return bool(scene.get("Target error")) or any(
        scene.number(path) > 0
        for path in ("Time stepping/Error tolerance", "Implicit dynamics/Error tolerance")
        if scene.knows(path)
    )


def same_steps(scene: Scene, times: Sequence[float]) -> Changes:
    """Changes that make an implicit scene end steps at these times: differences from other runs are not those
    of their steps then, and need no interpolation. Steps that estimates choose may be shorter still."""
    if scene.is_explicit or not 0 < len(times) <= MOST_STOPS:
        return {}
    inner = [f"{time:.15g}" for time in times if time < scene.end_time * (1.0 - 1e-9)]
    changes: dict[str, object] = {"Time stepping/Stops": ", ".join(inner)} if inner else {}
    longest = parameters.shown(1.000001 * max(b - a for a, b in zip([0.0, *times], times)))
    if scene.get("Time stepping/Step control") == "fixed":
        return {**changes, "Time stepping/Initial step": longest}
    if not has_error_control(scene):
        changes.update(
            {
                "Time stepping/Initial step": longest,
                "Time stepping/Maximum step": longest,
                "Time stepping/Growth iterations": 9998,
                "Time stepping/Shrink iterations": 9999,
            }
        )
    return changes


class Given(NamedTuple):
    """Data of the scene that its sources need: the ends of its steps, the maximum penetration of its contact
    in facet sizes, and of each column of it, and the answer of --check. Without them the sources are only
    counted."""

    times: Sequence[float] = (0.5, 1.0)
    penetration: float = math.nan
    checked: Mapping[str, Any] = {}
    depths: Mapping[str, float] = {}

    def is_shallow(self, pair: str) -> bool:
        """Tells whether the penetration of a pair is small beside that of the contact."""
        name, small = pair.rstrip("/").split("/")[-1], 0.1
        own = max(self.depths.get(f"{of}{name}.deepest_penetration", -1.0) for of in ("", "pair "))
        return 0.0 <= own < small * self.penetration


def mesh_source(scene: Scene) -> Source:
    found = Source(MESH, None, weight=8.0)
    try:
        finer = parameters.scaled_meshes(scene, 2.0)
        found.finer = Variant("mesh, one level finer", finer, finer)
    except parameters.CannotTurn as why:
        found.remarks.append(f"no finer mesh: {why}")
    try:
        coarser = parameters.scaled_meshes(scene, 0.5)
        found.coarser = Variant("mesh, one level coarser", coarser, coarser)
    except parameters.CannotTurn as why:
        found.remarks.append(f"no coarser mesh: {why}")
    return found


def step_source(scene: Scene, given: Given) -> Source:
    if scene.is_explicit:
        shorter = {
            "Explicit dynamics/Safety factor": parameters.shown(
                0.5 * scene.number("Explicit dynamics/Safety factor")
            )
        }
        return Source("steps", Variant("half the safety factor", shorter, shorter), weight=1.0)
    halves = same_steps(scene, midpoints(given.times))
    largest = 0.5 * max(b - a for a, b in zip([0.0, *given.times], given.times))
    paste = {
        "Time stepping/Maximum step": parameters.shown(largest),
        "Time stepping/Initial step": parameters.shown(min(largest, 0.5 * scene.step("Initial step"))),
    }
    if scene.get("Time stepping/Step control") == "fixed":
        paste.pop("Time stepping/Maximum step")
    if not halves:  # more steps than stops may be: interpolation is good enough
        halves = paste
    return Source("steps", Variant("steps of half the length", halves, paste), weight=4.0)


LEAST_PENETRATION = 1e-6  # [facet sizes] below which no run reduces it
QUARTER = "a quarter of the penetration"


def end_of_ramps(scene: Scene) -> float:
    """Returns the time from which no initial penetration is left that vanishes in a ramp; before, depths are
    not those of the contact alone."""
    ramps = [pair for pair in scene.pairs if scene.get(pair + "Initial penetration") == "ramp"]
    return max((scene.number(pair + "Ramp time") for pair in ramps), default=0.0)


def penetration_source(scene: Scene, given: Given) -> Source | None:
    """Returns the source whose finer run has four times the penalty. If contact is augmented, that run has a
    quarter of the remaining penetration as tolerance, never more than a quarter of the scene's. Pairs that
    hardly penetrate keep theirs."""
    tolerances = (
        {} if scene.is_explicit else {pair: scene.penetration_tolerance(pair) for pair in scene.pairs}
    )
    augmented = [pair for pair, tolerance in tolerances.items() if tolerance > 0.0]
    changes: dict[str, object] = {}
    for pair in scene.pairs:
        if pair not in augmented:
            keys = [k for k in ("Normal penalty", "Tangential penalty") if scene.get(pair + k)]
            changes.update({pair + k: parameters.shown(4.0 * scene.number(pair + k)) for k in keys})
    left = given.penetration if given.penetration >= 0.0 else 4e-3
    deep = [pair for pair in augmented if not given.is_shallow(pair)]
    for pair in deep:
        tried = 0.25 * min(left, tolerances[pair])
        if tried >= LEAST_PENETRATION:
            changes[pair + "Penetration tolerance"] = parameters.shown(tried)
            changes["Solver/Maximum augmentations"] = 100
    if changes:
        label = QUARTER if deep else "four times the penalty"
        return Source("penetration", Variant(label, changes, changes), ratio=4.0, weight=3.0)
    if not augmented:
        return None
    left = min(left, max(tolerances[pair] for pair in augmented))
    return Source(
        "penetration", None, remarks=[f"a depth of {number(left, 2)} facet sizes is too small to reduce"]
    )


def iteration_source(scene: Scene) -> Source:
    changes = parameters.newton_tolerance(0.01 * (scene.number("Solver/Force tolerance") or 1e-6))
    changes = dict(changes)
    paths = ["Solver/Displacement tolerance"]
    if scene.get("Solver/Linear solver") in ("CG", "GMRES"):
        paths.append("Solver/Linear tolerance")
    for path in paths:
        if scene.knows(path) and scene.number(path) > 0:
            changes[path] = parameters.shown(0.01 * scene.number(path))
    return Source(
        "iterations", Variant("a hundredth of the tolerances", changes, changes), ratio=100.0, weight=1.0
    )


def of_bodies(scene: Scene, key: str, is_one: Callable[[str], bool], better: str) -> dict[str, object]:
    """Changes of those bodies whose value is one of those."""
    paths = [f"Bodies/{body}/{key}" for body in scene.names("Bodies")]
    return {path: better for path in paths if is_one(scene.get(path))}


def formulation_sources(scene: Scene) -> list[Source]:
    """Sources that a run takes away."""
    found = []

    def add(name: str, label: str, changes: Changes, weight: float, is_of_mesh: bool = False) -> None:
        if changes:
            variant = Variant(label, changes, changes)
            found.append(Source(name, variant, ratio=math.inf, weight=weight, is_of_mesh=is_of_mesh))

    others = of_bodies(scene, "Element", lambda v: v != "assumed strain", "assumed strain")
    add(ELEMENTS, "elements of assumed strain", others, 3.0, True)
    rates = of_bodies(scene, "Material/Elasticity", lambda v: v == "hypoelastic", "Hencky")
    add("law", "Hencky's law", rates, 1.0)
    if scene.is_explicit:
        path = "Explicit dynamics/Number type"
        add("numbers", "double precision", {path: "double"} if scene.get(path) == "float" else {}, 1.0)
        path = "Explicit dynamics/Mass scaling step"
        add("added mass", "no mass scaling", {path: 0} if scene.number(path) > 0 else {}, 4.0)
    return found


UNKNOWN_GEOMETRY = "the error of its geometry is in that of the mesh, and cannot be told apart"


def moved_pair(before: Mapping[str, Any], after: Mapping[str, Any]) -> str:
    """Returns the first pair whose least gap at the start differs between two scenes by --check; '' if none
    does. A section that grows into its neighbour changes more than its area."""

    def gaps(checked: Mapping[str, Any]) -> dict[str, float]:
        pairs = checked.get("report", {}).get("pairs", [])
        return {pair["name"]: pair["gap"]["least"] for pair in pairs if "least" in pair.get("gap", {})}

    def size(checked: Mapping[str, Any]) -> float:
        bodies = checked.get("report", {}).get("bodies", [])
        return max((b - a for body in bodies for a, b in zip(body["low"], body["high"])), default=1.0)

    new = gaps(after)
    tolerance = 1e-6 * size(before)
    return next((n for n, gap in gaps(before).items() if abs(new.get(n, gap) - gap) > tolerance), "")


def geometry_source(scene: Scene, given: Given) -> Source | None:
    """Returns the source of facets on curved primitives, which cut off volume. An extruded section can be
    scaled to the area of the smooth one; for others only the volume is reported."""
    changes: dict[str, object] = {}
    remarks = []
    for body in given.checked.get("report", {}).get("bodies", []):
        name, smooth = body["name"], body.get("smooth volume")
        mesh = f"Bodies/{name}/Mesh/"
        if smooth is None:
            if scene.get(mesh + "Source") == "file":
                remarks.append(
                    f"finer levels of the mesh file of '{name}' keep its facets, whose error is not told"
                )
            continue
        lacks = 1.0 - body["volume"] / smooth
        height = scene.number(mesh + "Height") if scene.knows(mesh + "Height") else 0.0
        if abs(lacks) < 1e-6:
            if scene.number(mesh + "Section area") > 0:
                remarks.append(f"'{name}' has the volume of the smooth shape; {UNKNOWN_GEOMETRY} otherwise")
        elif scene.get(mesh + "Source") == "extruded primitive" and height > 0:
            changes[mesh + "Section area"] = f"{smooth / height:.12g}"
        else:
            size = f"{100.0 * abs(lacks):.2g} % too {'small' if lacks > 0 else 'large'}"
            remarks.append(f"facets make '{name}' {size}; {UNKNOWN_GEOMETRY}")
    if not changes and not remarks:
        return None
    variant = Variant("the area of the smooth section", changes, changes) if changes else None
    return Source(GEOMETRY, variant, ratio=math.inf, weight=3.0, remarks=remarks)


def sources_of(scene: Scene, given: Given) -> list[Source]:
    """Returns all sources of the scene. Runs other than those of the steps share the steps of the scene."""
    optional = [penetration_source(scene, given), None if scene.is_explicit else iteration_source(scene)]
    found = [mesh_source(scene), geometry_source(scene, given), step_source(scene, given), *optional]
    present = [source for source in found if source is not None] + formulation_sources(scene)
    shared = same_steps(scene, given.times)
    for source in present:
        if source.name == "steps":
            continue
        for side in ("finer", "coarser"):
            variant = getattr(source, side)
            if variant is not None:
                setattr(source, side, variant._replace(changes={**shared, **variant.changes}))
    return present
