//! Empty: only the `main.rs` of wasm-pack uses `human-panic`.
