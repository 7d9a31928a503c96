//! EN580C, an optical multiturn encoder.
#![no_std]
#![no_main]

use od_devices::en580c;

odkit_firmware_twin::twin!(en580c::en580c::DICTIONARY, en580c::PROFILE, en580c::ENCODER);
