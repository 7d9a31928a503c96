"""The DBC of `odkit convert`, as cantools decodes it: each mapped PDO to the values of its mapping.

With folders as arguments it is a measurement of their files: `test_dbc.py FOLDER…`.
"""

import json
import random
import struct
import subprocess
import sys
import unittest
from pathlib import Path

import cantools

from bench import ROOT, odkit

NODE = 5
FILES = [*sorted((ROOT / "devices" / "eds").glob("*.eds")), ROOT / "tests" / "interop" / "mapped.eds"]
PDOS = [("TPDO", 0x1A00), ("RPDO", 0x1600)]


def convert(path, form):
    done = subprocess.run(
        [odkit(), "convert", str(path), "--to", form, "--lossy"] + ["--node-id", str(NODE)] * (form == "dbc"),
        capture_output=True, text=True, timeout=60,
    )
    if done.returncode != 0:
        assert "does not define any object" in done.stderr, f"{path}: {done.stderr}"
        return None
    return done.stdout


def start(entry):
    return entry["parameter"] if entry["parameter"] is not None else entry["default"]


def value(data_type, bits, raw):
    """The value of these bits: what a master makes of them."""
    if data_type in ("REAL32", "REAL64") and bits == (32 if data_type == "REAL32" else 64):
        form = "<f" if bits == 32 else "<d"
        return struct.unpack(form, raw.to_bytes(bits // 8, "little"))[0]
    if data_type is not None and data_type.startswith("INTEGER") and raw >> (bits - 1):
        return raw - (1 << bits)
    return raw


def mappings(dictionary):
    """Name, bits and values of each PDO that maps something. The counts 254 and 255 (multiplexed PDOs) map nothing."""
    objects = {int(one["index"], 16): {sub["sub"]: sub for sub in one["entries"]} for one in dictionary["objects"]}
    for name, first in PDOS:
        for index in sorted(index for index in objects if first <= index < first + 0x200):
            entries = objects[index]
            count = start(entries[0]) if 0 in entries else 0
            if not isinstance(count, int) or count > 64 or index - 0x200 not in objects:
                continue
            fields, at = [], 0
            for sub in range(1, count + 1):
                mapped = entries.get(sub, {}).get("maps")
                if mapped is None:
                    continue
                bits, target = mapped["bits"], int(mapped["index"], 16)
                if at + bits > 64:
                    break
                if target >= 0x20 and bits:
                    entry = objects.get(target, {}).get(mapped["sub"], {})
                    fields.append((at, bits, entry.get("dataType")))
                at += bits
            if at:
                yield f"N{NODE}_{name}{index - first + 1}", at, fields


def check(path):
    """Counts the PDOs of a file and those that no message has, and fails at a wrong value."""
    text = convert(path, "dbc")
    if text is None:
        return 0, 0
    base = cantools.database.load_string(text, "dbc")
    known = {message.name: message for message in base.messages}
    seen = missing = 0
    rows = random.Random(1)
    for name, bits, fields in mappings(json.loads(convert(path, "json"))):
        message = known.get(name)
        seen += 1
        if message is None:
            missing += 1
            continue
        length = (bits + 7) // 8
        assert message.length == length, f"{path} {name}: {message.length} bytes, {length} mapped"
        signals = sorted(message.signals, key=lambda signal: signal.start)
        assert len(signals) == len(fields), f"{path} {name}: {len(signals)} signals"
        for data in [bytes(length), b"\xff" * length, *(rows.randbytes(length) for _ in range(8))]:
            decoded = message.decode(data, decode_choices=False)
            whole = int.from_bytes(data, "little")
            for signal, (at, own, data_type) in zip(signals, fields):
                expected = value(data_type, own, whole >> at & (1 << own) - 1)
                got = decoded[signal.name]
                same = got == expected or (got != got and expected != expected)
                assert same, f"{path} {name} {signal.name}: {got}, not {expected}"
    return seen, missing


class Dbc(unittest.TestCase):
    def test_each_mapped_pdo_is_decoded(self):
        for path in FILES:
            seen, missing = check(path)
            self.assertEqual(missing, 0, path)
            self.assertGreater(seen, 0, path)

    def test_the_frames_of_every_node(self):
        base = cantools.database.load_string(convert(FILES[0], "dbc"), "dbc")
        for identifier, data, expected in [
            (0x700 + NODE, "7f", {"NMT_state": "Pre-operational", "Toggle_bit": 0}),
            (0x000, "8105", {"NMT_command": "Reset node", "NMT_node_ID": NODE}),
            (0x600 + NODE, "4018100100000000", {"SDO_command": "Upload", "SDO_index": 0x1018, "SDO_sub_index": 1,
                                                "SDO_data": 0}),
            (0x580 + NODE, "43181001ec000000", {"SDO_command": "Upload 4 bytes", "SDO_index": 0x1018,
                                                "SDO_sub_index": 1, "SDO_data": 0xEC}),
        ]:
            self.assertEqual(base.decode_message(identifier, bytes.fromhex(data)), expected)
        emcy = base.decode_message(0x80 + NODE, bytes.fromhex("1082110000000000"))
        self.assertEqual((emcy["Emergency_error_code"], emcy["Error_register"]), (0x8210, 0x11))
        self.assertEqual(base.get_message_by_name("SYNC").frame_id, 0x80)


if __name__ == "__main__":
    if len(sys.argv) > 1:
        endings = {".eds", ".dcf", ".xdd", ".xdc", ".xpd"}
        paths = [path for name in sys.argv[1:] for path in sorted(Path(name).rglob("*"))]
        totals = [check(path) for path in paths if path.suffix.lower() in endings]
        print(len(totals), "files,", sum(seen for seen, _ in totals), "PDOs,",
              sum(missing for _, missing in totals), "without a message")
    else:
        unittest.main()
