//! The optical encoder EN580C: multiturn, electronic gear, endless mode.
//!
//! Source: manual 003, chapters 5 to 7, and `docs/MANUALS.md` where the manual contradicts itself
//! or gives no answer. The dictionary defines the objects; the two profiles here define the
//! differences of the device from CiA 301 and CiA 406.

use odkit::Address;
use odkit::encoder::{
    Counter, EncoderProfile, Fault, Gear, GearKind, Movement, Quantity, RangeRule, Report, Role,
    Sensor, Source, Total,
};
use odkit::{
    AbortCode, CommunicationReset, CutSave, EventTimer, LengthRule, LssProfile, NmtProfile,
    PdoProfile, Profile, Restore, SaveAnswer, SavedCobIds, SdoProfile, StoreProfile,
};

#[cfg(feature = "std")]
use odkit::{DeviceKind, kind::Behaviour};

odkit::object_dictionary! {
    /// `EN580C_M`: 24 bits per revolution, of which 6001h allows 21, and 16 bits of revolutions.
    ///
    /// 1018h:04 and 650Bh, the serial number, are 1 unless the host gives another one
    /// (`Encoder::with_serial_number`).
    pub mod en580c {
        eds = "../eds/EN580C.eds";
        profile = cia406;
    }
}

#[cfg(feature = "std")]
pub(crate) const fn kind(name: &'static str, title: &'static str) -> DeviceKind {
    DeviceKind {
        name,
        title,
        family: "en580c",
        // Manual 003 describes no LED.
        leds: false,
        dictionary: en580c::DICTIONARY,
        profile: &PROFILE,
        behaviour: Behaviour::Encoder(&ENCODER),
        channels: 1,
    }
}

/// Deviations of the services from CiA 301: chapter 5.1.
pub static PROFILE: Profile = Profile {
    sdo: SdoProfile {
        // U-37.
        min_dlc: 4,
        // The list of abort codes has one code for both (C-X-17).
        length: LengthRule {
            too_long: Some(AbortCode::Length),
            too_short: AbortCode::Length,
        },
        // Segmented upload (chapter 5.1.3).
        segmented_upload: true,
        segmented_download: false,
        block: false,
        below_limit: AbortCode::ValueTooLow,
        unused_error: Some(AbortCode::NoData),
        // U-19.
        mapping_in_use: AbortCode::DeviceState,
    },
    pdo: PdoProfile {
        // Chapter 5.1.4.1.
        tpdo_types: &[(1, 240), (254, 255)],
        event_on_change: false,
        // Chapter 5.1.4.1: 1800h:05 is the time between two PDOs.
        event_timer: EventTimer::Cyclic,
        // Chapter 5.1.4.2: at once.
        direct_cob_id: true,
        repeat_counter: None,
        sync_only: None,
    },
    store: StoreProfile {
        // C-EN-05.
        restore: Restore::AfterReset,
        failed: AbortCode::Hardware,
        // Chapter 5.1.3.1: within a second, in the background.
        answer: SaveAnswer::AtOnce,
        duration_us: 500_000,
        // U-33.
        cut: CutSave::Factory,
        // Chapters 5.1.4.2 and 5.2.2.
        cob_ids: SavedCobIds::Absolute,
        twins: &[],
        ..Profile::CIA301.store
    },
    // Chapter 5.1.8; 10 and 20 kbit/s are not supported (C-EN-19).
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
            None,
            None,
        ],
        identify_remote: false,
        non_configured: false,
        fastscan: true,
        inquire_node_id: true,
        // C-EN-18.
        second_delay: true,
        shows_state: true,
    }),
    guarding_switch: None,
    nmt: NmtProfile {
        // Chapters 5.1.5.1 and 5.1.5.2: less than a second for both.
        reset_node_us: 500_000,
        reset_communication_us: 500_000,
        // Both chapters: every value that was not saved is lost.
        reset_communication: CommunicationReset::Everything,
        // C-EAM-34.
        self_start: Some((0x1F80, 1 << 3)),
        reset_node_light: None,
    },
    // Chapter 5.2; codes and bits of the bus cover (U-08, U-09, U-38).
    errors: crate::bus_cover::ERRORS,
};

/// Encoder profile: chapters 5.1.12, 5.2 and 6.
pub static ENCODER: EncoderProfile = EncoderProfile {
    // 6501h says 2^24, of which 21 bits are used (C-EN-06, C-EN-07).
    sensor: Some(Sensor {
        steps: 0x20_0000,
        turns: 0x1_0000,
    }),
    // Chapter 6.11: half of 16 bits of revolutions in either direction without power.
    counter: Counter::Kept { turns: 0x1_0000 },
    total: Total::Revolutions,
    range_rule: RangeRule::Turns,
    signed_offset: true,
    zero_is_full: false,
    operating_bits: 0x0005,
    // Chapter 6.6; C-EN-04, C-EN-09.
    gear: Some(Gear {
        index: 0x2001,
        on: 1,
        kind: GearKind::Output,
    }),
    objects: &[
        // C-X-16.
        (Address::new(0x1029, 1), Role::OneOf(&[0, 1, 2])),
        (Address::new(0x1029, 2), Role::OneOf(&[0, 1, 2])),
        (Address::new(0x1029, 3), Role::OneOf(&[0, 1, 2])),
        (Address::new(0x1F80, 0), Role::OneOf(&[0, 8])),
        (Address::new(0x2001, 1), Role::OneOf(&[0, 1])),
        (Address::new(0x2100, 0), Role::BitRate),
        (Address::new(0x2101, 0), Role::NodeId),
        (Address::new(0x2A00, 1), Role::SecondsSinceStart),
        (Address::new(0x2A00, 2), Role::Seconds),
        (Address::new(0x2A01, 0), Role::Cycles),
        (Address::new(0x600C, 0), Role::RawPosition),
        // Chapters 6.2 to 6.5.
        (
            Address::new(0x6030, 1),
            Role::Movement(Movement {
                quantity: Quantity::Speed,
                selector: Some(Address::new(0x6031, 1)),
                sources: SOURCES,
                interval: Address::new(0x6031, 2),
                factor: Some((Address::new(0x6031, 3), Address::new(0x6031, 4))),
            }),
        ),
        (
            Address::new(0x6040, 1),
            Role::Movement(Movement {
                quantity: Quantity::Acceleration,
                selector: Some(Address::new(0x6041, 1)),
                sources: SOURCES,
                interval: Address::new(0x6041, 2),
                factor: Some((Address::new(0x6041, 3), Address::new(0x6041, 4))),
            }),
        ),
        // The manual does not say from when the object counts (C-X-09); in CiA 406 it counts over
        // the life of the encoder.
        (Address::new(0x6508, 0), Role::TenthHours),
    ],
    below_limit: AbortCode::ValueTooLow,
    options: None,
    bit_rates: &[0, 0, 50, 100, 125, 250, 500, 800, 1000],
    // C-EN-29: the table of the bus cover, without bit rates that the device does not support.
    switch_rates: &[0, 0, 50, 125, 250, 500, 800, 1000],
    // Codes and bits of the bus cover (U-09, U-08).
    reports: &[
        Report {
            fault: Fault::Position,
            code: 0x7320,
            register: 0x81,
            alarm: 0x0001,
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

/// Sources for 6031h:01 and 6041h:01.
const SOURCES: &[(u8, Source)] = &[(1, Source::Position), (2, Source::Raw)];
