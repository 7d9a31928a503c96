//! Names of crates.

use std::path::Path;

/// Names that a crate or its program cannot have, or that have another meaning in code that uses the crate.
const TAKEN: [&str; 24] = [
    "test",
    "core",
    "std",
    "alloc",
    "proc_macro",
    "odkit",
    "dictionary",
    "build",
    "deps",
    "examples",
    "incremental",
    "main",
    "board",
    "sensor",
    "cortex_m",
    "cortex_m_rt",
    "embedded_can",
    "embedded_hal_bus",
    "mcp25xx",
    "nb",
    "panic_halt",
    "portable_atomic",
    "static_cell",
    "nul",
];

/// The crates of odkit and embassy.
const FAMILIES: [&str; 2] = ["od_", "embassy_"];

/// Checks that a crate can have this name.
///
/// # Errors
/// A sentence with the reason.
pub(super) fn check(name: &str) -> Result<(), String> {
    let starts = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    // The library has the name in lower case.
    let identifier = name.replace('-', "_").to_ascii_lowercase();
    if !starts || !name.chars().all(fits) || name.len() > 64 {
        return Err(format!(
            "`{name}` is not a valid crate name, which is a letter, then letters, digits, `-` or `_`"
        ));
    }
    let is_family = FAMILIES.iter().any(|family| identifier.starts_with(family));
    if is_family || TAKEN.contains(&identifier.as_str()) || is_keyword(&identifier) {
        return Err(format!(
            "`{name}` cannot name the crate: Rust, or a crate that it needs, has that name"
        ));
    }
    Ok(())
}

/// Returns the name of a crate for a file or a built-in device: `my-device` for
/// `eds/My device.eds+coarse.overlay`.
///
/// # Errors
/// A sentence, if it would not be a valid name.
pub(super) fn of(source: &str) -> Result<String, String> {
    let base = source.split('+').next().unwrap_or(source);
    let stem = Path::new(base).file_stem().unwrap_or_default();
    let stem = stem.to_string_lossy().to_ascii_lowercase();
    let plain = |c: char| {
        if c.is_ascii_alphanumeric() || c == '_' {
            c
        } else {
            '-'
        }
    };
    let name: String = stem.chars().map(plain).collect();
    let name = name.trim_matches(['-', '_']);
    check(name).map_err(|why| format!("{why}; choose another one with `--name`"))?;
    Ok(name.to_owned())
}

/// Returns whether Rust reserves the word.
fn is_keyword(word: &str) -> bool {
    const WORDS: &str = "abstract as async await become box break const continue crate do dyn else enum \
        extern false final fn for gen if impl in let loop macro match mod move mut override priv \
        pub ref return self static struct super trait true try type typeof union unsafe unsized use virtual \
        where while yield";
    WORDS.split_whitespace().any(|keyword| keyword == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_that_cargo_accepts() {
        for name in ["my-device", "a", "Enc_58"] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        for name in ["", "5x", "-a", "a b", "ü", "test", "fn", "od-model", "a/b"] {
            assert!(check(name).is_err(), "{name}");
        }
        // In lower case the name is a keyword, a module or a crate of the firmware.
        for name in ["Self", "Fn", "board", "Sensor", "embassy-time", "od-new"] {
            assert!(check(name).is_err(), "{name}");
        }
    }

    #[test]
    fn a_file_names_its_crate() {
        for (file, name) in [
            ("eds/My device.eds+coarse.overlay", "my-device"),
            ("GXMM.eds", "gxmm"),
            ("gxmm", "gxmm"),
            ("(new) gate_2.dcf", "new--gate_2"),
        ] {
            assert_eq!(of(file), Ok(name.to_owned()), "{file}");
        }
        for file in ["42.eds", "test.eds", "ü.eds"] {
            assert!(of(file).unwrap_err().ends_with("with `--name`"), "{file}");
        }
    }
}
