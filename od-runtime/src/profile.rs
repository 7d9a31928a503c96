//! What one family does differently from another, as const data.
//!
//! The standard leaves room and manuals use it; the services ask here instead
//! of asking who they are.
//!
//! The structs are not `#[non_exhaustive]`: a family is one `const` literal, which that would
//! forbid. A literal that ends in `..Profile::CIA301` (or in a part of it, such as
//! `..Profile::CIA301.sdo`) still compiles when a field is added.

use od_model::Address;

use od_wire::AbortCode;

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
    /// Segmented upload. Without it a value of more than four bytes cannot be read.
    pub segmented_upload: bool,
    /// Segmented download. Without it the command is unknown.
    pub segmented_download: bool,
    /// Block transfers.
    pub block: bool,
    /// Answer to a value below the object's lower limit.
    pub below_limit: AbortCode,
    /// Answer to reading an entry of 1003h that holds no error; `None`: it reads 0.
    pub unused_error: Option<AbortCode>,
    /// Answer to writing an entry of a mapping while its sub-index 0 is not 0.
    pub mapping_in_use: AbortCode,
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
    /// Object index and bit mask. While all masked bits are set, the node sends only synchronous
    /// TPDOs (types 0–240). `None`: not supported.
    pub sync_only: Option<(u16, u32)>,
}

/// When a restored default acts.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Restore {
    /// At once in RAM, and storage is invalid.
    AtOnce,
    /// After the next reset (CiA 301).
    AfterReset,
}

/// When a write to 1010h is answered.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SaveAnswer {
    /// At once; the device goes on storing in the background.
    AtOnce,
    /// When everything is stored. NMT, PDOs and error control go on meanwhile; a further
    /// SDO request waits.
    AfterStoring,
}

/// Values that the node loads after an interrupted save (power loss or reset).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CutSave {
    /// The last complete set.
    LastSet,
    /// The factory values, whatever was saved before. The record of the device's life stays.
    Factory,
}

/// What a saved value whose default has `$NODEID` in it becomes when the node ID changes.
/// One that was never changed follows the node ID in any case.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SavedCobIds {
    /// It stays as it was written.
    Absolute,
    /// It is kept as the difference to its default, so it moves with the node ID.
    Difference,
}

/// Store and restore (1010h, 1011h).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct StoreProfile {
    /// When 1011h acts.
    pub restore: Restore,
    /// Answer where the storage fails.
    pub failed: AbortCode,
    /// When 1010h is answered.
    pub answer: SaveAnswer,
    /// How long a save takes, in microseconds; 0: it is complete at once. The values are
    /// those of the moment of the command.
    pub duration_us: u32,
    /// What is left of a save that was cut.
    pub cut: CutSave,
    /// COB-IDs of the user after a change of the node ID.
    pub cob_ids: SavedCobIds,
    /// Pairs of saved objects that are one value (1800h:05 and 6200h): what saves or restores
    /// the group of one does so with both.
    pub twins: &'static [[Address; 2]],
}

/// LSS slave (CiA 305).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LssProfile {
    /// LSS is there in NMT state Stopped alone.
    pub stopped_only: bool,
    /// Object of the node ID that the device starts with. [`LssProfile::OWN_NODE_ID`]: no object has
    /// it, the image of the saved values does; then it can be FFh, not configured.
    pub node_id: Address,
    /// Object of the bit rate that the device starts with, or [`LssProfile::OWN_BIT_RATE`].
    pub bit_rate: Address,
    /// Value of `bit_rate` for each index of the LSS bit timing table (0: 1000 kbit/s …
    /// 8: 10 kbit/s); `None`: the device does not have it.
    pub bit_rates: [Option<u8>; 9],
    /// Identify remote slave by ranges (46h–4Bh).
    pub identify_remote: bool,
    /// Identify non-configured remote slave (4Ch).
    pub non_configured: bool,
    /// Fastscan (51h).
    pub fastscan: bool,
    /// Inquire node ID (5Eh).
    pub inquire_node_id: bool,
    /// After 15h the device is silent for two switch delays, and the bit rate changes between
    /// them (CiA 305); else for one, and the bit rate changes at its end.
    pub second_delay: bool,
}

impl LssProfile {
    /// Stands for the node ID of a device without an object for it: index 0000h has no object.
    pub const OWN_NODE_ID: Address = Address::new(0, 1);
    /// Stands for the bit rate of a device without an object for it: its index in the LSS table.
    pub const OWN_BIT_RATE: Address = Address::new(0, 2);

    /// CiA 305 in full, in every NMT state, for a device without objects for node ID and bit rate.
    pub const CIA305: Self = Self {
        stopped_only: false,
        node_id: Self::OWN_NODE_ID,
        bit_rate: Self::OWN_BIT_RATE,
        bit_rates: [
            Some(0),
            Some(1),
            Some(2),
            Some(3),
            Some(4),
            None,
            Some(6),
            Some(7),
            Some(8),
        ],
        identify_remote: true,
        non_configured: true,
        fastscan: true,
        inquire_node_id: true,
        second_delay: true,
    };

    /// Whether the image keeps node ID and bit rate, and not an object each.
    pub const fn is_own(&self) -> bool {
        self.node_id.index == 0
    }
}

/// What NMT reset communication takes back.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CommunicationReset {
    /// 1000h–1FFFh, node ID and bit rate (CiA 301).
    Communication,
    /// Every value that was not saved.
    Everything,
}

/// Network management (CiA 301, chapter 7.2.8).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct NmtProfile {
    /// Time from power-on, and from NMT reset node, until the boot-up message, in microseconds.
    pub reset_node_us: u32,
    /// Duration of NMT reset communication until boot-up, in microseconds.
    pub reset_communication_us: u32,
    /// What NMT reset communication takes back.
    pub reset_communication: CommunicationReset,
    /// Object and bits (1F80h) of which one set makes the device enter Operational by itself
    /// after each boot-up; `None`: it waits for a master.
    pub self_start: Option<(u16, u32)>,
    /// Object and bits of which one set makes NMT reset node begin the NMT state alone anew:
    /// values and errors stay as they are; `None`: it is a reset of the device.
    pub reset_node_light: Option<(u16, u32)>,
}

/// What the device says of an error that a service finds: EMCY code and bits of 1001h.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Notice {
    /// Emergency error code.
    pub code: u16,
    /// Bits of 1001h while it lasts.
    pub register: u8,
}

/// When an EMCY "error reset" (0000h) goes out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ErrorReset {
    /// With each error that goes; 1001h in it says what is left.
    EachError,
    /// When the last error is gone.
    LastError,
}

/// What follows from bus-off.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct BusOffProfile {
    /// Object index and bit mask (2110h). If any masked bit is set, the CAN controller restarts
    /// after bus-off; otherwise the node stays off the bus until a reset or power cycle. `None`:
    /// always restarts.
    pub restart: Option<(u16, u32)>,
    /// Beginning anew is an NMT reset communication, with a boot-up message; else the NMT
    /// state goes on.
    pub boots: bool,
    /// 1029h acts only where the device stays off the bus; else on every bus-off.
    pub behaviour_if_off: bool,
}

/// Errors of the bus, and what all errors lead to (CiA 301, chapters 7.2.7 and 7.5.2.32).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ErrorProfile {
    /// Heartbeat or life guarding failed. It asks for 1029h:01 whatever its bits say.
    pub lost: Notice,
    /// The CAN controller's error counters passed the warning limit; `None`: not reported.
    pub bus_warning: Option<Notice>,
    /// The CAN controller is error passive; `None`: not reported.
    pub bus_passive: Option<Notice>,
    /// Bits of 1001h while the CAN controller is bus-off; nobody can be told by EMCY.
    pub bus_off: u8,
    /// Sent when the node is back from bus-off; `None`: nothing is.
    pub bus_recovered: Option<Notice>,
    /// Received frames were lost; `None`: not reported.
    pub overrun: Option<Notice>,
    /// When an error reset is sent.
    pub reset: ErrorReset,
    /// Which sub-index of 1029h belongs to which bits of 1001h: it acts when one of them
    /// becomes set, and at each entry into Operational while one is. Where several act, the
    /// gravest does: reset node before Stopped before Pre-operational.
    pub behaviour: &'static [(u8, u8)],
    /// 1029h acts in Operational alone; else "Stopped" and "reset node" act in any state.
    pub operational_only: bool,
    /// Bus-off.
    pub off: BusOffProfile,
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
    /// Network management.
    pub nmt: NmtProfile,
    /// Errors.
    pub errors: ErrorProfile,
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
            segmented_upload: true,
            segmented_download: true,
            block: true,
            below_limit: AbortCode::ValueTooLow,
            unused_error: Some(AbortCode::NoData),
            mapping_in_use: AbortCode::SubZeroFirst,
        },
        pdo: PdoProfile {
            tpdo_types: &[(0, 240), (252, 255)],
            event_on_change: true,
            direct_cob_id: false,
            repeat_counter: None,
            sync_only: None,
        },
        store: StoreProfile {
            restore: Restore::AfterReset,
            failed: AbortCode::Hardware,
            answer: SaveAnswer::AfterStoring,
            duration_us: 0,
            cut: CutSave::LastSet,
            cob_ids: SavedCobIds::Absolute,
            twins: &[],
        },
        lss: None,
        guarding_switch: None,
        nmt: NmtProfile {
            reset_node_us: 0,
            reset_communication_us: 0,
            reset_communication: CommunicationReset::Communication,
            self_start: None,
            reset_node_light: None,
        },
        errors: ErrorProfile {
            lost: Notice {
                code: 0x8130,
                register: 0x11,
            },
            bus_warning: None,
            bus_passive: Some(Notice {
                code: 0x8120,
                register: 0x11,
            }),
            bus_off: 0x11,
            bus_recovered: Some(Notice {
                code: 0x8140,
                register: 0x11,
            }),
            overrun: Some(Notice {
                code: 0x8110,
                register: 0x11,
            }),
            reset: ErrorReset::EachError,
            behaviour: &[],
            operational_only: false,
            off: BusOffProfile {
                restart: None,
                boots: false,
                behaviour_if_off: false,
            },
        },
    };
}
