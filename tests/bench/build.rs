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
impl Find for Values<{}> {{
    #[inline]
    fn find(&mut self, index: u16, sub: u8) -> Option<Place<'_>> {{
        Some(Place::Value(match (index, sub) {{
",
            objects::values(size)
        )
        .expect("a String takes all text");
        let mut place = 0;
        for object in objects::objects(size) {
            let index = object.index;
            if object.is_record {
                let count = objects::MEMBERS;
                writeln!(
                    text,
                    "            ({index:#06x}, 0) => return Some(Place::Count({count})),"
                )
                .expect("a String takes all text");
            }
            for sub in object.subs() {
                writeln!(
                    text,
                    "            ({index:#06x}, {sub}) => &mut self.0[{place}],"
                )
                .expect("a String takes all text");
                place += 1;
            }
        }
        text.push_str("            _ => return None,\n        }))\n    }\n}\n");
    }
    text
}
