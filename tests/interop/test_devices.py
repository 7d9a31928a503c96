"""python-canopen as the master of each of the twelve devices.

What is expected comes from the EDS that `odkit export` writes and from the manuals' lists
(`devices.py`); the tests know no device by name.
"""

import unittest

import canopen
from canopen.objectdictionary import datatypes

from bench import PATIENCE, BenchCase, Listener
from devices import COMMANDS, DEVICES

# Objects that depend on time, or act when they are written.
LIVE = {0x1003, 0x2116, 0x2117, 0x2120, 0x2122, 0x2201, 0x2A00, 0x2A01, 0x6004, 0x600C, 0x6030,
        0x6040, 0x6503, 0x6505, 0x6508}
# Lists of values, masks and CAN-IDs: no range describes the valid values.
CHOSEN = {0x1005, 0x1014, 0x1016, 0x1029, 0x1800, 0x1801, 0x1A00, 0x1A01, 0x1F80, 0x2001, 0x2100,
          0x2101, 0x2110, 0x2116, 0x6000, 0x6031, 0x6041}


def variables(dictionary):
    """Every entry, in order."""
    for index in dictionary:
        entry = dictionary[index]
        if isinstance(entry, canopen.objectdictionary.ODVariable):
            yield entry
        else:
            yield from entry.values()


def is_text(variable):
    return variable.data_type not in datatypes.INTEGER_TYPES


class EveryDevice:
    """The tests; the classes below run them on one device each."""

    device = None

    def start(self, *args):
        self.running = self.sim(self.device.name, *args)
        return self.running.node(eds=self.device.eds)

    def each(self, node, wanted, check):
        """Checks every entry that is wanted; the answer is how many there were."""
        count = 0
        for variable in variables(node.object_dictionary):
            if wanted(variable):
                address = f"{variable.index:04X}h:{variable.subindex:02X}"
                with self.subTest(device=self.device.name, object=address):
                    check(node, variable)
                count += 1
        return count

    def test_reads_all(self):
        node = self.start()
        self.assertGreater(self.each(node, lambda v: v.readable, self.reads), 60)

    def reads(self, node, variable):
        index, sub = variable.index, variable.subindex
        if index == 0x1003 and sub > 0 and self.device.family != "GX":
            # An unused entry of the error history (MANUALS.md U-10).
            self.assertAborts(0x08000024, node.sdo.upload, index, sub)
            return
        data = node.sdo.upload(index, sub)
        if is_text(variable):
            self.assertEqual(data.decode("ascii"), variable.default)
            return
        self.assertEqual(len(data) * 8, len(variable), "the length of its type")
        if index not in LIVE | COMMANDS and variable.default is not None:
            self.assertEqual(variable.decode_raw(data), variable.default)

    def test_writes_all_that_is_writable(self):
        node = self.start()

        def wanted(v):
            return v.writable and v.readable and v.index not in LIVE | COMMANDS

        self.assertGreater(self.each(node, wanted, self.writes), 20)

    def writes(self, node, variable):
        index, sub = variable.index, variable.subindex
        data = node.sdo.upload(index, sub)
        if index in (0x1A00, 0x1A01) and sub > 0:
            code = self.device.mapping_in_use
            self.assertAborts(code, node.sdo.download, index, sub, data)
            return
        node.sdo.download(index, sub, data)
        self.assertEqual(node.sdo.upload(index, sub), data)
        if index in CHOSEN:
            return
        for limit, beyond in ((variable.min, -1), (variable.max, 1)):
            if limit is not None:
                with self.subTest(limit=limit):
                    try:
                        node.sdo.download(index, sub, variable.encode_raw(limit))
                    except canopen.SdoAbortedError as refused:
                        # The whole range ends with the number of revolutions, which depends
                        # on the resolution.
                        self.assertEqual((index, refused.code), (0x6002, 0x06090031))
                        continue
                    read = variable.decode_raw(node.sdo.upload(index, sub))
                    self.assertEqual(read, limit)
                    node.sdo.download(index, sub, data)
                    self.out_of_range(node, variable, limit + beyond)
                    self.assertEqual(node.sdo.upload(index, sub), data)

    def out_of_range(self, node, variable, value):
        bits = len(variable)
        is_signed = variable.data_type in datatypes.SIGNED_TYPES
        lowest, highest = (-(1 << bits - 1), (1 << bits - 1) - 1) if is_signed else (0, (1 << bits) - 1)
        if not lowest <= value <= highest:
            return  # the type itself has no such value
        data = value.to_bytes(bits // 8, "little", signed=is_signed)
        too_high = variable.max is not None and value > variable.max
        code = 0x06090031 if too_high else self.device.too_low
        self.assertAborts(code, node.sdo.download, variable.index, variable.subindex, data)

    def test_refuses_what_is_read_only(self):
        node = self.start()

        def refuses(node, variable):
            address, data = (variable.index, variable.subindex), bytes(len(variable) // 8)
            self.assertAborts(0x06010002, node.sdo.download, *address, data)

        count = self.each(node, lambda v: not v.writable and not is_text(v), refuses)
        self.assertGreater(count, 20)

    def test_refuses_what_is_not_there(self):
        node = self.start()
        self.assertAborts(0x06020000, node.sdo.upload, 0x5FFF, 0)
        self.assertAborts(0x06020000, node.sdo.download, 0x5FFF, 0, bytes(4))
        self.assertAborts(0x06090011, node.sdo.upload, 0x1018, 9)

    def test_commands_want_their_signature(self):
        node = self.start()
        for index in COMMANDS:
            self.assertAborts(0x08000020, node.sdo.download, index, 1, b"what")

    def test_states_and_heartbeat(self):
        node = self.start()
        node.sdo[0x1017].raw = 20
        for state in ["OPERATIONAL", "STOPPED", "PRE-OPERATIONAL"]:
            node.nmt.state = state
            self.eventually(lambda: node.nmt.wait_for_heartbeat(PATIENCE) == state)
        booted = Listener(node.network, 0x701)
        node.nmt.state = "RESET"
        self.eventually(lambda: b"\0" in booted.frames)

    def test_node_guarding(self):
        node = self.start()
        if self.device.family == "GX":
            # Guarding is switched on by bit 5 of 2110h (C-X-19).
            node.sdo[0x2110].raw = node.sdo[0x2110].raw | 1 << 5
        answers = Listener(node.network, 0x701)
        for count in range(1, 7):
            node.network.send_message(0x701, b"", remote=True)
            answers.wait(count)
        toggles = [frame[0] for frame in answers.frames[:6]]
        # After boot-up the toggle bit is 0 (C-GX-38).
        self.assertEqual(toggles, [0x7F, 0xFF] * 3)
        node.nmt.start_node_guarding(0.02)
        answers.wait(20)
        node.nmt.stop_node_guarding()
        self.assertEqual(node.nmt.state, "PRE-OPERATIONAL")

    def test_pdo_mapping(self):
        node = self.start("--position", "77")
        node.tpdo.read()
        self.assertEqual(node.tpdo[1].cob_id & 0x7FF, 0x181)
        self.assertEqual([v.index for v in node.tpdo[1].map], [0x6004])
        pdo = node.tpdo[1]
        pdo.trans_type = 1
        pdo.event_timer = 0
        received = Listener(node.network, 0x181)
        if node.object_dictionary[0x1A00][0].writable:
            second = next(
                v for v in variables(node.object_dictionary)
                if v.pdo_mappable and v.index > 0x6004 and len(v) <= 32
            )
            pdo.clear()
            pdo.add_variable(0x6004)
            pdo.add_variable(second.index, second.subindex)
            pdo.save()
            node.tpdo.read()
            self.assertEqual([v.index for v in node.tpdo[1].map], [0x6004, second.index])
            length = 4 + len(second) // 8
        else:
            # The bus covers map statically.
            pdo.map = []
            node.sdo[0x1800][2].raw = 1
            node.sdo[0x1800][5].raw = 0
            length = 4
        position = node.sdo.upload(0x6004, 0)
        node.nmt.state = "OPERATIONAL"
        for _ in range(5):
            node.network.sync.transmit()
        frames = received.wait(5)
        self.assertEqual({len(frame) for frame in frames}, {length})
        self.assertEqual({frame[:4] for frame in frames}, {position})

    def test_emcy(self):
        node = self.start()
        fault, code = self.device.fault
        node.nmt.state = "OPERATIONAL"
        self.running.world(f"fault {fault} on")
        self.eventually(lambda: any(error.code == code for error in node.emcy.log))
        self.assertNotEqual(node.sdo[0x1001].raw, 0)
        self.assertEqual(node.sdo[0x1003][1].raw & 0xFFFF, code)

    def test_store_and_power_cycle(self):
        node = self.start()
        node.sdo[0x6003].raw = 0x123
        node.sdo[0x2300][1].raw = 0x1234
        node.sdo.download(0x1010, 1, b"save")
        node.sdo[0x2300][1].raw = 0x5678
        # A family that responds first needs power for another second (C-X-03).
        self.cycle(node, "wait 1500ms")
        self.assertEqual(node.sdo[0x2300][1].raw, 0x1234)
        self.assertEqual(node.sdo[0x6003].raw, 0x123)
        node.sdo.download(0x1011, 1, b"load")
        if self.device.restores_at_once:
            self.assertEqual(node.sdo[0x6003].raw, 0)
        else:
            self.assertEqual(node.sdo[0x6003].raw, 0x123)
        self.cycle(node, "wait 1500ms")
        self.assertEqual(node.sdo[0x2300][1].raw, 0)
        self.assertEqual(node.sdo[0x6003].raw, 0)

    def cycle(self, node, before):
        booted = Listener(node.network, 0x701)
        self.running.world(before)
        self.running.world("power cycle 200ms")
        self.eventually(lambda: b"\0" in booted.frames)

    def test_lss(self):
        node = self.start()
        network = node.network
        identity = [node.sdo[0x1018][sub].raw for sub in (1, 2, 3, 4)]
        self.assertEqual(identity[0], self.device.vendor)
        network.lss.RESPONSE_TIMEOUT = PATIENCE
        # The second channel of a redundant encoder is a node of its own: only one is read.
        node.nmt.state = "STOPPED"
        network.lss.send_switch_state_global(network.lss.CONFIGURATION_STATE)
        for sub, inquire in enumerate(
            [canopen.lss.CS_INQUIRE_VENDOR_ID, canopen.lss.CS_INQUIRE_PRODUCT_CODE,
             canopen.lss.CS_INQUIRE_REVISION_NUMBER, canopen.lss.CS_INQUIRE_SERIAL_NUMBER]
        ):
            self.assertEqual(network.lss.inquire_lss_address(inquire), identity[sub])
        network.lss.send_switch_state_global(network.lss.WAITING_STATE)
        if self.device.fastscan:
            # No response counts, too: on a busy machine it takes longer to be sure.
            for patience in (0.1, 0.5, 2):
                # A slave that confirmed late was already found.
                network.lss.send_switch_state_global(network.lss.WAITING_STATE)
                network.lss.RESPONSE_TIMEOUT = patience
                found, address = network.lss.fast_scan()
                if found:
                    break
            network.lss.RESPONSE_TIMEOUT = PATIENCE
            self.assertTrue(found)
            self.assertEqual(list(address), identity)
            network.lss.send_switch_state_global(network.lss.WAITING_STATE)
        else:
            # Manual 000 has the older service instead (C-X-18).
            answers = Listener(network, 0x7E4)
            network.lss.send_identify_remote_slave(
                identity[0], identity[1], identity[2], identity[2], identity[3], identity[3]
            )
            self.assertEqual(answers.wait(1)[0][0], 0x4F)
        selected = network.lss.send_switch_state_selective(*identity)
        self.assertTrue(selected)
        network.lss.configure_node_id(9)
        network.lss.store_configuration()
        network.lss.send_switch_state_global(network.lss.WAITING_STATE)
        booted = Listener(network, 0x709)
        # A save in the background gets its time before the node is reset.
        self.running.world("wait 1500ms")
        self.running.world("000#81 01")
        self.eventually(lambda: b"\0" in booted.frames)
        other = network.add_node(9, str(self.device.eds))
        self.assertEqual(other.sdo[0x1000].raw, node.object_dictionary[0x1000].default)


for each in DEVICES:
    name = f"Test_{each.name}"
    globals()[name] = type(name, (EveryDevice, BenchCase), {"device": each})


class Redundant(BenchCase):
    """Two channels of one encoder, two nodes."""

    def test_both_channels(self):
        sim = self.sim("eam_red")
        network = sim.network()
        device = next(device for device in DEVICES if device.name == "eam_red")
        channels = [network.add_node(number, str(device.eds)) for number in (1, 2)]
        sim.world("shaft at 0x4000")
        self.eventually(lambda: channels[0].sdo[0x6004].raw == 0x1000)
        self.assertEqual(channels[1].sdo[0x6004].raw, 0x1000)
        serials = {channel.sdo[0x1018][4].raw for channel in channels}
        self.assertEqual(len(serials), 2)


if __name__ == "__main__":
    unittest.main()
