# SPDX-License-Identifier: LGPL-2.1-or-later
"""Which scenes there are: each parameter over its range, alone and in pairs, in every kind of run that it
concerns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Collection, Iterable, Iterator, Mapping, Union

from .laws import RATE_FACTORS, RUBBER, THERMAL_FACTORS, VOLUMETRIC
from .scenes import FEATURES

Value = Union[float, str]
Changes = Mapping[str, Any]


@dataclass
class Case:
    """A base scene with some knobs turned. `parameters` are those whose range it is part of; `like` turns
    knobs so that the result must be the same but for `loose`; `count`: in exactly or nearly as many
    iterations, or '' for any; 'believed': `like` is a fine run, from which it is no farther off than it
    believes."""

    base: str
    changes: Changes
    parameters: tuple[str, ...]
    values: tuple[Value, ...]
    like: Changes | None = None
    count: str = "exact"
    loose: float = 1e-6

    @property
    def name(self) -> str:
        turned = ",".join(
            f"{k}={v:g}" if isinstance(v, float) else f"{k}={v}" for k, v in self.changes.items()
        )
        return f"{self.base}/{turned or 'as it is'}" + (
            ""
            if self.like is None
            else " like " + (",".join(f"{k}={v}" for k, v in self.like.items()) or "the base")
        )


def decades(low: int, high: int, each: int = 1) -> list[float]:
    return [10.0 ** (e / each) for e in range(low * each, high * each + 1)]


AS_IT_IS: Changes = {}
PLASTIC: Changes = {"law": "elastoplastic"}
ROUGH: Changes = {"mu": 0.2}
IMPLICIT_TOOLS = ("upset", "slide", "ball", "twist", "place")
BODIES = ("stack", "drag", "clip")
EXPLICIT = tuple(f"{b}.explicit" for b in ("drop", "bar", "bars", "skid", "fold"))
DYNAMIC = tuple(f"{b}.implicit" for b in ("drop", "bar", "bars", "skid", "fold"))
STATICS = IMPLICIT_TOOLS + BODIES
CONTACT = STATICS + EXPLICIT + DYNAMIC
ALL = ("upset", "pull") + STATICS[1:] + EXPLICIT + DYNAMIC
# Statics augments until penetration takes less than 0.005 of the forces. One augmentation more or less along
# the way, which round-off may decide, stays in the friction: 1.7e-4 where springs alone agree to 1e-13.
AUGMENTED = 5e-4
FRICTIONAL = (
    "upset",
    "slide",
    "ball",
    "twist",
    "place",
    "drag",
    "clip",
    "drop.explicit",
    "skid.explicit",
    "drop.implicit",
    "skid.implicit",
)
ELEMENTS = ("assumed strain", "mean dilatation", "one point")
LAWS = ("Hencky", "neo-Hookean", "hypoelastic")
FRICTION_LAWS = ("Coulomb", "shear limited", "static-kinetic", "pressure dependent")
NU = [-0.9, -0.5, 0.0, 0.3, 0.45, 0.49, 0.499, 0.4999]
MU = [0.0, 1e-6, 1e-3, 0.01, 0.1, 0.3, 0.6, 1.0, 2.0, 5.0, 10.0]
STRAINS = [-2.995732273553991, -2.0, -1.0, -0.5, -0.1, -1e-2, -1e-4, -1e-6]
STRETCHES = [1e-6, 1e-4, 1e-2, 0.1, 0.5, 0.99, 2.0, 2.995732273553991]
STEPS = [1e-6, 1e-4, 1e-2, 0.05, 0.1, 0.25, 0.5, 1.0]
PENALTIES = decades(-3, 8)


def single(
    parameter: str,
    bases: Iterable[str],
    values: Iterable[Value],
    knob: str | None = None,
    along: Changes | None = None,
) -> Iterator[Case]:
    """One parameter alone."""
    for base in bases:
        for value in values:
            yield Case(base, {**(along or {}), (knob or parameter): value}, (parameter,), (value,))


def product(
    names: tuple[str, str],
    bases: Iterable[str],
    firsts: Iterable[Value],
    seconds: Iterable[Value],
    along: Changes | None = None,
) -> Iterator[Case]:
    for base in bases:
        for a in firsts:
            for b in seconds:
                yield Case(base, {**(along or {}), names[0]: a, names[1]: b}, tuple(names), (a, b))


def strain_of(law: str, more: Collection[object] = ()) -> str:
    """A row of the table for each law, elastic or not: they end at different strains."""
    return "strain" + (f", {law}" if law != "Hencky" else "") + (", yields" if more else "")


def cases() -> list[Case]:
    """All of them, each once."""
    seen, result = set(), []
    for case in everything():
        if case.name not in seen:
            seen.add(case.name)
            result.append(case)
    return result


STRETCHED = ("stretch.explicit", "stretch.implicit")
# Each law in all of them: tools, none, explicit, implicit dynamics, pairs of bodies.
KINDS_OF_LAWS = (
    "upset",
    "pull",
    "membrane",
    "shear",
    "slide",
    "stack",
    "drag",
    *STRETCHED,
    "drop.explicit",
    "drop.implicit",
    "bars.explicit",
    "bars.implicit",
)
# How far a brick goes in these scenes, where nothing else is turned.
FAR: Mapping[str, Changes] = {
    "upset": {"strained": True, "strain": -0.5},
    **dict.fromkeys(("pull", "membrane", *STRETCHED), {"strain": 0.5}),
    "shear": {"strain": 1.0},
}


def far(
    parameter: str,
    bases: Iterable[str],
    values: Iterable[Value],
    knob: str | None = None,
    along: Changes | None = None,
) -> Iterator[Case]:
    """One parameter alone, at strains that are large."""
    for base in bases:
        yield from single(parameter, (base,), values, knob, {**FAR.get(base, {}), **(along or {})})


def in_other_words(name: str, along: Changes) -> Iterator[Case]:
    """A law in other units, and turned in space."""
    for base in ("upset", "drop.explicit"):
        more = {**FAR.get(base, {}), **along}
        units = {"length": 2.0**20, "stress": 2.0**-30, "time": 2.0**10}
        yield Case(base, {**more, **units}, ("units",), (f"{name}, powers of 2",), more, "exact", 1e-9)
        turned = {**more, "turned": 50.0}
        yield Case(base, turned, ("turned",), (50.0,), more, "", 1e-3)


def of_laws() -> Iterator[Case]:
    """Laws beyond linear hardening and the three elastic ones, at the extremes of their parameters."""
    yield from of_rubber()
    yield from of_viscosity()
    yield from of_rates()
    yield from of_heat()
    yield from of_flow_rules()
    yield from of_hardening()
    umat: Changes = {"law": "UMAT", "kinematics": "hypoelastic"}
    for base in KINDS_OF_LAWS:
        yield Case(base, {**FAR.get(base, {}), **umat}, ("user law",), ("UMAT",))
    for base, strains in (("pull", [1e-4, -1.0, 2.0]), ("upset", [-1e-4, -1.0, -2.0]), ("shear", [0.1, 5.0])):
        yield from far("strain, UMAT", (base,), strains, "strain", umat)
    yield from far("yield, UMAT", ("pull", "upset", "stretch.explicit"), [1e-8, 1e-4, 0.1], "yield", umat)
    yield from far("nu, UMAT", ("pull", "upset", "stack"), [-0.9, 0.0, 0.4999], "nu", umat)
    yield from in_other_words("UMAT", umat)


def of_rubber() -> Iterator[Case]:
    for law in RUBBER:
        along: Changes = {"kinematics": law, "nu": 0.49}
        yield from far("law", KINDS_OF_LAWS, [law], "kinematics", {"nu": 0.49})
        row = strain_of(law)
        yield from single(row, ("pull",), [1e-6, 1e-2, 1.0, STRETCHES[-1], -1.0, STRAINS[0]], "strain", along)
        yield from single(row, ("membrane",), [1e-4, 1.0, 1.5, -1.0, -1.5], "strain", along)
        yield from single(row, ("shear",), [1e-4, 0.1, 3.0, 10.0], "strain", along)
        yield from single(row, ("upset",), [-1e-4, -1.0, -2.0], "strain", {**along, "strained": True})
        yield from single(row, STRETCHED[:1], [-1.0, 1e-4, 2.0], "strain", along)
        yield from single(row, STRETCHED[1:], [-1.0, 1.0], "strain", along)
        yield from far(
            f"nu, {law}",
            ("pull", "upset", "membrane", "stack"),
            [0.0, 0.49999],
            "nu",
            {"kinematics": law},
        )
        for element in ELEMENTS[1:]:
            more = {**along, "nu": 0.49999}
            yield from far("element", ("upset", "shear"), [element], along=more)
        yield from in_other_words(law, along)
    constants = {
        "Mooney-Rivlin": [1e-6, 0.5, 0.9, 0.999],
        "Yeoh": [1e-6, 0.1, 1.0, 100.0],
        "Ogden": [-10.0, -2.0, 0.1, 2.0, 10.0, 25.0],
        "Arruda-Boyce": [1.05, 1.5, 10.0, 100.0],
    }
    for law, values in constants.items():
        yield from far(
            f"constant, {law}",
            ("pull", "membrane", "shear"),
            values,
            "constant",
            {"kinematics": law, "nu": 0.49},
        )
        stiffened: Changes = {"kinematics": law, "nu": 0.49}
        firmly: Changes = {**stiffened, "penalty": 1e4}  # softer contact would take the strain of some
        for bases, along in ((("stretch.explicit", "stack"), stiffened), (("upset",), firmly)):
            yield from far(f"constant, {law}", bases, [values[0], values[-1]], "constant", along)
    for law in RUBBER:
        for volumetric in VOLUMETRIC:
            for nu in (0.1, 0.499):
                for base in ("pull", "membrane") + (("upset", "stack", *STRETCHED) if law == "Yeoh" else ()):
                    yield Case(
                        base,
                        {**FAR.get(base, {}), "kinematics": law, "volumetric": volumetric, "nu": nu},
                        ("volumetric", "nu"),
                        (volumetric, nu),
                    )


def of_viscosity() -> Iterator[Case]:
    times = [1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3, 1e6]
    viscous: Changes = {"prony": 0.6, "kinematics": "Yeoh", "nu": 0.49}
    yield from far(
        "prony", KINDS_OF_LAWS, [0.6], along={"kinematics": "Ogden", "nu": 0.49, "relaxation": 0.1}
    )
    for law in ("Hencky", "neo-Hookean", *RUBBER):
        yield from far(
            "relaxation", ("pull",), [1e-3, 0.1, 10.0], along={"prony": 0.6, "kinematics": law, "ramp": 0.01}
        )
    yield from far("relaxation", ("pull", "membrane", "shear"), times, along={**viscous, "ramp": 0.01})
    yield from far("relaxation", ("upset", "stretch.explicit"), times[::2], along=viscous)
    yield from far("relaxation", ("drop.explicit", "drop.implicit"), [1e-6, 1.0, 1e6], along={"prony": 0.6})
    yield from far(
        "prony", ("pull", "shear", "stretch.explicit"), [1e-6, 0.1, 0.999], along={"relaxation": 0.1}
    )
    for g in (0.01, 0.9, 0.999):
        for time in (1e-3, 0.1, 10.0):
            yield Case(
                "pull",
                {"prony": g, "relaxation": time, "strain": 0.5, "cycles": 2},
                ("prony", "relaxation"),
                (g, time),
            )
    turning: Changes = {"prony": 0.9, "kinematics": "Yeoh", "nu": 0.49, "relaxation": 0.1}
    yield from single("strain, Prony", ("pull",), [1e-4, STRETCHES[-1], STRAINS[0]], "strain", turning)
    yield from single("strain, Prony", ("shear",), [1e-4, 10.0], "strain", turning)
    yield from in_other_words("Prony", {**viscous, "relaxation": 0.1})


def of_rates() -> Iterator[Case]:
    for factor in RATE_FACTORS:
        along: Changes = {**PLASTIC, "rate factor": factor}
        yield from far("rate factor", KINDS_OF_LAWS, [factor], along=PLASTIC)
        row = f"rate, {factor}"
        rates = [1e-6, 1e-3, 1e3, 1e6]
        yield from far(row, ("pull", "shear"), rates, "rate", along)
        yield from far(row, ("upset", "stack", *STRETCHED, "drop.explicit"), rates[::3], "rate", along)
        yield from in_other_words(factor, along)
    cowper: Changes = {**PLASTIC, "rate factor": "Cowper-Symonds"}
    yield from far("rate exponent", ("pull", "shear", "stretch.explicit"), [1.0, 20.0, 100.0], along=cowper)
    cook: Changes = {**PLASTIC, "rate factor": "Johnson-Cook", "rate": 1e3}
    yield from far("rate coefficient", ("pull", "shear", "stretch.explicit"), [1e-4, 0.2, 1.0], along=cook)
    for hardening in ("Voce", "power law", "Ludwik", "table"):
        for factor in RATE_FACTORS:
            yield Case(
                "pull",
                {**PLASTIC, "strain": 0.5, "hardening": hardening, "rate factor": factor},
                ("hardening", "rate factor"),
                (hardening, factor),
            )
    for rule in ("backstress", "Hill", "thermal"):
        yield Case(
            "pull",
            {**cowper, "strain": 0.5, "flow rule": rule},
            ("flow rule", "rate factor"),
            (rule, "Cowper-Symonds"),
        )


def of_heat() -> Iterator[Case]:
    for factor in THERMAL_FACTORS:
        along: Changes = {**PLASTIC, "thermal factor": factor}
        row = f"temperature, {factor}"
        yield from far("thermal factor", KINDS_OF_LAWS, [factor], along=PLASTIC)
        temperatures = [-1.0, 0.0, 0.9, 0.999, 1.0, 2.0]
        yield from far(row, ("pull", "shear"), temperatures, "temperature", along)
        yield from far(row, ("upset", "stack"), [-1.0, 0.9, 2.0], "temperature", along)
        # Molten, its stress is less than that of the waves.
        yield from far(row, ("stretch.explicit",), [-1.0, 0.9], "temperature", along)
        warm: Changes = {**along, "temperature": 0.0}
        heats = [1e-3, 0.1, 1.0, 10.0, 1e3]
        yield from far(f"heat, {factor}", ("pull", "shear"), heats, "heat", warm)
        yield from far(
            f"heat, {factor}",
            ("upset", *STRETCHED, "drop.explicit", "drop.implicit"),
            [0.1, 10.0, 1e3],
            "heat",
            warm,
        )
        yield from in_other_words(f"{factor} of temperature", {**warm, "heat": 0.1})
    along = {**PLASTIC, "thermal factor": "Johnson-Cook"}
    yield from far("thermal exponent", ("pull", "shear"), [0.01, 0.3, 3.0, 100.0], along=along)
    whole: Changes = {
        **along,
        "hardening": "Ludwik",
        "rate factor": "Johnson-Cook",
        "temperature": 0.1,
        "heat": 0.3,
    }
    yield from far("rate, Johnson and Cook's law", KINDS_OF_LAWS, [1e3], "rate", whole)


def of_flow_rules() -> Iterator[Case]:
    back: Changes = {**PLASTIC, "flow rule": "backstress"}
    yield from far("flow rule", KINDS_OF_LAWS, ["backstress", "Hill"], along=PLASTIC)
    yield from far("backstress", ("pull", "shear", "stretch.explicit"), [1e-3, 1.0, 1e3], along=back)
    yield from far("recovery", ("pull", "shear"), [0.0, 1.0, 1e3, 1e5], along=back)
    yield from far("recovery", ("upset", *STRETCHED), [0.0, 1e3], along=back)
    yield from far("recovery", ("stack", "drag"), [0.0, 1e3], along=back)
    for cycles in (1, 3, 10):
        for recovery in (0.0, 20.0, 1e3):
            yield Case(
                "pull",
                {**back, "strain": 0.1, "cycles": cycles, "recovery": recovery},
                ("load cycles", "recovery"),
                (cycles, recovery),
            )
    yield from single("strain, backstress", ("pull",), [1e-3, 2.0, -2.0], "strain", back)
    yield from single("strain, backstress", ("shear",), [0.1, 3.0, 10.0], "strain", back)
    yield from in_other_words("backstress", back)
    for axis in ("first", "second", "third"):
        for r in (0.1, 0.5, 2.0, 10.0):
            for base in ("pull", "upset", "stretch.explicit"):
                yield Case(
                    base,
                    {**PLASTIC, **FAR[base], "r value": r, "pulled": axis},
                    ("r value", "pulled"),
                    (r, axis),
                )
    hill: Changes = {**PLASTIC, "r value": 3.0}
    yield from far("r value", KINDS_OF_LAWS, [10.0], along=PLASTIC)
    yield from far("r value", ("shear", "slide", "stretch.implicit", "drop.implicit"), [0.1], along=PLASTIC)
    yield from single("strain, Hill", ("pull", "shear"), [1e-2, 2.0], "strain", hill)
    yield from in_other_words("Hill", hill)


def of_hardening() -> Iterator[Case]:
    for hardening in ("Voce", "power law", "Ludwik", "table"):
        along: Changes = {**PLASTIC, "hardening": hardening}
        yield from far("hardening", KINDS_OF_LAWS, [hardening], along=PLASTIC)
        yield from in_other_words(hardening, along)
        yield from single(f"strain, {hardening}", ("pull",), [1e-3, 2.0, -2.0], "strain", along)
        yield from single(f"strain, {hardening}", ("shear",), [0.1, 10.0], "strain", along)
    for hardening in ("power law", "Ludwik"):
        yield from far(
            f"exponent, {hardening}",
            ("pull", "upset", "stretch.explicit"),
            [0.0, 0.01, 0.5, 1.0],
            "exponent",
            {**PLASTIC, "hardening": hardening},
        )
    voce: Changes = {**PLASTIC, "hardening": "Voce"}
    yield from far("saturation", ("pull", "upset", "stretch.explicit"), [1.0, 10.0, 100.0], along=voce)
    yield from far("saturation rate", ("pull", "upset", "stretch.explicit"), [1e-3, 1e3, 1e6], along=voce)


def everything() -> Iterator[Case]:  # noqa: C901
    more: Changes
    yield from of_laws()
    # contact
    yield from single(
        "penalty",
        (
            "upset",
            "slide",
            "stack",
            "drag",
            "clip",
            "drop.explicit",
            "bars.explicit",
            "drop.implicit",
            "bars.implicit",
        ),
        PENALTIES,
    )
    yield from single("penalty", CONTACT, PENALTIES[1::2])
    yield from single(
        "penalty", ("stack", "drag", "clip", "bars.implicit"), PENALTIES[::2], along={"facets": "planed"}
    )
    yield from single("penalty", ("stack", "bars.explicit"), PENALTIES[::2], along={"facets": "bilinear"})
    for base in ("upset", "slide", "ball", "stack", "drag"):
        yield from single(
            "augmented penalty",
            (base,),
            PENALTIES[::2],
            knob="penalty",
            along={"augmentation": 1e-3, **ROUGH},
        )
        yield from single("augmentation", (base,), decades(-8, -1)[::2] + [0.1], along={"penalty": 1.0})
    for base in ("slide", "twist", "drag", "skid.explicit", "skid.implicit"):
        yield from single("tangential penalty", (base,), PENALTIES[::2], along=ROUGH)
    yield from single("mu", FRICTIONAL, MU)
    for law in FRICTION_LAWS[1:]:
        yield from single(
            f"mu, {law}",
            ("slide", "twist", "drag", "skid.explicit", "skid.implicit"),
            MU[2::2],
            "mu",
            {"friction law": law},
        )
    glides = ("glide.explicit", "glide.implicit")
    yield from single("mu", glides, MU)
    yield from product(("penalty", "mu"), glides[:1], PENALTIES[::2] + PENALTIES[-1:], [0.0, 0.3, 1.0])
    yield from product(("penalty", "mu"), glides[1:], PENALTIES[:8:2], [0.0, 0.3, 1.0])
    for law in FRICTION_LAWS[1:]:
        yield from single(f"mu, {law}", glides, [0.1, 0.6, 2.0], "mu", {"friction law": law})
        yield from single(
            f"mu, {law}", ("clip", "fold.explicit", "fold.implicit"), [0.3], "mu", {"friction law": law}
        )
    yield from single("mu", ("fold.explicit", "fold.implicit"), [0.3, 2.0, 10.0])
    yield from single("modulus ratio", glides, [1e-4, 1e-2, 1e2, 1e4], along={"mu": 0.3})
    yield from single("speed", glides, [1e-3, 0.1, 0.3], along={"mu": 0.3})
    yield from product(("penalty", "mu"), ("slide", "drag"), PENALTIES, [0.0, 0.01, 0.1, 0.3, 1.0, 3.0, 10.0])
    yield from product(
        ("penalty", "mu"),
        ("ball", "upset", "skid.explicit", "skid.implicit"),
        PENALTIES[::2],
        [0.01, 0.3, 1.0, 10.0],
    )
    for facets in ("planed", "mean gap", "bilinear", "overlap"):
        for passes in ("one", "two"):
            for base in (
                "stack",
                "drag",
                "clip",
                "bars.explicit",
                "fold.explicit",
                "bars.implicit",
                "fold.implicit",
                "touching",
                "lying.explicit",
            ):
                if base.startswith(("clip", "fold")) != (passes == "two") and (
                    facets == "overlap" or passes == "one"
                ):
                    continue  # a body with itself: two; overlaps between bodies: one
                if facets == "overlap" and base.endswith("explicit"):
                    continue
                yield Case(base, {"facets": facets, "passes": passes}, ("facets",), (f"{facets}, {passes}",))
    # material
    yield from single("nu", ALL, NU[::2] + NU[-1:])
    yield from product(("nu", "element"), ("upset", "pull", "stack"), NU, ELEMENTS)
    yield from product(("nu", "element"), ("drop.explicit", "bar.explicit"), NU[::2], ELEMENTS)
    yield from product(("nu", "step"), ("upset",), NU, STEPS, along={"strain": -0.5})
    yield from product(("nu", "step"), ("pull",), NU, STEPS[::2], along={"strain": 0.5, **PLASTIC})
    hardenings = [-0.1, -1e-3, 0.0, 1e-6, 1e-3, 0.1, 1.0, 10.0]
    yields = [10.0**e for e in range(-8, 1)]
    plastic = (
        "upset",
        "pull",
        "slide",
        "stack",
        "clip",
        "drop.explicit",
        "bars.explicit",
        "drop.implicit",
        "bars.implicit",
    )
    yield from single("hardening modulus", plastic, hardenings, along=PLASTIC)
    yield from single("yield", plastic, yields[:6], along=PLASTIC)
    yield from single(
        "yield", ("upset", "pull", "slide", "drop.explicit", "drop.implicit"), yields[6:7], along=PLASTIC
    )
    for base, sign in (("upset", -1), ("pull", 1), ("stretch.explicit", 1), ("stretch.implicit", 1)):
        for stress, strain in ((0.1, 0.3), (0.1, 1.0), (1.0, 1.5)):
            yield Case(
                base,
                {
                    **PLASTIC,
                    "yield": stress,
                    "strain": sign * strain,
                    **({"strained": True} if base == "upset" else {}),
                },
                ("yield",),
                (stress,),
            )
    yield from single("yield", ("slide", "drag"), yields[:7:2], along={**PLASTIC, "mu": 0.3})
    yield from product(
        ("yield", "hardening modulus"), ("upset", "pull"), yields[:7:2], hardenings[2:], along=PLASTIC
    )
    for base in ("upset", "pull", "slide", "drop.explicit", "drop.implicit"):
        for rule in ("backstress", "Hill", "thermal"):
            yield Case(base, {**PLASTIC, "flow rule": rule}, ("flow rule",), (rule,))
    for hardening in ("Voce", "power law", "table"):
        yield from single(
            "yield",
            ("upset", "pull", "drop.explicit", "drop.implicit"),
            yields[:7:2],
            along={**PLASTIC, "hardening": hardening},
        )
    for base in ALL:
        for element in ELEMENTS:
            for law in LAWS:
                for more in (
                    (AS_IT_IS, PLASTIC)
                    if base not in ("clip", "twist", "fold.implicit", "skid.implicit")
                    else (PLASTIC,)
                ):
                    yield Case(
                        base,
                        {"element": element, "kinematics": law, **more},
                        ("element", "law"),
                        (element, law + (", plastic" if more else "")),
                    )
    # shape and loading
    for law in LAWS:
        for more in (AS_IT_IS, PLASTIC):
            row = strain_of(law, more)
            yield from single(
                row, ("upset",), STRAINS, "strain", {"kinematics": law, "strained": True, **more}
            )
            yield from single(row, ("pull",), STRETCHES, "strain", {"kinematics": law, **more})
            yield from single(
                row,
                ("upset",),
                STRAINS[:3],
                "strain",
                {"kinematics": law, "mu": 0.3, "strained": True, **more},
            )
            yield from single(
                row,
                ("stretch.explicit", "stretch.implicit"),
                STRAINS + STRETCHES,
                "strain",
                {"kinematics": law, **more},
            )
        yield from single(
            strain_of(law),
            ("stretch.explicit", "stretch.implicit"),
            STRAINS[:4] + STRETCHES[4:],
            "strain",
            {"kinematics": law, "element": "one point"},
        )
    aspects = decades(-3, 3)
    yield from single("aspect", ("pull", "stretch.explicit", "stretch.implicit"), aspects)
    yield from single("aspect", ("upset",), aspects, along={"strained": True})
    yield from product(
        ("aspect", "strain"), ("upset",), decades(-3, 3), STRAINS[:6], along={"strained": True}
    )
    yield from product(("aspect", "strain"), ("pull",), decades(-3, 3), STRETCHES[2:])
    for element in ELEMENTS:
        yield from single("grading", ("upset",), decades(0, 4, 2), along={"element": element, "bricks": 4})
        yield from single(
            "distortion",
            ("upset",),
            [0.0, 0.1, 0.3, 0.5, 0.7, 0.8, 0.9, 1.0, 1.5, 3.0],
            along={"element": element},
        )
    yield from single("length", ALL, decades(-9, 6, 1)[::3], knob="length")
    yield from single("radius", ("ball",), decades(-3, 6), along={})
    yield from single("radius", ("ball",), decades(-3, 6), along=ROUGH)
    yield from product(("radius", "penalty"), ("ball",), decades(-2, 4, 1)[::2], PENALTIES[::3])
    for more in (AS_IT_IS, {"mu": 0.3}, {**PLASTIC}):
        for feature in FEATURES:
            yield Case("place", {"feature": feature, **more}, ("feature",), (feature,))
    yield from single("feature", ("place",), FEATURES, along={"penalty": 1e4})
    for turns in (1e-6, 1e-3, 0.1, 1.0, 10.0, 100.0):
        yield Case("twist", {"turns": turns, **ROUGH}, ("turns",), (turns,))
        yield Case("twist", {"turns": turns, "mu": 1.0}, ("turns",), (turns,))
        yield Case(
            "twist", {"turns": 0.02, "oscillations": turns * 10, "mu": 0.3}, ("oscillations",), (turns * 10,)
        )
    for base in ("rest", "touching", "lying.explicit", "lying.implicit"):
        yield from single("penalty", (base,), PENALTIES[::3])
        yield from single("mu", (base,), MU[::4])
        yield from single("length", (base,), decades(-9, 6)[::5], knob="length")
    for base in ("slide",):
        for cycles in (3, 10, 30):
            yield Case(
                base, {"cycles": cycles, "step": 0.05, "mu": 0.3, "slide": 0.01}, ("cycles",), (cycles,)
            )
    # steps and solver
    yield from single("step", STATICS + ("pull",), STEPS)
    yield from single("step", ("slide", "twist", "drag", "ball"), STEPS[1:], along={"mu": 0.3})
    yield from single("step", ("upset", "pull"), STEPS[3:], along={**PLASTIC, "strain": -0.5})
    for base in ("upset", "slide", "ball", "stack", "drag", "clip"):
        yield Case(
            base,
            {"first step": 1.0, "largest step": 10.0, "mu": 0.2},
            ("whole load",),
            ("at once",),
            like={"mu": 0.2},
            count="",
            loose=0.1,
        )
    for tangent in (
        "exact",
        "numerical",
        "consistent",
        "continuum",
        "symmetrised upper",
        "symmetrised lower",
        "symmetrised mean",
    ):
        for strain in (-0.5, -1.0):
            yield Case(
                "upset",
                {"tangent": tangent, "first step": 1.0, "largest step": 10.0, "strain": strain, **ROUGH},
                ("tangent", "whole load"),
                (tangent, "at once"),
            )
        for base in ("upset", "slide", "ball", "twist"):
            for mu in (0.0, 0.3):
                yield Case(base, {"tangent": tangent, "mu": mu}, ("tangent",), (tangent,))
        yield Case("drag", {"tangent": tangent, "mu": 0.3}, ("tangent",), (tangent,))
    for base in ("upset", "slide", "ball", "drag"):
        for predictor in ("extrapolation", "tangent"):
            yield Case(base, {"predictor": predictor, **ROUGH}, ("predictor",), (predictor,))
        for search in ("energy", "none"):
            yield Case(base, {"line search": search, **ROUGH}, ("line search",), (search,))
        for tangent in ("exact", "symmetrised"):
            yield Case(
                base,
                {"material tangent": tangent, "kinematics": "hypoelastic", **ROUGH, **PLASTIC},
                ("material tangent",),
                (tangent,),
            )
    yield from single(
        "tolerance",
        ("upset", "slide", "ball", "stack", "drag", "drop.implicit"),
        [10.0**-e for e in range(1, 16, 2)],
        along=ROUGH,
    )
    for solver in ("MUMPS", "MUMPS symmetric", "KLU", "CG", "GMRES"):
        for base in ("upset", "slide", "stack", "drag", "drop.implicit", "bars.implicit"):
            for penalty in (1.0, 1e5):
                yield Case(
                    base, {"solver": solver, "penalty": penalty}, ("solver", "penalty"), (solver, penalty)
                )
    for profile in ("fast", "accurate"):
        for base in ("upset", "slide", "ball", "stack", "drag", "clip") + DYNAMIC + EXPLICIT:
            yield Case(base, {"profile": profile, **ROUGH}, ("profile",), (profile,))
    # several bodies
    ratios = decades(-6, 6)
    yield from single("modulus ratio", ("stack", "drag", "bars.explicit", "bars.implicit"), ratios)
    yield from single("modulus ratio", ("stack", "drag"), ratios[::2], along={"facets": "planed"})
    yield from single("density ratio", ("bars.explicit", "bars.implicit"), ratios)
    yield from product(
        ("density ratio", "modulus ratio"), ("bars.explicit", "bars.implicit"), ratios[::3], ratios[::3]
    )
    # motion
    speeds = [1e-6, 1e-4, 1e-3, 0.01, 0.05, 0.1, 0.3, 1.0]
    yield from single(
        "speed",
        ("drop.explicit", "bar.explicit", "bars.explicit", "skid.explicit", "fold.explicit"),
        speeds[2:],
    )
    yield from single(
        "speed", ("drop.implicit", "bar.implicit", "bars.implicit", "skid.implicit"), speeds[2:]
    )
    yield from single(
        "speed",
        ("drop.explicit", "bar.explicit", "drop.implicit"),
        speeds[2:],
        along={**PLASTIC, "yield": 1e-3},
    )
    for resolution in (1.0, 2.0, 4.0):
        yield from single(
            "speed",
            ("drop.explicit", "bars.explicit"),
            speeds[3:],
            along={"resolution": resolution, "penalty": 1.0},
        )
    yield from product(("speed", "bricks"), ("bar.explicit", "drop.explicit"), speeds[3:], [1, 2, 4, 8])
    yield from single("safety", EXPLICIT, [0.01, 0.1, 0.5, 0.9, 0.99, 1.0])
    yield from single("safety", EXPLICIT[:1], [0.0, 1.01, 2.0])
    yield from product(
        ("safety", "resolution"), ("drop.explicit", "bars.explicit"), [0.5, 0.9, 0.99, 1.0], [1.0, 2.0, 4.0]
    )
    yield from single("mass scaling", ("drop.explicit", "bars.explicit"), [1e-6, 1e-4, 1e-3])
    yield from single(
        "linear viscosity", ("drop.explicit", "bar.explicit", "bars.explicit"), [0.0, 0.06, 0.5, 1.0, 3.0]
    )
    yield from single(
        "instructions", ("drop.explicit", "bars.explicit"), ("scalar", "SSE2", "AVX2", "AVX-512")
    )
    yield from single("number type", EXPLICIT, ("double", "float"))
    yield from product(("number type", "length"), EXPLICIT, ("float",), decades(-9, 6)[::5])
    for base in EXPLICIT:
        for element in ELEMENTS:
            for law in LAWS:
                for more in (AS_IT_IS, PLASTIC):
                    yield Case(
                        base,
                        {"number type": "float", "element": element, "kinematics": law, **more},
                        ("number type", "element", "law"),
                        ("float", element, law + (", plastic" if more else "")),
                    )
    yield from single("step", DYNAMIC, [1e-3, 0.01, 0.05, 0.2, 1.0])
    for method in ("Newmark", "HHT-alpha", "generalised-alpha"):
        for base in DYNAMIC:
            for mass in ("consistent", "lumped"):
                yield Case(base, {"method": method, "mass": mass}, ("method",), (method,))
    yield from single(
        "spectral radius",
        ("drop.implicit", "bars.implicit", "skid.implicit"),
        [0.0, 0.2, 0.5, 0.8, 0.95, 1.0],
    )
    yield from single(
        "error tolerance", ("drop.implicit", "bars.implicit"), [0.0, 1e-1, 1e-2, 1e-4, 1e-5], along={}
    )
    for steps in (10, 100, 1000):
        yield Case("pile.explicit", {"cycles": steps, "mu": 0.5}, ("explicit steps",), (steps * 1000,))
    # the same in other words
    units = {
        "m, N": (1e-3, 1e6, 1.0),
        "m, kN": (1e-3, 1e3, 1.0),
        "um, N": (1e3, 1e-6, 1.0),
        "mm, N, ms": (1.0, 1.0, 1e3),
        "miles, years": (6.2e-7, 1e-9, 3.17e-8),
        # Of these nothing is rounded: all must be the same to the last digit.
        "2^-10 lengths": (2.0**-10, 1.0, 1.0),
        "2^20 stresses": (1.0, 2.0**20, 1.0),
        "all by powers of 2": (2.0**20, 2.0**-30, 2.0**10),
    }
    for base in ALL:
        for name, (length, stress, time) in units.items():
            more = ROUGH if base in FRICTIONAL else {}
            if base.startswith("skid"):
                # a block that hops on its penalties doubles round-off with each hop
                more = {**more, "duration": 0.1}
            yield Case(
                base,
                {**more, "length": length, "stress": stress, "time": time},
                ("units",),
                (name,),
                like=dict(more),
                count="exact" if "2^" in name or "powers" in name else "nearly",
                loose=(
                    1e-9
                    if "2^" in name or "powers" in name
                    else 1e-6
                    if not base.endswith("implicit")
                    else 1e-5
                ),
            )
        if base in EXPLICIT:
            length, stress, time = units["all by powers of 2"]
            more = {"number type": "float", **({"duration": 0.1} if base.startswith("skid") else {})}
            yield Case(
                base,
                {**more, "length": length, "stress": stress, "time": time},
                ("units",),
                ("float, all by powers of 2",),
                like=more,
                count="exact",
                loose=1e-9,
            )
        # supports along axes, meshes and velocities that are formulas
        if base not in ("pull", "clip", "fold.explicit", "fold.implicit"):
            for degrees in (1e-6, 90.0, 137.0):
                more = ROUGH if base in FRICTIONAL else {}
                if base.startswith("skid"):
                    more = {**more, "duration": 0.1}
                yield Case(
                    base,
                    {**more, "turned": degrees},
                    ("turned",),
                    (degrees,),
                    like=dict(more),
                    count="",
                    loose=(
                        1e-3
                        if base.endswith(("implicit", "explicit"))
                        else AUGMENTED
                        if base in FRICTIONAL
                        else 2e-5
                    ),
                )
    for base in ("upset", "slide", "stack", "drop.explicit"):
        for law in LAWS:
            for element in ELEMENTS:
                more = {"kinematics": law, "element": element, **PLASTIC}
                yield Case(
                    base, {**more, "turned": 50.0}, ("turned",), (50.0,), like=more, count="", loose=1e-3
                )

    # light loads on stiff penalties: round-off is nearest
    lights = [1e-7, 1e-5, 1e-3]
    yield from product(("strain", "penalty"), ("upset",), [-x for x in lights], PENALTIES[6:])
    yield from product(("press", "penalty"), ("slide", "stack"), lights, PENALTIES[6:], along={"slide": 1e-5})
    # tools that forces and moments drive, and loads
    forces = [1e-8, 1e-6, 1e-4, 1e-2, 0.1, 0.3]
    yield from product(("force", "penalty"), ("upset",), forces, [0.1, 10.0, 1e5])
    yield from single("force", ("upset",), forces[2:5], along={**PLASTIC, "hardening modulus": 1.0})
    yield from single("moment", ("twist",), [1e-8, 1e-6, 1e-4, 1e-3, 0.1], along={"mu": 0.3})
    yield from single("moment", ("twist",), [1e-4, 1e-3], along={"mu": 2.0, "penalty": 1e3})
    yield from product(
        ("load", "penalty"), ("laden.explicit", "laden.implicit"), [1e-8, 1e-5, 1e-3, 0.1], [1.0, 1e4]
    )
    yield from single("spring", ("laden.explicit", "laden.implicit"), [1e-6, 1e-2, 1.0, 1e3])
    # between bodies: what is searched, and how normals are made
    yield from product(
        ("edges", "penalty"), ("bars.explicit", "fold.explicit", "lying.explicit"), ["true"], [1.0, 1e3]
    )
    yield from single("smoothing", ("drag", "stack"), [0.05, 0.25, 0.5], along={"facets": "planed"})
    yield from single("smoothing", ("bars.explicit", "fold.explicit"), [0.05, 0.5])
    yield from single("margin", ("drag", "clip", "fold.explicit", "bars.implicit"), [0.01, 0.1, 1.0, 10.0])
    # what a run believes to be off, beside what it is off a fine one
    fine: Changes = {"augmentation": 1e-4, "first step": 5e-3, "largest step": 5e-3, "tolerance": 1e-9}
    for base, more in (
        ("upset", {**ROUGH, **PLASTIC}),
        ("slide", ROUGH),
        ("ball", {**ROUGH, **PLASTIC}),
        ("twist", {"mu": 0.3}),
        ("drag", ROUGH),
        ("stack", PLASTIC),
    ):
        for target in (0.1, 0.03, 0.01, 0.003):
            yield Case(
                base,
                {"target error": target, **more},
                ("target error",),
                (target,),
                like={**more, **fine},
                count="believed",
            )
    # pairs in which round-off, stiffness and compressibility meet
    small = [1e-7, 1e-6, 1e-5, 1e-3, 0.1, 1.0]
    yield from product(("nu", "strain"), ("pull",), [-0.9, 0.0, 0.45, 0.499, 0.4999], small)
    yield from product(
        ("nu", "strain"),
        ("upset",),
        [-0.9, 0.0, 0.45, 0.499, 0.4999],
        [-s for s in small[1:]],
        along={"strained": True},
    )
    yield from product(("modulus ratio", "penalty"), ("stack",), [1e-6, 1e-3, 1e3, 1e6], PENALTIES[2::2])
    yield from product(("modulus ratio", "press"), ("stack",), [1e-6, 1e-3, 1e3, 1e6], [1e-7, 1e-5, 1e-3])
    yield from product(
        ("nu", "penalty"), ("stack", "slide"), [-0.9, 0.0, 0.49, 0.4999], PENALTIES[2::2], along=ROUGH
    )
    yield from product(("mu", "nu"), ("slide", "drag"), [0.1, 1.0, 5.0], [-0.9, 0.0, 0.49, 0.4999])
    yield from product(("aspect", "penalty"), ("upset",), [1e-3, 0.1, 10.0, 1e3], PENALTIES[2::2])
    yield from product(("step", "penalty"), ("upset", "slide"), [1e-6, 1e-4, 0.01, 0.1], PENALTIES[2::2])
    yield from product(
        ("yield", "penalty"), ("upset", "stack"), [1e-8, 1e-4, 1e-3], PENALTIES[2::2], along=PLASTIC
    )
    yield from product(
        ("speed", "penalty"),
        ("drop.explicit", "drop.implicit", "bars.explicit"),
        [1e-3, 0.03, 0.3],
        PENALTIES[2:8],
    )
    # tools of all sizes and shapes in motion, and strains and shapes of elements
    strikes, presses = ("strike.explicit", "strike.implicit"), ("press.explicit", "press.implicit")
    yield from single("radius", strikes, decades(-3, 6))
    yield from product(("radius", "speed"), strikes, [1e-3, 1e-2, 0.1, 10.0, 1e3], [1e-3, 0.1, 0.3, 1.0])
    yield from product(("radius", "penalty"), strikes, [1e-3, 1e-2, 0.1, 1e3], [0.1, 1.0, 100.0, 1e4])
    for more in (AS_IT_IS, {"mu": 0.3}, {**PLASTIC}):
        yield from single("feature", strikes, FEATURES, along=more)
    for more in (AS_IT_IS, {"mu": 0.3}):
        yield from product(("feature", "speed"), strikes, FEATURES, [0.03, 0.1, 0.15, 0.3, 1.0], along=more)
    yield from product(
        ("feature", "penalty"), strikes, ["rectangle", "disc"], [1.0, 100.0, 1e3, 1e5], along={"speed": 0.3}
    )
    for turns in (1e-3, 0.03, 1.0, 10.0):
        yield from single("turns", strikes, [turns], along={"mu": 0.3, "feature": "coincident"})
        yield from single(
            "oscillations", strikes, [10 * turns], along={"turns": 0.02, "mu": 0.3, "feature": "coincident"}
        )
    for more in (AS_IT_IS, {**PLASTIC}, {**PLASTIC, "hardening modulus": 0.0}):
        yield from single(strain_of("Hencky", more), presses, STRAINS, "strain", {"strained": True, **more})
    yield from single(
        strain_of("neo-Hookean"),
        presses,
        STRAINS[:4],
        "strain",
        {"strained": True, "kinematics": "neo-Hookean"},
    )
    yield from single(
        strain_of("Hencky", PLASTIC),
        presses,
        STRAINS[:4],
        "strain",
        {**PLASTIC, "strained": True, "element": "one point"},
    )
    yield from single("aspect", presses, aspects, along={"strained": True})
    yield from product(
        ("aspect", "strain"), presses, aspects[::2], STRAINS[:4], along={"strained": True, **PLASTIC}
    )
    for element in ELEMENTS:
        yield from single("grading", presses, decades(0, 4, 2), along={"element": element, "bricks": 4})
        yield from single("distortion", presses, [0.1, 0.3, 0.5, 0.7, 1.0, 3.0], along={"element": element})
    # loads above what a perfectly plastic body bears
    yield from product(
        ("yield", "load"),
        ("laden.explicit", "laden.implicit"),
        [1e-4, 0.01],
        [1e-3, 0.1],
        along={**PLASTIC, "hardening modulus": 0.0},
    )


# Some of each kind, seconds altogether: what ctest runs.
FIXED = (
    "upset/penalty=0.001",
    "upset/penalty=1e+06",
    "upset/nu=0.4999,element=mean dilatation",
    "upset/kinematics=neo-Hookean,strained=True,strain=-1",
    "upset/law=elastoplastic,hardening modulus=0",
    "upset/law=elastoplastic,hardening modulus=-0.1",
    "upset/law=elastoplastic,flow rule=Hill",
    "pull/law=elastoplastic,flow rule=backstress",
    "drop.explicit/law=elastoplastic,flow rule=thermal",
    "upset/element=one point,distortion=3",
    "upset/strained=True,aspect=1000,strain=-0.5",
    "upset/mu=0.2,length=0.000976562,stress=1,time=1 like mu=0.2",
    "pull/kinematics=Hencky,strain=2",
    "slide/penalty=10000,mu=0.3",
    "slide/mu=10",
    "slide/mu=0.3,step=1",
    "slide/friction law=shear limited,mu=0.6",
    "slide/mu=0.2,turned=137 like mu=0.2",
    "ball/radius=0.001",
    "place/feature=seams",
    "place/feature=rectangle",
    "upset/tangent=numerical,first step=1,largest step=10,strain=-1,mu=0.2",
    "rest/penalty=1000",
    "stack/modulus ratio=1e+06",
    "stack/nu=0.4999",
    "stack/facets=planed,penalty=10",
    "drag/mu=0.3",
    "touching/mu=0.1",
    "clip/penalty=100",
    "drop.explicit/speed=0.3",
    "bar.explicit/safety=0.99",
    "bars.explicit/density ratio=100",
    "bars.explicit/turned=90 like the base",
    "skid.explicit/mu=0.3",
    "fold.explicit/speed=0.01",
    "lying.explicit/penalty=1000",
    "drop.implicit/nu=0.45",
    "bar.implicit/penalty=1",
    "bars.implicit/modulus ratio=10",
    "skid.implicit/mu=0.01",
    "fold.implicit/nu=0",
    "lying.implicit/mu=0.1",
    "bars.explicit/number type=float",
    "upset/force=0.01,penalty=10",
    "laden.explicit/load=0.001,penalty=1",
    "laden.implicit/spring=1",
    "twist/mu=0.3,moment=0.0001",
    "drag/facets=planed,smoothing=0.5",
    "clip/margin=0.1",
    "bars.explicit/edges=true,penalty=1",
    "strike.explicit/feature=apex",
    "strike.explicit/feature=rectangle,speed=0.3",
    "strike.implicit/feature=disc,speed=0.3",
    "strike.implicit/radius=0.1",
    "strike.implicit/mu=0.3,feature=coincident,turns=1",
    "press.explicit/strained=True,law=elastoplastic,strain=-2.99573",
    "stretch.explicit/kinematics=Hencky,strain=0.5",
    "stretch.implicit/kinematics=neo-Hookean,strain=-1",
    "upset/strained=True,aspect=0.001,strain=-2.99573",
    "pull/kinematics=Yeoh,nu=0.49,strain=2.99573",
    "membrane/strain=0.5,kinematics=Arruda-Boyce,nu=0.49,constant=1.05",
    "stack/kinematics=Ogden,nu=0.49999",
    "pull/strain=0.5,prony=0.6,kinematics=Yeoh,ramp=0.01,relaxation=0.1",
    "pull/strain=0.5,law=elastoplastic,rate factor=Cowper-Symonds,rate=1e+06",
    "shear/strain=1,law=elastoplastic,thermal factor=Johnson-Cook,temperature=0,heat=10",
    "pull/law=elastoplastic,flow rule=backstress,strain=0.1,cycles=3,recovery=20",
    "pull/law=elastoplastic,strain=0.5,r value=0.1,pulled=second",
    "shear/strain=5,law=UMAT,kinematics=hypoelastic",
    (
        "slide/target error=0.1,mu=0.2 like mu=0.2,augmentation=0.0001,first step=0.005,largest"
        " step=0.005,tolerance=1e-09"
    ),
)
