"""How fast `odkit.to_canopen` is, against python-canopen's own reader.

    python python/benches/files.py DIR [ROUNDS]

All EDS and DCF files below DIR that both read; of each file the best of the rounds counts. `pip install
./python[canopen]` before: a debug build says nothing.
"""

import gc
import logging
import sys
import time
import warnings
from pathlib import Path

import canopen

import odkit

NODE_ID = 1


def best(files, read, rounds):
    """Seconds for all files, each in its best round."""
    times = [float("inf")] * len(files)
    for _ in range(rounds):
        for place, path in enumerate(files):
            gc.collect()
            began = time.perf_counter()
            read(path, NODE_ID)
            times[place] = min(times[place], time.perf_counter() - began)
    return sum(times)


def measure(folder, rounds=3):
    """Rows of the table, and how many times faster odkit is."""
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    found = sorted(one for one in folder.rglob("*") if one.suffix.lower() in (".eds", ".dcf"))
    files, refused = [], 0
    for path in map(str, found):
        try:
            canopen.import_od(path, NODE_ID)
            files.append(path)
        except Exception:  # Whatever it is, it does not read the file.
            refused += bool(odkit.to_canopen(path, NODE_ID))
    size = sum(Path(path).stat().st_size for path in files) / 1e6
    theirs = best(files, canopen.import_od, rounds)
    own = best(files, odkit.to_canopen, rounds)
    rows = [
        (f"{len(files)} files, {size:.1f} MB", "seconds", "MB/s", ""),
        ("odkit.to_canopen", f"{own:.3f}", f"{size / own:.1f}", f"{theirs / own:.1f} ×"),
        ("canopen.import_od", f"{theirs:.3f}", f"{size / theirs:.1f}", "1 ×"),
        (f"refused by python-canopen, read by odkit: {refused} of {len(found)}", "", "", ""),
    ]
    return rows, theirs / own


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    rows, _ = measure(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 3)
    for name, *numbers in rows:
        print(f"{name:48}" + "".join(f"{one:>10}" for one in numbers))


if __name__ == "__main__":
    main()
