"""A CAN bus with CANopen devices in it, in virtual time.

``can.Bus(interface="odkit", channel="gxmm@1")`` is a bus of python-can with an encoder at node ID 1.
:class:`Bench` has the devices and the world around them: shafts, power, faults, EEPROMs, the wire.
"""

from odkit._odkit import Bench, Device, Snapshot, devices, wires

__all__ = ["Bench", "Device", "Snapshot", "devices", "wires"]
