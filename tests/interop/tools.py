"""Does each tool take a file as odkit says it does?

    python tools.py TOOL DIR            each disagreement, and the sums
    python tools.py TOOL DIR --count    the sums only

TOOL is python-canopen or dcf-tools. A verdict is right if the tool rejects what odkit says it rejects, and if all
that it reads of another file is what odkit says it reads.
"""

import argparse
import contextlib
import io
import logging
import os
import subprocess
import warnings
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NODE_ID = 1


def expected(tool, folder):
    """file -> (verdict, codes, first finding, {(index, sub): fields}), as odkit expects it."""
    built = os.environ.get("ODKIT_TOOLS")
    build = ["cargo", "run", "--quiet", "--package", "od-tests", "--example", "tools", "--"]
    command = [built] if built else build
    out = subprocess.run(
        command + ["readings", tool, str(Path(folder).resolve())],
        cwd=ROOT, check=True, capture_output=True, encoding="utf-8",
    ).stdout
    files = {}
    for line in out.split("\n"):
        if not line:
            continue
        fields = line.split("\t")
        if line.startswith("\t"):
            values[int(fields[1], 16), int(fields[2], 16)] = tuple(fields[3:])
        else:
            values = {}
            files[fields[0]] = (*fields[1:4], values)
    return files


def escaped(text):
    """As `escape_default` of Rust."""
    plain = {"\t": "\\t", "\r": "\\r", "\n": "\\n", "'": "\\'", '"': '\\"', "\\": "\\\\"}
    return "".join(
        plain.get(c) or (c if " " <= c <= "~" else f"\\u{{{ord(c):x}}}") for c in text
    )


def shown(value):
    if value is None:
        return ""
    if isinstance(value, bytes):
        return "b" + value.hex()
    if isinstance(value, str):
        return "t" + escaped(value)
    if isinstance(value, float):
        return ("r", value)
    return f"i{clamped(value)}"


def clamped(number):
    return max(min(number, 2**127 - 1), 1 - 2**127)


def python_canopen(path):
    """{(index, sub): fields}, or what it raises."""
    import canopen
    from canopen.objectdictionary import ODVariable

    with open(path, encoding="utf-8") as file:
        od = canopen.objectdictionary.eds.import_eds(file, NODE_ID)
    read = {}
    for index, entry in od.indices.items():
        members = {0: entry} if isinstance(entry, ODVariable) else entry.subindices
        for sub, var in members.items():
            read[index, sub] = (
                "-" if var.data_type is None else str(clamped(var.data_type)), escaped(var.access_type),
                str(int(var.pdo_mappable)),
                *map(shown, (var.default, var.min, var.max, var.value)), "t" + escaped(var.name),
            )
    return read


def dcf_tools(path):
    """{(index, sub): fields}, or what it raises."""
    import dcf

    with contextlib.redirect_stderr(io.StringIO()):
        device = dcf.Device.from_dcf(str(path), {"NODEID": NODE_ID})
    read = {}
    for index, entry in device.items():
        for sub, var in entry.items():
            value = default = None
            try:
                value = var.parse_value()
                default = var.default_value.parse(device.env)
            except Exception:  # a value that dcfgen fails at when it needs it
                pass
            read[index, sub] = (
                str(clamped(var.data_type.index)), escaped(var.access_type.name), str(int(var.pdo_mapping)),
                shown(default), "-", "-", shown(value), "t" + escaped(var.name),
            )
    return read


READERS = {"python-canopen": python_canopen, "dcf-tools": dcf_tools}


def alike(ours, theirs):
    if isinstance(theirs, tuple):
        try:
            number = float(ours[1:])
        except ValueError:
            return False
        other = theirs[1]
        return number == other or (number != number and other != other)
    return ours == theirs


def disagreement(tool, path, verdict, values):
    """Why odkit is wrong about a file, or None."""
    try:
        read = READERS[tool](path)
    except Exception as error:  # whatever it is, it is what users of the tool get
        return None if verdict == "rejects" else f"it raises {type(error).__name__}: {error}"[:150]
    if verdict == "rejects":
        return "it reads the file"
    for at in sorted(set(read) | set(values)):
        ours, theirs = values.get(at), read.get(at)
        if ours is None or theirs is None or not all(map(alike, ours, theirs)):
            return f"{at[0]:04X}h:{at[1]:02X}: expected {ours}, it reads {theirs}"[:400]
    return None


def disagreements(tool, folder):
    """(number of files, of each verdict, [(file, why, first finding)])"""
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    counts, wrong = {}, []
    for name, (verdict, _, first, values) in expected(tool, folder).items():
        counts[verdict] = counts.get(verdict, 0) + 1
        why = disagreement(tool, Path(folder) / name, verdict, values)
        if why:
            wrong.append((name, why, first))
    return counts, wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("tool", choices=READERS)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--count", action="store_true")
    args = parser.parse_args()
    counts, wrong = disagreements(args.tool, args.folder)
    for name, why, first in [] if args.count else wrong:
        print(f"{name}: {why} (odkit: {first})")
    total = sum(counts.values())
    print(f"{args.tool}: {total - len(wrong)} of {total} right ({100 - 100 * len(wrong) / total:.2f} %); {counts}")


if __name__ == "__main__":
    main()
