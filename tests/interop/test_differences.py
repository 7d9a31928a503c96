"""odkit's reading against python-canopen's, value by value, over the corpus."""

import unittest

import differences


class Differences(unittest.TestCase):
    def test_each_difference_has_a_reason(self):
        counts, _, _, unknown, compared = differences.differences(differences.corpus())
        self.assertEqual(unknown, [], "differences without a reason")
        self.assertGreater(compared["values"], 0)
        self.assertTrue(set(counts) <= set(differences.KINDS))


if __name__ == "__main__":
    unittest.main()
