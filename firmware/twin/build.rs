//! Passes the memory layout of the board to the linker.

fn main() {
    let folder = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    println!("cargo::rustc-link-arg-bins=-T{folder}/../board.ld");
    println!("cargo::rerun-if-changed=../board.ld");
}
