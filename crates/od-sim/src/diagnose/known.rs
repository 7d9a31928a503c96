//! What is known besides a log.

use std::prelude::v1::*;

use od_model::Dictionary;

/// What is known besides the log.
#[derive(Clone, Copy, Default)]
pub struct Known<'k> {
    /// Bit rate in kbit/s; `None`: it is estimated from frames that follow each other without a pause.
    pub bit_rate: Option<u16>,
    /// Dictionary of a node, by its EDS.
    pub dictionary: Option<&'k dyn Fn(u8) -> Option<Dictionary<'k>>>,
}
