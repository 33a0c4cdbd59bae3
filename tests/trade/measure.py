# SPDX-License-Identifier: LGPL-2.1-or-later
"""Norms, Richardson extrapolation, Pareto front and choice, against closed forms."""

from __future__ import annotations

import math
import unittest

import numpy

import modules  # noqa: F401  finds the next ones
from billet_tools.output import Array
from billet_tools.trade import measure

UNEVEN = numpy.array([0.0, 0.1, 0.25, 0.3, 0.6, 0.65, 1.0])


class TestErrorPart(unittest.TestCase):
    """Results 1 + e of a source whose error e falls with an order."""

    @staticmethod
    def part(coarse: float | None, given: float, fine: float | None, ratio: float = 2.0) -> measure.Part:
        coarser, middle, finer = (None if v is None else numpy.array([v]) for v in (coarse, given, fine))
        assert middle is not None
        return measure.error_part(coarser, middle, finer, ratio, lambda v: float(numpy.linalg.norm(v)))

    def test_orders(self) -> None:
        for order in (0.7, 1.0, 2.0):
            part = self.part(1 + 0.1 * 2**order, 1.1, 1 + 0.1 / 2**order)
            self.assertAlmostEqual(part.order or 0.0, order)
            self.assertAlmostEqual(part.error, 0.1)
            self.assertAlmostEqual(part.left or 0.0, 0.1 / 2**order)
            self.assertAlmostEqual(float(part.correction[0]), -0.1)
            self.assertTrue(part.low < 0.1 < part.high)
        steep = self.part(1.8, 1.1, 1.01)  # of a higher order than is extrapolated
        self.assertAlmostEqual(steep.left or 0.0, 0.7 / 4 / 3)

    def test_two_results(self) -> None:
        """Results of order 1 are exact; those of orders 1/2 and 2 are at the ends of the range."""
        self.assertAlmostEqual(self.part(None, 1.1, 1.05).error, 0.1)
        self.assertAlmostEqual(self.part(1.2, 1.1, None).error, 0.1)
        self.assertIsNone(self.part(1.2, 1.1, None).left)
        self.assertAlmostEqual(self.part(None, 1.1, 1.025).low, 0.1)
        self.assertAlmostEqual(self.part(None, 1.1, 1 + 0.1 / math.sqrt(2)).high, 0.1)
        self.assertAlmostEqual(self.part(1.4, 1.1, None).low, 0.1)
        self.assertAlmostEqual(self.part(1 + 0.1 * math.sqrt(2), 1.1, None).high, 0.1)
        gone = self.part(None, 1.1, 1.0, math.inf)
        self.assertAlmostEqual(gone.error, 0.1)
        self.assertEqual((gone.left, gone.low), (0.0, gone.high))

    def test_no_order(self) -> None:
        part = self.part(1.1, 1.0, 1.2)
        self.assertAlmostEqual(part.error, 0.2)
        self.assertAlmostEqual(part.low, 0.1)
        self.assertEqual((part.high, part.left), (math.inf, None))
        still = self.part(1.1, 1.0, 1.0)
        self.assertEqual((still.error, still.high), (0.0, 0.0))
        with self.assertRaises(ValueError):
            self.part(None, 1.0, None)


class TestCurves(unittest.TestCase):
    def test_trapezoids(self) -> None:
        self.assertAlmostEqual(float(numpy.sum(measure.trapezoids(UNEVEN))), 1.0)
        self.assertAlmostEqual(measure.trapezoids(UNEVEN) @ (3 * UNEVEN + 1), 2.5)  # exact for straight lines

    def test_interpolation_is_exact_for_parabolas(self) -> None:
        at = numpy.linspace(0, 1, 57)
        values = numpy.stack([UNEVEN**2 - UNEVEN, 2 + 0 * UNEVEN], -1)
        found = measure.interpolate(UNEVEN, values, at)
        numpy.testing.assert_allclose(found, numpy.stack([at**2 - at, 2 + 0 * at], -1), atol=1e-14)
        numpy.testing.assert_allclose(
            measure.interpolate(numpy.array([0.0, 1.0]), numpy.array([[1.0], [3.0]]), numpy.array([0.5])),
            [[2.0]],
        )

    def test_running_mean(self) -> None:
        times = numpy.linspace(0, 1, 2001)
        window, at = 0.1, numpy.array([0.2, 0.5, 0.73])
        found = measure.running_mean(times, numpy.sin(20 * times), window, at)
        exact = (numpy.cos(20 * (at - 0.05)) - numpy.cos(20 * (at + 0.05))) / (20 * window)
        numpy.testing.assert_allclose(found, exact, atol=1e-5)
        # A polygon's own mean is exact, at the ends over half the window.
        numpy.testing.assert_allclose(
            measure.running_mean(UNEVEN, 2.0 * UNEVEN, 0.2, numpy.array([0.0, 0.5, 1.0])), [0.1, 1.0, 1.9]
        )

    def test_norms(self) -> None:
        weights = measure.trapezoids(numpy.array([0.0, 1.0, 3.0]))
        vectors = numpy.array([[3.0, 4.0], [0.0, 0.0], [0.0, 2.0]])
        self.assertAlmostEqual(measure.mean_length(vectors, weights), (0.5 * 5 + 1.0 * 2) / 3)
        self.assertAlmostEqual(
            measure.root_mean_square(vectors, weights), math.sqrt((0.5 * 25 + 1.0 * 4) / 3)
        )

    def test_rigid_motion(self) -> None:
        rng = numpy.random.default_rng(1)
        places, weights = rng.normal(size=(30, 3)), rng.uniform(0.5, 2, 30)
        c, s = math.cos(2.5), math.sin(2.5)
        turn = numpy.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ numpy.array(
            [[1, 0, 0], [0, s, c], [0, -c, s]]
        )
        moved = places @ turn.T + [4, 5, 6]
        numpy.testing.assert_allclose(
            measure.without_rigid_motion(places, moved - places, weights), 0, atol=1e-13
        )
        stretched = measure.without_rigid_motion(places, 0.1 * places, numpy.ones(30))  # about the centroid
        numpy.testing.assert_allclose(stretched, 0.1 * (places - places.mean(axis=0)), atol=1e-13)


def size(vector: Array) -> float:
    return float(numpy.linalg.norm(vector))


class TestRichardson(unittest.TestCase):
    limit = numpy.array([3.0, -1.0])
    direction = numpy.array([0.2, 0.5])

    def sequence(self, order: float, ratio: float = 2.0, n: int = 3, sign: float = 1.0) -> list[Array]:
        return [self.limit + self.direction * sign**i * ratio ** (-order * i) for i in range(n)]

    def test_order_and_limit(self) -> None:
        for ratio, order in ((2.0, 1.0), (2.0, 2.0), (1.5, 0.7), (4.0, 1.0)):
            found = measure.richardson(self.sequence(order, ratio), ratio, size)
            self.assertAlmostEqual(found.observed or 0.0, order)
            numpy.testing.assert_allclose(found.values, self.limit, atol=1e-12)
            error = size(self.sequence(order, ratio)[-1] - self.limit)
            # that of the finest, with a quarter on top
            self.assertAlmostEqual(found.uncertainty, 1.25 * error)

    def test_orders_beyond_two_are_not_believed(self) -> None:
        levels = self.sequence(3.5)
        found = measure.richardson(levels, 2.0, size)
        self.assertAlmostEqual(found.observed or 0.0, 3.5)
        self.assertEqual(found.order, 2.0)
        self.assertGreaterEqual(found.uncertainty, size(found.values - self.limit))
        # Nor is a last difference that is small by chance: what an order of two makes of the one before
        # counts.
        found = measure.richardson(
            [numpy.array([1.0]), numpy.array([0.2]), numpy.array([0.2 - 1e-9])], 2.0, size
        )
        self.assertAlmostEqual(found.uncertainty, 1.25 * 0.2 / 3)

    def test_to_and_fro(self) -> None:
        """Changes that turn round: the finest is taken, and the differences that are left bound its error."""
        levels = self.sequence(1.0, sign=-1.0)
        found = measure.richardson(levels, 2.0, size)
        self.assertIsNone(found.order)
        numpy.testing.assert_array_equal(found.values, levels[-1])
        self.assertGreaterEqual(found.uncertainty, size(levels[-1] - self.limit))

    def test_no_order(self) -> None:
        """Differences that do not fall: nothing is extrapolated, and the index for an order of a half
        counts."""
        levels = [numpy.array([0.0]), numpy.array([1.0]), numpy.array([2.0])]
        found = measure.richardson(levels, 2.0, size)
        self.assertIsNone(found.order)
        self.assertAlmostEqual(found.uncertainty, 1.25 / (math.sqrt(2) - 1))
        numpy.testing.assert_array_equal(found.values, levels[-1])

    def test_few_levels(self) -> None:
        two = measure.richardson(self.sequence(1.0)[:2], 2.0, size)
        self.assertAlmostEqual(two.uncertainty, 1.25 / (math.sqrt(2) - 1) * size(0.5 * self.direction))
        self.assertIsNone(two.order)
        self.assertTrue(math.isnan(measure.richardson([self.limit], 2.0, size).uncertainty))
        self.assertEqual(measure.richardson([self.limit] * 3, 2.0, size).uncertainty, 0.0)


class TestChoice(unittest.TestCase):
    costs = [1.0, 2.0, 2.0, 4.0, 8.0, 9.0]
    errors = [0.5, 0.2, 0.3, 0.25, 0.01, 0.005]

    def test_front(self) -> None:
        self.assertEqual(measure.pareto_front(self.costs, self.errors), [0, 1, 4, 5])
        # The last one is better by less than can be told.
        self.assertEqual(measure.pareto_front(self.costs, self.errors, 0.02), [0, 1, 4])
        self.assertEqual(measure.pareto_front([], []), [])

    def test_front_dominates(self) -> None:
        rng = numpy.random.default_rng(2)
        costs, errors = rng.uniform(size=(2, 200))
        front = measure.pareto_front(costs, errors)
        for i in range(200):
            beaten = any(costs[j] <= costs[i] and errors[j] <= errors[i] and j != i for j in range(200))
            self.assertEqual(i in front, not beaten)

    def test_choice(self) -> None:
        def choose(target: float, uncertainty: float, noise: float = 0.0) -> int | None:
            return measure.cheapest_within(
                self.costs, self.errors, uncertainty, target, noise, [6, 5, 4, 3, 2, 1]
            )

        self.assertEqual(choose(0.4, 0.0), 2)  # two of one cost: the one with less work
        self.assertEqual(choose(0.25, 0.0), 1)
        self.assertEqual(choose(0.25, 0.1), 4)  # 0.2 may be 0.3
        self.assertIsNone(choose(0.05, 0.05))  # the uncertainty alone is all of the target
        self.assertIsNone(choose(0.05, 0.03))  # nobody knows whether 0.005 is 0.03
        self.assertEqual(choose(0.25, 0.0, 1.1), 3)  # timings that scatter by a factor of two
        self.assertAlmostEqual(measure.weighted_mean([1.0, 4.0], [2.0, 1.0]), 2.0)


unittest.main()
