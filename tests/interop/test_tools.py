"""odkit's verdicts about other tools against the tools: cases of the project, and mutants of them."""

import importlib.util
import os
import subprocess
import tempfile
import unittest

import tools

CASES = tools.ROOT / "od-eds" / "cases"


class Tool:
    """The verdicts about one tool; the ordinary run has python-canopen alone."""

    name = ""
    mutants = 2000

    def hold(self, folder):
        counts, wrong = tools.disagreements(self.name, folder)
        total = sum(counts.values())
        self.assertGreater(total, 100)
        self.assertGreaterEqual(len(counts), 2, f"more than one verdict comes up: {counts}")
        self.assertLessEqual(len(wrong), total * 0.02, "\n".join(map(str, wrong)))

    def test_cases(self):
        self.hold(CASES)

    def test_mutants(self):
        built = os.environ.get("ODKIT_TOOLS", tools.ROOT / "target" / "debug" / "examples" / "tools")
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([built, "mutants", CASES, folder, str(self.mutants), "1"], check=True)
            self.hold(folder)


class PythonCanopen(Tool, unittest.TestCase):
    name = "python-canopen"
    mutants = 200


@unittest.skipUnless(importlib.util.find_spec("dcf"), "dcf-tools is installed with --long")
class DcfTools(Tool, unittest.TestCase):
    name = "dcf-tools"


@unittest.skipUnless("ODKIT_CANOPEN_RS" in os.environ, "canopen-rs is built with --long")
class CanopenRs(Tool, unittest.TestCase):
    name = "canopen-rs"


@unittest.skipUnless("NODE_PATH" in os.environ, "the package canopen of npm is installed with --long")
class NpmCanopen(Tool, unittest.TestCase):
    name = "npm-canopen"


if __name__ == "__main__":
    unittest.main()
