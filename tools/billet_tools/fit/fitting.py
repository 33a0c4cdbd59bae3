# SPDX-License-Identifier: LGPL-2.1-or-later
"""Least squares of the laws over all modes."""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Callable, Sequence

import numpy
from scipy import optimize

from . import laws
from .data import Array, Data
from .laws import Law

# A point counts by its error over its own stress, but not over less than this part of the mode's largest.
LEAST_SCALE = 0.05
LEAST_EXPONENT, GREATEST_EXPONENT = 0.3, 12.0
STARTS_OF_EXPONENTS = (1.3, 5.0, -2.0, 2.0, -4.0, 9.0)


@dataclass
class Fit:
    """A law and its error: the root mean square of relative errors of the points."""

    law: Law
    error: float


class Problem:
    """Residuals of laws at the data's points."""

    def __init__(self, data: Data, is_relative: bool) -> None:
        self.data = data
        scales = []
        for points in data.values():
            size = numpy.abs(points.stresses)
            floor = LEAST_SCALE * size.max()
            scales.append(numpy.maximum(size, floor) if is_relative else numpy.full_like(size, size.max()))
        self.scale = numpy.concatenate(scales)
        self.target = numpy.concatenate([points.stresses for points in data.values()]) / self.scale

    def scaled(self, law: Law) -> Array:
        """Returns the stresses of a law over the scales of the points."""
        stresses = [law.stress(mode, points.stretches) for mode, points in self.data.items()]
        return numpy.asarray(numpy.concatenate(stresses) / self.scale)

    def residuals(self, law: Law) -> Array:
        """Returns the errors over the scales."""
        return numpy.asarray(self.scaled(law) - self.target)

    def fit_of(self, law: Law) -> Fit:
        """Returns a law with its error."""
        return Fit(law, float(numpy.sqrt(numpy.mean(self.residuals(law) ** 2))))

    def linear(self, make: Callable[..., Law], n: int) -> Fit:
        """Returns the best law that is linear in its n constants."""
        columns = [self.scaled(make(*(float(i == k) for k in range(n)))) for i in range(n)]
        constants = numpy.linalg.lstsq(numpy.array(columns).T, self.target, rcond=None)[0]
        return self.fit_of(make(*constants))

    def arruda_boyce(self) -> Fit:
        """Returns the best one over a range of starts of the locking stretch."""

        def law_of(x: Array) -> Law:
            return laws.arruda_boyce(float(numpy.exp(x[0])), 1 + float(numpy.exp(x[1])))

        modulus = max(self.linear(lambda c: laws.yeoh(c, 0, 0), 1).law.shear_modulus(), 1e-12)
        runs = [
            optimize.least_squares(
                lambda x: self.residuals(law_of(x)), [numpy.log(modulus), numpy.log(limit - 1)], max_nfev=400
            )
            for limit in (1.5, 3.0, 6.0)
        ]
        return self.fit_of(law_of(min(runs, key=lambda run: float(run.cost)).x))

    def ogden(self, n_terms: int) -> Fit:
        """Returns the best one of n terms with μ α >= 0, which is stable.

        Given exponents it is linear in these products, so that only the exponents are searched for.
        """

        def solve(exponents: Array) -> tuple[Law, Array]:
            columns = [self.scaled(laws.ogden([1 / a], [a])) for a in exponents]
            products, _ = optimize.nnls(numpy.array(columns).T, self.target)
            law = laws.ogden(
                [float(c / a) for c, a in zip(products, exponents)], [float(a) for a in exponents]
            )
            return law, numpy.array(columns).T @ products - self.target

        best: tuple[float, Law] | None = None
        for start in itertools.combinations(STARTS_OF_EXPONENTS, n_terms):
            signs = numpy.sign(start)
            run = optimize.least_squares(
                lambda size: solve(signs * size)[1],
                numpy.abs(start),
                bounds=(LEAST_EXPONENT, GREATEST_EXPONENT),
                max_nfev=300,
                xtol=1e-12,
                ftol=1e-14,
            )
            if best is None or run.cost < best[0]:
                best = float(run.cost), solve(signs * run.x)[0]
        assert best is not None
        law = best[1]
        terms = [(m, a) for m, a in zip(law.moduli, law.exponents) if m != 0]
        return self.fit_of(laws.ogden([m for m, _ in terms], [a for _, a in terms]))


def fit_all(data: Data, names: Sequence[str], n_terms: int, is_relative: bool) -> list[Fit]:
    """Returns the fits of the laws of these names, the best one first."""
    problem = Problem(data, is_relative)
    makers: dict[str, Callable[[], Fit]] = {
        "Mooney-Rivlin": lambda: problem.linear(laws.mooney_rivlin, 2),
        "Yeoh": lambda: problem.linear(laws.yeoh, 3),
        "Ogden": lambda: problem.ogden(n_terms),
        "Arruda-Boyce": problem.arruda_boyce,
    }
    return sorted((makers[name]() for name in names), key=lambda fit: fit.error)
