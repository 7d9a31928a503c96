//! Generates one zencan dictionary per size, in the way its users do.

use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;
use std::{env, fs};

use zencan_common::device_config::DeviceConfig;

#[path = "../src/objects.rs"]
#[allow(dead_code, unreachable_pub)] // shared with od-benches, which uses more of it
mod objects;

/// From here on a dictionary is large.
const LARGE: usize = 1_000;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-changed=../src/objects.rs");
    let out = env::var_os("OUT_DIR").expect("Cargo sets OUT_DIR");
    let out = Path::new(&out);
    // The large ones take a minute of rustc: only for builds that measure.
    println!("cargo::rustc-check-cfg=cfg(large)");
    let large = env::var("PROFILE").is_ok_and(|profile| profile == "release");
    if large {
        println!("cargo::rustc-cfg=large");
    }
    let wanted = |size: &usize| large || *size < LARGE;
    for size in objects::SIZES.into_iter().filter(wanted) {
        let code = generate(&device_config(size))
            .unwrap_or_else(|error| panic!("zencan-build refuses {size} objects: {error}"));
        fs::write(out.join(format!("zencan_{size}.rs")), code).expect("OUT_DIR is writable");
    }
}

/// Does the work of `zencan_build::compile_device_config`, but without pretty-printing the
/// result, which takes half a minute for 5,000 objects. It breaks lines, because clippy takes four
/// minutes for a single line of 8 MB.
fn generate(config: &str) -> Result<String, Box<dyn Error>> {
    let config = DeviceConfig::load_from_str(config)?;
    let code = zencan_build::device_config_to_string(&config, false)?;
    Ok(code.replace("} ", "}\n").replace("; ", ";\n"))
}

/// A device configuration with one TPDO on SYNC and `size` U32 objects.
fn device_config(size: usize) -> String {
    let mapped = objects::mapped(size);
    let mut text = format!(
        r#"device_name = "bench"
software_version = "1"
hardware_version = "1"
heartbeat_period = 0

[identity]
vendor_id = 1
product_code = 2
revision_number = 3

[pdos]
num_rpdo = 0
num_tpdo = 1

[pdos.tpdo.0]
enabled = true
cob_id = 0x180
add_node_id = true
transmission_type = 1
mappings = [{{ index = {mapped:#x}, sub = 0, size = 32 }}]
"#
    );
    for object in objects::objects(size) {
        let index = object.index;
        let kind = if object.is_record { "record" } else { "var" };
        write!(
            text,
            r#"
[[objects]]
index = {index:#x}
parameter_name = "Object {index:x}"
object_type = "{kind}"
"#
        )
        .expect("a String takes all text");
        for sub in object.subs() {
            if object.is_record {
                write!(
                    text,
                    r#"[[objects.subs]]
sub_index = {sub}
parameter_name = "Member {sub}"
"#
                )
                .expect("a String takes all text");
            }
            let value = objects::value(index, sub);
            write!(
                text,
                r#"data_type = "uint32"
access_type = "rw"
default_value = {value}
pdo_mapping = "tpdo"
"#
            )
            .expect("a String takes all text");
        }
    }
    text
}
