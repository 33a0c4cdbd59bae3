# SPDX-License-Identifier: LGPL-2.1-or-later
"""Work-precision pictures of the shipped scenes by billet-trade: doc/results/trade/NAME.md and .csv,
doc/images/trade_NAME.png."""

import argparse
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]

# Scene and options by the name of the picture. Each takes some minutes on one core.
SWEEPS: dict[str, tuple[str, str, list[str], list[list[str]]]] = {
    "billet_upsetting": (
        "billet_upsetting",
        "--mesh 2 --reference-mesh 0.5,1,2 --force die.force_z --outputs force --target 3% --repeat 1",
        [
            "mesh=0.5,1",
            "steps=10,20,40,80",
            "maximum step=0.25,0.5,1,2",
            "penalty=0.1,1,10",
            "augmentation=0,0.01,0.0001",
            "tangent=exact,consistent,symmetrised lower",
            "tolerance=0.01,0.0001,1e-6,1e-8",
            "predictor=extrapolation,tangent",
            "solver=MUMPS,GMRES",
        ],
        [["mesh=0.5,1", "steps=10,20,40"]],
    ),
    "billet_given_mesh": (
        "billet_upsetting",
        "--mesh 2 --reference-mesh given --force die.force_z --outputs force --target 0.8% --repeat 1",
        [
            "steps=10,20,40,80",
            "maximum step=0.25,0.5,1,2",
            "penalty=0.1,1,10",
            "augmentation=0,0.01,0.0001",
            "tangent=exact,consistent,symmetrised lower",
            "tolerance=0.01,0.0001,1e-6,1e-8",
            "predictor=extrapolation,tangent",
            "solver=MUMPS,GMRES",
        ],
        [],
    ),
    "ironing": (
        "ironing",
        "--title|Shallow ironing|--reference-mesh 0.5,1,2 --outputs force --target 5%",
        [
            "mesh=0.5,1",
            "maximum step=0.5,1,2,4",
            "penalty=0.1,1,10",
            "augmentation=0.01,0.001",
            "tolerance=0.01,0.0001,1e-6",
            "tangent=exact,consistent",
            "facets=overlap,planed,bilinear,mean gap",
            "passes=one,two",
        ],
        [],
    ),
    "hertz_cylinders": (
        "hertz_cylinders",
        (
            "--title|Two elastic cylinders|--mesh 0.5 --reference-mesh 1,2,4 --reference-steps 10 --outputs"
            " force --target 1%"
        ),
        [
            "mesh=0.5,1,2",
            "steps=1,2,5,10",
            "penalty=0.1,1,10",
            "augmentation=0,0.01,0.001,0.0001",
            "tolerance=0.01,0.0001,1e-6",
            "facets=overlap,planed,bilinear",
            "solver=MUMPS,MUMPS symmetric,CG",
        ],
        [],
    ),
    "wagoner_punch": (
        "wagoner_punch",
        (
            "--mesh 0.5 --until 0.75 --reference-mesh 0.5,1,2 --force punch.force_z --outputs force,strain "
            "--line|0, 0, 0.5 to 66, 0, 0.5|--target 15% --repeat 1"
        ),
        [
            "mesh=0.5,1",
            "maximum step=0.5,1,2,4",
            "penalty=0.1,1,10",
            "tangent=exact,consistent,continuum",
            "tolerance=0.01,0.0001,1e-6",
        ],
        [],
    ),
    "taylor_bar": (
        "taylor_bar",
        (
            "--mesh 0.5 --reference-mesh 1,2,4 --reference|Bodies/bar/Element=assumed strain|--outputs shape "
            "--target 5% --time-limit 3000"
        ),
        [
            "mesh=0.5,1,2",
            "element=assumed strain,mean dilatation,one point",
            "safety factor=0.95,0.75,0.4",
            "contact resolution=1,2,4",
            "penalty=0.1,1,10",
            "mass scaling=1.05,1.2,1.5,2",
            "elasticity=Hencky,hypoelastic",
            "bulk viscosity=0.25,1,4",
        ],
        # At the end one that drifts: 3000 times the penalty, in steps as long as stability lets them be.
        [
            ["element=assumed strain", "mesh=0.5,1,2"],
            ["element=assumed strain", "elasticity=neo-Hookean,hypoelastic"],
            ["contact resolution=1", "safety factor=0.95", "penalty=10,3000"],
        ],
    ),
    # Bending, in which elements lock: two layers of bricks in the ring's wall, until it touches itself.
    "ring_crush": (
        "ring_crush",
        (
            "--title|Crushing of a ring|--until 0.476 --set|Time"
            " stepping/Stops=0.9|--set|Bodies/ring/Element=one point|--set|Bodies/ring/Mesh/Arguments=2, 1,"
            " 64 : 9.5, 0, -90 : 10, 0.5, 90 : true|--set|Bodies/ring/Mesh/Boundary ids=6 : z <"
            " -9.95|--reference-mesh 0.5,1,2 --reference-steps 40 --force die.force_z --outputs force"
            " --target 20%"
        ),
        [
            "mesh=0.5,1,2",
            "element=one point,assumed strain,mean dilatation",
            "maximum step=0.5,1",
            "penalty=0.001,0.1,10",
        ],
        [["mesh=0.5", "element=assumed strain,mean dilatation"]],
    ),
    "tube_impact": (
        "tube_impact",
        "--reference-mesh 0.5,1,2 --outputs shape,rebound --target 15%",
        [
            "mesh=0.5,1",
            "element=assumed strain,mean dilatation,one point",
            "elasticity=Hencky,neo-Hookean,hypoelastic",
            "safety factor=0.95,0.75,0.4",
            "contact resolution=1,2,4",
            "penalty=0.1,1,10",
            "facets=planed,bilinear,mean gap",
            "passes=one,two",
            "mass scaling=1.5,2,4,8",
            "bulk viscosity=0.25,1,4",
            "search margin=0.25,0.5,1",
        ],
        [["element=one point", "elasticity=Hencky,hypoelastic"]],
    ),
}

parser = argparse.ArgumentParser(prog="scripts/benchmarks trade")
parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(SWEEPS)} (all)")
parser.add_argument("--quick", action="store_true", help="each point timed once, nothing written to doc/")
parser.add_argument("--large", action="store_true", help="nothing more here")
parser.add_argument("--ranks", type=int, default=1, help="processes to run billet on (1)")
options = parser.parse_args()

os.chdir(ROOT)
os.environ.setdefault("BILLET", str(ROOT / "build/release/bin/billet"))
for name in options.names or SWEEPS:
    if name not in SWEEPS:
        sys.exit(f"scripts/benchmarks trade: unknown name '{name}' ({', '.join(SWEEPS)})")
    scene, text, values, products = SWEEPS[name]
    flags = [
        part for i, piece in enumerate(text.split("|")) for part in ([piece] if i % 2 else piece.split())
    ]
    command = [sys.executable, "tools/billet-trade", f"prm/{scene}.prm", *flags, "--parameters", *values]
    for product in products:
        command += ["--product", *product]
    command += (
        ["--repeat", "1"]
        if options.quick
        else ["--output", f"doc/results/trade/{name}", "--picture", f"doc/images/trade_{name}.png"]
    )
    command += ["--ranks", str(options.ranks)] if options.ranks > 1 else []
    done = subprocess.run(command)
    if done.returncode not in (0, 3):  # 3: nothing within the target, which the page says
        sys.exit(done.returncode)
