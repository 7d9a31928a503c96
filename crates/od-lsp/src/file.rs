//! One open file: its text, and what odkit has read from it, on demand.

use std::cell::OnceCell;
use std::ops::Range;

use od_eds::{Description, Document, Edit, Encoding, Finding, Origin, Overlaid, Parsed};
use od_model::Refused;

use crate::host::Host;
use crate::layout::{Layout, bytes};
use crate::text::{Text, Unit};
use crate::types::TextEdit;
use crate::uri;
use crate::xdd::{self, Element};

/// A byte order mark.
const MARK: char = '\u{FEFF}';

/// Kind of a file, by its name.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Kind {
    /// An EDS or a DCF.
    Eds,
    /// An XDD or an XDC.
    Xdd,
    /// Differences to an EDS.
    Overlay,
    /// A node list.
    NodeList,
    /// A project of dcfgen.
    Project,
    /// Rust source with calls of `object_dictionary!`.
    Rust,
}

/// A file that a client has open.
pub(crate) struct File {
    pub(crate) uri: String,
    pub(crate) path: String,
    pub(crate) version: Option<i64>,
    pub(crate) text: Text,
    pub(crate) kind: Kind,
    /// The file below an overlay.
    pub(crate) base: Option<Base>,
    /// The findings about a network, with the files that it names.
    pub(crate) network: Option<Vec<Finding>>,
    /// The file on the disk without its text, if its encoding differs from that of the client's text.
    disk: Option<Document>,
    seen: OnceCell<Seen>,
}

/// The file below an overlay, or the reason why there is none: a place in the overlay and a sentence.
pub(crate) type Base = Result<Box<File>, Problem>;

/// A problem of an overlay that no rule reports: its place and a sentence.
pub(crate) type Problem = (Range<usize>, String);

/// A text that odkit has read.
#[derive(Default)]
pub(crate) struct Seen {
    pub(crate) layout: Layout,
    /// The elements of an XDD.
    pub(crate) elements: Vec<Element>,
    pub(crate) description: Description,
    /// The findings about this file.
    pub(crate) findings: Vec<Finding>,
    /// The problems of an overlay with its base.
    pub(crate) problems: Vec<Problem>,
    /// Error in the settings of the project.
    pub(crate) misused: Option<Refused>,
}

impl File {
    pub(crate) fn new(
        uri: String,
        language: &str,
        version: Option<i64>,
        text: String,
        unit: Unit,
        host: &dyn Host,
    ) -> Self {
        let path = uri::path(&uri);
        let kind = kind(&path, language);
        let disk = match kind {
            Kind::Eds | Kind::Xdd => host.read(&path).and_then(foreign),
            Kind::Overlay | Kind::NodeList | Kind::Project | Kind::Rust => None,
        };
        Self {
            uri,
            path,
            version,
            text: Text::new(text, unit),
            kind,
            base: None,
            network: None,
            disk,
            seen: OnceCell::new(),
        }
    }

    /// Forgets everything read: the text, a file that it depends on, or the project's settings changed.
    pub(crate) fn forget(&mut self) {
        self.seen = OnceCell::new();
    }

    pub(crate) fn str(&self) -> &str {
        self.text.as_str()
    }

    /// A part of the text.
    pub(crate) fn part(&self, bytes: Range<usize>) -> &str {
        self.str().get(bytes).unwrap_or_default()
    }

    /// The byte order mark that the client left in the text.
    pub(crate) fn mark(&self) -> &str {
        if self.str().starts_with(MARK) {
            &self.str()[..MARK.len_utf8()]
        } else {
            ""
        }
    }

    /// Reads the text.
    pub(crate) fn seen(&self, host: &dyn Host) -> &Seen {
        self.seen.get_or_init(|| match self.kind {
            Kind::Eds | Kind::Xdd => self.read(host),
            Kind::Overlay => self.overlaid(host),
            Kind::NodeList | Kind::Project => self.connected(host),
            Kind::Rust => Seen::default(),
        })
    }

    /// The bytes that the file would have on the disk.
    pub(crate) fn document(&self) -> Document {
        let disk = self.disk.clone().and_then(|mut disk| {
            let edit = Edit {
                range: 0..0,
                text: self.str().into(),
            };
            disk.apply(&[edit]).ok()?;
            Some(disk)
        });
        let document = disk.unwrap_or_else(|| Document::new(self.str()));
        document.named(&self.path)
    }

    fn read(&self, host: &dyn Host) -> Seen {
        let mut layout = Layout::default();
        let mut elements = Vec::new();
        let is_xml = od_eds::is_xml(self.str());
        let is_eds = self.kind == Kind::Eds && !is_xml;
        let parsed = if self.mark().is_empty() {
            self.document().load_with(&mut |sections| {
                if is_xml {
                    elements = xdd::elements(sections);
                } else if is_eds {
                    layout = Layout::new(sections);
                }
            })
        } else {
            // Places refer to the text with the mark.
            if is_eds {
                layout = Layout::of(self.str());
            }
            od_eds::load(self.str())
        };
        let Parsed {
            description,
            mut findings,
        } = parsed;
        let misused = host.judge(&self.path, &mut findings).err();
        Seen {
            layout,
            elements,
            description,
            findings,
            problems: Vec::new(),
            misused,
        }
    }

    /// Reads an overlay with its base.
    fn overlaid(&self, host: &dyn Host) -> Seen {
        let mut seen = Seen {
            layout: Layout::of(self.str()),
            ..Seen::default()
        };
        let made = match &self.base {
            Some(Ok(base)) => od_eds::overlay(base.str(), self.str()),
            Some(Err(problem)) => {
                seen.problems.push(problem.clone());
                return seen;
            }
            None => return seen,
        };
        let made = match made {
            Ok(made) => made,
            Err(faults) => {
                let place = |line: u32| self.text.line((line as usize).saturating_sub(1));
                let faults = faults.into_iter().map(|(line, why)| (place(line), why));
                seen.problems.extend(faults);
                return seen;
            }
        };
        let mut parsed = od_eds::load(&made.text);
        seen.misused = host.judge(&self.path, &mut parsed.findings).err();
        seen.findings = own(&made, parsed.findings);
        seen.description = parsed.description;
        seen
    }

    /// Reads a network with the files that it names.
    fn connected(&self, host: &dyn Host) -> Seen {
        let mut seen = Seen::default();
        if self.kind == Kind::NodeList {
            seen.layout = Layout::of(self.str());
        }
        seen.findings = self.network.clone().unwrap_or_default();
        seen.misused = host.judge(&self.path, &mut seen.findings).err();
        seen
    }

    /// The file below an overlay.
    pub(crate) fn below(&self) -> Option<&File> {
        self.base.as_ref()?.as_ref().ok().map(Box::as_ref)
    }

    /// Returns whether the text was read since it changed.
    pub(crate) fn is_seen(&self) -> bool {
        self.seen.get().is_some()
    }
}

/// Finds the base of an overlay: the file that its comment `;odkit-base=my.eds` names, otherwise the only EDS or DCF
/// in its folder. `find` reads the text of a path, from the editor or from the disk.
pub(crate) fn base(
    overlay: &File,
    unit: Unit,
    host: &dyn Host,
    find: &dyn Fn(&str) -> Option<String>,
) -> Base {
    let (place, path) = match od_eds::base_of(overlay.str()) {
        Some(named) => (bytes(named.span), uri::join(&overlay.path, &named)),
        None => {
            let mut all = host.beside(&overlay.path).into_iter();
            let first = all.by_ref().find(|path| is_eds(path));
            match first.filter(|_| !all.any(|path| is_eds(&path))) {
                Some(path) => (0..0, path),
                None => {
                    let why = "an overlay needs a base; add a first line `;odkit-base=my.eds`";
                    return Err((0..0, why.into()));
                }
            }
        }
    };
    if kind(&path, "") == Kind::Overlay {
        let why = if path == overlay.path {
            "an overlay cannot be its own base; name an EDS or a DCF"
        } else {
            "the base is an overlay, too; name an EDS or a DCF"
        };
        return Err((place, why.into()));
    }
    let Some(text) = find(&path) else {
        return Err((place, format!("the base {path} cannot be read")));
    };
    let text = text.trim_start_matches(MARK).to_owned();
    let uri = uri::of(&path, &overlay.uri);
    Ok(Box::new(File::new(uri, "", None, text, unit, host)))
}

/// Those findings of base and overlay that are about the overlay.
fn own(made: &Overlaid, findings: Vec<Finding>) -> Vec<Finding> {
    let placed = findings.into_iter().map(|finding| made.place(finding));
    placed
        .filter(|(origin, finding)| *origin == Origin::Overlay && finding.span().is_some())
        .map(|(_, finding)| finding)
        .collect()
}

/// Returns a file without its text if its encoding differs from the client's text, or if it has a mark.
fn foreign(bytes: Vec<u8>) -> Option<Document> {
    let mut document = Document::new(bytes);
    let same = matches!(document.encoding(), Encoding::Ascii | Encoding::Utf8);
    if same && !document.has_mark() {
        return None;
    }
    let edit = Edit {
        range: 0..document.text().len(),
        text: String::new(),
    };
    document.apply(&[edit]).ok()?;
    Some(document)
}

fn extension(path: &str) -> &str {
    path.rsplit_once('.').map_or("", |(_, extension)| extension)
}

fn is_eds(path: &str) -> bool {
    matches!(extension(path).to_ascii_lowercase().as_str(), "eds" | "dcf")
}

fn kind(path: &str, language: &str) -> Kind {
    let extension = extension(path).to_ascii_lowercase();
    match (extension.as_str(), language) {
        ("rs", _) | (_, "rust") => Kind::Rust,
        ("overlay", _) => Kind::Overlay,
        ("cpj", _) => Kind::NodeList,
        ("yml" | "yaml", _) => Kind::Project,
        ("xdd" | "xdc", _) => Kind::Xdd,
        _ => Kind::Eds,
    }
}

/// The edit that changes the text of a file into `after`: it covers the lines between the first and the last
/// difference. `None` without a difference.
pub(crate) fn edits(file: &File, after: &str) -> Vec<TextEdit> {
    let before = file.str();
    if before == after {
        return Vec::new();
    }
    let start = same(before.split_inclusive('\n'), after.split_inclusive('\n'));
    let (old, new) = (&before[start..], &after[start..]);
    let end = same(
        old.split_inclusive('\n').rev(),
        new.split_inclusive('\n').rev(),
    );
    vec![TextEdit {
        range: file.text.range(start..before.len() - end),
        new_text: new[..new.len() - end].to_owned(),
    }]
}

/// Number of bytes of equal lines.
fn same<'a>(a: impl Iterator<Item = &'a str>, b: impl Iterator<Item = &'a str>) -> usize {
    let pairs = a.zip(b).take_while(|(a, b)| a == b);
    pairs.map(|(line, _)| line.len()).sum()
}
