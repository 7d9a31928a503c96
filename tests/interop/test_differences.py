"""odkit's reading against python-canopen's, value by value, over the corpus."""

import unittest

import differences
from bench import needs

FOLDER = differences.corpus()


class Differences(unittest.TestCase):
    @needs(FOLDER, "a folder of device files, which ODKIT_CORPUS names")
    def test_each_difference_has_a_reason(self):
        counts, _, _, unknown, compared = differences.differences(FOLDER)
        self.assertEqual(unknown, [], "differences of no kind")
        self.assertGreater(compared["values"], 0)
        self.assertTrue(set(counts) <= set(differences.KINDS))


if __name__ == "__main__":
    unittest.main()
