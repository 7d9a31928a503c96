//! Generates the `match` over an object dictionary that a user of canopen-sdo
//! would write by hand.

use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

#[path = "src/objects.rs"]
#[allow(dead_code, unreachable_pub)] // the crate itself uses more of it
mod objects;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=src/objects.rs");
    let out = env::var_os("OUT_DIR").expect("Cargo sets OUT_DIR");
    let file = Path::new(&out).join("match.rs");
    fs::write(file, hand_written_match()).expect("OUT_DIR is writable");
}

/// One `impl` per size, from an address to the place of its value.
fn hand_written_match() -> String {
    let mut text = String::new();
    for size in objects::SIZES {
        write!(
            text,
            "
impl Find for Values<{size}> {{
    #[inline]
    fn find(&mut self, index: u16, sub: u8) -> Option<&mut u32> {{
        Some(match (index, sub) {{
"
        )
        .expect("a String takes all text");
        for (place, index) in objects::indices(size).into_iter().enumerate() {
            writeln!(
                text,
                "            ({index:#06x}, 0) => &mut self.0[{place}],"
            )
            .expect("a String takes all text");
        }
        text.push_str("            _ => return None,\n        })\n    }\n}\n");
    }
    text
}
