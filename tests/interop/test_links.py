"""The other links of `odkit sim`: socketcand, a pseudo-terminal, SocketCAN."""

import os
import re
import socket
import subprocess
import unittest
from pathlib import Path

import canopen

from bench import EDS, PATIENCE, BenchCase, Listener, needs, receive

# A SocketCAN interface for the test of that link; few machines have one.
INTERFACE = os.environ.get("ODKIT_CAN")


class Links(BenchCase):
    def place(self, sim, pattern):
        """The line of the greeting about a link."""
        found = re.search(pattern, "\n".join(sim.errors))
        self.assertIsNotNone(found, sim.errors)
        return found.group(1)

    def master(self, **link):
        network = canopen.Network()
        network.NOTIFIER_CYCLE = 0.05
        network.connect(**link)
        self.addCleanup(network.disconnect)
        return network

    def works(self, network):
        """A master's day: reads, writes, and PDOs that come by themselves."""
        node = network.add_node(1, str(EDS))
        self.assertEqual(node.sdo[0x1008].raw, "GXMM")
        for number in range(100):
            node.sdo[0x2300][1].raw = number
            self.assertEqual(node.sdo[0x2300][1].raw, number)
        positions = Listener(network, 0x181)
        node.sdo[0x1800][5].raw = 10
        node.nmt.state = "OPERATIONAL"
        self.assertEqual(positions.wait(5), [b"\x4d\0\0\0"] * 5)

    def test_socketcand(self):
        sim = self.sim("gxmm", "--position", "77", "--link", "socketcand:127.0.0.1:0")
        port = int(self.place(sim, r"socketcand on 127\.0\.0\.1:(\d+)"))
        link = {"interface": "socketcand", "channel": "can0", "host": "127.0.0.1", "port": port}
        self.works(self.master(**link))

    def test_socketcand_beside_slcan(self):
        sim = self.sim("gxmm", "--link", "socketcand:127.0.0.1:0")
        port = int(self.place(sim, r"socketcand on 127\.0\.0\.1:(\d+)"))
        client = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
        self.addCleanup(client.close)
        self.assertEqual(receive(client, 6), b"< hi >")
        client.sendall(b"< open can0 >")
        self.assertEqual(receive(client, 6), b"< ok >")
        # In the initial mode a client receives the CAN-IDs that it subscribes to.
        client.sendall(b"< subscribe 0 0 581 >< add 0 50000 601 8 40 0 10 0 0 0 0 0 >")
        answers = Listener(sim.network(), 0x581)
        answers.wait(3)
        heard = b""
        while b"43 00 10 00 96 01 02 00" not in heard:
            more = client.recv(100)
            self.assertTrue(more and len(heard) < 10_000, heard)
            heard += more

    @needs(Path("/dev/pts/ptmx").exists(), "pseudo-terminals")
    def test_pseudo_terminal(self):
        sim = self.sim("gxmm", "--position", "77", "--link", "slcan:pty")
        path = self.place(sim, r"slcan on (/[^\s,]+)")
        link = {"interface": "slcan", "channel": path, "bitrate": 500000, "sleep_after_open": 0}
        self.works(self.master(**link))

    def socketcan(self):
        sim = self.sim("gxmm", "--position", "77", "--link", f"socketcan:{INTERFACE}")
        self.works(self.master(interface="socketcan", channel=INTERFACE))
        # can-utils receives the same frames, including those of other links.
        dump = subprocess.Popen(
            ["candump", "-L", "-n", "2", f"{INTERFACE},581:7FF,601:7FF"],
            stdout=subprocess.PIPE,
            text=True,
        )
        self.addCleanup(dump.kill)
        node = sim.node()
        # candump prints nothing when it is ready.
        while dump.poll() is None:
            self.assertEqual(node.sdo[0x1000].raw, 0x00020196)
        heard = [line.split()[2] for line in dump.stdout]
        dump.stdout.close()
        self.assertEqual(heard, ["601#4000100000000000", "581#4300100096010200"])

    if INTERFACE:
        test_socketcan = socketcan


if __name__ == "__main__":
    unittest.main()
