"""Every object of the bus-cover devices against the EDS: type, access, default."""

import canopen
from canopen.objectdictionary import datatypes

from bench import EDS, BenchCase



def family(name, device_type, product, steps, total, warnings):
    """Values of a device that differ from GXMM's defaults (manual 000, chapter 4.4.1)."""
    return {
        (0x1000, 0): device_type,
        (0x1008, 0): name,
        (0x1018, 2): product,
        (0x6001, 0): steps,
        (0x6501, 0): steps,
        (0x6002, 0): total,
        (0x6502, 0): total,
        (0x6506, 0): warnings,
    }


MULTI, SINGLE = 0x00020196, 0x00010196
FAMILIES = {
    "gxmm": family("GXMM", MULTI, 0x0A, 1 << 13, 1 << 29, 0x14),
    "gxam": family("GXAM", SINGLE, 0x0B, 1 << 13, 1 << 13, 0x04),
    "gcmm": family("GCMM", MULTI, 0x0C, 1 << 12, 1 << 26, 0x14),
    "gcam": family("GCAM", SINGLE, 0x0D, 1 << 12, 1 << 12, 0x04),
    "gdmm": family("GDMM", MULTI, 0x0E, 1 << 18, 1 << 31, 0x14),
    "gdam": family("GDAM", SINGLE, 0x0F, 1 << 18, 1 << 18, 0x04),
    "gbmm": family("GBMM", MULTI, 0x0E, 1 << 18, 1 << 31, 0x14),
    "gbam": family("GBAM", SINGLE, 0x0F, 1 << 18, 1 << 18, 0x04),
}

# Commands and live values: their value is not a default.
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

    def test_every_family(self):
        for device, defaults in FAMILIES.items():
            with self.subTest(device=device):
                self.check(device, defaults)

    def test_the_eds_runs_like_the_device(self):
        """The EDS as a file is a device, too: the same objects with the same values."""
        built_in, file = self.sim("gxmm").node(), self.sim(EDS).node()
        for variable in variables(built_in.object_dictionary):
            address = (variable.index, variable.subindex)
            # An entry without an error reads 0 in this family; CiA 301 aborts.
            if address not in LIVE and variable.index != 0x1003:
                self.assertEqual(built_in.sdo.upload(*address), file.sdo.upload(*address))

    def test_what_is_not_there(self):
        node = self.sim().node()
        self.assertAborts(0x06020000, node.sdo.upload, 0x2000, 0)
        self.assertAborts(0x06090011, node.sdo.upload, 0x1018, 5)
        self.assertAborts(0x06090011, node.sdo.upload, 0x6004, 1)
