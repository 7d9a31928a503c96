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
mod write;

pub use crate::rules::network::{
    key_twice, misspelled_key, no_sync, not_mappable, read_only, text_of_flag, unfit_values,
    unusual_bit_rate,
};
pub use concise::{Write, bytes};
pub use configure::{Configuration, ProjectSettings, Unfit, configure};
pub use dcf::dcf;
pub use list::{NodeList, node_lists};
pub use load::{BIT_RATES, Frame, Trigger, frame_bits, frames, load};
pub use master::{Master, consume_heartbeats, writes};
pub use node::{Node, Setting};
pub use pdo::PdoConfiguration;
pub use report::check;
pub use saved::saved;
