//! Types and constants of the header. Every bit pattern is valid, since C may write any.
// The names are those of C.
#![allow(non_camel_case_types)]

use core::ffi::c_void;

/// Handle of a node: a macro of odkit_objects.h; ODKIT_NODE in a library with one node. Without a
/// node with this handle a function does nothing, and returns ODKIT_NO_NODE or false.
pub type odkit_node = u32;

/// Flag of a frame: its CAN-ID has 29 bits.
pub const ODKIT_EXTENDED: u8 = 1;
/// Flag of a frame: it is a remote frame.
pub const ODKIT_REMOTE: u8 = 2;

/// Classical CAN frame.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct odkit_frame {
    /// Identifier: 11 bits, or 29 with ODKIT_EXTENDED.
    pub id: u32,
    /// ODKIT_EXTENDED, ODKIT_REMOTE, both or 0.
    pub flags: u8,
    /// Data length code, 0 to 8.
    pub len: u8,
    /// Data; the bytes after `len` are 0 in a frame to send.
    pub data: [u8; 8],
}

/// NMT state: Initialisation, or no power.
pub const ODKIT_INITIALISATION: u8 = 0;
/// NMT state: Stopped.
pub const ODKIT_STOPPED: u8 = 4;
/// NMT state: Operational.
pub const ODKIT_OPERATIONAL: u8 = 5;
/// NMT state: Pre-operational.
pub const ODKIT_PRE_OPERATIONAL: u8 = 127;

/// Node ID of a device that waits for LSS to give it one.
pub const ODKIT_UNCONFIGURED: u8 = 255;

/// CAN controller: error active again, no further frames are lost; after bus-off: it can restart.
pub const ODKIT_BUS_ACTIVE: u8 = 0;
/// CAN controller: an error counter passed the warning limit (96).
pub const ODKIT_BUS_WARNING: u8 = 1;
/// CAN controller: error passive.
pub const ODKIT_BUS_PASSIVE: u8 = 2;
/// CAN controller: bus-off.
pub const ODKIT_BUS_OFF: u8 = 3;
/// CAN controller: a received frame was lost.
pub const ODKIT_BUS_OVERRUN: u8 = 4;

/// Reset at power-on: everything in RAM is lost.
pub const ODKIT_RESET_POWER_ON: u8 = 0;
/// NMT reset node: all values are loaded again.
pub const ODKIT_RESET_NODE: u8 = 1;
/// NMT reset communication: 1000h to 1FFFh are loaded again.
pub const ODKIT_RESET_COMMUNICATION: u8 = 2;
/// 1011h restored the default values in RAM.
pub const ODKIT_RESET_DEFAULTS: u8 = 3;

/// A deadline that never comes, as result of the callback `tick`.
pub const ODKIT_NEVER: u32 = 0xFFFF_FFFF;

/// Event: the NMT state changed. `value`: the state.
pub const ODKIT_EVENT_STATE: u8 = 1;
/// Event: a reset. `value`: ODKIT_RESET_POWER_ON to ODKIT_RESET_DEFAULTS; `sub`: the node ID.
pub const ODKIT_EVENT_RESET: u8 = 2;
/// Event: a master wrote the object `index`, `sub`.
pub const ODKIT_EVENT_WRITTEN: u8 = 3;
/// Event: 1010h saved values. `sub`: its sub-index.
pub const ODKIT_EVENT_SAVED: u8 = 4;
/// Event: 1011h restored default values. `sub`: its sub-index.
pub const ODKIT_EVENT_RESTORED: u8 = 5;
/// Event: LSS activated a bit rate. `value`: kbit/s.
pub const ODKIT_EVENT_BIT_RATE: u8 = 6;
/// Event: the memory is not as the last save left it. `value`: ODKIT_STORAGE_PARTIAL and so on.
pub const ODKIT_EVENT_STORAGE: u8 = 7;
/// Event: a save failed. The values saved before it remain.
pub const ODKIT_EVENT_NOT_SAVED: u8 = 8;
/// Event: power loss or a reset interrupted a save. `value`: 1 if the default values were loaded.
pub const ODKIT_EVENT_SAVE_CUT: u8 = 9;
/// Event: the node is bus-off. `value`: 1 if it restarts when the bus allows it.
pub const ODKIT_EVENT_BUS_OFF: u8 = 10;
/// Event: the node returned from bus-off.
pub const ODKIT_EVENT_BUS_ON: u8 = 11;
/// Event: an error began. `value`: its EMCY code.
pub const ODKIT_EVENT_ERROR: u8 = 12;
/// Event: an error ended. `value`: its EMCY code.
pub const ODKIT_EVENT_ERROR_CLEARED: u8 = 13;
/// Event of a later version of odkit.
pub const ODKIT_EVENT_OTHER: u8 = 255;

/// Memory: some saved values fit no object of this dictionary.
pub const ODKIT_STORAGE_PARTIAL: u32 = 1;
/// Memory: the last set was loaded, although bits outside it changed.
pub const ODKIT_STORAGE_FLAWED: u32 = 2;
/// Memory: the last set is damaged; the one before it was loaded.
pub const ODKIT_STORAGE_OLDER: u32 = 3;
/// Memory: its content belongs to another device; default values.
pub const ODKIT_STORAGE_FOREIGN: u32 = 4;
/// Memory: its content cannot be read; default values.
pub const ODKIT_STORAGE_DAMAGED: u32 = 5;

/// Event of the node.
#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct odkit_event {
    /// ODKIT_EVENT_STATE and so on.
    pub kind: u8,
    /// Sub-index, if the kind has one.
    pub sub: u8,
    /// Index, if the kind has one.
    pub index: u16,
    /// Number that the kind describes.
    pub value: u32,
}

/// Non-volatile memory for the values that 1010h saves.
///
/// For EEPROM or FRAM `page` and `word` are 0. For NOR flash `page` is the number of bytes that
/// `erase` erases, and `word` the number of bytes that are written at once, each once after an
/// erasure.
///
/// The callbacks return 0 for success. They may not call functions of odkit.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct odkit_storage {
    /// Number of bytes of the memory, at most 2147483647 (2^31 - 1) and a multiple of `page`; 0: none, and a save fails.
    pub capacity: u32,
    /// Number of bytes of a page of flash; 0 for an EEPROM.
    pub page: u32,
    /// Bytes that are written at once: a power of two up to 32 that divides `page`; 0 means 1.
    pub word: u32,
    /// Fills `to` with `len` bytes from `offset` on.
    pub read: Option<
        unsafe extern "C" fn(context: *mut c_void, offset: u32, to: *mut u8, len: u32) -> i32,
    >,
    /// Writes `len` bytes from `offset` on.
    pub write: Option<
        unsafe extern "C" fn(context: *mut c_void, offset: u32, from: *const u8, len: u32) -> i32,
    >,
    /// Sets the page at `offset` to FFh; needed if `page` is not 0.
    pub erase: Option<unsafe extern "C" fn(context: *mut c_void, offset: u32) -> i32>,
    /// Makes sure that all written bytes survive a power failure; may be null.
    pub flush: Option<unsafe extern "C" fn(context: *mut c_void) -> i32>,
}

/// Behaviour of the device: callbacks, each of which may be null. Set unused fields to 0.
///
/// A callback runs inside the call of odkit that caused it. It may call odkit_get, odkit_set (which
/// does not check limits there), odkit_raise and odkit_clear; other functions return ODKIT_BUSY.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct odkit_device {
    /// First argument of each callback.
    pub context: *mut c_void,
    /// Called when values were loaded; `reset` is ODKIT_RESET_POWER_ON and so on. Set values here
    /// that the firmware knows better than the EDS, such as the serial number.
    pub reset: Option<unsafe extern "C" fn(context: *mut c_void, reset: u8)>,
    /// Returns the node ID of the switches at a reset, 1 to 127; 0: the node keeps its own.
    pub node_id: Option<unsafe extern "C" fn(context: *mut c_void) -> u8>,
    /// Called before an SDO or a PDO reads this value (2000h and above): bring it up to date with
    /// odkit_set. Returns 0, or the abort code of the SDO.
    pub refresh: Option<unsafe extern "C" fn(context: *mut c_void, index: u16, sub: u8) -> u32>,
    /// Called when a master writes this value, which fits the object and its limits. Returns 0, or
    /// the abort code of the SDO; the value then stays unchanged.
    pub validate: Option<
        unsafe extern "C" fn(
            context: *mut c_void,
            index: u16,
            sub: u8,
            value: *const u8,
            len: usize,
        ) -> u32,
    >,
    /// Called when a value was written; odkit_get returns it.
    pub written: Option<unsafe extern "C" fn(context: *mut c_void, index: u16, sub: u8)>,
    /// Acts on time or on odkit_handle_change. Returns the microseconds until its next call;
    /// ODKIT_NEVER: only after a change.
    pub tick: Option<unsafe extern "C" fn(context: *mut c_void) -> u32>,
    /// Memory for saved values.
    pub storage: odkit_storage,
}

impl odkit_storage {
    /// No memory.
    pub(crate) const fn none() -> Self {
        Self {
            capacity: 0,
            page: 0,
            word: 0,
            read: None,
            write: None,
            erase: None,
            flush: None,
        }
    }
}

impl odkit_device {
    /// No behaviour, no memory.
    pub(crate) const fn none() -> Self {
        Self {
            context: core::ptr::null_mut(),
            reset: None,
            node_id: None,
            refresh: None,
            validate: None,
            written: None,
            tick: None,
            storage: odkit_storage::none(),
        }
    }
}
