//! Results of the functions: 0, an error of the call, or an SDO abort code.

/// Success.
pub const ODKIT_OK: u32 = 0;
/// A pointer is null.
pub const ODKIT_NULL: u32 = 1;
/// Another call has not returned yet: this call came from an interrupt or a thread, or from a
/// callback in which it is not allowed.
pub const ODKIT_BUSY: u32 = 2;
/// Not possible in this state: the node has no power, or has power already.
pub const ODKIT_STATE: u32 = 3;
/// An argument has an invalid value.
pub const ODKIT_ARGUMENT: u32 = 4;
/// The buffer is too short for the value.
pub const ODKIT_SIZE: u32 = 5;
/// The object has another data type.
pub const ODKIT_TYPE: u32 = 6;

/// The library has no node with this handle.
pub const ODKIT_NO_NODE: u32 = 7;

/// SDO abort code 06060000h: a hardware error.
pub const ODKIT_ABORT_HARDWARE: u32 = 0x0606_0000;
/// SDO abort code 06090030h: the value is not allowed.
pub const ODKIT_ABORT_VALUE: u32 = 0x0609_0030;
/// SDO abort code 06090031h: the value is above the upper limit.
pub const ODKIT_ABORT_TOO_HIGH: u32 = 0x0609_0031;
/// SDO abort code 06090032h: the value is below the lower limit.
pub const ODKIT_ABORT_TOO_LOW: u32 = 0x0609_0032;
/// SDO abort code 08000000h: a general error.
pub const ODKIT_ABORT_GENERAL: u32 = 0x0800_0000;
/// SDO abort code 08000021h: the device does not allow it now (local control).
pub const ODKIT_ABORT_LOCAL: u32 = 0x0800_0021;
/// SDO abort code 08000022h: not in the present state of the device.
pub const ODKIT_ABORT_STATE: u32 = 0x0800_0022;
