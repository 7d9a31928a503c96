//! Rules where they begin and end: the last value that is right, and the first that is wrong.

use od_eds::{Document, Eds, say};

/// An object with one value, for the end of an EDS.
fn variable(index: &str, data_type: &str, value: &str) -> String {
    format!(
        "\n[{index}]\nParameterName=a\nObjectType=0x7\nDataType={data_type}\n\
        AccessType=rw\nDefaultValue={value}\nPDOMapping=0\n"
    )
}

/// Returns whether a rule has something to say.
fn finds(text: &str, code: &str) -> bool {
    let findings = Document::new(text).load().findings;
    findings.iter().any(|finding| finding.code() == code)
}

#[test]
fn steps_in_6502h_are_not_taken_for_revolutions() {
    let turns = include_str!("../cases/W0957/fixed.eds");
    let steps = turns.replace("DefaultValue=4096", "DefaultValue=33554432");
    assert_ne!(turns, steps);
    assert!(!finds(&steps, "W0957"), "8192 × 4096 steps, multiturn");
    let singleturn = steps.replace("DefaultValue=0x00020196", "DefaultValue=0x00010196");
    assert!(finds(&singleturn, "W0957"));
    let range = singleturn.replace("=33554432", "=8192");
    assert!(!finds(&range, "W0957"), "8192 steps are one revolution");
}

#[test]
fn a_maximum_of_0_is_none() {
    let bad = include_str!("../cases/W0917/bad.eds");
    let unset = bad.replace("DefaultValue=3000", "DefaultValue=0");
    assert_ne!(bad, unset);
    assert!(finds(bad, "W0917") && !finds(&unset, "W0917"));
}

#[test]
fn a_mode_has_its_own_bit_in_6502h() {
    let bad = include_str!("../cases/W0910/bad.eds");
    for (modes, is_wrong) in [
        ("0x4", false),
        ("0x3FB", true),
        ("0x7", false),
        ("0", false),
    ] {
        let text = bad.replace("DefaultValue=1\n", &format!("DefaultValue={modes}\n"));
        assert_eq!(finds(&text, "W0910"), is_wrong, "mode 3 of {modes}");
    }
    let findings = Document::new(bad).load().findings;
    let finding = findings.iter().find(|finding| finding.code() == "W0910");
    let said = say(finding.expect("a finding"), &Eds);
    assert!(said.message.contains("bit 2"), "{}", said.message);
}

#[test]
fn a_name_of_241_characters_is_not_too_long() {
    let text = variable("2010", "0x0005", "0");
    let named = |length| {
        text.replace(
            "ParameterName=a",
            &format!("ParameterName={}", "x".repeat(length)),
        )
    };
    assert!(!finds(&named(241), "W0344") && finds(&named(242), "W0344"));
}

#[test]
fn several_logical_devices_have_no_reserved_bits() {
    let one = include_str!("../cases/W0914/fixed.eds");
    let with = |device_type| one.replace("DefaultValue=0x00040191", device_type);
    assert!(finds(&with("DefaultValue=0x007F0191"), "W0914"));
    assert!(!finds(&with("DefaultValue=0xFFFF0191"), "W0914"));
}

#[test]
fn a_dcf_may_write_out_the_cob_ids_of_its_node() {
    let eds = include_str!("../cases/W0530/fixed.eds");
    let dcf = format!("{eds}\n[DeviceComissioning]\nNodeID=5\n");
    for (cob_id, is_wrong) in [("0x605", false), ("0x606", true), ("0x600", true)] {
        let text = dcf.replace("$NODEID+0x600", cob_id);
        assert_ne!(text, dcf);
        assert_eq!(finds(&text, "W0530"), is_wrong, "{cob_id}");
    }
    let other = dcf.replace("$NODEID+0x600", "0x700");
    assert!(finds(&other, "E0533") && !finds(&other, "W0530"));
}

#[test]
fn a_drive_has_reserved_codes_past_those_of_cia_402() {
    let module = include_str!("../cases/W0914/fixed.eds");
    let drive = module.replace("0x00040191", "0x00020192");
    for (index, right, wrong) in [
        ("605A", "8", "9"),
        ("605B", "1", "2"),
        ("605C", "1", "2"),
        ("605D", "1", "0"),
        ("605D", "4", "5"),
        ("605E", "4", "5"),
        ("6086", "3", "4"),
        ("6098", "14", "15"),
        ("6098", "37", "38"),
    ] {
        let with = |value| drive.clone() + &variable(index, "0x0003", value);
        assert!(!finds(&with(right), "W0914"), "{index} {right}");
        assert!(finds(&with(wrong), "W0914"), "{index} {wrong}");
    }
    let period = |exponent| {
        let sub = variable("60C2sub2", "0x0002", exponent);
        format!("{drive}\n[60C2]\nParameterName=a\nObjectType=0x9\nSubNumber=1\n{sub}")
    };
    assert!(!finds(&period("63"), "W0914") && finds(&period("64"), "W0914"));
}

#[test]
fn a_module_without_channels_has_them_by_its_modules() {
    let one = include_str!("../cases/W0912/fixed.eds");
    let (before, rest) = one.split_once("[6000sub1]").expect("a channel");
    let (_, after) = rest.split_once("\n[6002]").expect("what sets it");
    let none = format!("{before}[6002]{after}");
    assert!(!finds(&none, "W0912"));
    assert!(finds(include_str!("../cases/W0912/bad.eds"), "W0912"));
}

#[test]
fn a_type_needs_no_sub_objects() {
    let bad = include_str!("../cases/W0306/bad.eds");
    let with = |code| bad.replace("[2000]\nParameterName=Filter\nObjectType=0x9", code);
    let of_a_type = with("[2000]\nParameterName=Filter\nObjectType=0x6");
    assert_ne!(bad, of_a_type);
    assert!(finds(bad, "W0306") && !finds(&of_a_type, "W0306"));
}

#[test]
fn can_id_100h_is_for_time_messages_even_without_1012h() {
    let bad = include_str!("../cases/E0532/bad.eds");
    let said = |text: &str| {
        let findings = Document::new(text).load().findings;
        let all = findings.iter().filter(|one| one.code() == "E0532");
        let said: Vec<_> = all.map(|one| say(one, &Eds).message).collect();
        said.join(", ")
    };
    let (before, last) = bad.rsplit_once("=0x80\n").expect("a CAN-ID");
    let text = format!("{before}=0x100\n{last}");
    assert!(said(&text).contains("TIME"), "{}", said(&text));
}

/// The messages of a rule about `crates/od-eds/tests/faults.eds` with other COB-IDs.
fn said_of(code: &str, changes: &[(&str, &str)]) -> Vec<String> {
    let mut text = include_str!("faults.eds").to_owned();
    for (section, value) in changes {
        let at = text.find(&format!("[{section}]\n")).expect("a section");
        let from = at + text[at..].find("DefaultValue=").expect("a default");
        let to = from + text[from..].find('\n').expect("a line");
        text.replace_range(from..to, &format!("DefaultValue={value}"));
    }
    let findings = Document::new(text.as_str()).load().findings;
    let all = findings.iter().filter(|one| one.code() == code);
    all.map(|one| say(one, &Eds).message).collect()
}

#[test]
fn a_can_id_is_checked_for_every_node_id() {
    assert_eq!(
        said_of("W0522", &[("1800sub1", "$NODEID+0x790")]),
        ["the CAN-ID of node ID 112 is 800h, which has more than 11 bits; cut off, it is 000h"]
    );
    assert_eq!(
        said_of("W0520", &[("1800sub1", "$NODEID+0x680")]),
        ["a node with node ID 96 sends with CAN-ID 6E0h, which CiA 301 reserves for later use"]
    );
    // The last one that is free for all of them, and one of another range.
    for free in ["$NODEID+0x500", "$NODEID+0x480", "$NODEID+0x20000680"] {
        assert!(said_of("W0520", &[("1800sub1", free)]).is_empty(), "{free}");
        assert!(said_of("W0522", &[("1800sub1", free)]).is_empty(), "{free}");
    }
    // Bit 31: the PDO is not in use.
    assert!(said_of("W0520", &[("1800sub1", "$NODEID+0x80000680")]).is_empty());
}

#[test]
fn a_number_may_be_the_can_id_of_a_partner() {
    // The RPDO of every node listens to the TPDO of node 5, which is another device.
    assert!(said_of("W0521", &[("1400sub1", "0x185")]).is_empty());
    // Two that are sent cannot be told apart at node ID 5.
    assert_eq!(
        said_of("E0532", &[("1014", "0x185")]),
        ["1014h has the CAN-ID of 1800h:01, 185h, at node ID 5"]
    );
}

#[test]
fn a_value_that_cannot_be_mapped_has_no_wrong_length() {
    let bad = include_str!("../cases/E0504/bad.eds");
    let (before, mapped) = bad.split_once("\n[2000]").expect("what is mapped");
    let unmappable = mapped.replacen("PDOMapping=1", "PDOMapping=0", 1);
    let text = format!("{before}\n[2000]{unmappable}");
    assert!(finds(bad, "E0504") && text != bad && !finds(&text, "E0504"));
}

#[cfg(feature = "explain")]
#[test]
fn a_rule_is_explained_with_its_own_files() {
    for code in ["W0306", "E0532"] {
        assert_eq!(od_eds::check::pair(code).expect("a pair").code, code);
    }
}
