//! Reads a device description of any format, and checks it: `parse`, `load`, `Document`.

#[cfg(feature = "xdd")]
use alloc::collections::BTreeSet;
use alloc::vec::Vec;

use crate::allow::Allows;
use crate::check::run;
use crate::description::Description;
use crate::document::{Document, is_xml};
use crate::finding::{Finding, sort};
use crate::fix::Fix;
use crate::log::{KEPT, Log};
use crate::read::{modules, sorted};
#[cfg(feature = "xdd")]
use crate::rules::lists::W0216;
#[cfg(feature = "xdd")]
use crate::rules::text::E0115;
use crate::rules::text::{i0111_not_ascii, w0112_encoding, w0122_control_character};
#[cfg(feature = "xdd")]
use crate::rules::values::{E0401, reader::W0404};
use crate::scan::encoding::Encoding;
use crate::scan::lines;
use crate::scan::section::TextSection;
#[cfg(feature = "xdd")]
use crate::xdd;

/// Reads an EDS or a DCF; with feature `xdd`, also an XDD or an XDC.
///
/// It never fails and never panics: each unreadable part becomes a finding, and text in the `extra` of its
/// object or section. It does not check: see [`check`](crate::check::check) and [`load`].
pub fn parse(text: &str) -> Parsed {
    let mut log = Log::default();
    let description = read(text, None, &mut |_| {}, &mut log);
    ordered(description, log.finish(), text)
}

/// Reads and checks a text: [`parse`], then [`check`](crate::check::check), without the findings that the
/// text [allows](crate::check::Allows).
pub fn load(text: &str) -> Parsed {
    let mut log = Log::default();
    let description = read(text, None, &mut |_| {}, &mut log);
    checked(description, log, text)
}

impl Document {
    /// Reads the file like [`parse`](crate::parse()), and reports problems of its encoding.
    pub fn parse(&self) -> Parsed {
        let (description, log) = self.read(&mut |_| {});
        ordered(description, log.finish(), self.text())
    }

    /// Reads and checks the file like [`load`](crate::load()), and reports problems of its encoding.
    pub fn load(&self) -> Parsed {
        self.load_with(&mut |_| {})
    }

    /// Like [`load`](Self::load). `see` receives the sections that [`outline::sections`](crate::outline::sections)
    /// finds; of an XDD it receives what its elements say as sections of an EDS, with the places of the attributes.
    pub fn load_with(&self, see: &mut dyn FnMut(&[TextSection<'_>])) -> Parsed {
        let (description, log) = self.read(see);
        checked(description, log, self.text())
    }

    fn read(&self, see: &mut dyn FnMut(&[TextSection<'_>])) -> (Description, Log) {
        let mut log = Log::default();
        let description = read(self.text(), self.file_name.as_deref(), see, &mut log);
        log.extend(encoded(self));
        (description, log)
    }
}

/// Reads a text in its form.
fn read(
    text: &str,
    file: Option<&str>,
    see: &mut dyn FnMut(&[TextSection<'_>]),
    log: &mut Log,
) -> Description {
    #[cfg(feature = "xdd")]
    if is_xml(text) {
        return xdd::parse(text, file, see, log);
    }
    let description = sorted::eds(text, file, see, log);
    modules::check(&description, log);
    description
}

fn checked(description: Description, mut log: Log, text: &str) -> Parsed {
    run(&description, &mut log);
    let mut findings = log.finish();
    Allows::of(text).apply(&mut findings);
    ordered(description, findings, text)
}

/// Puts the findings in file order.
#[cfg_attr(not(feature = "xdd"), allow(unused_variables))]
fn ordered(description: Description, findings: Vec<Finding>, text: &str) -> Parsed {
    let mut parsed = Parsed {
        description,
        findings,
    };
    sort(&mut parsed.findings);
    #[cfg(feature = "xdd")]
    if is_xml(text) {
        // An XDD has other elements in place of the keys of an EDS.
        parsed
            .findings
            .retain(|finding| finding.code() != W0216.code);
        // A missing parameter has no type and no access.
        let parameters = parsed.findings.iter();
        let parameters = parameters.filter(|finding| finding.code() == E0115.code);
        let parameters = parameters.filter_map(Finding::span);
        let parameters: BTreeSet<u32> = parameters.map(|span| span.start).collect();
        let follows = |finding: &Finding| {
            let is_of_value = [E0401.code, W0404.code].contains(&finding.code());
            let tag = finding.span().filter(|_| is_of_value);
            tag.is_some_and(|tag| parameters.range(tag.start..tag.end).next().is_some())
        };
        parsed.findings.retain(|finding| !follows(finding));
        for finding in &mut parsed.findings {
            finding.is_xml = true;
            let fix = finding.fix.take();
            finding.fix = fix.and_then(|fix| xdd::fixes::in_xml(fix, text));
        }
    }
    parsed
}

/// Findings about the encoding.
fn encoded(document: &Document) -> Vec<Finding> {
    let (text, encoding) = (document.text(), document.encoding());
    let mut found = Vec::new();
    // XML names its encoding, and every XML reader supports these.
    if encoding != Encoding::Ascii && !is_xml(text) {
        let first = text.find(|c: char| !c.is_ascii());
        let first = lines::span(text, first.unwrap_or(0));
        found.push(i0111_not_ascii(first, encoding, document.has_mark()));
    }
    if let Some(at) = document.first_wrong() {
        found.push(w0112_encoding(lines::span(text, at), encoding));
    }
    if !is_xml(text) {
        let lines = lines::lines(text).filter(|line| line.text.len() <= lines::LONGEST);
        found.extend(lines.filter_map(|line| controls(&line)).take(KEPT + 1));
    }
    found
}

/// The finding about the control characters of a line. A tab is a blank, and 1Ah is the end of a file of DOS.
fn controls(line: &lines::Line<'_>) -> Option<Finding> {
    let is_plain = |byte: u8| matches!(byte, b' '..=b'~' | b'\t');
    if line.text.bytes().all(is_plain) {
        return None;
    }
    let is_wrong = |c: char| c.is_control() && !matches!(c, '\t' | '\u{1A}');
    let found = line.text.matches(is_wrong).take(REMOVED + 1);
    let found: Vec<&str> = found.collect();
    let first = found.first()?;
    let finding = w0122_control_character(line.span(first), first.chars().next()?);
    let mut fix = Fix::unsafe_fix();
    for c in &found {
        fix = fix.replace(line.span(c), "");
    }
    Some(if found.len() <= REMOVED {
        finding.fix(fix)
    } else {
        finding
    })
}

/// Maximum number of control characters that a fix removes from a line; a line with more is no text.
const REMOVED: usize = 16;

/// A description, and the findings about its text.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Parsed {
    /// Everything that odkit could read.
    pub description: Description,
    /// The problems, in file order.
    pub findings: Vec<Finding>,
}
