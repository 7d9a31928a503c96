"""A CAN bus with CANopen devices in it, in virtual time; and device descriptions.

``can.Bus(interface="odkit", channel="gxmm@1")`` is a bus of python-can with an encoder at node ID 1.
:class:`Bench` has the devices and the world around them: shafts, power, faults, EEPROMs, the wire.
:func:`read` reads an EDS, DCF or XDD, :func:`to_canopen` reads it for python-canopen.
"""

from odkit._odkit import (
    Bench,
    Description,
    Device,
    Difference,
    Entry,
    Finding,
    Fixed,
    Identity,
    Object,
    Relative,
    Snapshot,
    check,
    convert,
    devices,
    diff,
    fix,
    overlay,
    read,
    to_canopen,
    wires,
)

__all__ = [
    "Bench",
    "Description",
    "Device",
    "Difference",
    "Entry",
    "Finding",
    "Fixed",
    "Identity",
    "Object",
    "Relative",
    "Snapshot",
    "check",
    "convert",
    "devices",
    "diff",
    "fix",
    "overlay",
    "read",
    "to_canopen",
    "wires",
]
