"""Several threads on one wire: time moves while all of them wait."""

import gc
import hashlib
import os
import queue
import socket
import subprocess
import sys
import threading
import time
import warnings
from time import monotonic

import can
import canopen
import pytest

import odkit
from odkit import _odkit, _waits

EDS = os.path.join(os.path.dirname(__file__), "../../devices/eds/GXMM.eds")


@pytest.fixture(scope="module")
def dictionary():
    return canopen.import_od(EDS)


@pytest.fixture
def connected(dictionary):
    """A network and its node. The wire is closed even if the test fails, because the next test has a wire of this name."""
    network = canopen.Network()
    network.connect(interface="odkit", channel="gxmm@1")
    yield network, network.add_node(1, dictionary)
    network.disconnect()


def test_an_hour_of_heartbeats_while_the_program_waits(connected):
    network, node = connected
    node.sdo[0x1017].raw = 1000
    beats, done = [], threading.Event()

    def beat(can_id, data, at):
        beats.append(at)
        if at >= 3600:
            done.set()

    network.subscribe(0x701, beat)
    with odkit.patch_time():
        assert done.wait(5000)
    assert beats == [float(second) for second in range(1, 3601)]
    network.bus.bench.run(60)
    assert len(beats) == 3660


def test_no_time_passes_while_the_program_computes(connected):
    network, node = connected
    node.sdo[0x1017].raw = 10
    before, end = network.bus.bench.now, time.perf_counter() + 0.2
    while time.perf_counter() < end:
        pass
    assert network.bus.bench.now - before <= 0.2


def test_time_follows_the_clock_while_the_program_sleeps(connected):
    network, node = connected
    # The time depends on the last call only, not on how long the program waits after it.
    clock = time.perf_counter()
    node.sdo[0x1017].raw = 10
    before = network.bus.bench.now
    beats = []
    network.subscribe(0x701, lambda i, data, at: beats.append(at))
    while len(beats) < 10:
        time.sleep(0.005)
        assert time.perf_counter() - clock < 60
    assert network.bus.bench.now - before <= time.perf_counter() - clock + 0.01


def test_a_silent_node_takes_the_time_of_the_time_out(connected):
    network, node = connected
    network.bus.bench["gxmm"].power = False
    with pytest.raises(canopen.SdoCommunicationError):
        node.sdo.upload(0x1000, 0)
    assert network.bus.bench.now == pytest.approx(0.3, abs=1e-9)


def test_a_wait_lets_no_more_time_pass_than_its_time_out():
    bus = can.Bus(interface="odkit", channel="gxmm@1")
    reader = can.Notifier(bus, [lambda message: None])
    with pytest.raises(queue.Empty):
        queue.Queue().get(timeout=0.4)
    assert bus.bench.now == pytest.approx(0.4, abs=1e-9)
    assert not threading.Event().wait(0.4)
    assert bus.bench.now == pytest.approx(0.8, abs=1e-9)
    reader.stop()
    bus.shutdown()


def test_a_listener_that_answers_is_part_of_the_run():
    """Time does not pass while a listener works, so its answer has the time of the question."""
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus, bench.bus() as other:
        answers = []

        def answer(message):
            if message.arbitration_id == 0x200:
                bus.send(can.Message(arbitration_id=0x300, is_extended_id=False, data=message.data))

        reader = can.Notifier(bus, [answer])
        other.send_periodic(can.Message(arbitration_id=0x200, is_extended_id=False), 0.1)
        bench.run(1)
        while (message := other.recv(0)) is not None:
            if message.arbitration_id == 0x300:
                answers.append(round(message.timestamp, 6))
        assert answers[:10] == [round(n / 10, 6) for n in range(10)]
        reader.stop()


def test_two_threads_send_while_a_third_closes():
    bus = can.Bus(interface="odkit", channel="gxmm@1")
    errors, sent = [], threading.Semaphore(0)

    def send():
        message = can.Message(arbitration_id=0x123, is_extended_id=False)
        try:
            while True:
                bus.send(message)
                sent.release()
        except can.CanOperationError as error:
            errors.append(str(error))

    def receive():
        try:
            while True:
                bus.recv(None)
        except can.CanOperationError as error:
            errors.append(str(error))

    threads = [threading.Thread(target=one) for one in (send, send, receive)]
    for one in threads:
        one.start()
    for _ in range(50):
        assert sent.acquire(timeout=60)
    bus.shutdown()
    for one in threads:
        one.join(60)
    assert len(errors) == 3 and all("closed" in one for one in errors)


def test_an_exception_in_a_listener_leaves_the_wire_usable():
    class Failing(can.Listener):
        seen = []

        def on_message_received(self, message):
            raise RuntimeError("no")

        def on_error(self, error):
            self.seen.append(error)

    bus = can.Bus(interface="odkit", channel="gxmm@1")
    failing = Failing()
    reader = can.Notifier(bus, [failing])
    bus.bench.run(1)
    assert [str(one) for one in failing.seen] == ["no"]
    reader.stop()
    bus.bench.run(1)
    bus.shutdown()


@pytest.mark.skipif(not hasattr(os, "fork"), reason="the system has no fork")
def test_a_fork_has_a_bus_of_its_own():
    bus = can.Bus(interface="odkit", channel="gxmm@1")
    reader = can.Notifier(bus, [lambda message: None])
    child = os.fork()
    if child == 0:
        # The reader is not in this process, and the time of the bus is its own.
        bus.bench.run(5)
        os._exit(0 if bus.bench.now == 5 else 1)
    assert os.waitpid(child, 0)[1] == 0
    assert bus.bench.now < 5
    reader.stop()
    bus.shutdown()


def test_asyncio():
    import asyncio

    async def main():
        bus = can.Bus(interface="odkit", channel="gxmm@1")
        bus.send(can.Message(arbitration_id=0x601, is_extended_id=False, data=bytes.fromhex("2B171000E8030000")))
        reader = can.AsyncBufferedReader()
        notifier = can.Notifier(bus, [reader], loop=asyncio.get_running_loop())
        times = [(await reader.get_message()).timestamp for _ in range(12)]
        notifier.stop()
        bus.shutdown()
        return times

    assert asyncio.run(main()) == [0.0, 0.0] + [float(second) for second in range(1, 11)]


def notified(bench):
    """A bus with a heartbeat every 100 ms and a notifier, and the messages that it received."""
    bench["gxmm"][0x1017] = 100
    bus, got = bench.bus(), []
    return bus, can.Notifier(bus, [got.append]), got


def test_a_wait_that_odkit_does_not_see_lets_time_follow_the_clock():
    with odkit.Bench("gxmm@1") as bench:
        own, other = socket.socketpair()
        own.settimeout(60)
        bus, reader, got = notified(bench)
        reader.add_listener(lambda message: other.send(b"x") if message.timestamp >= 0.5 else None)
        with pytest.warns(RuntimeWarning, match=r"MainThread waits for something .* at .*test_threads.py"):
            assert own.recv(1) == b"x"
            reader.stop()
        assert bench.now >= 0.5 and len(got) >= 5
        for one in (bus.shutdown, own.close, other.close):
            one()


def test_a_lock_that_a_waiting_thread_holds_does_not_stop_time_for_ever():
    lock = threading.Lock()

    def hold():
        with lock:
            time.sleep(0.5)

    with odkit.Bench("gxmm@1") as bench, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        threading.Thread(target=hold).start()
        began = time.perf_counter()
        with lock:
            assert bench.now == 0.5
        assert time.perf_counter() - began < 60


def test_strict_time_does_not_follow_the_clock():
    with odkit.Bench("gxmm@1", time="strict") as bench, bench.bus() as bus:
        with pytest.raises(RuntimeError, match="patch_time"):
            time.sleep(0.5)
        with odkit.patch_time():
            time.sleep(0.5)
        assert bench.now == 0.5
        bench.run(0.5)
        assert bus.recv(1) is None and bench.now == 2
    with pytest.raises(ValueError, match="pace is -1; it must be 0 or more"):
        odkit.Bench("gxmm@1", pace=-1)


def test_the_pace_of_the_clock():
    # Benches of other tests have another pace.
    gc.collect()
    with odkit.Bench("gxmm@1", pace=100) as bench:
        began = time.perf_counter()
        time.sleep(20)
        assert bench.now == 20 and 0.15 <= time.perf_counter() - began < 15


@odkit.patch_time()
def test_clocks_show_the_time_of_the_bench():
    with odkit.Bench("gxmm@1") as bench:
        clock, imported, wall = time.perf_counter(), monotonic(), time.time_ns()
        bench.run(1000)
        for passed in (time.perf_counter() - clock, monotonic() - imported, (time.time_ns() - wall) / 1e9):
            assert passed == pytest.approx(1000, abs=1e-3)
        deadline = time.monotonic() + 0.2
        while time.monotonic() < deadline:
            pass
        assert bench.now == pytest.approx(1000.2, abs=0.01)
    assert monotonic is not time.monotonic or monotonic() >= imported


def test_asyncio_at_full_speed(odkit_bench, odkit_time):
    import asyncio

    async def main():
        with odkit_bench.bus() as bus:
            got = []
            notifier = can.Notifier(bus, [got.append], loop=asyncio.get_running_loop())
            await asyncio.sleep(10)
            with pytest.raises(asyncio.TimeoutError):
                await asyncio.wait_for(asyncio.Event().wait(), 5)
            notifier.stop()
            return [one.timestamp for one in got]

    odkit_bench["gxmm"][0x1017] = 1000
    clock = odkit_time.real()
    assert asyncio.run(main())[:15] == [float(second) for second in range(1, 16)]
    assert odkit_time.real() - clock < 10


def test_a_thread_computes_beside_others():
    """No time passes, with the interpreter's lock and without it."""
    for burn in (lambda: sum(range(1000)), lambda: hashlib.pbkdf2_hmac("sha1", b"a", b"b", 2000)):
        with odkit.Bench("gxmm@1") as bench:
            bus, reader, _ = notified(bench)
            end = time.perf_counter() + 1.3
            while time.perf_counter() < end:
                burn()
            assert bench.now == 0
            reader.stop()
            bus.shutdown()


@pytest.mark.long
def test_a_loop_without_a_wait_is_named():
    with odkit.Bench("gxmm@1") as bench:
        bus, reader, got = notified(bench)
        end = time.perf_counter() + 60
        with pytest.warns(RuntimeWarning, match=r"MainThread has computed .* at .*test_threads.py"):
            # Nothing lets time pass until the heartbeat, so only the warning ends this loop.
            with warnings.catch_warnings(record=True) as seen:
                warnings.simplefilter("always")
                while not got and not seen and time.perf_counter() < end:
                    pass
            warnings.warn(seen[0].message)
        assert bench.now == 0
        reader.stop()
        bus.shutdown()


def test_a_program_ends_while_threads_wait():
    program = """
import can, odkit, threading
bench = odkit.Bench("gxmm@1")
can.Notifier(bench.bus(), [print])
for wait in (threading.Event().wait, lambda: bench.run(1e12), lambda: threading.Event().wait(1e6)):
    threading.Thread(target=wait, daemon=True).start()
"""
    done = subprocess.run([sys.executable, "-c", program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, timeout=100)
    assert done.returncode == 0, done.stderr


def test_a_clock_goes_on_from_the_time_of_the_last_bench(monkeypatch):
    """It does not start at the time of the computer: an event loop would then wait for hours."""
    moment, real = None, 0
    monkeypatch.setattr(_odkit, "moment", lambda: moment)
    clock = _waits.Clock(lambda: real)
    moment = (1, 0)
    assert clock() == 0
    moment = (1, 60_000_000)
    assert clock() == 60 * 10**9
    moment, real = None, 2_000_000
    assert clock() == 60 * 10**9
    real = 3_000_000
    assert clock() == 60 * 10**9 + 1_000_000
