# SPDX-License-Identifier: LGPL-2.1-or-later
"""Scenes of the benchmark silent-errors, by families, each with its references."""

from __future__ import annotations

import math
from typing import Any, Sequence

import numpy

from silent_errors_runs import (
    OF_THE_MESH,
    Case,
    Judge,
    Kept,
    Reference,
    Sections,
    force_at,
    force_curve,
    impulse,
)
from billet_tools.output import Array

# Settings of references: as good as exact, in small steps.
EXACT = {
    "Force tolerance": 1e-5,
    "Energy tolerance": 1e-9,
    "Displacement tolerance": 1e-3,
    "Contact tangent": "exact",
}


def box(counts: Sequence[int], low: Sequence[float], high: Sequence[float], **more: Any) -> Sections:
    corners = " : ".join(", ".join(f"{x:.12g}" for x in corner) for corner in (low, high))
    return {
        "Primitive": "subdivided_hyper_rectangle",
        "Arguments": f"{', '.join(map(str, counts))} : {corners} : true",
        **more,
    }


def elastic(young: float, poisson: float = 0.3, **more: Any) -> dict[str, Any]:
    return {"Law": "elastic", "Young modulus": young, "Poisson ratio": poisson, **more}


def stepping(end: float, initial: float | None = None, largest: float | None = None, **more: Any) -> Sections:
    return {
        "End time": f"{end:.12g}",
        "Initial step": initial and f"{initial:.12g}",
        "Maximum step": largest and f"{largest:.12g}",
        **more,
    }


QUIET = {"Folder": "results", "Format": "none", "Verbosity": "quiet"}
ONE_PICTURE = {"Folder": "results", "Step interval": 0, "Verbosity": "quiet"}


# --- bending: a strip between a roll that supports it and one that presses it down ----------------


def strip(
    along: int,
    through: int,
    element: str,
    law: str,
    radius: float,
    penalty: float | None = None,
    tangent: str | None = None,
    search: str | None = None,
    initial: float | None = None,
    largest: float | None = None,
    travel: float = 8.0,
    solver: Sections | None = None,
) -> Sections:
    material = elastic(200000)
    if law == "plastic":
        material = {**material, "Law": "elastoplastic", "Yield stress": 400, "Hardening modulus": 2000}
    pair = {"Body": "strip", "Normal penalty": penalty}
    return {
        "Bodies": {
            "strip": {
                "Element": element,
                "Symmetry planes": "x = 0 ; y = 0 ; y = 1",
                "Mesh": box((along, 1, through), (0, 0, -0.5), (60, 1, 0.5)),
                "Material": material,
            }
        },
        "Tools": {
            "support": {
                "Surfaces": {
                    "roll": {
                        "Shape": "cylinder",
                        "Point": f"50, 0, {-0.5 - radius:g}",
                        "Axis": "0, 1, 0",
                        "Radius": radius,
                    }
                }
            },
            "punch": {
                "Surfaces": {
                    "roll": {
                        "Shape": "cylinder",
                        "Point": f"0, 0, {0.5 + radius:g}",
                        "Axis": "0, 1, 0",
                        "Radius": radius,
                    }
                },
                "Motion": {"Translation": f"0 ; 0 ; -{travel:g}*t"},
            },
        },
        "Contact pairs": {
            "on support": {**pair, "Boundary ids": 4, "Tool": "support"},
            "under punch": {**pair, "Boundary ids": 5, "Tool": "punch"},
        },
        "Time stepping": stepping(1, initial, largest),
        "Solver": {"Contact tangent": tangent, "Line search": search, **(solver or {})},
        "Output": QUIET,
    }


BENDING_NUMERICS: dict[str, dict[str, Any]] = {
    "default": {},
    "no line search": {"search": "none"},
    "steps of 1": {"initial": 1, "largest": 1},
    "steps of 0.3": {"initial": 0.3, "largest": 0.3},
    "penalty 0.1": {"penalty": 0.1},
    "penalty 1": {"penalty": 1},
    "penalty 100": {"penalty": 100},
    "exact": {"tangent": "exact"},
    "consistent": {"tangent": "consistent"},
    "continuum": {"tangent": "continuum"},
    "upper": {"tangent": "symmetrised upper"},
    "lower": {"tangent": "symmetrised lower", "search": "none"},
    "mean": {"tangent": "symmetrised mean", "largest": 1},
}


def bending() -> list[Case]:
    meshes = [(6, 1), (6, 2), (12, 1), (12, 2), (24, 4), (30, 2), (60, 1), (60, 2), (60, 4)]
    elements, radii = ("assumed strain", "one point", "mean dilatation"), (5, 1, 20, 50, 2, 10)
    cases = []
    for i, (along, through) in enumerate(meshes):
        for j, law in enumerate(("elastic", "plastic")):
            element, radius = elements[(i + j) % 3], radii[(2 * i + 3 * j + i // 3) % 6]
            settings: dict[str, Any] = dict(
                along=along, through=through, element=element, law=law, radius=radius
            )
            near = Reference(
                strip(**settings, penalty=300, initial=0.01, largest=0.02, solver=EXACT),
                strip(**settings, penalty=1000, initial=0.005, largest=0.01, solver=EXACT),
                frozenset(OF_THE_MESH),
                force_curve(["punch"]),
            )
            fine: dict[str, Any] = dict(
                along=120, through=4, element="one point", law=law, radius=radius, penalty=50
            )
            far = Reference(
                strip(**fine, initial=0.01, largest=0.02, solver=EXACT),
                None,
                frozenset(),
                force_curve(["punch"]),
                0.1,
                "fine mesh",
            )
            cases += [
                Case(
                    "bending",
                    f"{along} x {through} bricks, {element}, {law}, radius {radius}, {name}",
                    strip(**settings, **numerics),
                    (near, far),
                )
                for name, numerics in BENDING_NUMERICS.items()
            ]
    return cases


# --- blocks pressed into each other ---------------------------------------------------------------


def blocks(
    lower: int,
    upper: int,
    gap: float,
    slave: str,
    friction: float,
    press: float,
    initial: float | None = None,
    largest: float | None = None,
    penalty: float | None = None,
    end: float = 1.0,
    solver: Sections | None = None,
    spread: float = 0.5,
) -> Sections:
    sides = {"lower": ("lower", 5), "upper": ("upper", 4)}
    first, second = sides[slave], sides["upper" if slave == "lower" else "lower"]
    return {
        "Bodies": {
            "lower": {
                "Mesh": box((lower,) * 3, (-1, -1, -2), (1, 1, 0)),
                "Supports": {"base": {"Boundary ids": 4}},
                "Material": elastic(100),
            },
            "upper": {
                "Mesh": box((upper,) * 3, (-spread, -spread, gap), (spread, spread, gap + 1)),
                "Material": elastic(1000),
                "Supports": {
                    "top": {"Boundary ids": 5, "Displacement": f"0 ; 0 ; -{(gap + press) / end:.12g}*t"}
                },
            },
        },
        "Contact pairs": {
            "face": {
                "Body": first[0],
                "Boundary ids": first[1],
                "Second body": second[0],
                "Second boundary ids": second[1],
                "Friction coefficient": friction or None,
                "Normal penalty": penalty,
            }
        },
        "Time stepping": stepping(end, initial, largest),
        "Solver": solver or {},
        "Output": QUIET,
    }


BLOCK_NUMERICS: dict[str, dict[str, Any]] = {
    "default": {},
    "steps of 1": {"initial": 1, "largest": 1},
    "steps of 0.1 to 1": {"initial": 0.1, "largest": 1},
    "steps of 0.3": {"initial": 0.3, "largest": 0.3},
    "steps of 0.01 to 0.5": {"initial": 0.01, "largest": 0.5},
    "steps of 0.03": {"initial": 0.03, "largest": 0.03},
    "penalty 1": {"penalty": 1},
    "penalty 30": {"penalty": 30},
    "penalty 100": {"penalty": 100},
}


def pressed_blocks() -> list[Case]:
    meshes, gaps, presses, frictions = (
        [(4, 3), (4, 2), (3, 4), (5, 5)],
        (0, 0.1, 1, 3, 10),
        (0.1, 0.3, 0.5, 0.8),
        (0, 0.1, 0.3, 0.5),
    )
    cases = []
    for i in range(26):
        settings: dict[str, Any] = dict(
            lower=meshes[i % 4][0],
            upper=meshes[i % 4][1],
            slave=("upper", "lower")[(i // 2) % 2],
            friction=frictions[(i + i // 4) % 4],
            press=presses[(i // 3 + i) % 4],
        )
        gap = gaps[i % 5]

        def clock(time: Array, gap: float = gap, press: float = settings["press"]) -> Array:
            return ((gap + press) * time - gap) / press

        said = ", ".join(f"{key} {value}" for key, value in settings.items())
        left_out = ("penalty 1", "penalty 30", "penalty 100")[i % 3]
        for name, numerics in BLOCK_NUMERICS.items():
            if name == left_out:
                continue
            # The limit of high penalties depends on the mesh where a facet reaches over a rim: the penalty is
            # the run's own.
            stiff: dict[str, Any] = {
                **settings,
                "gap": 0,
                "penalty": numerics.get("penalty"),
                "solver": EXACT,
            }
            near = Reference(
                blocks(**stiff, initial=0.01, largest=0.02),
                blocks(**stiff, initial=0.005, largest=0.01),
                frozenset(OF_THE_MESH),
                force_curve(["face"], clock),
            )
            cases.append(
                Case("blocks", f"{said}, gap {gap}, {name}", blocks(**settings, gap=gap, **numerics), (near,))
            )
    return cases


# --- flights in implicit dynamics -----------------------------------------------------------------

TARGETS = {
    "held plate of 0.2": ((3, 3, 1), (3, 3, 0.2), True),
    "free plate of 0.2": ((3, 3, 1), (1.5, 1.5, 0.2), False),
    "free block of 1": ((2, 2, 2), (1, 1, 1), False),
    "held sheet of 0.05": ((6, 6, 1), (1.5, 1.5, 0.05), True),
}
FLIERS = {"cube of 0.5": ((2, 2, 2), (0.5, 0.5, 0.5)), "tile of 0.05": ((2, 2, 1), (0.5, 0.5, 0.05))}
FLIGHT_NUMERICS: dict[str, dict[str, Any]] = {
    "default": {},
    "steps up to the end": {"largest": 1.0},
    "first step of the whole flight": {"initial": 1.0, "largest": 1.0},
    "by iterations alone, steps up to 0.3": {"largest": 0.3, "tolerance": 0},
}


def flight(
    target: str,
    flier: str,
    speed: float,
    oblique: float,
    spin: float,
    distance: float,
    after: float,
    slave: str,
    faces: str,
    tilt: float = 0.0,
    initial: float | None = None,
    largest: float | None = None,
    tolerance: float | None = None,
    fixed: float | None = None,
) -> Sections:
    """The flier comes from above. `tilt`: its angle about y when it would touch the undeformed target;
    `spin`: in radians over a flight of its own size; `initial` and `largest` are parts of the run."""
    counts, size, is_held = TARGETS[target]
    f_counts, f_size = FLIERS[flier]
    reach = 0.5 * (
        f_size[0] * abs(math.sin(math.radians(tilt))) + f_size[2] * abs(math.cos(math.radians(tilt)))
    )
    time, rate = distance / speed, spin * speed / f_size[0]
    centre = (-oblique * distance, 0.0, reach + distance)
    end = time + after
    angle = tilt - math.degrees(rate * time)
    half, f_half = [0.5 * x for x in size], [0.5 * x for x in f_size]
    velocity = f"{oblique * speed:.12g}" + (f" + {rate:.12g}*(z - {centre[2]:.12g})" if rate else "")
    fall = f"{-speed:.12g}" + (f" - {rate:.12g}*(x - {centre[0]:.12g})" if rate else "")
    solid = elastic(1000, 0.3, Density=1e-3)
    bodies = {
        "target": {
            "Mesh": box(counts, (-half[0], -half[1], -size[2]), (half[0], half[1], 0)),
            "Material": solid,
            "Supports": {"rim": {"Boundary ids": "0, 1, 2, 3"}} if is_held else {},
        },
        "flier": {
            "Mesh": box(
                f_counts,
                [-x for x in f_half],
                f_half,
                **{
                    "Rotation axis": "0, 1, 0",
                    "Rotation angle": f"{angle:.12g}",
                    "Translation": ", ".join(f"{x:.12g}" for x in centre),
                },
            ),
            "Material": solid,
            "Initial velocity": f"{velocity} ; 0 ; {fall}",
        },
    }
    names = ("flier", "target") if slave == "flier" else ("target", "flier")
    every = "0, 1, 2, 3, 4, 5"
    ids = {"all": {"flier": every, "target": every}, "facing": {"flier": "0, 1, 4", "target": "5"}}[faces]
    steps = (
        stepping(end, initial and initial * end, largest and largest * end)
        if not fixed
        else {"End time": f"{end:.12g}", "Step control": "fixed", "Initial step": f"{fixed:.12g}"}
    )
    return {
        "Bodies": bodies,
        "Contact pairs": {
            "face": {
                "Body": names[0],
                "Boundary ids": ids[names[0]],
                "Second body": names[1],
                "Second boundary ids": ids[names[1]],
            }
        },
        "Time stepping": {"Scheme": "implicit dynamics", **steps},
        "Implicit dynamics": {"Error tolerance": tolerance},
        "Output": ONE_PICTURE,
    }


def flights() -> list[Case]:
    cases = []
    for i in range(28):
        target, flier = list(TARGETS)[i % 4], list(FLIERS)[(i // 4) % 2]
        thickness = min(TARGETS[target][1][2], FLIERS[flier][1][2])
        settings: dict[str, Any] = dict(
            target=target,
            flier=flier,
            speed=(10, 1, 30)[i % 3],
            oblique=(0, 0.5, 0, 1)[(i // 2) % 4],
            spin=(0, 0, 1)[(i // 3) % 3],
            tilt=(0, 20, 0, 45, 10)[i % 5],
            slave=("flier", "target")[(i // 2) % 2],
            faces=("all", "facing")[(i // 4) % 2 ^ i % 2],
        )
        far, near, after = 100 * thickness, 0.004 * settings["speed"] ** 0.5, 0.03
        step = 2e-5 if settings["speed"] > 1 else 4e-5
        start = [settings["oblique"] * settings["speed"], 0, -settings["speed"]]
        reference = Reference(
            flight(**settings, distance=near, after=after, fixed=step),
            flight(**settings, distance=near, after=after, fixed=step / 2),
            frozenset(OF_THE_MESH),
            impulse("1", start),
        )
        said = ", ".join(f"{key} {value}" for key, value in settings.items())
        cases += [
            Case(
                "flights",
                f"{said}, {name}",
                flight(**settings, distance=far, after=after, **numerics),
                (reference,),
            )
            for name, numerics in FLIGHT_NUMERICS.items()
        ]
    return cases


# --- ironing: a rounded elastic die, pressed into a soft slab and drawn along it ------------------


def ironing_scene(
    slave: str,
    largest: float | None,
    penalty: float | None,
    initial: float | None = None,
    solver: Sections | None = None,
) -> Sections:
    sides = {"die": ("die", "4"), "slab": ("slab", "5")}
    first, second = sides[slave], sides["slab" if slave == "die" else "die"]
    return {
        "Amplitudes": {
            "down": {"Times": "0, 1", "Values": "0, -0.6"},
            "along": {"Times": "1, 2", "Values": "0, 4"},
        },
        "Bodies": {
            "slab": {
                "Mesh": box((24, 1, 4), (0, 0, 0), (12, 0.5, 3)),
                "Symmetry planes": "y = 0 ; y = 0.5",
                "Supports": {"base": {"Boundary ids": 4}},
                "Material": elastic(100),
            },
            "die": {
                "Mesh": box(
                    (8, 1, 3),
                    (-2, 0, 0),
                    (2, 0.5, 1.5),
                    Positions="x + 4 ; y ; 3 + z + (1 - z/1.5)*(4 - sqrt(16 - x^2))",
                ),
                "Symmetry planes": "y = 0 ; y = 0.5",
                "Material": elastic(1000),
                "Supports": {"top": {"Boundary ids": 5, "Displacement": "along ; 0 ; down"}},
            },
        },
        "Contact pairs": {
            "face": {
                "Body": first[0],
                "Boundary ids": first[1],
                "Second body": second[0],
                "Second boundary ids": second[1],
                "Friction coefficient": 0.3,
                "Normal penalty": penalty,
            }
        },
        "Time stepping": stepping(2, initial, largest, Stops=1),
        "Solver": solver or {},
        "Output": QUIET,
    }


def ironing() -> list[Case]:
    cases = []
    for slave in ("die", "slab"):
        for i in range(30):
            largest, penalty = (
                round(0.02 * 15 ** (i / 29), 4),
                (10, 30, 100, 1000)[(i + (slave == "slab")) % 4],
            )
            near = Reference(
                ironing_scene(slave, 0.02, penalty, 0.01, EXACT),
                ironing_scene(slave, 0.01, penalty, 0.01, EXACT),
                frozenset(OF_THE_MESH),
                force_curve(["face"]),
                0.05,
            )
            cases.append(
                Case(
                    "ironing",
                    f"slave {slave}, steps of {largest}, penalty {penalty}",
                    ironing_scene(slave, largest, penalty, min(largest, 0.1)),
                    (near,),
                )
            )
    return cases


# --- penalties: slabs and blocks, pressed ---------------------------------------------------------


def pressed(shape: str, second: Any, scheme: str, penalty: float | None) -> Sections:
    """Returns a scene of a body pressed on a plane, or on another of its kind, by a hundredth of its height.
    Without a Poisson ratio the stress is uniform."""
    counts, size = {"slab": ((4, 4, 1), (4, 4, 0.05)), "block": ((3, 3, 3), (1, 1, 1))}[shape]
    solid = elastic(1000, 0.0, Density=None if scheme == "quasi-static" else 1e-3)
    height = size[2]
    bodies = {
        "upper": {
            "Mesh": box(counts, (0, 0, 0), size),
            "Material": solid,
            "Supports": {
                "top": {
                    "Boundary ids": 5,
                    "Displacement": f"0 ; 0 ; {-0.01 * height * (2 if second else 1):g}*a",
                }
            },
        }
    }
    pair = {"Body": "upper", "Boundary ids": 4, "Normal penalty": penalty}
    scene = {
        "Amplitudes": {"a": {"Times": "0, 0.1", "Values": "0, 1", "Interpolation": "smooth"}},
        "Bodies": bodies,
    }
    if second:
        bodies["lower"] = {
            "Mesh": box(counts, (0, 0, -height), (*size[:2], 0)),
            "Material": solid,
            "Supports": {"base": {"Boundary ids": 4}},
        }
        pair |= {"Second body": "lower", "Second boundary ids": 5}
    else:
        scene["Tools"] = {"floor": {"Surfaces": {"face": {"Shape": "plane"}}}}
        pair["Tool"] = "floor"
    return {
        **scene,
        "Contact pairs": {"c": pair},
        "Time stepping": {"Scheme": scheme, "End time": 0.15},
        "Output": QUIET,
    }


def held_force(name: str, exact: float) -> Judge:
    """Mean force of the last tenth of the run."""

    def judge(run: Kept, _: Kept | None, same_clock: bool = False) -> float:
        held = run.history["time"] > 0.9 * run.history["time"][-1]
        return abs(float(numpy.linalg.norm(run.force(name)[held].mean(axis=0))) / exact - 1)

    return judge


def penalties() -> list[Case]:
    cases = []
    for shape, area in (("slab", 16), ("block", 1)):
        for second in (False, True):
            exact = -1000 * area * math.log(0.99) / 0.99
            for scheme in ("quasi-static", "implicit dynamics", "explicit"):
                for i in range(13):
                    penalty = (0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000, 3000, 10000)[i]
                    form = Reference(
                        None,
                        None,
                        frozenset(OF_THE_MESH),
                        held_force("c" if second else "floor", exact),
                        0.05,
                        "closed form",
                    )
                    cases.append(
                        Case(
                            "penalties",
                            f"{shape} on a {'body' if second else 'plane'}, {scheme}, penalty {penalty}",
                            pressed(shape, second, scheme, penalty),
                            (form,),
                        )
                    )
    return cases


# --- stacks: plates clamped by friction -----------------------------------------------------------


def stack(
    plates: int,
    motion: str,
    friction: float,
    penalty: float | None = None,
    initial: float | None = None,
    largest: float | None = None,
    tolerance: float | None = None,
    profile: str | None = None,
    solver: Sections | None = None,
) -> Sections:
    shear = {
        "sheared": "0.1*{n}*slide ; 0 ; -0.01*{n}*press",
        "twisted": "-0.03*(y - 3)*{n}*slide ; 0.03*(x - 6)*{n}*slide ; -0.01*{n}*press",
    }[motion]
    counts = [(6, 3, 1), (8, 4, 1), (7, 3, 1), (6, 4, 1), (8, 3, 1)]
    bodies, pairs = {}, {}
    for i in range(plates):
        head: dict[str, Any] = {"Boundary ids": 5, "Displacement": shear.format(n=plates)}
        bodies[f"p{i}"] = {
            "Mesh": box(counts[i], (0, 0, i), (12, 6, i + 1)),
            "Material": elastic(1000),
            "Supports": (
                {"foot": {"Boundary ids": 4}} if i == 0 else ({"head": head} if i == plates - 1 else {})
            ),
        }
        if i:
            # One face slides first.
            pairs[f"f{i}"] = {
                "Body": f"p{i - 1}",
                "Boundary ids": 5,
                "Second body": f"p{i}",
                "Second boundary ids": 4,
                "Normal penalty": penalty,
                "Penetration tolerance": tolerance,
                "Friction coefficient": f"{friction * (1 if i == plates - 1 else 1.5):g}",
            }
    return {
        "Profile": profile,
        "Amplitudes": {
            "press": {"Times": "0, 1, 3", "Values": "0, 1, 1"},
            "slide": {"Times": "0, 1, 2, 3", "Values": "0, 0, 1, -1"},
        },
        "Bodies": bodies,
        "Contact pairs": pairs,
        "Time stepping": stepping(2.5, initial, largest),
        "Solver": solver or {},
        "Output": QUIET,
    }


STACK_NUMERICS: dict[str, dict[str, Any]] = {
    "default": {},
    "steps of 1": {"initial": 1, "largest": 1},
    "steps of 0.1": {"initial": 0.1, "largest": 0.1},
    "penalty 1": {"penalty": 1},
    "penalty 100": {"penalty": 100},
    "augmented": {"tolerance": 1e-3},
    "accurate": {"profile": "accurate"},
}


def stacks() -> list[Case]:
    cases = []
    for plates in (2, 3, 4, 5):
        for j, motion in enumerate(("sheared", "twisted")):
            settings: dict[str, Any] = dict(
                plates=plates, motion=motion, friction=(0.1, 0.3)[(plates + j) % 2]
            )
            near = Reference(
                stack(**settings, penalty=100, initial=0.02, largest=0.1, solver=EXACT),
                stack(**settings, penalty=300, initial=0.02, largest=0.05, solver=EXACT),
                frozenset(OF_THE_MESH),
                force_at([f"f{plates - 1}"], (1, 2, 2.5)),
                0.05,
            )
            said = ", ".join(f"{key} {value}" for key, value in settings.items())
            cases += [
                Case("stacks", f"{said}, {name}", stack(**settings, **numerics), (near,))
                for name, numerics in STACK_NUMERICS.items()
            ]
    return cases


# --- tools that turn ------------------------------------------------------------------------------


def turning(
    shape: str,
    turns: float,
    friction: float,
    initial: float | None = None,
    largest: float | None = None,
    solver: Sections | None = None,
) -> Sections:
    surface, axis, press = {
        "plane on a ring": ({"Shape": "plane", "Point": "0, 0, 4", "Normal": "0, 0, -1"}, "0, 0, 1", 0.04),
        "ball on a block": ({"Shape": "sphere", "Centre": "0, 0, 14", "Radius": 10}, "0, 0, 1", 0.3),
        "roll on a block": (
            {"Shape": "cylinder", "Point": "0, 0, 14", "Axis": "0, 1, 0", "Radius": 10},
            "0, 1, 0",
            0.2,
        ),
    }[shape]
    if shape == "plane on a ring":
        mesh: Sections = {
            "Source": "extruded primitive",
            "Primitive": "hyper_shell",
            "Arguments": "0, 0 : 5 : 8 : 32 : false",
            "Height": 4,
            "Layers": 3,
        }
        foot, top = 1, 2
    else:
        mesh, foot, top = box((10, 10, 3), (-4, -4, 0), (4, 4, 4)), 4, 5
    return {
        "Amplitudes": {
            "p": {"Times": "0, 1, 2", "Values": "0, 1, 1"},
            "w": {"Times": "0, 1, 2", "Values": "0, 0, 1"},
        },
        "Bodies": {"b": {"Mesh": mesh, "Material": elastic(1000), "Supports": {"f": {"Boundary ids": foot}}}},
        "Tools": {
            "t": {
                "Surfaces": {"p": surface},
                "Motion": {
                    "Translation": f"0 ; 0 ; -{press:g}*p",
                    "Rotation angle": f"{2 * math.pi * turns:.12g}*w",
                    "Rotation axis": axis,
                    "Centre": "0, 0, 14" if shape != "plane on a ring" else None,
                },
            }
        },
        "Contact pairs": {
            "c": {"Body": "b", "Boundary ids": top, "Tool": "t", "Friction coefficient": friction}
        },
        "Time stepping": stepping(2, initial, largest),
        "Solver": solver or {},
        "Output": QUIET,
    }


def last_wrench(name: str) -> Judge:
    """Force and moment at the end."""

    def judge(run: Kept, reference: Kept, same_clock: bool = False) -> float:
        def end(of: Kept, kind: str) -> Any:
            return numpy.array([of.history[f"{name}.{kind}_{axis}"][-1] for axis in "xyz"])

        return max(
            float(
                numpy.linalg.norm(end(run, kind) - end(reference, kind))
                / numpy.linalg.norm(end(reference, kind))
            )
            for kind in ("force", "moment")
        )

    return judge


def turning_tools() -> list[Case]:
    cases = []
    for shape in ("plane on a ring", "ball on a block", "roll on a block"):
        for friction in (0.1, 0.4):
            # Once all slides, forces stay: a quarter of a turn is enough.
            near = Reference(
                turning(shape, 0.25, friction, 0.02, 0.02, EXACT),
                turning(shape, 0.25, friction, 0.01, 0.01, EXACT),
                frozenset(OF_THE_MESH),
                last_wrench("t"),
            )
            cases += [
                Case(
                    "turning tools",
                    f"{shape}, friction {friction}, {turns} turns",
                    turning(shape, turns, friction),
                    (near,),
                )
                for turns in (0.1, 0.25, 0.5, 0.75, 1, 1.5, 2, 4.5, 5, 9.7, 10, 20)
            ]
    return cases


# --- removal of tools -----------------------------------------------------------------------------


def without_tool(
    scene: Sections, tool: str, at: Any, end: float, release: float | None, largest: float | None
) -> Sections:
    """The scene, whose tool presses until `at` and is gone afterwards."""
    motion = scene["Tools"][tool]["Motion"]
    return {
        **scene,
        "Tools": {
            **scene["Tools"],
            tool: {**scene["Tools"][tool], "Motion": {**motion, "Removal time": at, "Release time": release}},
        },
        "Time stepping": stepping(end, None, largest),
    }


def dented(law: str, friction: float) -> Sections:
    """A block with a ball pressed into it."""
    material = (
        elastic(1000)
        if law == "elastic"
        else {**elastic(70000), "Law": "elastoplastic", "Yield stress": 150, "Hardening modulus": 500}
    )
    return {
        "Amplitudes": {"p": {"Times": "0, 1", "Values": "0, 1"}},
        "Bodies": {
            "b": {
                "Mesh": box((8, 8, 4), (-2, -2, 0), (2, 2, 2)),
                "Material": material,
                "Supports": {"base": {"Boundary ids": 4}},
            }
        },
        "Tools": {
            "punch": {
                "Surfaces": {"s": {"Shape": "sphere", "Centre": "0, 0, 6", "Radius": 4}},
                "Motion": {"Translation": "0 ; 0 ; -0.4*p"},
            }
        },
        "Contact pairs": {
            "c": {"Body": "b", "Boundary ids": 5, "Tool": "punch", "Friction coefficient": friction or None}
        },
        "Output": QUIET,
    }


def bent(law: str, element: str, friction: float) -> Sections:
    scene = strip(30, 2, element, law, 5)
    scene["Amplitudes"] = {"p": {"Times": "0, 1", "Values": "0, 1"}}
    scene["Tools"]["punch"]["Motion"]["Translation"] = "0 ; 0 ; -8*p"
    for pair in scene["Contact pairs"].values():
        pair["Friction coefficient"] = friction or None
    return scene


def clamped(law: str, friction: float) -> Sections:
    """Two plates, pressed onto each other by a tool."""
    material = (
        elastic(1000)
        if law == "elastic"
        else {**elastic(1000), "Law": "elastoplastic", "Yield stress": 5, "Hardening modulus": 50}
    )
    return {
        "Amplitudes": {"p": {"Times": "0, 1", "Values": "0, 1"}},
        "Bodies": {
            "low": {
                "Mesh": box((6, 3, 1), (0, 0, 0), (12, 6, 1)),
                "Material": material,
                "Supports": {"foot": {"Boundary ids": 4}},
            },
            "top": {"Mesh": box((6, 4, 1), (0, 0, 1), (12, 6, 2)), "Material": material},
        },
        "Tools": {
            "punch": {
                "Surfaces": {"s": {"Shape": "sphere", "Centre": "6, 3, 12", "Radius": 10}},
                "Motion": {"Translation": "0.05*p ; 0 ; -0.2*p"},
            }
        },
        "Contact pairs": {
            "a": {
                "Body": "low",
                "Boundary ids": 5,
                "Second body": "top",
                "Second boundary ids": 4,
                "Friction coefficient": friction,
            },
            "c": {"Body": "top", "Boundary ids": 5, "Tool": "punch", "Friction coefficient": friction},
        },
        "Output": QUIET,
    }


def springback(at: Any) -> Judge:
    """Plastic work that appears after the removal of a tool, or elastic energy beyond what there was,
    relative to both before it."""

    def judge(run: Kept, _: Kept | None, same_clock: bool = False) -> float:
        time, plastic, stored = (run.history[name] for name in ("time", "plastic_work", "elastic_energy"))
        before = int(numpy.searchsorted(time, at * (1 + 1e-9))) - 1
        energy = plastic[before] + stored[before]
        late = slice(before + 1, None)
        return (
            max(
                0.0,
                float(plastic[late].max() - plastic[before]) / energy,
                float(stored[late].max() - stored[before]) / energy,
                float(stored[-1]) / energy if plastic[before] < 1e-9 * energy else 0.0,
            )
            if len(time) > before + 1
            else math.nan
        )

    return judge


def removals() -> list[Case]:
    scenes = {
        f"strip, {law}, {element}, friction {friction}": bent(law, element, friction)
        for law, element, friction in (
            ("elastic", "assumed strain", 0),
            ("plastic", "one point", 0.1),
            ("plastic", "assumed strain", 0),
        )
    }
    scenes |= {
        f"dented block, {law}, friction {friction}": dented(law, friction)
        for law, friction in (("elastic", 0), ("plastic", 0), ("plastic", 0.3))
    }
    scenes |= {
        f"clamped plates, {law}, friction {friction}": clamped(law, friction)
        for law, friction in (("elastic", 0.3), ("plastic", 0.2))
    }
    cases = []
    for name, scene in scenes.items():
        for i, release in enumerate((None, 0.02, 0.2, 0.5)):
            for largest in (None, (0.02, 0.3)[i % 2]):
                form = Reference(
                    None, None, frozenset(OF_THE_MESH), springback(1), 0.05, "no work without the tool"
                )
                cases.append(
                    Case(
                        "removal",
                        f"{name}, release time {release or 0}, steps of {largest or 'default'}",
                        without_tool(scene, "punch", 1, 2, release, largest),
                        (form,),
                    )
                )
    return cases


# --- explicit: balls, edges -----------------------------------------------------------------------


def plate_and_ball(radius: float, x: float, y: float, speed: float, refined: int = 1) -> Sections:
    """A free plate of facets of 1 x 1. Time until the ball has gone through, had there been no plate."""
    n = 4 * refined
    gap = 0.01
    return {
        "Bodies": {
            "A": {
                "Mesh": box((n, n, refined), (-2, -2, 0), (2, 2, 0.3)),
                "Material": elastic(1000, Density=1e-3),
            }
        },
        "Tools": {
            "ball": {
                "Surfaces": {
                    "p": {"Shape": "sphere", "Centre": f"{x}, {y}, {0.3 + radius + gap:g}", "Radius": radius}
                },
                "Motion": {"Force": 0, "Force direction": "0, 0, -1", "Mass": 1e-3, "Initial speed": speed},
            }
        },
        "Contact pairs": {"c": {"Body": "A", "Boundary ids": "0, 1, 2, 3, 4, 5", "Tool": "ball"}},
        "Time stepping": {"Scheme": "explicit", "End time": f"{0.005 + 0.6 / speed:.6g}"},
        "Output": QUIET,
    }


def plate_and_edge(second: Any, y: float, z: float, angle: float, speed: float, refined: int = 1) -> Sections:
    """A plate that flies with its edge ahead at a box, or at the edge of another plate."""
    solid = elastic(1000, Density=1e-3)
    slope = math.tan(math.radians(angle))
    x = 2.02 + 0.05 * abs(slope) - slope * (0.05 - z)
    flier = {
        "Initial velocity": f"{-speed} ; 0 ; 0",
        "Material": solid,
        "Mesh": box(
            (4 * refined, refined, 4 * refined),
            (0, 0, -2),
            (4, 0.1, 2),
            **{
                "Rotation axis": "0, 1, 0",
                "Rotation angle": angle,
                "Translation": f"{x:.6g}, {y}, {z}",
            },
        ),
    }
    scene: dict[str, Any] = {
        "Bodies": {"A": flier},
        "Time stepping": {"Scheme": "explicit", "End time": f"{0.01 + 0.8 / speed:.6g}"},
        "Output": ONE_PICTURE,
    }
    pair = {"Body": "A", "Boundary ids": "0, 1, 2, 3, 4, 5"}
    if second:
        scene["Bodies"]["B"] = {
            "Mesh": box((4 * refined, 4 * refined, refined), (-2, -2, 0), (2, 2, 0.1)),
            "Material": solid,
        }
        pair |= {"Second body": "B", "Second boundary ids": "0, 1, 2, 3, 4, 5"}
    else:
        scene["Tools"] = {
            "box": {
                "Surfaces": {
                    "p": {
                        "Shape": "extruded profile",
                        "Corners": "-2, 0 ; 2, 0 ; 2, 0.1 ; -2, 0.1 ; -2, 0",
                        "Outside": "right",
                        "Axis": "0, -1, 0",
                        "Direction": "1, 0, 0",
                        "Length": 4,
                    }
                }
            }
        }
        pair["Tool"] = "box"
    return {**scene, "Contact pairs": {"c": pair}}


def received(axis: str) -> Judge:
    """Momentum of all bodies at the end, along an axis."""

    def judge(run: Kept, reference: Kept, same_clock: bool = False) -> float:
        a, b = (
            r.history[f"momentum_{axis}"][-1] - r.history[f"momentum_{axis}"][0] for r in (run, reference)
        )
        return abs(a - b) / abs(b)

    return judge


def slowed(tool: str, speed: float) -> Judge:
    """Velocity of a tool that fell with this speed, in the last tenth of the run, relative to its change in
    the reference."""

    def judge(run: Kept, reference: Kept, same_clock: bool = False) -> float:
        def end(of: Kept) -> Any:
            late = of.history["time"] > 0.9 * of.history["time"][-1]
            time, way = of.history["time"][late], of.history[f"{tool}.travel_z"][late]
            return (way[-1] - way[0]) / (time[-1] - time[0])

        return abs(end(run) - end(reference)) / abs(end(reference) + speed)

    return judge


def explicit() -> list[Case]:
    cases = []
    points = [(0, 0), (0.5, 0), (0.5, 0.5), (0.25, 0.25), (0.3, 0.7), (0.9, 0.5), (0.97, 0.02)]
    for i, radius in enumerate((0.1, 0.3, 0.6, 1, 2)):
        for j, (x, y) in enumerate(points):
            speed = (50, 10, 150, 300)[(i + j) % 4]
            fine = Reference(
                plate_and_ball(radius, x, y, speed, 4),
                plate_and_ball(radius, x, y, speed, 6),
                frozenset(),
                slowed("ball", speed),
                0.1,
                "fine mesh",
            )
            cases.append(
                Case(
                    "explicit",
                    f"ball of radius {radius} at ({x}, {y}), {speed / 1000:g} of the wave speed",
                    plate_and_ball(radius, x, y, speed),
                    (fine,),
                )
            )
    places = [
        (0.33, 0.27, 0),
        (0, 0, 0),
        (0.5, -0.5, 0),
        (-0.05, 0.05, 0),
        (1.3, 0.4, 10),
        (-1.2, 1.1, 20),
        (0.7, -0.9, 45),
        (0.1, 0.6, -30),
        (1.85, 0.1, 0),
        (-0.6, 1.6, 5),
    ]
    for second in (False, True):
        for j, (y, z, angle) in enumerate(places):
            for speed in ((20, 200), (10, 50), (100, 300))[j % 3]:
                judge = impulse("0", [-speed, 0, 0]) if second else received("x")
                fine = Reference(
                    plate_and_edge(second, y, z, angle, speed, 3),
                    plate_and_edge(second, y, z, angle, speed, 4),
                    frozenset(),
                    judge,
                    0.1,
                    "fine mesh",
                )
                cases.append(
                    Case(
                        "explicit",
                        (
                            f"plate against the edge of a {'body' if second else 'tool'} at ({y}, {z}),"
                            f" {angle} degrees, {speed / 1000:g} of the wave speed"
                        ),
                        plate_and_edge(second, y, z, angle, speed),
                        (fine,),
                    )
                )
    return cases


# --- account of friction --------------------------------------------------------------------------


def slider(
    kind: str,
    floor: str,
    friction: float,
    method: str | None,
    scheme: str = "implicit dynamics",
    largest: float | None = None,
) -> Sections:
    """A block of 1 x 1 x 0.5 and mass 5e-4 under gravity slides on a floor, or spins on it, or slides down a
    slope."""
    solid = elastic(10000, 0.3, Density=1e-3)
    gravity, velocity, end = "0 ; 0 ; -50", "1 ; 0 ; 0", 0.1
    if kind == "spinning":
        velocity = "-2*y ; 2*x ; 0"
    if kind == "slope":
        gravity, velocity = "20 ; 0 ; -50", "0.5 ; 0 ; 0"
    bodies = {
        "block": {
            "Mesh": box((2, 2, 1), (-0.5, -0.5, 0), (0.5, 0.5, 0.5)),
            "Material": solid,
            "Initial velocity": velocity,
            "Loads": {"gravity": {"Type": "acceleration", "Acceleration": gravity}},
        }
    }
    pair = {"Body": "block", "Boundary ids": 4, "Friction coefficient": friction}
    scene = {"Bodies": bodies}
    if floor == "tool":
        scene["Tools"] = {"floor": {"Surfaces": {"face": {"Shape": "plane"}}}}
        pair["Tool"] = "floor"
    else:
        bodies["floor"] = {
            "Mesh": box((5, 3, 1), (-1.5, -1.5, -0.5), (1.5, 1.5, 0)),
            "Material": solid,
            "Supports": {"base": {"Boundary ids": 4}},
        }
        pair |= {"Second body": "floor", "Second boundary ids": 5}
    return {
        **scene,
        "Contact pairs": {"p": pair},
        "Time stepping": {"Scheme": scheme, **stepping(end, None, largest)},
        "Implicit dynamics": {"Method": method} if method else {},
        "Output": QUIET,
    }


def dissipated(exact: float) -> Judge:
    """Frictional dissipation at the end beside what friction must take."""

    def judge(run: Kept, _: Kept | None, same_clock: bool = False) -> float:
        return abs(run.history["friction_dissipation"][-1] / exact - 1)

    return judge


def balance(run: Kept, _: Kept | None, same_clock: bool = False) -> float:
    """Frictional dissipation beside the energy that is gone."""

    def gain(name: str) -> float:
        return run.history[name][-1] - run.history[name][0] if name in run.history else 0.0

    lost = gain("external_work") - sum(
        gain(name) for name in ("kinetic_energy", "elastic_energy", "contact_energy")
    )
    return abs(gain("friction_dissipation") / lost - 1)


def dissipation(run: Kept, reference: Kept, same_clock: bool = False) -> float:
    a, b = (r.history["friction_dissipation"][-1] for r in (run, reference))
    return abs(a / b - 1)


def travelled(speed: float, slowing: float, end: float) -> float:
    """Way of what starts with this speed."""
    time = min(end, speed / slowing) if slowing > 0 else end
    return speed * time - 0.5 * slowing * time**2


def friction_account() -> list[Case]:
    cases, mass, end = [], 5e-4, 0.1
    for floor in ("tool", "body"):
        for kind in ("sliding", "spinning", "slope"):
            for friction in (0.1, 0.3):
                for method in ("Newmark", "HHT-alpha", "generalised-alpha", None):
                    if kind == "sliding":
                        exact = friction * mass * 50 * travelled(1, friction * 50, end)
                    elif kind == "slope":
                        exact = friction * mass * 50 * travelled(0.5, friction * 50 - 20, end)
                    else:  # nine nodes, each with the weight of what is around it
                        inertia = mass / 6 if method else mass / 4  # a consistent or a lumped mass
                        moment = friction * mass * 50 * (0.25 * math.sqrt(0.5) + 0.5 * 0.5)
                        exact = 0.5 * inertia * (2**2 - max(0.0, 2 - moment * end / inertia) ** 2)
                    scene = slider(
                        kind, floor, friction, method, "implicit dynamics" if method else "explicit"
                    )
                    forms = [Reference(None, None, frozenset(OF_THE_MESH), balance, 0.02, "energy lost")]
                    if floor == "tool" or kind != "spinning":  # else the moment depends on the meshes
                        forms.append(
                            Reference(
                                None, None, frozenset(OF_THE_MESH), dissipated(exact), 0.02, "closed form"
                            )
                        )
                    cases.append(
                        Case(
                            "friction account",
                            f"{kind} on a {floor}, friction {friction}, {method or 'explicit'}",
                            scene,
                            tuple(forms),
                        )
                    )
    for friction in (0.1, 0.2, 0.4):
        for largest in (None, 0.02, 0.5):
            near = Reference(
                snap_fit(friction, 0.01), snap_fit(friction, 0.005), frozenset(OF_THE_MESH), dissipation, 0.05
            )
            cases.append(
                Case(
                    "friction account",
                    f"snap-fit, friction {friction}, steps of {largest or 'default'}",
                    snap_fit(friction, largest),
                    (near,),
                )
            )
    return cases


def snap_fit(friction: float, largest: float | None) -> Sections:
    return {
        "Amplitudes": {"s": {"Times": "0, 1, 2", "Values": "0, 1, 0"}},
        "Bodies": {
            "h": {
                "Mesh": box((40, 1, 4), (0, 0, 0), (40, 1, 2)),
                "Material": elastic(2000),
                "Element": "one point",
                "Symmetry planes": "y = 0 ; y = 1",
                "Supports": {"f": {"Boundary ids": 0}},
            }
        },
        "Tools": {
            "bump": {
                "Surfaces": {
                    "p": {
                        "Shape": "extruded profile",
                        "Corners": (
                            "44, -5 ; 41.5, -1 : 0.5 ; 44, 1.2 : 1 ; 47, 1.2 : 1 ; 49.5, -1 : 0.5 ; 48, -5"
                        ),
                        "Outside": "left",
                        "Origin": "0, 0, 0",
                        "Axis": "0, -1, 0",
                        "Direction": "1, 0, 0",
                        "Length": 6,
                    }
                },
                "Motion": {"Translation": "-14*s ; 0 ; 0"},
            }
        },
        "Contact pairs": {
            "c": {"Body": "h", "Boundary ids": "1, 4", "Tool": "bump", "Friction coefficient": friction}
        },
        "Time stepping": stepping(2, None, largest),
        "Output": QUIET,
    }


# --- pins in lugs ---------------------------------------------------------------------------------


def pin(facets: int, more: int, slave: str, correction: bool, largest: float | None = None) -> Sections:
    half = {"Positions": "x*cos(pi/180*y) ; x*sin(pi/180*y) ; z"}
    sides = {"pin": ("pin", 1), "lug": ("lug", 0)}
    first, second = sides[slave], sides["lug" if slave == "pin" else "pin"]
    steel = {"Symmetry planes": "y = 0 ; z = 0 ; z = 1", "Material": elastic(200000)}
    return {
        "Bodies": {
            "lug": {
                "Mesh": box((3, facets // 2, 1), (10, 0, 0), (20, 180, 1), **half),
                **steel,
                "Supports": {"outside": {"Boundary ids": 1, "Components": "x, y"}},
            },
            "pin": {
                "Mesh": box((3, facets // 2 + more, 1), (3, 0, 0), (10, 180, 1), **half),
                **steel,
                "Supports": {
                    "bore": {"Boundary ids": 0, "Components": "x, y", "Displacement": "0.02*t ; 0 ; 0"}
                },
            },
        },
        "Contact pairs": {
            "fit": {
                "Body": first[0],
                "Boundary ids": first[1],
                "Second body": second[0],
                "Second boundary ids": second[1],
                "Initial penetration": "shift",
                "Surface correction": "cylinder : 0, 0, 0 ; 0, 0, 1" if correction else None,
            }
        },
        "Time stepping": stepping(1, None, largest),
        "Output": QUIET,
    }


def pins() -> list[Case]:
    cases = []
    for slave in ("pin", "lug"):
        fine = pin(192, 0, slave, False, 0.1)
        fine["Contact pairs"]["fit"]["Normal penalty"] = 100
        for facets in (12, 16, 20, 24, 32, 48, 64, 96):
            for more in (0, 1, 2):
                for correction in (False, True):
                    reference = Reference(fine, None, frozenset(), force_curve(["fit"]), 0.05, "fine mesh")
                    cases.append(
                        Case(
                            "pins",
                            (
                                f"{facets} facets around, {more} more around half of the pin, slave"
                                f" {slave}{', surface correction' if correction else ''}"
                            ),
                            pin(facets, more, slave, correction),
                            (reference,),
                        )
                    )
    return cases


FAMILIES = {
    "bending": bending,
    "flights": flights,
    "blocks": pressed_blocks,
    "ironing": ironing,
    "stacks": stacks,
    "turning tools": turning_tools,
    "removal": removals,
    "pins": pins,
    "explicit": explicit,
    "penalties": penalties,
    "friction account": friction_account,
}

# Description of each family, and the references of its runs.
ABOUT = {
    "bending": (
        (
            "A strip of 60 x 1 x 1 mm between two rolls, bent by 8 mm: meshes, elements, laws, radii,"
            " tangents, line search, steps, penalties"
        ),
        (
            "force within 3 % of the same mesh with penalty 300 and steps of 0.02, no warning about the"
            " mesh excuses. Within 10 % of 120 x 4 one-point elements, any warning excuses"
        ),
    ),
    "flights": (
        (
            "Two bodies in implicit dynamics, apart by 100 times the thickness of the thinner one: oblique,"
            " with spin, tilted; steps up to the whole run"
        ),
        (
            "impulse on the flier within 3 % of the same bodies that start just before the impact, in fixed"
            " steps of 2e-5 or 4e-5"
        ),
    ),
    "blocks": (
        (
            "Two elastic blocks, pressed into each other by 10 to 80 % of the upper one's height. Gaps of 0"
            " to 10, both orders, friction, steps, penalties"
        ),
        "force within 3 % of the same meshes and penalty, from touching on, in steps of 0.02",
    ),
    "ironing": (
        (
            "A rounded elastic die, pressed into a soft slab and drawn along it: both orders, steps of 0.02"
            " to 0.3, penalties of 10 to 1000"
        ),
        "force within 5 % of the same mesh and penalty in steps of 0.02",
    ),
    "stacks": (
        "Two to five plates, clamped by friction, sheared or twisted until one face slides",
        (
            "force of the upper pair within 5 % of the same mesh with penalty 100 in steps of 0.1. Compared"
            " once pressed, at the end of the motion and after its reversal"
        ),
    ),
    "turning tools": (
        (
            "A plane on a ring, a ball and a roll on a block, pressed and turned 0.1 to 20 times with default"
            " steps"
        ),
        (
            "force and moment at the end within 3 % of a quarter of a turn in steps of 0.02: once all slides,"
            " they stay"
        ),
    ),
    "removal": (
        (
            "A bent strip, a dented block, two clamped plates, whose tool is removed at once or released in"
            " 0.02 to 0.5"
        ),
        (
            "no energy that appears after the removal: plastic and elastic within 5 % of both before it. A"
            " strip that only its rolls would hold has to be stopped"
        ),
    ),
    "pins": (
        (
            "A pin in a lug of its radius, 12 to 96 facets around, with equal and unequal facets, with and"
            " without a surface correction"
        ),
        "force within 5 % of 192 matching facets with penalty 100, any warning excuses",
    ),
    "explicit": (
        (
            "Balls of 0.1 to 2 facets on points of a facet, at 0.01 to 0.3 of the wave speed. A plate that"
            " flies with its edge at the edge of a tool, or of a plate"
        ),
        (
            "change of velocity or momentum within 10 % of the same scene with four to six times finer"
            " meshes, any warning excuses"
        ),
    ),
    "penalties": (
        "Slabs and blocks, pressed on a plane or on another at penalties of 0.01 to 1e4 E/h, in all schemes",
        "closed form within 5 %",
    ),
    "friction account": (
        (
            "A block that slides, spins, or goes down a slope, on a tool and on a body, with all methods of"
            " integration. A snap-fit in statics"
        ),
        (
            "frictional dissipation within 2 % of the energy that is gone and of a closed form; snap-fit:"
            " within 5 % of steps of 0.01"
        ),
    ),
}
