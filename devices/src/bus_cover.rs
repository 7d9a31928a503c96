//! Encoders with a bus cover: multivo, magtivo, activo and multivoPlus.
//!
//! Source: manual 000, chapters 4.3 (communication), 4.4 (objects) and 7.2 (switches), and
//! `docs/MANUALS.md` where the manual contradicts itself or gives no answer. The dictionary defines
//! the objects; the two profiles here define the differences of the family from CiA 301 and CiA
//! 406. The eight devices differ only in their dictionaries.

use odkit::Address;
use odkit::encoder::{EncoderProfile, Fault, OptionObject, Report, Role, Total};
use odkit::{
    AbortCode, BusOffProfile, CommunicationReset, CutSave, ErrorProfile, ErrorReset, EventTimer,
    LengthRule, LssProfile, NmtProfile, Notice, PdoProfile, Profile, Restore, SaveAnswer,
    SavedCobIds, SdoProfile, StoreProfile,
};

#[cfg(feature = "std")]
use odkit::{DeviceKind, Dictionary, kind::Behaviour};

odkit::object_dictionary! {
    /// `GXMM`, multivo multiturn: 13 bits per revolution, 16 bits of revolutions.
    ///
    /// 1018h:04 and 650Bh, the serial number, are 1 unless the host gives another one
    /// (`Encoder::with_serial_number`).
    pub mod gxmm {
        eds = "../eds/GXMM.eds";
        profile = cia406;

        /// `GXAM`, multivo singleturn: 13 bits per revolution. It has no battery.
        variant gxam {
            modify 0x1000 { default = 0x0001_0196 }
            modify 0x1008 { default = "GXAM" }
            modify 0x1018sub2 { default = 0x0B }
            modify 0x6002 { default = 0x2000; high = 0x2000 }
            modify 0x6502 { default = 0x2000 }
            modify 0x6506 { default = 0x0004 }
        }

        /// `GCMM`, magtivo multiturn: 12 bits per revolution, 14 bits of revolutions (C-GX-03,
        /// C-GX-31).
        variant gcmm {
            modify 0x1008 { default = "GCMM" }
            modify 0x1018sub2 { default = 0x0C }
            modify 0x6001 { default = 0x1000; high = 0x1000 }
            modify 0x6002 { default = 0x0400_0000; high = 0x0400_0000 }
            modify 0x6501 { default = 0x1000 }
            modify 0x6502 { default = 0x0400_0000 }
        }

        /// `GCAM`, magtivo singleturn: 12 bits per revolution. It has no battery.
        variant gcam {
            modify 0x1000 { default = 0x0001_0196 }
            modify 0x1008 { default = "GCAM" }
            modify 0x1018sub2 { default = 0x0D }
            modify 0x6001 { default = 0x1000; high = 0x1000 }
            modify 0x6002 { default = 0x1000; high = 0x1000 }
            modify 0x6501 { default = 0x1000 }
            modify 0x6502 { default = 0x1000 }
            modify 0x6506 { default = 0x0004 }
        }

        /// `GDMM`, activo multiturn: 18 bits per revolution, 13 bits of revolutions. Only its name
        /// differs from the multivoPlus; even the product code is the same (C-GX-30).
        variant gdmm {
            modify 0x1008 { default = "GDMM" }
            modify 0x1018sub2 { default = 0x0E }
            modify 0x6001 { default = 0x0004_0000; high = 0x0004_0000 }
            modify 0x6002 { default = 0x8000_0000; high = 0x8000_0000 }
            modify 0x6501 { default = 0x0004_0000 }
            modify 0x6502 { default = 0x8000_0000 }
        }

        /// `GDAM`, activo singleturn: 18 bits per revolution. It has no battery.
        variant gdam {
            modify 0x1000 { default = 0x0001_0196 }
            modify 0x1008 { default = "GDAM" }
            modify 0x1018sub2 { default = 0x0F }
            modify 0x6001 { default = 0x0004_0000; high = 0x0004_0000 }
            modify 0x6002 { default = 0x0004_0000; high = 0x0004_0000 }
            modify 0x6501 { default = 0x0004_0000 }
            modify 0x6502 { default = 0x0004_0000 }
            modify 0x6506 { default = 0x0004 }
        }

        /// `GBMM`, multivoPlus multiturn: 18 bits per revolution, 13 bits of revolutions (C-GX-04,
        /// C-GX-31). Its name has four letters (C-GX-09).
        variant gbmm {
            modify 0x1008 { default = "GBMM" }
            modify 0x1018sub2 { default = 0x0E }
            modify 0x6001 { default = 0x0004_0000; high = 0x0004_0000 }
            modify 0x6002 { default = 0x8000_0000; high = 0x8000_0000 }
            modify 0x6501 { default = 0x0004_0000 }
            modify 0x6502 { default = 0x8000_0000 }
        }

        /// `GBAM`, multivoPlus singleturn: 18 bits per revolution. It has no battery.
        variant gbam {
            modify 0x1000 { default = 0x0001_0196 }
            modify 0x1008 { default = "GBAM" }
            modify 0x1018sub2 { default = 0x0F }
            modify 0x6001 { default = 0x0004_0000; high = 0x0004_0000 }
            modify 0x6002 { default = 0x0004_0000; high = 0x0004_0000 }
            modify 0x6501 { default = 0x0004_0000 }
            modify 0x6502 { default = 0x0004_0000 }
            modify 0x6506 { default = 0x0004 }
        }
    }
}

/// A device of the family.
#[cfg(feature = "std")]
pub(crate) const fn kind(
    name: &'static str,
    title: &'static str,
    dictionary: Dictionary<'static>,
) -> DeviceKind {
    DeviceKind {
        name,
        title,
        family: "bus-cover",
        // Chapter 7.3.
        leds: true,
        dictionary,
        profile: &PROFILE,
        behaviour: Behaviour::Encoder(&ENCODER),
        channels: 1,
    }
}

/// Deviations of the services from CiA 301: chapters 4.3.3 to 4.3.6, objects 1010h to 2801h.
pub static PROFILE: Profile = Profile {
    sdo: SdoProfile {
        // Requests without their unused bytes get a response, too (C-GX-15).
        min_dlc: 4,
        length: LengthRule {
            // The list of abort codes has no code for lengths. If there are too many bytes the node
            // uses the low ones (C-GX-13, C-GX-14); too few bytes are a general error.
            too_long: None,
            too_short: AbortCode::General,
        },
        // The list of commands has only expedited ones.
        segmented_upload: false,
        segmented_download: false,
        block: false,
        // The abort code for values that is not "too great" (U-05).
        below_limit: AbortCode::ValueRange,
        // An entry of 1003h without an error reads 0 (U-10).
        unused_error: None,
        // The mapping is read only.
        mapping_in_use: AbortCode::UnsupportedAccess,
    },
    pdo: PdoProfile {
        // 1800h:02: every n-th SYNC, or cyclic with the event timer.
        tpdo_types: &[(1, 240), (254, 254)],
        event_on_change: false,
        // 1800h:05 is the cycle time of a PDO that is sent cyclically.
        event_timer: EventTimer::Cyclic,
        // A new COB-ID takes effect at once (U-18).
        direct_cob_id: true,
        repeat_counter: Some(0x2800),
        // 2110h bit 7, together with bit 6.
        sync_only: Some((0x2110, 1 << 6 | 1 << 7)),
    },
    store: StoreProfile {
        // 1011h overwrites RAM and makes the EEPROM invalid (C-GX-22).
        restore: Restore::AtOnce,
        failed: AbortCode::LocalControl,
        answer: SaveAnswer::AfterStoring,
        duration_us: 0,
        // U-33.
        cut: CutSave::LastSet,
        // A written value stays absolute (U-04).
        cob_ids: SavedCobIds::Absolute,
        // 6200h equals 1800h:05 (C-GX-26), whichever group is saved or restored.
        twins: &[[Address::new(0x1800, 5), Address::new(0x6200, 0)]],
        ..Profile::CIA301.store
    },
    // Chapter 4.3.7; the table runs opposite to the codes of 2100h (C-GX-36).
    lss: Some(LssProfile {
        stopped_only: true,
        node_id: Address::new(0x2101, 0),
        bit_rate: Address::new(0x2100, 0),
        bit_rates: [
            Some(8),
            Some(7),
            Some(6),
            Some(5),
            Some(4),
            Some(3),
            Some(2),
            Some(1),
            Some(0),
        ],
        identify_remote: true,
        non_configured: false,
        fastscan: false,
        inquire_node_id: false,
        // Silent during the delay, then at the new bit rate (C-GX-57).
        second_delay: false,
        shows_state: true,
    }),
    // 2110h bit 5: node guarding replaces heartbeat.
    guarding_switch: Some((0x2110, 1 << 5)),
    nmt: NmtProfile {
        // The manual gives no durations (C-X-20).
        reset_node_us: 0,
        reset_communication_us: 0,
        reset_communication: CommunicationReset::Communication,
        self_start: None,
        // 2110h bit 10: reset node resets the NMT state only.
        reset_node_light: Some((0x2110, 1 << 10)),
    },
    errors: ERRORS,
};

/// Errors that the node detects: chapter 4.3.5 and object 1029h; bits of 1001h: U-08.
pub(crate) const ERRORS: ErrorProfile = ErrorProfile {
    lost: Notice {
        code: 0x8130,
        register: 0x11,
    },
    // The list of codes has none for states of the CAN controller; code 1000h also covers an
    // overrun (U-38).
    bus_warning: None,
    bus_passive: None,
    bus_off: 0x11,
    bus_recovered: None,
    // SYNC messages of 0 and of 1 byte are both accepted, and the manual names no code for others.
    watches_sync_length: false,
    overrun: Some(Notice {
        code: 0x1000,
        register: 0x11,
    }),
    reset: ErrorReset::EachError,
    behaviour: &[(1 << 4, 1)],
    // U-32.
    operational_only: false,
    // 2110h bit 3 (U-22).
    off: BusOffProfile {
        restart: Some((0x2110, 1 << 3)),
        boots: false,
        behaviour_if_off: false,
    },
};

/// Encoder profile: chapters 4.3.5, 4.4.2 and 7.2.
pub static ENCODER: EncoderProfile = EncoderProfile {
    // 6501h and 6502h describe the sensor; 6502h is in steps, not revolutions.
    sensor: None,
    total: Total::Steps,
    // 6509h is 0 to the current range − 1 (C-GX-53, U-07).
    signed_offset: false,
    zero_is_full: false,
    // 6000h: code sequence and scaling.
    operating_bits: 0x0005,
    objects: &[
        // Reaction to a communication error (C-GX-23).
        (Address::new(0x1029, 1), Role::OneOf(&[0, 1, 2, 3])),
        (Address::new(0x2100, 0), Role::BitRate),
        (Address::new(0x2101, 0), Role::NodeId),
        (Address::new(0x2201, 2), Role::Seconds),
        (Address::new(0x6508, 0), Role::TenthHoursSinceStart),
    ],
    below_limit: AbortCode::ValueRange,
    options: Some(OptionObject {
        index: 0x2110,
        keep_offset: 1 << 9,
        delay_timer: 1 << 8,
        delay_ms: 2,
        ..OptionObject::NONE
    }),
    bit_rates: &[10, 20, 50, 100, 125, 250, 500, 800, 1000],
    // Chapter 7.2.2: other codes than in 2100h; 100 kbit/s is not supported (C-GX-35).
    switch_rates: &[10, 20, 50, 125, 250, 500, 800, 1000],
    // Bits of 1001h: U-08.
    reports: &[
        Report {
            fault: Fault::Position,
            code: 0x7320,
            register: 0x81,
            alarm: 0x0001,
            counter: Some(Address::new(0x2201, 1)),
            ..Report::BASE
        },
        Report {
            fault: Fault::Internal,
            code: 0x7510,
            register: 0x81,
            ..Report::BASE
        },
        Report {
            fault: Fault::Memory,
            code: 0x5530,
            register: 0x01,
            ..Report::BASE
        },
        Report {
            fault: Fault::Watchdog,
            code: 0x6010,
            register: 0x01,
            warning: 0x0004,
            counter: Some(Address::new(0x2201, 3)),
            ..Report::BASE
        },
        Report {
            fault: Fault::Battery,
            code: 0xFF00,
            register: 0x81,
            warning: 0x0010,
            ..Report::BASE
        },
    ],
    ..EncoderProfile::CIA406
};
