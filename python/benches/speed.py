"""How fast the package is: SDO uploads, an hour of a bus, an hour of heartbeats.

    python python/benches/speed.py [ODKIT]

`pip install ./python[canopen] pyserial` before: a debug build says nothing. ODKIT is the program `odkit`, for SDO
uploads over slcan TCP by python-canopen beside those in this process.
"""

import re
import subprocess
import sys
import time

import can
import canopen

import odkit

#: What each figure has to be at least or at most.
WANTED = {
    "SDO uploads by python-canopen, in process": "5 x slcan",
    "SDO uploads by odkit.Client": "300,000/s",
    "an hour of four encoders, TPDOs every 10 ms": "2 s",
    "an hour of heartbeats every 1 s": "0.1 s",
}


def best(act, rounds=5):
    """Seconds of the best round."""
    times = []
    for _ in range(rounds):
        began = time.perf_counter()
        act()
        times.append(time.perf_counter() - began)
    return min(times)


def by_canopen(network, count):
    """Uploads a second."""
    sdo = network.add_node(1, odkit.to_canopen("gxmm", 1)).sdo

    def some():
        for _ in range(count):
            sdo.upload(0x6004, 0)

    return count / best(some)


def over_slcan(program, count=2000):
    """Uploads a second of python-canopen over slcan TCP."""
    command = [program, "sim", "gxmm", "--slcan", "127.0.0.1:0", "--link", "-"]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.DEVNULL, "stderr": subprocess.PIPE}
    with subprocess.Popen(command, text=True, **pipes) as sim:
        for line in sim.stderr:
            port = re.search(r"slcan on 127\.0\.0\.1:(\d+)", line)
            if port:
                break
        network = canopen.Network()
        channel = f"socket://127.0.0.1:{port[1]}"
        try:
            network.connect(interface="slcan", channel=channel, bitrate=500000, sleep_after_open=0)
            speed = by_canopen(network, count)
            network.disconnect()
        finally:
            sim.kill()
    return speed


def in_process(count=10_000):
    """Uploads a second of python-canopen on a bench."""
    with odkit.Bench("gxmm@1") as bench:
        network = canopen.Network()
        network.connect(interface="odkit", channel=bench.name)
        speed = by_canopen(network, count)
        network.disconnect()
    return speed


def by_client(count=100_000):
    """Uploads a second of single calls of `odkit.Client`."""
    with odkit.Client(odkit.Bench("gxmm@1")) as client:
        upload = client.upload

        def some():
            for _ in range(count):
                upload(1, 0x6004)

        return count / best(some)


def an_hour(cycle):
    """Seconds for an hour of a bus with four encoders: 1.44 million TPDOs at 10 ms."""
    bench = odkit.Bench("gxmm@1,gxmm@2,gxmm@3,gxmm@4")
    with bench.bus() as bus:
        bus.set_filters([{"can_id": 0x7FF, "can_mask": 0x7FF}])
        for device in bench.devices:
            device[0x1800, 2] = 254
            device[0x1800, 5] = cycle
            device.rpm = 60
        bus.send(can.Message(arbitration_id=0, data=[1, 0], is_extended_id=False))
        return best(lambda: bench.run(3600), 1)


def heartbeats():
    """Seconds for an hour of heartbeats, each received through python-can."""
    bench = odkit.Bench("gxmm@1")
    with bench.bus() as bus:
        bench["gxmm"][0x1017] = 1000
        bus.recv(0)

        def hour():
            end = bench.now + 3600
            while bench.now < end:
                assert bus.recv(2).arbitration_id == 0x701

        return best(hour, 3)


def main():
    rows = []
    slcan = over_slcan(sys.argv[1]) if len(sys.argv) > 1 else None
    if slcan:
        rows.append(("SDO uploads by python-canopen, slcan over TCP", f"{slcan:,.0f}/s"))
    own = in_process()
    ratio = f" ({own / slcan:.1f} x slcan)" if slcan else ""
    rows.append(("SDO uploads by python-canopen, in process", f"{own:,.0f}/s{ratio}"))
    rows.append(("SDO uploads by odkit.Client", f"{by_client():,.0f}/s"))
    rows.append(("an hour of four encoders, TPDOs every 10 ms", f"{an_hour(10):.2f} s"))
    rows.append(("an hour of heartbeats every 1 s", f"{heartbeats():.3f} s"))
    for name, figure in rows:
        print(f"{name:48} {figure:28} {WANTED.get(name, '')}")


if __name__ == "__main__":
    main()
