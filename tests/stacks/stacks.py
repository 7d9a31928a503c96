"""Tests open CANopen stacks with `odkit conform`, and writes docs/CONFORMANCE.md.

    python3 tests/stacks/stacks.py FOLDER [--again]

FOLDER is outside the repository: stacks are fetched and built there, and their results stay there. A stack with a result is not run
again without `--again`. Each stack is a slave of its own behind slcan over TCP. Its EDS also declares what the slave is not made for,
so judged.txt says for each failure whose it is. The driver of ros2_canopen for drives is a master instead: it commands the built-in
drive. The driver needs a compiler of C++ and the headers of Boost.
"""

import fnmatch
import json
import os
import re
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ODKIT = Path(os.environ.get("ODKIT", ROOT / "target/debug/odkit"))
PORT = "30401"
LINK = ["--link", f"slcan:127.0.0.1:{PORT}"]
SOURCES = {
    "CANopenNode": ("https://github.com/CANopenNode/CANopenNode", "9b8beed"),
    "CANopenDemo": ("https://github.com/CANopenNode/CANopenDemo", "1f16f49"),
    "lely-core": ("https://gitlab.com/lely_industries/lely-core", "620d1858"),
    "ros2_canopen": ("https://github.com/ros-industrial/ros2_canopen", "6ada1969"),
}
CARGO = """[package]
name = "{name}-slave"
version = "0.1.0"
edition = "2024"

{dependencies}

[workspace]
"""
ZENCAN = """[dependencies]
zencan-node = { version = "=0.0.5", features = ["std"] }

[build-dependencies]
zencan-build = "=0.0.5"
"""
CANOPEN_RS = """[dependencies]
canopen-rs = { version = "=0.6.1", features = ["std"] }
"""
STARTUP = """
[1F80]
ParameterName=NMT startup
ObjectType=0x7
DataType=0x0007
AccessType=rw
DefaultValue=4
PDOMapping=0
"""
BUILD = 'fn main() {\n    zencan_build::build_node_from_device_config("SLAVE", "slave.toml").expect("a configuration");\n}\n'


def python_canopen(folder):
    """python-canopen's LocalNode with the EDS of a slave of all services: command and EDS."""
    eds = folder / "ds301.eds"
    shutil.copy(ROOT / "firmware/eds/ds301.eds", eds)
    programs = environment(folder / "python", "canopen==2.4.1", "python-can==4.6.1")
    return [programs / "python", HERE / "local_node.py", PORT, eds, "5"], eds


def crate(folder, name, source, dependencies):
    """A crate around the source of a slave: its folder and its program."""
    path = folder / name
    (path / "src").mkdir(parents=True, exist_ok=True)
    (path / "Cargo.toml").write_text(CARGO.format(name=name, dependencies=dependencies))
    shutil.copy(HERE / source, path / "src/main.rs")
    shutil.copy(HERE / "slcan.rs", path / "src/slcan.rs")
    return path, path / f"target/debug/{name}-slave"


def zencan(folder):
    """zencan-node with a TPDO and an RPDO; its EDS is learned from it."""
    path, program = crate(folder, "zencan", "zencan.rs", ZENCAN)
    (path / "build.rs").write_text(BUILD)
    shutil.copy(HERE / "zencan.toml", path / "slave.toml")
    subprocess.run(["cargo", "build"], cwd=path, check=True)
    return [program, PORT, "5"], None


def canopen_rs(folder):
    """canopen-rs with a TPDO and an RPDO; its EDS is learned from it."""
    path, program = crate(folder, "canopen-rs", "canopen_rs.rs", CANOPEN_RS)
    subprocess.run(["cargo", "build"], cwd=path, check=True)
    return [program, PORT, "5"], None


def source(folder, name):
    """The checkout of a stack, cloned if it is missing."""
    path = folder / name
    address, commit = SOURCES[name]
    if not path.exists():
        subprocess.run(["git", "clone", "-q", address, path], check=True)
    subprocess.run(["git", "-C", path, "checkout", "-q", commit], check=True)
    return path


def compiled(program, sources, flags, compiler="cc"):
    """A program of C or C++, compiled unless it is newer than its sources."""
    own = [path for path in HERE.rglob("*.*") if path.suffix in (".c", ".h", ".cpp", ".hpp")]
    newest = max(path.stat().st_mtime for path in [*sources, *own])
    if not program.exists() or program.stat().st_mtime < newest:
        subprocess.run([compiler, "-O1", "-w", *flags, *sources, "-o", program, "-lm"], check=True)
    return program


def environment(folder, *packages):
    """A folder for Python programs of its own, with these packages."""
    if not folder.exists():
        subprocess.run([sys.executable, "-m", "venv", folder], check=True)
        subprocess.run([folder / "bin/pip", "install", "-q", *packages], check=True)
    return folder / "bin"


def canopennode(folder):
    """CANopenNode with the objects of its demo device."""
    stack, demo = source(folder, "CANopenNode"), source(folder, "CANopenDemo") / "demo"
    parts = ["CO_ODinterface", "CO_NMT_Heartbeat", "CO_HBconsumer", "CO_Emergency", "CO_SDOserver", "CO_TIME", "CO_SYNC", "CO_PDO"]
    files = [stack / f"301/{part}.c" for part in [*parts, "crc16-ccitt"]]
    files += [stack / part for part in ["303/CO_LEDs.c", "305/CO_LSSslave.c", "storage/CO_storage.c", "CANopen.c"]]
    files += [demo / f"{part}.c" for part in ["OD", "CO_identificators", "objectAccessOD", "domainDemo"]]
    folders = [HERE / "canopennode", stack, demo, demo / "linux"]
    program = compiled(folder / "canopennode-slave", [HERE / "canopennode/main.c", *files], [f"-I{path}" for path in folders])
    eds = folder / "canopennode.eds"
    shutil.copy(demo / "demoDevice.eds", eds)
    return [program, PORT, "5"], eds


def lely(folder):
    """Lely core with the EDS of a slave of all services."""
    stack = source(folder, "lely-core")
    files = [path for part in ["libc", "util", "can", "co"] for path in sorted((stack / "src" / part).glob("*.c"))]
    files = [path for path in files if path.name not in ("vci.c", "socket.c", "threads-win32.c")]
    flags = [f"-I{stack / 'include'}", "-D_GNU_SOURCE", "-DNDEBUG", "-DLELY_NO_CANFD=1", "-DLELY_NO_CXX=1", "-pthread"]
    program = compiled(folder / "lely-slave", [HERE / "lely.c", *files], flags)
    eds = folder / "lely.eds"
    # Without 1F80h it enters Operational without a command.
    text = (ROOT / "firmware/eds/ds301.eds").read_text()
    text = re.sub(r"(?m)^33=.*$", r"\g<0>\n34=0x1F80", text.replace("SupportedObjects=33", "SupportedObjects=34"), count=1)
    eds.write_text(text + STARTUP)
    return [program, PORT, "5", eds], eds


def ros2_drive(folder):
    """ros2_canopen's driver for drives on the master of Lely core: the program, and the folder with its network."""
    stack, ros = source(folder, "lely-core"), source(folder, "ros2_canopen")
    parts = ["libc", "util", "can", "co", "ev", "io2", "io2/can", "io2/linux", "io2/sys", "io2/user"]
    files = [path for part in parts for path in sorted((stack / "src" / part).glob("*.c"))]
    files = [path for path in files if path.name not in ("vci.c", "socket.c", "threads-win32.c")]
    files += [stack / f"src/io2/posix/{part}.c" for part in ("fd", "io", "sigset")]
    flags = [f"-I{stack / 'include'}", "-D_GNU_SOURCE", "-DNDEBUG", "-pthread"]
    library = compiled(folder / "liblely-master.so", files, [*flags, "-shared", "-fPIC"])
    files = [path for part in ("util", "coapp", "io2") for path in sorted((stack / "src" / part).glob("*.cpp"))]
    files += [ros / f"canopen_402_driver/src/{part}.cpp" for part in ("motor", "command", "state", "default_homing_mode")]
    files += [ros / "canopen_base_driver/src/lely_driver_bridge.cpp", HERE / "ros2/drive.cpp", library]
    folders = [HERE / "ros2/stand_ins", *(ros / part / "include" for part in ("canopen_402_driver", "canopen_base_driver", "canopen_core"))]
    flags += [*(f"-I{path}" for path in folders), f"-Wl,-rpath,{folder}", "-std=c++17"]
    program = compiled(folder / "ros2-drive", files, flags, "c++")
    network = folder / "ros2-network"
    network.mkdir(exist_ok=True)
    eds = subprocess.run([ODKIT, "export", "drive"], stdout=subprocess.PIPE, check=True)
    (network / "drive.eds").write_bytes(eds.stdout)
    shutil.copy(HERE / "ros2/bus.yml", network)
    programs = environment(folder / "dcf-tools", "dcf-tools==2.4.2", "setuptools<81")
    subprocess.run([programs / "dcfgen", "-r", "bus.yml"], cwd=network, check=True)
    return program, network


def driven(folder):
    """Lets the driver of ros2_canopen command the built-in drive, and writes its steps: name and whether it is done."""
    program, network = ros2_drive(folder)
    control = str(int(PORT) + 1)
    links = ["--link", f"slcan:127.0.0.1:{PORT}", "--control", f"tcp:127.0.0.1:{control}"]
    drive = running([ODKIT, "sim", "drive@3", *links, "--quiet"])
    try:
        command = [program, PORT, control, "master.dcf", "drive.eds", "drive.bin"]
        done = subprocess.run(command, cwd=network, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=300)
    finally:
        drive.kill()
    steps = re.findall(r"(?m)^(ok|failed) (.*)$", done.stdout)
    (folder / "ros2-drive.json").write_text(json.dumps([[name, result == "ok"] for result, name in steps]))


STACKS = [
    ("CANopenNode", "4.1, commit 9b8beed, its demo device", canopennode),
    ("Lely core", "2.4.0, commit 620d1858", lely),
    ("python-canopen", "2.4.1, `LocalNode`", python_canopen),
    ("zencan-node", "0.0.5", zencan),
    ("canopen-rs", "0.6.1", canopen_rs),
]


def running(command):
    """The slave as a process that is ready for a client."""
    slave = subprocess.Popen([str(part) for part in command])
    time.sleep(3)
    return slave


def tested(name, make, folder):
    """Writes the report of one stack, as JSON."""
    command, eds = make(folder)
    slave = running(command)
    try:
        if eds is None:
            eds = folder / f"{name}.eds"
            subprocess.run([ODKIT, "learn", "5", *LINK, "--allow-writes", "-o", eds], check=True)
        report = folder / f"{name}.json"
        test = [ODKIT, "conform", *LINK, "--node-id", "5", "--eds", eds, "--allow-reset", "--allow-store", "--allow-motion"]
        subprocess.run([*test, "--report", report], stdout=subprocess.DEVNULL)
        assert slave.poll() is None, f"{name} ended"
    finally:
        slave.kill()


def learned(folder):
    """Compares the EDS that is learned from CANopenNode with its own, and with the node: differences of each."""
    command, own = canopennode(folder)
    slave = running(command)
    try:
        eds = folder / "learned.eds"
        eds.unlink(missing_ok=True)
        subprocess.run([ODKIT, "learn", "5", *LINK, "--allow-writes", "-o", eds], check=True)
        pairs = {"own": [own, eds], "live": [eds, *LINK, "--node-id", "5"]}
        found = {}
        for name, arguments in pairs.items():
            done = subprocess.run([ODKIT, "diff", *arguments, "--format", "json"], stdout=subprocess.PIPE, text=True)
            found[name] = json.loads(done.stdout)["differences"]
        found["entries"] = len(re.findall(r"(?m)^DataType=", own.read_text()))
    finally:
        slave.kill()
    (folder / "learned.json").write_text(json.dumps(found))


#: Why a field of a learned EDS differs.
REASONS = {
    "default": "values that the stack computes, and texts that its EDS leaves out",
    "data-type": "whether an integer has a sign, or is a REAL64, is not in a response; a text with bytes beyond ASCII is an OCTET_STRING",
    "access": "sub-index 0 of a list: `const` for `ro`",
    "mapping": "`learn` marks the objects that are mapped, and does not try others",
    "storage": "CANopenEditor's own key for the storage of an object",
    "name": "names come from the standards",
    "high-limit": "a limit that the probe of the value found",
}


def judgements():
    """Lines of judged.txt: stack, patterns, judgement."""
    lines = (HERE / "judged.txt").read_text().splitlines()
    rows = [line.split(" | ") for line in lines if line and not line.startswith("#")]
    return [(stack, patterns.split(), text) for stack, patterns, text in rows]


def page(folder):
    """The text of docs/CONFORMANCE.md."""
    out = [
        "# Open stacks in the conformance test",
        "",
        "`tests/stacks/stacks.py` builds each stack outside the repository, puts a slave made with it behind slcan, and runs",
        "`odkit conform` with resets, stores and outputs allowed. A failure belongs to this slave and the EDS of the test: a service that the EDS declares and",
        "the stack leaves to its application counts as a failure, too. Each failure was judged by its frames.",
        "Skipped are the cases that switch the power, and those in which the computer of the test was late.",
        "",
        "| stack | version | passed | failed | skipped | not applicable |",
        "|---|---|---|---|---|---|",
    ]
    reports = {}
    for name, version, _ in STACKS:
        report = json.loads((folder / f"{name}.json").read_text())
        reports[name] = report
        counts = report["counts"]
        cells = [counts[key] for key in ("pass", "fail", "skipped", "not_applicable")]
        out.append(f"| {name} | {version} | " + " | ".join(str(cell) for cell in cells) + " |")
    rows = judgements()
    for name, report in reports.items():
        out += ["", f"## {name}", ""]
        if report["lost"]:
            out += [f"The run ended early: {report['lost']}.", ""]
        out += ["| behaviour | cases |", "|---|---|"]
        failed = [case["id"] for case in report["cases"] if case["verdict"] == "fail"]
        for stack, patterns, text in rows:
            if stack == name:
                own = [case for case in failed if any(fnmatch.fnmatch(case, one) for one in patterns)]
                failed = [case for case in failed if case not in own]
                if own:
                    out.append(f"| {text} | {', '.join(own)} |")
        if failed:
            out.append(f"| not judged | {', '.join(failed)} |")
    found = json.loads((folder / "learned.json").read_text())
    out += [
        "",
        "## `odkit learn` on CANopenNode",
        "",
        f"The EDS that `odkit learn --allow-writes` makes of the node has the {found['entries']} values of the stack's own EDS. They differ in:",
        "",
        "| field | differences | why |",
        "|---|---|---|",
    ]
    fields = [one["field"] for one in found["own"]]
    out += [f"| {field} | {fields.count(field)} | {REASONS.get(field, 'not judged')} |" for field in sorted(set(fields))]
    live = len(found["live"])
    out += ["", f"Against the running node `odkit diff` finds {live} difference{'' if live == 1 else 's'} in it."]
    steps = json.loads((folder / "ros2-drive.json").read_text())
    done = [name for name, is_done in steps if is_done]
    out += [
        "",
        "## ros2_canopen commands the drive",
        "",
        "`Motor402` and `LelyDriverBridge` of ros2_canopen (commit 6ada1969, 0.3.4, unchanged) on the master of Lely core (commit 620d1858)",
        "command both axes of `odkit sim drive@3` every 10 ms. Small classes of ours replace what they use of rclcpp.",
        "Its user has to know two things: the RPDO with the set-point must be event-driven, otherwise the controlword overtakes it; and the",
        "motor must be shut down before `handleInit`, which reads an old state of an enabled motor and ends at once.",
        f"{len(done)} of {len(steps)} steps are done:",
        "",
        "| step | axis 1 | axis 2 |",
        "|---|---|---|",
    ]
    for name in dict.fromkeys(re.sub(r"^axis \d: ", "", name) for name, _ in steps):
        cells = [{True: "done", False: "failed"}.get(dict(steps).get(f"axis {axis}: {name}"), "") for axis in (1, 2)]
        if any(cells):
            out.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(out) + "\n"


def main():
    folder = Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for name, _, make in STACKS:
        if "--again" in sys.argv or not (folder / f"{name}.json").exists():
            tested(name, make, folder)
    if "--again" in sys.argv or not (folder / "learned.json").exists():
        learned(folder)
    if "--again" in sys.argv or not (folder / "ros2-drive.json").exists():
        driven(folder)
    (ROOT / "docs/CONFORMANCE.md").write_text(page(folder))


main()
