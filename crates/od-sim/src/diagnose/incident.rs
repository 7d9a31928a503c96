//! An incident: a fault, from its first sign to its last.

use std::prelude::v1::*;

use od_wire::Instant;

/// A likely cause of an incident.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cause {
    /// Its name for programs, such as `same-node-id`.
    pub id: &'static str,
    /// The cause, in one sentence.
    pub text: String,
    /// First things to check.
    pub check: String,
}

impl Cause {
    pub(super) fn new(id: &'static str, text: impl Into<String>, check: impl Into<String>) -> Self {
        Self {
            id,
            text: text.into(),
            check: check.into(),
        }
    }
}

/// A fault in a log.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Incident {
    /// Name of the rule that found it.
    pub rule: &'static str,
    /// The incident in one sentence.
    pub text: String,
    /// The nodes that it is about; empty: the whole bus.
    pub nodes: Vec<u8>,
    /// Whether the log has times; without them begin and end say nothing.
    pub has_times: bool,
    /// Time of the first sign.
    pub begin: Instant,
    /// Time of the last sign, or of the recovery.
    pub end: Instant,
    /// Whether the bus was as before when the log ended.
    pub recovered: bool,
    /// Likely causes, in the order of likelihood.
    pub causes: Vec<Cause>,
    /// Places in the log of the records that show it, at most [`Incident::SHOWN`].
    pub records: Vec<usize>,
}

impl Incident {
    /// Greatest number of records in an incident.
    pub const SHOWN: usize = 8;

    /// Begin, end and whether the bus recovered: `1.500000 s to 2.300000 s, not recovered`. Without times only the
    /// last part.
    pub fn span(&self) -> String {
        let state = if self.recovered {
            "recovered"
        } else {
            "not recovered"
        };
        if self.has_times {
            format!("{:?} s to {:?} s, {state}", self.begin, self.end)
        } else {
            state.into()
        }
    }

    /// The incident as lines of text: what happened, when, each cause with its check, and the records that show it.
    /// `words` is the text of each record of the log. Lines are wrapped for a terminal, without those of the records.
    pub fn lines(&self, words: &[String]) -> Vec<String> {
        let mut lines = hanging("", &self.text);
        lines.push(self.span());
        for (place, cause) in (1..).zip(&self.causes) {
            let label = format!("cause {place}: ");
            lines.extend(hanging(&label, &cause.text));
            let check = format!("check {}", cause.check);
            lines.extend(hanging(&" ".repeat(label.len()), &check));
        }
        let shown = self.records.iter().filter_map(|place| words.get(*place));
        lines.extend(shown.cloned());
        lines
    }

    pub(super) fn new(text: impl Into<String>, begin: Instant, end: Instant) -> Self {
        Self {
            rule: "",
            text: text.into(),
            nodes: Vec::new(),
            has_times: true,
            begin,
            end,
            recovered: false,
            causes: Vec::new(),
            records: Vec::new(),
        }
    }

    pub(super) fn node(mut self, node: u8) -> Self {
        self.nodes.push(node);
        self
    }

    pub(super) fn recovered(mut self, recovered: bool) -> Self {
        self.recovered = recovered;
        self
    }

    pub(super) fn cause(mut self, cause: Cause) -> Self {
        self.causes.push(cause);
        self
    }

    pub(super) fn shows(mut self, records: impl IntoIterator<Item = usize>) -> Self {
        self.records.extend(records);
        self.records.sort_unstable();
        self.records.dedup();
        self.records.truncate(Self::SHOWN);
        self
    }
}

/// The width of a terminal, without a number before an incident.
const WIDTH: usize = 77;

/// The lines of a text behind a label; the others begin below its first word.
fn hanging(label: &str, text: &str) -> Vec<String> {
    let wrapped = wrapped(text, WIDTH - label.len());
    let labels = core::iter::once(label.to_owned());
    let labels = labels.chain(core::iter::repeat(" ".repeat(label.len())));
    let lines = labels.zip(wrapped.lines());
    lines.map(|(label, line)| label + line).collect()
}

/// Wraps words at about this width.
pub fn wrapped(text: &str, width: usize) -> String {
    let mut out = String::new();
    let mut column = 0;
    for word in text.split_whitespace() {
        let long = word.chars().count();
        if column > 0 && column + 1 + long > width {
            out.push('\n');
            column = 0;
        } else if column > 0 {
            out.push(' ');
            column += 1;
        }
        out.push_str(word);
        column += long;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_wrapped_between_words() {
        assert_eq!(wrapped("a bb ccc dddd", 6), "a bb\nccc\ndddd");
        let text = "word ".repeat(20);
        let lines = hanging("cause 1: ", &text);
        assert_eq!(lines.len(), 2);
        assert!(lines[0].starts_with("cause 1: word") && lines[1].starts_with("         word"));
        assert!(lines.iter().all(|line| line.len() <= WIDTH));
    }
}
