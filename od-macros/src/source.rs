//! The EDS file of a call: finds and reads it.

use std::path::{Path, PathBuf};

use od_eds::Description;
use syn::LitStr;

use crate::files::Files;
use crate::input::Input;
use crate::report::Report;

/// The file of a call after reading.
#[derive(Default)]
pub(crate) struct Source {
    /// The paths as written in the call, for messages.
    pub(crate) files: Option<Files>,
    /// The files for `include_bytes!`; empty if none was read.
    pub(crate) paths: Vec<PathBuf>,
    /// The findings of the reader.
    pub(crate) findings: Vec<od_eds::Finding>,
    /// The findings that the file allows (`odkit-allow`).
    pub(crate) allows: od_eds::check::Allows,
    /// The description in the file; empty without a file.
    pub(crate) description: Description,
}

/// Reads the files that the call names, if any.
pub(crate) fn read(input: &Input, report: &mut Report) -> Source {
    let Some(literal) = &input.eds else {
        return Source::default();
    };
    let files = Files::one(literal.value());
    let nothing = |files| Source {
        files: Some(files),
        ..Source::default()
    };
    let Some((path, text)) = file(literal, report) else {
        return nothing(files);
    };
    let mut paths = vec![path];
    if let Some(base) = base(literal, &text) {
        let shown = literal.value();
        let other = input.overlay.as_ref().map(LitStr::value);
        let base = other.filter(|other| !is_overlay(other)).unwrap_or(base);
        let said =
            format!("`{shown}` is an overlay\nhelp: write `eds = \"{base}\" + \"{shown}\";`");
        report.at(literal.span(), said);
        return nothing(files);
    }
    let (files, text) = match &input.overlay {
        None => (files, text),
        Some(literal) => {
            let Some((path, over)) = file(literal, report) else {
                return nothing(files);
            };
            paths.push(path);
            match od_eds::overlay(&text, &over) {
                Ok(made) => {
                    let text = made.text.clone();
                    (files.with_overlay(literal.value(), made), text)
                }
                Err(faults) => {
                    for (line, fault) in faults {
                        let shown = literal.value();
                        report.at(literal.span(), format!("{shown}:{line}: {fault}"));
                    }
                    return nothing(files);
                }
            }
        }
    };
    if let Some(kind) = od_eds::foreign(&text) {
        let shown = literal.value();
        report.at(
            literal.span(),
            format!("`{shown}` is {kind}\nhelp: the macro reads EDS and DCF files of CANopen"),
        );
        return nothing(files);
    }
    if text
        .trim_start_matches('\u{FEFF}')
        .trim_start()
        .starts_with('<')
    {
        let shown = literal.value();
        let help = match shown.rsplit_once('.') {
            Some((stem, end)) if end.eq_ignore_ascii_case("eds") => {
                format!("rename it; `odkit convert {stem}.xdd -o {shown}` writes an EDS")
            }
            Some((stem, _)) => format!("`odkit convert {shown} -o {stem}.eds` writes an EDS"),
            None => format!("`odkit convert {shown} -o {shown}.eds` writes an EDS"),
        };
        report.at(
            literal.span(),
            format!("`{shown}` is XML, and the macro reads EDS and DCF\nhelp: {help}"),
        );
        return nothing(files);
    }
    let parsed = od_eds::parse(&text);
    Source {
        files: Some(files),
        paths,
        findings: parsed.findings,
        allows: od_eds::check::Allows::of(&text),
        description: parsed.description,
    }
}

/// If a file is an overlay, the path of its base for the call: the one that it names, otherwise an example.
fn base(literal: &LitStr, text: &str) -> Option<String> {
    let shown = literal.value();
    if let Some(base) = od_eds::base_of(text) {
        let path = Path::new(&shown).with_file_name(base.value);
        return Some(path.display().to_string());
    }
    is_overlay(&shown).then(|| "my_device.eds".to_string())
}

/// Returns whether the name of the file ends as that of an overlay.
fn is_overlay(path: &str) -> bool {
    let end = Path::new(path).extension();
    end.is_some_and(|end| end.eq_ignore_ascii_case("overlay"))
}

/// Path and text of one file; `None` if it cannot be read, which is reported.
fn file(literal: &LitStr, report: &mut Report) -> Option<(PathBuf, String)> {
    let path = locate(literal);
    match std::fs::read(&path) {
        Ok(bytes) => {
            let text = od_eds::decode(&bytes).into_owned();
            Some((path, text))
        }
        Err(error) => {
            report.at(literal.span(), unreadable(&literal.value(), &path, &error));
            None
        }
    }
}

/// The path, relative to the source file of the literal.
///
/// If the compiler does not name that source file (rust-analyzer; sources under a
/// remapped prefix), the search begins in the usual folders of the package.
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
    format!("file `{shown}` does not exist\nhelp: {help}")
}

/// The EDS file in the same folder with the most similar name; an error if the folder does not exist.
fn beside(path: &Path) -> Result<Option<String>, ()> {
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    let folder = std::fs::read_dir(path.parent().ok_or(())?).map_err(|_| ())?;
    let mut names: Vec<String> = folder
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|name| {
            let lower = name.to_ascii_lowercase();
            [".eds", ".dcf", ".overlay"]
                .iter()
                .any(|end| lower.ends_with(end))
        })
        .collect();
    names.sort();
    let names = names.iter().map(String::as_str);
    Ok(od_eds::nearest(&wanted, names, 3).map(Into::into))
}
