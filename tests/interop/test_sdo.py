"""SDO with python-canopen as the client: all transfers, and aborts."""

from bench import STRINGS, BenchCase

TEXT = "The quick brown fox jumps over the lazy dog"


class Writes(BenchCase):
    def test_typed_writes(self):
        node = self.sim("gxmm", "--position", "0x79592").node()
        self.assertEqual(node.sdo[0x6004].raw, 0x79592)
        node.sdo[0x6001].raw = 0x1000
        self.assertEqual(node.sdo[0x6004].raw, 0x3CAC9)
        node.sdo[0x6003].raw = 1000
        self.assertEqual(node.sdo[0x6004].raw, 1000)
        node.sdo[0x2300][8].raw = 0xABCD
        self.assertEqual(node.sdo[0x2300][8].raw, 0xABCD)
        self.assertEqual(node.sdo["Identity object"]["Vendor-ID"].raw, 0xEC)

    def test_aborts(self):
        node = self.sim().node()
        download = node.sdo.download
        self.assertAborts(0x06010002, download, 0x1000, 0, bytes(4))
        self.assertAborts(0x06020000, download, 0x5FFF, 0, bytes(4))
        self.assertAborts(0x06090011, download, 0x2300, 9, bytes(2))
        self.assertAborts(0x06090030, download, 0x6001, 0, bytes(4))
        self.assertAborts(0x06090031, download, 0x6001, 0, (0x2001).to_bytes(4, "little"))
        self.assertAborts(0x08000020, download, 0x1010, 1, b"evas")
        # The manual's list of commands has only expedited ones.
        self.assertAborts(0x05040001, download, 0x2300, 1, bytes(5))


class Transfers(BenchCase):
    def setUp(self):
        self.device = self.sim(STRINGS).node(7, STRINGS)

    def test_expedited(self):
        self.device.sdo[0x2010].raw = -5
        self.assertEqual(self.device.sdo[0x2010].raw, -5)
        self.device.sdo[0x2011].raw = 1.5
        self.assertEqual(self.device.sdo[0x2011].raw, 1.5)

    def test_segmented_upload(self):
        self.assertEqual(self.device.sdo[0x2000].raw, TEXT)

    def test_segmented_download(self):
        for text in ["seven77", "eight888", TEXT, "abc"]:
            self.device.sdo[0x2001].raw = text
            self.assertEqual(self.device.sdo[0x2001].raw, text)
        self.device.sdo[0x2012].raw = 0x1122334455667788
        self.assertEqual(self.device.sdo[0x2012].raw, 0x1122334455667788)

    def test_too_long(self):
        self.assertAborts(0x06070012, self.device.sdo.download, 0x2010, 0, bytes(3))
        self.assertAborts(0x06070013, self.device.sdo.download, 0x2010, 0, bytes(1))
        self.assertAborts(0x06070012, self.device.sdo.download, 0x2001, 0, bytes((1 << 20) + 1))

    def test_block_both_ways(self):
        for size in [1, 7, 8, 888, 889, 890, 1000]:
            sent = bytes(number * 7 % 256 for number in range(size))
            with self.device.sdo[0x2002].open(
                "wb", size=size, block_transfer=True, buffering=0
            ) as domain:
                at = 0
                while at < size:
                    at += domain.write(sent[at : at + 7])
            with self.device.sdo[0x2002].open("rb", block_transfer=True) as domain:
                self.assertEqual(domain.read(), sent, f"{size} bytes")

    def test_block_upload_of_a_text(self):
        with self.device.sdo[0x2000].open("rb", block_transfer=True) as text:
            self.assertEqual(text.read().decode(), TEXT)

    def test_many_in_a_row(self):
        for number in range(1000):
            self.device.sdo[0x2010].raw = number
            self.assertEqual(self.device.sdo[0x2010].raw, number)
