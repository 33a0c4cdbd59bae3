# SPDX-License-Identifier: LGPL-2.1-or-later
"""Options of the command line. Needs Python alone, so that --help works everywhere."""

from __future__ import annotations

import argparse
import re
import sys
from typing import Sequence

from .. import UserError
from . import parameters
from .budget import Budget

Options = argparse.Namespace

OUTPUTS = ("force", "energy", "strain", "shape", "rebound")
GIVEN = "given"  # as --reference-mesh instead of factors: errors are those of all but the mesh

HELP = """Shows what accuracy costs in a scene of billet, in a table, a CSV file and a picture of error
over cost. It changes one parameter after the other, and measures each run against a converged
reference that it makes itself. With --explain: a bar for each source of error, as text and picture.
With --target: the cheapest setting within an error, as lines to paste into the scene. Runs are kept:
after Ctrl-C there is the page of what was run, and the same command continues."""


def make_parser() -> argparse.ArgumentParser:
    """Returns the parser of the command line; the manual page is made from it, too."""
    parser = argparse.ArgumentParser(
        prog="billet-trade", description=HELP, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add("scene", help="a scene file of billet")
    add(
        "--list",
        action="store_true",
        help="say which parameters the scene can use and with which values, and end",
    )
    add(
        "--explain",
        action="store_true",
        help=(
            "shows how far off the scene is, and why, by one run for each source of error. With --target,"
            " also the cheapest way there by these runs"
        ),
    )
    group = parser.add_argument_group("parameters to change")
    add = group.add_argument
    add(
        "--parameters",
        nargs="+",
        metavar="PARAMETER[=V,V]",
        help="these only, with these values: mesh=0.5,1 tangent penalty=1,10 (all that the scene can use)",
    )
    add("--knobs", dest="parameters", nargs="+", help=argparse.SUPPRESS)  # old name
    add(
        "--parameter",
        action="append",
        default=[],
        metavar="[NAME: ]PATH=V,V",
        help=(
            "a parameter of the scene by its path, 'Solver/Line search=energy,none'; "
            "several at once joined by ' & '; values with commas separated by '|'"
        ),
    )
    add("--knob", dest="parameter", action="append", default=[], help=argparse.SUPPRESS)  # old name
    add(
        "--product",
        action="append",
        nargs="+",
        default=[],
        metavar="PARAMETER[=V,V]",
        help="all combinations of the values of these parameters, too; may be given more than once",
    )
    add(
        "--combine",
        action="store_true",
        help="with --target: join to the chosen point, parameter by parameter, what is cheaper still",
    )
    group = parser.add_argument_group("a shorter form of the scene")
    add = group.add_argument
    add("--until", type=float, metavar="PART", help="this part of the end time only")
    add(
        "--mesh",
        metavar="FACTOR",
        help="elements along each edge, factor of the scene's: 0.5 for a coarser mesh",
    )
    add("--set", action="append", default=[], metavar="PATH=VALUE", help="any parameter")
    group = parser.add_argument_group("outputs and target")
    add = group.add_argument
    add(
        "--outputs",
        default="",
        metavar="O[=W],...",
        help=(
            f"of {', '.join(OUTPUTS)}, with weights: force=2,shape "
            "(force, where there is one, and shape; strain, too, with --line; --explain: force, in dynamics"
            " energy)"
        ),
    )
    add(
        "--force",
        metavar="COLUMN,...",
        help=(
            "columns of history.csv, such as die.force_z (forces of all tools, else of all pairs of bodies,"
            " else of supports)"
        ),
    )
    add(
        "--window",
        type=float,
        default=0.05,
        metavar="PART",
        help="explicit scenes: forces are means over this part of the time (0.05)",
    )
    add("--line", metavar="'X,Y,Z to X,Y,Z'", help="in the undeformed bodies, of the strain profile")
    add(
        "--profile",
        choices=("stretch", "plastic"),
        default="stretch",
        help="logarithmic stretch along the line, or equivalent plastic strain",
    )
    add("--target", metavar="ERROR", help="such as 1%% or 0.01: name the cheapest point within it")
    add(
        "--cost",
        choices=("seconds", "work"),
        default="seconds",
        help="what 'cheap' means: core-seconds, or work without regard to the machine",
    )
    group = parser.add_argument_group("reference")
    add = group.add_argument
    add(
        "--reference-mesh",
        metavar="F,F,F",
        help=(
            "factors of the mesh in one ratio, 1 among them (1,2,4 if that is affordable, else 0.5,1,2)."
            " With 'given' the mesh is that of the scene, and errors are those of everything else"
        ),
    )
    add(
        "--reference-steps",
        type=int,
        metavar="N",
        help="implicit scenes: N, 2N and 4N equal steps (as many as the maximum step makes, 20 to 100)",
    )
    add(
        "--reference",
        action="append",
        default=[],
        metavar="PATH=VALUE",
        help="a parameter that the reference has otherwise than the scene",
    )
    group = parser.add_argument_group("runs")
    add = group.add_argument
    add("--ranks", type=int, default=1, help="processes of each run (1)")
    add("-j", "--jobs", type=int, default=1, help="runs at a time; more than one blurs the core-seconds (1)")
    add(
        "--repeat",
        type=int,
        help=(
            "times that points are timed which others do not dominate; the median counts (3, or 1 with"
            " --explain)"
        ),
    )
    add(
        "--budget",
        metavar="LIMIT",
        help="what the study may take on the clock, or in runs: '20 minutes', '90 s', '2 h', '30 runs'",
    )
    add(
        "--time-limit", type=float, default=600.0, metavar="S", help="seconds on the clock for each run (600)"
    )
    add("--program", help="billet itself (the one beside this program, or in BILLET, or on the path)")
    group = parser.add_argument_group("limits beyond which a run counts as failed")
    add = group.add_argument
    add("--largest-drift", type=float, default=0.05, help="of the energy balance of dynamic scenes (0.05)")
    add("--largest-penetration", type=float, default=0.5, help="in facet sizes (0.5)")
    add(
        "--locked",
        type=float,
        default=0.2,
        help="forces larger by this part in the mean are those of locking (0.2)",
    )
    add(
        "--soft",
        type=float,
        default=0.2,
        help="forces smaller by this part in the mean are those of too soft a contact (0.2)",
    )
    add(
        "--largest-error",
        type=float,
        default=0.5,
        help="beyond which a run is of no use; of the reference, too (0.5)",
    )
    group = parser.add_argument_group("output files")
    add = group.add_argument
    add("--folder", help="where runs are kept (results/trade/SCENE)")
    add("--output", metavar="NAME", help="NAME.csv, NAME.md and NAME.png are written (FOLDER/trade)")
    add("--picture", metavar="FILE", help="another place for the picture, .png, .svg or .pdf")
    add("--title", help="of picture and page (the scene's)")
    return parser


def parse(arguments: Sequence[str]) -> Options:
    options = make_parser().parse_args(arguments)
    options.budget = Budget(options.budget)
    options.repeat = (1 if options.explain else 3) if options.repeat is None else options.repeat
    for name, least in (("ranks", 1), ("jobs", 1), ("repeat", 1)):
        if getattr(options, name) < least:
            raise UserError(
                f"--{name} is {getattr(options, name)}; allowed are whole numbers from {least} on"
            )
    if options.reference_steps is not None and options.reference_steps < 1:
        raise UserError(
            f"--reference-steps is {options.reference_steps}; allowed are whole numbers from 1 on"
        )
    if options.until is not None and not 0 < options.until <= 1:
        raise UserError(f"--until is {options.until:g}; allowed is a part of the end time, > 0 and <= 1")
    if options.combine and not options.target:
        raise UserError("--combine wants a --target to stay within")
    if options.explain and (options.parameters or options.parameter or options.product or options.combine):
        raise UserError("--explain changes one source of error at a time: it takes no parameters of a study")
    weights = read_outputs(options.outputs)
    if options.explain and options.force and weights and "force" not in weights:
        raise UserError("--explain: forces by --force want 'force' among the --outputs")
    if options.reference_mesh == GIVEN and any(
        k.partition("=")[0] == "mesh" for k in (options.parameters or []) + sum(options.product, [])
    ):
        raise UserError("--reference-mesh given: the mesh cannot be a parameter then")
    options.target = read_error(options.target)
    if "strain" in weights and not options.line:
        raise UserError("--outputs: the strain profile wants a --line 'x, y, z to x, y, z'")
    if options.line:
        read_line(options.line)  # says what is wrong with it
    if not options.time_limit > 0:
        raise UserError(f"--time-limit is {options.time_limit:g}; allowed are seconds > 0")
    return options


def check_usage(arguments: Sequence[str]) -> int:
    """Returns the exit code of a wrong command line, which it prints; else 0. Ends the program by --help."""
    try:
        parse(arguments)
    except UserError as error:
        print(f"billet-trade: {error}", file=sys.stderr)
        return error.code
    except parameters.CannotTurn as why:
        print(f"billet-trade: {why}", file=sys.stderr)
        return 2
    return 0


def read_line(text: str) -> tuple[list[float], list[float]]:
    """Returns both ends of a line."""
    numbers = re.findall(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", text)
    if len(numbers) != 6 or " to " not in text:
        raise UserError(f"--line is '{text}'; allowed is 'x, y, z to x, y, z'")
    begin, end = [float(x) for x in numbers[:3]], [float(x) for x in numbers[3:]]
    if begin == end:
        raise UserError(f"--line is '{text}'; allowed are two different points")
    return begin, end


def read_error(text: str | None) -> float | None:
    if text is None:
        return None
    cleaned = text.replace("percent", "%").strip()
    value = parameters.number(cleaned.rstrip("% "), "an error > 0, such as 1% or 0.01", "--target") * (
        0.01 if "%" in cleaned else 1.0
    )
    if value >= 1:
        raise UserError(f"--target is '{text}'; allowed is an error below 100 %, such as 1% or 0.01")
    return value


def read_settings(option: str, texts: Sequence[str]) -> dict[str, str]:
    changes = {}
    for text in texts:
        path, equals, value = text.partition("=")
        if not equals or not path.strip():
            raise UserError(f"{option} is '{text}'; allowed is 'path/to/parameter=value'")
        changes["/".join(" ".join(part.split()) for part in path.split("/"))] = value.strip()
    return changes


def read_outputs(text: str) -> dict[str, float]:
    """{name: weight}."""
    weights = {}
    for part in filter(None, (p.strip() for p in text.split(","))):
        name, equals, weight = part.partition("=")
        if name not in OUTPUTS:
            raise UserError(
                f"--outputs is '{name}'; allowed are {', '.join(OUTPUTS)}, each with =WEIGHT if need be"
            )
        weights[name] = parameters.number(weight, "a weight > 0", f"--outputs: {name}") if equals else 1.0
    return weights
