//! GXMM, a multiturn encoder of the bus-cover family.
#![no_std]
#![no_main]

use od_devices::bus_cover;

odkit_firmware_twin::twin!(
    bus_cover::gxmm::DICTIONARY,
    bus_cover::PROFILE,
    bus_cover::ENCODER
);
