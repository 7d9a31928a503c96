//! odkit.
fn main() {}
