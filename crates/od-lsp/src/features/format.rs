//! Formats a file: brings it into its canonical form and keeps its comments.
//!
//! The text is that of `odkit convert`, which has no comments. So each comment moves to the new place of
//! the line below it. Lines that odkit cannot read become comments, so nothing is lost.

use std::collections::{BTreeMap, BTreeSet};

use od_eds::convert::lost;
use od_eds::outline;
use od_eds::{Parsed, canonical, complete};

use crate::file::{self, File, Kind, Seen};
use crate::layout::{Layout, Section};
use crate::mentions::plain;
use crate::types::TextEdit;

/// The edits that bring a file into its canonical form.
///
/// # Errors
/// Reason why the file has no canonical form.
pub(crate) fn edits(file: &File, seen: &Seen) -> Result<Vec<TextEdit>, String> {
    if file.kind != Kind::Eds || od_eds::is_xml(file.str()) {
        return Err("only EDS and DCF files have a canonical form".into());
    }
    let Parsed { findings, .. } = od_eds::parse(file.str());
    if let Some(finding) = lost::unread(&findings).first() {
        let line = finding.span().map_or(0, |span| span.line);
        return Err(format!("correct {} in line {line} first", finding.code()));
    }
    let plain = canonical(&seen.description);
    let again = od_eds::parse(&plain).description;
    if again.objects != complete(&seen.description).objects {
        return Err("the file has content that its canonical form cannot hold".into());
    }
    let made = Comments::of(file, &seen.layout).into(&plain);
    let text = if file.str().contains("\r\n") {
        made.replace('\n', "\r\n")
    } else {
        made
    };
    Ok(file::edits(file, &format!("{}{text}", file.mark())))
}

/// Name of a section in the canonical form, in lower case.
fn known(name: &str) -> String {
    let own = outline::place(name).name();
    let own = own.unwrap_or_else(|| match name.to_ascii_lowercase().as_str() {
        "devicecommissioning" => "DeviceComissioning".into(),
        _ => name.into(),
    });
    own.to_ascii_lowercase()
}

/// Comments to write above a header (no key) or above a key.
#[derive(Default)]
struct Comments {
    /// Above the whole text.
    top: Vec<String>,
    at: BTreeMap<(String, Option<String>), Vec<String>>,
    /// Directly below the header.
    below: BTreeMap<String, Vec<String>>,
    /// After the whole text.
    end: Vec<String>,
}

impl Comments {
    fn of(file: &File, layout: &Layout) -> Self {
        let text = file.str();
        let mut comments = Self::default();
        let mut headers = layout.sections.iter().peekable();
        let mut section: Option<&Section> = None;
        let mut pairs = Vec::new().into_iter().peekable();
        let mut waiting: Vec<String> = Vec::new();
        let mut written = BTreeSet::new();
        for number in 0..file.text.lines() {
            let line = file.text.line(number);
            let own = file.part(line.clone()).trim();
            let own = own.trim_start_matches('\u{FEFF}');
            if let Some(next) = headers.next_if(|next| line.contains(&next.header.start)) {
                let name = known(file.part(next.name.clone()));
                match section {
                    None => comments.top.append(&mut waiting),
                    Some(_) => {
                        let lines = comments.at.entry((name, None)).or_default();
                        lines.append(&mut waiting);
                    }
                }
                section = Some(next);
                let own: Vec<_> = next.pairs.iter().collect();
                pairs = own.into_iter().peekable();
                continue;
            }
            let pair = pairs.next_if(|pair| line.contains(&pair.key.start));
            let name = section.map(|section| known(file.part(section.name.clone())));
            let name = name.unwrap_or_default();
            if let Some(pair) = pair {
                let key = file.part(pair.key.clone()).to_ascii_lowercase();
                if !written.insert((name.clone(), key.clone())) {
                    // The first one is used.
                    waiting.push(commented(own));
                    continue;
                }
                let behind = file.part(plain(text, pair).end..pair.value.end).trim();
                if behind.starts_with([';', '#']) && !is_text(&key) {
                    waiting.push(commented(behind));
                }
                let lines = comments.at.entry((name, Some(key))).or_default();
                lines.append(&mut waiting);
            } else if is_word(own, "odkit-allow") && section.is_some() {
                // It belongs to the section around it.
                comments.below.entry(name).or_default().push(own.into());
            } else if !own.is_empty() && !is_word(own, "StorageLocation") {
                waiting.push(commented(own));
            }
        }
        match section {
            Some(_) => comments.end = waiting,
            None => comments.top.append(&mut waiting),
        }
        comments
    }

    /// The canonical text with the comments; a comment without a place comes last.
    fn into(mut self, plain: &str) -> String {
        let mut out = String::with_capacity(plain.len());
        let put = |lines: Vec<String>, out: &mut String| {
            for line in lines {
                out.push_str(&line);
                out.push('\n');
            }
        };
        if !self.top.is_empty() {
            put(std::mem::take(&mut self.top), &mut out);
            out.push('\n');
        }
        self.find_places(plain);
        let mut section = String::new();
        for line in plain.lines() {
            if let Some(name) = header(line) {
                section = name;
                put(
                    self.at.remove(&(section.clone(), None)).unwrap_or_default(),
                    &mut out,
                );
                out.push_str(line);
                out.push('\n');
                put(self.below.remove(&section).unwrap_or_default(), &mut out);
                continue;
            }
            if let Some((key, _)) = line.split_once('=') {
                let key = (section.clone(), Some(key.trim().to_ascii_lowercase()));
                put(self.at.remove(&key).unwrap_or_default(), &mut out);
            }
            out.push_str(line);
            out.push('\n');
        }
        put(self.end, &mut out);
        out
    }

    /// Finds another place for comments of sections and keys that the canonical form lacks:
    /// below the header of their section or object, otherwise at the end.
    fn find_places(&mut self, plain: &str) {
        let mut keys: BTreeSet<(String, Option<String>)> = BTreeSet::new();
        let mut section = String::new();
        for line in plain.lines() {
            match (header(line), line.split_once('=')) {
                (Some(name), _) => {
                    keys.insert((name.clone(), None));
                    section = name;
                }
                (None, Some((key, _))) => {
                    let key = key.trim().to_ascii_lowercase();
                    keys.insert((section.clone(), Some(key)));
                }
                (None, None) => {}
            }
        }
        let home = |name: &str| {
            let object = name.get(..4).unwrap_or(name);
            let mut names = [name, object].into_iter().map(str::to_owned);
            names.find(|name| keys.contains(&(name.clone(), None)))
        };
        let all = std::mem::take(&mut self.at).into_iter();
        let (at, lost): (Vec<_>, Vec<_>) = all.partition(|(key, _)| keys.contains(key));
        self.at = at.into_iter().collect();
        let below = std::mem::take(&mut self.below).into_iter();
        for (name, mut lines) in
            below.chain(lost.into_iter().map(|((name, _), lines)| (name, lines)))
        {
            match home(&name) {
                Some(home) => self.below.entry(home).or_default().append(&mut lines),
                None => self.end.append(&mut lines),
            }
        }
    }
}

fn header(line: &str) -> Option<String> {
    let name = line.strip_prefix('[')?.strip_suffix(']')?;
    Some(known(name))
}

fn commented(line: &str) -> String {
    if line.starts_with([';', '#']) {
        line.into()
    } else {
        format!(";{line}")
    }
}

/// A comment of odkit or of another tool that begins with this word.
fn is_word(line: &str, word: &str) -> bool {
    let body = line.strip_prefix([';', '#']).map(str::trim_start);
    let start = body.and_then(|body| body.get(..word.len()));
    start.is_some_and(|start| start.eq_ignore_ascii_case(word))
}

/// Returns whether the value includes the text after a `;`.
fn is_text(key: &str) -> bool {
    matches!(
        key,
        "parametername"
            | "denotation"
            | "filename"
            | "description"
            | "createdby"
            | "modifiedby"
            | "vendorname"
            | "productname"
            | "ordercode"
    ) || key.starts_with("line")
}
