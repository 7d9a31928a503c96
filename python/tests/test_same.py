"""Programs with several threads: each run has the same frames, at the same times."""

import asyncio
import concurrent.futures
import os
import queue
import subprocess
import sys
import threading

import can
import canopen
import pytest

import odkit

EDS = os.path.join(os.path.dirname(__file__), "../../devices/eds/GXMM.eds")
LONG = bool(os.environ.get("ODKIT_LONG"))
RUNS, LOADED = (1000, 500) if LONG else (20, 3)
UPLOAD = bytes.fromhex("4018100100000000")


def frame(can_id, data=b""):
    return can.Message(arbitration_id=can_id, is_extended_id=False, data=data)


def told(bench):
    return [line.split("  ")[0] for line in bench.log]


def a_program_of_python_canopen(dictionary=canopen.import_od(EDS)):
    network = canopen.Network()
    network.connect(interface="odkit", channel="gxmm@1")
    node = network.add_node(1, dictionary)
    log = []
    for can_id in (0x581, 0x701, 0x181):
        network.subscribe(can_id, lambda i, data, at: log.append((at, i, bytes(data))))
    node.sdo[0x1017].raw = 1000
    node.nmt.wait_for_heartbeat()
    node.nmt.state = "OPERATIONAL"
    node.nmt.wait_for_heartbeat()
    log.append(node.nmt.state)
    log.append(node.sdo[0x1018][1].raw)
    node.sdo[0x1800][5].raw = 100
    node.nmt.wait_for_heartbeat()
    log.append(network.bus.bench.now)
    seen = list(log)
    network.disconnect()
    assert seen[-1] == 3.0 and "OPERATIONAL" in seen
    return seen


def a_listener_that_answers():
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus, bench.bus() as other:

        def answer(message):
            if message.arbitration_id == 0x200:
                bus.send(frame(0x300, message.data))

        with can.Notifier(bus, [answer]):
            other.send_periodic(frame(0x200), 0.1)
            bench.run(1)
            log = told(bench)
    # The last one may be answered after the run.
    assert [one for one in log[:-1] if "300#" in one] == [f"{n / 10:f} -> 300#" for n in range(10)]
    return log[:21]


def a_reader_with_a_buffer():
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus:
        bench["gxmm"][0x1017] = 100
        reader = can.BufferedReader()
        with can.Notifier(bus, [reader]):
            for _ in range(3):
                assert reader.get_message(1).arbitration_id == 0x701
                bus.send(frame(0x601, UPLOAD))
                assert reader.get_message(1).arbitration_id == 0x581
            assert bench.now == pytest.approx(0.3)
            return told(bench)


def a_thread_of_its_own():
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus:

        def work():
            for number in range(5):
                bus.send(frame(0x123, bytes([number])))
                while bus.recv(0.2) is not None:
                    pass

        thread = threading.Thread(target=work)
        thread.start()
        bench.run(2)
        thread.join()
        assert told(bench)[-1] == "0.800000 -> 123#04"
        return told(bench)


def a_pool_of_threads():
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus:

        def work(number):
            bus.send(frame(0x123, bytes([number])))
            bus.recv(0.2)
            return bench.now

        with concurrent.futures.ThreadPoolExecutor(1) as pool:
            done = [pool.submit(work, number).result() for number in range(3)]
            bench.run(1)
            last = pool.submit(work, 9)
            bench.run(1)
            return done, last.result(), told(bench)


def two_notifiers_and_a_queue():
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus, bench.bus() as other:
        beats = queue.Queue()

        def beat(message):
            if message.arbitration_id == 0x701:
                beats.put(message)

        def answer(message):
            if message.arbitration_id == 0x100:
                other.send(frame(0x101, message.data))

        bench["gxmm"][0x1017] = 100
        with can.Notifier(bus, [beat]), can.Notifier(other, [answer]):
            for number in range(5):
                beats.get(timeout=10)
                bus.send(frame(0x100, bytes([number])))
            bench.until("101#04", timeout=0.1)
            return told(bench)


def a_timer_beside_a_notifier():
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus:
        bench["gxmm"][0x1017] = 100
        at = []
        with can.Notifier(bus, [lambda message: None]):
            for delay in (0.55, 0.3, 0.2):
                timer = threading.Timer(delay, lambda: at.append(bench.now))
                timer.start()
                timer.join()
            assert at == [0.55, 0.85, 1.05]
        return at, told(bench)[:10]


def a_control_loop():
    with odkit.Bench("gxmm@1") as bench, bench.bus() as bus:
        bench["gxmm"][0x1017] = 10
        stop, cycles = threading.Event(), []

        def control():
            while not stop.wait(0.1):
                bus.send(frame(0x80))
                cycles.append(bench.now)

        thread = threading.Thread(target=control)
        thread.start()
        bench.run(1)
        stop.set()
        thread.join()
        assert cycles == [round(n / 10, 6) for n in range(1, 11)]
        return told(bench)


def an_event_loop():
    async def main():
        bench = odkit.Bench("gxmm@1")
        bench["gxmm"][0x1017] = 100
        got = []
        with bench.bus() as bus:
            reader = can.AsyncBufferedReader()
            notifier = can.Notifier(bus, [reader], loop=asyncio.get_running_loop())

            async def ask():
                while True:
                    await asyncio.sleep(0.07)
                    bus.send(frame(0x601, UPLOAD))

            asking = asyncio.ensure_future(ask())
            while len(got) < 20:
                got.append((await reader.get_message()).timestamp)
            asking.cancel()
            await asyncio.sleep(0.5)
            notifier.stop()
        return got, told(bench)[:30]

    return asyncio.run(main())


def an_executor_of_callbacks():
    """As in ROS: a thread spins on a queue that a notifier and timers fill."""
    with odkit.Bench("gxmm@1,eam_mt@2") as bench, bench.bus() as bus:
        for device in bench.devices:
            device[0x1017] = 50
        ready, done = queue.Queue(), threading.Event()

        def spin():
            while not done.is_set():
                try:
                    ready.get(timeout=0.25)()
                except queue.Empty:
                    bus.send(frame(0x7E5))

        def timer():
            bus.send(frame(0x80))
            clock = threading.Timer(0.035, lambda: ready.put(timer))
            clock.daemon = True
            clock.start()

        def answer(message):
            if message.arbitration_id == 0x702:
                ready.put(lambda: bus.send(frame(0x601, UPLOAD)))

        with can.Notifier(bus, [answer]):
            spinner = threading.Thread(target=spin)
            spinner.start()
            ready.put(timer)
            bench.run(1)
            log = told(bench)
            done.set()
            spinner.join()
        return log


PROGRAMS = [
    a_program_of_python_canopen,
    a_listener_that_answers,
    a_reader_with_a_buffer,
    a_thread_of_its_own,
    a_pool_of_threads,
    two_notifiers_and_a_queue,
    a_timer_beside_a_notifier,
    a_control_loop,
    an_event_loop,
    an_executor_of_callbacks,
]


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.__name__)
def test_each_run_is_the_same(program):
    with odkit.patch_time():
        first = program()
        for _ in range(RUNS):
            assert program() == first


@pytest.mark.parametrize("program", PROGRAMS, ids=lambda program: program.__name__)
def test_it_is_the_same_with_the_clock(program):
    """The waits of Python take their time, and the frames are those of `patch_time`."""
    own = program()
    with odkit.patch_time():
        assert program() == own


@pytest.fixture
def burners():
    """Eight programs that compute."""
    burn = "while True: pass"
    running = [subprocess.Popen([sys.executable, "-c", burn]) for _ in range(8)]
    yield
    for one in running:
        one.kill()
        one.wait()


def test_it_is_the_same_on_a_busy_computer(burners):
    for program in PROGRAMS:
        with odkit.patch_time():
            first = program()
            for _ in range(LOADED):
                assert program() == first
