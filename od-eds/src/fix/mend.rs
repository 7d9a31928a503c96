//! A document, mended.

use alloc::vec::Vec;

use super::{Applicability, plan};
use crate::document::{Document, Edit};
use crate::finding::Finding;

/// So many rounds at most: a fix may make room for the next one, but not for ever.
const ROUNDS: usize = 16;

/// What [`mend`] made of a document.
#[derive(Clone, PartialEq, Debug)]
pub struct Mended {
    /// The document; as it was where nothing was to be mended.
    pub document: Document,
    /// How many places were edited.
    pub edits: usize,
    /// What is left to say about it.
    pub findings: Vec<Finding>,
}

/// Mends a document as far as fixes up to `level` go; `find` says what is wrong with it.
///
/// A second run finds nothing to do. Every line without an edit keeps its bytes. A round
/// that would bring errors is not made.
pub fn mend(
    document: &Document,
    level: Applicability,
    find: impl Fn(&Document) -> Vec<Finding>,
) -> Mended {
    let mut mended = Mended {
        document: document.clone(),
        edits: 0,
        findings: find(document),
    };
    for _ in 0..ROUNDS {
        let edits: Vec<Edit> = plan(mended.document.text(), &mended.findings, level)
            .into_iter()
            .map(|edit| Edit {
                range: edit.start as usize..edit.end as usize,
                text: edit.text,
            })
            .collect();
        let mut document = mended.document.clone();
        if edits.is_empty() || document.apply(&edits).is_err() {
            break;
        }
        let findings = find(&document);
        if errors(&findings) > errors(&mended.findings) {
            break;
        }
        mended = Mended {
            document,
            edits: mended.edits + edits.len(),
            findings,
        };
    }
    mended
}

fn errors(findings: &[Finding]) -> usize {
    findings.iter().filter(|finding| finding.is_error()).count()
}
