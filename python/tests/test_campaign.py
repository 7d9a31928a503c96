"""Scripts of what happened, pickles, and campaigns."""

import base64
import concurrent.futures
import json
import multiprocessing
import os
import pickle
import random
import shutil
import subprocess
import zlib

import can
import pytest

import odkit

EDS = os.path.abspath(os.path.join(os.path.dirname(__file__), "../../devices/eds/GXMM.eds"))
ODKIT = os.environ.get("ODKIT_BINARY") or shutil.which("odkit")
DEVICES = "gxmm@1,eam_mt@2,gxmm@5"


def busy(bench, seed):
    """A scenario with everything that a script has a line for."""
    draw = random.Random(seed)
    with odkit.Client(bench, timeout=0.05) as client, bench.bus() as bus:
        for device in bench.devices:
            device[0x1017] = draw.choice([10, 20, 50])
        task = bus.send_periodic(can.Message(arbitration_id=0x80, is_extended_id=False), 0.01)
        for _ in range(30):
            device, kind = draw.choice(bench.devices), draw.randrange(12)
            try:
                if kind == 0:
                    device.rpm = draw.uniform(-3000, 3000)
                elif kind == 1:
                    device.fault(draw.choice(device.faults), draw.random() < 0.6)
                elif kind == 2:
                    device.power = not device.power
                elif kind == 3:
                    client.nmt(draw.choice(["start", "stop", "reset"]), draw.choice([1, 2]))
                elif kind == 4:
                    client.download(draw.choice([1, 2, 5]), 0x1017, draw.randrange(5, 50).to_bytes(2, "little"))
                elif kind == 5:
                    client.download(draw.choice([1, 2, 5]), 0x1010, b"save", 1)
                elif kind == 6:
                    device.turns = draw.uniform(0, 9)
                elif kind == 7:
                    device.ramp(draw.uniform(-300, 300), draw.random())
                elif kind == 8:
                    device.emcy(0x4200, 9, bytes(5))
                elif kind == 9:
                    device.clear_emcy()
                elif kind == 10:
                    device.node_switch = device.node_id or 1
                else:
                    client.upload(draw.choice([1, 2, 5]), 0x6004)
            except (odkit.SdoAbort, TimeoutError, ValueError):
                pass
            if draw.random() < 0.5:
                # A frame comes, and the next act is at the same moment.
                bus.recv(draw.uniform(0, 0.05))
            else:
                bench.run(draw.uniform(0, 0.2))
        task.stop()


@pytest.mark.parametrize("seed", range(12))
def test_a_script_gives_the_same_state(seed):
    with odkit.Bench(DEVICES) as bench:
        busy(bench, seed)
        with odkit.Bench(odkit.play(bench.script())) as other:
            assert other.now == bench.now
            one, two = bench.snapshot(), other.snapshot()
            for each in (bench, other):
                each.restore(one if each is bench else two)
                each.run(1)
            assert bench.log == other.log
            assert [one.eeprom for one in bench.devices] == [one.eeprom for one in other.devices]


@pytest.mark.skipif(ODKIT is None, reason="the command `odkit` is not built")
@pytest.mark.parametrize("seed", range(4))
def test_odkit_run_plays_a_script_to_the_byte(seed, tmp_path):
    with odkit.Bench(f"{DEVICES},{EDS}@9") as bench:
        busy(bench, seed)
        (tmp_path / "it.script").write_text(bench.script())
        # Time passes while Python waits for the command.
        journal = bench.journal()
        run = [ODKIT, "run", "--echo", str(tmp_path / "it.script")]
        done = subprocess.run(run, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert done.returncode == 0, done.stderr
        assert done.stdout == journal


def test_what_a_script_cannot_say():
    with odkit.Bench("gxmm@1") as bench:
        bench["gxmm"].cut_power(3)
        with pytest.raises(ValueError, match="a script has no line for `cut_power`"):
            bench.script()
        with pytest.raises(ValueError, match="no line for"):
            pickle.dumps(bench.snapshot())
    with pytest.raises(ValueError, match="cannot be read"):
        odkit.play("nonsense\n")
    with pytest.raises(AssertionError, match="line 2"):
        odkit.play("device gxmm node 1\nexpect 123# within 1ms\n")


def test_snapshots_and_descriptions_can_be_pickled():
    with odkit.Bench(["gxmm@1", f"{EDS}@7"]) as bench:
        bench.devices[1][0x1017] = 100
        bench.devices[0].rpm = 60
        bench.run(3)
        snapshot = pickle.loads(pickle.dumps(bench.snapshot()))
        other = odkit.Bench(snapshot)
        assert snapshot.now == 3 and [one.name for one in other.devices] == ["gxmm", "GXMM.eds"]
        bench.run(1)
        other.run(1)
        assert other.log == bench.log[-10:] and other["gxmm"].turns == bench["gxmm"].turns
    for source in (EDS, "gxmm"):
        described = odkit.read(source, 5)
        copy = pickle.loads(pickle.dumps(described))
        assert (copy.text, copy.path, copy.node_id) == (described.text, described.path, 5)
        assert [str(one) for one in copy.findings] == [str(one) for one in described.findings]
    restore, (form, *rest) = snapshot.__reduce__()
    with pytest.raises(ValueError, match="this snapshot was pickled by `odkit 9.9.9 form 1`.*same version"):
        restore("odkit 9.9.9 form 1", *rest)
    with odkit.Bench("gxmm@1") as bench, pytest.raises(TypeError, match=r"use `bench.snapshot\(\)`"):
        pickle.dumps(bench)


def test_a_link_has_the_script():
    with odkit.Bench("gxmm@1") as bench:
        bench["gxmm"].rpm = 6
        bench.run(2)
        packed = bench.link().removeprefix("#bench=")
        text = zlib.decompress(base64.urlsafe_b64decode(packed + "=" * (-len(packed) % 4)), -15)
        inside = json.loads(text)
        assert inside["now"] == 2_000_000
        assert inside["entries"] == [[0, {"op": "script", "text": bench.script()}]]


def shaky(bench, seed):
    """Fails when the power of one device was off last."""
    draw = random.Random(seed)
    for _ in range(12):
        device = draw.choice(bench.devices)
        if draw.random() < 0.2:
            device.power = not device.power
        else:
            device.rpm = draw.randrange(100)
        bench.run(0.1)


def all_have_power(bench):
    assert all(device.power for device in bench.devices), "without power"


def test_a_campaign_finds_seeds_and_shrinks_their_scripts():
    failures = list(odkit.campaign(shaky, range(40), "gxmm@1,eam_mt@2", check=all_have_power, chunk=7))
    assert 5 < len(failures) < 40
    for failure in failures:
        assert failure.error.startswith("AssertionError: without power") and "all_have_power" in failure.trace
        assert failure.link.startswith("#bench=") and str(failure).startswith(f"seed {failure.seed}: ")
        # The device, if not the last one its name, and the power.
        assert len(failure.shrunk.splitlines()) <= 3 and "power off" in failure.shrunk
        with pytest.raises(AssertionError):
            all_have_power(odkit.Bench(odkit.play(failure.script)))


def test_a_campaign_without_scenarios_is_refused():
    for chunk in (0, -1):
        with pytest.raises(ValueError, match=f"chunk is {chunk}; a chunk has 1 seed or more"):
            list(odkit.campaign(shaky, range(40), "gxmm@1", chunk=chunk))
    for seeds in (40, iter([1, 2])):
        with pytest.raises(TypeError, match=r"write a range or a list, such as range\(1000\)"):
            list(odkit.campaign(shaky, seeds, "gxmm@1"))


def test_a_campaign_on_processes_is_that_of_one():
    with odkit.Bench("gxmm@1,eam_mt@2") as bench:
        bench.run(1)
        start = bench.snapshot()
    arguments = {"start": start, "check": all_have_power, "chunk": 10}

    def found(**others):
        # pytest changes the texts of assertions in this process.
        failures = odkit.campaign(shaky, range(40), **arguments, **others)
        return [(one.seed, one.script, one.shrunk, one.link) for one in failures]

    own = found()
    context = multiprocessing.get_context("spawn")
    with concurrent.futures.ProcessPoolExecutor(2, context) as pool:
        assert found(map=pool.map) == own
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        futures = lambda job, chunks: [pool.submit(job, chunk) for chunk in chunks]  # noqa: E731
        assert found(map=futures) == own
