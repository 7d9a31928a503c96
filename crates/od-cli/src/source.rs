//! Finds a device description by its name on the command line, and reads it once.

use od_model::Refused;
use std::cell::OnceCell;
use std::fs;
use std::path::{Path, PathBuf};

use od_devices::DEVICES;
use od_eds::convert::lost;
use od_eds::{Description, Document, Eds, Finding, Origin, Overlaid, Parsed, Severity, say};
use od_runtime::DeviceKind;
use od_runtime::NodeId;
use od_sim::{EdsOptions, VirtualDevice, recorded};

pub(crate) use od_sim::serve::options::node_id;

use crate::config::Config;
use crate::failure::{Failure, read_error};
use crate::files;
use crate::report::{Names, names};
use crate::{output, report};

/// A built-in device, or a file, or a base with an overlay.
#[derive(Default)]
pub(crate) struct Source {
    /// The name of the device, or the path; base and overlay are joined by `+`.
    pub(crate) path: String,
    /// The built-in device, if it is one.
    pub(crate) kind: Option<&'static DeviceKind>,
    /// The text of the file; for a built-in device its EDS, made on demand.
    document: OnceCell<Document>,
    laid: Option<Box<Laid>>,
}

/// Parts of a text with overlays.
struct Laid {
    base: Source,
    /// Path and file.
    overlay: (String, Document),
    made: Overlaid,
}

/// One file of a source, and its findings.
pub(crate) struct Part<'a> {
    pub(crate) path: &'a str,
    pub(crate) document: &'a Document,
    pub(crate) findings: Vec<Finding>,
}

/// Findings about objects that the target lacks or changes.
pub(crate) struct Lost(Vec<Finding>);

impl Lost {
    /// # Errors
    /// The target lacks objects, and `--lossy` is not given.
    pub(crate) fn judge(&self, accepted: bool) -> Result<(), Failure> {
        if self.0.is_empty() || accepted {
            return Ok(());
        }
        let objects = self.0.iter().filter_map(|finding| finding.object);
        let objects: Vec<String> = objects.map(|object| object.to_string()).collect();
        let count = report::plural(self.0.len(), "object");
        let named = if objects.is_empty() {
            String::new()
        } else {
            format!(" ({})", objects.join(", "))
        };
        let is_there = self
            .0
            .iter()
            .any(|finding| finding.code().starts_with("W1"));
        let verb = if is_there { "cannot express" } else { "lacks" };
        Err(Failure::Failed(format!(
            "the target {verb} {count} of the source{named}; correct them, or add `--lossy` to accept that"
        )))
    }
}

/// Maximum number of errors that are shown when a device is made from a file.
const SHOWN: usize = 5;

/// Returns the document, unless it is a device file of another fieldbus or no device file.
fn canopen(document: Document) -> Result<Document, String> {
    match od_eds::foreign(document.text()) {
        Some(name) => Err(format!(
            "it is {name}, not a device file of CANopen; odkit reads EDS, DCF, XDD and XDC files"
        )),
        None if od_eds::lacks_sections(document.text()) => {
            Err(String::from(if is_network(document.text()) {
                "it is a project or a node list, not a device; `odkit network FILE` checks it"
            } else {
                "it has no section of an EDS, such as [FileInfo]; odkit reads EDS, DCF, XDD and XDC files"
            }))
        }
        None => Ok(document),
    }
}

/// Returns whether a line begins the master or the nodes of a project, or the topology of a node list.
fn is_network(text: &str) -> bool {
    let mut lines = text.lines();
    lines.any(|line| {
        line.starts_with("master:")
            || line.starts_with("nodes:")
            || line.to_ascii_lowercase().starts_with("[topology")
    })
}

impl Source {
    /// A name of a built-in device, or the path of an EDS or DCF file.
    pub(crate) fn find(name: &str) -> Result<Self, Failure> {
        Self::find_in(name, Path::new(""))
    }

    /// Like [`find`](Self::find), with paths relative to `folder`.
    pub(crate) fn find_in(name: &str, folder: &Path) -> Result<Self, Failure> {
        if let Some(kind) = od_devices::find(name) {
            return Ok(Self {
                path: kind.name.into(),
                kind: Some(kind),
                ..Self::default()
            });
        }
        let path = folder.join(name);
        match files::read(&path) {
            Ok(bytes) => {
                let name = path.display().to_string();
                let failed = |why| Failure::Failed(format!("{name}: {why}"));
                let document = canopen(Document::new(bytes).named(name.clone())).map_err(failed)?;
                if is_overlay(&path) {
                    let base = base_of(&path, &document).map_err(failed)?;
                    return Self::find(&base)?.with_overlay(&path);
                }
                Ok(Self::of(name, document))
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                match name.rsplit_once('+') {
                    Some((base, overlay)) => {
                        Self::find_in(base, folder)?.with_overlay(&folder.join(overlay))
                    }
                    None => Err(unknown(name, &error)),
                }
            }
            Err(error) => Err(unknown(name, &error)),
        }
    }

    /// The paths of its files; empty for a built-in device.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        match (&self.laid, self.kind) {
            (Some(laid), _) => {
                let mut files = laid.base.files();
                files.push(laid.overlay.0.clone().into());
                files
            }
            (None, Some(_)) => Vec::new(),
            (None, None) => vec![self.path.clone().into()],
        }
    }

    /// The file at a path, or a base with an overlay; never a built-in device.
    ///
    /// # Errors
    /// Reason why it cannot be read.
    pub(crate) fn file(path: &str) -> Result<Self, String> {
        match od_sim::serve::files::read(Path::new(path)) {
            Ok(bytes) => {
                let document = canopen(Document::new(bytes).named(path))?;
                let overlay = Path::new(path);
                if is_overlay(overlay) {
                    let base = base_of(overlay, &document)?;
                    let laid = Self::find(&base).and_then(|base| base.with_overlay(overlay));
                    return laid.map_err(|failure| failure.to_string());
                }
                Ok(Self::of(path.into(), document))
            }
            Err(error) if error.kind() == std::io::ErrorKind::NotFound && path.contains('+') => {
                Self::find(path).map_err(|failure| failure.to_string())
            }
            Err(error) => Err(read_error(&error)),
        }
    }

    fn of(path: String, document: Document) -> Self {
        Self {
            path,
            document: document.into(),
            ..Self::default()
        }
    }

    /// This base with the overlay at a path; the base may have an overlay itself.
    fn with_overlay(self, path: &Path) -> Result<Self, Failure> {
        let shown = path.display().to_string();
        let bytes = files::read(path).map_err(|error| {
            let why = read_error(&error);
            Failure::Failed(format!("overlay {shown}: {why}"))
        })?;
        let overlay = Document::new(bytes);
        let made = od_eds::overlay(self.text(), overlay.text()).map_err(|faults| {
            for (line, fault) in &faults {
                output::note!("{shown}:{line}: {fault}");
            }
            let count = report::plural(faults.len(), "problem");
            Failure::Failed(format!("{shown} does not fit {}: {count}", self.path))
        })?;
        let document = Document::new(made.text.clone());
        let mut laid = Self::of(format!("{}+{shown}", self.path), document);
        laid.laid = Some(Box::new(Laid {
            base: self,
            overlay: (shown, overlay),
            made,
        }));
        Ok(laid)
    }

    /// Returns whether it consists of two files.
    pub(crate) fn is_overlaid(&self) -> bool {
        self.laid.is_some()
    }

    /// The file.
    pub(crate) fn document(&self) -> &Document {
        let text = || self.kind.map(od_devices::text::eds).unwrap_or_default();
        self.document.get_or_init(|| Document::new(text()))
    }

    /// Replaces the file.
    pub(crate) fn replace(&mut self, document: Document) {
        self.document = document.into();
    }

    pub(crate) fn text(&self) -> &str {
        self.document().text()
    }

    /// Returns whether it is one file that any EDS parser accepts: not a text with an overlay, not an XDD.
    pub(crate) fn is_plain(&self) -> bool {
        !self.is_overlaid() && !od_eds::is_xml(self.text())
    }

    /// Returns the description and the findings; a text without objects, or with more than a device file can have, is
    /// a failure.
    pub(crate) fn parse(&self) -> Result<Parsed, Failure> {
        self.described(od_eds::parse(self.text()))
    }

    /// Like [`parse`](Self::parse), with the findings of the rules.
    pub(crate) fn load(&self) -> Result<Parsed, Failure> {
        self.described(od_eds::load(self.text()))
    }

    fn described(&self, parsed: Parsed) -> Result<Parsed, Failure> {
        let mut findings = parsed.findings.iter();
        if let Some(large) = findings.find(|one| one.code() == "E0119") {
            let why = say(large, &Eds).message;
            let line = large.span().map_or(0, |span| span.line);
            return Err(Failure::Failed(format!(
                "{}:{line}: {why}; remove what does not describe the device",
                self.path
            )));
        }
        if parsed.description.objects.is_empty() {
            return Err(Failure::Failed(format!(
                "{} does not define any object; is it an EDS, DCF or XDD file?",
                self.path
            )));
        }
        Ok(parsed)
    }

    /// Returns the description for a target that must be complete. Prints errors to standard
    /// error, and findings about objects that the target lacks; with `typed` also about values without a
    /// type.
    pub(crate) fn complete(&self, typed: bool) -> Result<(Description, Lost), Failure> {
        let Parsed {
            description,
            findings,
        } = self.parse()?;
        let checked = if typed {
            od_eds::check::check(&description)
        } else {
            Vec::new()
        };
        let mut lost = lost::unread(&findings);
        if typed {
            let all: Vec<_> = findings.iter().chain(&checked).cloned().collect();
            lost.extend(lost::untyped(&description, &all));
        }
        let mut shown: Vec<_> = findings.into_iter().filter(Finding::is_unsound).collect();
        shown.extend(
            lost.iter()
                .filter(|one| !shown.contains(one))
                .cloned()
                .collect::<Vec<_>>(),
        );
        Config::of(&self.path)?.apply(&self.path, &mut shown);
        self.note(&shown, &names(&description, &shown));
        Ok((description, Lost(lost)))
    }

    /// Prints what a target cannot express to standard error; everything except remarks is lost.
    pub(crate) fn unexpressed(
        &self,
        description: &Description,
        mut findings: Vec<Finding>,
        mut lost: Lost,
    ) -> Result<Lost, Failure> {
        Config::of(&self.path)?.apply(&self.path, &mut findings);
        self.note(&findings, &names(description, &findings));
        findings.retain(|finding| finding.severity > Severity::Info);
        lost.0.extend(findings);
        Ok(lost)
    }

    /// Shows findings on standard error.
    fn note(&self, findings: &[Finding], names: &Names) {
        output::note_coloured(&self.render(findings, names, output::error_colours()));
    }

    /// Findings of the text with line and caret, each in the file that it is about.
    pub(crate) fn render(&self, findings: &[Finding], names: &Names, colours: bool) -> String {
        let parts = self.parts(findings.to_vec());
        let rendered = parts.iter().map(|part| {
            report::render(
                part.path,
                part.document.text(),
                &part.findings,
                names,
                colours,
            )
        });
        let rendered: Vec<String> = rendered.filter(|text| !text.is_empty()).collect();
        let trimmed: Vec<&str> = rendered.iter().map(|text| text.trim_end()).collect();
        match rendered.len() {
            0 | 1 => rendered.concat(),
            _ => trimmed.join("\n\n") + "\n\n",
        }
    }

    /// Its files, each with the findings about it.
    pub(crate) fn parts(&self, findings: Vec<Finding>) -> Vec<Part<'_>> {
        let Some(laid) = &self.laid else {
            return vec![Part {
                path: &self.path,
                document: self.document(),
                findings,
            }];
        };
        let (mut base, mut overlay) = (Vec::new(), Vec::new());
        for finding in findings {
            match laid.made.place(finding) {
                (Origin::Base, finding) => base.push(finding),
                (Origin::Overlay, finding) => overlay.push(finding),
            }
        }
        let mut parts = laid.base.parts(base);
        parts.push(Part {
            path: &laid.overlay.0,
            document: &laid.overlay.1,
            findings: overlay,
        });
        parts
    }

    /// A device with power off. Errors of a text are printed to standard error; the device runs
    /// with the valid rest, since masters accept such files, too.
    pub(crate) fn device(&self, node_id: Option<NodeId>) -> Result<VirtualDevice, Refused> {
        if let Some(kind) = self.kind {
            return Ok(VirtualDevice::new(kind, node_id.unwrap_or(NodeId::ONE)));
        }
        let options = EdsOptions {
            node_id,
            lenient: true,
        };
        let (mut device, mut findings) = VirtualDevice::read_eds(self.text(), options);
        findings.retain(Finding::is_unsound);
        self.note(&findings[..findings.len().min(SHOWN)], &Names::new());
        let path = &self.path;
        let recorded = recorded::read(self.text()).map_err(|why| format!("{path}, {why}"))?;
        if let (Some(device), Some(recorded)) = (&mut device, recorded) {
            device.play_recorded(recorded);
        }
        match device {
            Some(device) if findings.is_empty() => Ok(device),
            Some(device) if !device.dictionary().objects().is_empty() => {
                let count = report::plural(findings.len(), "error");
                output::error(&format!(
                    "{path} has {count}; odkit leaves out the invalid objects (`odkit check` shows all \
                     findings)"
                ));
                Ok(device)
            }
            _ => Err(format!(
                "{path} does not define any object with a value; is it an EDS or DCF file?"
            )
            .into()),
        }
    }
}

fn has_ending(path: &Path, ending: &str) -> bool {
    let own = path.extension();
    own.is_some_and(|own| own.eq_ignore_ascii_case(ending))
}

fn is_overlay(path: &Path) -> bool {
    has_ending(path, "overlay")
}

/// The base of an overlay: the file that its comment `;odkit-base=my.eds` names, otherwise the only EDS or DCF in its
/// folder.
///
/// # Errors
/// The base is missing or is an overlay; the text says what to do.
fn base_of(path: &Path, overlay: &Document) -> Result<String, String> {
    let folder = path.parent().unwrap_or(Path::new(""));
    let base = match od_eds::base_of(overlay.text()) {
        Some(named) => {
            let base = folder.join(*named);
            if !base.exists() {
                let line = named.span.line;
                let shown = base.display();
                return Err(format!("line {line}: the base {shown} does not exist"));
            }
            base
        }
        None => only_eds(folder)
            .ok_or("an overlay needs a base; add a first line `;odkit-base=my.eds`")?,
    };
    if is_overlay(&base) {
        return Err("the base is an overlay, too; name an EDS or a DCF".into());
    }
    Ok(base.display().to_string())
}

/// The only EDS or DCF in a folder.
fn only_eds(folder: &Path) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() {
        Path::new(".")
    } else {
        folder
    };
    let entries = fs::read_dir(folder).ok()?.flatten();
    let paths = entries.map(|entry| entry.path());
    let mut found = paths.filter(|path| has_ending(path, "eds") || has_ending(path, "dcf"));
    let first = found.next()?;
    found.next().is_none().then_some(first)
}

fn unknown(name: &str, error: &std::io::Error) -> Failure {
    if error.kind() != std::io::ErrorKind::NotFound {
        return Failure::Failed(format!("{name}: {}", read_error(error)));
    }
    let names: Vec<_> = DEVICES.iter().map(|kind| kind.name).collect();
    Failure::Failed(format!(
        "no built-in device or file is named `{name}`\nhelp: built-in devices are {}",
        names.join(", ")
    ))
}

/// The list of built-in devices, for the end of `--help`.
pub(crate) fn device_list() -> String {
    let mut list = String::from("Built-in devices:\n");
    for kind in DEVICES {
        list.push_str(&format!("  {:<8} {}\n", kind.name, kind.title));
    }
    list.push_str("\nExit codes: 0 success, 1 failure, 2 wrong usage\n");
    list
}
