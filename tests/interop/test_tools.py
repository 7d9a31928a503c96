"""odkit's verdicts about other tools against the tools: cases of the project, and mutants of them."""

import importlib.util
import os
import subprocess
import tempfile
import unittest

import tools

CASES = tools.ROOT / "crates/od-eds/cases"


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
    is_there = True
    mutants = 200


class DcfTools(Tool, unittest.TestCase):
    name = "dcf-tools"
    is_there = importlib.util.find_spec("dcf")


class CanopenRs(Tool, unittest.TestCase):
    name = "canopen-rs"
    is_there = "ODKIT_CANOPEN_RS" in os.environ


class NpmCanopen(Tool, unittest.TestCase):
    name = "npm-canopen"
    is_there = "NODE_PATH" in os.environ


def load_tests(loader, tests, pattern):
    """The tools that are here: the ordinary run has python-canopen, `--long` installs the others."""
    tools_here = [it for it in (PythonCanopen, DcfTools, CanopenRs, NpmCanopen) if it.is_there]
    return unittest.TestSuite(loader.loadTestsFromTestCase(it) for it in tools_here)


if __name__ == "__main__":
    unittest.main()
