# SPDX-License-Identifier: LGPL-2.1-or-later
"""Pure: norms of differences, Richardson extrapolation, Pareto front, the choice. Nothing here knows of runs
or files."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Callable, Sequence

import numpy
from numpy.typing import NDArray

Array = NDArray[numpy.float64]


def trapezoids(times: Array) -> Array:
    """Weights of the trapezoidal rule at these times; one time has all the weight."""
    if len(times) == 1:
        return numpy.ones(1)
    gaps = numpy.diff(times)
    weights = numpy.zeros(len(times))
    weights[:-1] += 0.5 * gaps
    weights[1:] += 0.5 * gaps
    return weights


def interpolate(times: Array, values: Array, at: Array) -> Array:
    """Cubic Hermite interpolation with three-point slopes, of second order on unequal steps; constant beyond
    the ends. `values` has a row for each time."""
    times, values, at = (numpy.asarray(a, dtype=float) for a in (times, values, at))
    if len(times) < 3:
        flat = values.reshape(len(times), -1)
        return numpy.stack([numpy.interp(at, times, column) for column in flat.T], -1).reshape(
            at.shape + values.shape[1:]
        )
    at = numpy.clip(at, times[0], times[-1])
    gaps = numpy.diff(times).reshape((-1,) + (1,) * (values.ndim - 1))
    rises = numpy.diff(values, axis=0) / gaps
    slopes = numpy.empty_like(values)
    slopes[1:-1] = (gaps[1:] * rises[:-1] + gaps[:-1] * rises[1:]) / (gaps[1:] + gaps[:-1])
    slopes[0], slopes[-1] = 2.0 * rises[0] - slopes[1], 2.0 * rises[-1] - slopes[-2]
    i = numpy.clip(numpy.searchsorted(times, at, side="right") - 1, 0, len(times) - 2)
    h = gaps[i]
    s = ((at - times[i]) / numpy.diff(times)[i]).reshape(h.shape)
    found: Array = (
        (1 + 2 * s) * (1 - s) ** 2 * values[i]
        + s * (1 - s) ** 2 * h * slopes[i]
        + s**2 * (3 - 2 * s) * values[i + 1]
        + s**2 * (s - 1) * h * slopes[i + 1]
    )
    return found


def running_mean(times: Array, values: Array, window: float, at: Array) -> Array:
    """Means of the polygon through (times, values) over `window` about each time in `at`, over less at the
    ends."""
    times, values, at = numpy.asarray(times), numpy.asarray(values), numpy.asarray(at)
    columns = values.reshape(len(times), -1)
    # The integral of a polygon is a parabola between its corners: exact.
    gaps = numpy.diff(times)[:, None]
    integrals = numpy.vstack(
        [numpy.zeros((1, columns.shape[1])), numpy.cumsum(0.5 * gaps * (columns[1:] + columns[:-1]), axis=0)]
    )

    def integral(t: Array) -> Array:
        i = numpy.clip(numpy.searchsorted(times, t, side="right") - 1, 0, len(times) - 2)
        s = (t - times[i])[:, None]
        until: Array = integrals[i] + s * columns[i] + 0.5 * s**2 * (columns[i + 1] - columns[i]) / gaps[i]
        return until

    low = numpy.clip(at - 0.5 * window, times[0], times[-1])
    high = numpy.clip(at + 0.5 * window, times[0], times[-1])
    means: Array = (integral(high) - integral(low)) / (high - low)[:, None]
    return means.reshape(at.shape + values.shape[1:])


def mean_length(vectors: Array, weights: Array) -> float:
    """Weighted mean of the lengths of vectors (a row each): the L1 norm of a curve."""
    return float(
        numpy.sum(weights * numpy.linalg.norm(vectors.reshape(len(vectors), -1), axis=1)) / numpy.sum(weights)
    )


def root_mean_square(vectors: Array, weights: Array) -> float:
    """Weighted root of the mean of squared lengths: the L2 norm."""
    squares = numpy.sum(vectors.reshape(len(vectors), -1) ** 2, axis=1)
    return math.sqrt(float(numpy.sum(weights * squares) / numpy.sum(weights)))


def without_rigid_motion(places: Array, displacements: Array, weights: Array) -> Array:
    """Returns displacements less the rotation and translation that fit best (Kabsch 1976)."""
    w = weights[:, None] / numpy.sum(weights)
    moved = places + displacements
    start, end = places - numpy.sum(w * places, axis=0), moved - numpy.sum(w * moved, axis=0)
    u, _, v = numpy.linalg.svd((w * start).T @ end)
    turn = numpy.diag([1.0, 1.0, numpy.sign(numpy.linalg.det(u @ v))])
    left: Array = end - start @ (u @ turn @ v)
    return left


# --- the limit ------------------------------------------------------------------------------------

LEAST_ORDER, LARGEST_ORDER = 0.5, 2.0
SAME_WAY = 0.75


@dataclass
class Limit:
    """Limit of a sequence: its `values`; the `uncertainty` in the norm, NaN for a sequence of one; and the
    `order` used, None if the finest member is taken as it is. `observed` is the observed order, None without
    one; `differences` are those of neighbours in the norm."""

    values: Array
    uncertainty: float
    order: float | None
    observed: float | None
    differences: list[float]


def richardson(levels: Sequence[Array], ratio: float, norm: Callable[[Array], float]) -> Limit:
    """Returns the limit of a sequence of results from coarse to fine, each `ratio` times finer than the last
    (Richardson 1911).

    The order is observed in the last three, p = log(|f1 − f2| / |f2 − f3|) / log r. It is used from 1/2 on,
    up to 2, the highest order that is extrapolated here. If differences continue to fall at this order, the
    rest adds up to |f2 − f3| / (r^p − 1), whatever their signs. With a factor of 1.25 that is the uncertainty
    (Roache 1994, the grid convergence index).

    A last difference smaller than order 2 predicts from the one before may be chance; the prediction then
    replaces it. The finest result is extrapolated if both differences have the same direction, |f1 − f3|
    nearly their sum; else it is taken as it is. Below order 1/2 the uncertainty assumes p = 1/2, which is 3
    |f2 − f3| for r = 2, and also Roache's advice for two results."""
    finest = levels[-1]
    differences = [norm(b - a) for a, b in zip(levels, levels[1:])]
    if not differences:
        return Limit(finest, math.nan, None, None, differences)
    last, before = differences[-1], math.nan
    observed: float | None = None
    if last == 0.0:
        return Limit(finest, 0.0, None, None, differences)
    if len(levels) > 2:
        before = differences[-2]
        observed = math.log(before / last) / math.log(ratio) if before > 0.0 else -math.inf
    if observed is None or observed < LEAST_ORDER:
        return Limit(finest, 1.25 * last / (ratio**LEAST_ORDER - 1.0), None, observed, differences)
    order = min(observed, LARGEST_ORDER)
    left = max(last, before / ratio**LARGEST_ORDER) / (ratio**order - 1.0)
    if norm(finest - levels[-3]) >= SAME_WAY * (before + last):
        return Limit(
            finest + (finest - levels[-2]) / (ratio**order - 1.0), 1.25 * left, order, observed, differences
        )
    return Limit(finest, 1.25 * left, None, observed, differences)


@dataclass
class Part:
    """The error that one source makes in a result: its size in the norm; the range it may have, open at the
    top (inf) where nothing converges; the `order` that was observed, None where one was assumed; the
    `correction` that takes it away; and what is `left` of it in the finer result, None without one."""

    error: float
    low: float
    high: float
    order: float | None
    correction: Array
    left: float | None


ASSUMED_ORDER = 1.0  # of plastic flow, friction and contact, in steps and meshes


def error_part(
    coarse: Array | None, given: Array, fine: Array | None, ratio: float, norm: Callable[[Array], float]
) -> Part:
    """Returns the error of `given`, by results with the source `ratio` times larger and smaller, one of which
    may be missing. An infinite ratio removes the source.

    With three results the order is observed, and used from 1/2 to 2 as in richardson(). The error is the last
    difference and the rest that differences of this order add up to. The range goes from the last difference
    to 1.25 times the rest. If differences do not fall, there is no order, and the larger one is a lower
    bound. With two results the order is assumed to be 1, and the range is that of orders from 2 to 1/2."""

    def tail(order: float) -> float:
        return 1.0 / (float(ratio**order) - 1.0)

    if fine is None:
        if coarse is None:
            raise ValueError("an error needs two results")
        rise = given - coarse
        size = norm(rise)
        return Part(
            size * tail(ASSUMED_ORDER),
            size * tail(LARGEST_ORDER),
            size * tail(LEAST_ORDER),
            None,
            rise * tail(ASSUMED_ORDER),
            None,
        )
    step = fine - given
    last = norm(step)
    before = norm(given - coarse) if coarse is not None else 0.0
    if coarse is None or last == 0.0:
        factors = [1.0 + tail(order) for order in (LARGEST_ORDER, ASSUMED_ORDER, LEAST_ORDER)]
        low, size, high = (last * factor for factor in factors)
        return Part(size, low, high, None, step * factors[1], size - last)
    observed = math.log(before / last) / math.log(ratio) if before > 0.0 else -math.inf
    if observed < LEAST_ORDER:
        return Part(max(before, last), min(before, last), math.inf, observed, step, None)
    rest = max(last, before / ratio**LARGEST_ORDER) * tail(min(observed, LARGEST_ORDER))
    goes_on = norm(fine - coarse) >= SAME_WAY * (before + last)
    correction = step * (1.0 + rest / last) if goes_on else step
    return Part(last + rest, last, last + 1.25 * rest, observed, correction, rest)


# --- points in the plane of cost and error --------------------------------------------------------


def pareto_front(costs: Sequence[float], errors: Sequence[float], floor: float = 0.0) -> list[int]:
    """Indices, by cost, of the points that no other point beats in both. Errors below the floor, where they
    cannot be told apart, count as the floor."""
    front, least = [], math.inf
    for i in sorted(range(len(costs)), key=lambda i: (costs[i], errors[i])):
        error = max(errors[i], floor)
        if error < least:
            front.append(i)
            least = error
    return front


def cheapest_within(
    costs: Sequence[float],
    errors: Sequence[float],
    uncertainty: float,
    target: float,
    noise: float = 0.0,
    preferences: Sequence[Any] | None = None,
) -> int | None:
    """Index of the cheapest point whose error, the reference's uncertainty added, is within the target; None
    if there is none. Of those whose costs the noise, a part of them, does not tell apart, the one with the
    least of `preferences`, such as works, and then the first."""
    good = [i for i in range(len(costs)) if max(errors[i], uncertainty) + uncertainty <= target]
    if not good:
        return None
    least = min(costs[i] for i in good)
    return min(
        (i for i in good if costs[i] <= least * (1.0 + noise)),
        key=lambda i: preferences[i] if preferences else costs[i],
    )


def weighted_mean(values: Sequence[float], weights: Sequence[float]) -> float:
    return sum(w * v for v, w in zip(values, weights)) / sum(weights)
