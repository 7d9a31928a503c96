//! Applies the fixes of a document round by round, except harmful ones.

use alloc::collections::{BTreeMap, BTreeSet};
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use od_model::Address;

use super::Applicability;
use super::plan::{Choice, choose};
use crate::catalogue::{Eds, say};
use crate::document::{Document, Edit, EditError};
use crate::finding::Finding;
use crate::scan::encoding::Encoding;

/// Limit of rounds: a fix may make another one possible.
const ROUNDS: usize = 64;
/// Limit of runs over all rounds.
const RUNS: usize = 8;
/// Limit of rounds while a rule has too many findings to show all of them; each makes 10,000 fixes of the rule.
const CAPPED_ROUNDS: usize = 3;
/// Limit of documents that are read again to find harmful fixes.
const TRIALS: usize = 1000;
/// Rounds that are remembered to detect fixes that undo each other.
const PAST: usize = 8;

/// A document after [`fix`].
#[derive(Clone, PartialEq, Debug)]
pub struct Fixed {
    /// The document; unchanged if there was nothing to fix.
    pub document: Document,
    /// Number of places that were edited.
    pub edits: usize,
    /// Remaining findings.
    pub findings: Vec<Finding>,
    /// Fixes that were not applied, each with its finding in the present or an earlier document.
    pub held: Vec<Held>,
}

/// A fix that was not applied.
#[derive(Clone, PartialEq, Debug)]
pub struct Held {
    /// Its finding.
    pub finding: Finding,
    /// The reason.
    pub why: Why,
}

/// Reason why a fix was not applied.
#[derive(Clone, PartialEq, Debug)]
pub enum Why {
    /// It would add this error.
    Adds(Finding),
    /// It would not remove its finding, or another fix undoes it.
    Stays,
    /// The encoding of the file lacks this character.
    NoCharacter(char, Encoding),
}

/// The reason as a clause.
impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Adds(error) => {
                let error = say(error, &Eds);
                write!(f, "it would add {}: {}", error.code, error.with_object())
            }
            Self::Stays => f.write_str("the finding would stay, or another fix would undo it"),
            Self::NoCharacter(c, encoding) => {
                write!(f, "{encoding}, the encoding of the file, lacks `{c}`")
            }
        }
    }
}

/// Applies the fixes of a document up to `level`; `find` returns its findings.
///
/// A second run changes nothing, unless a rule has more than 10,000 findings: then each run makes a part of its fixes. Every
/// line without an edit keeps its bytes. A fix that would add an error, or that would not remove its finding, is left out;
/// the others are applied.
pub fn fix(
    document: &Document,
    level: Applicability,
    find: impl Fn(&Document) -> Vec<Finding>,
) -> Fixed {
    let mut state = State {
        document: document.clone(),
        findings: find(document),
        edits: 0,
    };
    let mut held = Vec::new();
    // A fix that was left out may be harmless after the others: repeat until a run changes nothing.
    for _ in 0..RUNS {
        let before = state.edits;
        let mut run = Run {
            find: &find,
            held: Vec::new(),
            refused: BTreeSet::new(),
            trials: TRIALS,
        };
        state = run.rounds(state, level);
        held = run.held;
        if held.is_empty() || state.edits == before || state.is_capped() {
            break;
        }
    }
    Fixed {
        document: state.document,
        edits: state.edits,
        findings: state.findings,
        held,
    }
}

/// A document between two rounds.
#[derive(Clone)]
struct State {
    document: Document,
    findings: Vec<Finding>,
    edits: usize,
}

impl State {
    fn errors(&self) -> usize {
        errors(&self.findings).count()
    }

    /// Returns whether a rule has too many findings to show all of them.
    fn is_capped(&self) -> bool {
        self.findings.iter().any(|one| one.code() == "W0116")
    }
}

fn errors(findings: &[Finding]) -> impl Iterator<Item = &Finding> {
    findings.iter().filter(|finding| finding.is_error())
}

/// The same problem at the same object or in the same section, wherever in the text.
type Fault = (&'static str, Option<Address>, Vec<u8>, String);

impl State {
    fn fault(&self, finding: &Finding) -> Fault {
        let said = say(finding, &Eds).message;
        let section = match (finding.object, finding.span()) {
            (None, Some(span)) => self.section(span.start as usize),
            _ => &[],
        };
        (finding.code(), finding.object, section.to_vec(), said)
    }

    /// Counts each problem.
    fn counts<'a>(&self, findings: impl Iterator<Item = &'a Finding>) -> BTreeMap<Fault, usize> {
        let mut counts = BTreeMap::new();
        findings.for_each(|finding| *counts.entry(self.fault(finding)).or_default() += 1);
        counts
    }

    /// The name of the section at a position; empty if the header is far above.
    fn section(&self, at: usize) -> &[u8] {
        const FAR: usize = 4096;
        let bytes = self.document.text().as_bytes();
        let above = &bytes[at.saturating_sub(FAR).min(bytes.len())..at.min(bytes.len())];
        let start = above
            .windows(2)
            .rposition(|pair| matches!(pair, [b'\n' | b'\r', b'[']));
        let name = start.map_or(&[][..], |start| &above[start + 1..]);
        let end = name
            .iter()
            .position(|byte| matches!(byte, b']' | b'\n' | b'\r'));
        &name[..end.unwrap_or(name.len())]
    }
}

/// Reason why a set of fixes is not applied.
enum Refusal {
    Adds(Vec<Finding>),
    Stays(BTreeSet<Fault>),
    NoCharacter(char),
}

struct Run<'f> {
    find: &'f dyn Fn(&Document) -> Vec<Finding>,
    held: Vec<Held>,
    /// Problems whose fixes are left out.
    refused: BTreeSet<Fault>,
    trials: usize,
}

impl Run<'_> {
    fn rounds(&mut self, mut state: State, level: Applicability) -> State {
        let mut past: Vec<(State, BTreeSet<Fault>)> = Vec::new();
        let (mut rounds, mut capped) = (0, 0);
        while rounds < ROUNDS && capped < CAPPED_ROUNDS {
            let refused = &self.refused;
            let may =
                |finding: &Finding| refused.is_empty() || !refused.contains(&state.fault(finding));
            let choices = choose(state.document.text(), &state.findings, level, may);
            if choices.is_empty() {
                break;
            }
            let held = self.held.len();
            let (made, next) = self.make(&state, choices);
            let Some(next) = next else {
                // All of them were left out; fixes that they blocked may come next.
                debug_assert!(self.held.len() > held);
                continue;
            };
            if state.is_capped() {
                past.clear();
                capped += 1;
            } else {
                let faults = made
                    .iter()
                    .map(|choice| state.fault(&state.findings[choice.finding]));
                let faults = faults.collect();
                past.push((state, faults));
                rounds += 1;
            }
            let text = next.document.text();
            let seen = past
                .iter()
                .rposition(|(old, _)| old.document.text() == text);
            state = match seen {
                None => next,
                Some(at) => {
                    // If fixes undo each other, the document stays as it was before the first of them.
                    let circle: Vec<_> = past.drain(at..).collect();
                    for (old, faults) in &circle {
                        for finding in &old.findings {
                            if finding.fix.is_some() && faults.contains(&old.fault(finding)) {
                                self.hold(old, finding, Why::Stays);
                            }
                        }
                    }
                    match circle.into_iter().next() {
                        Some((first, _)) => first,
                        None => next,
                    }
                }
            };
            if past.len() > PAST {
                past.remove(0);
            }
        }
        state
    }

    fn hold(&mut self, state: &State, finding: &Finding, why: Why) {
        if self.refused.insert(state.fault(finding)) {
            let finding = finding.clone();
            self.held.push(Held { finding, why });
        }
    }

    /// Applies as many harmless fixes as possible, and returns which.
    fn make(&mut self, base: &State, choices: Vec<Choice>) -> (Vec<Choice>, Option<State>) {
        let mut made: (Vec<Choice>, Option<State>) = (Vec::new(), None);
        let mut sets = alloc::vec![choices];
        while let Some(set) = sets.pop() {
            let all: Vec<&Choice> = made.0.iter().chain(&set).collect();
            let refusal = match self.attempt(base, made.1.as_ref().unwrap_or(base), &all) {
                Ok(state) => {
                    made.0.extend(set);
                    made.1 = Some(state);
                    continue;
                }
                Err(refusal) => refusal,
            };
            self.trials = self.trials.saturating_sub(1);
            if set.len() == 1 || self.trials == 0 {
                for choice in &set {
                    let finding = &base.findings[choice.finding];
                    let why = match &refusal {
                        Refusal::Adds(errors) => {
                            errors.first().cloned().map_or(Why::Stays, Why::Adds)
                        }
                        Refusal::Stays(_) => Why::Stays,
                        Refusal::NoCharacter(c) => Why::NoCharacter(*c, base.document.encoding()),
                    };
                    self.hold(base, finding, why);
                }
                continue;
            }
            let is_suspect = |choice: &Choice| {
                let finding = &base.findings[choice.finding];
                let index = |finding: &Finding| finding.object.map(|object| object.index);
                match &refusal {
                    Refusal::Adds(errors) => {
                        let same = |error: &Finding| index(error) == index(finding);
                        errors.iter().any(same)
                    }
                    Refusal::Stays(faults) => faults.contains(&base.fault(finding)),
                    Refusal::NoCharacter(c) => {
                        choice.edits.iter().any(|edit| edit.text.contains(*c))
                    }
                }
            };
            let (mut last, mut first): (Vec<_>, Vec<_>) = set.into_iter().partition(is_suspect);
            if first.is_empty() {
                first = last;
                last = first.split_off(first.len() / 2);
            } else if last.is_empty() {
                last = first.split_off(first.len() / 2);
            }
            sets.extend([last, first]);
        }
        made
    }

    /// The document with these fixes; `before` is the document with all applied fixes.
    fn attempt(&self, base: &State, before: &State, choices: &[&Choice]) -> Result<State, Refusal> {
        let edits = choices.iter().flat_map(|choice| &choice.edits);
        let edits: Vec<Edit> = edits
            .map(|edit| Edit {
                range: edit.start as usize..edit.end as usize,
                text: edit.text.clone(),
            })
            .collect();
        let mut document = base.document.clone();
        match document.apply(&edits) {
            Ok(()) => {}
            Err(EditError::NoCharacter(c, _)) => return Err(Refusal::NoCharacter(c)),
            Err(_) => return Err(Refusal::Stays(BTreeSet::new())),
        }
        let findings = (self.find)(&document);
        let state = State {
            document,
            findings,
            edits: base.edits + edits.len(),
        };
        if state.errors() > before.errors() {
            let [old, now] = [before, &state].map(|state| state.counts(errors(&state.findings)));
            let is_new = |error: &&Finding| {
                let of = state.fault(error);
                now.get(&of) > old.get(&of)
            };
            let new = errors(&state.findings).filter(is_new);
            return Err(Refusal::Adds(new.cloned().collect()));
        }
        if !base.is_capped() {
            let made = choices.iter().map(|choice| &base.findings[choice.finding]);
            let codes: BTreeSet<_> = made.clone().map(Finding::code).collect();
            let [old, now] = [base, &state].map(|state| {
                let all = state.findings.iter();
                state.counts(all.filter(|finding| codes.contains(finding.code())))
            });
            let of =
                |counts: &BTreeMap<Fault, usize>, of: &Fault| counts.get(of).copied().unwrap_or(0);
            let made = base.counts(made).into_iter();
            let stays = made.filter(|(fault, made)| of(&now, fault) + made > of(&old, fault));
            let stays: BTreeSet<Fault> = stays.map(|(fault, _)| fault).collect();
            if !stays.is_empty() {
                return Err(Refusal::Stays(stays));
            }
        }
        Ok(state)
    }
}
