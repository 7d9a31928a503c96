"""The EDS that `odkit export` writes of each device, as python-canopen reads it.

The expected content is in `odkit dump`, which shows the compiled dictionary.
"""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import canopen
from canopen.objectdictionary import ODVariable, datatypes

from bench import odkit

NODE = 5
TYPES = {
    "UNSIGNED8": datatypes.UNSIGNED8,
    "UNSIGNED16": datatypes.UNSIGNED16,
    "UNSIGNED32": datatypes.UNSIGNED32,
    "INTEGER16": datatypes.INTEGER16,
    "INTEGER32": datatypes.INTEGER32,
    "VISIBLE_STRING": datatypes.VISIBLE_STRING,
}
DEVICES = "gxmm gxam gcmm gcam gbmm gbam gdmm gdam eam_mt eam_st eam_red en580c".split()


def say(*arguments):
    done = subprocess.run(
        [odkit(), *arguments], capture_output=True, text=True, check=True, timeout=60
    )
    return done.stdout


def rows(table):
    """Rows of `odkit dump` by their columns."""
    lines = table.splitlines()
    starts = [found.start() for found in re.finditer(r"\S+", lines[0])]
    names = lines[0].split()
    for line in lines[1:]:
        cells = [
            line[start:end].strip()
            for start, end in zip(starts, starts[1:] + [None], strict=True)
        ]
        yield dict(zip(names, cells, strict=True))


def number(text):
    """A number as `odkit dump` shows it, for our node ID."""
    total = 0
    for part in text.split("+"):
        part = part.strip()
        if part == "node ID":
            total += NODE
        elif part.endswith("h"):
            total += int(part[:-1], 16)
        else:
            total += int(part)
    return total


class Export(unittest.TestCase):
    def check(self, device):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / f"{device}.eds"
            path.write_text(say("export", device), encoding="ascii")
            read = canopen.import_od(str(path), node_id=NODE)
        index, seen, objects = 0, 0, set()
        for row in rows(say("dump", device)):
            if row["Index"]:
                index = int(row["Index"][:-1], 16)
                objects.add(index)
            if not row["Sub"]:
                self.assertEqual(read[index].name, row["Name"])
                kinds = {
                    "ARRAY": canopen.objectdictionary.ODArray,
                    "RECORD": canopen.objectdictionary.ODRecord,
                }
                self.assertIsInstance(read[index], kinds[row["Type"]])
                continue
            sub = int(row["Sub"], 16)
            entry = read[index]
            variable = entry if isinstance(entry, ODVariable) else entry.subindices[sub]
            with self.subTest(device=device, object=f"{index:04X}h:{sub:02X}"):
                self.check_one(variable, row)
            seen += 1
        self.assertEqual(objects, set(read.indices), "no object too much or too few")
        count = sum(
            1 if isinstance(read[index], ODVariable) else len(read[index].subindices)
            for index in read.indices
        )
        self.assertEqual(count, seen)
        self.assertGreater(seen, 80)

    def check_one(self, variable, row):
        self.assertEqual(variable.name, row["Name"])
        self.assertEqual(variable.data_type, TYPES[row["Type"]])
        self.assertEqual(variable.access_type, row["Access"])
        self.assertEqual(variable.pdo_mappable, row["PDO"] != "")
        if row["Type"] == "VISIBLE_STRING":
            self.assertEqual(f'"{variable.default}"', row["Default"])
        else:
            self.assertEqual(variable.default, number(row["Default"]))
        low, _, high = row["Limits"].partition("..")
        self.assertEqual(variable.min, number(low) if low else None)
        self.assertEqual(variable.max, number(high) if high else None)


for name in DEVICES:
    setattr(Export, f"test_{name}", lambda self, name=name: self.check(name))


if __name__ == "__main__":
    unittest.main()
