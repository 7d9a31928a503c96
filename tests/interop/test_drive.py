"""The drive and the I/O module under python-canopen: `BaseNode402` through its modes, PDOs of both."""

import threading
import time

from canopen.profiles.p402 import BaseNode402

from bench import PATIENCE, BenchCase, exported

# A busy machine is slow, not wrong.
for limit in ("CHECK_TPDO", "RESET_FAULT", "SWITCH_OP_MODE", "SWITCH_STATE_FINAL", "SWITCH_STATE_SINGLE"):
    setattr(BaseNode402, f"TIMEOUT_{limit}", PATIENCE)


class Drive(BenchCase):
    def setUp(self):
        self.bench = self.sim("drive@3")
        node = BaseNode402(3, str(exported("drive")))
        self.bench.network().add_node(node)
        node.nmt.state = "PRE-OPERATIONAL"
        # python-canopen takes a TPDO that came twice as periodic, and waits for the next one.
        node.sdo[0x1800][5].raw = 20
        node.setup_402_state_machine()
        node.nmt.state = "OPERATIONAL"
        self.node = node

    def at(self, index):
        return self.node.sdo[index].raw

    def test_every_state_that_can_be_commanded(self):
        node = self.node
        # Quick stop leads on to Switch on disabled, unless 605Ah holds it.
        node.sdo[0x605A].raw = 6
        self.eventually(lambda: node.state == "SWITCH ON DISABLED")
        for state in [
            "READY TO SWITCH ON",
            "SWITCHED ON",
            "OPERATION ENABLED",
            "QUICK STOP ACTIVE",
            "OPERATION ENABLED",
            "SWITCHED ON",
            "READY TO SWITCH ON",
            "SWITCH ON DISABLED",
            "OPERATION ENABLED",
        ]:
            node.state = state
            self.assertEqual(node.state, state)

    def test_every_mode_that_6502h_lists(self):
        for mode in [
            "PROFILED POSITION",
            "PROFILED VELOCITY",
            "HOMING",
            "INTERPOLATED POSITION",
            "CYCLIC SYNCHRONOUS POSITION",
            "CYCLIC SYNCHRONOUS VELOCITY",
            "NO MODE",
        ]:
            self.node.op_mode = mode
            self.assertEqual(self.node.op_mode, mode)
        for mode in ["VELOCITY", "PROFILED TORQUE"]:
            with self.assertRaises(TypeError):
                self.node.op_mode = mode

    def test_homing_where_it_stands_and_at_a_limit_switch(self):
        node = self.node
        node.sdo[0x6098].raw = 35
        node.sdo[0x607C].raw = -500
        self.assertTrue(node.homing(PATIENCE))
        self.assertEqual(self.at(0x6064), 500)
        self.assertTrue(node.is_homed())
        node.state = "SWITCHED ON"
        node.sdo[0x6098].raw = 17

        def press():
            self.eventually(lambda: self.at(0x606C) < -1000)
            self.bench.world("pin limit1- 1")
            self.eventually(lambda: self.at(0x606C) > 0)
            self.bench.world("pin limit1- 0")

        finger = threading.Thread(target=press)
        finger.start()
        self.assertTrue(node.homing(PATIENCE, restore_op_mode=True))
        finger.join()

    def test_homing_that_fails(self):
        node = self.node
        node.sdo[0x6098].raw = 19
        self.bench.world("pin limit1+ 1")
        self.assertFalse(node.homing(PATIENCE))
        self.assertEqual(node.check_statusword() & 0x3000, 0x2000)

    def test_a_set_point_and_its_handshake(self):
        node = self.node
        node.op_mode = "PROFILED POSITION"
        node.state = "OPERATION ENABLED"
        node.sdo[0x607A].raw = 30_000
        node.controlword = 0x1F
        self.eventually(lambda: node.check_statusword() & 1 << 12)
        node.controlword = 0x0F
        self.eventually(lambda: not node.check_statusword() & 1 << 12)
        self.eventually(lambda: node.check_statusword() & 1 << 10)
        self.assertEqual(self.at(0x6064), 30_000)

    def test_a_cyclic_position_by_sync(self):
        node = self.node
        node.op_mode = "CYCLIC SYNCHRONOUS POSITION"
        node.state = "OPERATION ENABLED"
        target = node.rpdo[2]
        for step in range(1, 51):
            target[0].raw = 0x0F
            target[1].raw = step * 20
            target.transmit()
            node.network.sync.transmit()
            time.sleep(0.002)
        self.eventually(lambda: self.at(0x6064) == 1000)
        node.network.sync.transmit()
        self.eventually(lambda: node.tpdo[2][1].raw == 1000)

    def test_safe_torque_off_is_an_emcy_and_a_reset_enables_again(self):
        node = self.node
        node.state = "OPERATION ENABLED"
        self.bench.world("pin sto1 1")
        self.eventually(node.is_faulted)
        self.eventually(lambda: [one.code for one in node.emcy.active] == [0x5441])
        self.bench.world("pin sto1 0")
        self.eventually(lambda: self.at(0x60FD) == 0)
        # Its loop for the fault reset always waits until the end of this time.
        node.TIMEOUT_RESET_FAULT = 0.1
        node.reset_from_fault()
        self.assertEqual(node.state, "OPERATION ENABLED")
        self.eventually(lambda: node.emcy.active == [])


class Module(BenchCase):
    def test_terminals_and_pdos(self):
        bench = self.sim("io@4")
        node = bench.node(4, exported("io"))
        node.nmt.state = "PRE-OPERATIONAL"
        node.pdo.read()
        node.nmt.state = "OPERATIONAL"
        inputs, outputs = node.tpdo[1], node.rpdo[1]
        self.eventually(lambda: inputs.timestamp is not None)
        bench.world("pin in1 1")
        self.eventually(lambda: inputs[0].raw == 1)
        bench.world("wire out9 in16")
        outputs[1].raw = 1
        outputs.transmit()
        self.eventually(lambda: inputs[1].raw == 0x80)
        self.assertEqual(node.sdo[0x6200][2].raw, 1)
