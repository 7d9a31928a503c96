"""NMT, heartbeat, PDO, EMCY with python-canopen as the master."""

import time

from bench import PATIENCE, STRINGS, BenchCase, Listener


class Nmt(BenchCase):
    def test_states(self):
        node = self.sim().node()
        node.sdo[0x1017].raw = 20
        for state in ["OPERATIONAL", "STOPPED", "PRE-OPERATIONAL"]:
            node.nmt.state = state
            # A heartbeat of the earlier state may still be in transit.
            self.eventually(lambda: node.nmt.wait_for_heartbeat(PATIENCE) == state)

    def test_boot_up(self):
        node = self.sim().node()
        for command in ["RESET", "RESET COMMUNICATION"]:
            booted = Listener(node.network, 0x701)
            node.nmt.state = command
            self.assertEqual(booted.wait(1), [b"\0"])

    def test_broadcast(self):
        sim = self.sim("gxmm", "--node-id", "9")
        node = sim.node(9)
        node.sdo[0x1017].raw = 20
        node.network.nmt.state = "OPERATIONAL"
        self.eventually(lambda: node.nmt.wait_for_heartbeat(PATIENCE) == "OPERATIONAL")

    def test_heartbeat_keeps_its_period(self):
        node = self.sim().node()
        beats = Listener(node.network, 0x701)
        start = time.monotonic()
        node.sdo[0x1017].raw = 50
        beats.wait(21)
        passed = time.monotonic() - start
        # A simulator that got no processor time catches up: some frames may be early.
        self.assertGreater(passed, 21 * 0.050 * 0.7)
        self.assertLess(passed, PATIENCE)


class Pdo(BenchCase):
    def test_cyclic_position(self):
        node = self.sim("gxmm", "--position", "1000", "--rpm", "600").node()
        node.tpdo.read()
        self.assertEqual(node.tpdo[1].cob_id, 0x181)
        self.assertEqual([v.index for v in node.tpdo[1].map], [0x6004])
        node.sdo[0x1800][5].raw = 10
        node.nmt.state = "OPERATIONAL"
        positions = []
        for _ in range(10):
            node.tpdo[1].wait_for_reception(PATIENCE)
            positions.append(node.tpdo[1]["Position value"].raw)
        self.assertEqual(positions, sorted(positions))
        self.assertGreater(positions[-1], positions[0])

    def test_sync(self):
        node = self.sim("gxmm", "--position", "77").node()
        node.sdo[0x1800][2].raw = 1
        received = Listener(node.network, 0x181)
        node.nmt.state = "OPERATIONAL"
        for _ in range(5):
            node.network.sync.transmit()
        self.assertEqual(received.wait(5), [b"\x4d\0\0\0"] * 5)

    def test_remote_frame(self):
        node = self.sim("gxmm", "--position", "77").node()
        node.sdo[0x1800][5].raw = 0
        received = Listener(node.network, 0x181)
        node.nmt.state = "OPERATIONAL"
        node.network.send_message(0x181, b"", remote=True)
        self.assertEqual(received.wait(1), [b"\x4d\0\0\0"])

    def test_reconfigured_by_the_library(self):
        node = self.sim(STRINGS).node(7, STRINGS)
        node.tpdo.read()
        pdo = node.tpdo[1]
        pdo.clear()
        pdo.add_variable(0x2010)
        pdo.add_variable(0x2013)
        pdo.trans_type = 1
        pdo.enabled = True
        pdo.save()
        node.nmt.state = "OPERATIONAL"
        node.sdo[0x2010].raw = -2
        node.sdo[0x2013].raw = 0xAB
        node.network.sync.transmit()
        self.eventually(lambda: [variable.raw for variable in pdo.map] == [-2, 0xAB])

    def test_rpdo(self):
        node = self.sim(STRINGS).node(7, STRINGS)
        node.rpdo.read()
        node.nmt.state = "OPERATIONAL"
        node.rpdo[1].map[0].raw = 1234
        node.rpdo[1].transmit()
        self.eventually(lambda: node.sdo[0x2010].raw == 1234)


class Emcy(BenchCase):
    def test_a_short_pdo(self):
        node = self.sim(STRINGS).node(7, STRINGS)
        node.nmt.state = "OPERATIONAL"
        node.network.send_message(0x207, b"\x01")
        self.eventually(lambda: len(node.emcy.log) == 1)
        self.assertEqual(node.emcy.log[0].code, 0x8210)
        self.assertEqual(node.sdo[0x1001].raw, 0x11)
        self.assertEqual(node.sdo[0x1003][1].raw & 0xFFFF, 0x8210)
