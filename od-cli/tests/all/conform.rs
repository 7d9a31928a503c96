//! `odkit conform`: the conformance test of a simulated device and of one on a bus.

use crate::support::{file, odkit, repository};

#[test]
fn a_simulated_device_passes_and_is_reported() {
    let report = file("conform.json", "").display().to_string();
    let done = odkit(&["conform", "gxmm", "--report", &report], "");
    assert_eq!(done.code, 0, "{}{}", done.out, done.err);
    assert!(done.out.contains(" 0 failed, "), "{}", done.out);
    assert!(
        done.out.contains("SDO response: 50 % within "),
        "{}",
        done.out
    );
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(report).expect("a report")).expect("JSON");
    assert_eq!(json["pass"], true);
    let cases = json["cases"].as_array().expect("cases");
    let case = cases
        .iter()
        .find(|case| case["id"] == "sdo-upload-expedited");
    let frames = case.expect("a case")["frames"].as_array().expect("frames");
    assert!(
        frames
            .iter()
            .any(|frame| frame["frame"] == "601#4000100000000000"),
        "{frames:?}"
    );
}

#[test]
fn a_device_that_is_not_as_its_eds_fails() {
    let text = std::fs::read_to_string(repository("devices/eds/GXMM.eds")).expect("an EDS");
    let wrong = text.replacen("DefaultValue=0x20196", "DefaultValue=0x20197", 1);
    let other = file("other.eds", &wrong).display().to_string();
    let args = [
        "conform",
        "--link",
        "bench:gxmm",
        "--eds",
        &other,
        "--only",
        "eds-*",
    ];
    let done = odkit(&args, "");
    assert_eq!(done.code, 1, "{}{}", done.out, done.err);
    assert!(
        done.out.contains("  fail     eds-device-type"),
        "{}",
        done.out
    );
    assert!(
        done.out.contains("clause    CiA 301 7.5.2.1"),
        "{}",
        done.out
    );
}

#[test]
fn wrong_usage_says_what_to_write() {
    for (args, told) in [
        (&["conform"][..], "odkit conform gxmm"),
        (&["conform", "gxmm", "--only", "nosuch*"][..], "--list"),
        (&["conform", "gxmm", "--report", "x.doc"][..], ".json"),
        (
            &["conform", "--link", "slcan:127.0.0.1:9"][..],
            "--eds FILE",
        ),
    ] {
        let done = odkit(args, "");
        assert_eq!(done.code, 2, "{args:?}: {}{}", done.out, done.err);
        assert!(done.err.contains(told), "{args:?}: {}", done.err);
    }
    let list = odkit(&["conform", "--list", "--only", "HEARTBEAT-*"], "");
    assert!(
        list.out.lines().count() > 5 && list.code == 0,
        "{}",
        list.out
    );
}
