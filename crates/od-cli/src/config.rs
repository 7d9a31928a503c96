//! `odkit.toml`: the settings of a project for the rules.
//!
//! ```toml
//! strict = true               # warnings count as errors
//! tools = ["python-canopen"]  # as `odkit check --for python-canopen`
//!
//! [rules]
//! W0311 = "off"               # or "on", "error", "warning", "remark"
//! "W0445:2000" = "off"        # for one object
//!
//! [[files]]
//! pattern = "vendor/**/*.eds" # from the folder of odkit.toml on
//! rules = { W0311 = "on" }    # later ones replace earlier ones
//! ```

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use od_eds::check::parse_allow;
use od_eds::tools::{self, TOOLS};
use od_eds::{Finding, Severity};
use serde::Deserialize;

use crate::failure::{Failure, read_error};

/// Name of the file.
const NAME: &str = "odkit.toml";

/// The file of `--config`.
static GIVEN: OnceLock<PathBuf> = OnceLock::new();

/// Uses this file for every path.
pub(crate) fn use_file(path: PathBuf) {
    // The command line is parsed once.
    let _ = GIVEN.set(path);
}

/// Settings of a project; empty if there is no file.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields, rename_all = "kebab-case")]
pub(crate) struct Config {
    /// Whether warnings count as errors.
    pub(crate) strict: bool,
    /// Whether remarks are shown.
    pub(crate) remarks: bool,
    /// The tools that read the files of the project, as for `--for`.
    pub(crate) tools: Vec<String>,
    rules: BTreeMap<String, Setting>,
    files: Vec<Files>,
    /// Folder to which patterns are relative.
    #[serde(skip)]
    root: PathBuf,
}

/// Settings for the files that match a pattern.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Files {
    pattern: String,
    rules: BTreeMap<String, Setting>,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Setting {
    Off,
    On,
    Error,
    Warning,
    Remark,
}

impl Config {
    /// The configuration for a file: `--config`, else the nearest `odkit.toml` in its folder or a folder above.
    ///
    /// # Errors
    /// The file cannot be read, or has a key or a value that is not valid.
    pub(crate) fn of(path: &str) -> Result<Self, Failure> {
        if let Some(given) = GIVEN.get() {
            return Self::read(given);
        }
        // For a base with an overlay, the path of the base.
        let base = path.split('+').next().unwrap_or(path);
        let file = std::path::absolute(base).unwrap_or_else(|_| base.into());
        let folders = file.ancestors().skip(1);
        let mut found = folders.map(|folder| folder.join(NAME));
        match found.find(|file| file.is_file()) {
            Some(found) => Self::read(&found),
            None => Ok(Self::default()),
        }
    }

    fn read(path: &Path) -> Result<Self, Failure> {
        let shown = path.display();
        let wrong = |why: String| Failure::Usage(format!("{shown}: {why}"));
        let text = std::fs::read_to_string(path).map_err(|error| wrong(read_error(&error)))?;
        let mut config: Self = toml::from_str(&text).map_err(|error| wrong(error.to_string()))?;
        let files = config.files.iter().flat_map(|files| files.rules.keys());
        for code in config.rules.keys().chain(files) {
            parse_allow(code).map_err(|refused| wrong(refused.into()))?;
        }
        let unknown = config.tools.iter();
        let mut unknown = unknown.filter(|name| *name != "all" && tools::tool(name).is_none());
        if let Some(name) = unknown.next() {
            let known: Vec<&str> = TOOLS.iter().map(|tool| tool.name).collect();
            let known = known.join(", ");
            return Err(wrong(format!(
                "`{name}` is not a tool that odkit knows; it knows {known}, and `all`"
            )));
        }
        let folder = std::path::absolute(path).unwrap_or_else(|_| path.into());
        config.root = folder.parent().unwrap_or(Path::new("")).into();
        Ok(config)
    }

    /// Removes findings of rules that are off, and sets the severity of the others.
    pub(crate) fn apply(&self, path: &str, findings: &mut Vec<Finding>) {
        let file = std::path::absolute(path).unwrap_or_else(|_| path.into());
        let own = file.strip_prefix(&self.root).unwrap_or(&file);
        let own = own.display().to_string().replace('\\', "/");
        let files = self
            .files
            .iter()
            .filter(|files| matches(&files.pattern, &own));
        let rules = files.flat_map(|files| &files.rules);
        let settings: Vec<_> = self
            .rules
            .iter()
            .chain(rules)
            .filter_map(|(code, setting)| Some((parse_allow(code).ok()?, *setting)))
            .collect();
        findings.retain_mut(|finding| {
            let index = finding.object.map(|address| address.index);
            let own = finding.code();
            let about = settings.iter().filter(|((code, object), _)| {
                *code == own && (object.is_none() || *object == index)
            });
            let mut keep = true;
            let given = finding.severity;
            for (_, setting) in about {
                keep = !matches!(setting, Setting::Off);
                finding.severity = match setting {
                    Setting::Off | Setting::On => given,
                    Setting::Error => Severity::Error,
                    Setting::Warning => Severity::Warning,
                    Setting::Remark => Severity::Info,
                };
            }
            keep
        });
    }
}

/// Returns whether a path matches a pattern. `*` matches anything but `/`, `**` anything, `?` one character; a
/// pattern without `/` matches the file name.
fn matches(pattern: &str, path: &str) -> bool {
    let path = if pattern.contains('/') {
        path
    } else {
        path.rsplit('/').next().unwrap_or(path)
    };
    is_like(pattern.as_bytes(), path.as_bytes())
}

fn is_like(pattern: &[u8], path: &[u8]) -> bool {
    match pattern {
        [] => path.is_empty(),
        [b'*', b'*', b'/', rest @ ..] => {
            let mut starts = (0..=path.len()).filter(|at| *at == 0 || path[at - 1] == b'/');
            starts.any(|at| is_like(rest, &path[at..]))
        }
        [b'*', b'*', rest @ ..] => (0..=path.len()).any(|at| is_like(rest, &path[at..])),
        [b'*', rest @ ..] => {
            let end = path.iter().position(|b| *b == b'/').unwrap_or(path.len());
            (0..=end).any(|at| is_like(rest, &path[at..]))
        }
        [b'?', rest @ ..] => path.first().is_some_and(|b| *b != b'/') && is_like(rest, &path[1..]),
        [first, rest @ ..] => path.first() == Some(first) && is_like(rest, &path[1..]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn patterns_match_paths() {
        for (pattern, path, expected) in [
            ("*.eds", "vendor/a.eds", true),
            ("vendor/*.eds", "vendor/a.eds", true),
            ("vendor/*.eds", "vendor/b/a.eds", false),
            ("vendor/**/*.eds", "vendor/a.eds", true),
            ("vendor/**/*.eds", "vendor/b/c/a.eds", true),
            ("vendor/**", "vendor/b/a.eds", true),
            ("**/a.eds", "a.eds", true),
            ("a?.eds", "x/ab.eds", true),
            ("a?.eds", "a.eds", false),
            ("vendor/a.eds", "a.eds", false),
        ] {
            assert_eq!(matches(pattern, path), expected, "{pattern} {path}");
        }
    }
}
