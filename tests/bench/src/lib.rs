//! odkit.
