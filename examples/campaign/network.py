"""A network of twelve encoders, power cuts and faults at random, and what must hold afterwards."""

import random

import odkit

NODES = range(1, 13)
#: Two families of encoders in turn.
DEVICES = [f"{'gxmm' if node % 2 else 'eam_mt'}@{node}" for node in NODES]
HEARTBEAT, STORE = 0x1017, 0x1010


def start():
    """The state in which each scenario begins: all devices have booted and send heartbeats."""
    with odkit.Bench(DEVICES) as bench:
        for device in bench.devices:
            device[HEARTBEAT] = 500
        bench.run(1)
        return bench.snapshot()


def scenario(bench, seed):
    """Ten acts of a bad day, then power for all; raises `AssertionError` if an invariant does not hold."""
    draw = random.Random(seed)
    #: Values with which each node may start: the last confirmed one, and those whose save was cut since.
    may_have = {node: {0, 500} for node in NODES}
    with odkit.Client(bench, timeout=0.05) as client:
        for _ in range(10):
            node = draw.choice(NODES)
            device = bench.devices[node - 1]
            act = draw.randrange(5)
            if act == 0:
                device.power = not device.power
            elif act == 1:
                device.fault(draw.choice(device.faults), draw.random() < 0.6)
            elif act == 2:
                device.rpm = draw.uniform(-3000, 3000)
            elif device.power:
                value = draw.randrange(100, 1000)
                cut = draw.uniform(0, 0.03) if act == 4 else None
                if save(bench, client, node, value, cut):
                    may_have[node] = {value}
                else:
                    # The manual of the second family: after a save that was cut, a node starts with its default values.
                    may_have[node] |= {value} if node % 2 else {value, 0}
            bench.run(draw.uniform(0, 0.2))
    restart(bench)
    for node, values in may_have.items():
        value = bench.devices[node - 1][HEARTBEAT]
        assert value in values, f"node {node} starts with {value}, not with one of {sorted(values)}"


def save(bench, client, node, value, cut):
    """Writes a value and saves it; with `cut` the power fails that many seconds later. Whether the node confirmed it."""
    try:
        client.download(node, HEARTBEAT, value.to_bytes(2, "little"))
    except (odkit.NodeError, TimeoutError):
        return False
    client.send(0x600 + node, b"\x23\x10\x10\x01save")
    try:
        bench.expect(f"{0x580 + node:X}#60 10 10 01 *", within=2 if cut is None else cut)
        return True
    except AssertionError:
        return False
    finally:
        if cut is not None:
            bench.devices[node - 1].power = False


def restart(bench):
    """Switches all off and on. Each node boots once, and no frame has the CAN-ID of a node that does not exist."""
    for device in bench.devices:
        device.power = False
    bench.run(0.1)
    before = len(frames(bench))
    for device in bench.devices:
        device.power = True
    bench.run(2)
    ids = [frame.split("#") for frame in frames(bench)]
    booted = sorted(int(can_id, 16) - 0x700 for can_id, data in ids[before:] if data == "00" and can_id[0] == "7")
    assert booted == list(NODES), f"after power-on these nodes boot: {booted}"
    strange = {can_id for can_id, _ in ids if int(can_id, 16) & 0x7F not in NODES}
    assert not strange, f"frames with the CAN-IDs {sorted(strange)}"


def frames(bench):
    return [line.split()[2] for line in bench.journal().decode().splitlines()]
