//! The EDS file behind a call: where it is, and what is in it.

use std::path::{Path, PathBuf};

use od_model::Description;
use syn::LitStr;

use crate::input::Input;
use crate::report::Report;

/// What was read.
#[derive(Default)]
pub(crate) struct Source {
    /// The path as it is written in the call, for messages.
    pub(crate) shown: Option<String>,
    /// The file for `include_bytes!`; `None` where none was read.
    pub(crate) path: Option<PathBuf>,
    /// The findings of the reader.
    pub(crate) findings: Vec<od_model::Diagnostic>,
    /// What the file says is as it should be.
    pub(crate) allows: od_model::check::Allows,
    /// What the file describes; empty without one.
    pub(crate) description: Description,
}

/// Reads the file that the call names, if it names one.
pub(crate) fn read(input: &Input, report: &mut Report) -> Source {
    let Some(literal) = &input.eds else {
        return Source::default();
    };
    let shown = literal.value();
    let path = locate(literal);
    let bytes = match std::fs::read(&path) {
        Ok(bytes) => bytes,
        Err(error) => {
            report.at(literal.span(), unreadable(&shown, &path, &error));
            return Source {
                shown: Some(shown),
                ..Source::default()
            };
        }
    };
    let text = od_model::eds::decode(&bytes);
    let parsed = od_model::eds::parse(&text);
    Source {
        shown: Some(shown),
        path: Some(path),
        findings: parsed.diagnostics,
        allows: od_model::check::Allows::of(&text),
        description: parsed.description,
    }
}

/// The path, relative to the source file that the literal stands in.
///
/// Where the compiler does not say which that is (rust-analyzer; sources under a
/// remapped prefix), it is looked for from the package's usual folders.
fn locate(literal: &LitStr) -> PathBuf {
    let written = PathBuf::from(literal.value());
    if written.is_absolute() {
        return written;
    }
    if let Some(file) = literal.span().unwrap().local_file() {
        let folder = file.parent().unwrap_or(Path::new(""));
        let path = folder.join(&written);
        return std::path::absolute(&path).unwrap_or(path);
    }
    let package = PathBuf::from(std::env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    ["src", "", "tests", "examples", "benches"]
        .map(|folder| package.join(folder).join(&written))
        .into_iter()
        .find(|path| path.exists())
        .unwrap_or_else(|| package.join("src").join(&written))
}

fn unreadable(shown: &str, path: &Path, error: &std::io::Error) -> String {
    if path.is_dir() {
        return format!("`{shown}` is a folder\nhelp: name the EDS file in it");
    }
    if error.kind() != std::io::ErrorKind::NotFound {
        return format!("cannot read `{shown}`: {error}");
    }
    let relative = "the path is relative to this source file, as for `include_str!`";
    let help = match beside(path) {
        Ok(Some(near)) => {
            let written = Path::new(shown).with_file_name(near);
            format!("did you mean `{}`?", written.display())
        }
        Ok(None) => relative.to_string(),
        Err(()) => format!("the folder does not exist; {relative}"),
    };
    format!("there is no file `{shown}`\nhelp: {help}")
}

/// The EDS file in the same folder whose name is nearest; an error without that folder.
fn beside(path: &Path) -> Result<Option<String>, ()> {
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = std::fs::read_dir(path.parent().ok_or(())?).map_err(|_| ())?;
    let mut near: Vec<(usize, String)> = folder
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| {
            let lower = name.to_ascii_lowercase();
            lower.ends_with(".eds") || lower.ends_with(".dcf")
        })
        .map(|name| (crate::names::distance(&wanted, &name), name))
        .filter(|(distance, _)| *distance <= 3)
        .collect();
    near.sort();
    Ok(near.into_iter().next().map(|(_, name)| name))
}
