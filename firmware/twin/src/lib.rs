//! Devices on a Cortex-M3 that behave as those of the bench.
//!
//! The bench runs the conformance scripts and logs the calls of a device: frames, time, angle of
//! the shaft, switches, faults, power. A program here reads them from the file `calls` of the
//! computer that runs the emulator, and writes the answers of its node to `answers`.
//! `tests/firmware` compares them with those of the bench, byte for byte.
#![no_std]

pub mod files;
pub mod parts;
pub mod twin;

/// The program of a device: its node, with the services that its profile has.
#[macro_export]
macro_rules! twin {
    ($dictionary:path, $profile:path, $encoder:path) => {
        use odkit::encoder::{EncoderProfile, Family};
        use odkit::storage::image;
        use odkit::{Device, Dictionary, NodeId, Profile, Services};
        use odkit_firmware::board::Once;
        use $crate::twin::{Slave, run, slave};

        #[derive(Clone, Copy)]
        struct Own;

        const DICTIONARY: Dictionary<'static> = $dictionary;
        const DEVICE: &Profile = &$profile;

        impl Services for Own {
            const DICTIONARY: Option<Dictionary<'static>> = Some(DICTIONARY);
            const LSS: bool = DEVICE.lss.is_some();
            const SEGMENTED: bool = DEVICE.sdo.segmented_upload || DEVICE.sdo.segmented_download;
            const BLOCK: bool = DEVICE.sdo.block;
            const RPDOS: bool = DICTIONARY.rpdos() > 0;
            const CHANGES: bool = DEVICE.pdo.event_on_change;
        }

        impl Device for Own {
            type Values = Values;
            type Rooms = Rooms;

            fn dictionary(&self) -> Dictionary<'_> {
                DICTIONARY
            }

            fn profile(&self) -> &Profile {
                DEVICE
            }
        }

        odkit::rooms!(Own);

        impl Family for Own {
            const PROFILE: Option<&'static EncoderProfile> = Some(&$encoder);
        }

        static NODE: Once<Slave<Own>> = Once::new(slave(Own, NodeId::ONE));
        #[unsafe(link_section = ".eeprom")]
        static EEPROM: Once<[u8; image::capacity_needed(&DICTIONARY)]> =
            Once::new([0; image::capacity_needed(&DICTIONARY)]);

        #[unsafe(no_mangle)]
        extern "C" fn main() -> ! {
            run(NODE.take(), EEPROM.take())
        }
    };
}
