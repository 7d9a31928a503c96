//! Findings in the output of rustc: at the token that caused them, or at the path of the EDS with the place in
//! the file in the text.

use std::collections::BTreeMap;
use std::ops::Range;

use od_eds::patch::{Action, Edit};
use od_eds::row::Row;
use od_eds::{Description, Eds, Finding, Sentence, Severity, say, token_of};
use od_model::Address;
use proc_macro2::Span;

use crate::files::Files;
use crate::report::{Place, Report};

/// Limit of errors that are shown of one EDS file; the rest is counted.
const SHOWN: usize = 20;

/// Reports the findings about the file: those about the text of an edit at its token, the others at
/// `home`, the path. Each rule has one warning.
pub(crate) fn tell(
    findings: &[Finding],
    home: Span,
    files: Option<&Files>,
    description: &Description,
    report: &mut Report,
) {
    let mut shown = 0;
    let mut hidden = 0usize;
    let mut warned: BTreeMap<&str, (&Finding, usize)> = BTreeMap::new();
    for finding in findings
        .iter()
        .filter(|f| f.severity() >= Severity::Warning)
    {
        let place = report.token(finding);
        let at_token = || at_token(&say(finding, &Row), description, None);
        match (place, finding.is_unsound()) {
            (Some(place), true) => report.at(place, at_token()),
            (Some(place), false) => report.warn(place, finding.code(), at_token()),
            (None, false) => warned.entry(finding.code()).or_insert((finding, 0)).1 += 1,
            (None, true) if shown < SHOWN => {
                shown += 1;
                report.at(home, in_file(finding, description, files));
            }
            (None, true) => hidden += 1,
        }
    }
    let file = || files.map_or_else(|| "the file".into(), Files::shown);
    if hidden > 0 {
        let file = file();
        let help = format!("`odkit check {file}` shows them all");
        report.at(home, format!("{file}: {hidden} more errors\nhelp: {help}"));
    }
    for (code, (first, count)) in warned {
        let mut text = in_file(first, description, files);
        if count > 1 {
            let more = count - 1;
            text.push_str(&format!(
                "\nnote: {more} more; `odkit check {}` shows all",
                file()
            ));
        }
        report.warn(home, code, text);
    }
}

/// The edits of one patch, and the findings that they caused.
pub(crate) struct Patch<'a> {
    pub(crate) edits: &'a [Edit],
    /// The numbers of the edits' tokens.
    pub(crate) tokens: Range<u32>,
    /// The place of other findings: the variant's name, or the path.
    pub(crate) home: Span,
    /// "variant `x`: ", or nothing for the base.
    pub(crate) context: &'a str,
    pub(crate) files: Option<&'a Files>,
}

impl Patch<'_> {
    /// Reports errors of the edits themselves, at their tokens.
    pub(crate) fn tell(&self, faults: &[Finding], description: &Description, report: &mut Report) {
        for fault in faults {
            let mut told = say(fault, &Row);
            if fault.code() == "E0701" {
                self.help_to_find(fault, &mut told, report);
            }
            let place = report.token(fault).unwrap_or(Place::from(self.home));
            report.at(place, at_token(&told, description, None));
        }
    }

    /// The help for a missing object: its `add` may come later, and a table has no file to search.
    fn help_to_find(&self, fault: &Finding, told: &mut Sentence, report: &Report) {
        let own = |edit: &&Edit| Some(edit.target.span) == fault.span();
        let Some(edit) = self.edits.iter().find(own) else {
            return;
        };
        let target = *edit.target;
        let is_its = |other: &&Edit| other.action == Action::Add && *other.target == target;
        if let Some(later) = self.edits.iter().find(is_its) {
            let line = report.span(later.target.span).and_then(Place::line);
            let line = line.map_or(String::new(), |line| format!(" in line {line}"));
            told.help = format!("move this statement after `add {target}`{line}");
        } else if self.files.is_none() && told.help.contains("odkit dump") {
            told.help = format!("write `add {target} {{ … }}` first");
        }
    }

    /// Reports the findings that the edits caused.
    pub(crate) fn blame(
        &self,
        findings: &[Finding],
        description: &Description,
        report: &mut Report,
    ) {
        let mut warned: BTreeMap<_, (Place, String, usize)> = BTreeMap::new();
        for finding in findings
            .iter()
            .filter(|f| f.severity() >= Severity::Warning)
        {
            // A finding about a missing part of a file: a table has no [FileInfo].
            if self.files.is_none() && finding.object.is_none() && finding.span().is_none() {
                continue;
            }
            // A statement can correct a value of the file, such as a default, but not another key, such as one of
            // [DeviceInfo].
            let is_in_file = finding.span().is_some_and(|span| token_of(span).is_none());
            if is_in_file && !finding.rule.is_of_one_value() && !finding.is_unsound() {
                continue;
            }
            let own = finding.span().and_then(token_of);
            let own = own.filter(|id| self.tokens.contains(id));
            let mut told = say(finding, &Row);
            let place = match (own, self.culprit(finding)) {
                (None, Some(edit)) => {
                    if edit.action == Action::Remove {
                        told.help = without(edit, &told);
                    }
                    report.span(edit.target.span)
                }
                (Some(_), _) => report.token(finding),
                // The token of another patch: what it says is right without this one.
                (None, None) => None,
            };
            let text = at_token(&told, description, self.files);
            let text = format!("{}{text}", self.context);
            let place = place.unwrap_or(Place::from(self.home));
            if finding.is_unsound() {
                report.at(place, text);
                continue;
            }
            let edit = self
                .culprit(finding)
                .and_then(|edit| token_of(edit.target.span));
            let key = (finding.code(), own.or(edit));
            warned.entry(key).or_insert((place, text, 0)).2 += 1;
        }
        for ((code, _), (place, mut text, count)) in warned {
            if count > 1 {
                text.push_str(&format!("\nnote: {} more of this rule here", count - 1));
            }
            report.warn(place, code, text);
        }
    }

    /// The last edit of the object of the finding, or of an object among its facts.
    fn culprit(&self, finding: &Finding) -> Option<&Edit> {
        let last = |index: u16| self.edits.iter().rev().find(|e| e.target.index == index);
        let about = finding.object.and_then(|address| last(address.index));
        about.or_else(|| {
            let facts = finding.facts.iter();
            facts.filter_map(|(_, fact)| last(fact.index()?)).next()
        })
    }
}

/// The help for a finding that a `remove` caused.
fn without(edit: &Edit, finding: &Sentence) -> String {
    let target = *edit.target;
    let about = finding.address.map(|address| address.index);
    if about == Some(target.index) {
        format!("remove the statement `remove {target}`")
    } else {
        format!(
            "{}, or remove the statement `remove {target}`",
            finding.help
        )
    }
}

/// `[E0414] object 2300h:09 "Reset": message`, the help below.
fn at_token(finding: &Sentence, description: &Description, files: Option<&Files>) -> String {
    let mut text = heading(finding, description);
    let written = finding.span.filter(|span| token_of(*span).is_none());
    if let (Some(files), Some(span)) = (files, written) {
        text.push_str(&format!("\nnote: defined at {}", files.place(span)));
    }
    if !finding.help.is_empty() {
        text.push_str(&format!("\nhelp: {}", finding.help));
    }
    text
}

/// `file:line:column: [E0412] object 2300h:09 "Reset": message`, notes and help below.
fn in_file(finding: &Finding, description: &Description, files: Option<&Files>) -> String {
    let Some(files) = files else {
        return at_token(&say(finding, &Row), description, None);
    };
    let finding = say(finding, &Eds);
    let mut text = match finding.span {
        Some(span) => files.place(span),
        None => files.shown(),
    };
    text.push_str(": ");
    text.push_str(&heading(&finding, description));
    for label in &finding.labels {
        let place = files.place(label.span);
        text.push_str(&format!("\nnote: {place}: {}", label.text));
    }
    if !finding.help.is_empty() {
        text.push_str(&format!("\nhelp: {}", finding.help));
    }
    text
}

/// Code, object and message. Findings of a patch, and those about missing parts,
/// name their object in the message.
fn heading(finding: &Sentence, description: &Description) -> String {
    let about = finding
        .address
        .and_then(|address| label(address, description));
    match about {
        Some(about) if !finding.code.starts_with("E07") => {
            format!("[{}] object {about}: {}", finding.code, finding.message)
        }
        _ => format!("[{}] {}", finding.code, finding.message),
    }
}

fn label(address: Address, description: &Description) -> Option<String> {
    let object = description.objects.get(&address.index)?;
    Some(match object.entries.get(&address.sub) {
        Some(entry) if object.code.has_members() => format!("{address} {:?}", *entry.name),
        _ => format!("{:04X}h {:?}", address.index, *object.name),
    })
}

#[cfg(test)]
mod tests;
