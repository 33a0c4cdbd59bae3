# SPDX-License-Identifier: LGPL-2.1-or-later
"""Base scenes: tiny, each with what must hold in it. A scene is made of knobs {name: value}; those that are
not set have the defaults below. Base units: block sizes about 1, E = 1000; dynamic ones with a density of
1e-3, so that bars carry waves at 1000."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, Callable, Mapping, Sequence

from . import invariants as must, laws
from .closed_forms import bar_speed
from .frame import Frame, number

Sections = dict[str, Any]  # of a scene file, {name: value or sections}
Vector = Sequence[float]
Planes = Sequence[tuple[Vector, float]]  # (normal, distance)

KNOBS: dict[str, Any] = {
    # frame
    "length": 1.0,
    "stress": 1.0,
    "time": 1.0,
    "turned": 0.0,
    # body
    "law": "elastic",
    "element": "assumed strain",
    "kinematics": "Hencky",
    "nu": 0.3,
    "young": 1000.0,
    "hardening": "linear",
    "yield": 0.01,
    "hardening modulus": 0.1,
    "flow rule": "plain",
    "exponent": 0.2,
    "saturation": 2.0,  # yield stresses
    "saturation rate": 10.0,
    "backstress": 20.0,  # modulus of the first term, yield stresses
    "recovery": 20.0,
    "r value": None,
    "pulled": "first",  # the material axis along z
    "rate factor": "none",
    "rate": 1.0,  # of the scene's strains, over the reference rate
    "rate exponent": 5.0,
    "rate coefficient": 0.02,
    "thermal factor": "none",
    "temperature": 0.5,  # 0: room, 1: melting
    "thermal exponent": 1.0,
    "heat": 0.0,  # parts of the way to melting, per plastic strain
    "volumetric": "logarithmic",
    "constant": None,  # of a rubber
    "prony": 0.0,  # share of the stress that relaxes
    "relaxation": 1.0,  # its time, parts of the scene's
    "density": 1e-3,
    "bricks": None,
    "aspect": 1.0,
    "grading": 1.0,
    "distortion": 0.0,
    "density ratio": 1.0,
    "modulus ratio": 1.0,
    # loading
    "strain": -0.1,
    "strained": False,
    "press": 0.02,
    "slide": 0.2,
    "speed": 0.01,
    "ramp": 1.0,  # part of the scene until the load is full
    "turns": 0.1,
    "oscillations": 0.0,
    "cycles": 0,
    # contact
    "penalty": 10.0,
    "mu": 0.0,
    "friction law": "Coulomb",
    "facets": None,
    "passes": None,
    "augmentation": None,
    "tangential penalty": None,
    "radius": 1.0,
    "feature": "pole",
    "edges": None,
    "smoothing": None,
    "margin": None,
    # of tools that are driven, and loads: parts of E
    "force": None,
    "moment": None,
    "load": 1e-3,
    "spring": None,
    # time and solver
    "step": None,
    "first step": 0.1,
    "largest step": 0.25,
    "tangent": None,
    "tolerance": None,
    "solver": None,
    "predictor": None,
    "line search": None,
    "safety": None,
    "resolution": None,
    "mass scaling": None,
    "instructions": None,
    "number type": None,
    "linear viscosity": None,
    "method": None,
    "spectral radius": None,
    "error tolerance": None,
    "profile": None,
    "target error": None,
    "mass": None,
    "duration": 1.0,
    "material tangent": None,
}

UPRIGHT = (1.0, 1.0, 1.0)


class Knobs:
    """As attributes, blanks as underscores."""

    def __init__(self, changes: Mapping[str, Any]) -> None:
        unknown = set(changes) - set(KNOBS)
        if unknown:
            raise KeyError(f"unknown knobs {unknown}")
        self.chosen, self.all = dict(changes), {**KNOBS, **changes}

    def but(self, changes: Mapping[str, Any]) -> Knobs:
        return Knobs({**self.chosen, **changes})

    def __getattr__(self, name: str) -> Any:
        return self.all[name.replace("_", " ")]


class Setup:
    """`sections` of the scene file, the `frame` they are written in, what `must` hold (functions of a
    Result), and `facts` that these functions need, in base units."""

    def __init__(
        self, knobs: Knobs, frame: Frame, sections: Sections, checks: list[must.Check], **facts: Any
    ) -> None:
        self.knobs, self.frame, self.sections, self.checks, self.facts = knobs, frame, sections, checks, facts
        self.library: Path | None = None  # source of the shared library that the scene names


def nudged(setup: Setup, part: float) -> Sections | None:
    """The sections of `setup` with every first velocity changed, so that no symmetry is left, by about this
    part of it, and by what moves it until the end by this part of its size; None of a static scene."""
    time_stepping = setup.sections["Time stepping"]
    if time_stepping.get("Scheme", "quasi-static") == "quasi-static":
        return None
    end = float(time_stepping["End time"]) / setup.frame.time
    by = [
        number(share * part * (setup.facts.get("speed", 0.0) + 1 / end) * setup.frame.speed)
        for share in (1.0, -0.6, 0.3)
    ]
    bodies = {}
    for name, of_body in setup.sections["Bodies"].items():
        v = of_body.get("Initial velocity", "0; 0; 0").split(";")
        bodies[name] = {**of_body, "Initial velocity": ";".join(f"{x.rstrip()} + {y}" for x, y in zip(v, by))}
    return {**setup.sections, "Bodies": bodies}


def reach(k: Knobs, end: float) -> float:
    """When a scene of equal steps ends: with tiny ones after twenty."""
    return end if k.step is None or k.step >= 0.01 else 20 * k.step


def turn(k: Knobs) -> float:
    """When it has been pressed enough, and begins to slide: with tiny steps after ten."""
    return 1.0 if k.step is None or k.step >= 0.01 else 10 * k.step


def pressed(k: Knobs) -> str:
    """How a part goes down: by `press` until its turn."""
    return f"{number(-k.press)}*(if({{t}} < {number(turn(k))}, {{t}}, {number(turn(k))}))"


def drawn(k: Knobs, rate: float) -> str:
    """How a part goes along from then on."""
    return f"{number(rate)}*({{t}} - {number(turn(k))})*({{t}} > {number(turn(k))})"


def frame_of(k: Knobs) -> Frame:
    return Frame(k.length, k.stress, k.time, UPRIGHT, k.turned)


def material(k: Knobs, f: Frame, young: float | None = None, density: float | None = None) -> Sections:
    e = young or k.young
    m: Sections = {"Law": k.law, "Young modulus": number(e * f.stress), "Poisson ratio": number(k.nu)}
    if k.kinematics != "Hencky":
        m["Elasticity"] = k.kinematics
    if density:
        m["Density"] = number(density * f.density)
    if k.law == "elastoplastic":
        y, h = k.all["yield"] * e * f.stress, k.hardening_modulus * e * f.stress
        m["Hardening"] = k.hardening
        if k.hardening == "linear":
            m.update({"Yield stress": number(y), "Hardening modulus": number(h)})
        elif k.hardening == "Voce":
            m.update(
                {
                    "Yield stress": number(y),
                    "Hardening modulus": number(h),
                    "Saturation stress": number(k.saturation * y),
                    "Saturation rate": number(k.saturation_rate),
                }
            )
        elif k.hardening == "power law":
            m.update(
                {
                    "Strength coefficient": number(3 * y),
                    "Prestrain": number(1e-3),
                    "Hardening exponent": number(k.exponent),
                }
            )
        elif k.hardening == "Ludwik":
            m.update(
                {
                    "Yield stress": number(y),
                    "Hardening coefficient": number(h),
                    "Hardening exponent": number(k.exponent),
                }
            )
        elif k.hardening == "table":
            m["Table"] = ", ".join(f"{number(s)} : {number(y + h * s)}" for s in (0, 0.1, 0.5, 5))
        m.update(flow_rule(k, f, y))
    return m


def flow_rule(k: Knobs, f: Frame, y: float) -> Sections:
    """What plasticity has beside isotropic hardening; tension along z yields as closed_forms.py says."""
    if k.flow_rule == "backstress":
        return {
            "Backstress moduli": f"{number(k.backstress * y)}, {number(0.5 * y)}",
            "Backstress rates": f"{number(k.recovery)}, 0",
        }
    if k.flow_rule == "Hill":
        return {
            "Anisotropy": "Hill",
            "Stress ratios": "1, 1.2, 1.2, 0.9, 0.9, 1.1",
            "Axes": "local",
            "First axis": f.vector((0, 0, 1)),
            "Second axis": f.vector((1, 0, 0)),
        }
    if k.flow_rule == "thermal":
        return {"Thermal factor": "table", "Thermal table": "0 : 1, 100 : 0.5", "Temperature": 50}
    return {}


def body(
    k: Knobs,
    f: Frame,
    mesh: Sections,
    planes: Planes | None = None,
    young: float | None = None,
    density: float | None = None,
    **more: Any,
) -> Sections:
    b: Sections = {"Mesh": f.mesh(**mesh), "Material": material(k, f, young, density)}
    if k.element != "assumed strain":
        b["Element"] = k.element
    if planes:
        b["Symmetry planes"] = f.planes(planes)
    b.update(more)
    return b


def box(n: tuple[int, int, int], low: Vector, high: Vector, **more: Any) -> Sections:
    # deal.II's box, at base units; written as a product, since deal.II takes corners of any order.
    return {
        "Primitive": "subdivided_hyper_rectangle",
        "Arguments": (
            f"{n[0]}, {n[1]}, {n[2]} : {', '.join(map(number, low))} : {', '.join(map(number, high))} : true"
        ),
        **more,
    }


def plane(f: Frame, point: Vector, normal: Vector) -> Sections:
    return {"plane": {"Shape": "plane", "Point": f.vector(point, f.length), "Normal": f.vector(normal)}}


def pair(k: Knobs, f: Frame, **more: Any) -> Sections:
    # What the program chooses by itself, unless a penalty is turned: in statics as much as contact needs.
    p: Sections = {"Normal penalty": number(k.penalty)} if "penalty" in k.chosen else {}
    if k.tangential_penalty is not None:
        p["Tangential penalty"] = number(k.tangential_penalty)
    if k.augmentation is not None:
        p["Penetration tolerance"] = number(k.augmentation)
    if k.mu > 0:
        p["Friction coefficient"] = number(k.mu)
        p["Friction law"] = k.friction_law
        law = friction(k)
        if k.friction_law == "shear limited":
            p["Maximum shear stress"] = number(law["largest"] * f.stress)
        elif k.friction_law == "static-kinetic":
            p.update(
                {
                    "Kinetic friction coefficient": number(law["kinetic"]),
                    "Decay coefficient": number(law["decay"] / f.speed),
                }
            )
        elif k.friction_law == "pressure dependent":
            p.update(
                {
                    "Reference pressure": number(law["reference"] * f.stress),
                    "Pressure exponent": number(law["exponent"]),
                }
            )
    for knob, key in (("edges", "Edge contact"), ("smoothing", "Smoothing"), ("margin", "Search margin")):
        if k.all[knob] is not None and "Second body" in more:
            p[key] = k.all[knob]
    p.update(more)
    return p


def friction(k: Knobs) -> Sections:
    """Parameters of the law, base units."""
    return {
        "law": k.friction_law,
        "mu": k.mu,
        "largest": 0.005 * k.young,
        "kinetic": 0.5 * k.mu,
        "decay": 1.0,
        "reference": 0.02 * k.young,
        "exponent": 0.7,
    }


def tolerances(k: Knobs) -> Sections:
    """Of Newton's method: for comparisons to many digits, unless the scene, its profile or its target error
    has others."""
    if k.tolerance is not None:
        return {"Force tolerance": k.tolerance, "Energy tolerance": number(max(k.tolerance, 1e-15))}
    return {} if k.profile or k.target_error else {"Force tolerance": "1e-6", "Energy tolerance": "1e-10"}


def statics(
    k: Knobs, f: Frame, end: float = 1.0, first: float | None = None, stops: Sequence[float] = ()
) -> Sections:
    t = {
        "End time": number(end * f.time),
        "Initial step": number((first or k.first_step) * f.time),
        "Maximum step": number(k.largest_step * f.time),
        "Minimum step": number(1e-5 * f.time),
    }
    if k.step is not None:
        t = {"End time": t["End time"], "Step control": "fixed", "Initial step": number(k.step * f.time)}
    if stops:
        t["Stops"] = ", ".join(number(s * f.time) for s in stops)
    s = {
        name: value
        for name, value in {
            "Contact tangent": k.tangent,
            "Linear solver": k.solver,
            "Predictor": k.predictor,
            "Line search": k.line_search,
            "Material tangent": k.material_tangent,
            **tolerances(k),
        }.items()
        if value is not None
    }
    whole = {"Time stepping": t, "Solver": s, "Output": output()}
    return {**top(k), **whole}


def output(**more: Any) -> Sections:
    return {"Folder": "results", "Step interval": 1000000, "Verbosity": "steps", **more}


def top(k: Knobs) -> Sections:
    return {
        name: value
        for name, value in {"Profile": k.profile, "Target error": k.target_error}.items()
        if value is not None
    }


def dynamics(k: Knobs, f: Frame, scheme: str, end: float, rows: int = 400) -> Sections:
    """`end` in base units of time."""
    whole = {**top(k), "Time stepping": {"Scheme": scheme, "End time": number(end * f.time)}}
    if scheme == "explicit":
        x = {
            "Safety factor": k.safety,
            "Contact resolution": k.resolution,
            "Instruction set": k.instructions,
            "Number type": k.number_type,
            "Linear bulk viscosity": k.linear_viscosity,
            "Mass scaling step": None if k.mass_scaling is None else number(k.mass_scaling * f.time),
        }
        whole["Explicit dynamics"] = {a: b for a, b in x.items() if b is not None}
        whole["Output"] = output(**{"Step interval": 0, "History interval": number(end * f.time / rows)})
    else:
        whole["Time stepping"].update(
            {
                "Initial step": number(end / 200 * f.time),
                "Maximum step": number(end / 50 * f.time),
                "Minimum step": number(end * 1e-7 * f.time),
            }
        )
        if k.step is not None:
            whole["Time stepping"].update(
                {"Initial step": number(k.step * end * f.time), "Maximum step": number(k.step * end * f.time)}
            )
        x = {
            "Method": k.method,
            "Spectral radius": k.spectral_radius,
            "Error tolerance": k.error_tolerance,
            "Mass": k.mass,
        }
        whole["Implicit dynamics"] = {a: b for a, b in x.items() if b is not None}
        whole["Solver"] = {
            a: b
            for a, b in {
                "Contact tangent": k.tangent,
                **tolerances(k),
                "Linear solver": k.solver,
                "Material tangent": k.material_tangent,
            }.items()
            if b is not None
        }
        whole["Output"] = output()
    return whole


# --- statics with tools ---------------------------------------------------------------------------


def shaped(k: Knobs, n: int) -> str:
    """Vertices of a unit block moved: graded along z so that the thickest layer is `grading` times the
    thinnest, its inner node and the middles of its edges moved by `distortion` halves of a brick."""
    x, y, z = "x", "y", "z"
    if k.grading != 1.0:
        ratio = k.grading ** (1 / max(n - 1, 1))
        # layers 1, r, r², ...: the vertex at z = i/n goes to (r^i − 1)/(r^n − 1)
        z = f"({number(ratio)}^({n}*z) - 1)/{number(ratio**n - 1)}"
    if k.distortion:
        d = number(k.distortion / n)
        bubble = "(x*(1-x) > 1e-6)*(y*(1-y) > 1e-6)*(z*(1-z) > 1e-6)"
        x, y, z = f"{x} + {d}*{bubble}", f"{y} + {d}*0.7*{bubble}", f"{z} - {d}*0.8*{bubble}"
    return " ; ".join((x, y, z))


def stiff(k: Knobs, height: float, facet: float) -> Knobs:
    """With penalties that give way by less than a fiftieth of what is left of the height, or of its change,
    if the block is to be `strained` as named; else as it is."""
    if not k.strained:
        return k
    pressure = abs(k.strain) * math.exp(-(1 - 2 * k.nu) * k.strain)  # E, of a bar
    least = 100 * pressure * facet / (height * math.exp(k.strain) * min(1.0, abs(k.strain)))
    return k.but({"penalty": max(k.penalty, 10.0 ** math.ceil(math.log10(least)))})


def upset(k: Knobs) -> Setup:
    """A block between two plane tools, held in two planes of symmetry: a bar in compression."""
    f, n, h = frame_of(k), k.bricks or 2, k.aspect
    k = stiff(k, h, 1 / n)
    travel = h * (1 - math.exp(k.strain))
    pushed = (
        {
            "Force": f.expression(f"{number(k.force * k.young)}*{{t}}", number(f.force) + "*"),
            "Force direction": f.vector((0, 0, -1)),
        }
        if k.force
        else None
    )
    mesh = box((n, n, n), (0, 0, 0), (1, 1, 1 if k.grading != 1 or k.distortion else h))
    if k.grading != 1 or k.distortion:
        mesh["Positions"] = shaped(k, n)
        travel, h = 1 - math.exp(k.strain), 1.0
    sections = {
        "Bodies": {"block": body(k, f, mesh, [((1, 0, 0), 0), ((0, 1, 0), 0)])},
        "Tools": {
            "die": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))},
            "ram": {
                "Surfaces": plane(f, (0, 0, h), (0, 0, -1)),
                "Motion": pushed
                or {"Translation": f.expressions(("0", "0", f"{number(-travel)}*{{t}}"), f.length)},
            },
        },
        "Contact pairs": {
            "low": pair(k, f, Body="block", Tool="die", **{"Boundary ids": 4}),
            "high": pair(k, f, Body="block", Tool="ram", **{"Boundary ids": 5}),
        },
        **statics(k, f, end=reach(k, 1.0)),
    }
    checks = [must.finite, must.balanced("die", "ram"), must.yields, must.diagonal_symmetry, must.jacobians]
    if k.force:
        checks.append(must.driven("ram.force_z", -k.force * k.young))
    if k.mu == 0:
        checks += [must.bar, must.uniform_stress, must.sideways_free("die"), must.sideways_free("ram")]
        if not k.distortion:
            checks += [must.penalty_depth("ram", 1 / n), must.bar_shape]
    else:
        checks += [must.cone]
    if k.law == "elastic" or k.mu > 0:
        checks += [must.energies]
    if k.strained:
        checks += [must.strained]
    return Setup(
        k, f, sections, checks, height=h, strain=k.strain, friction=friction(k), travel=travel, layers=n
    )


def pull(k: Knobs) -> Setup:
    """One brick stretched by supports, free across: no contact. With a `ramp` it is held from then on; with
    `cycles` it goes to and fro."""
    f, n, h = frame_of(k), k.bricks or 1, k.aspect
    top_moves = h * (math.exp(k.strain) - 1)
    moves, stops = loading(k)
    sections = {
        "Bodies": {
            "block": body(
                k,
                f,
                box((n, n, n), (0, 0, 0), (1, 1, h)),
                [((1, 0, 0), 0), ((0, 1, 0), 0), ((0, 0, 1), 0)],
                Supports={
                    "grip": {
                        "Boundary ids": 5,
                        "Components": "z",
                        "Displacement": (
                            f"0 ; 0 ; {f.expression(f'{number(top_moves)}*{moves}', number(f.length) + '*')}"
                        ),
                    }
                },
            )
        },
        **statics(k, f, end=reach(k, 1.0), first=stops[0] / 4 if stops else None, stops=stops),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.diagonal_symmetry,
            must.uniform_stress,
            must.bar_stress,
            must.energies,
            must.jacobians,
        ],
        height=h,
        strain=k.strain,
        layers=n,
    )


def loading(k: Knobs) -> tuple[str, list[float]]:
    """How a brick is stretched over time, and when that turns."""
    if k.cycles:
        whole = k.cycles + 0.25
        return (
            f"sin({number(2 * math.pi * whole)}*{{t}})",
            [(0.5 * i + 0.25) / whole for i in range(2 * k.cycles)],
        )
    if k.ramp < 1:
        return f"if({{t}} < {number(k.ramp)}, {{t}}/{number(k.ramp)}, 1)", [k.ramp]
    return "{t}", []


def membrane(k: Knobs) -> Setup:
    """One brick stretched by supports in two directions, free in the third one."""
    f = frame_of(k)
    moves, stops = loading(k)
    pulled = f"{number(math.expm1(k.strain))}*{moves}"
    sections = {
        "Bodies": {
            "sheet": body(
                k,
                f,
                box((1, 1, 1), (0, 0, 0), (1, 1, 1)),
                [((1, 0, 0), 0), ((0, 1, 0), 0), ((0, 0, 1), 0)],
                Supports={
                    "along": {
                        "Boundary ids": 1,
                        "Components": "x",
                        "Displacement": f.expressions((pulled, "0", "0"), f.length),
                    },
                    "across": {
                        "Boundary ids": 3,
                        "Components": "y",
                        "Displacement": f.expressions(("0", pulled, "0"), f.length),
                    },
                },
            )
        },
        **statics(k, f, first=stops[0] / 4 if stops else None, stops=stops),
    }
    checks: list[must.Check] = [
        must.finite,
        must.yields,
        must.diagonal_symmetry,
        must.uniform_stress,
        must.membrane_stress,
        must.energies,
        must.jacobians,
    ]
    return Setup(k, f, sections, checks, strain=k.strain)


def shear(k: Knobs) -> Setup:
    """One brick in simple shear: its top goes along by `strain` times its height."""
    f = frame_of(k)
    moves, stops = loading(k)
    along = f"{number(k.strain)}*{moves}"
    sections = {
        "Bodies": {
            "block": body(
                k,
                f,
                box((1, 1, 1), (0, 0, 0), (1, 1, 1)),
                Supports={
                    "foot": {"Boundary ids": 4},
                    "head": {"Boundary ids": 5, "Displacement": f.expressions((along, "0", "0"), f.length)},
                },
            )
        },
        **statics(k, f, first=stops[0] / 4 if stops else None, stops=stops),
    }
    checks: list[must.Check] = [
        must.finite,
        must.yields,
        must.uniform_stress,
        must.sheared,
        must.energies,
        must.jacobians,
    ]
    return Setup(k, f, sections, checks, strain=k.strain)


def slide(k: Knobs) -> Setup:
    """A block pressed on a plane that is drawn away under it; or to and fro, `cycles` times."""
    f, n = frame_of(k), k.bricks or 2
    way = k.slide
    if k.cycles:
        end = 1.0 + k.cycles
        along = f"{number(way)}*sin(2*pi*({{t}} - 1))*({{t}} > 1)"
    else:
        end = 2.0
        along = drawn(k, way)
    down = pressed(k)
    sections = {
        "Bodies": {
            "block": body(
                k,
                f,
                box((n, n, n), (0, 0, 0), (1, 1, 1)),
                Supports={
                    "head": {"Boundary ids": 5, "Displacement": f.expressions(("0", "0", down), f.length)}
                },
            )
        },
        "Tools": {
            "die": {
                "Surfaces": plane(f, (0, 0, 0), (0, 0, 1)),
                "Motion": {"Translation": f.expressions((along, "0", "0"), f.length)},
            }
        },
        "Contact pairs": {"foot": pair(k, f, Body="block", Tool="die", **{"Boundary ids": 4})},
        **statics(k, f, end=end if k.cycles else reach(k, end), stops=(1.0,) if k.step is None else ()),
    }
    checks = [
        must.finite,
        must.yields,
        must.cone,
        must.force_cone("die"),
        must.mirror((0, 1, 0), 0.5),
        must.energies,
        must.pushes("die"),
        must.jacobians,
    ]
    if not k.cycles:
        checks.append(must.gross_slip("die"))
    if k.kinematics == "Hencky" and k.cycles:
        checks.append(must.closed_cycles("die"))
    return Setup(k, f, sections, checks, friction=friction(k), slip_rate=way)


def ball(k: Knobs) -> Setup:
    """A quarter of a block between a rigid sphere, whose pole is on a node, and a bed."""
    f, n = frame_of(k), k.bricks or 3
    r = k.radius
    depth = k.press * 5 * min(r, 1.0)
    sections = {
        "Bodies": {
            "block": body(k, f, box((n, n, 2), (0, 0, 0), (1, 1, 0.7)), [((1, 0, 0), 0), ((0, 1, 0), 0)])
        },
        "Tools": {
            "bed": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))},
            "ball": {
                "Surfaces": {
                    "sphere": {
                        "Shape": "sphere",
                        "Centre": f.vector((0, 0, 0.7 + r), f.length),
                        "Radius": number(r * f.length),
                        "Axis": f.vector((0, 0, 1)),
                    }
                },
                "Motion": {"Translation": f.expressions(("0", "0", f"{number(-depth)}*{{t}}"), f.length)},
            },
        },
        "Contact pairs": {
            "low": pair(k.but({"mu": 0.0}), f, Body="block", Tool="bed", **{"Boundary ids": 4}),
            "high": pair(k, f, Body="block", Tool="ball", **{"Boundary ids": 5}),
        },
        **statics(k, f, end=reach(k, 1.0)),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.balanced("bed", "ball"),
            must.yields,
            must.diagonal_symmetry,
            must.cone,
            must.energies,
            must.depth_bound("ball", depth),
            must.jacobians,
        ],
        friction=friction(k),
    )


def twist(k: Knobs) -> Setup:
    """A plane tool pressed on a block and turned, or swung, about an axis through the middle node."""
    f, n = frame_of(k), k.bricks or 2
    angle = (
        f"{number(2 * math.pi * k.turns)}*sin(2*pi*{number(k.oscillations)}*({{t}} - 1))*({{t}} > 1)"
        if k.oscillations
        else drawn(k, 2 * math.pi * k.turns)
    )
    down = pressed(k)
    turned = (
        {"Rotation angle": f.expression(angle)}
        if k.moment is None
        else {
            "Moment": f.expression(
                f"{number(k.moment * k.young)}*if({{t}} > 1, {{t}} - 1, 0)", number(f.energy) + "*"
            )
        }
    )
    sections = {
        "Bodies": {
            "block": body(
                k, f, box((n, n, n), (-0.5, -0.5, 0), (0.5, 0.5, 0.5)), Supports={"foot": {"Boundary ids": 4}}
            )
        },
        "Tools": {
            "ram": {
                "Surfaces": plane(f, (0, 0, 0.5), (0, 0, -1)),
                "Motion": {
                    "Translation": f.expressions(("0", "0", down), f.length),
                    **turned,
                    "Rotation axis": f.vector((0, 0, 1)),
                    "Centre": f.vector((0, 0, 0.5), f.length),
                },
            }
        },
        "Contact pairs": {"head": pair(k, f, Body="block", Tool="ram", **{"Boundary ids": 5})},
        **statics(k, f, end=reach(k, 2.0), stops=(1.0,) if k.step is None else ()),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.sideways_free("ram"),
            must.quarter_turn,
            must.energies,
            must.moment_cone("ram"),
            must.jacobians,
            *([] if k.moment is None else [must.driven("ram.moment_z", k.moment * k.young)]),
        ],
        friction=friction(k),
        slip_rate=k.turns * 5,
    )


def features(f: Frame, k: Knobs | None) -> dict[str, Sections]:
    """Tools with edges, poles, axes, apices and seams exactly where nodes of the block are; faces at z = 0.5,
    looking down."""
    v, w = (lambda p: f.vector(p, f.length)), f.vector

    def rectangle(x: float, y: float, a: float, b: float) -> Sections:
        return {
            "Shape": "rectangle",
            "Centre": v((x, y, 0.5)),
            "Normal": w((0, 0, -1)),
            "Direction": w((1, 0, 0)),
            "Length": number(a * f.length),
            "Width": number(b * f.length),
        }

    down = w((0, 0, -1))
    return {
        "rectangle": {"a": rectangle(0, 0, 1, 1)},
        "rectangle of its size": {"a": rectangle(0, 0, 2, 2)},
        "coplanar": {"a": rectangle(-0.5, 0, 1, 4), "b": rectangle(1, 0, 2, 4)},
        "coincident": {"a": rectangle(0, 0, 4, 4), "b": rectangle(0, 0, 4, 4)},
        "disc": {
            "a": {"Shape": "disc", "Centre": v((0, 0, 0.5)), "Normal": down, "Radius": number(0.5 * f.length)}
        },
        "ring": {
            "a": {
                "Shape": "disc",
                "Centre": v((0, 0, 0.5)),
                "Normal": down,
                "Inner radius": number(0.5 * f.length),
                "Radius": number(3 * f.length),
            }
        },
        "sectors": {
            str(i): {
                "Shape": "disc",
                "Centre": v((0, 0, 0.5)),
                "Normal": down,
                "Radius": number(3 * f.length),
                "Sector": 90,
                "Start": w(d),
            }
            for i, d in enumerate(((1, 0, 0), (0, 1, 0), (-1, 0, 0), (0, -1, 0)))
        },
        "pole": {
            "a": {
                "Shape": "sphere",
                "Centre": v((0, 0, 2.5)),
                "Radius": number(2 * f.length),
                "Axis": w((0, 0, 1)),
            }
        },
        "pole aside": {
            "a": {
                "Shape": "sphere",
                "Centre": v((0, 0, 2.5)),
                "Radius": number(2 * f.length),
                "Axis": w((1, 1, 0)),
            }
        },
        "apex": {
            "a": {
                "Shape": "cone",
                "Apex": v((0, 0, 0.5)),
                "Axis": w((0, 0, 1)),
                "Half angle": 80,
                "To height": number(f.length),
            }
        },
        "torus": {
            "a": {
                "Shape": "torus",
                "Centre": v((0, 0, 1)),
                "Axis": w((0, 0, 1)),
                "Ring radius": number(0.5 * f.length),
                "Tube radius": number(0.5 * f.length),
            }
        },
        "profile": {
            "a": {
                "Shape": "revolved profile",
                "Corners": (
                    f"0, 0 ; {number(0.5 * f.length)}, 0 ; {number(2 * f.length)}, {number(0.5 * f.length)}"
                ),
                "Origin": v((0, 0, 0.5)),
                "Axis": w((0, 0, 1)),
                "Outside": "right",
            }
        },
        "seams": {
            str(i): {
                "Shape": "coons patch",
                "Curves": " ; ".join(f"line: {v(a)} to {v(b)}" for a, b in zip(c, c[1:] + c[:1])),
            }
            for i, c in enumerate(
                [
                    [(0, 0, 0.5), (0, 2, 0.5), (2, 2, 0.5), (2, 0, 0.5)],
                    [(0, 0, 0.5), (2, 0, 0.5), (2, -2, 0.5), (0, -2, 0.5)],
                    [(0, 0, 0.5), (0, -2, 0.5), (-2, -2, 0.5), (-2, 0, 0.5)],
                    [(0, 0, 0.5), (-2, 0, 0.5), (-2, 2, 0.5), (0, 2, 0.5)],
                ]
            )
        },
    }


FEATURES = tuple(features(Frame(), None))


def place(k: Knobs) -> Setup:
    """A quarter of a block pressed on a bed by a tool whose features are exactly on nodes."""
    f, n = frame_of(k), k.bricks or 2
    sections = {
        "Bodies": {
            "block": body(k, f, box((n, n, 1), (0, 0, 0), (1, 1, 0.5)), [((1, 0, 0), 0), ((0, 1, 0), 0)])
        },
        "Tools": {
            "bed": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))},
            "ram": {
                "Surfaces": features(f, k)[k.feature],
                "Motion": {"Translation": f.expressions(("0", "0", f"{number(-k.press)}*{{t}}"), f.length)},
            },
        },
        "Contact pairs": {
            "low": pair(k.but({"mu": 0.0}), f, Body="block", Tool="bed", **{"Boundary ids": 4}),
            "high": pair(k, f, Body="block", Tool="ram", **{"Boundary ids": 5}),
        },
        **statics(k, f, end=reach(k, 1.0)),
    }
    checks = [
        must.finite,
        must.balanced("bed", "ram"),
        must.yields,
        must.cone,
        must.energies,
        must.depth_bound("ram", k.press),
        must.jacobians,
    ]
    if k.feature not in ("coplanar",) or k.mu == 0:
        checks.append(must.diagonal_symmetry)
    return Setup(k, f, sections, checks, friction=friction(k))


def rest(k: Knobs) -> Setup:
    """A block that just touches two tools, and nothing moves."""
    f, n = frame_of(k), k.bricks or 2
    sections = {
        "Bodies": {
            "block": body(k, f, box((n, n, n), (0, 0, 0), (1, 1, 1)), [((1, 0, 0), 0), ((0, 1, 0), 0)])
        },
        "Tools": {
            "die": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))},
            "ram": {"Surfaces": plane(f, (0, 0, 1), (0, 0, -1))},
        },
        "Contact pairs": {
            "low": pair(k, f, Body="block", Tool="die", **{"Boundary ids": 4}),
            "high": pair(k, f, Body="block", Tool="ram", **{"Boundary ids": 5}),
        },
        **statics(k, f),
    }
    return Setup(k, f, sections, [must.finite, must.nothing_happens])


# --- statics between bodies -----------------------------------------------------------------------


def contact_of_bodies(k: Knobs) -> Sections:
    return {
        name: value for name, value in {"Facets": k.facets, "Passes": k.passes}.items() if value is not None
    }


def stack(k: Knobs) -> Setup:
    """Two confined blocks pressed on each other: the stress is uniform. Their meshes do not fit where facets
    overlap."""
    f = frame_of(k)
    over = k.facets in (None, "overlap")
    n = (3, 2) if over else (2, 2)
    sides = [((1, 0, 0), 0), ((1, 0, 0), 1), ((0, 1, 0), 0), ((0, 1, 0), 1)]
    down = f"{number(-k.press)}*{{t}}"
    lower, upper = k.young, k.young * k.modulus_ratio
    sections = {
        "Bodies": {
            "lower": body(
                k,
                f,
                box((n[0], n[0], 1), (0, 0, -1), (1, 1, 0)),
                sides,
                young=lower,
                Supports={"foot": {"Boundary ids": 4}},
            ),
            "upper": body(
                k,
                f,
                box((n[1], n[1], 1), (0, 0, 0), (1, 1, 1)),
                sides,
                young=upper,
                Supports={
                    "head": {"Boundary ids": 5, "Displacement": f.expressions(("0", "0", down), f.length)}
                },
            ),
        },
        "Contact pairs": {
            "joint": pair(
                k,
                f,
                Body="upper",
                **{"Boundary ids": 4, "Second body": "lower", "Second boundary ids": 5},
                **contact_of_bodies(k),
            )
        },
        **statics(k, f, end=reach(k, 1.0)),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.stack(lower, upper),
            must.uniform_stress_of_bodies,
            must.energies,
            must.jacobians,
        ],
        friction=friction(k),
    )


def touching(k: Knobs) -> Setup:
    """The same two blocks, just touching, and nothing moves."""
    setup = stack(k.but({"press": 0.0}))
    setup.checks = [must.finite, must.nothing_happens]
    return setup


def drag(k: Knobs) -> Setup:
    """A block pressed on a wider one and drawn over it."""
    f = frame_of(k)
    along, down = drawn(k, k.slide), pressed(k)
    lower, upper = k.young, k.young * k.modulus_ratio
    sections = {
        "Bodies": {
            "lower": body(
                k,
                f,
                box((3, 2, 1), (-0.25, -0.25, -0.5), (1.5, 1.25, 0)),
                young=lower,
                Supports={"foot": {"Boundary ids": 4}},
            ),
            "upper": body(
                k,
                f,
                box((2, 2, 1), (0, 0, 0), (1, 1, 0.5)),
                young=upper,
                Supports={
                    "head": {"Boundary ids": 5, "Displacement": f.expressions((along, "0", down), f.length)}
                },
            ),
        },
        "Contact pairs": {
            "joint": pair(
                k,
                f,
                Body="upper",
                **{"Boundary ids": 4, "Second body": "lower", "Second boundary ids": 5},
                **contact_of_bodies(k),
            )
        },
        **statics(k, f, end=reach(k, 2.0), stops=(1.0,) if k.step is None else ()),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.force_cone("joint"),
            must.mirror((0, 1, 0), 0.5),
            must.energies,
            must.jacobians,
        ],
        friction=friction(k),
        slip_rate=k.slide,
    )


def clip(k: Knobs) -> Setup:
    """An open ring is pinched until its ends touch: a body with itself."""
    f, n = frame_of(k), k.bricks or 12
    gap = 0.1
    half = math.pi - 0.5 * gap
    mesh = box(
        (1, n, 1),
        (1, 0, 0),
        (1.25, 1, 0.25),
        Positions=(
            f"x*cos({number(math.pi + half)} - {number(2 * half)}*(1 - y)) ; "
            f"x*sin({number(math.pi + half)} - {number(2 * half)}*(1 - y)) ; z"
        ),
    )
    # the outer faces next to the ends, and the one opposite
    sin_first = 1.25 * math.sin(0.5 * gap + half / n)
    mesh["Boundary ids"] = (
        f"7 : (x < -1.1)*(x*x + y*y > {number(1.2**2)}) ; 8 : (x > 0)*(x*x + y*y > {number(1.2**2)})*(y >"
        f" 0)*(y < {number(1.2 * sin_first)}) ; 9 : (x > 0)*(x*x + y*y > {number(1.2**2)})*(y < 0)*(y >"
        f" {number(-1.2 * sin_first)})"
    )
    if f.length != 1.0:
        s = number(f.length)
        mesh["Boundary ids"] = (
            mesh["Boundary ids"]
            .replace("x*x", f"(x*x/{s}^2)")
            .replace("y*y", f"(y*y/{s}^2)")
            .replace("(x <", f"(x/{s} <")
            .replace("(x >", f"(x/{s} >")
            .replace("(y <", f"(y/{s} <")
            .replace("(y >", f"(y/{s} >")
        )
    close = 0.5 * gap * 1.1 * 4 * k.press / 0.08 * 1.0
    move = f"{number(close)}*{{t}}"

    def pinch(sign: str) -> str:
        return f"0 ; {f.expression(sign + move, number(f.length) + '*')} ; 0"

    sections = {
        "Bodies": {
            "ring": body(
                k,
                f,
                mesh,
                [((0, 0, 1), 0)],
                Supports={
                    "back": {"Boundary ids": 7},
                    "above": {"Boundary ids": 8, "Components": "y", "Displacement": pinch("-")},
                    "below": {"Boundary ids": 9, "Components": "y", "Displacement": pinch("")},
                },
            )
        },
        "Contact pairs": {
            "ends": pair(
                k, f, Body="ring", **{"Boundary ids": "2, 3", "Second body": "ring"}, **contact_of_bodies(k)
            )
        },
        **statics(k, f, end=reach(k, 1.0)),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.mirror((0, 1, 0), 0.0),
            must.energies,
            must.jacobians,
            must.touches("ends"),
        ],
        friction=friction(k),
    )


# --- dynamics -------------------------------------------------------------------------------------


def velocity(f: Frame, v: Vector) -> str:
    return " ; ".join(number(x) for x in f.turned(v) * f.speed)


def thrown(f: Frame, v: Vector) -> Sections:
    return {"Initial velocity": velocity(f, v)}


def drop(k: Knobs, scheme: str) -> Setup:
    """A block flies onto a plane and back; speed as part of the bar's wave speed."""
    f, n = frame_of(k), k.bricks or 2
    c = bar_speed(k.young, k.density)
    v = k.speed * c
    gap = min(0.02, 0.5 * k.speed)
    end = k.duration * (gap / v + 5.0 / c)
    sections = {
        "Bodies": {
            "block": body(
                k,
                f,
                box((n, n, n), (-0.5, -0.5, gap), (0.5, 0.5, 1 + gap)),
                density=k.density,
                **thrown(f, (0, 0, -v)),
            )
        },
        "Tools": {"floor": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))}},
        "Contact pairs": {"foot": pair(k, f, Body="block", Tool="floor", **{"Boundary ids": 4})},
        **dynamics(k, f, scheme, end),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.mirror((1, 0, 0), 0.0),
            must.mirror((0, 1, 0), 0.0),
            must.diagonal_symmetry,
            must.drift,
            must.impulse("floor", v),
            must.energy_not_made,
            must.jacobians,
        ],
        friction=friction(k),
        mass=k.density,
        speed=v,
    )


def strike(k: Knobs, scheme: str) -> Setup:
    """A quarter of a block flies up against a tool whose features are exactly on nodes, and back; with a
    radius, against a ball whose pole is on one. A whole block where the tool turns."""
    f, n = frame_of(k), k.bricks or 2
    c = bar_speed(k.young, k.density)
    v = k.speed * c
    gap = min(0.02, 0.5 * k.speed)
    end = k.duration * (gap / v + 5.0 / c)
    turns = k.turns != KNOBS["turns"] or k.oscillations > 0
    r = k.radius
    surfaces = (
        features(f, k)[k.feature]
        if r == KNOBS["radius"]
        else {
            "a": {
                "Shape": "sphere",
                "Centre": f.vector((0, 0, 0.5 + r), f.length),
                "Radius": number(r * f.length),
                "Axis": f.vector((0, 0, 1)),
            }
        }
    )
    angle = (
        f"{number(2 * math.pi * k.turns)}*sin({number(2 * math.pi * k.oscillations / end)}*{{t}})"
        if k.oscillations
        else f"{number(2 * math.pi * k.turns / end)}*{{t}}"
    )
    motion = (
        {
            "Motion": {
                "Rotation angle": f.expression(angle),
                "Rotation axis": f.vector((0, 0, 1)),
                "Centre": f.vector((0, 0, 0.5), f.length),
            }
        }
        if turns
        else {}
    )
    sections = {
        "Bodies": {
            "block": body(
                k,
                f,
                (
                    box((2 * n, 2 * n, 2), (-1, -1, -0.5 - gap), (1, 1, 0.5 - gap))
                    if turns
                    else box((n, n, 2), (0, 0, -0.5 - gap), (1, 1, 0.5 - gap))
                ),
                None if turns else [((1, 0, 0), 0), ((0, 1, 0), 0)],
                density=k.density,
                **thrown(f, (0, 0, v)),
            )
        },
        "Tools": {"ram": {"Surfaces": surfaces, **motion}},
        "Contact pairs": {"top": pair(k, f, Body="block", Tool="ram", **{"Boundary ids": 5})},
        **dynamics(k, f, scheme, end),
    }
    checks = [
        must.finite,
        must.yields,
        must.cone,
        must.drift,
        must.meets("ram"),
        must.jacobians,
        *([must.quarter_turn, must.impulse("ram", v)] if turns else [must.energy_not_made]),
    ]
    if not turns and (k.feature != "coplanar" or k.mu == 0):
        checks.append(must.diagonal_symmetry)
    return Setup(k, f, sections, checks, friction=friction(k), mass=(4 if turns else 1) * k.density, speed=v)


def press(k: Knobs, scheme: str) -> Setup:
    """The bar of upset, pressed at a speed to a strain: a block on planes of symmetry under a tool that comes
    down."""
    f, n, h = frame_of(k), k.bricks or 2, k.aspect
    c = bar_speed(k.young, k.density)
    is_shaped = k.grading != 1 or k.distortion
    mesh = box((n, n, n), (0, 0, 0), (1, 1, 1 if is_shaped else h))
    if is_shaped:
        mesh["Positions"], h = shaped(k, n), 1.0
    k = stiff(k, h, 1 / n)
    travel = h * (1 - math.exp(k.strain))
    v = min(k.speed * c, travel * c / (5 * h))  # waves go to and fro
    end = travel / v
    sections = {
        "Bodies": {
            "block": body(
                k,
                f,
                mesh,
                [((1, 0, 0), 0), ((0, 1, 0), 0), ((0, 0, 1), 0)],
                density=k.density,
                **thrown(f, (0, 0, 0)),
            )
        },
        "Tools": {
            "ram": {
                "Surfaces": plane(f, (0, 0, h), (0, 0, -1)),
                "Motion": {"Translation": f.expressions(("0", "0", f"{number(-v)}*{{t}}"), f.length)},
            }
        },
        "Contact pairs": {"high": pair(k, f, Body="block", Tool="ram", **{"Boundary ids": 5})},
        **dynamics(k, f, scheme, end),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.diagonal_symmetry,
            must.drift,
            must.depth_bound("ram", travel),
            must.meets("ram"),
            must.jacobians,
        ]
        + ([must.strained] if k.strained else []),
        friction=friction(k),
        mass=h * k.density,
        speed=v,
        height=h,
        strain=k.strain,
    )


def stretch(k: Knobs, scheme: str) -> Setup:
    """The brick of `pull` in motion: slow enough that its stress is that of a bar."""
    f, n, h = frame_of(k), k.bricks or 2, k.aspect
    c = bar_speed(k.young, k.density)
    moves = h * math.expm1(k.strain)
    v = min(0.2 * k.speed * c, abs(moves) * c / (50 * max(h, 1.0)))  # waves go to and fro, sideways, too
    sections = {
        "Bodies": {
            "block": body(
                k,
                f,
                box((n, n, n), (0, 0, 0), (1, 1, h)),
                [((1, 0, 0), 0), ((0, 1, 0), 0), ((0, 0, 1), 0)],
                density=k.density,
                Supports={
                    "grip": {
                        "Boundary ids": 5,
                        "Components": "z",
                        "Displacement": f.expressions(
                            ("0", "0", f"{number(math.copysign(v, moves))}*{{t}}"), f.length
                        ),
                    }
                },
                **thrown(f, (0, 0, 0)),
            )
        },
        **dynamics(k, f, scheme, abs(moves) / v),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.diagonal_symmetry,
            must.drift,
            must.strained,
            must.bar_in_motion,
            must.jacobians,
        ],
        speed=v,
        height=h,
        strain=k.strain,
    )


def bar(k: Knobs, scheme: str) -> Setup:
    """A slender bar hits a plane: the force is ρ c v A until the wave is back."""
    f, n = frame_of(k), k.bricks or 16
    k = k.but({"nu": 0.0}) if k.nu == KNOBS["nu"] else k
    c = bar_speed(k.young, k.density)
    v = k.speed * c
    width = 1.0 / n
    end = 1.6 / c
    sections = {
        "Bodies": {
            "bar": body(
                k,
                f,
                box((1, 1, n), (0, 0, 0), (width, width, 1)),
                density=k.density,
                **thrown(f, (0, 0, -v)),
            )
        },
        "Tools": {"wall": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))}},
        "Contact pairs": {"end": pair(k, f, Body="bar", Tool="wall", **{"Boundary ids": 4})},
        **dynamics(k, f, scheme, end),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.diagonal_symmetry,
            must.drift,
            must.energy_not_made,
            must.impact_force("wall", k.density * c * v * width**2, 0.5 / c, 1.5 / c),
            must.impulse("wall", v),
            must.jacobians,
        ],
        mass=k.density * width**2,
        speed=v,
        friction=friction(k),
    )


def bars(k: Knobs, scheme: str) -> Setup:
    """A bar hits another one at rest, both free: momentum stays, and the force is that of the two
    impedances."""
    f, n = frame_of(k), k.bricks or 8
    k = k.but({"nu": 0.0}) if k.nu == KNOBS["nu"] else k
    young, density = (k.young, k.young * k.modulus_ratio), (k.density, k.density * k.density_ratio)
    speeds = [bar_speed(e, r) for e, r in zip(young, density)]
    v = k.speed * min(speeds)
    width = 1.0 / n
    end = 1.6 / max(speeds)

    def made(low: float, high: float, i: int, initial: float) -> Sections:
        return body(
            k,
            f,
            box((1, 1, n), (0, 0, low), (width, width, high)),
            young=young[i],
            density=density[i],
            **(thrown(f, (0, 0, initial)) if initial else {}),
        )

    sections = {
        "Bodies": {"low": made(-1, 0, 0, 0), "high": made(0, 1, 1, -v)},
        "Contact pairs": {
            "joint": pair(
                k,
                f,
                Body="high",
                **{"Boundary ids": 4, "Second body": "low", "Second boundary ids": 5},
                **contact_of_bodies(k),
            )
        },
        **dynamics(k, f, scheme, end),
    }
    z = [math.sqrt(e * r) for e, r in zip(young, density)]
    force = z[0] * z[1] / (z[0] + z[1]) * v * width**2
    mass = density[1] * width**2
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.diagonal_symmetry,
            must.drift,
            must.energy_not_made,
            must.momentum((0, 0, -mass * v), mass * v),
            *(
                [must.impact_force("joint", force, 0.5 / max(speeds), 1.4 / max(speeds))]
                if 0.3 <= speeds[1] / speeds[0] <= 3
                else []
            ),
            must.jacobians,
        ],
        mass=mass,
        speed=v,
        friction=friction(k),
    )


def flung(k: Knobs, f: Frame, speed: float, gravity: float) -> Sections:
    """A block with a speed along x, that weighs."""
    n = k.bricks or 2
    return body(
        k,
        f,
        box((n, n, 1), (-0.5, -0.5, 0), (0.5, 0.5, 0.5)),
        density=k.density,
        **thrown(f, (speed, 0, 0)),
        Loads={
            "gravity": {
                "Type": "acceleration",
                "Acceleration": f.expressions(("0", "0", number(-gravity)), f.acceleration),
            }
        },
    )


def skid(k: Knobs, scheme: str) -> Setup:
    """A block with a speed along a plane, under gravity: friction takes no more momentum than its limit
    allows."""
    f = frame_of(k)
    c = bar_speed(k.young, k.density)
    v, g = k.speed * c, 0.002 * c * c
    end = 40.0 / c * k.duration
    sections = {
        "Bodies": {"block": flung(k, f, v, g)},
        "Tools": {"floor": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))}},
        "Contact pairs": {"foot": pair(k, f, Body="block", Tool="floor", **{"Boundary ids": 4})},
        **dynamics(k, f, scheme, end),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.mirror((0, 1, 0), 0.0),
            must.drift,
            must.skidding(k.density * 0.5, v, g),
            must.jacobians,
        ],
        friction=friction(k),
        mass=0.5 * k.density,
        speed=v,
        slip_rate=v,
    )


def glide(k: Knobs, scheme: str) -> Setup:
    """A block with a speed along a wider one that is held below, under gravity."""
    f = frame_of(k)
    c = bar_speed(k.young, k.density)
    v, g = k.speed * c, 0.002 * c * c
    sections = {
        "Bodies": {
            "block": flung(k, f, v, g),
            "bed": body(
                k,
                f,
                box((3, 3, 1), (-1.5, -0.9, -0.5), (1.5, 0.9, 0)),
                young=k.young * k.modulus_ratio,
                density=k.density,
                Supports={"foot": {"Boundary ids": 4}},
            ),
        },
        "Contact pairs": {
            "foot": pair(
                k,
                f,
                Body="block",
                **{"Boundary ids": 4, "Second body": "bed", "Second boundary ids": 5},
                **contact_of_bodies(k),
            )
        },
        **dynamics(k, f, scheme, 40.0 / c * k.duration),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.force_cone("foot"),
            must.mirror((0, 1, 0), 0.0),
            must.drift,
            must.jacobians,
        ],
        friction=friction(k),
        mass=0.5 * k.density,
        speed=v,
        slip_rate=v,
    )


def fold(k: Knobs, scheme: str) -> Setup:
    """The open ring of `clip` in motion: its ends fly at each other, and touch."""
    setup = clip(k.but({"density": 0.0}))
    f = setup.frame
    c = bar_speed(k.young, k.density)
    v = k.speed * c
    ring = setup.sections["Bodies"]["ring"]
    ring["Material"]["Density"] = number(k.density * f.density)
    ring.pop("Supports")
    y = "y" if f.length == 1.0 else f"(y/{number(f.length)})"
    x = "x" if f.length == 1.0 else f"(x/{number(f.length)})"
    ring["Initial velocity"] = f"0 ; {number(-v * f.speed)}*{y}*({x} > 0)*{x} ; 0"
    sections = {
        **{n: s for n, s in setup.sections.items() if n in ("Bodies", "Contact pairs")},
        **dynamics(k, f, scheme, k.duration * 0.25 / v),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.mirror((0, 1, 0), 0.0),
            must.drift,
            must.energy_not_made,
            must.momentum((0, 0, 0), k.density * 0.5 * v, held=(2,)),
            must.jacobians,
        ],
        friction=friction(k),
        speed=v,
    )


def lying(k: Knobs, scheme: str) -> Setup:
    """Two blocks that just touch each other and a plane, at rest, without loads: nothing may happen."""
    f, n = frame_of(k), k.bricks or 2
    c = bar_speed(k.young, k.density)
    sections = {
        "Bodies": {
            "lower": body(k, f, box((n, n, 1), (0, 0, 0), (1, 1, 0.5)), density=k.density),
            "upper": body(k, f, box((n, n, 1), (0, 0, 0.5), (1, 1, 1)), density=k.density),
        },
        "Tools": {"floor": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))}},
        "Contact pairs": {
            "foot": pair(k, f, Body="lower", Tool="floor", **{"Boundary ids": 4}),
            "joint": pair(
                k,
                f,
                Body="upper",
                **{"Boundary ids": 4, "Second body": "lower", "Second boundary ids": 5},
                **contact_of_bodies(k),
            ),
        },
        **dynamics(k, f, scheme, 5.0 / c),
    }
    return Setup(k, f, sections, [must.finite, must.nothing_happens])


def laden(k: Knobs, scheme: str) -> Setup:
    """A block on a plane under a pressure that grows slowly, and springs, where there are some, on its
    top."""
    f, n = frame_of(k), k.bricks or 2
    c = bar_speed(k.young, k.density)
    end = 40.0 / c * k.duration
    p = k.load * k.young
    # the limit load
    is_beyond = k.law == "elastoplastic" and k.hardening_modulus == 0 and k.load >= getattr(k, "yield")
    loads = {
        "pressure": {
            "Type": "pressure",
            "Boundary ids": 5,
            "Pressure": f.expression(f"{number(p / end)}*{{t}}", number(f.stress) + "*"),
        }
    }
    if k.spring:
        loads["springs"] = {
            "Type": "spring",
            "Boundary ids": 5,
            "Stiffness": number(k.spring * k.young * f.stress / f.length),
        }
    sections = {
        "Bodies": {
            "block": body(
                k, f, box((n, n, n), (-0.5, -0.5, 0), (0.5, 0.5, 1)), density=k.density, Loads=loads
            )
        },
        "Tools": {"floor": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))}},
        "Contact pairs": {"foot": pair(k, f, Body="block", Tool="floor", **{"Boundary ids": 4})},
        **dynamics(k, f, scheme, end),
    }
    return Setup(
        k,
        f,
        sections,
        [
            must.finite,
            must.yields,
            must.cone,
            must.mirror((1, 0, 0), 0.0),
            must.diagonal_symmetry,
            must.drift,
            *([] if is_beyond else [must.bears("floor", p, end)]),
            must.jacobians,
        ],
        friction=friction(k),
        mass=k.density,
        speed=1e-9,
    )


def pile(k: Knobs, scheme: str) -> Setup:
    """Three blocks on a plane under gravity, pressed by no more than their weight; `cycles` stands for steps,
    in thousands."""
    f = frame_of(k)
    c = bar_speed(k.young, k.density)
    g = 1e-4 * c * c
    bodies, pairs = {}, {"foot": pair(k, f, Body="block0", Tool="floor", **{"Boundary ids": 4})}
    for i in range(3):
        bodies[f"block{i}"] = body(
            k,
            f,
            box((1, 1, 1), (0, 0, i), (1, 1, i + 1)),
            density=k.density,
            Loads={
                "gravity": {
                    "Type": "acceleration",
                    "Acceleration": f.expressions(("0", "0", number(-g)), f.acceleration),
                }
            },
        )
        if i:
            pairs[f"joint{i}"] = pair(
                k,
                f,
                Body=f"block{i}",
                **{"Boundary ids": 4, "Second body": f"block{i - 1}", "Second boundary ids": 5},
                **contact_of_bodies(k),
            )
    sections = {
        "Bodies": bodies,
        "Tools": {"floor": {"Surfaces": plane(f, (0, 0, 0), (0, 0, 1))}},
        "Contact pairs": pairs,
        **dynamics(k, f, scheme, max(k.cycles, 1) * 1000 * 0.2 / c),
    }
    return Setup(
        k,
        f,
        sections,
        [must.finite, must.drift, must.stays_put(3 * k.density * g), must.jacobians],
        friction=friction(k),
        mass=3 * k.density,
        speed=1e-9,
    )


def with_scheme(scene: Callable[[Knobs, str], Setup], scheme: str) -> Callable[[Knobs], Setup]:
    made = lambda k: scene(k, scheme)  # noqa: E731
    made.__doc__ = scene.__doc__
    return made


BASES: dict[str, Callable[[Knobs], Setup]] = {
    "upset": upset,
    "pull": pull,
    "membrane": membrane,
    "shear": shear,
    "slide": slide,
    "ball": ball,
    "twist": twist,
    "place": place,
    "rest": rest,
    "stack": stack,
    "touching": touching,
    "drag": drag,
    "clip": clip,
    **{
        f"{name}.explicit": with_scheme(scene, "explicit")
        for name, scene in (
            ("drop", drop),
            ("bar", bar),
            ("bars", bars),
            ("skid", skid),
            ("glide", glide),
            ("fold", fold),
            ("lying", lying),
            ("pile", pile),
            ("laden", laden),
            ("strike", strike),
            ("press", press),
            ("stretch", stretch),
        )
    },
    **{
        f"{name}.implicit": with_scheme(scene, "implicit dynamics")
        for name, scene in (
            ("drop", drop),
            ("bar", bar),
            ("bars", bars),
            ("skid", skid),
            ("glide", glide),
            ("fold", fold),
            ("lying", lying),
            ("laden", laden),
            ("strike", strike),
            ("press", press),
            ("stretch", stretch),
        )
    },
}

KINDS = {  # what kind of run a base scene is
    "statics, tools": ("upset", "slide", "ball", "twist", "place", "rest"),
    "statics, no contact": ("pull", "membrane", "shear"),
    "statics, bodies": ("stack", "touching", "drag"),
    "statics, self-contact": ("clip",),
    "explicit, tools": (
        "drop.explicit",
        "bar.explicit",
        "skid.explicit",
        "laden.explicit",
        "strike.explicit",
        "press.explicit",
    ),
    "explicit, bodies": ("bars.explicit", "glide.explicit", "lying.explicit", "pile.explicit"),
    "explicit, self-contact": ("fold.explicit",),
    "implicit dynamics, tools": (
        "drop.implicit",
        "bar.implicit",
        "skid.implicit",
        "laden.implicit",
        "strike.implicit",
        "press.implicit",
    ),
    "explicit, no contact": ("stretch.explicit",),
    "implicit dynamics, no contact": ("stretch.implicit",),
    "implicit dynamics, bodies": ("bars.implicit", "glide.implicit", "lying.implicit"),
    "implicit dynamics, self-contact": ("fold.implicit",),
}


# Knobs of laws beyond linear hardening and the three elastic ones.
OF_LAWS = (
    "r value",
    "pulled",
    "rate factor",
    "thermal factor",
    "volumetric",
    "constant",
    "prony",
)


# Edge of the largest facet of each pair or tool whose contacts may be augmented.
FACETS = {
    "upset": (("die", "ram"), 0.5),
    "slide": (("die",), 0.5),
    "ball": (("ball",), 1 / 3),
    "stack": (("joint",), 0.5),
    "drag": (("joint",), 0.625),
}


# Yield stress [E], if it is not turned, where the usual one is not reached.
YIELD = {
    "stack": 1e-3,
    "clip": 1e-3,
    **{f"{name}.{kind}": 1e-3 for name in ("bars", "skid", "fold") for kind in ("explicit", "implicit")},
}


def strain_rate(setup: Setup) -> float:
    """Of a scene, about; in motion without a strain that of an impact on a block."""
    k, end = setup.knobs, float(setup.sections["Time stepping"]["End time"]) / setup.frame.time
    if "strain" in setup.facts:
        return float(abs(k.strain) / end / k.ramp * max(4 * k.cycles, 1))
    return float(setup.facts.get("speed", 0.1 / end))


def equip(setup: Setup) -> None:
    """Gives the bodies what their law has beyond `material`, and what must hold of it."""
    k, f = setup.knobs, setup.frame
    if not set(k.chosen) & set(OF_LAWS) and k.kinematics not in laws.RUBBER and k.law != "UMAT":
        return
    end = float(setup.sections["Time stepping"]["End time"]) / f.time
    setup.facts["end"], setup.facts["reference rate"] = end, strain_rate(setup) / k.rate
    for name, of_body in setup.sections["Bodies"].items():
        young = k.young * (k.modulus_ratio if name == "upper" or name == "high" else 1.0)
        of_body["Material"] = laws.parameters(k, f, of_body["Material"], young, end, strain_rate(setup))
    if k.law == "UMAT":
        setup.library = laws.UMAT
        setup.sections["Output"]["State fields"] = "equivalent plastic strain"
    if k.rate_factor != "none" and not setup.sections["Time stepping"].get("Scheme") == "explicit":
        setup.sections["Output"]["Step interval"] = 1  # the rate of the last step
    if k.heat:
        setup.sections["Output"]["State fields"] = "temperature rise"
        setup.checks.append(must.heats)
    if must.energies not in setup.checks:
        setup.checks.append(must.dissipates)
    if k.r_value is not None:
        if k.pulled != "third":
            setup.checks = [check for check in setup.checks if check is not must.diagonal_symmetry]
        if "height" in setup.facts and k.mu == 0:
            setup.checks.append(must.hill_sides)


def make(base: str, changes: Mapping[str, Any]) -> Setup:
    setup = BASES[base](Knobs({"yield": YIELD.get(base, KNOBS["yield"]), **changes}))
    equip(setup)
    if setup.knobs.augmentation is not None and base in FACETS and setup.knobs.bricks is None:
        names, facet = FACETS[base]
        setup.checks = setup.checks + [must.augmented(name, facet) for name in names]
    return setup
