# SPDX-License-Identifier: LGPL-2.1-or-later
"""What became of all scenes: extremes.md with its tables, and pictures over pairs of parameters."""

from __future__ import annotations

import math
import re
from collections import Counter, defaultdict
from pathlib import Path
from typing import AbstractSet, Any, Sequence

from matplotlib import pyplot
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from billet_tools.records import Record
from billet_tools.text import quoted, table, wrapped

from .invariants import NUDGE, SYMMETRIES
from .runner import AT_MOST, DEEP, OUTCOMES, PATIENCE
from .laws import RATE_FACTORS, RUBBER, THERMAL_FACTORS, VOLUMETRIC
from .plan import FRICTION_LAWS
from .scenes import KINDS, KNOBS

Records = Sequence[Record]

COLOURS = {
    "right": "#4c9f70",
    "warned": "#7fbf94",
    "soft": "#b9dcc3",
    "doubtful": "#c7dc6b",
    "refused": "#9db4d6",
    "failed": "#f2c14e",
    "unhelpful": "#e08e45",
    "wrong": "#d1495b",
    "crashed": "#3b0f2b",
    "hung": "#7a5195",
    None: "#f4f4f4",
}
WORDS = {
    "penalty": "penalty, E/h",
    "augmented penalty": "penalty, E/h, with augmentation",
    "mu": "friction coefficient",
    **{f"mu, {law}": f"friction coefficient, `{law}`" for law in FRICTION_LAWS[1:]},
    "nu": "Poisson's ratio",
    "step": "fixed step, of the load",
    "aspect": "height over width of a brick",
    "yield": "yield stress, E",
    "hardening modulus": "hardening modulus, E",
    "flow rule": "flow rule of the plasticity",
    "augmentation": "`Penetration tolerance`",
    "tangential penalty": "tangential penalty, E/h",
    "grading": "largest over smallest element",
    "distortion": "inner node moved, bricks",
    "length": "length of the scene",
    "radius": "radius of the tool, block sizes",
    "turns": "turns of a tool",
    "oscillations": "oscillations of a tool",
    "cycles": "cycles of friction",
    "tolerance": "`Force tolerance`",
    "modulus ratio": "ratio of moduli",
    "density ratio": "ratio of densities",
    "speed": "speed, wave speeds",
    "safety": "`Safety factor`",
    "resolution": "`Contact resolution`",
    "mass scaling": "`Mass scaling step`",
    "linear viscosity": "`Linear bulk viscosity`",
    "spectral radius": "`Spectral radius`",
    "error tolerance": "`Error tolerance`",
    "bricks": "bricks along an edge",
    "feature": "feature of a tool on nodes",
    "turned": "scene turned, degrees",
    "units": "units",
    "facets": "`Facets`, `Passes`",
    "element": "`Element`",
    "law": "`Elasticity`",
    "tangent": "`Contact tangent`",
    "solver": "`Linear solver`",
    "method": "`Method`",
    "profile": "`Profile`",
    "instructions": "`Instruction set`",
    "number type": "`Number type`",
    "whole load": "whole load in the first step",
    "force": "force on a tool, E",
    "moment": "moment on a tool, E",
    "load": "pressure, E",
    "spring": "stiffness of springs, E",
    "edges": "`Edge contact`",
    "smoothing": "`Smoothing`",
    "margin": "`Search margin`",
    "target error": "`Target error`",
    "press": "travel of a tool, block sizes",
    "explicit steps": "explicit steps of a resting pile",
    "predictor": "`Predictor`",
    "line search": "`Line search`",
    "material tangent": "`Material tangent`",
    "hardening": "`Hardening`",
    "user law": "law of a user's library",
    "rate factor": "`Rate factor`",
    "rate exponent": "exponent of Cowper and Symonds",
    "rate coefficient": "coefficient of Johnson and Cook",
    "thermal factor": "`Thermal factor`",
    "thermal exponent": "exponent of the thermal factor",
    "volumetric": "`Volumetric law`",
    "prony": "share of the stress that relaxes",
    "relaxation": "relaxation time, of the scene's",
    "backstress": "modulus of the backstress, yield stresses",
    "recovery": "recovery rate of the backstress",
    "r value": "r-values of Hill's function",
    "pulled": "material axis that is pulled",
    "saturation": "saturation stress, yield stresses",
    "saturation rate": "saturation rate of Voce's hardening",
    "load cycles": "cycles of a bar that yields",
}
# Rows of a knob for each law that has it: 'rate, table'.
WORDS_OF_LAWS = {
    "constant": "constant of rubber",
    "exponent": "hardening exponent",
    "heat": "heat, ways to melting per strain",
    "nu": "Poisson's ratio",
    "rate": "rate of strain over the reference rate",
    "strain": "logarithmic strain",
    "temperature": "temperature, 0 at room, 1 at melting",
    "yield": "yield stress, E",
}
COLUMNS = {
    "statics": lambda base: "." not in base,
    "implicit dynamics": lambda base: base.endswith(".implicit"),
    "explicit": lambda base: base.endswith(".explicit"),
}


STRAINS = (
    "strain",
    *(
        f"strain{law}{yields}"
        for law in ("", ", neo-Hookean", ", hypoelastic")
        for yields in ("", ", yields")
        if law or yields
    ),
)
WORDS |= {row: "logarithmic strain" + row[len("strain") :] for row in STRAINS}
KNOB_OF: dict[str, str] = {
    "augmented penalty": "penalty",
    **dict.fromkeys(STRAINS, "strain"),
    "user law": "law",
    "load cycles": "cycles",
}
DEFAULTS: dict[str, Any] = {**KNOBS, "law": "Hencky"}
PENALTIES = ("penalty", "augmented penalty")
STRAINED = (*STRAINS, "aspect")  # a penalty that is soft would hide what they do


def knob_of(parameter: str) -> str:
    first = parameter.partition(", ")[0]
    return KNOB_OF.get(parameter, first if first in WORDS_OF_LAWS else parameter)


def words_of(parameter: str) -> str:
    first, comma, law = parameter.partition(", ")
    known = WORDS.get(parameter)
    return known or (f"{WORDS_OF_LAWS[first]}{comma}{law}" if first in WORDS_OF_LAWS else parameter)


def shown(value: object) -> str:
    return f"{value:.5g}" if isinstance(value, float) else str(value)


def alone(records: Records, parameter: str) -> list[Record]:
    return [r for r in records if parameter in r["parameters"]]


def outcome_of(record: Record) -> str | None:
    """As the tables have it: where all that must hold does, but a penalty is soft, "soft", or "warned" if
    only a warning says by how much."""
    if record.get("outcome") != "right" or not record.get("soft"):
        return record.get("outcome")
    return (
        "soft"
        if record.get("depth", DEEP) > DEEP
        or "penalty-too-low" in record.get("warnings", ["penalty-too-low"])
        else "warned"
    )


def is_default(record: Record, but: str | None = None) -> bool:
    return all(
        p == but or v == DEFAULTS.get(knob_of(p)) for p, v in zip(record["parameters"], record["values"])
    )


def variant(record: Record) -> str:
    """The scene in which its parameters are turned: the base, with what is set beside."""
    turned = {knob_of(p) for p in record["parameters"]}
    return "/".join(
        [
            record.get("base", ""),
            *(f"{p}={v}" for p, v in record.get("changes", {}).items() if p not in turned),
        ]
    )


def soft_by_default(records: Records) -> set[str]:
    """The scenes whose penalty is soft whatever other parameter is turned."""
    return {variant(r) for r in records if is_default(r) and outcome_of(r) == "soft"}


def safe(records: Records, parameter: str, soft: AbstractSet[str] = frozenset()) -> str:
    """Of the scenes in which this parameter alone is turned, any other being as it is by default: the values,
    in a row around the default, at which all are right, and no penalty is soft, but for those that are `soft`
    by default where it is not about penalties; words: those at which all are. Where it is never turned alone,
    of all its scenes: what is soft there is so by the other one."""
    own = [r for r in alone(records, parameter) if is_default(r, parameter)]
    if not own:
        pairs = alone(records, parameter)
        return f"{span(pairs, parameter)}, in pairs" if pairs else ""
    is_strict = parameter in PENALTIES + STRAINED or knob_of(parameter) == "strain"
    return span(
        [
            (
                r
                if not is_strict and (variant(r) in soft or outcome_of(r) == "warned")
                else {**r, "outcome": outcome_of(r)}
            )
            for r in own
        ],
        parameter,
    )


def span(own: Records, parameter: str) -> str:
    by_value = defaultdict(set)
    for r in own:
        by_value[r["values"][r["parameters"].index(parameter)]].add(r["outcome"])
    good = {v for v, outcomes in by_value.items() if outcomes == {"right"}}
    if any(isinstance(v, str) for v in by_value):
        bad = [v for v in by_value if v not in good]
        return (
            "all"
            if not bad
            else f"all but {', '.join(map(str, bad))}"
            if len(bad) <= 3
            else f"{len(good)} of {len(by_value)}"
        )
    values = sorted(by_value)
    if not good:
        return "-"
    default = DEFAULTS.get(knob_of(parameter))
    runs, row = [], []
    for v in values + [None]:
        if v in good:
            row.append(v)
        elif row:
            runs.append(row)
            row = []

    def worth(run: list[float]) -> tuple[bool, int]:
        holds = default is not None and isinstance(default, (int, float)) and run[0] <= default <= run[-1]
        return holds, len(run)

    best = max(runs, key=worth)
    return shown(best[0]) if len(best) == 1 else f"{shown(best[0])} to {shown(best[-1])}"


def tried(records: Records, parameter: str) -> str:
    values = {r["values"][r["parameters"].index(parameter)] for r in alone(records, parameter)}
    if any(isinstance(v, str) for v in values):
        return f"{len(values)} of them"
    return f"{shown(min(values))} to {shown(max(values))}"


def shortened(text: str, width: int) -> str:
    """The first whole words of a text."""
    return text if len(text) <= width else text[: width + 1].rpartition(" ")[0] + " ..."


def reasons(records: Records, outcome: str) -> list[tuple[str, list[Record]]]:
    """Messages without their numbers and names, most frequent first."""
    found = defaultdict(list)
    for r in records:
        if r["outcome"] == outcome:
            words = re.sub(r"^scene\.prm(:\d+)?: ", "", r["reason"])
            words = re.sub(r"^.*? (?=after \d+ accepted)", "the step failed ", words)
            words = re.sub(r"\([^()]*\d[^()]*\)", "(...)", words)
            words = re.sub(r"-?\d[\d.]*(e[-+]?\d+)?", "#", words)
            words = re.sub(r"'(Bodies|Tools|Contact pairs) / [^']*'|pair '[^']*'", "...", words)
            words = re.sub(r"; residual # of the forces.*", "", words)
            found[shortened(words, 220)].append(r)
    return sorted(found.items(), key=lambda item: -len(item[1]))


def examples(records: Records) -> str:
    """One of each kind of scene, at most three, those with the fewest parameters."""
    first: dict[str, str] = {}
    for r in sorted(records, key=lambda r: (len(r["parameters"]), len(r["name"]))):
        first.setdefault(r["base"], r["name"])
    return ", ".join(f"`{name}`" for name in list(first.values())[:3])


def programs(records: Records, ours: str) -> str:
    """In words: which programs the outcomes are of; `ours`: the one that is named now."""
    count = Counter(r["program"] for r in records)
    checks = Counter(r.get("checks of") for r in records)
    if set(count) == {ours}:
        return "All of them ran with one and the same program" + (
            ", and were judged by the same checks."
            if len(checks) == 1
            else f"; {len(records) - max(checks.values())} were judged by older checks."
        )
    now = count.pop(ours, 0)
    others = ", ".join(f"{n} with {name}" for name, n in count.most_common())
    other = sum(count.values())
    return (
        f"{now} scene{'s' * (now != 1)} ran with the program as it is"
        + f", {other} with {'one other state' if len(count) == 1 else f'{len(count)} other states'} of it"
        " and are kept from then. The command `scripts/extremes --stale` runs these once more.\n\n"
        f"- Other states: {others}.\n"
        "- Outcomes with them: "
        + ", ".join(
            f"{n} {o}"
            for o, n in Counter(r["outcome"] for r in records if r["program"] != ours).most_common()
        )
        + "."
    )


def units(records: Records) -> str:
    """In words: how many take another number of iterations in other units."""
    named: list[bool] = []
    exact: list[bool] = []
    for r in records:
        if r["parameters"] == ["units"] and "errors" in r:
            differs = any(error for name, error in r["errors"].items() if name.startswith("as many"))
            (exact if re.search(r"2\^|powers", str(r["values"][0])) else named).append(differs)
    if not named or not exact:
        return ""
    same = named.count(False)
    return (
        f"Of {len(named)} scenes in other units {same} take{'s' * (same == 1)} as many steps, cuts and"
        f" iterations, {named.count(True)} one or two iterations more or less. Of {len(exact)} in units that"
        f" differ by powers of 2, {exact.count(False)} take as many."
    )


def slow(records: Records) -> str:
    """In words, and in a table: what took longer than hung runs are given for a step."""
    took = sorted(((r.get("processor seconds", r["seconds"]), r) for r in records), key=lambda pair: -pair[0])
    long = [(s, r) for s, r in took if s > PATIENCE]
    if not took:
        return ""
    if not long:
        return (
            f"None took more than {PATIENCE:g} s of the processor; the longest, `{took[0][1]['name']}`,"
            f" {took[0][0]:.0f} s."
        )
    return f"{len(long)} took more than {PATIENCE:g} s of the processor. The longest are:\n\n" + table(
        ["scene", "seconds", "outcome", "steps"],
        [
            [f"`{r['name']}`", f"{s:.0f}", r["outcome"], f"{r['steps']:.0f}" if "steps" in r else ""]
            for s, r in long[:5]
        ],
    )


def forgetful(records: Records) -> str:
    """In words, and in a table: motions in which a symmetry is lost to round-off."""
    lost = [r for r in records if r["outcome"] == "right" and r.get("sensitivity")]
    if not lost:
        return ""
    return (
        f"In {len(lost)} motion{'s' * (len(lost) > 1)} with chatter round-off grows until symmetry is lost."
        f" They ran once more, nudged at the start by {NUDGE:g} of velocity and size. Displacements at the"
        " end then differ by as much, or at least a tenth of it. Among them are:\n\n"
        + table(
            ["scene", "loss of symmetry", "difference, nudged"],
            [
                [
                    f"`{r['name']}`",
                    f"{max(r['errors'].get(name, 0) for name in SYMMETRIES):.1g}",
                    f"{r['sensitivity']:.1g}",
                ]
                for r in lost[:5]
            ],
        )
    )


# Why a scene comes out otherwise than before 2026-11-22, by its name: each was run with mean dilatation, too,
# the element of then.
REASONS = (
    (r"drag/.*mu=0\.3|laden\.implicit/|bar\.explicit/", "the element: with mean dilatation it ends"),
    (r"drop\.explicit/", "the element: with mean dilatation no corner turns inside out"),
    (
        r"drag/.*mu=10|drop\.implicit/|press\.|stretch\..*hypoelastic|strike\.implicit/",
        "the element: with mean dilatation it fails as before",
    ),
    (r"stretch\.", "the element: mean dilatation turns corners inside out, or leaves the uniform state"),
    (r"strike\.explicit/|slide/|upset/", "contact: it ends with both elements"),
)


def reason_for(name: str) -> str:
    return next((reason for pattern, reason in REASONS if re.match(pattern, name)), "")


LAWS = {
    **{f"rubber, {law}": ("kinematics", law) for law in RUBBER},
    **{f"volumetric law, {law}": ("volumetric", law) for law in VOLUMETRIC[1:]},
    "Prony's series": ("prony", None),
    **{f"rate factor, {factor}": ("rate factor", factor) for factor in RATE_FACTORS},
    **{f"thermal factor, {factor}": ("thermal factor", factor) for factor in THERMAL_FACTORS},
    "heat of plastic work": ("heat", None),
    "backstress": ("flow rule", "backstress"),
    "Hill, r-values": ("r value", None),
    "Hill, ratios of stresses": ("flow rule", "Hill"),
    **{f"hardening, {name}": ("hardening", name) for name in ("Voce", "power law", "Ludwik", "table")},
    "UMAT": ("law", "UMAT"),
}


def of_laws(records: Records, outcomes: Sequence[str | None]) -> list[str]:
    """A table of the laws beyond linear hardening and the three elastic ones, in words and numbers."""
    rows = []
    for law, (knob, value) in LAWS.items():
        mine = [r for r in records if knob in r["changes"] and value in (None, r["changes"][knob])]
        if mine:
            count = Counter(map(outcome_of, mine))
            kinds = [kind for kind, bases in KINDS.items() if any(r["base"] in bases for r in mine)]
            rows.append([law, len(mine), *[count[o] or "" for o in outcomes], len(kinds)])
    if not rows:
        return []
    return [
        "## By law",
        "A scene with several of these laws counts in each of their rows. *Kinds* is the number of kinds of"
        " run, of those in the table of outcomes.",
        table(["law", "scenes", *outcomes, "kinds"], rows),
    ]


def changed(records: Records, before: Records) -> list[str]:
    """A section on the scenes that have come out otherwise than an older version's."""
    then = {r["name"]: r for r in before}
    both = [(then[r["name"]], r) for r in records if r["name"] in then]
    other = sorted(
        ((a, b) for a, b in both if a["outcome"] != b["outcome"]),
        key=lambda pair: (pair[0]["outcome"], pair[1]["outcome"], pair[1]["name"]),
    )
    if not both:
        return []

    def said(older: Record, newer: Record) -> str:
        words = " ".join((newer["reason"] or older["reason"]).split())
        return shortened(re.sub(r"^scene\.prm(:\d+)?: ", "", words), 200).replace("|", "\\|")

    return [
        "## Another outcome than before",
        (
            f"{len(both)} of these scenes ran with an older version, too; {len(other)} came out otherwise."
            " The last column is what the program says now, or what it said before where it says nothing now."
            " The reason is from the same scene with mean dilatation, the default before."
        ),
        table(
            ["before", "now", "scene", "reason", "said"],
            [
                [a["outcome"], b["outcome"], f"`{b['name']}`", reason_for(b["name"]), said(a, b)]
                for a, b in other
            ],
        ),
    ]


def write(records: Records, folder: Path, planned: int = 0, program: str = "", before: Records = ()) -> None:
    (folder / "results").mkdir(parents=True, exist_ok=True)
    (folder / "images").mkdir(parents=True, exist_ok=True)
    soft = soft_by_default(records)
    outcomes = [
        o for o in (OUTCOMES[0], "warned", "soft", *OUTCOMES[1:]) if any(outcome_of(r) == o for r in records)
    ]
    whole = Counter(map(outcome_of, records))
    parts = [
        "# Scenes at the extremes",
        (
            "Written by `scripts/extremes`, on one rank:"
            f" {len(records)} {f'of the {planned} ' if planned > len(records) else ''}tiny scenes of the plan"
            " (1 to 64 bricks)."
        ),
        "This page shows in which range of each parameter the program gives right results, and what it does"
        " beyond. Each parameter goes over its range, alone and in pairs, in every kind of run. What must"
        " hold is computed from what the run wrote:\n\n"
        "- equilibrium, and closed forms of bars, columns, membranes and simple shear\n"
        "- relaxation by Prony's series, and flow at a rate, at a temperature and with its own heat\n"
        "- the yield condition, and dissipation that never falls\n"
        "- the friction cone of nodes and of whole forces\n"
        "- the ledger of energies, momentum, impulse, and mirror symmetry\n"
        "- penetration, and elements inside out\n"
        "- the same scene in other units takes as many steps and iterations, and turned in space gives the"
        " same",
        "Each scene has one outcome:\n\n"
        "- *right*: all of that holds.\n"
        "- *warned*: all of that holds. A warning says that penetration takes more than 4 % of the energy"
        " along a load path, and how much.\n"
        f"- *soft*: all of that holds. A node goes deeper than {DEEP:g} facet sizes, though, or a warning"
        " says that the penalty is low for the facets. Forces are then too small, by any factor: what is in"
        " balance is less than the scene asks for. A larger penalty, or a `Penetration tolerance`, mends"
        " both.\n"
        "- *doubtful*: something does not hold, and a warning says why, and what to do. Energies fail to"
        " balance, a law is no longer stable at such strains, or a bar necks as heat softens it. Or elements"
        " are too stiff or too soft in bending.\n"
        "- *refused*, *failed*: the program stops with a message that says where, why and what to do.\n"
        "- *unhelpful*: it stops with a message that does not.\n"
        f"- *wrong*, *crashed*, *hung*: these must not be. A run hangs if it accepts no step in {PATIENCE:g}"
        f" s of the processor, or has no end after {AT_MOST:g} s.",
        *(said for said in (programs(records, program), units(records)) if said),
        "## Outcomes",
        table(
            ["", *outcomes, "scenes"],
            [["all", *[whole[o] for o in outcomes], len(records)]]
            + [
                [
                    kind,
                    *[sum(r["base"] in bases and outcome_of(r) == o for r in records) for o in outcomes],
                    sum(r["base"] in bases for r in records),
                ]
                for kind, bases in KINDS.items()
            ],
        ),
        *(said for said in (slow(records), forgetful(records)) if said),
        *of_laws(records, outcomes),
        "## By parameter",
        "*Safe* is the widest range around the default, for each kind of run; of words it is those that are"
        " safe. In this range every scene that turns this parameter alone is right or warned, and not soft."
        " Beyond it at least one of them is not, which may be one of many, or none was tried. Scenes that are"
        " soft as they are"
        + (" (" + ", ".join(f"`{scene}`" for scene in sorted(soft)) + ")" if soft else "")
        + " count as soft for penalties, strains and shapes only. So do warned scenes.\n\n"
        "Blocks reach the strain that is named only under penalties that do not give way. Where a"
        " strain or a shape is turned, penalties are raised to what that takes, up to 1e5 E/h. With the"
        " default of 10 E/h an elastic block that is pressed to ln -1 gives way at -0.76. One pressed"
        " to ln -3 gives way at -1.3. Such blocks are soft, and a warning says so.\n\n"
        "*In pairs*: the parameter is never turned alone, and all its scenes count; soft ones are so by"
        " the other parameter. Empty: not tried. Counts are of all scenes, those in pairs with it"
        " included. Scenes of fixed steps below a hundredth of the load end after twenty of them.",
    ]
    names = []
    for r in records:
        names += [p for p in r["parameters"] if p not in names]
    rows: list[list[Any]] = []
    for name in names:
        mine = alone(records, name)
        count = Counter(map(outcome_of, mine))
        rows.append(
            [
                words_of(name),
                tried(records, name),
                len(mine),
                *[count[o] or "" for o in outcomes],
                *[safe([r for r in mine if of(r["base"])], name, soft) for of in COLUMNS.values()],
            ]
        )
    rows.sort(key=lambda row: -row[2])
    parts.append(table(["parameter", "tried", "scenes", *outcomes, *(f"safe: {c}" for c in COLUMNS)], rows))
    parts += draw_all(records, folder / "images")
    for outcome, title in (
        ("failed", "What failed, and what was said"),
        ("refused", "What was refused"),
        ("unhelpful", "Messages that do not help"),
        ("doubtful", "Doubtful"),
    ):
        found = reasons(records, outcome)
        if found:
            parts += [
                f"## {title}",
                "Numbers and names are left out of what the program says.",
                quoted(
                    (f"{len(n)} scene{'s' * (len(n) > 1)}, such as {examples(n)}", words)
                    for words, n in found[:25]
                ),
            ]
    bad = [r for r in records if r["outcome"] in ("wrong", "crashed", "hung")]
    if bad:
        parts += [
            "## What must not be",
            table(
                ["", "scene", "why"],
                [
                    [
                        r["outcome"],
                        f"`{r['name']}`",
                        shortened(" ".join(r["reason"].split()), 240).replace("|", "\\|"),
                    ]
                    for r in sorted(bad, key=lambda r: (r["outcome"], r["name"]))
                ],
            ),
        ]
    parts += changed(records, before)
    (folder / "results/extremes.md").write_text(wrapped("\n\n".join(parts)) + "\n")


# --- pictures -------------------------------------------------------------------------------------

PICTURES = {
    "penalty_friction": (
        ("penalty", "mu"),
        "normal penalty, E/h",
        "friction coefficient",
        (
            ("slide", "a block dragged on a tool"),
            ("drag", "a block dragged on a block"),
            ("skid.explicit", "explicit: skidding"),
            ("skid.implicit", "implicit dynamics: skidding"),
        ),
    ),
    "nu_step": (
        ("step", "nu"),
        "fixed step, part of the load (below 0.01: twenty of them)",
        "Poisson's ratio",
        (("upset", "elastic, pressed to ln -0.5"), ("pull", "plastic, pulled to ln 0.5")),
    ),
    "aspect_strain": (
        ("aspect", "strain"),
        "height over width",
        "logarithmic strain",
        (("upset", "pressed between tools"), ("pull", "pulled")),
    ),
}


LEGEND = (
    "A colour is an outcome of the list above: *warned* is a scene that is right, with a warning of the"
    " energy that penetration takes. A number is that of iterations a step."
)


def draw_all(records: Records, folder: Path) -> list[str]:
    said = []
    for name, (pair, x, y, bases) in PICTURES.items():
        if draw(records, folder / f"extremes_{name}.png", pair, x, y, bases):
            said.append(f"![Outcome over {name.replace('_', ' and ')}](../images/extremes_{name}.png)")
    return [LEGEND, *said] if said else []


def draw(
    records: Records,
    file: Path,
    pair: tuple[str, str],
    x_label: str,
    y_label: str,
    bases: Sequence[tuple[str, str]],
) -> bool:
    cells: dict[str, dict[tuple[float, float], Record]] = {base: {} for base, _ in bases}
    for r in records:
        if r["base"] in cells and set(r["parameters"]) == set(pair):
            v = dict(zip(r["parameters"], r["values"]))
            cells[r["base"]][v[pair[0]], v[pair[1]]] = r
    panels = [(base, title) for base, title in bases if cells[base]]
    if not panels:
        return False
    order = list(COLOURS)
    figure, axes = pyplot.subplots(1, len(panels), figsize=(1.2 + 3.9 * len(panels), 4.4), squeeze=False)
    colours, norm = ListedColormap([COLOURS[o] for o in order]), BoundaryNorm(
        [i - 0.5 for i in range(len(order) + 1)], len(order)
    )
    used = set()
    for ax, (base, title) in zip(axes[0], panels):
        found = cells[base]
        xs, ys = sorted({k[0] for k in found}), sorted({k[1] for k in found})
        outcome = [[outcome_of(found.get((a, b), {})) for a in xs] for b in ys]
        used |= {o for row in outcome for o in row if o}
        ax.imshow(
            [[order.index(o) for o in row] for row in outcome],
            cmap=colours,
            norm=norm,
            origin="lower",
            aspect="auto",
        )
        for i, b in enumerate(ys):
            for j, a in enumerate(xs):
                drawn = found.get((a, b))
                if drawn and drawn.get("iterations"):
                    ax.text(
                        j,
                        i,
                        f"{drawn['iterations'] / max(drawn['steps'], 1):.1f}",
                        ha="center",
                        va="center",
                        fontsize=6.5,
                        color="#10301c",
                    )
        ax.set_xticks(range(len(xs)), [power(v) for v in xs], fontsize=8)
        ax.set_yticks(range(len(ys)), [f"{v:.4g}" for v in ys], fontsize=8)
        ax.set_title(title, fontsize=10)
        ax.set_xlabel(x_label)
        for spine in ax.spines.values():
            spine.set_visible(False)
        ax.set_xticks([i - 0.5 for i in range(len(xs) + 1)], minor=True)
        ax.set_yticks([i - 0.5 for i in range(len(ys) + 1)], minor=True)
        ax.grid(which="minor", color="white", lw=1.2)
        ax.tick_params(which="both", length=0)
    axes[0][0].set_ylabel(y_label)
    figure.legend(
        handles=[Patch(color=COLOURS[o], label=o) for o in order if o in used],
        loc="lower center",
        ncol=8,
        frameon=False,
    )
    figure.tight_layout(rect=(0, 0.07, 1, 1))
    figure.savefig(file, dpi=110)
    pyplot.close(figure)
    return True


def power(value: float) -> str:
    if value > 0 and abs(math.log10(value) - round(math.log10(value))) < 1e-9 and not 0.05 < value < 50:
        return f"$10^{{{round(math.log10(value))}}}$"
    return f"{value:.4g}"
