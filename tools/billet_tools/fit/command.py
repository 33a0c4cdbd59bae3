# SPDX-License-Identifier: LGPL-2.1-or-later
"""The command billet-fit."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Sequence

from .. import UserError
from .data import read_data
from .fitting import fit_all
from .options import LAWS, parse
from .picture import draw


def main(arguments: Sequence[str]) -> int:
    """Fits, prints and draws. Returns the exit code."""
    options = parse(arguments)
    file = Path(options.data)
    data = read_data(file)
    fits = fit_all(data, options.law or LAWS, options.terms, not options.absolute)
    for fit in fits:
        print(f"# {fit.law.name}: {100 * fit.error:.3g} % root mean square of errors;", end=" ")
        print(f"initial shear modulus {fit.law.shear_modulus():.4g}")
        for warning in fit.law.warn():
            print(f"# {warning}")
        if fit.law.shear_modulus() > 0:
            print(fit.law.paste(options.poisson) + "\n")
        else:
            print("# no lines for a scene: billet refuses an initial shear modulus that is not positive\n")
    if not any(fit.law.shear_modulus() > 0 for fit in fits):
        raise UserError(f"{file}: no law with a positive initial shear modulus fits these data")
    picture = Path(options.picture) if options.picture else file.with_suffix(".png")
    draw(data, fits, picture)
    print(f"# picture: {picture}")
    return 0


def run(arguments: Sequence[str]) -> int:
    """Returns the exit code; errors of the user go to the standard error."""
    try:
        return main(arguments)
    except UserError as error:
        print(f"billet-fit: {error}", file=sys.stderr)
        return error.code
