//! Fixes: they end, never add an error, leave nothing to fix for a second run, and safe ones do not
//! change the meaning of a file.

use od_eds::Document;
use od_eds::fix::{Applicability, fix};

use super::eds;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "fix",
    run,
    seeds: eds::seeds,
    words: eds::WORDS,
    is_text: true,
    longest: 8192,
    ..Target::PLAIN
};

pub(super) fn run(input: &[u8]) {
    let before = Document::new(input);
    let loaded = before.load();
    let errors = |findings: &[od_eds::Finding]| findings.iter().filter(|f| f.is_error()).count();
    for level in [Applicability::Safe, Applicability::Unsafe] {
        let fixed = fix(&before, level, |file| file.load().findings);
        let shown = || String::from_utf8_lossy(fixed.document.bytes()).into_owned();
        let after = fixed.document.load();
        assert_eq!(after.findings, fixed.findings, "{level:?}: {}", shown());
        assert!(
            errors(&after.findings) <= errors(&loaded.findings),
            "{level:?} fixes add an error:\n{}",
            shown()
        );
        if fixed.edits == 0 {
            assert_eq!(fixed.document.bytes(), before.bytes(), "{level:?}");
        }
        let again = fix(&fixed.document, level, |file| file.load().findings);
        assert!(
            again.edits == 0,
            "a second run of {level:?} fixes has {} edits:\n{}\nbecomes\n{}",
            again.edits,
            shown(),
            String::from_utf8_lossy(again.document.bytes())
        );
        if level == Applicability::Safe {
            eds::same_values(&loaded.description, &after.description, &shown());
        }
    }
}
