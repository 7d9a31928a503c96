//! Names of crates.

use std::path::Path;

/// Words that cannot name a crate, or have another meaning in code that uses the crate.
const TAKEN: [&str; 15] = [
    "test",
    "core",
    "std",
    "alloc",
    "proc_macro",
    "self",
    "super",
    "crate",
    "od_model",
    "od_board",
    "odkit",
    "od_bench",
    "dictionary",
    "build",
    "main",
];

/// Checks that a crate can have this name.
///
/// # Errors
/// A sentence that says why not.
pub(super) fn check(name: &str) -> Result<(), String> {
    let starts = name.starts_with(|c: char| c.is_ascii_alphabetic());
    let fits = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    let identifier = name.replace('-', "_");
    if !starts || !name.chars().all(fits) || name.len() > 64 {
        return Err(format!(
            "`{name}` is not a valid crate name; start with a letter, then letters, digits, `-` or `_`"
        ));
    }
    if TAKEN.contains(&identifier.as_str()) || is_keyword(&identifier) {
        return Err(format!("`{name}` is reserved in Rust; choose another name"));
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
    let plain = |c: char| match c.is_ascii_alphanumeric() || c == '_' {
        true => c,
        false => '-',
    };
    let name: String = stem.chars().map(plain).collect();
    let name = name.trim_matches(['-', '_']);
    check(name).map_err(|why| format!("{why} with `--name`"))?;
    Ok(name.to_owned())
}

fn is_keyword(word: &str) -> bool {
    const WORDS: &str = "abstract as async await become box break const continue do dyn else enum \
        extern false final fn for gen if impl in let loop macro match mod move mut override priv \
        pub ref return static struct trait true try type typeof union unsafe unsized use virtual \
        where while yield";
    WORDS.split_whitespace().any(|keyword| keyword == word)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_ones_that_cargo_takes() {
        for name in ["my-device", "a", "Enc_58"] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        for name in ["", "5x", "-a", "a b", "ü", "test", "fn", "od-model", "a/b"] {
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
