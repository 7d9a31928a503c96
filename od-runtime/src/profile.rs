//! What one family does differently from another, as const data.
//!
//! The standard leaves room and manuals use it; the services ask here instead
//! of asking who they are.

use od_model::Address;

use crate::AbortCode;

/// What a device does with an SDO download whose length is not the object's.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LengthRule {
    /// Answer to too much data; `None`: the low bytes are taken.
    pub too_long: Option<AbortCode>,
    /// Answer to too little data.
    pub too_short: AbortCode,
}

/// SDO server (CiA 301, chapter 7.2.4).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SdoProfile {
    /// Shortest request that is looked at, 4–8 bytes; missing data bytes do not count as given.
    pub min_dlc: u8,
    /// Downloads of the wrong length.
    pub length: LengthRule,
    /// Segmented transfers.
    pub segmented: bool,
    /// Block transfers.
    pub block: bool,
    /// Answer to a value below the object's lower limit.
    pub below_limit: AbortCode,
    /// Answer to reading an entry of 1003h that holds no error; `None`: it reads 0.
    pub unused_error: Option<AbortCode>,
}

/// Process data (CiA 301, chapter 7.2.2).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PdoProfile {
    /// Transmission types that 1800h:02 takes, as inclusive ranges.
    pub tpdo_types: &'static [(u8, u8)],
    /// Types 254 and 255 send when a mapped value changes; else by the event timer alone.
    pub event_on_change: bool,
    /// A COB-ID can be changed while the PDO is valid. CiA 301 wants bit 31 set first.
    pub direct_cob_id: bool,
    /// First index of the repeat counters (2800h of the bus-cover family), one for each TPDO.
    pub repeat_counter: Option<u16>,
}

/// When a restored default acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Restore {
    /// At once in RAM, and storage is invalid.
    AtOnce,
    /// After the next reset (CiA 301).
    AfterReset,
}

/// Store and restore (1010h, 1011h).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct StoreProfile {
    /// When 1011h acts.
    pub restore: Restore,
    /// Answer where the storage fails.
    pub failed: AbortCode,
}

/// LSS slave (CiA 305).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LssProfile {
    /// LSS is there in NMT state Stopped alone.
    pub stopped_only: bool,
    /// Object of the node ID that the device starts with.
    pub node_id: Address,
    /// Object of the bit rate that the device starts with.
    pub bit_rate: Address,
    /// What `bit_rate` is for each index of the LSS bit timing table (0: 1000 kbit/s …
    /// 8: 10 kbit/s); `None`: the device does not have it.
    pub bit_rates: &'static [Option<u8>],
    /// Identify remote slave by ranges (46h–4Bh).
    pub identify_remote: bool,
    /// Identify non-configured remote slave (4Ch).
    pub non_configured: bool,
    /// Fastscan (51h).
    pub fastscan: bool,
    /// Inquire node ID (5Eh).
    pub inquire_node_id: bool,
}

/// What the services of a node need to know of its family.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Profile {
    /// SDO server.
    pub sdo: SdoProfile,
    /// Process data.
    pub pdo: PdoProfile,
    /// Store and restore.
    pub store: StoreProfile,
    /// LSS slave; `None`: the device has none.
    pub lss: Option<LssProfile>,
    /// Object and bits that switch from heartbeat to node guarding; `None`: CiA 301, where
    /// 1017h decides.
    pub guarding_switch: Option<(u16, u32)>,
    /// Duration of NMT reset node until boot-up, in microseconds.
    pub reset_node_us: u32,
    /// Duration of NMT reset communication until boot-up, in microseconds.
    pub reset_communication_us: u32,
}

impl Profile {
    /// CiA 301 to the letter, with every service: what a device of an unknown EDS gets.
    pub const CIA301: Self = Self {
        sdo: SdoProfile {
            min_dlc: 8,
            length: LengthRule {
                too_long: Some(AbortCode::TooLong),
                too_short: AbortCode::TooShort,
            },
            segmented: true,
            block: true,
            below_limit: AbortCode::ValueTooLow,
            unused_error: Some(AbortCode::NoData),
        },
        pdo: PdoProfile {
            tpdo_types: &[(0, 240), (252, 255)],
            event_on_change: true,
            direct_cob_id: false,
            repeat_counter: None,
        },
        store: StoreProfile {
            restore: Restore::AfterReset,
            failed: AbortCode::Hardware,
        },
        lss: None,
        guarding_switch: None,
        reset_node_us: 0,
        reset_communication_us: 0,
    };
}
