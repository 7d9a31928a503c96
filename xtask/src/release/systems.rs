//! The systems that the command line and the Python package are built for.

/// A system, its name in file names, and the linker of its programs with Debian's package of it, unless rustc
/// can link them itself: `rust-lld` comes with rustc.
pub(super) struct System {
    pub(super) triple: &'static str,
    pub(super) ending: &'static str,
    pub(super) linker: Option<(&'static str, Option<&'static str>)>,
}

/// The linker of programs for Windows, and Debian's package of it.
pub(super) const MINGW: (&str, &str) = ("x86_64-w64-mingw32-gcc", "gcc-mingw-w64-x86-64");

#[rustfmt::skip]
pub(super) const SYSTEMS: [System; 3] = [
    System { triple: "x86_64-unknown-linux-musl", ending: "", linker: None },
    System { triple: "aarch64-unknown-linux-musl", ending: "", linker: Some(("rust-lld", None)) },
    System {
        triple: "x86_64-pc-windows-gnu",
        ending: ".exe",
        linker: Some((MINGW.0, Some(MINGW.1))),
    },
];

/// The systems of the wheels, and the oldest one of each that may load the module. zig links for an old libc, and a wheel that needs
/// more is an error of maturin; a wheel for Windows has no such promise. A Mac builds the sources: its linker needs
/// files of Apple.
pub(super) const WHEELS: [(&str, Option<&str>); 5] = [
    ("x86_64-unknown-linux-gnu", Some("manylinux2014")),
    ("aarch64-unknown-linux-gnu", Some("manylinux2014")),
    ("x86_64-unknown-linux-musl", Some("musllinux_1_2")),
    ("aarch64-unknown-linux-musl", Some("musllinux_1_2")),
    ("x86_64-pc-windows-gnu", None),
];

#[cfg(test)]
mod tests {
    use super::SYSTEMS;

    /// `cargo binstall` finds the files by the names that crates/od-cli/Cargo.toml says.
    #[test]
    fn binstall_knows_the_files_of_each_system() {
        let manifest = include_str!("../../../crates/od-cli/Cargo.toml");
        let made = "odkit-{ version }-{ target }{ binary-ext }\"";
        assert!(manifest.contains(made));
        for system in SYSTEMS {
            let name = format!("/odkit-{{ version }}-{}{}\"", system.triple, system.ending);
            assert!(manifest.contains(&name), "{name}");
        }
    }
}
