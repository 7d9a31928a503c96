//! Reads the sections of a text as a [`Description`](crate::Description).

mod compact;
mod compact_pdo;
pub(crate) mod configured;
mod entry;
pub(crate) mod fields;
mod lists;
pub(crate) mod modules;
mod object;
mod other;
mod own_types;
pub(crate) mod sorted;
pub(crate) mod values;
mod words;
