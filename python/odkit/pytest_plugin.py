"""Fixtures and markers for pytest: a bench and a bus for each test.

Without a marker the bench has a GXMM encoder at node ID 1::

    @pytest.mark.odkit_devices("gxmm@1", "eam_mt@2")
    def test_two_encoders(odkit_bench, odkit_bus): ...

    @pytest.mark.odkit_eds("drive.eds", node_id=5)
    def test_drive(odkit_bench, odkit_bus): ...

A failing test or fixture shows the faults in the frames of its bus with their likely causes, and the last frames in
words. ``--odkit-record DIR`` saves the frames of each test as ``DIR/TEST.log``, as candump does.

``--odkit-conform LINK --odkit-eds FILE --odkit-node-id N`` adds the conformance test of a node: each case is a
test with its clause in the name. Without a file or folder on the command line these are all tests.
"""

import hashlib
import os
import re
from typing import Any

import pytest

#: Frames that a failing test shows.
SHOWN = 100

#: Characters of the name of a test in the name of a file.
LONGEST = 150

_benches: "pytest.StashKey[Any]" = pytest.StashKey()


def pytest_addoption(parser):
    group = parser.getgroup("odkit")
    group.addoption(
        "--odkit-record",
        metavar="DIR",
        help="save the frames of each test that uses odkit_bench as DIR/TEST.log",
    )
    group.addoption(
        "--odkit-conform",
        metavar="LINK",
        help="run the conformance test of the node on this bus: slcan:HOST:PORT, socketcan:can0, or "
        "bench:DEVICE for a simulated device",
    )
    group.addoption(
        "--odkit-eds",
        metavar="FILE",
        help="EDS, DCF or XDD of the node; of a simulated device its own by default",
    )
    group.addoption("--odkit-node-id", metavar="N", type=int, help="node ID, 1 to 127; 1 by default")
    group.addoption(
        "--odkit-only",
        metavar="GLOB",
        action="append",
        help="only cases or groups of this name, such as 'nmt-*'; may be repeated",
    )
    group.addoption("--odkit-allow-reset", action="store_true", help="allow resets of the node")
    group.addoption(
        "--odkit-allow-store",
        action="store_true",
        help="allow save and restore commands; the cases restore the saved values",
    )
    group.addoption(
        "--odkit-allow-motion",
        action="store_true",
        help="allow cases that move the axes of a drive, and set the outputs of an I/O module",
    )


def pytest_configure(config):
    for line in (
        "odkit_devices(*devices): the devices of odkit_bench, such as 'gxmm@1' or 'my.eds@5'",
        "odkit_eds(path, node_id=None): a device of odkit_bench that a file describes; the path is "
        "relative to the file of the test",
    ):
        config.addinivalue_line("markers", line)


def _devices(request):
    devices = []
    for marker in reversed(list(request.node.iter_markers())):
        if marker.name == "odkit_devices":
            devices += marker.args
        elif marker.name == "odkit_eds":
            devices.append(_of_file(request, *marker.args, **marker.kwargs))
    return [str(device) for device in devices] or ["gxmm@1"]


def _of_file(request, path, node_id=None):
    path = os.path.join(os.path.dirname(str(request.node.path)), str(path))
    return path if node_id is None else f"{path}@{node_id}"


def _file_name(nodeid):
    """A name that no other test has; one that is long, or that loses characters, ends with a number of its own."""
    name = re.sub(r"[^\w.]+", "-", nodeid).strip("-")
    if re.fullmatch(r"[\w./]+(::\w+)+", nodeid) and len(name) <= LONGEST:
        return name
    return f"{name[:LONGEST]}-{hashlib.sha256(nodeid.encode()).hexdigest()[:8]}"


@pytest.fixture
def odkit_bench(request):
    """An :class:`odkit.Bench` in virtual time, with the devices of the markers."""
    import odkit

    bench = odkit.Bench(_devices(request))
    request.node.stash[_benches] = bench
    yield bench
    folder = request.config.getoption("--odkit-record")
    if folder:
        os.makedirs(folder, exist_ok=True)
        bench.save_log(os.path.join(folder, f"{_file_name(request.node.nodeid)}.log"))
    bench.close()


@pytest.fixture
def odkit_time():
    """The waits of Python take no time on the clock; see :func:`odkit.patch_time`."""
    import odkit

    with odkit.patch_time() as patched:
        yield patched


@pytest.fixture
def odkit_bus(odkit_bench):
    """A bus of python-can on the wire of ``odkit_bench``. It receives the frames from now on,
    but not the boot-up messages of the devices."""
    with odkit_bench.bus() as bus:
        yield bus


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_makereport(item, call):
    report = (yield).get_result()
    bench = item.stash.get(_benches, None)
    if bench is not None and call.when == "teardown":
        del item.stash[_benches]
    if not report.failed:
        return
    lines = bench.log if bench is not None else []
    incidents = bench.diagnose() if lines else []
    if incidents:
        report.sections.append(("odkit diagnosis", "\n\n".join(map(str, incidents))))
    if lines:
        hidden = len(lines) - SHOWN
        head = [f"({hidden} earlier frames)"] if hidden > 0 else []
        report.sections.append(("odkit bus log", "\n".join(head + lines[-SHOWN:])))


def pytest_collection_modifyitems(session, config, items):
    if not config.getoption("--odkit-conform"):
        return
    from odkit import pytest_conform

    cases = list(pytest_conform.Node.from_parent(session, name="conform").collect())
    named = getattr(config, "args_source", None)
    if named is None or named.name != "ARGS":
        items.clear()
    items.extend(cases)
