"""The position of an axis, from an encoder on a CANopen bus."""

import threading

POSITION, STEPS, HEARTBEAT = 0x6004, 0x6001, 0x1017


class Axis:
    """An encoder that reports its position every `period_ms` milliseconds and is watched."""

    def __init__(self, network, node_id, dictionary, period_ms=10, heartbeat_ms=100):
        self.node = network.add_node(node_id, dictionary)
        self.steps = self.node.sdo[STEPS].raw
        self.node.sdo[HEARTBEAT].raw = heartbeat_ms
        self.node.tpdo.read()
        self.node.tpdo[1].event_timer = period_ms
        self.node.tpdo[1].trans_type = 254
        self.node.tpdo[1].enabled = True
        self.node.tpdo.save()
        self.revolutions = None
        self.errors = []
        self._moved = threading.Event()
        self.node.tpdo[1].add_callback(self._position)
        self.node.emcy.add_callback(lambda error: self.errors.append(error.code))
        self.node.nmt.state = "OPERATIONAL"

    def _position(self, pdo):
        self.revolutions = pdo[0].raw / self.steps
        self._moved.set()

    def wait_for_position(self, timeout=1.0):
        """The next position in revolutions; `TimeoutError` if the encoder is silent."""
        self._moved.clear()
        if not self._moved.wait(timeout):
            raise TimeoutError("the encoder sends no position")
        return self.revolutions
