//! Sources of a description: a file, a built-in device, a base with overlays, or a text.

use std::fs;
use std::io::ErrorKind;
use std::path::PathBuf;

use od_devices::DEVICES;
use od_eds::{Document, Eds, Finding, Origin, Overlaid, say};
use od_runtime::DeviceKind;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString};

use crate::faults::Fault;

/// Number of findings in a message.
const SHOWN: usize = 5;

/// A text and its name.
#[derive(Clone)]
pub(crate) struct Source {
    /// The path, or the name of the built-in device; base and overlay are joined by `+`.
    pub(crate) name: Option<String>,
    pub(crate) kind: Option<&'static DeviceKind>,
    pub(crate) document: Document,
    laid: Option<Box<Laid>>,
}

/// Parts of a text with overlays.
#[derive(Clone)]
struct Laid {
    base: Source,
    overlay: Option<String>,
    made: Overlaid,
}

impl Source {
    /// The source that a caller names: a path or a built-in device, a text with line ends, or the bytes of a file.
    ///
    /// # Errors
    /// It cannot be read.
    pub(crate) fn of(given: &Bound<'_, PyAny>) -> PyResult<Self> {
        if let Ok(bytes) = given.cast::<PyBytes>() {
            return Ok(Self::plain(None, Document::new(bytes.as_bytes())));
        }
        if given.is_instance_of::<PyString>() {
            let text: String = given.extract()?;
            return if text.contains(['\n', '\r']) {
                Ok(Self::plain(None, Document::new(text)))
            } else {
                Ok(Self::find(&text)?)
            };
        }
        let path: PathBuf = given.extract()?;
        Ok(Self::find(&path.display().to_string())?)
    }

    /// A built-in device, a file, or `base+overlay`.
    ///
    /// # Errors
    /// Reason why it cannot be read.
    pub(crate) fn find(name: &str) -> Result<Self, Fault> {
        if let Some(kind) = od_devices::find(name) {
            let document = Document::new(od_devices::text::eds(kind));
            let mut source = Self::plain(Some(kind.name.into()), document);
            source.kind = Some(kind);
            return Ok(source);
        }
        match (fs::read(name), name.rsplit_once('+')) {
            (Ok(bytes), _) => {
                let document = Document::new(bytes).named(name);
                Ok(Self::plain(Some(name.into()), document))
            }
            (Err(_), Some((base, overlay))) => Self::find(base)?.with(Self::find(overlay)?),
            (Err(error), None) if error.kind() == ErrorKind::NotFound => {
                let known: Vec<_> = DEVICES.iter().map(|kind| kind.name).collect();
                let known = known.join(", ");
                Err(Fault::Missing(format!(
                    "no built-in device or file is named `{name}`; built-in devices are {known}"
                )))
            }
            (Err(error), None) => Err(Fault::system(format!("{name}: {error}"))),
        }
    }

    /// A text of one file.
    pub(crate) fn plain(name: Option<String>, document: Document) -> Self {
        Self {
            name,
            kind: None,
            document,
            laid: None,
        }
    }

    /// A text that was read before, with its name.
    pub(crate) fn pickled(text: String, name: Option<String>) -> Self {
        let kind = name.as_deref().and_then(od_devices::find);
        let mut source = Self::plain(name, Document::new(text));
        source.kind = kind;
        source
    }

    /// This base with an overlay.
    ///
    /// # Errors
    /// The overlay removes what the base lacks; with its line.
    pub(crate) fn with(self, overlay: Self) -> Result<Self, Fault> {
        let made = od_eds::overlay(self.document.text(), overlay.document.text());
        let shown = overlay.name.as_deref().unwrap_or("overlay");
        let made = made.map_err(|faults| {
            let faults = faults
                .iter()
                .map(|(line, why)| format!("{shown}: line {line}: {why}"));
            Fault::value(faults.collect::<Vec<_>>().join("; "))
        })?;
        let base = self.name.as_deref().unwrap_or("text");
        let name = format!("{base}+{shown}");
        let mut laid = Self::plain(Some(name), Document::new(made.text.clone()));
        laid.laid = Some(Box::new(Laid {
            base: self,
            overlay: overlay.name,
            made,
        }));
        Ok(laid)
    }

    /// The same source with another text.
    pub(crate) fn with_document(self, document: Document) -> Self {
        Self { document, ..self }
    }

    /// Returns whether it consists of two files.
    pub(crate) fn is_overlaid(&self) -> bool {
        self.laid.is_some()
    }

    /// The name for messages.
    pub(crate) fn shown(&self) -> &str {
        self.name.as_deref().unwrap_or("text")
    }

    /// Assigns a finding of the text to its file, and returns the file's name.
    pub(crate) fn place(&self, finding: Finding) -> (Option<&str>, Finding) {
        let Some(laid) = &self.laid else {
            return (self.name.as_deref(), finding);
        };
        match laid.made.place(finding) {
            (Origin::Base, finding) => laid.base.place(finding),
            (Origin::Overlay, finding) => (laid.overlay.as_deref(), finding),
        }
    }

    /// Findings in one sentence, each with its file and line; only the first ones if there are many.
    pub(crate) fn words(&self, findings: &[&Finding]) -> String {
        let mut words: Vec<String> = Vec::new();
        let mut last = None;
        for finding in findings.iter().take(SHOWN) {
            let (file, finding) = self.place((*finding).clone());
            let file = file.unwrap_or("text").to_owned();
            let line = finding.span().map_or(0, |span| span.line);
            let head = if last.as_ref() == Some(&file) {
                String::new()
            } else {
                format!("{file}: ")
            };
            let at = match line {
                0 => String::new(),
                line => format!("line {line}: "),
            };
            let (code, said) = (finding.code(), say(&finding, &Eds).message);
            words.push(format!("{head}{at}{code} {said}"));
            last = Some(file);
        }
        if findings.len() > SHOWN {
            words.push(format!("and {} more", findings.len() - SHOWN));
        }
        words.join("; ")
    }
}
