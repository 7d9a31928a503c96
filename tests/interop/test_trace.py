"""The trace of chapter 6.4 of manual 000, through python-canopen's own socket, byte for byte.

Damaged rows are reconstructed from the command list (MANUALS.md C-GX-52); the same trace is
`tests/conformance/bus-cover/trace-6-4.script`.
"""

from bench import ROOT, BenchCase, Listener

SCRIPT = ROOT / "tests" / "conformance" / "bus-cover" / "trace-6-4.script"


def exchange():
    """Requests on 601h with their answers on 581h, in order."""
    request = None
    for line in SCRIPT.read_text().splitlines():
        words = line.split(" #")[0]
        if words.startswith("601#"):
            request = bytes.fromhex(words[4:])
        elif words.startswith("expect 581#"):
            yield request, bytes.fromhex(words[11:])


class Trace(BenchCase):
    def test_trace(self):
        network = self.sim("gxmm", "--position", "0x79592").network()
        answers = Listener(network, 0x581)
        positions = Listener(network, 0x181)
        booted = Listener(network, 0x701)
        count = 0
        for request, answer in exchange():
            network.send_message(0x601, request)
            count += 1
            self.assertEqual(answers.wait(count)[-1].hex(" "), answer.hex(" "))
        self.assertEqual(count, 16)
        network.send_message(0, b"\x01\x01")
        self.assertEqual(positions.wait(4), [b"\x92\x95\x07\x00"] * 4)
        network.send_message(0, b"\x80\x01")
        network.send_message(0, b"\x02\x01")
        network.send_message(0, b"\x81\x01")
        self.assertEqual(booted.wait(1), [b"\x00"])
