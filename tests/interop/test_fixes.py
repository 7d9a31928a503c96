"""Safe fixes lose nothing: python-canopen and dcf-tools still read every value that they read before."""

import logging
import os
import shutil
import subprocess
import tempfile
import unittest
import warnings
from importlib.util import find_spec
from pathlib import Path

import bench
import tools

ODKIT = bench.odkit()
MUTANTS = 5000 if "ODKIT_LONG" in os.environ else 300
# The ordinary run has only python-canopen. dcf-tools never ends with some mutants; for these,
# `tests/tests/witness.rs` has a reader that reads as dcf-tools does.
WITNESSES = [tool for tool, module in (("python-canopen", "canopen"), ("dcf-tools", "dcf")) if find_spec(module)]


class SafeFixes(unittest.TestCase):
    """Cases of the project, and mutants of them."""

    def setUp(self):
        logging.disable(logging.CRITICAL)
        warnings.simplefilter("ignore")
        self.addCleanup(logging.disable, logging.NOTSET)

    def hold(self, files, witnesses):
        compared = 0
        with tempfile.TemporaryDirectory() as folder:
            copies = []
            for number, path in enumerate(files):
                copy = Path(folder) / f"{number}{path.suffix}"
                shutil.copy(path, copy)
                copies.append(copy)
            before = {tool: [tools.reading(tool, copy) for copy in copies] for tool in witnesses}
            for at in range(0, len(copies), 100):
                # The exit code is not checked: it is 1 if a file has errors without a fix.
                subprocess.run([ODKIT, "check", "--fix", *copies[at:at + 100]], capture_output=True)
            for tool, readings in before.items():
                for path, copy, was in zip(files, copies, readings):
                    if isinstance(was, str) or copy.read_bytes() == path.read_bytes():
                        continue
                    compared += 1
                    now = tools.reading(tool, copy)
                    self.assertNotIsInstance(now, str, (tool, path))
                    self.assertEqual(set(was) - set(now), set(), (tool, path))
        return compared

    def test_cases(self):
        files = sorted((tools.ROOT / "crates" / "od-eds" / "cases").glob("*/*.eds"))
        files += sorted((tools.ROOT / "tests" / "corpus").glob("*.eds"))
        self.assertGreater(self.hold(files, WITNESSES), 20)

    def test_mutants(self):
        built = os.environ.get("ODKIT_TOOLS", tools.ROOT / "target" / "debug" / "examples" / "tools")
        with tempfile.TemporaryDirectory() as folder:
            cases = tools.ROOT / "crates" / "od-eds" / "cases"
            subprocess.run([built, "mutants", cases, folder, str(MUTANTS), "32"], check=True)
            self.assertGreater(self.hold(sorted(Path(folder).glob("*.eds")), ["python-canopen"]), 2)


if __name__ == "__main__":
    unittest.main()
