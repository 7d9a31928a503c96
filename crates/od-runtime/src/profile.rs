//! Options and deviations of a device family relative to CiA 301, as const data.
//!
//! CiA 301 leaves options open, and manuals use them. The services read the profile and have no
//! code for a family.
//!
//! The structs are not `#[non_exhaustive]`, since a family is one `const` literal. A literal that
//! ends in `..Profile::CIA301` (or in a part of it, such as `..Profile::CIA301.sdo`) still compiles
//! when a field is added.

use od_model::Address;
use od_model::row::Row;
use od_wire::{AbortCode, NodeId};

use crate::store::Store;

/// Response to an SDO download whose length is not that of the object.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LengthRule {
    /// Abort code for too much data; `None`: the node accepts the low bytes.
    pub too_long: Option<AbortCode>,
    /// Abort code for too little data.
    pub too_short: AbortCode,
}

/// Options of the SDO server (CiA 301, chapter 7.2.4).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct SdoProfile {
    /// DLC of the shortest request that the server answers, 4 to 8; a shorter one is ignored. Missing
    /// data bytes are not a part of the value.
    pub min_dlc: u8,
    /// Response to downloads of the wrong length.
    pub length: LengthRule,
    /// Segmented upload is supported. Otherwise a value of more than four bytes cannot be read
    /// (06010000h).
    pub segmented_upload: bool,
    /// Segmented download is supported. Otherwise the command is unknown (05040001h).
    pub segmented_download: bool,
    /// Block transfers are supported. Otherwise their commands are unknown (05040001h).
    pub block: bool,
    /// Abort code for a value below the lower limit of the object.
    pub below_limit: AbortCode,
    /// Abort code for an upload of a sub-index of 1003h that holds no error; `None`: it reads 0.
    pub unused_error: Option<AbortCode>,
    /// Abort code for a download of a mapping entry while sub-index 0 is not 0.
    pub mapping_in_use: AbortCode,
}

/// Options of the PDOs (CiA 301, chapter 7.2.2).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct PdoProfile {
    /// Transmission types that 1800h:02 accepts, as inclusive ranges; others abort with 06090030h.
    pub tpdo_types: &'static [(u8, u8)],
    /// Types 254 and 255 send when a mapped value changes; otherwise by the event timer only.
    pub event_on_change: bool,
    /// Restart of the event timer of types 254 and 255.
    pub event_timer: EventTimer,
    /// A COB-ID can be changed while the PDO is valid. In CiA 301 bit 31 has to be set first
    /// (chapters 7.5.2.35 and 7.5.2.37).
    pub direct_cob_id: bool,
    /// Index of the first repeat counter (2800h of the bus-cover family), one for each TPDO.
    /// `None`: not supported.
    pub repeat_counter: Option<u16>,
    /// Object index and bit mask. While all masked bits are set, the node sends only synchronous
    /// TPDOs (types 0–240). `None`: not supported.
    pub sync_only: Option<(u16, u32)>,
}

/// Restart of the event timer of an event-driven TPDO (1800h:05).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum EventTimer {
    /// With each transmission: the PDO is sent when the time has elapsed without an event (CiA 301, chapter
    /// 7.2.2.3).
    SinceTransmission,
    /// Never: the PDO is sent on a fixed grid, even if something else sent it in between.
    Cyclic,
}

/// Time when a restored default applies (1011h).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Restore {
    /// At once, in RAM and in storage.
    AtOnce,
    /// After the next reset (CiA 301).
    AfterReset,
}

/// Time of the response to a download of 1010h.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SaveAnswer {
    /// At once; the device stores in the background.
    AtOnce,
    /// After everything is stored. Until then NMT, PDOs and error control continue, and a further
    /// SDO request waits.
    AfterStoring,
}

/// Values that the node loads after an interrupted save (power loss or reset).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CutSave {
    /// The last complete set.
    LastSet,
    /// The factory values replace all saved ones. The operating records stay.
    Factory,
}

/// Value of a saved COB-ID after a change of the node ID, if its default depends on `$NODEID`. A
/// COB-ID that was never changed always follows the node ID.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SavedCobIds {
    /// As written.
    Absolute,
    /// Saved as the difference to its default: it changes with the node ID.
    Difference,
}

/// Options of saving and restoring (CiA 301, objects 1010h and 1011h).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct StoreProfile {
    /// Time when a restored default applies.
    pub restore: Restore,
    /// Abort code if the storage fails.
    pub failed: AbortCode,
    /// Time of the response to 1010h.
    pub answer: SaveAnswer,
    /// Duration of a save in microseconds; 0: it is complete at once. The node saves the values at
    /// the moment of the command.
    pub duration_us: u32,
    /// Values after an interrupted save.
    pub cut: CutSave,
    /// Saved COB-IDs after a change of the node ID.
    pub cob_ids: SavedCobIds,
    /// Pairs of saved objects with one value (1800h:05 and 6200h): saving or restoring the group
    /// of one includes the other.
    pub twins: &'static [[Address; 2]],
    /// Object and value that replaces its default: the node ID with which this device was
    /// delivered. `None`: the default of the dictionary.
    pub node_id: Option<(Address, NodeId)>,
}

impl StoreProfile {
    /// Resets every value for which `which` is true to the value that the device was delivered
    /// with.
    pub fn reset(&self, store: &mut Store<'_>, which: &dyn Fn(&Row) -> bool) {
        store.reset(which);
        if let Some((address, node_id)) = self.node_id
            && let Some(row) = store.dictionary().row_at(address)
            && which(row)
        {
            // The value must be an UNSIGNED8; otherwise the dictionary's own default stays.
            let _ = store.put_row(row, &[node_id.raw()]);
        }
    }
}

/// Options of the LSS slave (CiA 305).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct LssProfile {
    /// LSS works only in NMT state Stopped.
    pub stopped_only: bool,
    /// Address of the node ID for the next start. [`LssProfile::OWN_NODE_ID`]: there is no such
    /// object, and the image of the saved values contains the node ID; then it can be FFh, not
    /// configured.
    pub node_id: Address,
    /// Address of the bit rate for the next start, or [`LssProfile::OWN_BIT_RATE`].
    pub bit_rate: Address,
    /// Values of `bit_rate` by the index of the LSS bit timing table (0: 1000 kbit/s to
    /// 8: 10 kbit/s); `None`: not supported.
    pub bit_rates: [Option<u8>; 9],
    /// Identify remote slave (46h to 4Bh) is supported.
    pub identify_remote: bool,
    /// Identify non-configured remote slave (4Ch) is supported.
    pub non_configured: bool,
    /// Fastscan (51h) is supported.
    pub fastscan: bool,
    /// Inquire node ID (5Eh) is supported.
    pub inquire_node_id: bool,
    /// After 15h the device is silent for two switch delays, and the bit rate changes between
    /// them (CiA 305); otherwise for one, and the bit rate changes at its end.
    pub second_delay: bool,
    /// Byte 1 of the response to switch state selective (44h) is the state, 01h; CiA 305 reserves it.
    pub shows_state: bool,
}

impl LssProfile {
    /// Address of the node ID of a device without an object for it: index 0000h has no object.
    pub const OWN_NODE_ID: Address = Address::new(0, 1);
    /// Address of the bit rate of a device without an object for it: its index in the LSS table.
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
        shows_state: false,
    };

    /// Returns whether the image contains node ID and bit rate, and not objects.
    pub const fn is_own(&self) -> bool {
        self.node_id.index == 0
    }
}

/// Values that NMT reset communication resets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum CommunicationReset {
    /// 1000h–1FFFh, node ID and bit rate (CiA 301).
    Communication,
    /// Every value that was not saved.
    Everything,
}

/// Options of the NMT slave (CiA 301, chapter 7.2.8).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct NmtProfile {
    /// Time from power-on, and from NMT reset node, until the boot-up message, in microseconds.
    pub reset_node_us: u32,
    /// Time from NMT reset communication until the boot-up message, in microseconds.
    pub reset_communication_us: u32,
    /// Values that NMT reset communication resets.
    pub reset_communication: CommunicationReset,
    /// Object index and bit mask (1F80h). If any masked bit is set, the node enters Operational
    /// after each boot-up. `None`: it waits for a master.
    pub self_start: Option<(u16, u32)>,
    /// Object index and bit mask. If any masked bit is set, NMT reset node restarts only the NMT
    /// state: values and errors stay. `None`: it resets the device.
    pub reset_node_light: Option<(u16, u32)>,
}

/// Report of an error that a service finds: EMCY code and bits of 1001h.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Notice {
    /// Emergency error code.
    pub code: u16,
    /// Bits of 1001h that it sets while it lasts.
    pub register: u8,
}

/// Time when the node sends an EMCY message with code 0000h (error reset).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum ErrorReset {
    /// With each error that ends; its error register shows the others.
    EachError,
    /// Only when the last error ends.
    LastError,
}

/// Options of bus-off.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct BusOffProfile {
    /// Object index and bit mask (2110h). If any masked bit is set, the CAN controller restarts
    /// after bus-off; otherwise the node stays off the bus until a reset or power cycle. `None`:
    /// always restarts.
    pub restart: Option<(u16, u32)>,
    /// A restart is an NMT reset communication, with a boot-up message; otherwise the NMT state
    /// stays.
    pub boots: bool,
    /// 1029h acts only if the node stays off the bus; otherwise on every bus-off.
    pub behaviour_if_off: bool,
}

/// Errors of the bus, and the reaction to errors (CiA 301, chapters 7.2.7 and 7.5.2.32).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct ErrorProfile {
    /// Report of a failed heartbeat or life guarding. 1029h:01 acts independently of the bits.
    pub lost: Notice,
    /// Report of an error counter beyond the warning limit (96); `None`: not reported.
    pub bus_warning: Option<Notice>,
    /// Report of the state error passive; `None`: not reported.
    pub bus_passive: Option<Notice>,
    /// Bits of 1001h while the CAN controller is bus-off, without an EMCY message.
    pub bus_off: u8,
    /// EMCY message after bus-off; `None`: not sent.
    pub bus_recovered: Option<Notice>,
    /// A SYNC whose length is not that of 1019h is reported (EMCY 8240h).
    pub watches_sync_length: bool,
    /// Report of received frames that were lost; `None`: not reported.
    pub overrun: Option<Notice>,
    /// Time of the EMCY message for error reset.
    pub reset: ErrorReset,
    /// Pairs of bits of 1001h and the sub-index of 1029h. The sub-index acts when one of the bits
    /// becomes set, and when the node enters Operational while one is set. If several act, the
    /// order is reset node, Stopped, Pre-operational.
    pub behaviour: &'static [(u8, u8)],
    /// 1029h acts only in Operational; otherwise "Stopped" and "reset node" act in any state.
    pub operational_only: bool,
    /// Reaction to bus-off.
    pub off: BusOffProfile,
}

/// Options and deviations of a device family relative to CiA 301, for all services.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Profile {
    /// Options of the SDO server.
    pub sdo: SdoProfile,
    /// Options of the PDOs.
    pub pdo: PdoProfile,
    /// Options of saving and restoring.
    pub store: StoreProfile,
    /// Options of the LSS slave; `None`: not supported.
    pub lss: Option<LssProfile>,
    /// Object index and bit mask. If any masked bit is set, node guarding replaces heartbeat.
    /// `None`: node guarding while 1017h is 0 (CiA 301, chapter 7.2.8.3.2).
    pub guarding_switch: Option<(u16, u32)>,
    /// Options of the NMT slave.
    pub nmt: NmtProfile,
    /// Errors and the reaction to them.
    pub errors: ErrorProfile,
}

impl Profile {
    /// CiA 301 without deviations, with all services except LSS: the profile of a device of an
    /// unknown EDS.
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
            event_timer: EventTimer::SinceTransmission,
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
            node_id: None,
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
            watches_sync_length: true,
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
