//! Sizes and marks of a bank; [`image`](super) has the table.

/// The longest value that is saved, in bytes.
pub const MAX_VALUE: usize = 1024;

/// Bytes of a bank's header.
pub(super) const HEADER: usize = 20;
/// Bytes of a record before its value.
pub(super) const RECORD: usize = 5;
/// Index of the records that are no object's: node ID (sub-index 1) and bit rate (2) of LSS.
pub(super) const OWN: u16 = 0;
/// No byte of it is one flipped bit away from 00h or FFh.
pub(super) const MAGIC: [u8; 4] = *b"\x69odk";
/// First byte of the magic of a set that a save is about to replace, where a save that is cut
/// leaves nothing.
pub(super) const REPLACED: u8 = 0x96;
/// Version of the layout.
pub(super) const VERSION: u16 = 1;
