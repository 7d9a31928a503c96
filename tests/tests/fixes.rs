//! Harmful fixes are left out one by one; all others are applied.

use od_eds::fix::{Applicability, Fixed, Why, fix};
use od_eds::{Document, Finding, Severity};

fn find(document: &Document) -> Vec<Finding> {
    document.load().findings
}

/// Fixes a text twice: the second run must change nothing.
#[track_caller]
fn fixed(bytes: &[u8], level: Applicability) -> Fixed {
    let fixed = fix(&Document::new(bytes), level, find);
    let again = fix(&fixed.document, level, find);
    assert_eq!((again.edits, &again.document), (0, &fixed.document));
    let codes = |held: &Fixed| -> Vec<_> { held.held.iter().map(|h| h.finding.code()).collect() };
    assert_eq!(codes(&again), codes(&fixed));
    fixed
}

#[test]
fn fixes_that_undo_each_other_leave_the_text_as_it_was() {
    // The types of sub-index 1 and sub-index 2 are in one line here.
    for text in [
        "[1280]\nDataType=0x1A\nCompactSubObj=0xFFFFFFFFFFFFFFFF\n",
        "[1280]\nObjectType=9\nAccessType=rw\nDataType=0x5\nCompactSubObj=3\n",
        "[1280]\nObjectType=9\nAccessType=rw\nDataType=0x7\nCompactSubObj=3\n",
        "[1018]\nObjectType=9\nAccessType=ro\nDataType=0x5\nCompactSubObj=4\n",
        "[1400]\nObjectType=9\nAccessType=rw\nDataType=0x5\nCompactSubObj=5\nDefaultValue=1\n",
    ] {
        for level in [Applicability::Safe, Applicability::Unsafe] {
            let done = fixed(text.as_bytes(), level);
            assert!(done.edits < 6, "{text}: {}", done.edits);
        }
    }
    let done = fixed(
        b"[1280]\nDataType=0x1A\nCompactSubObj=0xFFFFFFFFFFFFFFFF\n",
        Applicability::Unsafe,
    );
    assert!(done.held.iter().any(|held| held.why == Why::Stays));
}

#[test]
fn a_fix_that_adds_an_error_is_left_out_alone() {
    let mut text = String::new();
    for index in 0x2000..0x2200 {
        text += &format!("[{index:04X}]\nParameterName=a\nDataType:7\nAccessType=rw\n");
    }
    // The checks find an error once the line of one object contains `=`.
    let harm = |document: &Document| {
        let mut found = find(document);
        let text = document.text();
        for name in ["[2077]", "[2111]"] {
            let at = text.find(name).unwrap();
            if text[at..].lines().nth(2) == Some("DataType=7") {
                let mut error = od_eds::load("[2000]\n").findings;
                error.retain(|one| one.severity() == Severity::Error && one.object.is_some());
                found.extend(error.into_iter().take(1));
            }
        }
        found
    };
    let document = Document::new(text);
    let done = fix(&document, Applicability::Safe, harm);
    assert_eq!(done.edits, 0x200 - 2);
    let lines = done
        .held
        .iter()
        .map(|held| held.finding.span().unwrap().line);
    assert_eq!(lines.collect::<Vec<_>>(), [0x77 * 4 + 3, 0x111 * 4 + 3]);
    assert!(
        done.held
            .iter()
            .all(|held| matches!(&held.why, Why::Adds(error) if error.is_error()))
    );
    assert!(
        done.document
            .text()
            .contains("[2078]\nParameterName=a\nDataType=7\n")
    );
    assert!(
        done.document
            .text()
            .contains("[2077]\nParameterName=a\nDataType:7\n")
    );
}

#[test]
fn a_fix_with_a_character_that_the_file_cannot_have_is_left_out() {
    // As above: the fix that adds a character is made up, the others are real.
    let document = Document::new(&b"[2000]\nParameterName=\xB5\nDataType:7\nAccessType:rw\n"[..]);
    let odd = |document: &Document| {
        let mut found = find(document);
        for one in found.iter_mut().filter(|one| one.code() == "W0108") {
            let fix = one.fix.as_mut().unwrap();
            if document.text()[fix.edits[0].span.end as usize..].starts_with('7') {
                fix.edits[0].text = "=\u{3A9}".into();
            }
        }
        found
    };
    let done = fix(&document, Applicability::Safe, odd);
    assert_eq!(done.edits, 1);
    assert_eq!(
        done.document.bytes(),
        b"[2000]\nParameterName=\xB5\nDataType:7\nAccessType=rw\n"
    );
    assert!(
        matches!(done.held[..], [ref held] if matches!(held.why, Why::NoCharacter('\u{3A9}', _)))
    );
}

#[test]
fn the_values_of_the_vendor_are_kept() {
    let text =
        "[2000]\nParameterName=a\nDataType=5\nAccessType=rww\nPDOMapping=0\nDefaultValue=1\n";
    let done = fixed(text.as_bytes(), Applicability::Unsafe);
    assert!(
        done.document
            .text()
            .contains("AccessType=rw\nPDOMapping=0\n")
    );
}

#[test]
fn bad_lines_beyond_the_limit_of_a_report_are_fixed_too() {
    let done = fixed("junk\n".repeat(25_000).as_bytes(), Applicability::Safe);
    assert_eq!((done.edits, done.held.len()), (25_000, 0));
}
