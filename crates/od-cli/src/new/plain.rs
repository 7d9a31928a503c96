//! The crate for the host only.

use super::device::DeviceFile;
use super::origin::Origin;
use super::template::{Template, fill, text};

const FILES: [Template; 7] = [
    ("Cargo.toml", include_str!("template/plain/Cargo.toml.in")),
    (".gitignore", "/target\n"),
    ("README.md", include_str!("template/plain/README.md.in")),
    ("src/lib.rs", include_str!("template/plain/lib.rs.in")),
    ("src/main.rs", include_str!("template/plain/main.rs.in")),
    ("tests/scripts.rs", include_str!("template/scripts.rs.in")),
    (
        "tests/scripts/boot-up.script",
        include_str!("template/boot-up.script.in"),
    ),
];

/// Paths and contents.
pub(super) fn files(name: &str, device: &DeviceFile, origin: &Origin) -> Vec<(String, Vec<u8>)> {
    let mut gaps = device.gaps(name, 500);
    let behaviour = match device.encoder() {
        Some(_) => include_str!("template/plain/encoder.rs.in"),
        None => include_str!("template/plain/behaviour.rs.in"),
    };
    let behaviour = text(behaviour.trim_end(), &gaps);
    let dependencies = [("od-sim", ", features = [\"serve\"]"), ("odkit", "")];
    let dependencies = dependencies.map(|(name, features)| origin.dependency(name, features));
    gaps.extend([
        ("device", behaviour),
        ("dependencies", dependencies.join("\n")),
        ("exclude", origin.exclude().to_owned()),
        ("vendor", origin.about()),
        ("host", name.replace('-', "_").to_ascii_lowercase()),
        ("scripts", String::from("tests/scripts")),
    ]);
    let mut files = fill(&FILES, &gaps);
    files.push((format!("{name}.{}", device.ending), device.bytes.clone()));
    files.extend(origin.files());
    files
}
