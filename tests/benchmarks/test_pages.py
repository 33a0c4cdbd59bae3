# SPDX-License-Identifier: LGPL-2.1-or-later
"""What benchmarks compute and say of what they ran."""

import math
import unittest

from hand_set import beside_hand_set
from profile_words import no_better, without_errors


class Counting(unittest.TestCase):
    def test_what_cannot_be_compared_is_not_counted(self):
        said = beside_hand_set([1.0, 1.5, 1.6, math.nan], [0.9, 2.0, 1.7, math.nan])
        self.assertIn("2 of 3 take at most 1.5 times the work, 1 of 3 at most 1.5 times the CPU seconds", said)
        self.assertIn("for 1 no run by hand that was tried is within the target", said)
        self.assertNotIn("not counted", beside_hand_set([1.0], [2.0]))


class Profiles(unittest.TestCase):
    def test_no_better(self):
        errors = {"a": {"fast": 0.02, "balanced": 0.019, "accurate": 0.001}, "b": {"fast": 0.02, "balanced": 0.002, "accurate": 0.001},
                  "c": {"fast": 0.01, "balanced": 0.01, "accurate": 0.009}, "d": {"fast": math.nan, "balanced": 0.01, "accurate": 0.01}}
        self.assertIn("in 2 of 3 scenes whose errors are known (a, c)", no_better(errors))
        self.assertIn("In 1 of these accurate, which augments, has at most half", no_better(errors))
        self.assertEqual(no_better({"b": errors["b"]}), "")

    def test_reasons(self):
        self.assertEqual(without_errors({}), "")
        self.assertIn("a (given up)", without_errors({"a": "given up"}))


if __name__ == "__main__":
    unittest.main()
