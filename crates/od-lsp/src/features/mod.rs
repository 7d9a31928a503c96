//! Requests of an editor: one file for each feature.

pub(crate) mod actions;
pub(crate) mod complete;
pub(crate) mod diagnostics;
pub(crate) mod folding;
pub(crate) mod format;
pub(crate) mod hints;
pub(crate) mod hover;
pub(crate) mod jump;
pub(crate) mod rename;
pub(crate) mod symbols;
pub(crate) mod tokens;
