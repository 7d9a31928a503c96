"""Benches: devices and the world around them."""

import gc
import os
import resource
import signal
import subprocess
import sys
import textwrap
import threading

import pytest

import odkit

LONG = os.environ.get("ODKIT_LONG")
HERE = os.path.dirname(__file__)
EDS = os.path.join(HERE, "../../devices/eds/GXMM.eds")


@pytest.fixture
def bench():
    return odkit.Bench("gxmm@1")


@pytest.fixture
def gxmm(bench):
    return bench["gxmm"]


def test_devices_have_names_and_node_ids():
    bench = odkit.Bench(["gxmm", "gxmm", f"{EDS}@9", "eam_red@20"])
    names = [(device.name, device.node_id) for device in bench.devices]
    assert names == [
        ("gxmm", 1),
        ("gxmm-2", 2),
        ("GXMM.eds", 9),
        ("eam_red", 20),
        ("eam_red.2", 21),
    ]
    assert bench[9].name == "GXMM.eds" and bench["gxmm-2"].node_id == 2 and len(bench) == 5
    assert bench.devices[0].lss_address[:3] == bench.devices[1].lss_address[:3]
    assert bench.devices[0].lss_address != bench.devices[1].lss_address
    with pytest.raises(KeyError, match="the devices are gxmm, gxmm-2"):
        bench["nothing"]
    added = bench.add("eam_mt")
    assert (added.name, added.node_id, len(bench)) == ("eam_mt", 22, 6)


def test_an_overlay(tmp_path):
    overlay = tmp_path / "other.overlay"
    overlay.write_text("[1017]\nDefaultValue=250\n")
    bench = odkit.Bench(f"{EDS}+{overlay}@1")
    bench.run(1)
    assert bench.log[-1].startswith("1.000000 <- 701#7F")
    assert bench.devices[0][0x1017] == 250


def test_what_is_wrong_with_a_file(tmp_path):
    wrong = tmp_path / "wrong.eds"
    wrong.write_text("[2000]\nParameterName=a\nDataType=5\nAccessType=rw\nDefaultValue=300\n")
    with pytest.raises(ValueError, match=r"wrong.eds: line 5: E0412 DefaultValue `300`"):
        odkit.Bench(wrong)
    for nothing in ("", " , ", ["gxmm@1", ""]):
        with pytest.raises(ValueError, match="names no device; write for example `gxmm@1`"):
            odkit.Bench(nothing)
    with pytest.raises(ValueError, match="no built-in device or file is named `none.eds`"):
        odkit.Bench("none.eds")
    with pytest.raises(OSError):
        odkit.Bench(tmp_path)


def test_the_shaft(bench, gxmm):
    gxmm.turns = 2.5
    assert gxmm.turns == 2.5 and gxmm[0x6004] == 2.5 * gxmm[0x6001]
    gxmm.rpm = 60
    bench.run(10)
    assert gxmm.turns == pytest.approx(12.5) and gxmm.rpm == 60
    gxmm.ramp(0, 2)
    bench.run(5)
    assert gxmm.turns == pytest.approx(13.5) and gxmm.rpm == 0
    gxmm.turn(-1)
    gxmm.position = 5
    assert gxmm.position == 5


def test_until(bench, gxmm):
    gxmm.rpm = 600
    assert bench.until(lambda: gxmm.turns >= 3) == pytest.approx(0.3)
    gxmm[0x1017] = 100
    assert bench.until("701#7F", timeout=1) == pytest.approx(0.1)
    with pytest.raises(TimeoutError, match="not true after 2 s"):
        bench.until(lambda: False, timeout=2.0)
    with pytest.raises(ZeroDivisionError):
        bench.until(lambda: 1 / 0)


def test_expect_says_what_came_instead(bench):
    with bench.bus() as bus:
        import can

        request = can.Message(arbitration_id=0x601, is_extended_id=False, data=bytes.fromhex("4004600000000000"))
        bus.send(request)
        assert "Position value" in bench.expect("581#43 04 60 00 .. *", within=0.1)
        with pytest.raises(AssertionError, match="did not come within 0.1 s; no frame came"):
            bench.expect("581#43 04 60 00 *", within=0.1)
        bus.send(request)
        with pytest.raises(AssertionError) as failed:
            bench.expect("581#80 *", within=0.1)
        assert "what came instead:\n  0.100000 -> 601#4004600000000000   SDO node 1: read" in str(failed.value)
        with pytest.raises(ValueError, match="not a byte|no `#`|half a byte"):
            bench.expect("581")


def test_power_and_switches(bench, gxmm):
    gxmm.power = False
    assert gxmm.state == "off" and not gxmm.power
    gxmm.node_switch = 7
    gxmm.power = True
    bench.expect("707#00", within=5)
    assert gxmm.node_id == 7
    with pytest.raises(ValueError, match="0 to 99"):
        gxmm.node_switch = 100
    with pytest.raises(ValueError, match="0 to 7"):
        gxmm.rate_switch = 8


def test_faults_and_errors(bench, gxmm):
    fault = gxmm.faults[0]
    gxmm.fault(fault)
    assert gxmm.is_faulty(fault)
    bench.expect("081#*", within=1)
    gxmm.fault(fault, on=False)
    assert not gxmm.is_faulty(fault)
    with pytest.raises(ValueError, match="does not support the fault `thirst`"):
        gxmm.fault("thirst")
    gxmm.emcy(0x8110, register=0x11)
    bench.expect("081#10 81 *", within=1)
    gxmm.clear_emcy(0x8110)
    with pytest.raises(ValueError, match="not active"):
        gxmm.clear_emcy(0x8110)


def test_values(bench, gxmm):
    assert gxmm[0x1000] == 0x20196 and gxmm["1018h:01"] == gxmm[0x1018, 1]
    assert isinstance(gxmm[0x1008], str)
    gxmm["1017h"] = 50
    assert gxmm[0x1017] == 50
    with pytest.raises(ValueError, match="does not exist"):
        gxmm[0x5FFF]
    with pytest.raises(ValueError, match="computed by the device"):
        gxmm[0x6004] = 1


def test_the_eeprom(bench, gxmm, tmp_path):
    import can

    def save(bus):
        bus.send(can.Message(arbitration_id=0x601, is_extended_id=False, data=b"\x23\x10\x10\x01save"))

    empty = gxmm.eeprom
    gxmm[0x1017] = 500
    with bench.bus() as bus:
        save(bus)
        bench.expect("581#60 10 10 01 *", within=2)
        assert gxmm.eeprom != empty
        gxmm.save_eeprom(tmp_path / "eeprom")
        other = odkit.Bench("gxmm@1")
        other["gxmm"].power = False
        other["gxmm"].load_eeprom(tmp_path / "eeprom")
        other["gxmm"].power = True
        other.expect("701#7F", within=3)
        assert other["gxmm"][0x1017] == 500
        gxmm[0x1017] = 700
        gxmm.cut_power(3)
        save(bus)
        bench.run(2)
        assert not gxmm.power
        gxmm.power = True
        bench.run(2)
        assert gxmm[0x1017] == 500
    with pytest.raises(ValueError, match="the EEPROM has"):
        gxmm.eeprom = bytes(1_000_000)


def test_snapshots(bench, gxmm):
    gxmm[0x1017] = 100
    gxmm.rpm = 60
    bench.run(10)
    state = bench.snapshot()
    bench.run(1)
    first = bench.log[-10:]
    for _ in range(50):
        bench.restore(state)
        assert bench.now == state.now == 10 and bench.log == []
        bench.run(1)
        assert bench.log == first
    gxmm.rpm = 0
    copy = odkit.Bench(state)
    assert copy["gxmm"].rpm == 60
    copy.run(1)
    assert copy.log == first


def test_logs(bench, tmp_path):
    bench.devices[0][0x1017] = 100
    bench.run(0.2)
    assert bench.journal() == b"(0.000000) can0 701#00\n(0.100000) can0 701#7F\n(0.200000) can0 701#7F\n"
    bench.save_log(tmp_path / "it.pcapng")
    assert (tmp_path / "it.pcapng").read_bytes() == bench.journal("pcapng")
    assert bench.journal("asc").startswith(b"date")
    with pytest.raises(ValueError, match="format `txt` is not known"):
        bench.journal("txt")
    with pytest.raises(ValueError, match="is -1; it must be 0 s or more"):
        bench.run(-1)


def test_a_line_without_terminators(bench):
    def errors(seed):
        bench.restore(state)
        bench.seed(seed)
        bench.run(1)
        return bench.log

    bench.devices[0][0x1017] = 10
    bench.real_line, bench.terminators = True, 0
    assert (bench.real_line, bench.terminators, bench.bit_rate) == (True, 0, None)
    state = bench.snapshot()
    assert errors(1) == errors(1) != errors(2)


def test_everything_has_a_docstring():
    public = [getattr(odkit, name) for name in odkit.__all__]
    assert all(one.__doc__ for one in public)
    for one in public:
        if not isinstance(one, type) or issubclass(one, Exception):
            continue
        for name, member in vars(one).items():
            if not name.startswith("_"):
                assert (member.__doc__ or "").strip(), f"{one.__name__}.{name}"


def test_benches_leave_no_memory_behind():
    def make(count):
        for _ in range(count):
            bench = odkit.Bench("gxmm@1")
            bench.run(0.01)
            bench.bus().shutdown()
        gc.collect()
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss

    before = make(50)
    assert make(10_000 if LONG else 100) - before < 8_000
    assert not [name for name in odkit.wires() if name.startswith("bench-")]


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_a_shaft_turns_by_finite_numbers(gxmm, value):
    for act in (
        lambda: setattr(gxmm, "turns", value),
        lambda: setattr(gxmm, "rpm", value),
        lambda: gxmm.turn(value),
        lambda: gxmm.ramp(value, 1),
        lambda: gxmm.ramp(1, value),
    ):
        with pytest.raises(ValueError, match="must be a finite number, not"):
            act()


def test_a_seed_is_not_negative(bench):
    for seed in (-1, 2**64):
        with pytest.raises(ValueError, match=f"seed is {seed}; it must be 0 to"):
            bench.seed(seed)
    with pytest.raises(TypeError):
        bench.seed("a")


def test_everything_says_what_it_is(bench):
    with bench.bus() as bus, odkit.Client(bench) as client:
        conform = odkit.Conform(client, 1, "gxmm")
        for one in (bench, bench.snapshot(), client, conform, client.node(1), bench.devices[0], bus, bus._port):
            assert repr(one).startswith("<odkit.") and " at 0x" not in repr(one)
    assert repr(client) == "<odkit.Client closed>"


def python(program, *arguments):
    """Runs a program in a process of its own until it ends."""
    return subprocess.run([sys.executable, "-c", textwrap.dedent(program), *arguments], capture_output=True, text=True, timeout=200)


CALLS = [
    "bench.bus().recv(inf)",
    "bench.bus().recv()",
    "bench.run(inf)",
    'bench.expect("123#", within=inf)',
    "bench.until(lambda: False, inf)",
    "client.run(inf)",
    "client.heartbeat(1, inf)",
    "client.emcy(inf)",
    "client.scan(inf)",
    "time.sleep(1e6)",
    "threading.Event().wait()",
    "queue.SimpleQueue().get()",
    "held.join()",
    # The client waits for the thread that uses it.
    "busy.upload(1, 0x1018)",
    # It ends after 9 million virtual seconds with ten heartbeats in each.
    'odkit.play("device gxmm\\nsdo write 1017h = 100\\nwait 9000000s")',
    # The server says nothing; that is an error after 2 s.
    'odkit.Client(f"socketcand:127.0.0.1:{silent.getsockname()[1]}")',
    # A frame every 0.2 ms: there is always something to do.
    'real.run(inf)',
    "foreign.run(inf)",
    # Nobody reads what is sent; that is an error after 2 s.
    "full()",
]


@pytest.mark.skipif(os.name == "nt", reason="the system has no SIGINT of a single process")
def test_ctrl_c_ends_every_call():
    program = """
        import can, odkit, os, queue, signal, socket, sys, threading, time
        clock, inf, real_sleep = time.perf_counter, float("inf"), time.sleep
        silent = socket.create_server(("127.0.0.1", 0))
        loud = socket.create_server(("127.0.0.1", 0))
        def talk():
            other = loud.accept()[0]
            while True:
                # Whatever is asked, the answer is a line; frames come all the time.
                other.sendall(b"\\r" + b"t701105\\r" * 20)
                time.sleep(0.004)
        threading.Thread(target=talk, daemon=True).start()
        real = odkit.Client(f"slcan:127.0.0.1:{loud.getsockname()[1]}")
        foreign = odkit.Client(can.Bus("nobody", interface="virtual"))
        deaf = socket.create_server(("127.0.0.1", 0))
        def greet():
            other = deaf.accept()[0]
            other.sendall(b"\\r" * 4)
            threading.Event().wait()
        threading.Thread(target=greet, daemon=True).start()
        def full():
            other = odkit.Client(f"slcan:127.0.0.1:{deaf.getsockname()[1]}")
            while True:
                other.send(0x123, bytes(8))
        # A run in the background of a shell script ignores SIGINT, and its programs inherit that.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        sent = []
        def interrupt():
            real_sleep(0.1)
            sent.append(clock())
            os.kill(os.getpid(), signal.SIGINT)
        for call in sys.argv[1:]:
            bench = odkit.Bench("gxmm@1")
            client = odkit.Client(bench)
            if "held" in call:
                held = threading.Thread(target=threading.Event().wait, daemon=True)
                held.start()
            if "busy" in call:
                # The thread has the client as soon as it reads from the bus.
                reads = threading.Event()
                bus = can.Bus("busy", interface="virtual")
                recv = bus.recv
                bus.recv = lambda timeout: (reads.set(), recv(timeout))[1]
                busy = odkit.Client(bus)
                threading.Thread(target=busy.run, args=[inf], daemon=True).start()
                reads.wait()
            try:
                # Under load it may come before the call.
                threading.Thread(target=interrupt).start()
                exec(call)
            except KeyboardInterrupt:
                print(round(clock() - sent[-1], 3), call, flush=True)
        os._exit(0)
    """
    done = python(program, *CALLS)
    delays = sorted(float(line.split()[0]) for line in done.stdout.splitlines())
    # The computer may be busy.
    assert len(delays) == len(CALLS), done.stdout + done.stderr
    assert delays[len(delays) // 2] < 0.1 and delays[-1] < 2, done.stdout


@pytest.mark.skipif(os.name == "nt", reason="the system has no SIGINT of a single process")
def test_no_ctrl_c_is_lost_in_a_wait():
    """It comes at each line of `odkit/_waits.py` in turn: also where a wait has just ended."""
    program = """
        import itertools, time
        real_sleep = time.sleep
        import odkit, signal, sys, threading
        signal.signal(signal.SIGINT, signal.default_int_handler)
        bench, ended = odkit.Bench("gxmm@1"), []
        for wanted in itertools.count(1):
            seen = [0]
            def profile(frame, event, _):
                if frame.f_code.co_filename.endswith("_waits.py"):
                    seen[0] += 1
                    if seen[0] == wanted:
                        signal.raise_signal(signal.SIGINT)
            thread = threading.Thread(target=real_sleep, args=[0])
            is_ended = False
            sys.setprofile(profile)
            try:
                thread.start()
                threading.Event().wait(1e-6)
                time.sleep(1e-6)
                thread.join()
            except KeyboardInterrupt:
                is_ended = True
            sys.setprofile(None)
            if seen[0] < wanted:
                break
            ended.append(is_ended)
            while thread.is_alive():
                real_sleep(0.001)
        print(len(ended) > 20, all(ended))
    """
    done = python(program)
    assert (done.stdout, done.stderr) == ("True True\n", "")


@pytest.mark.skipif(os.name == "nt", reason="the system has no SIGINT of a single process")
def test_no_ctrl_c_is_lost_while_a_thread_starts():
    program = """
        import odkit, os, signal, threading
        signal.signal(signal.SIGINT, signal.default_int_handler)
        bench, ended = odkit.Bench("gxmm@1"), 0
        def interrupt():
            os.kill(os.getpid(), signal.SIGINT)
        for _ in range(300):
            try:
                threading.Thread(target=interrupt).start()
                bench.run(1)
            except KeyboardInterrupt:
                ended += 1
        print(ended)
    """
    done = python(program)
    assert (done.stdout, done.stderr) == ("300\n", "")


def test_a_signal_handler_in_a_call_of_a_client():
    """A second call of the same client would wait for the first one for ever."""
    with odkit.Bench("gxmm@1") as bench, odkit.Client(bench) as client:

        def handle(*_):
            assert repr(client) == "<odkit.Client in a call>"
            client.sync()

        before = signal.signal(signal.SIGALRM, handle)
        try:
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            with pytest.raises(RuntimeError, match="the client is in a call of this thread"):
                client.run(float("inf"))
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
            signal.signal(signal.SIGALRM, before)
        client.sync()


def test_an_object_whose_name_runs_python():
    """Reading the name may run any code, also such as uses the bench."""

    class Name:
        def __str__(self):
            assert bench.now == 0 and bench["gxmm"].power
            return "1017h"

    with odkit.Bench("gxmm@1") as bench:
        bench["gxmm"][Name()] = 100
        assert bench["gxmm"][Name()] == 100


def test_benches_on_threads_run_side_by_side():
    """A thread that is alone on its bench moves time without the interpreter's lock."""
    turns, seen = [0], []

    def run():
        with odkit.Bench("gxmm@1,eam_mt@2") as bench:
            for device in bench.devices:
                device[0x1017] = 1
            before = turns[0]
            bench.run(60)
            seen.append(turns[0] - before)

    thread = threading.Thread(target=run)
    thread.start()
    while not seen:
        turns[0] += 1
    thread.join()
    # Without that, a turn comes every 5 ms.
    assert seen[0] > 10_000
