# SPDX-License-Identifier: LGPL-2.1-or-later
"""What benchmarks compute and say of what they ran."""

import math
import unittest

from hand_set import beside_hand_set


class Counting(unittest.TestCase):
    def test_what_cannot_be_compared_is_not_counted(self):
        said = beside_hand_set([1.0, 1.5, 1.6, math.nan], [0.9, 2.0, 1.7, math.nan])
        self.assertIn("2 of 3 take at most 1.5 times the work, 1 of 3 at most 1.5 times the CPU seconds", said)
        self.assertIn("for 1 no run by hand that was tried is within the target", said)
        self.assertNotIn("not counted", beside_hand_set([1.0], [2.0]))


if __name__ == "__main__":
    unittest.main()
