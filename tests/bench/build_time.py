#!/usr/bin/env python3
"""What a call of object_dictionary! adds to a build.

    python3 tests/bench/build_time.py [ROUNDS]

Two description files are generated, of 100 objects and of 6,000 values. For each, a crate with
one call is built as a user builds it (`dev` profile, nothing optimized, macro included) after its
source has changed, and so is a crate without a call; the difference is what the call adds. Of
ROUNDS (default 5) the fastest counts. Processor time is what a busy machine blurs least.
"""

import os
import pathlib
import resource
import shutil
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
WORDS = """Position Speed Acceleration Torque Temperature Pressure Limit Offset Gain Filter Mode
Status Control Counter Threshold Window Delay Period Source Target""".split()
# Data type, largest value.
TYPES = [(0x05, 255), (0x06, 65535), (0x07, 4294967295), (0x03, 32767), (0x04, 2147483647)]
# Name, application objects, how many of them are VARs between two records, members of a record.
SIZES = [("hundred", 97, 3, 5), ("thousands", 749, 0, 7)]
# Milliseconds that a call may add.
MARKS = {"hundred": 100, "thousands": 2000}


def value(section, name, data_type, access, default, mappable, limits=""):
    return (
        f"[{section}]\nParameterName={name}\nObjectType=0x7\nDataType=0x{data_type:04X}\n"
        f"AccessType={access}\nDefaultValue={default}\n{limits}PDOMapping={mappable}\n\n"
    )


def varied(section, name, number):
    data_type, top = TYPES[number % 5]
    limits = f"LowLimit={number % 7}\nHighLimit={top - number % 9}\n" if number % 2 else ""
    access = ["rw", "ro", "rw", "const"][number % 4]
    mappable = int(number % 3 == 0 and access != "const")
    return value(section, name, data_type, access, 10 + number % 90, mappable, limits)


def record(index, name, members):
    count = len(members)
    head = f"[{index:04X}]\nParameterName={name}\nObjectType=0x9\nSubNumber={count + 1}\n\n"
    first = value(f"{index:04X}sub0", "Highest sub-index supported", 5, "const", count, 0)
    return head + first + "".join(members)


def description(count, between, members):
    """The text of a description file, and how many values it has."""
    indices = range(0x2000, 0x2000 + count)
    listed = "".join(f"{at + 1}=0x{index:04X}\n" for at, index in enumerate(indices))
    identity = [
        value(f"1018sub{sub}", name, 7, "ro", "1", 0)
        for sub, name in enumerate(["Vendor-ID", "Product code", "Revision number"], 1)
    ]
    parts = [
        "[FileInfo]\nFileName=generated.eds\nFileVersion=1\nFileRevision=1\nEDSVersion=4.0\n\n",
        "[DeviceInfo]\nVendorName=Generated\nVendorNumber=1\nProductName=Generated\n"
        "ProductNumber=1\nRevisionNumber=1\nBaudRate_125=1\nGranularity=8\n\n",
        "[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n\n",
        f"[ManufacturerObjects]\nSupportedObjects={count}\n{listed}\n",
        value("1000", "Device type", 7, "ro", "0", 0),
        value("1001", "Error register", 5, "ro", "0", 1),
        record(0x1018, "Identity object", identity),
    ]
    values = 6
    for at, index in enumerate(indices):
        name = f"{WORDS[at % 20]} {WORDS[at // 20 % 20]} {at}"
        if at % (between + 1) < between:
            parts.append(varied(f"{index:04X}", name, at))
            values += 1
            continue
        subs = [
            varied(f"{index:04X}sub{m:X}", f"{WORDS[(at + m) % 20]} {WORDS[at * m % 20]} {m}", at + m)
            for m in range(1, members + 1)
        ]
        parts.append(record(index, name, subs))
        values += 1 + members
    return "".join(parts).replace("\n", "\r\n"), values


def crate(folder, name, source):
    (folder / name / "src").mkdir(parents=True)
    shutil.copy(ROOT / "Cargo.lock", folder / name)
    (folder / name / "Cargo.toml").write_text(
        f'[package]\nname = "bench-{name}"\nversion = "0.0.0"\nedition = "2024"\n[workspace]\n'
        f'[dependencies]\nod-model = {{ path = "{ROOT}/od-model", default-features = false }}\n'
        f'od-macros = {{ path = "{ROOT}/od-macros" }}\n'
    )
    (folder / name / "src/lib.rs").write_text(source)


def build(folder, name, command):
    """Seconds on the wall, and of processor time, after a change of the source."""
    path = folder / name / "src/lib.rs"
    path.write_text(path.read_text() + f"// {time.time_ns()}\n")
    environment = os.environ | {"CARGO_TARGET_DIR": str(folder / "target"), "CARGO_INCREMENTAL": "0"}
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    done = subprocess.run(
        ["cargo", command, "--offline", "--quiet"],
        cwd=folder / name, env=environment, stderr=subprocess.PIPE, text=True, check=False,
    )
    wall = time.monotonic() - start
    if done.returncode:
        sys.exit(done.stderr)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return wall, after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def main():
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        crate(folder, "empty", "")
        about = {}
        for name, *shape in SIZES:
            text, values = description(*shape)
            about[name] = f"{shape[0] + 3} objects, {values} values, {len(text) // 1000} kB"
            call = 'od_macros::object_dictionary! { pub mod device { eds = "device.eds"; } }\n'
            crate(folder, name, call)
            (folder / name / "src/device.eds").write_text(text, newline="")
        names = ["empty", *MARKS]
        print("| a call on | command | wall | processor | wanted |\n|---|---|--:|--:|--:|")
        for command in ["check", "build"]:
            for name in names:
                build(folder, name, command)  # the dependencies
            times = {name: [] for name in names}
            for _ in range(rounds):
                for name in names:
                    times[name].append(build(folder, name, command))
            best = {n: [min(t[i] for t in times[n]) * 1000 for i in (0, 1)] for n in names}
            for name in MARKS:
                wall, cpu = (best[name][i] - best["empty"][i] for i in (0, 1))
                print(f"| {about[name]} | `cargo {command}` | {wall:.0f} ms | {cpu:.0f} ms | ≤ {MARKS[name]} ms |")


if __name__ == "__main__":
    main()
