//! A network of nodes: the concise DCF of each node (1F22h, CiA 302-3), the DCF of its master, and
//! contradictions between the nodes.
//!
//! The order of the writes and the objects of the master follow dcfgen (dcf-tools), so that a
//! master of Lely core boots the network.

mod concise;
mod configure;
mod dcf;
pub mod keys;
mod list;
mod load;
mod master;
pub(crate) mod node;
mod objects;
mod partners;
mod pdo;
mod report;
mod saved;
pub(crate) mod write;

pub use crate::rules::network::project::{
    key_twice, misspelled_key, no_pdo, no_sync, not_a_number, not_mappable, read_only,
    text_of_flag, unfit, unfit_values, unusual_bit_rate,
};
pub use crate::rules::network::reading::{missing_key, missing_section, unreadable, unusable_file};
pub use concise::{Write, bytes};
pub use configure::{Configuration, ProjectSettings, configure};
pub use dcf::dcf;
pub use list::{NodeList, node_lists};
pub use load::{BIT_RATES, Frame, Trigger, frame_bits, frames, load};
pub use master::{Master, consume_heartbeat, writes};
pub use node::{Node, Setting};
pub use pdo::PdoConfiguration;
pub use report::check;
pub use saved::saved;
pub use write::Unfit;
