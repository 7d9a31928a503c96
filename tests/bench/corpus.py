"""Parse and check a folder of device files: odkit and python-canopen, one after the other.

    python tests/bench/corpus.py [DIR]      (DIR: the folder that ODKIT_CORPUS names, or tests/corpus)

Needs python-canopen (tests/interop/requirements.txt). Both read texts that are in memory
already, each file the best of its rounds, and only files that python-canopen reads count.
odkit also checks them; python-canopen has no checks. The table is Markdown, for the README.
"""

import io
import logging
import os
import subprocess
import sys
import time
import warnings
from pathlib import Path

import canopen

ROOT = Path(__file__).resolve().parents[2]
ROUNDS = 3


def odkit(folder):
    """file -> (bytes, seconds)"""
    command = ["cargo", "run", "--quiet", "--release", "--package", "od-tests", "--example", "corpus"]
    out = subprocess.run(
        command + ["--", str(folder), "--time"],
        cwd=ROOT, check=True, capture_output=True, encoding="utf-8",
    ).stdout
    rows = [line.split("\t") for line in out.splitlines()]
    return {name: (int(size), float(seconds)) for name, size, seconds in rows if name != "corpus"}


def python_canopen(text):
    """Seconds for one file, or None if it is not read."""
    best = None
    for _ in range(ROUNDS):
        source = io.StringIO(text)
        source.name = "x.eds"
        start = time.perf_counter()
        try:
            canopen.objectdictionary.eds.import_eds(source, 1)
        except Exception:  # whatever its users get
            return None
        seconds = time.perf_counter() - start
        best = seconds if best is None else min(best, seconds)
    return best


def main():
    given = sys.argv[1] if len(sys.argv) > 1 else os.environ.get("ODKIT_CORPUS")
    folder = (Path(given) if given else ROOT / "tests" / "corpus").resolve()
    if not folder.is_dir():
        sys.exit(f"there is no folder {folder}: name one with device files")
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    # A first run builds, the second measures.
    odkit(folder)
    mine = odkit(folder)
    count = size = 0
    ours = theirs = 0.0
    for name, (length, seconds) in mine.items():
        if not name.lower().endswith((".eds", ".dcf")):
            continue
        data = (folder / name).read_bytes()
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError:
            continue
        other = python_canopen(text)
        if other is not None:
            count, size = count + 1, size + length
            ours, theirs = ours + seconds, theirs + other
    largest = max(mine.items(), key=lambda row: row[1][0] if row[0].endswith(("eds", "dcf")) else 0)
    print(f"| {count} files, {size / 1e6:.1f} MB | seconds | MB/s | |")
    print("|---|--:|--:|--:|")
    print(f"| odkit, parse and check | {ours:.3f} | {size / 1e6 / ours:.0f} | {theirs / ours:.0f} x |")
    print(f"| python-canopen {canopen.__version__}, parse | {theirs:.3f} | {size / 1e6 / theirs:.1f} | 1 x |")
    name, (length, seconds) = largest
    print(f"\nThe largest, {length / 1000:.0f} kB: {seconds * 1e3:.1f} ms.")
    if theirs < 20 * ours:
        sys.exit("less than 20 times as fast")


if __name__ == "__main__":
    main()
