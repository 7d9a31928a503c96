//! Flags of rustc.

use std::env;
use std::path::Path;

use crate::console::ask_in;

/// Flags for `CARGO_ENCODED_RUSTFLAGS` that make paths in messages independent of the build folder.
pub(crate) fn without_paths(root: &Path) -> String {
    let home = |name: &str, place: &str| {
        let path =
            env::var(name).or_else(|_| env::var("HOME").map(|home| format!("{home}/{place}")));
        path.unwrap_or_default()
    };
    let sysroot = ask_in(root, "rustc", &["--print", "sysroot"]).unwrap_or_default();
    [
        (root.display().to_string(), "odkit"),
        (home("CARGO_HOME", ".cargo"), "cargo"),
        (sysroot, "rust"),
    ]
    .iter()
    .filter(|(path, _)| !path.is_empty())
    .map(|(path, name)| format!("--remap-path-prefix={path}={name}"))
    .collect::<Vec<_>>()
    .join("\u{1f}")
}
