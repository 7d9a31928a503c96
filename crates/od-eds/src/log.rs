//! Collects the findings of one text, with a limit for each rule.

use alloc::collections::BTreeMap;
use alloc::collections::btree_map::Entry;
use alloc::vec::Vec;

use crate::finding::{Finding, Rule};
use crate::rules::text::w0116_too_many_findings;
use crate::span::Span;

/// Limit of findings of one rule.
pub(crate) const KEPT: usize = 10_000;
/// Limit of sub-objects without a section of their own in a text.
pub(crate) const EXPANDED: usize = 50_000;

/// Findings in any order, and how much of each limit is left.
#[derive(Default)]
pub(crate) struct Log {
    findings: Vec<Finding>,
    counts: BTreeMap<&'static str, Count>,
    expanded: usize,
}

/// Findings of one rule.
struct Count {
    rule: &'static Rule,
    all: usize,
    /// Place of the first finding that was left out.
    first: Span,
}

impl Log {
    /// Keeps a finding, unless its rule has too many.
    pub(crate) fn push(&mut self, finding: Finding) {
        self.add(finding.rule, || finding);
    }

    /// Like [`push`](Self::push), for a finding that is only made if it is kept.
    pub(crate) fn add(&mut self, rule: &'static Rule, make: impl FnOnce() -> Finding) {
        let count = match self.counts.entry(rule.code) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(Count {
                rule,
                all: 0,
                first: Span::default(),
            }),
        };
        count.all += 1;
        if count.all <= KEPT {
            self.findings.push(make());
        } else if count.first.line == 0 {
            count.first = make().span().unwrap_or_default();
        }
    }

    /// Keeps findings, like [`push`](Self::push).
    pub(crate) fn extend(&mut self, findings: impl IntoIterator<Item = Finding>) {
        findings.into_iter().for_each(|finding| self.push(finding));
    }

    /// Takes over the findings of another log.
    #[cfg(feature = "xdd")]
    pub(crate) fn append(&mut self, other: Self) {
        self.extend(other.finish());
    }

    /// Counts sub-objects without a section. Returns whether the limit allows them.
    pub(crate) fn expand(&mut self, count: usize) -> bool {
        let fits = count <= EXPANDED - self.expanded;
        self.expanded += if fits { count } else { 0 };
        fits
    }

    /// The findings, with an additional one for each rule that has too many.
    pub(crate) fn finish(mut self) -> Vec<Finding> {
        let counts = self.counts.into_values();
        for count in counts.filter(|count| count.all > KEPT) {
            let finding =
                w0116_too_many_findings(count.first, count.rule.code, KEPT, count.all - KEPT);
            self.findings.push(finding);
        }
        self.findings
    }
}
