"""`odkit.Client`: the other end of a bus."""

import math
import os
import pathlib
import signal
import sys
import threading

import can
import pytest

import odkit

EDS = pathlib.Path(__file__).resolve().parents[2] / "devices/eds/GXMM.eds"


@pytest.fixture
def bench():
    return odkit.Bench("gxmm@1")


@pytest.fixture
def client(bench):
    with odkit.Client(bench) as client:
        yield client


def test_objects_are_read_and_written(bench, client):
    assert client.upload(1, 0x1018, 1) == (0xEC).to_bytes(4, "little")
    assert client.upload(1, "1018h:01") == client.upload(1, (0x1018, 1))
    client.download(1, 0x1017, b"\x64\x00")
    assert bench["gxmm"][0x1017] == 100
    with pytest.raises(ValueError, match="the type of 1017h:00 is not known"):
        client.download(1, 0x1017, 100)
    with pytest.raises(ValueError, match="the node has no description"):
        client.upload(1, "Position value")
    node = client.node(1, EDS)
    bench["gxmm"].turns = 2
    assert node["Position value"] == 2 * node[0x6001]
    assert client.upload(1, 0x1008) == "GXMM" and node[0x1018, 1] == 0xEC
    node[0x1017] = 250
    client.download(1, "Producer heartbeat time", 251)
    assert node[0x1017] == bench["gxmm"][0x1017] == 251


def test_ctrl_c_ends_a_wait_of_any_length(bench, client):
    def interrupt(*_):
        raise KeyboardInterrupt

    bench["gxmm"][0x1017] = 10
    before = signal.signal(signal.SIGALRM, interrupt)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.1)
        with pytest.raises(KeyboardInterrupt):
            client.run(50_000)
    finally:
        signal.signal(signal.SIGALRM, before)
    assert bench.now < 50_000
    assert client.upload(1, 0x1018, 1) == (0xEC).to_bytes(4, "little")


@pytest.mark.parametrize("length", [5, 40, 500])
def test_long_values_go_by_segments_and_blocks(length, tmp_path):
    value = "ab" * (length // 2)
    section = "[{}]\nParameterName=Long {}\nDataType={}\nAccessType={}\nDefaultValue={}\n"
    overlay = section.format("5000", "text", 9, "ro", value) + section.format("5001", "bytes", "0xA", "rw", "00" * length)
    path = tmp_path / "long.eds"
    odkit.overlay(EDS, overlay).save(path)
    bench = odkit.Bench(f"{path}@1")
    with odkit.Client(bench) as client:
        node = client.node(1, path)
        assert node["Long text"] == value
        node["Long bytes"] = bytes(range(length % 256)) + bytes(length - length % 256)
        assert node["Long bytes"] == bench.devices[0]["Long bytes"] == bytes(range(length % 256)) + bytes(length - length % 256)
        initiates = "6" if length < 64 else "C"
        assert any(f"601#{initiates}" in line for line in bench.log)


def test_aborts_and_silence_are_exceptions(bench, client):
    with pytest.raises(odkit.SdoAbort, match="node 1: 7777h:00: abort 06020000h: .*does not exist") as info:
        client.upload(1, 0x7777)
    assert info.value.code == 0x06020000 and isinstance(info.value, odkit.NodeError)
    with pytest.raises(odkit.SdoAbort, match="06010002h"):
        client.download(1, 0x1000, b"\0\0\0\0")
    began = bench.now
    with pytest.raises(TimeoutError, match="node 9 does not respond to SDO requests within 1 s"):
        client.upload(9, 0x1000)
    assert bench.now == began + 1
    with pytest.raises(ValueError, match="200 is not a node ID"):
        client.upload(200, 0x1000)
    with pytest.raises(ValueError, match="`can0` is not a valid link"):
        odkit.Client("can0")
    with pytest.raises(OSError):
        odkit.Client("slcan:127.0.0.1:1")
    client.close()
    client.close()
    with pytest.raises(OSError, match="the client is closed"):
        client.upload(1, 0x1000)


def test_nmt_and_heartbeat(bench, client):
    node = client.node(1, EDS)
    node[0x1017] = 100
    assert client.heartbeat(1) == "Pre-operational" and bench.now == pytest.approx(0.1)
    assert node.nmt("start", timeout=0.5) == "Operational" == bench["gxmm"].state == node.state
    client.watch(1, 0.3)
    client.run(1)
    assert client.lost == []
    bench["gxmm"].power = False
    client.run(1)
    assert client.lost == [1]
    with pytest.raises(TimeoutError, match="node 1: no heartbeat within 2 s"):
        client.heartbeat(1, 2)
    bench["gxmm"].power = True
    assert client.heartbeat(1) == "Initialising" and client.lost == []
    assert client.nmt("reset", timeout=1) == "Initialising"
    with pytest.raises(ValueError, match="`go` is not known; write start, stop"):
        client.nmt("go")


def test_emcy(bench, client):
    bench["gxmm"].emcy(0x8130, 0x11, b"hello")
    emcy = client.emcy()
    assert (emcy.node_id, emcy.code, emcy.register, emcy.info) == (1, 0x8130, 0x11, b"hello")
    with pytest.raises(TimeoutError, match="no EMCY message within 0.5 s"):
        client.emcy(0.5)


def test_pdos_are_decoded(bench, client):
    node = client.node(1, EDS)
    node[0x1800, 2] = 254
    node[0x1800, 5] = 10
    bench["gxmm"].turns = 3
    node.nmt("start")
    pdo = node.pdo()
    assert (pdo.node_id, pdo.number, pdo.can_id) == (1, 1, 0x181)
    assert pdo["Position value"] == pdo[0x6004] == pdo[0x6004, 0] == bench["gxmm"][0x6004]
    with pytest.raises(KeyError, match="the PDO has"):
        pdo["Speed"]
    assert node.read_mapping() == [1, 2]
    assert node.pdo()[0x6004] == pdo[0x6004]
    node[0x1800, 5] = 0
    node[0x1800, 2] = 1
    with pytest.raises(TimeoutError, match="no PDO within 0.5 s"):
        while True:
            client.pdo(0.5)
    bench["gxmm"].turns = 4
    client.sync()
    assert client.pdo(0.5)[0x6004] == bench["gxmm"][0x6004] > pdo[0x6004]


def test_scan(bench, client):
    bench.add("eam_mt@5")
    found = client.scan()
    assert [(one.node_id, one.name, one.identity[0]) for one in found] == [(1, "GXMM", 0xEC), (5, "EAMxxx MT", 0x5F)]
    assert found[0].answers and "node 1: GXMM" in repr(found[0])


def test_lss():
    bench = odkit.Bench("gxmm@1")
    with odkit.Client(bench) as client:
        address = bench["gxmm"].lss_address
        assert client.lss_scan() == []
        client.nmt("stop")
        assert client.lss_set_node_id(address, 7, store=True) is False
        bench["gxmm"].power = False
        bench["gxmm"].power = True
        assert bench["gxmm"].node_id == 7
        with pytest.raises(odkit.NodeError, match="no LSS slave has the LSS address"):
            client.lss_set_node_id((1, 2, 3, 4), 7)
        with pytest.raises(ValueError, match="CiA 301 does not define 333 kbit/s"):
            client.lss_set_bit_rate(333)


def test_over_a_bus_of_python_can(bench):
    with bench.bus() as bus, odkit.Client(bus) as client:
        assert client.node(1, EDS)[0x1008] == "GXMM"
    other = can.Bus(interface="virtual", channel="odkit-client")
    node = can.Bus(interface="virtual", channel="odkit-client")

    def answer():
        request = node.recv(5)
        data = b"\x4f" + bytes(request.data[1:4]) + b"\x2a\0\0\0"
        node.send(can.Message(arbitration_id=0x583, data=data, is_extended_id=False))

    thread = threading.Thread(target=answer)
    with other, node, odkit.Client(other) as client:
        thread.start()
        assert client.upload(3, 0x2000) == b"\x2a"
        thread.join()


def test_threads_share_a_client(bench, client):
    failed = []

    def work(index):
        for _ in range(50):
            if client.upload(1, index) != client.upload(1, index):
                failed.append(index)

    threads = [threading.Thread(target=work, args=(index,)) for index in (0x1000, 0x1008, 0x6001)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == []


def test_conform(client):
    test = odkit.Conform(client, 1, EDS, allow_reset=True, allow_store=True)
    record = test.run("sdo-upload-expedited")
    assert record.verdict == "pass" and record.reason == "" and record.clause.startswith("CiA 301")
    assert any("581#" in line for line in record.frames)
    with pytest.raises(ValueError, match="case `nothing` does not exist"):
        test.run("nothing")
    assert len(odkit.conform_cases()) > 150
    assert {group for _, group, _, _ in odkit.conform_cases(["nmt-*"])} == {"NMT"}
    with pytest.raises(ValueError, match="no case has this name: none"):
        odkit.conform_cases(["none"])


def test_a_case_that_fails(bench):
    wrong = EDS.read_text().replace("DefaultValue=0x20196", "DefaultValue=0x10196", 1)
    with odkit.Client(bench) as client:
        record = odkit.Conform(client, 1, wrong).run("eds-device-type")
        assert record.verdict == "fail" and "expected" in record.reason and "fail" in repr(record)
        reset = odkit.Conform(client, 1, wrong).run("nmt-reset-application")
        assert (reset.verdict, reset.reason) == ("skipped", "the case needs --allow-reset")


sys.path.insert(0, str(EDS.parents[2] / "tests/interop"))
canopen = pytest.importorskip("canopen")
# It sets a time-out for all of python-canopen, and other tests here are about the usual one.
usual = canopen.sdo.SdoClient.RESPONSE_TIMEOUT
interop = pytest.importorskip("bench")
canopen.sdo.SdoClient.RESPONSE_TIMEOUT = usual


@pytest.mark.skipif(not os.path.exists(interop.odkit()), reason="`odkit` is not built")
def test_over_slcan():
    """A node of `odkit sim` over TCP, in real time."""
    sim = interop.Sim("gxmm")
    try:
        with odkit.Client(f"slcan:127.0.0.1:{sim.port}", timeout=30) as client:
            node = client.node(1, EDS)
            assert node[0x1008] == "GXMM"
            node[0x1017] = 20
            assert client.heartbeat(1, 30) == "Pre-operational"
            assert node.nmt("start", timeout=30) == "Operational"
            case = odkit.Conform(client, 1, EDS).run("sdo-upload-expedited")
            assert case.verdict == "pass"
    finally:
        sim.stop()


def test_a_client_of_asyncio():
    import asyncio

    async def main():
        bench = odkit.Bench("gxmm@1,eam_mt@2")
        async with odkit.AsyncClient(bench) as client:
            await client.describe(1, "gxmm")
            await client.download(1, 0x1017, 100)
            names, state = await asyncio.gather(
                asyncio.gather(client.upload(1, 0x1008), client.upload(2, 0x1008)), client.heartbeat(1)
            )
            with pytest.raises(TimeoutError):
                await client.emcy(0.1)
            with pytest.raises(odkit.SdoAbort):
                await client.upload(2, 0x5FFF)
            assert await client.lost() == []
        with pytest.raises(AttributeError):
            client.nothing
        return names, state

    names, state = asyncio.run(main())
    assert names[0] == "GXMM" and state == "Pre-operational"


@pytest.mark.parametrize("link", ["bench", "bus"])
def test_a_cancelled_call_of_asyncio_ends(link):
    """A wait without end would keep the thread, the next calls and the program."""
    import asyncio

    async def main():
        bench = odkit.Bench("gxmm@1")
        with can.Bus(interface="virtual", channel="no node") as bus:
            client = odkit.AsyncClient(bench if link == "bench" else bus, timeout=0.05)
            for wait in (client.run, client.emcy):
                with pytest.raises(asyncio.TimeoutError):
                    await asyncio.wait_for(wait(math.inf), 0.05)
            # A call that waits for its turn does not begin.
            endless, next_one = asyncio.ensure_future(client.run(math.inf)), asyncio.ensure_future(client.run(math.inf))
            await asyncio.sleep(0.05)
            next_one.cancel()
            endless.cancel()
            await asyncio.gather(endless, next_one, return_exceptions=True)
            await client.run(0.01)
            if link == "bench":
                assert await client.upload(1, 0x1008) == b"GXMM"
            await client.close()

    asyncio.run(main())
