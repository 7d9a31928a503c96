"""Tests open CANopen stacks with `odkit conform`, and writes docs/CONFORMANCE.md.

    python3 tests/stacks/stacks.py FOLDER [--again]

FOLDER is outside the repository: stacks are fetched and built there, and their results stay there. A stack whose result is there is
not run again without `--again`. Each stack is a slave of its own behind slcan over TCP; what it is not made for is in its EDS all the
same, so every failure is judged in judged.txt.
"""

import fnmatch
import json
import shutil
import subprocess
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ODKIT = ROOT / "target/debug/odkit"
CARGO = """[package]
name = "zencan-slave"
version = "0.1.0"
edition = "2021"

[dependencies]
zencan-node = { version = "=0.0.5", features = ["std"] }

[build-dependencies]
zencan-build = "=0.0.5"

[workspace]
"""
BUILD = 'fn main() {\n    zencan_build::build_node_from_device_config("SLAVE", "slave.toml").expect("a configuration");\n}\n'


def python_canopen(folder):
    """python-canopen's LocalNode with the EDS of a slave of all services: command and EDS."""
    eds = folder / "ds301.eds"
    shutil.copy(ROOT / "firmware/eds/ds301.eds", eds)
    env = folder / "python"
    if not env.exists():
        subprocess.run([sys.executable, "-m", "venv", env], check=True)
        subprocess.run([env / "bin/pip", "install", "-q", "canopen==2.4.1", "python-can==4.6.1"], check=True)
    return [env / "bin/python", HERE / "local_node.py", "30401", eds, "5"], eds


def zencan(folder):
    """zencan-node with a TPDO and an RPDO; its EDS is learned from it."""
    crate = folder / "zencan"
    (crate / "src").mkdir(parents=True, exist_ok=True)
    (crate / "Cargo.toml").write_text(CARGO)
    (crate / "build.rs").write_text(BUILD)
    shutil.copy(HERE / "zencan.toml", crate / "slave.toml")
    shutil.copy(HERE / "zencan.rs", crate / "src/main.rs")
    subprocess.run(["cargo", "build"], cwd=crate, check=True)
    return [crate / "target/debug/zencan-slave", "30401", "5"], None


STACKS = [
    ("python-canopen", "2.4.1, `LocalNode`", python_canopen),
    ("zencan-node", "0.0.5", zencan),
]
LINK = ["--link", "slcan:127.0.0.1:30401"]


def tested(name, make, folder):
    """The report of one stack, as JSON."""
    command, eds = make(folder)
    slave = subprocess.Popen([str(part) for part in command])
    try:
        time.sleep(3)
        if eds is None:
            eds = folder / f"{name}.eds"
            subprocess.run([ODKIT, "learn", "5", *LINK, "--allow-writes", "-o", eds], check=True)
        report = folder / f"{name}.json"
        test = [ODKIT, "conform", *LINK, "--node-id", "5", "--eds", eds, "--allow-reset", "--allow-store"]
        subprocess.run([*test, "--report", report], stdout=subprocess.DEVNULL)
    finally:
        slave.kill()


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
        "`odkit conform` with resets and stores allowed. A failure belongs to this slave and the EDS of the test: a service that the EDS declares and",
        "the stack leaves to its application counts as a failure, too. Each failure was judged by its frames.",
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
    return "\n".join(out) + "\n"


def main():
    folder = Path(sys.argv[1]).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    for name, _, make in STACKS:
        if "--again" in sys.argv or not (folder / f"{name}.json").exists():
            tested(name, make, folder)
    (ROOT / "docs/CONFORMANCE.md").write_text(page(folder))


main()
