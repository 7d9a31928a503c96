//! A document with its fixes applied.

use alloc::vec::Vec;

use super::{Applicability, plan};
use crate::document::{Document, Edit};
use crate::finding::Finding;

/// Limit of rounds: a fix may make room for the next one.
const ROUNDS: usize = 16;

/// A document after [`fix`].
#[derive(Clone, PartialEq, Debug)]
pub struct Fixed {
    /// The document; unchanged if there was nothing to fix.
    pub document: Document,
    /// Number of places that were edited.
    pub edits: usize,
    /// Findings that are left.
    pub findings: Vec<Finding>,
}

/// Applies the fixes of a document up to `level`; `find` returns its findings.
///
/// A second run finds nothing to do. Every line without an edit keeps its bytes. A round
/// that would add errors is not made.
pub fn fix(
    document: &Document,
    level: Applicability,
    find: impl Fn(&Document) -> Vec<Finding>,
) -> Fixed {
    let mut fixed = Fixed {
        document: document.clone(),
        edits: 0,
        findings: find(document),
    };
    for _ in 0..ROUNDS {
        let edits: Vec<Edit> = plan(fixed.document.text(), &fixed.findings, level)
            .into_iter()
            .map(|edit| Edit {
                range: edit.start as usize..edit.end as usize,
                text: edit.text,
            })
            .collect();
        let mut document = fixed.document.clone();
        if edits.is_empty() || document.apply(&edits).is_err() {
            break;
        }
        let findings = find(&document);
        if errors(&findings) > errors(&fixed.findings) {
            break;
        }
        fixed = Fixed {
            document,
            edits: fixed.edits + edits.len(),
            findings,
        };
    }
    fixed
}

fn errors(findings: &[Finding]) -> usize {
    findings.iter().filter(|finding| finding.is_error()).count()
}
