"""Every object of gxmm and gxam against the EDS: type, access, default."""

import canopen
from canopen.objectdictionary import datatypes

from bench import EDS, BenchCase

# What GXAM has in place of GXMM's defaults (manual 000, chapter 4.4.1).
GXAM = {
    (0x1000, 0): 0x00010196,
    (0x1008, 0): "GXAM",
    (0x1018, 2): 0x0B,
    (0x6002, 0): 0x2000,
    (0x6502, 0): 0x2000,
    (0x6506, 0): 0x0004,
}

# Commands and what lives: their value is not a default.
COMMANDS = {0x1010, 0x1011}
LIVE = {(0x6004, 0), (0x6508, 0), (0x2201, 2)}


def variables(dictionary):
    for index in dictionary:
        entry = dictionary[index]
        if isinstance(entry, canopen.objectdictionary.ODVariable):
            yield entry
        else:
            for sub in entry.values():
                yield sub


class Objects(BenchCase):
    def check(self, device, changed):
        node = self.sim(device).node()
        seen = 0
        for variable in variables(node.object_dictionary):
            address = (variable.index, variable.subindex)
            with self.subTest(object=f"{variable.index:04X}h:{variable.subindex:02X}"):
                self.check_one(node, variable, changed.get(address, variable.default))
                seen += 1
        self.assertGreater(seen, 80)
        return node

    def check_one(self, node, variable, default):
        index, sub = variable.index, variable.subindex
        self.assertTrue(variable.readable)
        data = node.sdo.upload(index, sub)
        if variable.data_type in datatypes.DATA_TYPES:
            self.assertEqual(data.decode("ascii"), default)
        else:
            self.assertEqual(len(data) * 8, len(variable), "the length of its type")
            if (index, sub) not in LIVE:
                self.assertEqual(variable.decode_raw(data), default)
        if not variable.writable:
            self.assertAborts(0x06010002, node.sdo.download, index, sub, data)
        elif index in COMMANDS:
            self.assertAborts(0x08000020, node.sdo.download, index, sub, data)
        else:
            node.sdo.download(index, sub, data)
            self.assertEqual(node.sdo.upload(index, sub), data)

    def test_gxmm(self):
        self.check("gxmm", {})

    def test_gxam(self):
        self.check("gxam", GXAM)

    def test_the_eds_runs_like_the_device(self):
        """The EDS as a file is a device, too: the same objects with the same values."""
        built_in, file = self.sim("gxmm").node(), self.sim(EDS).node()
        for variable in variables(built_in.object_dictionary):
            address = (variable.index, variable.subindex)
            # An entry without an error reads 0 in this family, and aborts after CiA 301.
            if address not in LIVE and variable.index != 0x1003:
                self.assertEqual(built_in.sdo.upload(*address), file.sdo.upload(*address))

    def test_what_is_not_there(self):
        node = self.sim().node()
        self.assertAborts(0x06020000, node.sdo.upload, 0x2000, 0)
        self.assertAborts(0x06090011, node.sdo.upload, 0x1018, 5)
        self.assertAborts(0x06090011, node.sdo.upload, 0x6004, 1)
