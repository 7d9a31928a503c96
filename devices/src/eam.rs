//! Magnetic encoders EAM: multiturn, singleturn, and the redundant version.
//!
//! Source: manual 001, chapters 4 to 12, and `docs/MANUALS.md` where the manual contradicts itself
//! or gives no answer. The dictionary defines the objects; the profiles here define the differences
//! of the family from CiA 301 and CiA 406.
//!
//! The redundant version is two channels on one shaft, behind one connector: two nodes, each
//! with its own electronics, battery, memory and serial number (chapter 4.5).

use odkit::Address;
use odkit::encoder::{
    Counter, EncoderProfile, Gear, GearKind, Movement, OptionObject, Quantity, RangeRule, Role,
    Sensor, Source, Total,
};
use odkit::{
    AbortCode, BusOffProfile, CommunicationReset, CutSave, ErrorProfile, ErrorReset, EventTimer,
    LengthRule, LssProfile, NmtProfile, Notice, PdoProfile, Profile, Restore, SaveAnswer,
    SavedCobIds, SdoProfile, StoreProfile,
};

use crate::eam_diagnosis;
#[cfg(feature = "std")]
use odkit::{DeviceKind, Dictionary, kind::Behaviour};

odkit::object_dictionary! {
    /// `EAMxxx MT`, multiturn: 16 bits per revolution, of which 14 are used by default, and 18 bits
    /// of revolutions.
    ///
    /// 1018h:04 and 650Bh, the serial number, are 1 unless the host gives another one
    /// (`Encoder::with_serial_number`).
    pub mod eam_mt {
        eds = "../eds/EAM_MT.eds";
        profile = cia406;

        /// `EAMxxx ST`, singleturn (C-EAM-16).
        variant eam_st {
            modify 0x1000 { default = 0x0001_0196 }
            modify 0x1008 { default = "EAMxxx ST" }
            modify 0x1018sub2 { default = 0x71 }
            modify 0x6002 { default = 0x4000 }
            modify 0x6502 { default = 1 }
        }

        /// One channel of the redundant `EAMxxx MT`, without the electronic gear.
        variant eam_red {
            remove 0x2001;
        }
    }
}

/// A device of the family.
#[cfg(feature = "std")]
pub(crate) const fn kind(
    name: &'static str,
    title: &'static str,
    dictionary: Dictionary<'static>,
    encoder: &'static EncoderProfile,
    channels: u8,
) -> DeviceKind {
    DeviceKind {
        name,
        title,
        family: "eam",
        // Manual 001 describes no LED.
        leds: false,
        dictionary,
        profile: &PROFILE,
        behaviour: Behaviour::Encoder(encoder),
        channels,
    }
}

/// Deviations of the services from CiA 301: chapters 5 to 11.
pub static PROFILE: Profile = Profile {
    sdo: SdoProfile {
        // U-37.
        min_dlc: 4,
        // The list of abort codes has no code for lengths, so the node sends the general one of CiA
        // 301 (U-16).
        length: LengthRule {
            too_long: Some(AbortCode::Length),
            too_short: AbortCode::Length,
        },
        // Segmented upload (chapter 6.1).
        segmented_upload: true,
        segmented_download: false,
        block: false,
        // The abort code for values that is not "too great" (U-05).
        below_limit: AbortCode::ValueRange,
        // U-10.
        unused_error: Some(AbortCode::NoData),
        // U-19.
        mapping_in_use: AbortCode::UnsupportedAccess,
    },
    pdo: PdoProfile {
        // Chapter 7.2.
        tpdo_types: &[(1, 240), (253, 255)],
        event_on_change: false,
        // Chapter 7.2: 1800h:05 is a cycle time.
        event_timer: EventTimer::Cyclic,
        // A new COB-ID takes effect at once (chapter 7.3).
        direct_cob_id: true,
        repeat_counter: None,
        sync_only: None,
    },
    store: StoreProfile {
        // Chapter 6.3.2.
        restore: Restore::AfterReset,
        failed: AbortCode::LocalControl,
        // Chapter 6.3.1; the manual gives no duration, this is typical of an EEPROM.
        answer: SaveAnswer::AfterStoring,
        duration_us: 50_000,
        // Chapter 6.3.3 (U-33).
        cut: CutSave::Factory,
        // Chapters 7.3 and 8.2 (C-EAM-02).
        cob_ids: SavedCobIds::Difference,
        twins: &[],
        ..Profile::CIA301.store
    },
    // Chapter 11: index 5 is reserved by CiA 305.
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
            None,
            Some(2),
            Some(1),
            Some(0),
        ],
        // Chapter 14: not implemented (C-EAM-22).
        identify_remote: false,
        non_configured: true,
        fastscan: true,
        inquire_node_id: true,
        // As in CiA 305.
        second_delay: true,
        shows_state: true,
    }),
    guarding_switch: None,
    nmt: NmtProfile {
        // Chapters 5.1.1 and 5.1.2: maximum durations.
        reset_node_us: 170_000,
        reset_communication_us: 5_000,
        // Chapter 5.1.2: every value that was not saved is lost.
        reset_communication: CommunicationReset::Everything,
        // C-EAM-34.
        self_start: Some((0x1F80, 1 << 3)),
        reset_node_light: None,
    },
    // Chapters 8.4, 9.3 and 9.5.
    errors: ErrorProfile {
        // The row has no bit of 1001h (C-EAM-20).
        lost: Notice {
            code: 0x8130,
            register: 0,
        },
        bus_warning: Some(Notice {
            code: 0x8100,
            register: 1 << 4,
        }),
        bus_passive: Some(Notice {
            code: 0x8120,
            register: 1 << 4,
        }),
        bus_off: 1 << 4,
        // C-EAM-41.
        bus_recovered: None,
        // A SYNC of 0 bytes and of 1 byte are accepted; the manual has no code for others.
        watches_sync_length: false,
        // The row has no bit of 1001h; chapter 8.4.1 has one (C-EAM-20).
        overrun: Some(Notice {
            code: 0x8110,
            register: 1 << 4,
        }),
        reset: ErrorReset::LastError,
        behaviour: &[(1 << 4, 1), (1 << 0, 2), (1 << 3, 3)],
        operational_only: true,
        // 2110h bit 3.
        off: BusOffProfile {
            restart: Some((0x2110, 1 << 3)),
            boots: true,
            behaviour_if_off: true,
        },
    },
};

/// Raw resolution (C-EAM-15), and the revolutions of 6502h.
const SENSOR: Sensor = Sensor {
    steps: 0x1_0000,
    turns: 0x4_0000,
};

const BASE: EncoderProfile = EncoderProfile {
    sensor: Some(SENSOR),
    // U-34.
    unscaled_steps: Some(0x4000),
    // With 4 steps per revolution the range has 2^30 revolutions; half of them are the limit
    // in chapter 4.4.6 for turning without power.
    counter: Counter::Kept { turns: 1 << 30 },
    // 6502h follows 6001h and 6002h (C-EAM-17), and 6002h is 6001h times a power of two (C-EAM-18).
    total: Total::Shown,
    range_rule: RangeRule::PowerOfTwo,
    signed_offset: true,
    // 6002h = 0 means 2^32 steps.
    zero_is_full: true,
    operating_bits: 0x0005,
    // Chapter 4.4.6; C-X-06.
    gear: Some(Gear {
        index: 0x2001,
        on: 2,
        kind: GearKind::Position,
    }),
    objects: &[
        // C-X-16.
        (Address::new(0x1029, 1), Role::OneOf(&[0, 1, 2])),
        (Address::new(0x1029, 2), Role::OneOf(&[0, 1, 2])),
        (Address::new(0x1029, 3), Role::OneOf(&[0, 1, 2])),
        // C-EAM-34.
        (Address::new(0x1F80, 0), Role::OneOf(&[0, 8])),
        (Address::new(0x2001, 1), Role::OneOf(&[1, 2])),
        (Address::new(0x2100, 0), Role::BitRate),
        (Address::new(0x2101, 0), Role::NodeId),
        // Chapter 9.4; C-EAM-12.
        (Address::new(0x2116, 1), Role::InjectedError),
        (Address::new(0x2116, 2), Role::InjectedOffset),
        (Address::new(0x2117, 0), eam_diagnosis::DIAGNOSIS),
        // U-27.
        (Address::new(0x2120, 0), Role::TimeStamp),
        // Chapter 4.4.4.
        (Address::new(0x6030, 1), speed(&[(1, Source::Position)])),
        (Address::new(0x2118, 0), speed(&[(1, Source::Revolutions)])),
        // Chapter 4.4.5; C-EAM-07. 6508h is constant (C-EAM-11).
        (
            Address::new(0x6040, 1),
            Role::Movement(Movement {
                quantity: Quantity::Acceleration,
                selector: Some(Address::new(0x6041, 1)),
                sources: &[(1, Source::Position), (2, Source::Fixed(0x1_0000))],
                interval: Address::new(0x6041, 2),
                factor: Some((Address::new(0x6041, 3), Address::new(0x6041, 4))),
            }),
        ),
    ],
    // C-EAM-04, C-EAM-28.
    links: &[
        (Address::new(0x6003, 0), Address::new(0x6010, 1)),
        (Address::new(0x6509, 0), Address::new(0x650C, 1)),
    ],
    below_limit: AbortCode::ValueRange,
    // C-EAM-33.
    options: Some(OptionObject {
        index: 0x2110,
        ignore_code_sequence: 1 << 0,
        ..OptionObject::NONE
    }),
    bit_rates: &[10, 20, 50, 100, 125, 250, 500, 800, 1000],
    // The device has no switches.
    switch_rates: &[],
    reports: eam_diagnosis::SINGLE,
    // 6504h and 6506h lack some bits that chapter 9.5 sets (C-EAM-09, C-EAM-10).
    by_support: false,
};

/// A speed that is the mean over 4001h.
const fn speed(sources: &'static [(u8, Source)]) -> Role {
    Role::Movement(Movement {
        quantity: Quantity::Speed,
        selector: None,
        sources,
        interval: Address::new(0x4001, 0),
        factor: None,
    })
}

/// Encoder profile of the multiturn encoder: chapters 4.4, 9 and 12.3.
pub static ENCODER: EncoderProfile = BASE;

/// Encoder profile of the singleturn encoder: it counts revolutions while it has power, and the
/// gear uses them (chapter 4.4.6).
pub static SINGLETURN: EncoderProfile = EncoderProfile {
    sensor: Some(Sensor { turns: 1, ..SENSOR }),
    counter: Counter::Volatile,
    ..BASE
};

/// Encoder profile of one channel of the redundant encoder (chapter 9.2).
pub static REDUNDANT: EncoderProfile = EncoderProfile {
    gear: None,
    reports: eam_diagnosis::REDUNDANT,
    ..BASE
};
