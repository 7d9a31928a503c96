//! The file named by a call of the macro, read as the macro reads it.

use od_eds::{Description, Document, Finding, Origin, Overlaid, Parsed};

use crate::file::File;
use crate::layout::{Layout, bytes};
use crate::macros::call::Call;
use crate::text::Text;
use crate::types::Location;
use crate::uri;

/// Reads the text of a file, from the editor or from the disk.
pub(crate) type Find<'a> = &'a dyn Fn(&str) -> Option<String>;

/// A file with its text.
pub(crate) struct Named {
    pub(crate) uri: String,
    pub(crate) text: Text,
}

/// The file of a call, and its overlay.
pub(crate) struct Base {
    pub(crate) eds: Named,
    overlay: Option<(Named, Overlaid)>,
    pub(crate) description: Description,
    pub(crate) findings: Vec<Finding>,
}

/// Reason why a call has no base: the place of a path, and a sentence.
pub(crate) type Lacking = (std::ops::Range<usize>, String);

impl Base {
    /// The file of a call; an empty description for a call without one.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub(crate) fn of(file: &File, call: &Call, find: Find<'_>) -> Result<Option<Self>, Lacking> {
        let Some(path) = &call.eds else {
            return Ok(None);
        };
        let eds = named(file, path, find)?;
        let overlay = match &call.overlay {
            None => None,
            Some(path) => {
                let overlay = named(file, path, find)?;
                let made = od_eds::overlay(eds.text.as_str(), overlay.text.as_str());
                let made = made.map_err(|faults| {
                    let why = faults
                        .into_iter()
                        .map(|(line, why)| format!("line {line}: {why}"));
                    (path.clone(), why.collect::<Vec<_>>().join("; "))
                })?;
                Some((overlay, made))
            }
        };
        let text = match &overlay {
            Some((_, made)) => &made.text,
            None => eds.text.as_str(),
        };
        let Parsed {
            description,
            findings,
        } = od_eds::load(text);
        Ok(Some(Self {
            eds,
            overlay,
            description,
            findings,
        }))
    }

    /// Place of a finding, in one of the two files.
    pub(crate) fn place(&self, finding: &Finding) -> Option<Location> {
        let span = finding.span()?;
        let (named, span) = match &self.overlay {
            Some((overlay, made)) => match made.locate(span) {
                (Origin::Overlay, span) => (overlay, span),
                (Origin::Base, span) => (&self.eds, span),
            },
            None => (&self.eds, span),
        };
        Some(Location {
            uri: named.uri.clone(),
            range: named.text.range(bytes(span)),
        })
    }

    /// Place of an object or a sub-object in the EDS.
    pub(crate) fn described(&self, place: od_eds::outline::Place) -> Option<Location> {
        let layout = Layout::of(self.eds.text.as_str());
        let section = layout.section_of(place)?;
        Some(Location {
            uri: self.eds.uri.clone(),
            range: self.eds.text.range(section.header.clone()),
        })
    }
}

fn named(file: &File, path: &std::ops::Range<usize>, find: Find<'_>) -> Result<Named, Lacking> {
    let written = file.part(path.clone());
    let own = uri::join(&file.path, written);
    match find(&own) {
        Some(text) => Ok(Named {
            uri: uri::of(&own, &file.uri),
            text: Text::new(text, file.text.unit()),
        }),
        None => Err((path.clone(), format!("{written} cannot be read"))),
    }
}

/// The text of a file on the disk.
pub(crate) fn decoded(bytes: Vec<u8>) -> String {
    Document::new(bytes).text().to_owned()
}
