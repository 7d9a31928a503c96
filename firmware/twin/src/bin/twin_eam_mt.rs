//! EAM multiturn, a magnetic encoder.
#![no_std]
#![no_main]

use od_devices::eam;

odkit_firmware_twin::twin!(eam::eam_mt::DICTIONARY, eam::PROFILE, eam::ENCODER);
