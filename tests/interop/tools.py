"""Does each tool take a file as odkit says it does?

    python tools.py TOOL DIR            each disagreement, and the sums
    python tools.py TOOL DIR --count    the sums only

TOOL is python-canopen, dcf-tools, npm-canopen (NODE_PATH has the package `canopen`) or canopen-rs (ODKIT_CANOPEN_RS is
the program of `tools/canopen-rs`). A verdict is right if the tool rejects what odkit says it rejects, and if all
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
    """{(index, sub): fields}, or what it raises; without names, and without values that are no numbers."""
    import dcf

    node = {"NODEID": NODE_ID}
    with contextlib.redirect_stderr(io.StringIO()):
        device = dcf.Device.from_dcf(str(path), node)
    read = {}
    for index, entry in device.items():
        for sub, var in entry.items():
            values = (var.default_value, var.value)
            basic = var.data_type.is_basic()
            default, value = (shown(it.parse(node)) if basic else "-" for it in values)
            read[index, sub] = (
                str(clamped(var.data_type.index)), escaped(var.access_type.name), str(int(var.pdo_mapping)),
                default, "-", "-", value, "-",
            )
    return read


def outside(tool, folder, names):
    """file -> {(index, sub): fields}, or what went wrong, by a program that reads names."""
    programs = {
        "npm-canopen": ["node", Path(__file__).with_name("tools") / "npm-canopen.js"],
        "canopen-rs": [os.environ.get("ODKIT_CANOPEN_RS", "read-canopen-rs")],
    }
    out = subprocess.run(
        [*programs[tool], folder], input="\n".join(names) + "\n",
        check=True, capture_output=True, encoding="utf-8",
    ).stdout
    files = {}
    for line in out.split("\n"):
        fields = line.split("\t")
        if line.startswith("\t"):
            values[int(fields[1], 16), int(fields[2], 16)] = tuple(fields[3:])
        elif line:
            values = {}
            files[fields[0]] = values if fields[1] == "read" else fields[2]
    return files


READERS = {"python-canopen": python_canopen, "dcf-tools": dcf_tools}


def alike(ours, theirs):
    if "-" in (ours, theirs):
        return True
    if ours == theirs:
        return True
    try:
        a, b = float(ours[1:]), theirs[1] if isinstance(theirs, tuple) else float(theirs[1:])
    except ValueError:
        return False
    # A REAL32 has seven digits. A NaN that is stored as an integer is 0.
    near = 1e-15 if ours.startswith("i") else 1e-6
    return abs(a - b) <= near * max(abs(a), abs(b)) or a != a and b != b or b != b and a == 0


def disagreement(read, verdict, values):
    """Why odkit is wrong about a file, or None."""
    if isinstance(read, str):
        return None if verdict == "rejects" else f"it raises {read}"[:150]
    if verdict == "rejects":
        return "it reads the file"
    for at in sorted(set(read) | set(values)):
        ours, theirs = values.get(at), read.get(at)
        if ours is None or theirs is None or not all(map(alike, ours, theirs)):
            return f"{at[0]:04X}h:{at[1]:02X}: expected {ours}, it reads {theirs}"[:400]
    return None


def reading(tool, path):
    try:
        return READERS[tool](path)
    except Exception as error:  # whatever it is, it is what users of the tool get
        return f"{type(error).__name__}: {error}"


def disagreements(tool, folder):
    """(number of files, of each verdict, [(file, why, first finding)])"""
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    counts, wrong = {}, []
    files = expected(tool, folder)
    of_program = {} if tool in READERS else outside(tool, folder, files)
    for name, (verdict, _, first, values) in files.items():
        counts[verdict] = counts.get(verdict, 0) + 1
        read = reading(tool, Path(folder) / name) if tool in READERS else of_program[name]
        why = disagreement(read, verdict, values)
        if why:
            wrong.append((name, why, first))
    return counts, wrong


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("tool", choices=[*READERS, "npm-canopen", "canopen-rs"])
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
