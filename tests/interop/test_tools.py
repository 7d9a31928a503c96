"""odkit's verdicts about python-canopen against python-canopen: cases of the project, and mutants of them."""

import os
import subprocess
import tempfile
import unittest

import tools


class PythonCanopen(unittest.TestCase):
    def hold(self, folder, least):
        counts, wrong = tools.disagreements("python-canopen", folder)
        total = sum(counts.values())
        self.assertGreater(total, 100)
        self.assertGreaterEqual(len(counts), 3, f"each verdict comes up: {counts}")
        self.assertLessEqual(len(wrong), total * (1 - least), "\n".join(map(str, wrong)))

    def test_cases(self):
        self.hold(tools.ROOT / "od-eds" / "cases", 0.98)

    def test_mutants(self):
        with tempfile.TemporaryDirectory() as folder:
            command = [os.environ.get("ODKIT_TOOLS", tools.ROOT / "target" / "debug" / "examples" / "tools")]
            subprocess.run(
                command + ["mutants", tools.ROOT / "od-eds" / "cases", folder, "200", "1"], check=True
            )
            self.hold(folder, 0.98)


if __name__ == "__main__":
    unittest.main()
