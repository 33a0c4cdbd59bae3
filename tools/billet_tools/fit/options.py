# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command line of billet-fit. Needs Python alone, so that --help works everywhere."""

from __future__ import annotations

import argparse
import sys
from typing import Sequence

from .. import UserError

LAWS = ("Mooney-Rivlin", "Yeoh", "Ogden", "Arruda-Boyce")


def make_parser() -> argparse.ArgumentParser:
    """Returns the parser of the command line."""
    parser = argparse.ArgumentParser(
        prog="billet-fit",
        description="Fits constants of laws of rubber to measured nominal stresses, and prints lines for the"
        " 'Material' of a scene. The solid counts as incompressible.",
    )
    parser.add_argument(
        "data",
        help="CSV file with the columns MODE_stretch (or MODE_strain, nominal) and MODE_stress, MODE one of"
        " uniaxial, equibiaxial, planar; cells may be empty",
    )
    parser.add_argument("--law", action="append", choices=LAWS, help="only this law; may be repeated")
    parser.add_argument("--terms", type=int, default=3, choices=range(1, 5), help="terms of Ogden's law (3)")
    parser.add_argument(
        "--absolute",
        action="store_true",
        help="count errors over the greatest stress of the mode, not over the stress of the point",
    )
    parser.add_argument(
        "--poisson", type=float, default=0.499, help="Poisson's ratio in the lines, not fitted (0.499)"
    )
    parser.add_argument("--picture", metavar="FILE", help="picture of points and curves (DATA.png)")
    return parser


def parse(arguments: Sequence[str]) -> argparse.Namespace:
    options = make_parser().parse_args(arguments)
    if not -1 < options.poisson <= 0.49999:
        raise UserError("--poisson: a number > -1 and <= 0.49999")
    return options


def check_usage(arguments: Sequence[str]) -> int:
    """Returns the exit code of a wrong command line, which it prints; else 0. Ends the program by --help."""
    try:
        parse(arguments)
    except UserError as error:
        print(f"billet-fit: {error}", file=sys.stderr)
        return error.code
    return 0
