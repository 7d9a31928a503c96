//! The layout of packed bytes, as numbers for TypeScript: `playground/web/src/sim/layout.ts`.

use std::{env, fs};

use crate::codec::{CRC, DATA, RECESSIVE, STUFFED, TAG_LEN, TAG_NODE, TAG_OBJECT};
use crate::packed::{self, DISTURBED, EXTENDED, OWN, REMOTE, at};

fn written() -> String {
    let flags = [
        ("EXTENDED", EXTENDED),
        ("REMOTE", REMOTE),
        ("FROM_PAGE", OWN),
        ("DISTURBED", DISTURBED),
    ];
    let offsets = [
        ("time", at::TIME),
        ("id", at::ID),
        ("flags", at::FLAGS),
        ("dlc", at::DLC),
        ("device", at::DEVICE),
        ("data", at::DATA),
    ];
    let bits = [
        ("recessive", RECESSIVE),
        ("stuffed", STUFFED),
        ("part", STUFFED - 1),
        ("crc", CRC),
        ("data", DATA),
    ];
    let flags = flags.map(|(name, bit)| format!("export const {name} = {bit};\n"));
    let offsets = offsets.map(|(name, offset)| format!("  {name}: {offset},\n"));
    let bits = bits.map(|(name, number)| format!("  {name}: {number},\n"));
    format!(
        "// Written by `ODKIT_ACCEPT=1 cargo test -p od-playground`, from playground/src/layout.rs.\n\n\
         /** Bytes of a packed frame (playground/src/packed.rs). */\n\
         export const FRAME_BYTES = {};\n\n\
         /** Its flags. */\n{}\n\
         /** Offsets of its parts; numbers are little endian. */\n\
         export const AT = {{\n{}}} as const;\n\n\
         /** Numbers of each frame in `tags`; of the first a mask for its parts, and the bits below the node ID and the object. */\n\
         export const TAG = {{ length: {TAG_LEN}, mask: {}, node: {TAG_NODE}, object: {TAG_OBJECT} }} as const;\n\n\
         /** Codes of `frameBits` for a bit, and the numbers of two parts of a frame. */\n\
         export const BIT = {{\n{}}} as const;\n",
        packed::LEN,
        flags.concat(),
        offsets.concat(),
        (1u32 << TAG_NODE) - 1,
        bits.concat(),
    )
}

#[test]
fn the_page_has_the_layout_of_this_module() -> std::io::Result<()> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/web/src/sim/layout.ts");
    let written = written();
    if env::var_os("ODKIT_ACCEPT").is_some() {
        fs::write(path, &written)?;
    }
    let there = fs::read_to_string(path)?;
    assert_eq!(there, written, "ODKIT_ACCEPT=1 writes the file again");
    Ok(())
}
