# SPDX-License-Identifier: LGPL-2.1-or-later
"""Measures cost and effect of settings that have no table of their own: line search, predictor, forcing,
symmetry of the model, smoothing of facets and the margin of their search, and which facets."""

from billet_runs import ROOT, Changes, arguments, number, percent, publish, table
from curve_runs import error, run_all

options = arguments("settings")

MESH = "Bodies/billet/Mesh/"
LENGTH = {
    MESH + "Height": 30,
    MESH + "Layers": 10,
    "Bodies/billet/Symmetry planes": "x = 0 ; y = 0",
    "Tools/die/Surfaces/Plane/Point": "0, 0, 30",
    "Tools/lower die/Surfaces/Plane/Point": "0, 0, 0",
    "Tools/lower die/Surfaces/Plane/Normal": "0, 0, 1",
    "Tools/lower die/Motion/Translation": "0 ; 0 ; 9.6*t",
    **{
        f"Contact pairs/billet on lower die/{key}": value
        for key, value in {
            "Body": "billet",
            "Boundary ids": "0, 2",
            "Tool": "lower die",
            "Friction coefficient": 0.1,
            "Penalty unit": "absolute",
            "Normal penalty": 3.5e5,
        }.items()
    },
}
ITERATIVE = {"Solver/Linear solver": "GMRES", MESH + "Refinements": 2, MESH + "Layers": 10}
IRONING = {"Time stepping/End time": 1.6, "Time stepping/Stops": 1}
FACE = "Contact pairs/face/"
FACES = "Contact pairs/faces/"
KINDS = [
    ("overlap", "one"),
    ("planed", "one"),
    ("planed", "two"),
    ("mean gap", "two"),
    ("bilinear", "one"),
    ("bilinear", "two"),
]

# scene, what all of its runs have, [(setting, value, changes)], the first is what errors are measured against
GROUPS: list[tuple[str, Changes, list[tuple[str, str, Changes]]]] = [
    (
        "billet_upsetting",
        {},
        [
            ("`Line search`", "energy", {}),
            ("`Line search`", "none", {"Solver/Line search": "none"}),
            ("`Predictor`", "tangent", {"Solver/Predictor": "tangent"}),
        ],
    ),
    (
        "billet_upsetting",
        ITERATIVE,
        [
            ("`Forcing term`", "fixed", {"Solver/Forcing term": "fixed"}),
            ("`Forcing term`", "Eisenstat-Walker", {}),
            (
                "`Forcing term`, `Linear tolerance` 1e-3",
                "fixed",
                {"Solver/Forcing term": "fixed", "Solver/Linear tolerance": 1e-3},
            ),
        ],
    ),
    (
        "billet_upsetting",
        {},
        [
            ("symmetry", "all of the length, 120 bricks", LENGTH),
            ("symmetry", "half of the length, 60 bricks", {}),
        ],
    ),
    (
        "ironing",
        IRONING,
        [
            ("`Search margin`", "0.5", {}),
            ("`Search margin`", "0.1", {FACE + "Search margin": 0.1}),
            ("`Search margin`", "2", {FACE + "Search margin": 2}),
            ("`Line search`", "none", {"Solver/Line search": "none"}),
            ("`Predictor`", "tangent", {"Solver/Predictor": "tangent"}),
        ],
    ),
    (
        "ironing",
        {**IRONING, FACE + "Facets": "bilinear", FACE + "Passes": "two"},
        [
            ("`Smoothing`, bilinear facets", "0.1", {}),
            ("`Smoothing`, bilinear facets", "0.02", {FACE + "Smoothing": 0.02}),
            ("`Smoothing`, bilinear facets", "0.5", {FACE + "Smoothing": 0.5}),
        ],
    ),
    (
        "passing_spheres",
        {},
        [
            (
                "`Facets`, `Passes`",
                "overlap, one, augmented to 1e-3",
                {FACES + "Penetration tolerance": 1e-3},
            ),
            *(
                (
                    "`Facets`, `Passes`" + (f", {penalty} E/h" if penalty != 10 else ""),
                    f"{facets}, {passes}",
                    {FACES + "Facets": facets, FACES + "Passes": passes, FACES + "Normal penalty": penalty},
                )
                for penalty in (10, 100)
                for facets, passes in KINDS
            ),
        ],
    ),
]

rows = []
for scene, common, settings in GROUPS:
    runs = run_all(
        ROOT / f"prm/{scene}.prm",
        [{**common, **changes} for _, _, changes in settings],
        options.ranks,
        at_once=1,
    )
    for (setting, value, _), run in zip(settings, runs):
        rows.append(
            [scene, setting, value]
            + (
                [
                    run.steps,
                    run.work,
                    number(run.seconds),
                    "" if run is runs[0] else percent(error(run, runs[0])),
                ]
                if run.finished
                else [f"stops at {run.times[-1] if run.times else 0:.2g}", run.work, number(run.seconds), "–"]
            )
        )

publish(
    "settings",
    "Cost and effect of the remaining settings",
    options,
    (
        "This page shows what settings without a page of their own cost, and how much they change the"
        " forces. The billet is that of `prm/billet_upsetting.prm`, for `Forcing term` with 480 bricks and"
        " GMRES. `prm/ironing.prm` ends when the die has been drawn 3 mm (time 1.6). For symmetry the"
        " billet lies between two dies, without the plane z = 0.\n\n"
        "The difference is ∫Σ|F − F*| dt over ∫Σ|F*| dt of the forces; F* is that of the first of each"
        " group. Each run is done once.\n\n"
        "The spheres of `prm/passing_spheres.prm` begin and end apart. With soft penalties the difference"
        " is mostly how far they give way, with stiff ones what the facets make."
    ),
    table(["scene", "setting", "value", "steps", "Newton iterations", "CPU seconds", "difference"], rows),
)
