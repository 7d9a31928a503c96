"""A CAN bus with CANopen devices in it, in virtual time; device descriptions; and a client for any bus.

``can.Bus(interface="odkit", channel="gxmm@1")`` is a bus of python-can with an encoder at node ID 1.
:class:`Bench` has the devices and the world around them: shafts, power, faults, EEPROMs, the wire.
:func:`read` reads an EDS, DCF or XDD, :func:`to_canopen` reads it for python-canopen.
:class:`Client` is the other end of a bus: SDO, NMT, LSS, heartbeat, EMCY, PDOs, the conformance test.
"""

from odkit._odkit import (
    Bench,
    Client,
    Conform,
    Description,
    Device,
    Difference,
    Emcy,
    Entry,
    Finding,
    Fixed,
    Found,
    Identity,
    Incident,
    Node,
    NodeError,
    Object,
    Pdo,
    Record,
    Relative,
    SdoAbort,
    Snapshot,
    check,
    conform_cases,
    convert,
    devices,
    diff,
    fix,
    overlay,
    play,
    read,
    to_canopen,
    wires,
)
from odkit._campaign import Failure, campaign
from odkit._waits import patch_time
from odkit.aio import AsyncClient

__all__ = [
    "AsyncClient",
    "Bench",
    "Client",
    "Conform",
    "Description",
    "Device",
    "Difference",
    "Emcy",
    "Entry",
    "Failure",
    "Finding",
    "Fixed",
    "Found",
    "Identity",
    "Incident",
    "Node",
    "NodeError",
    "Object",
    "Pdo",
    "Record",
    "Relative",
    "SdoAbort",
    "Snapshot",
    "campaign",
    "check",
    "conform_cases",
    "convert",
    "devices",
    "diff",
    "fix",
    "overlay",
    "patch_time",
    "play",
    "read",
    "to_canopen",
    "wires",
]
