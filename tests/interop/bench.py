"""A live `odkit sim`, and python-canopen as its master."""

import os
import re
import signal
import socket
import subprocess
import tempfile
import threading
import time
import unittest
from pathlib import Path

import can
import canopen

# A busy machine is slow, not wrong.
PATIENCE = 30.0
canopen.sdo.SdoClient.RESPONSE_TIMEOUT = PATIENCE

ROOT = Path(__file__).resolve().parents[2]
EDS = ROOT / "devices" / "eds" / "GXMM.eds"
STRINGS = Path(__file__).with_name("strings.eds")


def odkit():
    """The binary: from the environment, else where cargo puts it."""
    path = os.environ.get("ODKIT")
    if path is None:
        target = os.environ.get("CARGO_TARGET_DIR", ROOT / "target")
        path = Path(target) / "debug" / "odkit"
    return str(path)


def needs(present, what):
    """Skips a test where `what` is missing; in CI it runs and fails instead."""
    return unittest.skipUnless(present or os.environ.get("CI") == "true", f"missing: {what}")


def receive(client, count):
    """Exactly `count` bytes from a socket, or what came before it was closed."""
    data = b""
    while len(data) < count:
        more = client.recv(count - len(data))
        if not more:
            break
        data += more
    return data


class Sim:
    """A running `odkit sim` on a port of its own, and the world around it on standard input."""

    def __init__(self, device, *args):
        command = [odkit(), "sim", str(device), "--slcan", "127.0.0.1:0", "--link", "-"]
        self.process = subprocess.Popen(
            [*command, *map(str, args)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.errors = []
        self.frames = []
        self.news = threading.Condition()
        pipes = [(self.process.stderr, self.errors), (self.process.stdout, self.frames)]
        self.watchers = [
            threading.Thread(target=self._watch, args=pipe, daemon=True) for pipe in pipes
        ]
        for watcher in self.watchers:
            watcher.start()
        with self.news:
            self.news.wait_for(lambda: self._greeting() or not self._runs(), PATIENCE)
        found = self._greeting()
        if found is None:
            self.process.kill()
            raise AssertionError(f"odkit said {self.errors}")
        self.port = int(found.group(1))
        self.networks = []
        self.sockets = []

    def _greeting(self):
        return re.search(r"slcan on 127\.0\.0\.1:(\d+)", "\n".join(self.errors))

    def _runs(self):
        return self.process.poll() is None

    def _watch(self, pipe, lines):
        for line in pipe:
            with self.news:
                lines.append(line.rstrip())
                self.news.notify_all()
        with self.news:
            self.news.notify_all()

    def world(self, line):
        """Something happens outside the bus: `power cycle 1s`, `fault battery-low on`."""
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()

    def network(self):
        """A python-canopen network on the bus."""
        bus = can.Bus(
            interface="slcan",
            channel=f"socket://127.0.0.1:{self.port}",
            bitrate=500000,
            sleep_after_open=0,
        )
        # python-can does not wait for its channel, which receives nothing until it is open.
        if bus.get_version(PATIENCE) == (None, None):
            raise AssertionError("the slcan channel did not open")
        network = canopen.Network(bus)
        network.NOTIFIER_CYCLE = 0.05  # how long `disconnect` waits for its thread
        network.connect()
        self.networks.append(network)
        return network

    def node(self, node_id=1, eds=EDS):
        """A remote node on a network of its own."""
        return self.network().add_node(node_id, str(eds))

    def raw(self):
        """A plain socket that has sent nothing yet."""
        client = socket.create_connection(("127.0.0.1", self.port), timeout=PATIENCE)
        self.sockets.append(client)
        return client

    def leave(self):
        """Every client goes."""
        for network in self.networks:
            network.disconnect()
        for client in self.sockets:
            client.close()
        self.networks, self.sockets = [], []

    def kill(self):
        """The process ends without a farewell."""
        self.leave()
        self.process.kill()
        self.process.wait(PATIENCE)

    def stop(self):
        """Ctrl-C, as a person ends it."""
        self.leave()
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
        code = self.process.wait(PATIENCE)
        for watcher in self.watchers:
            watcher.join(PATIENCE)
        for pipe in (self.process.stdin, self.process.stdout, self.process.stderr):
            pipe.close()
        return code


class BenchCase(unittest.TestCase):
    """A test that starts simulators, and ends them whatever happens."""

    def sim(self, device="gxmm", *args):
        sim = Sim(device, *args)
        self.addCleanup(sim.stop)
        return sim

    def assertAborts(self, code, act, *args):
        with self.assertRaises(canopen.SdoAbortedError) as caught:
            act(*args)
        self.assertEqual(f"{caught.exception.code:08X}", f"{code:08X}")

    def eventually(self, holds, seconds=PATIENCE):
        end = time.monotonic() + seconds
        while not holds():
            self.assertLess(time.monotonic(), end, "it did not come about in time")
            time.sleep(0.01)


# Removed when Python ends.
EDS_FOLDER = tempfile.TemporaryDirectory(prefix="odkit-eds-")


def exported(device):
    """The EDS that `odkit export` writes for a device, once for all tests."""
    path = Path(EDS_FOLDER.name) / f"{device}.eds"
    if not path.exists():
        subprocess.run([odkit(), "export", device, "-o", path], check=True)
    return path


class Listener:
    """Collects what a python-canopen network hears."""

    def __init__(self, network, cob_id):
        self.frames = []
        self.fresh = threading.Condition()
        network.subscribe(cob_id, self._hear)

    def _hear(self, cob_id, data, timestamp):
        with self.fresh:
            self.frames.append(bytes(data))
            self.fresh.notify_all()

    def wait(self, count, seconds=PATIENCE):
        """The first `count` frames."""
        with self.fresh:
            if not self.fresh.wait_for(lambda: len(self.frames) >= count, seconds):
                raise AssertionError(f"{len(self.frames)} of {count} frames came")
            return self.frames[:count]
