"""1010h and 1011h: what a power cycle keeps. The process ends and starts again."""

import tempfile
from pathlib import Path

from bench import BenchCase, Listener


class Store(BenchCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.eeprom = Path(folder.name) / "eeprom.bin"

    def start(self, *args):
        return self.sim("gxmm", "--eeprom", self.eeprom, *args)

    def test_saved_values_survive(self):
        sim = self.start()
        node = sim.node()
        node.sdo[0x6001].raw = 0x1000
        node.sdo[0x2300][1].raw = 0x1234
        node.sdo.download(0x1010, 1, b"save")
        node.sdo[0x2300][2].raw = 0x5678
        sim.kill()  # the save itself is on the disk
        node = self.start().node()
        self.assertEqual(node.sdo[0x6001].raw, 0x1000)
        self.assertEqual(node.sdo[0x2300][1].raw, 0x1234)
        self.assertEqual(node.sdo[0x2300][2].raw, 0)

    def test_restored_values_stay_restored(self):
        sim = self.start()
        node = sim.node()
        node.sdo[0x6001].raw = 0x1000
        node.sdo.download(0x1010, 1, b"save")
        node.sdo.download(0x1011, 1, b"load")
        self.assertEqual(node.sdo[0x6001].raw, 0x2000)  # at once, MANUALS.md C-GX-22
        self.assertEqual(sim.stop(), 0)
        self.assertEqual(self.start().node().sdo[0x6001].raw, 0x2000)

    def test_node_id(self):
        sim = self.start()
        node = sim.node()
        node.sdo[0x2101].raw = 5
        node.sdo.download(0x1010, 1, b"save")
        booted = Listener(node.network, 0x705)
        node.nmt.state = "RESET"
        booted.wait(1)
        sim.stop()
        sim = self.start()
        self.assertEqual(sim.node(5).sdo[0x1800][1].raw, 0x185)

    def test_in_memory_nothing_survives(self):
        sim = self.sim()
        node = sim.node()
        node.sdo[0x6001].raw = 0x1000
        node.sdo.download(0x1010, 1, b"save")
        booted = Listener(node.network, 0x701)
        node.nmt.state = "RESET"
        booted.wait(1)
        self.assertEqual(node.sdo[0x6001].raw, 0x1000)
        sim.stop()
        self.assertEqual(self.sim().node().sdo[0x6001].raw, 0x2000)
