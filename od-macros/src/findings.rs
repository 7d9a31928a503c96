//! The model's findings in rustc's output: at the token that made them, or at the
//! path of the EDS, with the place in the file in the text.

use std::ops::Range;

use od_eds::patch::{Action, Edit, Target};
use od_eds::{Description, Eds, Finding, Key, Sentence, Vocabulary, say, token_of};
use od_model::Address;
use proc_macro2::Span;

use crate::files::Files;
use crate::report::{Place, Report};

/// So many faults of one EDS file are shown; the rest is counted.
const SHOWN: usize = 20;

/// Tells the findings of the reader and of the checks about the file: those about
/// what an edit wrote at its token, the others at `home`, the path.
pub(crate) fn tell(
    findings: &[Finding],
    home: Span,
    files: Option<&Files>,
    description: &Description,
    report: &mut Report,
) {
    let mut shown = 0;
    let mut hidden = 0usize;
    for finding in findings.iter().filter(|f| f.is_error()) {
        if let Some(place) = report.token(finding) {
            report.at(place, at_token(&say(finding, &Row), description, None));
        } else if shown < SHOWN {
            shown += 1;
            report.at(home, in_file(finding, description, files));
        } else {
            hidden += 1;
        }
    }
    if hidden > 0 {
        let file = files.map_or_else(|| "the file".into(), Files::shown);
        let help = format!("`odkit check {file}` shows them all");
        report.at(home, format!("{file}: {hidden} more errors\nhelp: {help}"));
    }
}

/// The edits of one patch: whom to blame for what was sound before them.
pub(crate) struct Patch<'a> {
    pub(crate) edits: &'a [Edit],
    /// The numbers of their tokens.
    pub(crate) tokens: Range<u32>,
    /// Where nothing better is known: the variant's name, the path.
    pub(crate) home: Span,
    /// "variant `x`: ", or nothing for the base.
    pub(crate) context: &'a str,
    pub(crate) files: Option<&'a Files>,
}

impl Patch<'_> {
    /// Tells what the edits made unsound.
    pub(crate) fn blame(
        &self,
        findings: &[Finding],
        description: &Description,
        report: &mut Report,
    ) {
        for finding in findings.iter().filter(|f| f.is_error()) {
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
                _ => report.token(finding),
            };
            let text = at_token(&told, description, self.files);
            let place = place.unwrap_or(Place::from(self.home));
            report.at(place, format!("{}{text}", self.context));
        }
    }

    /// The last edit of an object that the finding is about, or that it names.
    fn culprit(&self, finding: &Finding) -> Option<&Edit> {
        let last = |index: u16| self.edits.iter().rev().find(|e| e.target.index == index);
        let about = finding.object.and_then(|address| last(address.index));
        about.or_else(|| {
            let message = say(finding, &Eds).message;
            self.edits
                .iter()
                .rev()
                .find(|edit| message.contains(&format!("{:04X}h", edit.target.index)))
        })
    }
}

/// How to mend what a `remove` made.
fn without(edit: &Edit, finding: &Sentence) -> String {
    let target = *edit.target;
    let about = finding.address.map(|address| address.index);
    match about == Some(target.index) {
        true => format!("leave `remove {target}` out"),
        false => format!("{}; or leave `remove {target}` out", finding.help),
    }
}

/// `[E0414] object 2300h:09 "Reset": message`, the help below.
fn at_token(finding: &Sentence, description: &Description, files: Option<&Files>) -> String {
    let mut text = heading(finding, description);
    let written = finding.span.filter(|span| token_of(*span).is_none());
    if let (Some(files), Some(span)) = (files, written) {
        text.push_str(&format!("\nnote: it stands at {}", files.place(span)));
    }
    if !finding.help.is_empty() {
        text.push_str(&format!("\nhelp: {}", finding.help));
    }
    in_words_of_the_macro(&text)
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

/// Code, object and message. Findings of a patch, and those about what is missing,
/// name their object themselves.
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

/// The words of a macro call: `low = 5` in the row of an object.
struct Row;

impl Vocabulary for Row {
    fn key(&self, key: Key) -> &'static str {
        match key {
            Key::ParameterName => "`name`",
            Key::ObjectType => "`code`",
            Key::DataType => "`type`",
            Key::AccessType => "`access`",
            Key::PdoMapping => "`mappable`",
            Key::DefaultValue => "`default`",
            Key::LowLimit => "`low`",
            Key::HighLimit => "`high`",
            Key::StorageLocation => "`save`",
            other => other.name(),
        }
    }

    fn set(&self, key: Key, value: &str) -> String {
        match (key, value) {
            (Key::PdoMapping, "0") => "mappable = false".into(),
            (Key::PdoMapping, "1") => "mappable = true".into(),
            _ => format!("{} = {value}", self.key(key).trim_matches('`')),
        }
    }

    fn section(&self, index: u16, sub: Option<u8>) -> String {
        format!("a row `add {} {{ … }}`", Target { index, sub })
    }
}

/// The checks speak of the keys of an EDS; beside a row they are its fields.
fn in_words_of_the_macro(text: &str) -> String {
    const WORDS: [(&str, &str); 10] = [
        ("DefaultValue=", "default = "),
        ("DefaultValue", "`default`"),
        ("LowLimit", "`low`"),
        ("HighLimit", "`high`"),
        ("PDOMapping=1", "mappable = true"),
        ("PDOMapping=0", "mappable = false"),
        ("AccessType=", "access = "),
        ("ParameterName=", "name = "),
        ("DataType=", "type = "),
        ("ObjectType=", "code = "),
    ];
    let mut text = text.to_string();
    for (eds, here) in WORDS {
        text = text.replace(eds, here);
    }
    // "write a section [1018]"
    while let Some(at) = text.find("a section [") {
        let (before, after) = text.split_at(at);
        let after = after.trim_start_matches("a section [");
        let Some((target, after)) = after.split_once(']') else {
            break;
        };
        text = format!("{before}`add 0x{target} {{ … }}`{after}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_has_fields_and_not_keys() {
        for (eds, here) in [
            ("write `DefaultValue=2`", "write `default = 2`"),
            (
                "DefaultValue 3 is below LowLimit 5",
                "`default` 3 is below `low` 5",
            ),
            ("write a section [1018sub0]", "write `add 0x1018sub0 { … }`"),
            ("a section [", "a section ["),
        ] {
            assert_eq!(in_words_of_the_macro(eds), here);
        }
    }
}
