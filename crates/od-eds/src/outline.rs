//! The text of an EDS for a tool that edits it: sections, keys and values with their places, and
//! their descriptions in CiA 306 and CiA 301.

pub use crate::scan::known::{Form, Known, OBJECT_KEYS, SECTIONS, key, section};
pub use crate::scan::lines::sections;
pub use crate::scan::names::{Compact, List, Place, place};
pub use crate::scan::number::{before_comment, number};
pub use crate::scan::placed::{Placed, Text};
pub use crate::standards::cia301::{Specified, data_type, specified};
pub use crate::standards::{meaning, profile_name, profile_objects, profile_types};
