"""python-canopen's own tests: all of them on the interface `odkit`, and those that need a node against a node of
odkit in place of its own."""

import subprocess
import sys
import tarfile

import canopen
import pytest

#: Its buses are those of odkit.
BUSES = '''
import can

opened = can.Bus


def bus(channel=None, interface="virtual", **arguments):
    assert interface == "virtual"
    return opened(f"{channel or 'own'}=", interface="odkit", **arguments)


can.Bus = can.interface.Bus = bus
'''

#: The nodes of its tests of an SDO server and of PDOs are simulated by odkit, from the same EDS.
NODES = r'''
import unittest

import canopen
import odkit
from test import test_local
from test.util import SAMPLE_EDS


def description():
    """The EDS of these tests without its errors: no mapping of missing objects, and a name that the device may change."""
    base = odkit.read(SAMPLE_EDS)
    change = {0x1008: "[1008]\nAccessType=ro\n"}
    for one in base.errors:
        mapping = f"[{one.index:X}sub0]\nDefaultValue=0\n"
        change[one.index] = mapping if 0x1600 <= one.index < 0x1C00 else f"[{one.index:X}]\nRemove=1\n"
    return odkit.overlay(base.text, "".join(change.values()))


class Value:
    """A value with the attributes of one in a local node of python-canopen."""

    def __init__(self, device, index, sub=0):
        self.device, self.address = device, (index, sub)

    def __getitem__(self, sub):
        return Value(self.device, self.address[0], sub)

    @property
    def raw(self):
        return self.device[self.address]

    @raw.setter
    def raw(self, value):
        self.device[self.address] = value

    @property
    def data(self):
        return self.raw.encode()


class Node:
    """A device of a bench with the parts of a local node that the tests use."""

    def __init__(self, device):
        self.device, self.sdo, self.nmt, self.pdo = device, self, self, self

    def __getitem__(self, key):
        index = key if isinstance(key, int) else self.description[key].index
        return Value(self.device, index)

    def stop_heartbeat(self):
        self.device[0x1017] = 0

    @property
    def state(self):
        return self.device.state.upper()

    def read(self):
        """A device has its PDOs."""

    save = read


class OnBench:
    @classmethod
    def setUpClass(cls):
        Node.description = described = description()
        described.save("node.eds")
        cls.bench = odkit.Bench(["node.eds@2", "node.eds@3"])
        cls.network1 = cls.network2 = canopen.Network()
        cls.network1.connect(cls.bench.name, interface="odkit", bench=cls.bench)
        cls.remote_node, cls.remote_node2 = (cls.network1.add_node(one, SAMPLE_EDS) for one in (2, 3))
        cls.local_node, cls.local_node2 = map(Node, cls.bench.devices)


def cannot(reason):
    return unittest.skip(reason)(lambda self: None)


class Sdo(OnBench, test_local.TestSDO):
    # Their own node and one of odkit differ here, or the test is about the calls of their node.
    test_block_upload_switch_to_expedite_upload = cannot("odkit supports block uploads")
    test_block_download_not_supported = cannot("odkit supports block downloads")
    test_abort = cannot("odkit has an error register, and a value of it")
    test_callbacks = cannot("it is about callbacks of their node")
    test_expedited_download_wrong_datatype = cannot("odkit aborts with 06070012h: the value is too long")
    test_expedited_upload = cannot("odkit does not set 99h as the COB-ID of an RPDO")
    test_nmt_state_initializing_to_preoper = cannot("it sets the NMT state of their node")
    test_receive_abort_request = cannot("it asks their node for the last abort")
    test_segmented_upload = cannot("a name of odkit is at most as long as its default value")
    test_two_nodes_on_the_bus = cannot("a name of odkit is at most as long as its default value")
    test_upload_zero_length = cannot("odkit answers with an empty value")


class Pdo(OnBench, test_local.TestPDO):
    pass
'''


@pytest.fixture(scope="module")
def source(tmp_path_factory):
    """The source package of python-canopen, downloaded: the wheel lacks the tests."""
    folder = tmp_path_factory.mktemp("canopen")
    fetch = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", "canopen"]
    subprocess.run([*fetch, f"canopen=={canopen.__version__}"], cwd=folder, check=True)
    (archive,) = folder.glob("*.tar.gz")
    with tarfile.open(archive) as packed:
        wanted = [one for one in packed if one.name.split("/")[1:2] == ["test"]]
        packed.extractall(folder, wanted)
    (inside,) = (one for one in folder.iterdir() if one.is_dir())
    return inside


def run(folder, *what):
    """Runs tests. Those that fail run again, at most twice: some of them wait 10 ms of real time."""
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:threadexception", *what]
    for again in ([], ["--last-failed"], ["--last-failed"]):
        done = subprocess.run([*command, *again], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode == 0:
            return done.stdout
    raise AssertionError(done.stdout)


@pytest.mark.long
def test_all_on_a_bus_of_odkit(source):
    (source / "conftest.py").write_text(BUSES)
    assert " passed" in run(source, "test")


@pytest.mark.long
def test_those_of_a_node_against_one_of_odkit(source):
    (source / "conftest.py").unlink(missing_ok=True)
    (source / "test_odkit.py").write_text(NODES)
    assert "8 passed, 11 skipped" in run(source, "test_odkit.py")
