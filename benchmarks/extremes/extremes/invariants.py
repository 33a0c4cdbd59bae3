# SPDX-License-Identifier: LGPL-2.1-or-later
"""What must hold in a scene, computed from what the run wrote, not from what it thinks of itself. Each takes
a Result and gives Findings: an error, and how large it may be. All numbers are in base units and upright."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Callable, Sequence

import numpy
from billet_tools.output import Array, History
from numpy.typing import NDArray

from . import closed_forms, laws

if TYPE_CHECKING:
    from .results import Result

ROUNDING = 3e-7  # of fields, which are written with 24 bits


@dataclass
class Finding:
    name: str
    error: float
    allowed: float
    said: str = ""

    @property
    def holds(self) -> bool:
        return bool(self.error <= self.allowed)  # NaN does not

    def __str__(self) -> str:
        return (
            f"{self.name}: off by {self.error:.3g}, allowed"
            f" {self.allowed:.3g}{': ' + self.said if self.said else ''}"
        )


Check = Callable[["Result"], "list[Finding]"]


def part(error: float, scale: float) -> float:
    """error/scale, where nothing over nothing is nothing."""
    error, scale = float(error), float(scale)
    return 0.0 if error == 0 else (error / scale if scale > 0 else math.inf)


def newton(r: Result, times: float = 10.0, least: float = 1e-5) -> float:
    """Of forces: what Newton's method may leave."""
    return max(
        least,
        times * float(r.knobs.tolerance or (1e-3 if r.knobs.profile == "fast" else 0) or 0),
        1e-3 if r.knobs.target_error else 0,
    )


def finite(r: Result) -> list[Finding]:
    """Nothing that is written is infinite or not a number, and the run came to its end."""
    bad = sum(int(numpy.sum(~numpy.isfinite(v))) for v in r.history.values())
    bad += sum(int(numpy.sum(~numpy.isfinite(v))) for v in r.fields.values() if v.dtype.kind == "f")
    end = float(r.setup.sections["Time stepping"]["End time"]) / r.setup.frame.time
    time = r.history["time"][-1] if len(r.history.get("time", ())) else 0.0
    return [
        Finding("finite", bad, 0),
        Finding("comes to its end", abs(time - end) / end, 1e-3 if r.is_explicit else 1e-9),
    ]


def residual(r: Result) -> list[Finding]:
    """No step of statics is accepted with more than 'Force tolerance' asks for (in motion there may be no
    forces); what chooses tolerances by itself is looked at by its errors. Beside that the last bits of
    positions may stay, times the springs of a face of unit size."""
    if (
        "residual" not in r.history
        or "kinetic_energy" in r.history
        or r.knobs.profile
        or r.knobs.target_error
    ):
        return []
    # Of the first three steps, in which loads may begin, the program accepts what round-off leaves, however
    # much; the last one counts.
    after = numpy.r_[3 : max(3, len(r.history["residual"])), -1]
    forces = numpy.max(
        [numpy.abs(r.history[name][after]) for name in r.history if name.endswith(".force_z")] or [0 * after],
        axis=0,
    )
    springs = float(r.knobs.penalty) * float(r.knobs.young) * (r.knobs.bricks or 2)
    bits = numpy.divide(
        3 * numpy.finfo(float).eps * springs, forces, out=numpy.zeros(len(after)), where=forces > 0
    )
    return [
        Finding(
            "residual of steps",
            float(numpy.max(r.history["residual"][after] - bits, initial=0.0)),
            1.001 * float(r.knobs.tolerance or 1e-6),
        )
    ]


def deepest(r: Result) -> float:
    """How deep nodes go in, relative to a facet: the root of the largest area of a node."""
    area = float(numpy.max(r.fields.get("contact_area", numpy.zeros(1)), initial=0.0))
    depth = max(
        (
            float(numpy.max(v, initial=0.0))
            for name, v in r.history.items()
            if name.endswith(".deepest_penetration")
        ),
        default=0.0,
    )
    return depth / math.sqrt(area) if area > 0 else 0.0


# --- forces ---------------------------------------------------------------------------------------


def largest_force(r: Result) -> float:
    return max((float(numpy.max(numpy.abs(r.force(name)), initial=0.0)) for name in r.named), default=0.0)


def balanced(a: str, b: str) -> Check:
    """The forces of two tools on a body without supports are opposite."""

    def check(r: Result) -> list[Finding]:
        return [
            Finding(
                "equilibrium",
                part(numpy.max(numpy.abs((r.force(a) + r.force(b))[:, 2])), largest_force(r)),
                newton(r),
            )
        ]

    return check


def driven(column: str, value: float) -> Check:
    """A tool that a force, or a moment, drives presses with just that."""

    def check(r: Result) -> list[Finding]:
        return [Finding("driven", part(abs(r.history[column][-1] - value), abs(value)), newton(r, 10, 1e-4))]

    return check


def bears(name: str, pressure: float, end: float) -> Check:
    """The floor takes the momentum that the pressure gives, but for what the block still has of it; with
    springs, no more than that."""

    def check(r: Result) -> list[Finding]:
        h = r.history
        gap = numpy.diff(numpy.append(0.0, h["time"]))
        f = numpy.append(0.0, h[f"{name}.force_z"])
        taken = float(numpy.sum(0.5 * (f[1:] + f[:-1]) * gap))
        given = 0.5 * pressure * end
        if r.knobs.spring:
            return [
                Finding("pushes up", max(0.0, -taken) / given, 1e-6),
                Finding("bears no more than the load", max(0.0, taken / given - 1), 0.1 + 4 * r.knobs.load),
            ]
        return [
            Finding(
                "bears the load",
                abs(taken + float(-h["momentum_z"][-1]) - given) / given,
                0.05 + 4 * r.knobs.load,
            )
        ]

    return check


def believed(r: Result, fine: Result) -> list[Finding]:
    """What a run with a 'Target error' believes to be off is no less than a third of what it is off a fine
    run, in its forces over time; of a fine run itself no more is known than 2e-4."""
    names = [name for name in r.named if name in fine.named]
    t, to = r.history["time"], fine.history["time"]
    weights = 0.5 * (numpy.diff(t, append=t[-1]) + numpy.diff(t, prepend=t[0]))
    off = size = 0.0
    for name in names:
        f, exact = r.force(name), fine.force(name)
        there = numpy.stack(
            [numpy.interp(t, numpy.append(0.0, to), numpy.append(0.0, exact[:, i])) for i in range(3)], axis=1
        )
        off += float(numpy.sum(weights * numpy.linalg.norm(f - there, axis=1)))
        size += float(numpy.sum(weights * numpy.linalg.norm(there, axis=1)))
    told = r.believed.get("error", math.nan)
    return [Finding("believed error", part(off, size), 3 * told + 2e-4, f"believed {told:.3g}")]


def sideways_free(name: str) -> Check:
    """A frictionless or symmetrically loaded flat tool has no force across its normal."""

    def check(r: Result) -> list[Finding]:
        f = r.force(name)
        return [Finding("no force across", part(numpy.max(numpy.abs(f[:, :2])), largest_force(r)), newton(r))]

    return check


def pushes(name: str) -> Check:
    """A tool below a body never pulls."""

    def check(r: Result) -> list[Finding]:
        f = r.force(name)
        return [Finding("pushes", part(max(0.0, -float(numpy.min(f[:, 2]))), largest_force(r)), 1e-9)]

    return check


def force_cone(name: str) -> Check:
    """The whole force of a flat tool along its face is within the limit of its force across."""

    def check(r: Result) -> list[Finding]:
        f, law, area = (
            r.force(name),
            r.setup.facts["friction"],
            numpy.abs(r.history.get(f"{name}.contact_area", 0.0)),
        )
        along, across = numpy.hypot(f[:, 0], f[:, 1]), numpy.abs(f[:, 2])
        limit = law["mu"] * across
        if law["law"] == "shear limited":
            limit = numpy.minimum(limit, law["largest"] * area * (1 + 1e-6))
        if law["law"] == "pressure dependent":  # concave: a uniform pressure has most
            mean = numpy.where(area > 0, across / numpy.where(area > 0, area, 1), 0)
            limit = law["mu"] * law["reference"] * area * (mean / law["reference"]) ** law["exponent"]
        tilted = r.between_bodies  # the faces themselves turn
        return [
            Finding(
                "friction cone, whole",
                part(max(0.0, float(numpy.max(along - limit))), largest_force(r)),
                max(0.02 if tilted else 0.0, newton(r) * (1 + law["mu"])),
            )
        ]

    return check


def gross_slip(name: str) -> Check:
    """Where every node slides, Coulomb's law holds of the whole force, and it is dragged where the tool
    goes."""

    def check(r: Result) -> list[Finding]:
        law, status = r.setup.facts["friction"], r.fields.get("contact_status")
        if (
            law["law"] != "Coulomb"
            or law["mu"] == 0
            or status is None
            or not numpy.all(status[r.in_contact] == 2)
        ):
            return []
        f = r.force(name)[-1]
        return [
            Finding("Coulomb's limit", part(abs(f[0] - law["mu"] * abs(f[2])), law["mu"] * abs(f[2])), 0.05)
        ]

    return check


def moment_cone(name: str) -> Check:
    def check(r: Result) -> list[Finding]:
        m, f, law = r.history[f"{name}.moment_z"], numpy.abs(r.force(name)[:, 2]), r.setup.facts["friction"]
        if law["law"] == "pressure dependent":
            return []
        radius = float(numpy.max(numpy.hypot(*(r.fields["places"] + r.fields["displacement"])[:, :2].T)))
        scale = float(numpy.max(f)) * radius
        return [
            Finding(
                "friction cone, moment",
                part(max(0.0, float(numpy.max(numpy.abs(m) - law["mu"] * f * radius * 1.2))), scale),
                newton(r),
            )
        ]

    return check


def cone(r: Result) -> list[Finding]:
    """At each node: no tension, and traction within the law's limit of its pressure."""
    if "contact_pressure" not in r.fields:
        return []
    p, t, law = r.fields["contact_pressure"], r.fields["contact_traction"], r.setup.facts["friction"]
    scale = float(numpy.max(numpy.abs(t), initial=0.0))
    found = [Finding("no tension", part(max(0.0, -float(numpy.min(p, initial=0.0))), scale), 1e-6)]
    along = numpy.sqrt(numpy.maximum(numpy.sum(t * t, axis=1) - p * p, 0.0))
    limit = numpy.array(
        [closed_forms.friction_limit(pressure=max(float(x), 0.0), slip_rate=0.0, **law) for x in p]
    )
    if law["law"] == "pressure dependent" and r.between_bodies:
        return found  # tractions are means over the facets of a node, and the law is not linear
    over = float(numpy.max(along - limit, initial=0.0))
    return found + [
        Finding("friction cone", part(max(0.0, over), scale), 2e-3 if not r.between_bodies else 1e-2)
    ]


def penalty_depth(name: str, facet: float) -> Check:
    """Under a uniform pressure nodes go in by the pressure over the penalty."""

    def check(r: Result) -> list[Finding]:
        if (
            "penalty" not in r.knobs.chosen
            or r.knobs.augmentation is not None
            or r.knobs.profile
            or r.knobs.target_error
        ):
            return []  # as deep as the program finds right
        f, area = abs(r.force(name)[-1][2]), r.history[f"{name}.contact_area"][-1]
        expected = f / area / (r.knobs.penalty * r.knobs.young / facet) if area > 0 else 0.0
        return [
            Finding(
                "penetration",
                part(abs(r.history[f"{name}.deepest_penetration"][-1] - expected), expected),
                newton(r, 100, 1e-3),
            )
        ]

    return check


def augmented(name: str, facet: float) -> Check:
    """With augmentation nodes go in no deeper than the 'Penetration tolerance' of a facet, at the end of any
    step."""

    def check(r: Result) -> list[Finding]:
        return [
            Finding(
                "penetration, augmented",
                float(numpy.max(r.history[f"{name}.deepest_penetration"])) / facet,
                r.knobs.augmentation * (1 + 1e-6),
            )
        ]

    return check


def depth_bound(name: str, bound: float) -> Check:
    """Nodes go in no deeper than the tool went down."""

    def check(r: Result) -> list[Finding]:
        return [
            Finding(
                "penetration bound",
                part(float(numpy.max(r.history[f"{name}.deepest_penetration"])), bound),
                1 + 1e-6,
            )
        ]

    return check


def touched(r: Result, name: str) -> bool:
    """Where tractions are augmented, what presses need not be deep."""
    return any(
        float(numpy.max(r.history[f"{name}.{what}"], initial=0.0)) > 0
        for what in ("deepest_penetration", "contact_area")
    )


def touches(name: str) -> Check:
    """Where the ends are led together to the end, and the ring does not grow around them."""

    def check(r: Result) -> list[Finding]:
        if r.knobs.step and r.knobs.step < 0.1 or r.knobs.nu < 0:
            return []
        return [Finding("touches", 0.0 if touched(r, name) else 1.0, 0.5)]

    return check


def meets(name: str) -> Check:
    """What flies at a tool, or what a tool comes down on, is touched by it."""

    def check(r: Result) -> list[Finding]:
        return [Finding("meets the tool", 0.0 if touched(r, name) else 1.0, 0.5)]

    return check


def energies(r: Result) -> list[Finding]:
    """What is dissipated grows, what is stored is positive, and the columns add up."""
    h = r.history
    found = []
    stored = [h[c] for c in ("elastic_energy", "contact_energy") if c in h]
    scale = max(
        (float(numpy.max(numpy.abs(h[c]))) for c in h if c.endswith(("_energy", "_work", "_dissipation"))),
        default=0.0,
    )
    for column in ("plastic_work", "friction_dissipation"):
        if column in h and len(h[column]):
            falls = float(numpy.max(-numpy.diff(numpy.append(0.0, h[column])), initial=0.0))
            found.append(Finding(f"{column} grows", part(falls, scale), 1e-6))
    found.append(
        Finding(
            "stored energy",
            part(max(0.0, -min(float(numpy.min(s, initial=0.0)) for s in stored)), scale),
            1e-9,
        )
    )
    if "external_work" in h and "kinetic_energy" not in h:
        total = sum(
            h[c]
            for c in (
                "elastic_energy",
                "plastic_work",
                "contact_energy",
                "friction_dissipation",
                "hourglass_energy",
            )
            if c in h
        )
        found.append(
            Finding(
                "energy ledger",
                part(numpy.max(numpy.abs(total - h["external_work"] + h["energy_drift"])), scale),
                1e-8,
            )
        )
    return found


# --- stress ---------------------------------------------------------------------------------------

GAUSS = numpy.array([[(1 + s * g) / 2 for s in (-1, 1)] for g in (-1 / math.sqrt(3), 1 / math.sqrt(3))])
CORNERS = numpy.array(
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]]
)


def jacobi_matrices(points: Array) -> Array:
    """At the 2 x 2 x 2 points of hexahedra: (elements, 8, 3, 3); points: (elements, 8, 3), in VTK's order."""
    result = []
    for q in range(8):
        at = [(1 + (2 * ((q >> d) & 1) - 1) / math.sqrt(3)) / 2 for d in range(3)]
        gradients = numpy.empty((8, 3))
        for a, corner in enumerate(CORNERS):
            values = [at[d] if corner[d] else 1 - at[d] for d in range(3)]
            for d in range(3):
                gradients[a, d] = (1 if corner[d] else -1) * values[(d + 1) % 3] * values[(d + 2) % 3]
        result.append(numpy.einsum("eai,aj->eij", points, gradients))
    return numpy.array(result).transpose(1, 0, 2, 3)


def determinants(points: Array) -> Array:
    return numpy.linalg.det(jacobi_matrices(points))


def volume_ratio(r: Result) -> Array:
    cells = r.fields["cells"]
    x = r.fields["places"]
    return determinants((x + r.fields["displacement"])[cells]).sum(axis=1) / determinants(x[cells]).sum(
        axis=1
    )


def volume_ratio_of_law(r: Result) -> Array:
    """det of the mean deformation gradient, but of mean dilatation the ratio of the volumes."""
    if r.knobs.element == "mean dilatation":
        return volume_ratio(r)
    x, cells = r.fields["places"], r.fields["cells"]
    before, now = jacobi_matrices(x[cells]), jacobi_matrices((x + r.fields["displacement"])[cells])
    weights = numpy.linalg.det(before)
    mean = (
        numpy.einsum("eq,eqij->eij", weights, now @ numpy.linalg.inv(before))
        / weights.sum(axis=1)[:, None, None]
    )
    return numpy.linalg.det(mean)


def jacobians(r: Result) -> list[Finding]:
    """No element is inside out."""
    d = determinants((r.fields["places"] + r.fields["displacement"])[r.fields["cells"]])
    lowest = float(numpy.min(d.mean(axis=1) if r.knobs.element == "one point" else d))
    return [Finding("elements inside out", 1.0 if lowest < -1e-6 * float(numpy.max(d)) else 0.0, 0.5)]


def yields(r: Result) -> list[Finding]:
    """q(τ) <= σ_y(α): von Mises' stress times J, the one by which the element divides τ."""
    k = r.knobs
    if not laws.is_plastic(k) or "equivalent_plastic_strain" not in r.fields:
        return []
    first = r.fields["cells"][:, 0]
    stress, plastic = r.fields["von_mises_stress"][first], r.fields["equivalent_plastic_strain"][first]
    body = r.fields["body"][first]
    j = volume_ratio_of_law(r)
    rates, temperatures = plastic_rates(r)[first], temperature(r)[first]
    reference = r.setup.facts.get("reference rate", 1.0)
    limit = numpy.array(
        [
            laws.yield_limit(
                k, float(a), k.young * (k.modulus_ratio if b == 1 else 1.0), float(rate), reference, float(t)
            )
            for a, b, rate, t in zip(plastic, body, rates, temperatures)
        ]
    )
    is_uniform = "strain" in r.setup.facts and k.mu == 0 and not k.distortion
    is_curved = k.hardening != "linear" or k.rate_factor != "none" or k.heat
    loose = (3e-2 if is_curved and not is_uniform else 3e-3) + nearly_molten(r)
    if k.flow_rule == "Hill":
        loose += 0.3  # von Mises' stress over Hill's
    gentle = (
        k.penalty < 10
        or abs(k.strain) < 0.05
        or k.press < 0.02
        or k.slide < 0.2
        or k.speed < 0.01
        or k.step is not None
        or k.force
        or k.moment
        or k.modulus_ratio != 1
        or k.turns < 0.1
        or k.radius != 1
        or k.rate_factor != "none"
        and k.rate > 1
        or any("Loads" in of_body for of_body in r.setup.sections["Bodies"].values())
    )
    found = [] if gentle else [Finding("yields at all", 0.0 if float(numpy.max(plastic)) > 0 else 1.0, 0.5)]
    return found + [
        Finding("plastic strain >= 0", max(0.0, -float(numpy.min(plastic))), 1e-9),
        Finding("yield condition", float(numpy.max(stress * j / limit - 1)), loose),
    ]


def plastic_rates(r: Result) -> Array:
    """At the points of the fields, in the last step; where only the end was written, more than they are."""
    k, alpha = r.knobs, r.fields["equivalent_plastic_strain"]
    if k.rate_factor == "none":
        return numpy.zeros(len(alpha))
    if r.before:
        step = float(r.history["step_length"][-1])
        return numpy.maximum(alpha - r.before["equivalent_plastic_strain"], 0) / step
    much = 10 if "strain" in r.setup.facts else 1000
    return numpy.full(len(alpha), much * r.setup.facts["reference rate"] * k.rate)


def temperature(r: Result) -> Array:
    rise = r.fields.get("state_temperature_rise", numpy.zeros(len(r.fields["places"])))
    return laws.temperature_of(r.knobs) + rise


def nearly_molten(r: Result) -> float:
    """How well the flow stress is known from a temperature that is written with 24 bits."""
    if not r.knobs.heat:
        return 0.0
    hottest = laws.thermal_factor(r.knobs, float(numpy.max(temperature(r))))
    return ROUNDING * laws.MELTING / (laws.MELTING - laws.COLD) / hottest


def flows_at_limit(r: Result) -> list[Finding]:
    """Where all points flow to the end, and in one direction, the yield condition is an equation."""
    k, alpha = r.knobs, r.fields["equivalent_plastic_strain"]
    if float(numpy.min(alpha)) <= 1e-9 or k.flow_rule == "Hill" or k.r_value is not None or k.ramp < 1:
        return []
    if k.cycles:
        return []
    stress, j = r.fields["von_mises_stress"][r.fields["cells"][:, 0]], volume_ratio_of_law(r)
    first = r.fields["cells"][:, 0]
    found = [
        laws.yield_limit(k, float(a), None, float(rate), r.setup.facts.get("reference rate", 1.0), float(t))
        for a, rate, t in zip(alpha[first], plastic_rates(r)[first], temperature(r)[first])
    ]
    return [
        Finding(
            "flows at the limit", float(numpy.max(numpy.abs(stress * j / found - 1))), 1e-5 + nearly_molten(r)
        )
    ]


def dissipates(r: Result) -> list[Finding]:
    """What is dissipated does not fall; elastic bodies dissipate nothing."""
    h = r.history
    work = h["plastic_work"]
    scale = max(float(numpy.max(numpy.abs(h[c]))) for c in h if c.endswith(("_energy", "_work")))
    falls = float(numpy.max(-numpy.diff(numpy.append(0.0, work)), initial=0.0))
    found = [Finding("plastic_work grows", part(falls, scale), 1e-6)]
    if r.knobs.law == "elastic" and not r.knobs.prony:
        found.append(Finding("nothing is dissipated", part(float(numpy.max(numpy.abs(work))), scale), 1e-9))
    return found


def heats(r: Result) -> list[Finding]:
    """A part of the plastic work is the heat of the body."""
    k = r.knobs
    volumes = determinants(r.fields["places"][r.fields["cells"]]).sum(axis=1)
    rise = r.fields["state_temperature_rise"][r.fields["cells"][:, 0]]
    heat = float(numpy.sum(volumes / 8 * rise)) * laws.capacity(k)
    work = laws.HEATS * float(r.history["plastic_work"][-1])
    return [Finding("heat of the work", part(abs(heat - work), work), 1e-4)]


def hill_sides(r: Result) -> list[Finding]:
    """The two sides of a bar move in as its r-values say."""
    strain, known = stretch(r)
    if not laws.is_plastic(r.knobs):
        return []
    expected = laws.Flow(r.knobs, r.setup.facts["reference rate"]).bar(*path(r, strain))[1]
    found = []
    for i in (0, 1):
        x, u = r.fields["places"][:, i], r.fields["displacement"][:, i]
        reached = math.log1p(float(numpy.mean(u[x > 1 - 1e-6])))
        found.append(
            Finding(
                f"strain along {'xy'[i]}",
                abs(reached - expected[i]) / abs(strain),
                (2e-3 if "kinetic_energy" in r.history else 1e-4) + part(2 * known, abs(strain)),
                f"{reached:.4g} for {expected[i]:.4g}",
            )
        )
    return found


def path(r: Result, strain: float) -> tuple[Array, Array]:
    """Logarithmic strains of the steps, to the last one that was reached, and their times."""
    times, named = r.history["time"], r.setup.facts["strain"]
    times = times[times > 0]
    strains = numpy.log1p(math.expm1(named) * laws.loaded(r.knobs, times / times[-1]))
    return strains * (strain / named), times


def ends(r: Result) -> tuple[float, float]:
    """Mean displacements of the faces z = 0 and z = height."""
    z, u = r.fields["places"][:, 2], r.fields["displacement"][:, 2]
    h = r.setup.facts["height"]
    return u[z < 1e-6 * h].mean(), u[z > (1 - 1e-6) * h].mean()


def stretch(r: Result) -> tuple[float, float]:
    """Logarithmic strain between the faces, and how well it is known."""
    low, high = ends(r)
    h = r.setup.facts["height"]
    strain = math.log1p((high - low) / h)
    return strain, 4 * ROUNDING * (abs(low) + abs(high)) / (h + high - low)


def strained(r: Result) -> list[Finding]:
    """The block itself is strained as named, in the mean: neither penalties nor the step gave way instead."""
    named, (reached, known) = r.setup.facts["strain"], stretch(r)
    return [
        Finding(
            "strained as named", abs(reached - named) / abs(named), 0.1 + known / abs(named), f"{reached:.3g}"
        )
    ]


def bar_in_motion(r: Result) -> list[Finding]:
    """Slowly strained, its stress is that of a bar, but for waves."""
    strain, known = stretch(r)
    expected = expected_stress(r, strain)
    if expected is None or r.knobs.law != "elastic" and not laws.is_special(r.knobs):
        return []
    stress, across, loose = expected
    cauchy = stress / math.exp(strain + 2 * across)
    k = r.knobs
    waves = 0.01 if k.kinematics in laws.RUBBER or k.prony or laws.is_special(k) else 0.1
    return [
        Finding(
            "stress of the bar",
            abs(float(numpy.mean(r.fields["stress_zz"])) - cauchy) / abs(cauchy),
            waves + loose + 3 * part(known, abs(strain)),
        )
    ]


def expected_stress(r: Result, strain: float) -> tuple[float, float, float] | None:
    """(Kirchhoff stress, logarithmic strain across, allowed relative error), None where there is no closed
    form."""
    k = r.knobs
    if k.kinematics in laws.RUBBER or k.prony:
        strains, times = path(r, strain) if k.prony else (numpy.array([strain]), numpy.array([1.0]))
        terms = laws.terms_of(k, r.setup.facts["end"])
        stresses, side = laws.relaxing(laws.Elastic.of(k), laws.uniaxial, strains, times, terms)
        return stresses[2], side, 1e-3 if terms and r.named else 0.0  # contact takes its share earlier
    if laws.is_special(k):
        stress, e, _, _ = laws.Flow(k, r.setup.facts.get("reference rate", 1.0)).bar(*path(r, strain))
        return stress, 0.5 * (e[0] + e[1]), 1e-3 if r.named else 0.0
    if k.kinematics == "neo-Hookean":
        if k.law != "elastic":
            return None
        return (*closed_forms.uniaxial_neo_hookean(k.young, k.nu, strain), 0.0)
    loose = 0.0
    if k.kinematics == "hypoelastic":
        # What counts are the steps, parts of a linear motion; what contact took of it is spread evenly. Where
        # they are many and short the midpoint rule's error, x²/12 of each step's x, is small.
        times = numpy.append(0.0, numpy.cumsum(r.history["step_length"]))
        named = r.setup.facts["strain"]
        strains = numpy.log1p(math.expm1(named) * times / times[-1])
        x = float(numpy.max(numpy.abs(numpy.diff(strains))))
        if x > 0.1:
            stress, across = closed_forms.uniaxial_hypoelastic(
                k.young,
                k.nu,
                strains * strain / named,
                (lambda a: closed_forms.yield_stress_of(k, a)) if laws.is_plastic(k) else None,
            )
            return stress, across, 1e-6 + x * x / 6 * abs(strain / named - 1)
        loose = x * x / 6 + (0.02 if laws.is_plastic(k) else 0.0)
    if k.law == "elastic":
        return k.young * strain, -k.nu * strain, loose
    if k.young * abs(strain) <= closed_forms.yield_stress_of(k, 0.0):
        return k.young * strain, -k.nu * strain, loose
    plastic = closed_forms.root(
        lambda a: k.young * (abs(strain) - a) - closed_forms.yield_stress_of(k, a), 0.0, abs(strain)
    )
    stress = math.copysign(k.young * (abs(strain) - plastic), strain)
    return stress, closed_forms.lateral_hencky(k.young, k.nu, strain, stress), loose


def bar(r: Result) -> list[Finding]:
    """The tool's force is that of a bar with the strain that was reached."""
    strain, known = stretch(r)
    expected = expected_stress(r, strain)
    if expected is None:
        return []
    stress, _, loose = expected
    force = -stress / math.exp(strain)
    uncertain = part(known, abs(strain)) if r.knobs.law == "elastic" else part(known, abs(strain)) + known
    found = [
        Finding(
            "force of the bar",
            part(abs(abs(r.force("ram")[-1][2]) - abs(force)), abs(force)),
            newton(r, 10, 1e-4) + uncertain + loose,
        )
    ]
    if r.knobs.law == "elastic" and r.knobs.kinematics in ("Hencky", *laws.RUBBER) and not r.knobs.prony:
        across = expected[1]
        energy = laws.Elastic.of(r.knobs).energy((across, across, strain)) * r.setup.facts["height"]
        found.append(
            Finding(
                "elastic energy",
                part(abs(r.history["elastic_energy"][-1] - energy), energy),
                newton(r, 20, 2e-4) + 2 * uncertain,
            )
        )
    return found


def bar_stress(r: Result) -> list[Finding]:
    """σ_zz is that of a bar, and its sides move in as they must."""
    strain, known = stretch(r)
    expected = expected_stress(r, strain)
    if expected is None:
        return []
    stress, across, loose = expected
    cauchy = stress / math.exp(strain + 2 * across)
    known += loose * abs(strain) * 3
    # Newton's tolerance is of forces, and those on the sides of a flat brick are small.
    side = max(newton(r, 10, 1e-4), 2e-6 / r.knobs.aspect)
    got = r.fields["stress_zz"]
    scale = max(abs(cauchy), 1e-300)
    return [
        Finding(
            "stress of the bar",
            float(numpy.max(numpy.abs(got - cauchy))) / scale,
            side + loose + part(known, abs(strain)) + 3 * known,
        ),
        Finding(
            "no stress across",
            float(numpy.max(numpy.abs(r.fields["stress_xx"]))) / scale,
            side * max(1.0, math.exp(-2 * across)),
        ),
    ]


def membrane_stress(r: Result) -> list[Finding]:
    """The stress along both directions, the thickness, and the energy."""
    k, strain = r.knobs, float(r.setup.facts["strain"])
    if laws.is_plastic(k):
        return flows_at_limit(r)
    if k.kinematics == "hypoelastic":
        return []
    strains, times = path(r, strain) if k.prony else (numpy.array([strain]), numpy.array([1.0]))
    law = laws.Elastic.of(k)
    terms = laws.terms_of(k, r.setup.facts["end"]) if k.prony else ()
    stresses, side = laws.relaxing(law, laws.equibiaxial, strains, times, terms)
    wanted = stresses[0] / math.exp(2 * strain + side)
    moved = r.fields["displacement"][r.fields["places"][:, 2] > 1 - 1e-6, 2]
    return [
        Finding(
            "stress of the membrane",
            max(
                float(numpy.max(numpy.abs(r.fields[f"stress_{i}"] - wanted))) / abs(wanted)
                for i in ("xx", "yy")
            ),
            1e-4 + 10 * ROUNDING / min(abs(strain), 1),
        ),
        Finding(
            "thickness",
            float(numpy.max(numpy.abs(numpy.log1p(moved) - side))) / abs(side),
            1e-4 + 10 * ROUNDING / min(abs(strain), 1),
        ),
        *stored(r, law.energy((strain, strain, side))),
    ]


def stored(r: Result, energy: float) -> list[Finding]:
    """Of a body of unit volume."""
    if r.knobs.prony:
        return []
    return [Finding("elastic energy", abs(float(r.history["elastic_energy"][-1]) - energy) / energy, 1e-5)]


def sheared(r: Result) -> list[Finding]:
    """In simple shear an elastic body has the principal strains ±asinh(γ/2), and no pressure; the force never
    turns back."""
    k, f = r.knobs, r.history["block.support head.force_x"]
    gamma = float(r.setup.facts["strain"])
    found = []
    if not k.cycles and k.ramp == 1 and gamma > 0:
        found.append(
            Finding("resists", part(max(0.0, -float(numpy.min(f))), float(numpy.max(numpy.abs(f)))), 1e-6)
        )
    if laws.is_plastic(k):
        return found + ([] if k.flow_rule == "backstress" else flows_at_limit(r))
    if k.kinematics == "hypoelastic":
        return found
    e = (math.asinh(0.5 * gamma), 0.0, -math.asinh(0.5 * gamma))
    law = laws.Elastic.of(k)
    a, b, c = law.stresses(e)
    keeps, loose = 1.0, 0.0
    if k.prony:  # at rest for long, or not at all
        shortest = k.relaxation if k.ramp == 1 else min(k.relaxation, k.relaxation / k.ramp)
        if k.relaxation <= 1e-2 and k.ramp <= 0.5 or k.relaxation <= 1e-5:
            keeps, loose = 1 - k.prony, 100 * k.relaxation + math.exp(-0.05 / k.relaxation)
        elif shortest >= 1e2:
            loose = 1 / shortest
        else:
            return found
    mises = math.sqrt(0.5 * ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2)) * keeps
    near = 1e-4 + loose + 10 * ROUNDING / min(gamma, 1)
    return found + [
        Finding(
            "stress of the shear", float(numpy.max(numpy.abs(r.fields["von_mises_stress"] / mises - 1))), near
        ),
        Finding("no pressure", float(numpy.max(numpy.abs(r.fields["pressure"]))) / mises, near),
        *stored(r, law.energy(e)),
    ]


def bar_shape(r: Result) -> list[Finding]:
    """The sides move out as they must."""
    strain, known = stretch(r)
    expected = expected_stress(r, strain)
    if expected is None or r.setup.knobs.law != "elastic":
        return []
    across, loose = expected[1], expected[2]
    moved = r.fields["displacement"][r.fields["places"][:, 0] > 1 - 1e-6, 0]
    wanted = math.expm1(across)
    scale = max(abs(wanted), abs(math.expm1(strain)) * 0.1)
    return [
        Finding(
            "sides",
            part(float(numpy.max(numpy.abs(moved - wanted))), scale),
            (newton(r, 10, 2e-4) + loose * 3) * max(1.0, 0.3 / max(0.5 - r.knobs.nu, 1e-9) * 1e-2)
            + part(known, abs(strain)),
        )
    ]


def uniform_stress(r: Result) -> list[Finding]:
    if r.knobs.mu > 0:
        return []
    v = r.fields["von_mises_stress"]
    return [
        Finding(
            "uniform stress",
            part(float(numpy.max(v) - numpy.min(v)), float(numpy.max(v))),
            newton(r, 100, 1e-3),
        )
    ]


def uniform_stress_of_bodies(r: Result) -> list[Finding]:
    """A patch test: in each body the stress is uniform."""
    found = []
    for b in (0, 1):
        v = r.fields["stress_zz"][r.fields["body"] == b]
        found.append(
            Finding(
                "patch test",
                part(float(numpy.max(v) - numpy.min(v)), float(numpy.max(numpy.abs(v)))),
                newton(r, 100, 1e-3),
            )
        )
    return found


def stack(young_low: float, young_high: float) -> Check:
    """Two confined columns: each has the stress of its own stretch, and both are the pair's force over the
    area."""

    def check(r: Result) -> list[Finding]:
        k, x, u = r.knobs, r.fields["places"][:, 2], r.fields["displacement"][:, 2]
        if k.law != "elastic" or k.press == 0 or k.prony:
            return []
        force = abs(r.history["joint.force_z"][-1])
        found = []
        for b, young, low, high in ((0, young_low, -1.0, 0.0), (1, young_high, 0.0, 1.0)):
            here = r.fields["body"] == b
            top, bottom = u[here & (x > high - 1e-6)].mean(), u[here & (x < low + 1e-6)].mean()
            strain = math.log1p(top - bottom)
            tau = closed_forms.confined_hencky(young, k.nu, strain)
            if k.kinematics in ("neo-Hookean", *laws.RUBBER):
                tau = laws.Elastic.of(k, young).stresses((0.0, 0.0, strain))[2]
            loose = 1e-3 if k.kinematics == "hypoelastic" else 0.0
            known = 4 * ROUNDING * (abs(top) + abs(bottom))
            if part(known, abs(strain)) > 0.1:
                continue  # too stiff for what is written of it
            found.append(
                Finding(
                    "force of the column",
                    part(abs(abs(tau) / math.exp(strain) - force), force),
                    newton(r, 10, 1e-4) + part(known, abs(strain)) * 2 + loose,
                )
            )
        return found

    return check


# --- symmetry -------------------------------------------------------------------------------------


def partners(places: Array, images: Array, bodies: Array) -> NDArray[numpy.int64] | None:
    """Index of the place of the same body where each image is; None if the mesh itself is not symmetric."""
    scale = float(numpy.max(numpy.abs(places))) or 1.0

    def keys(p: Array) -> list[tuple[int, ...]]:
        whole = numpy.column_stack((numpy.round(p / scale * 2e4 + 1e-3), bodies))
        return [tuple(row) for row in whole.astype(int)]

    index: dict[tuple[int, ...], int] = {}
    for i, key in enumerate(keys(places)):
        index.setdefault(key, i)
    try:
        return numpy.array([index[key] for key in keys(images)])
    except KeyError:
        return None


# What round-off breaks in a motion that is chaotic, and how much of it a nudge is: some hundred roundings.
SYMMETRIES = ("mirror symmetry", "diagonal symmetry", "symmetry of quarter turns", "momentum across")
NUDGE = 1e-13


def sensitivity(r: Result, nudged: Result) -> float:
    """How far displacements at the end differ from those of the same motion with its first velocity nudged. A
    motion that forgets how it began keeps no symmetry better than that."""
    u = r.fields["displacement"]
    return part(
        float(numpy.max(numpy.abs(nudged.fields["displacement"] - u))), float(numpy.max(numpy.abs(u)))
    )


def symmetry(
    r: Result, name: str, map_point: Callable[[Array], Array], map_vector: Callable[[Array], Array]
) -> list[Finding]:
    if r.knobs.distortion:
        return []
    x, u = r.fields["places"], r.fields["displacement"]
    to = partners(x, map_point(x), r.fields["body"])
    if to is None:
        return []
    scale = float(numpy.max(numpy.abs(u)))
    return [
        Finding(name, part(float(numpy.max(numpy.abs(u[to] - map_vector(u)))), scale), newton(r, 100, 1e-4))
    ]


def mirror(normal: Sequence[float], distance: float) -> Check:
    n = numpy.asarray(normal, float)

    def check(r: Result) -> list[Finding]:
        def vector(u: Array) -> Array:
            return u - 2 * numpy.outer(u @ n, n)

        return symmetry(r, "mirror symmetry", lambda x: vector(x) + 2 * distance * n, vector)

    return check


def diagonal_symmetry(r: Result) -> list[Finding]:
    swap = [1, 0, 2]
    return symmetry(r, "diagonal symmetry", lambda x: x[:, swap], lambda u: u[:, swap])


def quarter_turn(r: Result) -> list[Finding]:
    def turn(v: Array) -> Array:
        return numpy.stack((-v[:, 1], v[:, 0], v[:, 2]), axis=1)

    return symmetry(r, "symmetry of quarter turns", turn, turn)


# --- motion ---------------------------------------------------------------------------------------


def nothing_happens(r: Result) -> list[Finding]:
    e = r.knobs.young
    forces = max((float(numpy.max(numpy.abs(r.force(name)), initial=0.0)) for name in r.named), default=0.0)
    return [
        Finding("no displacement", float(numpy.max(numpy.abs(r.fields["displacement"]))), 1e-9),
        Finding("no force", forces / e, 1e-9),
    ]


def ledger(h: History) -> Array:
    gains = (
        "kinetic_energy",
        "elastic_energy",
        "plastic_work",
        "contact_energy",
        "friction_dissipation",
        "viscous_dissipation",
        "hourglass_energy",
        "numerical_dissipation",
        "tool_kinetic_energy",
        "release_dissipation",
    )
    return numpy.asarray(sum(h[c] for c in h if c in gains or c.endswith(("_dissipation",))))


def drift(r: Result) -> list[Finding]:
    """Energies balance; the program's own sum is done again here."""
    h = r.history
    total = ledger(h) - h["external_work"]
    scale = max(float(numpy.max(ledger(h))), float(numpy.max(numpy.abs(h["external_work"] + total[0]))))
    return [
        Finding("energy balance", part(float(numpy.max(numpy.abs(h["energy_drift"]))), scale), 0.06),
        Finding("energy balance at the end", part(abs(h["energy_drift"][-1]), scale), 0.055),
        Finding(
            "energy ledger",
            part(
                float(numpy.max(numpy.abs(total - total[0] + h["energy_drift"] - h["energy_drift"][0]))),
                scale,
            ),
            1e-6,
        ),
    ]


def energy_not_made(r: Result) -> list[Finding]:
    h = r.history
    begin = 0.5 * r.setup.facts.get("mass", 0.0) * r.setup.facts["speed"] ** 2
    if not begin or r.knobs.mass_scaling:
        begin = float(h["kinetic_energy"][0])  # with the mass that is added
    return [
        Finding(
            "no energy is made",
            part(max(0.0, float(h["kinetic_energy"][-1] + h["elastic_energy"][-1]) - begin), begin),
            0.02,
        )
    ]


def momentum(expected: Sequence[float], scale: float, held: Sequence[int] = ()) -> Check:
    """Stays as it is, but for components that supports hold."""

    def check(r: Result) -> list[Finding]:
        p = numpy.stack([r.history[f"momentum_{i}"] for i in "xyz"], axis=1)
        p[:, list(held)] = 0
        if r.knobs.mass_scaling:
            return [
                Finding(
                    "momentum", float(numpy.max(numpy.abs(p - p[0]))) / float(numpy.max(numpy.abs(p))), 1e-9
                )
            ]
        return [
            Finding(
                "momentum",
                float(numpy.max(numpy.abs(p - numpy.asarray(expected)))) / scale,
                1e-9 if r.is_explicit else newton(r, 100, 1e-4),
            )
        ]

    return check


def impulse(name: str, speed: float) -> Check:
    """Momentum changes by the tool's force over time; none across it."""

    def check(r: Result) -> list[Finding]:
        h, m = r.history, r.setup.facts["mass"]
        p, f, t = h["momentum_z"], h[f"{name}.force_z"], h["time"]
        found = [
            Finding(
                "momentum across",
                float(numpy.max(numpy.abs(h["momentum_x"]) + numpy.abs(h["momentum_y"]))) / (m * speed),
                1e-6,
            )
        ]
        steps = float(h["step"][-1])
        if r.knobs.penalty <= 1e3 and (not r.is_explicit or steps < 3 * len(t)):
            # Implicit steps take the mean of the forces at their ends, or, where contacts open and close,
            # that at their end.
            mean = 0.5 * (f[1:] + f[:-1])
            other = mean if r.is_explicit else f[1:]
            low, high = (
                numpy.append(0.0, numpy.cumsum(least * numpy.diff(t)))
                for least in (numpy.minimum(mean, other), numpy.maximum(mean, other))
            )
            missing = float(numpy.max(numpy.maximum(low - (p - p[0]), p - p[0] - high))) / (m * speed)
            found.append(Finding("impulse", missing, 0.15))
        return found

    return check


def impact_force(name: str, force: float, begin: float, end: float) -> Check:
    """ρ c v A, in the mean, until the wave is back."""

    def check(r: Result) -> list[Finding]:
        k = r.knobs
        # from 1e3 on nodes rattle, and rows of the history are samples of blows
        stiffest = k.penalty * max(k.modulus_ratio, 1 / k.modulus_ratio)
        if (
            k.mass_scaling
            or k.speed > 0.03
            or k.law != "elastic"
            or k.penalty < 3
            or stiffest >= 1e3
            or k.nu != 0.0
            or k.prony
            or (k.bricks or 8) < 8
        ):
            return []
        t, f = r.history["time"], numpy.abs(r.force(name)[:, 2])
        window = (t > begin) & (t < end)
        if numpy.count_nonzero(window) < 5:
            return []
        mean = float(numpy.trapz(f[window], t[window]) / (t[window][-1] - t[window][0]))
        return [Finding("stress of the impact", abs(mean - force) / force, 0.12)]

    return check


def skidding(mass: float, speed: float, gravity: float) -> Check:
    """Friction takes, since the start, no more than µ times what the floor gave upwards."""

    def check(r: Result) -> list[Finding]:
        h, law = r.history, r.setup.facts["friction"]
        t, along, up = h["time"], h["momentum_x"], h["momentum_z"] + mass * gravity * h["time"]
        scale = mass * max(speed, gravity * float(t[-1]))
        found = [
            Finding("momentum across", float(numpy.max(numpy.abs(h["momentum_y"]))) / scale, 1e-4),
            Finding("not pushed", max(0.0, float(numpy.max(along - mass * speed))) / scale, 1e-3),
            Finding("borne", max(0.0, -float(numpy.min(up))) / scale, 1e-6),
        ]
        if law["law"] != "pressure dependent":
            found.append(
                Finding(
                    "friction's impulse",
                    max(0.0, float(numpy.max(mass * speed - along - law["mu"] * up))) / scale,
                    0.02,
                )
            )
        if law["law"] == "Coulomb" and law["mu"] == 0:
            found.append(
                Finding(
                    "no friction",
                    float(numpy.max(numpy.abs(along - mass * speed))) / scale,
                    1e-9 if r.is_explicit else 1e-5,
                )
            )
        return found

    return check


def stays_put(weight: float) -> Check:
    """The floor bears the weight, and nothing wanders off sideways."""

    def check(r: Result) -> list[Finding]:
        h = r.history
        late = h["time"] > 0.5 * h["time"][-1]
        mean = float(numpy.mean(h["foot.force_z" if "foot.force_z" in h else "floor.force_z"][late]))
        long = r.knobs.cycles >= 100  # by then bulk viscosity has taken what the start made
        return [
            Finding("bears the weight", abs(mean - weight) / weight, 1e-6 if long else 0.05),
            Finding("stays where it is", float(numpy.max(numpy.abs(r.fields["displacement"][:, :2]))), 1e-3),
            Finding(
                "comes to rest",
                float(numpy.max(h["kinetic_energy"][late])) / float(numpy.max(h["kinetic_energy"])),
                1e-6 if long else 1.0,
            ),
        ]

    return check


def closed_cycles(name: str) -> Check:
    """After the first ones, a cycle ends where the one before did."""

    def check(r: Result) -> list[Finding]:
        t, f = r.history["time"], r.force(name)
        at = [int(numpy.argmin(numpy.abs(t - (1 + i)))) for i in range(r.knobs.cycles + 1)]
        if r.knobs.cycles < 3 or abs(t[at[-1]] - t[at[-2]] - 1) > 1e-6:
            return []
        return [
            Finding(
                "cycles close",
                part(float(numpy.max(numpy.abs(f[at[-1]] - f[at[-2]]))), largest_force(r)),
                1e-5,
            )
        ]

    return check


# --- two runs -------------------------------------------------------------------------------------


def same(r: Result, other: Result, loose: float = 1e-6, count: str = "exact") -> list[Finding]:
    """The same scene in other units, or turned: as many iterations and steps, and the same history. Where
    units are no powers of two round-off differs, and a node that is just at the limit of friction may slip in
    the one and stick in the other: one correction more or less, or two ('nearly'), but as many steps and
    cuts."""
    found = []
    if count:
        for column in ("step", "total_iterations", "total_cuts"):
            if column in r.history and column in other.history:
                mine, its = float(r.history[column][-1]), float(other.history[column][-1])
                found.append(
                    Finding(
                        f"as many: {column}",
                        abs(mine - its),
                        2.0 if count == "nearly" and column == "total_iterations" else 0.0,
                        f"{mine:g} for {its:g}",
                    )
                )
    for name in r.named:
        if name not in other.named:
            continue
        a, b = r.force(name), other.force(name)
        n = min(len(a), len(b))
        if count != "exact":
            a, b, n = a[-1:], b[-1:], 1
        found.append(
            Finding(
                f"same force: {name}",
                part(float(numpy.max(numpy.abs(a[:n] - b[:n]))), max(largest_force(r), largest_force(other))),
                loose,
            )
        )
    u, v = r.fields["displacement"], other.fields["displacement"]
    if u.shape == v.shape:
        found.append(
            Finding(
                "same displacements",
                part(float(numpy.max(numpy.abs(u - v))), float(numpy.max(numpy.abs(v)))),
                max(loose, 3e-6),
            )
        )
    return found
