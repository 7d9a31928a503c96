"""The line protocol itself, and several clients on one bus."""

import socket

from bench import BenchCase, Listener, receive

READ = b"t60184000100000000000\r"
ANSWER = b"t58184300100096010200\r"


class Lines(BenchCase):
    def say(self, client, sent, expected):
        client.sendall(sent)
        self.assertEqual(receive(client, len(expected)), expected)

    def hears_nothing(self, client):
        """Receives the frames from before, so that the next bytes are the response to a command."""
        self.say(client, b"V\r", b"V1013\r")

    def test_a_host_opens(self):
        client = self.sim().raw()
        self.say(client, b"\r\r\rC\rS6\r\rO\r", b"\r" * 7)
        self.say(client, READ, b"z\r" + ANSWER)
        self.say(client, b"V\r", b"V1013\r")
        self.say(client, b"F\r", b"F00\r")
        self.say(client, b"T000006010\r", b"Z\r")
        # Node guarding is off: the next frame is the response to the next request.
        self.say(client, b"r7018\r" + READ, b"z\rz\r" + ANSWER)
        self.hears_nothing(client)

    def test_malformed_lines_get_a_bell(self):
        client = self.sim().raw()
        self.say(client, b"O\r", b"\r")
        for line in [b"t", b"t60", b"t6019", b"t601811", b"txyz0", b"?", b"t8000", b"\xff\xfe", b"S"]:
            self.say(client, line + b"\r", b"\x07")
        self.say(client, b"t" * 1_000_000 + b"\r", b"\x07")
        self.say(client, READ, b"z\r" + ANSWER)

    def test_lines_in_pieces_and_in_heaps(self):
        sim = self.sim()
        client, other = sim.raw(), sim.raw()
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        for byte in b"O\r" + READ:
            client.sendall(bytes([byte]))
            self.hears_nothing(other)  # a turn of the bus for each byte
        expected = b"\rz\r" + ANSWER
        self.assertEqual(receive(client, len(expected)), expected)
        self.say(client, READ * 500, (b"z\r" + ANSWER) * 500)

    def test_closed_channels_are_deaf_and_dumb(self):
        sim = self.sim()
        client, witness = sim.raw(), sim.raw()
        self.say(witness, b"O\r", b"\r")
        for closed in (b"", b"C\r"):
            self.say(client, closed + READ, closed[1:] + b"\x07")
            # No frame of the client was sent on the bus, and it receives none.
            self.say(witness, READ, b"z\r" + ANSWER)
            self.hears_nothing(client)
        self.say(client, b"O\r" + READ, b"\rz\r" + ANSWER)
        self.assertEqual(receive(witness, len(READ + ANSWER)), READ + ANSWER)
        # In listen-only mode it receives and cannot send.
        self.say(client, b"C\rL\r" + READ, b"\r\r\x07")
        self.say(witness, READ, b"z\r" + ANSWER)
        self.assertEqual(receive(client, len(READ + ANSWER)), READ + ANSWER)
        self.hears_nothing(client)

    def test_every_length(self):
        sim = self.sim()
        one, two = sim.raw(), sim.raw()
        self.say(one, b"O\r", b"\r")
        self.say(two, b"O\r", b"\r")
        for dlc in range(9):
            line = b"t123%d" % dlc + b"5A" * dlc + b"\r"
            self.say(one, line, b"z\r")
            self.assertEqual(receive(two, len(line)), line)
            line = b"R1234567%d%d\r" % (8, dlc)
            self.say(one, line, b"Z\r")
            self.assertEqual(receive(two, len(line)), line)


class Clients(BenchCase):
    def test_everybody_hears_everything_but_himself(self):
        sim = self.sim()
        clients = [sim.raw() for _ in range(3)]
        for client in clients:
            client.sendall(b"O\r")
            self.assertEqual(receive(client, 1), b"\r")
        for sender in clients:
            sender.sendall(READ)
            for client in clients:
                expected = (b"z\r" if client is sender else READ) + ANSWER
                self.assertEqual(receive(client, len(expected)), expected)

    def test_masters_work_side_by_side(self):
        sim = self.sim()
        node, other = sim.node(), sim.node()
        heard = [Listener(network.network, 0x181) for network in (node, other)]
        answers = Listener(other.network, 0x581)
        for number in range(100):
            node.sdo[0x2300][1].raw = number
            self.assertEqual(node.sdo[0x2300][1].raw, number)
        answers.wait(200)
        node.sdo[0x1800][5].raw = 5
        other.nmt.state = "OPERATIONAL"
        for listener in heard:
            listener.wait(20)

    def test_a_client_that_goes_disturbs_nobody(self):
        sim = self.sim()
        node = sim.node()
        for _ in range(20):
            client = sim.raw()
            client.sendall(b"O\rt601")
            client.close()
            self.assertEqual(node.sdo[0x1000].raw, 0x00020196)

    def test_a_client_that_does_not_read_holds_nobody_up(self):
        sim = self.sim()
        deaf, talker = sim.raw(), sim.raw()
        deaf.sendall(b"O\r")
        talker.sendall(b"O\r")
        self.assertEqual(receive(talker, 1), b"\r")
        heap = 2000
        for _ in range(500):
            talker.sendall(b"t12380000000000000000\r" * heap)
            self.assertEqual(receive(talker, 2 * heap), b"z\r" * heap)
            if any("does not read" in line for line in sim.errors):
                break
        self.eventually(lambda: any("does not read" in line for line in sim.errors))
        talker.sendall(READ)
        self.assertEqual(receive(talker, 24), b"z\r" + ANSWER)
        # When it reads again, it gets whole lines, and after them the newest ones.
        last = b"t7770\r"
        data = b""
        while not data.endswith(last):
            data += deaf.recv(1 << 20)
            talker.sendall(last)
            self.assertEqual(receive(talker, 2), b"z\r")
        whole = {b"", b"t12380000000000000000", READ[:-1], ANSWER[:-1], last[:-1]}
        self.assertLessEqual(set(data.split(b"\r")), whole)
