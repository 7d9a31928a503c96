"""Every value of a folder of device files, as odkit and as python-canopen read it.

    python differences.py DIR            the kinds of differences, with a count and an example
    python differences.py DIR --docs     docs/DIFFERENCES.md, generated

Each difference belongs to a kind in KINDS, which says who is right and why; one that
belongs to none fails the test in test_differences.py.
"""

import argparse
import collections
import configparser
import logging
import os
import re
import subprocess
import warnings
from pathlib import Path

import canopen
from difference_kinds import KINDS
from canopen.objectdictionary import ODArray, ODRecord, ODVariable, datatypes

ROOT = Path(__file__).resolve().parents[2]
NODE_ID = 1


def corpus():
    """The folder of device files: `tests/corpus`, or the one that ODKIT_CORPUS names."""
    folder = Path(os.environ.get("ODKIT_CORPUS") or ROOT / "tests" / "corpus")
    assert folder.is_dir(), f"ODKIT_CORPUS does not name a folder: {folder}"
    return folder


def odkit_reading(folder):
    """file -> {index: (code, name, {sub: fields})}, read by odkit."""
    built = os.environ.get("ODKIT_READING")
    build = ["cargo", "run", "--quiet", "--package", "od-tests", "--example", "corpus", "--"]
    command = [built] if built else build
    out = subprocess.run(
        command + [str(Path(folder).resolve()), "--entries"],
        cwd=ROOT, check=True, capture_output=True, encoding="utf-8",
    ).stdout
    files = {}
    for line in out.split("\n"):
        if not line:
            continue
        if not line.startswith("\t"):
            objects = files.setdefault(line, {})
            continue
        fields = line[1:].split("\t")
        index = int(fields[0], 16)
        if len(fields) == 3:
            objects[index] = (int(fields[1]), unescape(fields[2]), {})
            continue
        _, sub, data_type, access, mappable, default, low, high, value, name = fields
        objects[index][2][int(sub, 16)] = {
            "name": unescape(name), "type": int(data_type), "access": access,
            "mapping": mappable == "1", "default": odkit_value(default),
            "low": odkit_value(low), "high": odkit_value(high), "value": odkit_value(value),
        }
    return files


def unescape(text):
    text = re.sub(r"\\u\{([0-9a-f]+)\}", lambda m: chr(int(m[1], 16)), text)
    return re.sub(r"\\([\\'\"tnr])", lambda m: {"t": "\t", "n": "\n", "r": "\r"}.get(m[1], m[1]), text)


def odkit_value(text):
    if not text:
        return None
    kind, text = text[0], text[1:]
    return {
        "i": int, "r": float, "t": unescape, "b": bytes.fromhex,
        "n": lambda offset: int(offset) + NODE_ID,
    }[kind](text)


class Raw:
    """The text of a file's fields, however it is written."""

    def __init__(self, path):
        self.sections = {}
        section = {}
        data = path.read_bytes()
        try:
            text = data.decode("utf-8-sig")
        except UnicodeDecodeError:
            text = data.decode("latin-1")
        for line in text.splitlines():
            line = line.strip()
            if line.startswith("["):
                name = line[1:].split("]")[0].strip().lower()
                section = self.sections.setdefault(name, {})
            elif "=" in line and line[0] not in ";#":
                key, value = line.split("=", 1)
                section.setdefault(key.strip().lower(), value.strip())

    def get(self, index, sub, key):
        own = self.sections.get(f"{index:04x}", {})
        for name in (f"{index:04x}sub{sub:x}", f"{index:04x}sub{sub:02x}"):
            if name in self.sections:
                return self.sections[name].get(key, "")
        if sub == 0 or "compactsubobj" in own:
            return own.get(key, "")
        return ""

    def is_compact(self, index):
        own = self.sections.get(f"{index:04x}", {})
        return own.get("compactsubobj", "0").strip() not in ("", "0", "0x0")


def file_kind(error):
    text = f"{type(error).__name__}: {error}"
    if isinstance(error, UnicodeDecodeError):
        return "file: text that is not UTF-8"
    if isinstance(error, (configparser.ParsingError, configparser.DuplicateOptionError,
                          configparser.DuplicateSectionError)):
        return "file: a line, section or key that stops the INI reader"
    if re.search(r"No option '(Dummy\d+|Line\d+|Lines)'", text):
        return "file: [DummyUsage] or [Comments] lacks a key"
    if re.search(r"No option '\d+' in section: '[0-9A-F]{4}Name'", text, re.IGNORECASE):
        return "file: [xxxxName] names some members only"
    if re.search(r"No option '(DataType|AccessType|ParameterName)'", text):
        return "file: DataType, AccessType or ParameterName is missing"
    if isinstance(error, ValueError) and "invalid literal for int" in text:
        return "file: a number is empty or followed by a comment"
    if isinstance(error, KeyError):
        return "file: member of an object without its section"
    return None


def members(entry):
    if isinstance(entry, ODVariable):
        return {0: entry}
    return dict(entry.subindices)


def compare(path, objects):
    """(kind or None, place, python-canopen's, odkit's) for each difference of one file."""
    try:
        od = canopen.import_od(str(path), NODE_ID)
    except Exception as error:  # whatever it is, it is what users of python-canopen get
        yield file_kind(error), "", f"{type(error).__name__}: {error}"[:90], "reads it"
        return
    raw = Raw(path)
    for index in sorted(set(od.indices) | set(objects)):
        place = f"{index:04X}h"
        if index not in objects:
            yield ("object: dummies" if index < 8 else None), place, "an object", "none"
            continue
        code, _, mine = objects[index]
        if index not in od.indices:
            kind = None
            if f"{index:04x}" not in raw.sections and 0x1400 <= index < 0x1C00:
                kind = "object: made from CompactPDO"
            elif code in (0, 5, 6):
                kind = "object: DEFTYPE, DEFSTRUCT or NULL"
            yield kind, place, "none", "an object"
            continue
        theirs = members(od.indices[index])
        for sub in sorted(set(mine) | set(theirs)):
            place = f"{index:04X}h:{sub:02X}"
            if sub not in theirs:
                yield missing_kind(od.indices[index], raw, index, sub), place, "no value", "a value"
            elif sub not in mine:
                compact = raw.is_compact(index)
                yield ("object: members of CompactSubObj" if compact else None), place, "a value", "no value"
            else:
                for difference in fields(theirs[sub], mine[sub], raw, index, sub):
                    yield difference[0], f"{place} {difference[1]}", *difference[2:]


def missing_kind(entry, raw, index, sub):
    if raw.is_compact(index):
        return "object: members of CompactSubObj"
    if isinstance(entry, ODVariable):
        return "object: VAR with members"
    names = [name for name in raw.sections if name.startswith(f"{index:04x}sub")]
    if names:
        return "object: member with a subsection name that python-canopen does not match"
    return None


def fields(var, mine, raw, index, sub):
    compact = raw.is_compact(index)
    if var.name != mine["name"]:
        name = raw.get(index, sub, "parametername")
        kind = None
        if compact:
            kind = "name: NrOfObjects" if sub == 0 else "name: member of CompactSubObj"
        elif ";" in name:
            kind = "name: `;` in a name"
        yield kind, "name", var.name, mine["name"]
    if var.data_type != mine["type"]:
        basic = mine["type"] and mine["type"] <= 0x1B
        yield (None if basic else "type: not a basic type"), "type", var.data_type, mine["type"]
    if var.access_type != mine["access"]:
        word = raw.get(index, sub, "accesstype").lower()
        kind = None
        if compact and sub == 0:
            kind = "access: of sub-index 0 of CompactSubObj"
        elif re.match(r"(ro|wo|rw|rwr|rww|const)\s*[;#]", word):
            kind = "access: followed by a comment"
        elif word not in ("ro", "wo", "rw", "rwr", "rww", "const"):
            kind = "access: none that CiA 306 knows"
        yield kind, "access", var.access_type, mine["access"]
    if var.pdo_mappable != mine["mapping"]:
        yield "mapping: a flag that is neither 0 nor 1", "mapping", var.pdo_mappable, mine["mapping"]
    for key, theirs, own in [
        ("DefaultValue", var.default, mine["default"]),
        ("ParameterValue", var.value, mine["value"]),
        ("LowLimit", var.min, mine["low"]),
        ("HighLimit", var.max, mine["high"]),
    ]:
        if same(theirs, own):
            continue
        text = raw.get(index, sub, key.lower())
        if key.endswith("Limit"):
            kind = limit_kind(mine["type"], text, theirs, own, compact and sub == 0)
        else:
            kind = value_kind(mine["type"], text, theirs, own, compact and sub == 0)
            if key == "ParameterValue" and compact and f"{index:04x}value" in raw.sections:
                kind = "value: from [xxxxValue]"
        yield kind, key, f"{theirs!r:.40}", f"{own!r:.40} of `{text[:40]}`"


def same(a, b):
    if isinstance(a, float) and isinstance(b, float):
        return a == b or abs(a - b) <= 1e-6 * max(abs(a), abs(b))
    return a == b


SIGNED = {2: 8, 3: 16, 4: 32, 0x10: 24, 0x12: 40, 0x13: 48, 0x14: 56, 0x15: 64}
UNSIGNED = {1: 1, 5: 8, 6: 16, 7: 32, 0x16: 24, 0x18: 40, 0x19: 48, 0x1A: 56, 0x1B: 64, 0xC: 48, 0xD: 48}


def value_kind(data_type, text, theirs, own, counts):
    if counts:
        return "value: sub-index 0 of CompactSubObj"
    if data_type == 0 or data_type > 0x1B:
        return "value: of an unknown type"
    if data_type in (9, 0xB) and text == "":
        return "value: an empty text"
    if data_type == 9 and ";" in text:
        return "value: `;` in a text"
    if data_type == 0xB:
        return "value: UNICODE_STRING"
    if data_type in (0xA, 0xF):
        return "value: an empty text" if text == "" else "value: OCTET_STRING or DOMAIN in another form"
    if data_type in (8, 0x11):
        if re.search(r"[;#]", text):
            return "value: followed by a comment"
        if theirs is None and re.match(r"0[xX]|.*[fF]$", text):
            return "value: real in hexadecimal or with a suffix"
        if theirs is None and re.match(r"[+-]?\d+,\d+$", text):
            return "value: real with a comma"
        return None
    if "NODEID" in text.upper():
        return "value: $NODEID in another case or place"
    if re.search(r"[;#]", text):
        return "value: followed by a comment"
    if data_type in (0xC, 0xD) and re.match(r"\d+\s+\d+$", text):
        return "value: time"
    if own is None and theirs is None:
        return "value: no value at all"
    if isinstance(own, int) and isinstance(theirs, int) and data_type in SIGNED:
        if theirs - own in (1 << 8, 1 << 16, 1 << 24, 1 << 32, 1 << 40, 1 << 48, 1 << 56, 1 << 64):
            return "value: two's complement"
    if theirs is None and isinstance(own, int):
        if re.match(r"0[0-7]+$", text):
            return "value: octal"
        if re.match(r"0\d+$", text):
            return "value: leading zeros"
        return "value: integer with a suffix, a point or `true`"
    return None


def limit_kind(data_type, text, theirs, own, counts):
    if counts:
        return "limit: of an object with members"
    if data_type == 0 or data_type > 0x1B:
        return "value: of an unknown type"
    if data_type in (8, 0x11):
        return "limit: of a real"
    if data_type in (9, 0xA, 0xB, 0xF):
        return "limit: of a text or bytes"
    if "NODEID" in text.upper():
        return "limit: $NODEID"
    if theirs is None and data_type in (0x10, 0x12, 0x13, 0x14):
        return "limit: of a 24-, 40-, 48- or 56-bit integer"
    if data_type in SIGNED and isinstance(theirs, int) and theirs < 0 and isinstance(own, int) and own > 0:
        decimal = re.match(r"\d+$", text)
        return ("limit: beyond the type, in decimal" if decimal
                else "limit: high limit that is a bit pattern below the low one")
    return value_kind(data_type, text, theirs, own, counts)


def differences(folder):
    """Counter of kinds, examples of each, and the differences of no kind."""
    logging.disable(logging.CRITICAL)
    warnings.simplefilter("ignore")
    counts, files, examples, unknown = collections.Counter(), collections.defaultdict(set), {}, []
    compared = collections.Counter()
    for name, objects in sorted(odkit_reading(folder).items()):
        if not name.lower().endswith((".eds", ".dcf")):
            continue
        compared["files"] += 1
        failed = False
        for kind, place, theirs, own in compare(folder / name, objects):
            failed |= place == ""
            if kind not in KINDS:
                unknown.append((kind, name, place, theirs, own))
                continue
            counts[kind] += 1
            files[kind].add(name)
            examples.setdefault(kind, (name, place, theirs, own))
        if not failed:
            compared["read by both"] += 1
            compared["values"] += sum(len(entries) for _, _, entries in objects.values())
    return counts, files, examples, unknown, compared


def docs(counts, files, compared):
    lines = [
        "# Where odkit and python-canopen differ",
        "",
        "Every object, sub-index, name, type, access, mapping flag, default, configured value and limit of the",
        "corpus, read by odkit and by python-canopen 2.4.1 (node ID 1). This page is made by",
        "`python tests/interop/differences.py DIR --docs`; `tests/interop/test_differences.py` fails if there is a",
        "difference of no kind that is listed here.",
        "",
        f"{compared['files']} EDS and DCF files; python-canopen reads {compared['read by both']} of them, with "
        f"{compared['values']} values in odkit's reading.",
        "",
        "| difference | files | times | right is | why |",
        "|---|--:|--:|---|---|",
    ]
    for kind, (right, why) in KINDS.items():
        if counts[kind]:
            lines.append(f"| {kind} | {len(files[kind])} | {counts[kind]} | {right} | {why} |")
    unseen = [kind for kind in KINDS if not counts[kind]]
    if unseen:
        lines += ["", "Known, and in no file of this corpus:", ""]
        lines += [f"- {kind}: {KINDS[kind][0]}. {KINDS[kind][1]}" for kind in unseen]
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path)
    parser.add_argument("--docs", action="store_true")
    args = parser.parse_args()
    counts, files, examples, unknown, compared = differences(args.folder)
    if args.docs:
        text = docs(counts, files, compared)
        (ROOT / "docs" / "DIFFERENCES.md").write_text(text, encoding="utf-8")
    for kind, count in counts.most_common():
        print(f"{count:6} in {len(files[kind]):3} files  {kind}  e.g. {examples[kind]}")
    for difference in unknown:
        print("of no kind:", difference)
    print(dict(compared))


if __name__ == "__main__":
    main()
