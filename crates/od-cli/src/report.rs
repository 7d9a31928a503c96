//! Findings with their source line and a caret.

use std::borrow::Cow;
use std::collections::BTreeMap;

use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use od_eds::{Description, Eds, Finding, Label, Sentence, Severity, Span, say};
use od_model::{Address, Visible};

/// Objects and sub-objects in words: `2001h "Temperature"`.
pub(crate) type Names = BTreeMap<Address, String>;

/// The objects of findings, in words; a VAR is named without sub-index.
pub(crate) fn names(description: &Description, findings: &[Finding]) -> Names {
    let addresses = findings.iter().filter_map(|finding| finding.object);
    let named = addresses.filter_map(|address| {
        let object = description.objects.get(&address.index)?;
        let whole = address.sub == 0 && !object.code.has_members();
        let name = match object.entries.get(&address.sub) {
            Some(entry) if !whole => &entry.name,
            _ => &object.name,
        };
        let shown = if whole {
            format!("{:04X}h", address.index)
        } else {
            address.to_string()
        };
        let named = !name.is_empty();
        Some((
            address,
            if named {
                format!("{shown} \"{}\"", Visible(&of_a_line(name)))
            } else {
                shown
            },
        ))
    });
    named.collect()
}

/// A name that fits into a line.
fn of_a_line(name: &str) -> Cow<'_, str> {
    match name.char_indices().nth(100) {
        Some((at, _)) => Cow::Owned(format!("{}…", &name[..at])),
        None => Cow::Borrowed(name),
    }
}

/// `object 2001h "Temperature" (CiA 306-1, object sections)`
fn note(finding: &Finding, names: &Names) -> String {
    let source = finding.rule.source;
    match finding.object {
        Some(address) => match names.get(&address) {
            Some(name) => format!("object {name} ({source})"),
            None => format!("object {address} ({source})"),
        },
        None => source.to_owned(),
    }
}

/// The findings of a file as text, each followed by an empty line.
pub(crate) fn render(
    path: &str,
    text: &str,
    findings: &[Finding],
    names: &Names,
    colours: bool,
) -> String {
    let renderer = if colours {
        Renderer::styled()
    } else {
        Renderer::plain()
    };
    let renderer = renderer.decor_style(DecorStyle::Ascii);
    let mut out = String::new();
    for finding in findings {
        let sentence = say(finding, &Eds);
        let note = note(finding, names);
        out.push_str(&renderer.render(&[group(path, text, &sentence, &note)]));
        out.push_str("\n\n");
    }
    out
}

fn group<'a>(path: &'a str, text: &'a str, sentence: &'a Sentence, note: &'a str) -> Group<'a> {
    let level = match sentence.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
        Severity::Info => Level::INFO.with_name("remark"),
    };
    let snippets = snippets(path, text, sentence);
    let has_excerpt = !snippets.is_empty();
    let mut group = level
        .primary_title(short(&sentence.message))
        .id(sentence.code)
        .elements(snippets);
    if sentence.span.is_none() {
        group = group.element(annotate_snippets::Origin::path(path));
    } else if !has_excerpt {
        let place = sentence.span.unwrap_or_default();
        let origin = annotate_snippets::Origin::path(path)
            .line(place.line as usize)
            .char_column(place.column as usize);
        group = group.element(origin);
    }
    group = group.element(Level::NOTE.message(note));
    if !sentence.help.is_empty() {
        group = group.element(Level::HELP.message(sentence.help.as_str()));
    }
    group
}

/// The two ends of a message that quotes a very long text.
fn short(message: &str) -> Cow<'_, str> {
    const HEAD: usize = 200;
    const TAIL: usize = 80;
    let at = |(at, _)| at;
    let head = message.char_indices().nth(HEAD).map(at);
    let tail = message.char_indices().nth_back(TAIL).map(at);
    match (head, tail) {
        (Some(head), Some(tail)) if head < tail => {
            Cow::Owned(format!("{}…{}", &message[..head], &message[tail..]))
        }
        _ => Cow::Borrowed(message),
    }
}

/// Maximum distance in bytes of two places that are shown as one excerpt, and of a place from both ends of its line:
/// a longer line is not shown.
const FAR: u32 = 1 << 14;

/// The lines of the file that the finding is about.
fn snippets<'a>(
    path: &'a str,
    text: &'a str,
    sentence: &'a Sentence,
) -> Vec<Snippet<'a, annotate_snippets::Annotation<'a>>> {
    let Some(main) = sentence.span else {
        return Vec::new();
    };
    let is_near = |label: &&Label| {
        let span = label.span;
        span.start.abs_diff(main.start) <= FAR && span.end.abs_diff(main.end) <= FAR
    };
    let (near, far): (Vec<_>, Vec<_>) = sentence.labels.iter().partition(is_near);
    let own = snippet(path, text, Some(main), &near);
    let others = far
        .iter()
        .filter_map(|label| snippet(path, text, None, &[label]));
    own.into_iter().chain(others).collect()
}

/// The lines from the first to the last of these places.
fn snippet<'a>(
    path: &'a str,
    text: &'a str,
    main: Option<Span>,
    labels: &[&'a Label],
) -> Option<Snippet<'a, annotate_snippets::Annotation<'a>>> {
    let spans = labels.iter().map(|label| label.span).chain(main);
    let first = spans.clone().min_by_key(|span| span.start)?;
    let end = spans.map(|span| span.end).max()?;
    let bytes = text.as_bytes();
    let is_end = |byte: &u8| matches!(*byte, b'\n' | b'\r');
    let (first_byte, last) = (first.start as usize, end as usize);
    let near = first_byte.saturating_sub(FAR as usize);
    let before = bytes.get(near..first_byte)?;
    let start = match before.iter().rposition(is_end) {
        Some(at) => near + at + 1,
        None if near == 0 => 0,
        None => return None,
    };
    let behind = bytes.get(last..bytes.len().min(last + FAR as usize))?;
    let end = match behind.iter().position(is_end) {
        Some(at) => last + at,
        None if last + behind.len() == bytes.len() => bytes.len(),
        None => return None,
    };
    let shown = text
        .get(start..end)
        .filter(|shown| shown.len() <= 4 * FAR as usize)?;
    let range = |span: Span| {
        let from = (span.start as usize).saturating_sub(start).min(shown.len());
        from..(span.end as usize)
            .saturating_sub(start)
            .clamp(from, shown.len())
    };
    let snippet = Snippet::source(shown)
        .line_start(first.line as usize)
        .path(path)
        .annotations(main.map(|main| AnnotationKind::Primary.span(range(main))));
    Some(snippet.annotations(labels.iter().map(|label| {
        AnnotationKind::Context
            .span(range(label.span))
            .label(label.text.as_str())
    })))
}

/// `1 error, 3 warnings`; `None` if there are none.
pub(crate) fn count<'d>(findings: impl Iterator<Item = &'d Finding>) -> Option<String> {
    let mut counts = [0usize; 3];
    for finding in findings {
        counts[match finding.severity() {
            Severity::Error => 0,
            Severity::Warning => 1,
            Severity::Info => 2,
        }] += 1;
    }
    let parts: Vec<_> = counts
        .into_iter()
        .zip(["error", "warning", "remark"])
        .filter(|(count, _)| *count > 0)
        .map(|(count, what)| plural(count, what))
        .collect();
    (!parts.is_empty()).then(|| parts.join(", "))
}

/// `1 entry`, `2 entries`.
pub(crate) fn plural_of(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}

/// `1 file`, `2 files`.
pub(crate) fn plural(count: usize, what: &str) -> String {
    if count == 1 {
        format!("1 {what}")
    } else {
        format!("{count} {what}s")
    }
}
