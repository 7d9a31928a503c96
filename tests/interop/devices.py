"""The twelve devices, as far as their manuals differ for a master."""

from dataclasses import dataclass

from bench import exported

# Objects without a default: commands and live values.
COMMANDS = {0x1010, 0x1011}


@dataclass(frozen=True)
class Device:
    """One device, with what its family does."""

    name: str
    family: str
    # Abort code for a value below its limit (MANUALS.md U-05).
    too_low: int
    # LSS: the way in which a master finds a node.
    fastscan: bool
    vendor: int
    # Restored values are active at once, or after a reset (C-X-02).
    restores_at_once: bool
    # Abort code for a mapping entry that is written while its PDO has entries (U-19).
    mapping_in_use: int
    # A fault of this name causes an EMCY with this code.
    fault: tuple

    @property
    def eds(self):
        return exported(self.name)


def bus_cover(name):
    return Device(name, "GX", 0x06090030, False, 0xEC, True, None, ("internal", 0x7510))


def eam(name):
    return Device(name, "EAM", 0x06090030, True, 0x5F, False, 0x06010000, ("temperature", 0x4200))


DEVICES = [
    *map(bus_cover, ["gxmm", "gxam", "gcmm", "gcam", "gdmm", "gdam", "gbmm", "gbam"]),
    eam("eam_mt"),
    eam("eam_st"),
    eam("eam_red"),
    Device("en580c", "EN", 0x06090032, True, 0x5F, False, 0x08000022, ("battery-low", 0xFF00)),
]
