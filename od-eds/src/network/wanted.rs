//! Settings of one PDO in a project.

use alloc::vec::Vec;

use od_model::Address;

/// Settings of one PDO in a project; `None` leaves the value of the device.
#[derive(Clone, PartialEq, Debug, Default)]
#[allow(missing_docs)] // the names of CiA 301
pub struct PdoConfiguration {
    /// `Some(None)`: one is chosen.
    pub cob_id: Option<Option<u32>>,
    pub transmission: Option<u32>,
    pub inhibit_time: Option<u32>,
    pub event_timer: Option<u32>,
    /// The event timer of an RPDO.
    pub event_deadline: Option<u32>,
    pub sync_start: Option<u32>,
    pub mapping: Option<Vec<Address>>,
    /// Is the PDO valid in the end?
    pub enabled: bool,
}
