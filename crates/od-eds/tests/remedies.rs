//! Fixes that look right and are wrong: what odkit does instead.

use od_eds::fix::{Applicability, fix};
use od_eds::{Document, Eds, say};

/// An object with sub-objects of one type; `subs` are the names of their sections.
fn array(index: &str, types: &[(&str, &str)]) -> String {
    let count = types.len();
    let mut text = format!(
        "[{index}]\nParameterName=a\nObjectType=0x8\nSubNumber={}\n\
        [{index}sub0]\nParameterName=n\nDataType=0x0005\nAccessType=const\nDefaultValue={count}\n",
        count + 1
    );
    for (sub, data_type) in types {
        text += &format!(
            "[{index}{sub}]\nParameterName={sub}\nDataType={data_type}\nAccessType=rw\nDefaultValue=0\n"
        );
    }
    text
}

/// The text with all fixes of a level.
fn fixed(text: &str, level: Applicability) -> String {
    let find = |document: &Document| document.load().findings;
    fix(&Document::new(text), level, find)
        .document
        .text()
        .into()
}

#[test]
fn an_array_of_a_standard_stays_one() {
    for (index, device_type) in [
        ("1020", "0"),
        ("6000", "0x00030191"),
        ("6401", "0x00040191"),
    ] {
        let start = format!(
            "[1000]\nParameterName=t\nDataType=0x0007\nAccessType=ro\nDefaultValue={device_type}\n"
        );
        let text = start + &array(index, &[("sub1", "0x0005"), ("sub2", "0x0006")]);
        let fixed = fixed(&text, Applicability::Unsafe);
        assert!(fixed.contains("ObjectType=0x8"), "{fixed}");
    }
    // Of the manufacturer, a RECORD is what is most likely meant.
    let text = array("2000", &[("sub1", "0x0005"), ("sub2", "0x0006")]);
    assert!(fixed(&text, Applicability::Unsafe).contains("ObjectType=0x9"));
}

#[test]
fn a_section_with_a_misspelled_name_still_counts() {
    let subs = ["sub1", "sub2", "sb3", "sub4"].map(|sub| (sub, "0x0005"));
    let text = array("2005", &subs);
    assert!(fixed(&text, Applicability::Safe).contains("SubNumber=5"));
    let unsafely = fixed(&text, Applicability::Unsafe);
    assert!(
        unsafely.contains("SubNumber=5") && unsafely.contains("[2005sub3]"),
        "{unsafely}"
    );
    // The last one: sub-index 0 is right, too.
    let subs = ["sub1", "sub2", "sb3"].map(|sub| (sub, "0x0005"));
    let text = array("2005", &subs);
    assert_eq!(
        fixed(&text, Applicability::Unsafe),
        text.replace("sb3]", "sub3]")
    );
    let findings = Document::new(text.as_str()).load().findings;
    let count = findings.iter().find(|finding| finding.code() == "W0350");
    assert!(count.is_some_and(|finding| finding.fix.is_none()));
}

#[test]
fn a_gap_is_not_filled_with_a_sub_index_in_decimal_that_is_elsewhere() {
    // Sub-index 1 is missing, and `sub10` after `sub9` is probably decimal.
    let subs = ["2", "3", "4", "5", "6", "7", "8", "9", "10"];
    let text = subs.iter().fold(
        String::from("[2010]\nParameterName=a\nObjectType=0x8\nSubNumber=9\n"),
        |text, sub| {
            text + &format!("[2010sub{sub}]\nParameterName={sub}\nDataType=5\nAccessType=rw\n")
        },
    );
    let findings = Document::new(text.as_str()).load().findings;
    let gap = findings.iter().find(|finding| finding.code() == "W0351");
    let gap = gap.expect("there is a gap");
    assert!(gap.fix.is_none(), "{}", say(gap, &Eds).help);
}

#[test]
fn a_sub_index_in_decimal_does_not_raise_sub_index_0() {
    let subs = [
        "sub1", "sub2", "sub3", "sub4", "sub5", "sub6", "sub7", "sub8", "sub9", "sub10",
    ];
    let text = array("2010", &subs.map(|sub| (sub, "0x0005")));
    let fixed = fixed(&text, Applicability::Unsafe);
    assert!(
        fixed.contains("DefaultValue=10") && fixed.contains("[2010subA]"),
        "{fixed}"
    );
    assert!(help(&text, "W0311").contains("`[2010subA]`"));
}

/// The help of the first finding of a rule.
fn help(text: &str, code: &str) -> String {
    let findings = Document::new(text).load().findings;
    let found = findings.iter().find(|finding| finding.code() == code);
    say(found.expect("a finding"), &Eds).help
}

#[test]
fn a_missing_type_is_that_of_the_profile() {
    let start = "[1000]\nParameterName=t\nDataType=7\nAccessType=ro\nDefaultValue=0x00030191\n";
    let text = start.to_string() + &array("6000", &[("sub1", "0x0005")]);
    let text = text.replace(
        "ParameterName=sub1\nDataType=0x0005\n",
        "ParameterName=sub1\n",
    );
    assert!(help(&text, "E0401").contains("UNSIGNED8"), "{text}");
}

#[test]
fn a_number_that_is_not_one_of_32_bits_is_reported_once() {
    let text =
        "[DeviceInfo]\nVendorNumber=-1\n".to_string() + &array("1018", &[("sub1", "0x0007")]);
    let text = text.replace(
        "AccessType=rw\nDefaultValue=0",
        "AccessType=ro\nDefaultValue=0x5F",
    );
    let findings = Document::new(text.as_str()).load().findings;
    let about = |code: &str| {
        findings
            .iter()
            .filter(|finding| finding.code() == code)
            .count()
    };
    assert_eq!((about("W0609"), about("W0607")), (1, 0));
}

#[test]
fn a_missing_equals_sign_is_written() {
    let text = "[2000]\nParameterName=a\nDataType=0x0005\nAccessType rww\nPDOMapping=1\n";
    let fixed = fixed(text, Applicability::Safe);
    assert!(fixed.contains("\nAccessType=rww\n"), "{fixed}");
    assert!(
        !fixed.contains(";AccessType") && !fixed.contains("=ro"),
        "{fixed}"
    );
}

#[test]
fn pdo_mapping_2_is_what_a_pdo_says() {
    for access in ["rw", "rww"] {
        let text = format!(
            "[1A00]\nParameterName=m\nObjectType=0x9\nSubNumber=2\n\
            [1A00sub0]\nParameterName=n\nDataType=0x0005\nAccessType=rw\nDefaultValue=1\n\
            [1A00sub1]\nParameterName=e\nDataType=0x0007\nAccessType=rw\nDefaultValue=0x20000008\n\
            [2000]\nParameterName=a\nDataType=0x0005\nAccessType={access}\nPDOMapping=2\n"
        );
        let findings = Document::new(text.as_str()).load().findings;
        let own = findings.iter().find(|finding| finding.code() == "W0406");
        assert!(own.expect("a finding").fix.is_none());
        assert!(!findings.iter().any(|finding| finding.code() == "W0445"));
        let fixed = fixed(&text, Applicability::Unsafe);
        // A PDO maps it, which says more than the number.
        assert!(fixed.contains("PDOMapping=1"), "{fixed}");
    }
}

#[test]
fn compact_sub_objects_beside_sections_change_no_count() {
    let text = "[2000]\nParameterName=a\nObjectType=0x8\nSubNumber=3\nCompactSubObj=8\nDataType=0x0005\n\
        AccessType=rw\n[2000sub0]\nParameterName=n\nDataType=0x0005\nAccessType=ro\nDefaultValue=2\n\
        [2000sub1]\nParameterName=b\nDataType=0x0005\nAccessType=rw\n\
        [2000sub2]\nParameterName=c\nDataType=0x0005\nAccessType=rw\n";
    let codes: Vec<_> = Document::new(text)
        .load()
        .findings
        .iter()
        .map(|f| f.code())
        .collect();
    assert!(codes.contains(&"W0324"), "{codes:?}");
    let fixed = fixed(text, Applicability::Unsafe);
    assert!(
        fixed.contains("DefaultValue=2") && fixed.contains("SubNumber=3"),
        "{fixed}"
    );
}

#[test]
fn reserved_bits_are_cleared_and_the_others_stay() {
    let text = "[1014]\nParameterName=e\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\n\
        DefaultValue=$NODEID+0x40000080\n[1800]\nParameterName=t\nObjectType=0x9\nSubNumber=3\n\
        [1800sub0]\nParameterName=n\nDataType=0x0005\nAccessType=const\nDefaultValue=2\n\
        [1800sub1]\nParameterName=c\nDataType=0x0007\nAccessType=rw\nDefaultValue=$NODEID+0x40000180\n\
        [1800sub2]\nParameterName=y\nDataType=0x0005\nAccessType=rw\nDefaultValue=253\n";
    let fixed = fixed(text, Applicability::Unsafe);
    for right in [
        "DefaultValue=$NODEID+0x80\n",
        "DefaultValue=$NODEID+0x180\n",
    ] {
        assert!(fixed.contains(right), "{right}: {fixed}");
    }
}

#[test]
fn objects_that_a_list_lacks_are_added_together() {
    let object = |index: u16| {
        format!("[{index:04X}]\nParameterName=a\nObjectType=0x7\nDataType=0x0005\nAccessType=rw\n")
    };
    let objects: String = (0x2000..0x2003).map(object).collect();
    let list = "[ManufacturerObjects]\nSupportedObjects=1\n1=0x2001\n";
    let found = fixed(&format!("{list}{objects}"), Applicability::Unsafe);
    let right = "SupportedObjects=3\n1=0x2001\n2=0x2000\n3=0x2002\n";
    assert!(found.contains(right), "{found}");
    // A list whose count is wrong is corrected before.
    let wrong = list.replace("=1\n1", "=5\n1");
    let found = fixed(&format!("{wrong}{objects}"), Applicability::Unsafe);
    assert!(found.contains(right), "{found}");
}

/// An object that the count and a free number speak of is not taken out of the list by a lower count.
#[test]
fn a_number_that_is_missing_in_a_list_belongs_to_the_object_that_is() {
    let object = |index| {
        format!("[{index}]\nParameterName=a\nDataType=0x0005\nAccessType=rw\nDefaultValue=0\n")
    };
    let objects = ["2000", "2001", "2002", "2003", "2004"].map(object);
    let list = "[ManufacturerObjects]\nSupportedObjects=5\n";
    for (entries, right) in [
        (
            "1=0x2000\n3=0x2002\n4=0x2003\n",
            "1=0x2000\n2=0x2001\n3=0x2002\n4=0x2003\n5=0x2004\n",
        ),
        (
            "2=0x2001\n3=0x2002\n",
            "1=0x2000\n2=0x2001\n3=0x2002\n4=0x2003\n5=0x2004\n",
        ),
    ] {
        let text = format!("{list}{entries}{}", objects.concat());
        assert_eq!(fixed(&text, Applicability::Safe), text);
        let all = fixed(&text, Applicability::Unsafe);
        assert_eq!(all, text.replace(entries, right));
    }
    // Without the objects, the count is that of the entries.
    let text = format!("{list}1=0x2000\n3=0x2002\n{}{}", objects[0], objects[2]);
    let safe = fixed(&text, Applicability::Safe);
    assert!(
        safe.contains("SupportedObjects=2\n1=0x2000\n2=0x2002\n"),
        "{safe}"
    );
}

#[test]
fn a_digit_that_looks_like_a_letter_of_an_access_type_is_read_as_one() {
    let text = |access: &str| {
        format!("[2000]\nParameterName=a\nDataType=0x0005\nAccessType={access}\nDefaultValue=0\n")
    };
    for (given, right) in [("r0", "ro"), ("W0", "wo"), ("c0nst", "const"), ("x0", "x0")] {
        let all = fixed(&text(given), Applicability::Unsafe);
        assert!(all.contains(&text(right)), "{given}: {all}");
    }
}

#[test]
fn an_empty_version_is_not_one_of_cia_306() {
    let version = |text: &str| {
        let text = format!("[FileInfo]\nEDSVersion={text}\n[2000]\nDataType=0x0005\n");
        let found = Document::new(text).load().findings.into_iter();
        let mut said = found.map(|one| say(&one, &Eds).message);
        said.any(|said| said.contains("EDSVersion") && said.contains("not a version of CiA 306"))
    };
    assert!(version("") && version("4"));
    assert!(!version("4.0") && !version("4.2"));
}

#[test]
fn a_comment_after_a_number_of_a_list_gets_its_own_line() {
    let object = "[2000]\nParameterName=a\nDataType=0x0005\nAccessType=rw\nDefaultValue=0\n";
    let list = "[ManufacturerObjects]\nSupportedObjects=1 ; one\n1=0x2000;two\n";
    let right = "[ManufacturerObjects]\nSupportedObjects=1\n; one\n1=0x2000\n;two\n";
    let safe = fixed(&format!("{list}{object}"), Applicability::Safe);
    assert_eq!(safe, format!("{right}{object}"));
}
