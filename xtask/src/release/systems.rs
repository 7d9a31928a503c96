//! The systems that the command line is built for.

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
