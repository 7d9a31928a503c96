"""python-canopen reads after the safe fixes of a file what it read before."""

import logging
import os
import shutil
import subprocess
import tempfile
import unittest
import warnings
from pathlib import Path

import bench
import tools

ODKIT = bench.odkit()
MUTANTS = 300


class SafeFixes(unittest.TestCase):
    """Cases of the project, and mutants of them."""

    def setUp(self):
        logging.disable(logging.CRITICAL)
        warnings.simplefilter("ignore")
        self.addCleanup(logging.disable, logging.NOTSET)

    def hold(self, files):
        compared = 0
        with tempfile.TemporaryDirectory() as folder:
            copies = []
            for number, path in enumerate(files):
                copy = Path(folder) / f"{number}{path.suffix}"
                shutil.copy(path, copy)
                copies.append(copy)
            before = [tools.reading("python-canopen", copy) for copy in copies]
            for at in range(0, len(copies), 100):
                # The exit code tells of errors that no fix corrects.
                subprocess.run([ODKIT, "check", "--fix", *copies[at:at + 100]], capture_output=True)
            for path, copy, was in zip(files, copies, before):
                if isinstance(was, str) or copy.read_bytes() == path.read_bytes():
                    continue
                compared += 1
                now = tools.reading("python-canopen", copy)
                self.assertNotIsInstance(now, str, path)
                self.assertEqual(set(was) - set(now), set(), path)
        return compared

    def test_cases(self):
        files = sorted((tools.ROOT / "crates" / "od-eds" / "cases").glob("*/*.eds"))
        self.assertGreater(self.hold(files), 20)

    def test_mutants(self):
        built = os.environ.get("ODKIT_TOOLS", tools.ROOT / "target" / "debug" / "examples" / "tools")
        with tempfile.TemporaryDirectory() as folder:
            cases = tools.ROOT / "crates" / "od-eds" / "cases"
            subprocess.run([built, "mutants", cases, folder, str(MUTANTS), "32"], check=True)
            self.assertGreater(self.hold(sorted(Path(folder).glob("*.eds"))), 2)


if __name__ == "__main__":
    unittest.main()
