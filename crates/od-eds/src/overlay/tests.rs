use super::*;
use crate::description::Value;
use od_model::Address;

const BASE: &str = "\
; ours
[DeviceInfo]
ProductName=Base

[MandatoryObjects]
SupportedObjects=1
1=0x1000

[OptionalObjects]
SupportedObjects=0

[ManufacturerObjects]
SupportedObjects=2
1=0x2000
2=0x2001

[1000]
ParameterName=Device type
DataType=0x0007
AccessType=ro
DefaultValue=1

[2000]
ParameterName=Speed
DataType=0x0005
AccessType=rw
DefaultValue=3
HighLimit=9

[2001]
ParameterName=Pair
ObjectType=0x9
SubNumber=2
[2001sub0]
ParameterName=Highest
DataType=0x0005
AccessType=ro
DefaultValue=1
[2001sub1]
ParameterName=One
DataType=0x0005
AccessType=rw";

#[track_caller]
fn laid(text: &str) -> Overlaid {
    overlay(BASE, text).unwrap_or_else(|faults| panic!("{faults:?}"))
}

fn number(made: &Overlaid, index: u16, sub: u8) -> Option<i128> {
    let description = crate::parse(&made.text).description;
    let entry = description.entry(Address::new(index, sub))?;
    entry.default.as_ref().and_then(|value| value.integer(1))
}

#[test]
fn an_empty_overlay_changes_nothing() {
    assert_eq!(laid("").text, BASE);
    assert_eq!(laid("\n").text, BASE);
    let (before, after) = (
        crate::parse(BASE),
        crate::parse(&laid("; ours, too\n").text),
    );
    assert_eq!(before.findings, after.findings);
    assert_eq!(before.description, after.description);
}

/// A mistake in an overlay is reported, as it is in any file.
#[test]
fn lines_before_the_first_section_and_second_lines_of_a_key_are_reported() {
    let codes = |text: &str| {
        let made = laid(text);
        let findings = crate::load(&made.text).findings.into_iter();
        let placed = findings.map(|finding| made.place(finding));
        let of_overlay = placed.filter(|(origin, _)| *origin == Origin::Overlay);
        let told = of_overlay.map(|(_, finding)| {
            let line = finding.span().map_or(0, |span| span.line);
            format!("{} {line}", finding.code())
        });
        told.collect::<Vec<_>>().join(", ")
    };
    assert_eq!(codes("[2000]\nDefaultValue=5\n"), "");
    assert_eq!(
        codes("; mine\nDefaultValue=5\n[2000]\nHighLimit=8\n"),
        "W0105 2"
    );
    assert_eq!(codes("[2000]\nDefaultValue=5\ndefaultvalue=6\n"), "E0117 3");
}

#[test]
fn a_comment_at_the_head_of_an_overlay_allows_findings() {
    let head = ";odkit-allow=W0635 another program watches this device\n";
    let mut allows = crate::check::Allows::of(&laid(head).text);
    let mut findings = crate::load(BASE).findings;
    let has = |findings: &[Finding]| findings.iter().any(|finding| finding.code() == "W0635");
    assert!(has(&findings));
    allows.filter(&mut findings);
    assert!(!has(&findings));
}

#[test]
fn keys_of_the_overlay_replace_those_of_the_base() {
    let made = laid("[2000]\ndefaultvalue=5\nLowLimit=2\n[deviceinfo]\nProductName=Mine\n");
    assert_eq!(number(&made, 0x2000, 0), Some(5));
    let description = crate::parse(&made.text).description;
    let entry = &description.objects[&0x2000].entries[&0];
    assert_eq!(entry.low.as_deref(), Some(&Value::Unsigned(2)));
    assert_eq!(entry.high.as_deref(), Some(&Value::Unsigned(9)));
    let info = description
        .section("DeviceInfo")
        .and_then(|info| info.get("ProductName"));
    assert_eq!(info.map(|name| name.value.as_str()), Some("Mine"));
    assert_eq!(made.text.matches("DefaultValue=3").count(), 0);
}

#[test]
fn objects_are_added_and_removed_in_the_lists_too() {
    let made = laid("[2001]\nRemove=1\n[1017]\nParameterName=Beat\nDataType=6\nAccessType=rw\n");
    let loaded = crate::parse(&made.text);
    let indices: Vec<u16> = loaded.description.objects.keys().copied().collect();
    assert_eq!(indices, [0x1000, 0x1017, 0x2000]);
    assert!(!made.text.contains("2001sub1"), "{}", made.text);
    assert!(
        made.text
            .contains("[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n")
    );
    let member = laid("[2001sub1]\nRemove=1\n");
    assert!(!member.text.contains("2001sub1") && member.text.contains("2001sub0"));
}

#[test]
fn a_section_that_cannot_be_applied_is_an_error() {
    for (text, expected) in [
        (
            "\n[2005]\nRemove=1\n[2001sub7]\nRemove=1 ; why\n",
            "2 section [2005] to remove is missing, 4 section [2001sub7] to remove is missing",
        ),
        (
            "[2000]\nRemove=2 ; both\n[2005]\nremove=\n",
            "2 `Remove=2` is not valid; write `Remove=1`, or remove the line, \
             4 `Remove=` is not valid; write `Remove=1`, or remove the line",
        ),
        (
            "[2000]\nRemove=1\n[2000]\nRemove=1\n",
            "3 section [2000] is already in line 1; move its lines there",
        ),
        (
            "[2001sub1]\nLowLimit=1\n[1000]\nDefaultValue=2\n[2001SUB1]\nLowLimit=2\n",
            "5 section [2001SUB1] is already in line 1; move its lines there",
        ),
        (
            "<<<<<<< HEAD\n[2000]\nDefaultValue=1\n=======\n[2000]\nDefaultValue=2\n>>>>>>> mine\n",
            "1 `<<<<<<< HEAD` is a mark of a merge conflict that is not resolved; keep one of the two versions",
        ),
        (
            "[2000]\nDefaultValue=1\n[2000]\nRemove=1\n",
            "3 section [2000] is already in line 1; move its lines there",
        ),
    ] {
        let faults = overlay(BASE, text).expect_err(text).into_iter();
        let faults: Vec<String> = faults.map(|(line, why)| format!("{line} {why}")).collect();
        assert_eq!(faults.join(", "), expected);
    }
}

#[test]
fn a_removed_object_can_be_defined_again() {
    let made = laid("[2001]\nRemove=0x1\n[2001]\nParameterName=Pair\nDataType=5\nAccessType=rw\n");
    let description = crate::parse(&made.text).description;
    let again = &description.objects[&0x2001];
    assert!(again.entries.len() == 1 && !made.text.contains("2001sub"));
}

#[test]
fn a_finding_has_its_place_in_the_original_file() {
    let text = "; mine\n[2000]\nHighLimit=1\n\n[2002]\nParameterName=New\nAccessType=rw\n";
    let made = laid(text);
    let findings = crate::load(&made.text).findings;
    let placed: Vec<_> = findings
        .into_iter()
        .map(|finding| made.place(finding))
        .collect();
    let of = |code: &str| placed.iter().find(|(_, finding)| finding.code() == code);
    let (origin, missing) = of("E0401").expect("2002h has no DataType");
    assert_eq!(*origin, Origin::Overlay);
    assert_eq!(missing.span().map(|span| span.line), Some(5));
    let (origin, limit) = of("W0452").expect("3 is above 1");
    let span = limit.span().expect("it has a place");
    let file = if *origin == Origin::Base { BASE } else { text };
    let line = file.lines().nth(span.line as usize - 1).unwrap_or("");
    assert!(line.contains('='), "{line}");
    assert_eq!(
        &file[span.start as usize..span.end as usize],
        line.split('=').nth(1).unwrap_or("")
    );
}

/// A line of an overlay can end as a line of an EDS can.
#[test]
fn any_line_end() {
    for end in ["\n", "\r\n", "\r"] {
        let base = BASE.replace('\n', end);
        let over = ["[2000]", "DefaultValue=4", "[2001]", "Remove=1", "[3]"].join(end);
        let made = overlay(&base, &over).unwrap_or_else(|faults| panic!("{end:?}: {faults:?}"));
        assert_eq!(number(&made, 0x2000, 0), Some(4), "{end:?}");
        assert_eq!(number(&made, 0x2001, 1), None, "{end:?}");
        let broken = made.text.find("[3]").unwrap_or_default();
        let (origin, span) = made.locate(crate::scan::lines::span(&made.text, broken));
        assert_eq!((origin, span.line), (Origin::Overlay, 5), "{end:?}");
        assert_eq!(over.as_bytes()[span.start as usize], b'[', "{end:?}");
    }
}

#[test]
fn a_comment_names_the_base() {
    let text = "; a variant\r\n # ODKIT-Base = eds/my device.eds \r\n[2000]\r\n";
    let named = base_of(text).expect("the second line");
    assert_eq!(
        (*named, named.span.line, named.span.column),
        ("eds/my device.eds", 2, 17)
    );
    for text in [
        "",
        "[2000]\nodkit-base=a.eds",
        ";odkit-base",
        "; the odkit-base=a.eds",
    ] {
        assert_eq!(base_of(text), None, "{text}");
    }
}

#[test]
fn a_base_of_xml_is_refused() {
    let refused = overlay("<?xml version=\"1.0\"?><a/>", "[2000]\nDefaultValue=4\n");
    assert!(refused.is_err_and(|why| why[0].1.contains("odkit convert")));
}

#[test]
fn a_section_that_is_changed_keeps_its_empty_lines_at_its_end() {
    let base = format!("{BASE}\n[Own]\n; a\nA=1\n\n");
    let made = overlay(&base, "[own]\nB=2\n\na=3\n").expect("it fits");
    let own = made.text.split_once("[Own]").map(|(_, own)| own);
    assert_eq!(own, Some("\n; a\na=3\nB=2\n\n"));
}
