//! Installs the tools that odkit's tasks need.

pub(crate) mod apt;
pub(crate) mod binaryen;
pub(crate) mod bindgen;
pub(crate) mod browser;
pub(crate) mod installed;
pub(crate) mod mdbook;
pub(crate) mod node;
pub(crate) mod python;
pub(crate) mod target;
pub(crate) mod toolchain;
