//! The text of a description, perhaps of two files, and findings shown where they are.

use od_eds::{Description, Finding};
use od_eds::{Origin, Overlaid};

use crate::{Failure, output, report};

/// The text of a file, or of a file with an overlay.
pub(crate) struct Text {
    /// The path; of base and overlay, with `+` between them.
    pub(crate) path: String,
    /// The text as it is read.
    pub(crate) text: String,
    pub(super) overlay: Option<Box<Laid>>,
}

/// What an overlaid text was made of.
pub(super) struct Laid {
    base: Text,
    overlay: (String, String),
    made: Overlaid,
}

impl Text {
    /// This text with an overlay, of a path and a text.
    pub(super) fn with_overlay(self, overlay: (String, String)) -> Result<Self, Failure> {
        let made = od_eds::overlay(&self.text, &overlay.1).map_err(|faults| {
            let path = &overlay.0;
            for (line, fault) in &faults {
                output::note!("{path}:{line}: {fault}");
            }
            let count = report::plural(faults.len(), "section");
            Failure::Failed(format!(
                "{path}: {count} to remove cannot be; {} has other ones",
                self.path
            ))
        })?;
        Ok(Self {
            path: format!("{}+{}", self.path, overlay.0),
            text: made.text.clone(),
            overlay: Some(Box::new(Laid {
                base: self,
                overlay,
                made,
            })),
        })
    }

    /// The text as one file that any reader of an EDS takes: itself, unless it is an overlaid
    /// one or an XDD.
    pub(crate) fn is_plain(&self) -> bool {
        self.overlay.is_none() && !od_eds::is_xml(&self.text)
    }

    /// What it describes, and what was found; a text that describes nothing is a failure.
    pub(crate) fn parse(&self) -> Result<(Description, Vec<Finding>), Failure> {
        let parsed = od_eds::parse(&self.text);
        if parsed.description.objects.is_empty() {
            return Err(Failure::Failed(format!(
                "{} describes no object; is it an EDS, DCF or XDD file?",
                self.path
            )));
        }
        Ok((parsed.description, parsed.diagnostics))
    }

    /// Findings of the text with line and caret, each in the file that it is about.
    pub(crate) fn render(&self, findings: &[Finding], colours: bool) -> String {
        let Some(laid) = &self.overlay else {
            return report::render(&self.path, &self.text, findings, colours);
        };
        let placed: Vec<_> = findings
            .iter()
            .map(|finding| laid.made.place(finding.clone()))
            .collect();
        let of = |origin| -> Vec<Finding> {
            let own = placed.iter().filter(|(from, _)| *from == origin);
            own.map(|(_, finding)| finding.clone()).collect()
        };
        let (path, text) = &laid.overlay;
        let base = laid.base.render(&of(Origin::Base), colours);
        let overlay = report::render(path, text, &of(Origin::Overlay), colours);
        match (base.is_empty(), overlay.is_empty()) {
            (false, false) => format!("{}\n\n{overlay}", base.trim_end()),
            (true, _) => overlay,
            (_, true) => base,
        }
    }
}
