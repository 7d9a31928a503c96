//! Devices on a Cortex-M3 that do what those of the bench do.
//!
//! The bench plays the conformance scripts, and logs the calls of a device: frames, time, angle of
//! the shaft, switches, faults, power. A program here reads them from the file `calls` of the computer
//! that runs the emulator, and writes the answers of its node to `answers`. `tests/firmware` compares
//! them with those of the bench, byte for byte.
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
        use odkit::{Device, Dictionary, Node, NodeId, Only, Profile, rooms};
        use odkit_firmware::board::Once;

        struct Own;

        const DICTIONARY: Dictionary<'static> = $dictionary;
        const DEVICE: &Profile = &$profile;

        impl Device for Own {
            const DICTIONARY: Option<Dictionary<'static>> = Some(DICTIONARY);
            const PROFILE: Option<&'static Profile> = Some(DEVICE);
            const LSS: bool = DEVICE.lss.is_some();
            const SEGMENTED: bool = DEVICE.sdo.segmented_upload || DEVICE.sdo.segmented_download;
            const BLOCK: bool = DEVICE.sdo.block;
            const RPDOS: bool = DICTIONARY.rpdos() > 0;
            const CHANGES: bool = DEVICE.pdo.event_on_change;
        }

        impl Family for Own {
            const PROFILE: Option<&'static EncoderProfile> = Some(&$encoder);
        }

        type Slave = Node<Own, { DICTIONARY.tpdos() }, { DICTIONARY.longest() }, Only<rooms!(Own)>>;

        static NODE: Once<Slave> = Once::new(Node::new(NodeId::ONE));
        static VALUES: Once<[u8; DICTIONARY.store_len()]> = Once::new([0; DICTIONARY.store_len()]);
        #[unsafe(link_section = ".eeprom")]
        static EEPROM: Once<[u8; image::capacity_needed(&DICTIONARY)]> =
            Once::new([0; image::capacity_needed(&DICTIONARY)]);

        #[unsafe(no_mangle)]
        extern "C" fn main() -> ! {
            $crate::twin::run::<Own, _, _, _, _>(
                NODE.take(),
                DICTIONARY,
                VALUES.take(),
                EEPROM.take(),
                DEVICE,
            )
        }
    };
}
