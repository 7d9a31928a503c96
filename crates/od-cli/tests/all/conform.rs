//! `odkit conform`: the conformance test of a simulated device and of one on a bus.

use crate::support::{file, odkit, repository};

#[test]
fn a_simulated_device_passes_all_cases() {
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
fn every_report_has_every_case() {
    let names = ["txt", "json", "xml", "md", "html"].map(|extension| {
        let name = format!("conform-all.{extension}");
        file(&name, "").display().to_string()
    });
    let mut args = vec![
        "conform",
        "en580c",
        "--only",
        "NMT",
        "--format",
        "json",
        "--tester",
        "A. Tester",
    ];
    for name in &names {
        args.extend(["--report", name]);
    }
    let done = odkit(&args, "");
    assert_eq!(done.code, 0, "{}{}", done.out, done.err);
    for name in &names {
        let text = std::fs::read_to_string(name).expect("a report");
        assert!(text.contains("nmt-boot-up-first"), "{name}: {text}");
        // What was tested, by whom and with what; the official cases.
        for part in [
            "A. Tester",
            "SHA-256 of the EDS",
            "Vendor-ID (1018h:01)",
            "odkit 0.",
        ] {
            assert!(text.contains(part), "{name}: {part}");
        }
        let official = if name.ends_with(".json") {
            "\"9.1, 10.1\""
        } else {
            "CiA test 9.1, 10.1"
        };
        let has_clauses = !name.ends_with(".txt") && !name.ends_with(".xml");
        assert_eq!(text.contains(official), has_clauses, "{name}");
        // Reports show the frames below each case, except those with one line per case.
        let has_frames = text.contains("000#8101");
        assert_eq!(
            has_frames,
            !name.ends_with(".txt") && !name.ends_with(".md"),
            "{name}"
        );
    }
    let page = std::fs::read_to_string(&names[4]).expect("a page");
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
    for outside in ["http", "src=", "<link", "@import", "url("] {
        assert!(!page.contains(outside), "{outside}");
    }
    // Frames in words, failures before the groups, and a style for the printer.
    assert!(
        page.contains("701#00") && page.contains("boot-up"),
        "{page}"
    );
    assert!(page.find("Failures</h2>") < page.find(">NMT</h2>"));
    assert!(page.contains("@media print"));
    let junit = std::fs::read_to_string(&names[2]).expect("JUnit");
    assert!(junit.contains("<testsuite name=\"NMT\""), "{junit}");
}

#[test]
fn a_page_has_a_heading_for_each_group_with_cases_and_a_printed_reason_for_each_skipped_one() {
    let name = file("conform-skipped.html", "").display().to_string();
    let only = ["--only", "guarding-answer", "--only", "CiA 401"];
    let done = odkit(
        &[&["conform", "gxmm", "--report", &name], &only[..]].concat(),
        "",
    );
    assert_eq!(done.code, 0, "{}{}", done.out, done.err);
    let page = std::fs::read_to_string(&name).expect("a page");
    assert!(page.contains(">error control</h2>"), "{page}");
    // Every case of this group is not applicable.
    assert!(page.contains("<td>CiA 401</td>"), "{page}");
    assert!(!page.contains(">CiA 401</h2>"), "{page}");
    // What is printed of a closed case ends with its summary.
    let summary = page.split("<summary>").nth(1).expect("a skipped case");
    let (summary, rest) = summary.split_once("</summary>").expect("its end");
    assert!(summary.contains("bit 5 of 2110h"), "{summary}");
    assert!(!rest.contains("<pre></pre>"), "{rest}");
}

#[test]
fn the_scripts_of_the_official_cases_are_cases() {
    let folder = repository("tests/conformance/cia");
    let done = odkit(
        &[
            "conform", "gxmm", "--cases", &folder, "--only", "*-0?", "--only", "*-0?-*",
        ],
        "",
    );
    assert_eq!(done.code, 0, "{}{}", done.out, done.err);
    assert!(done.out.contains("  pass     sdo-01 "), "{}", done.out);
    assert!(done.out.contains("  n/a      sdo-08 "), "{}", done.out);
    // This case needs a low battery, which only a bench can simulate.
    assert!(
        done.out.contains("  pass     emergency-04 "),
        "{}",
        done.out
    );
}

/// A folder with one case.
fn cases(folder: &str, name: &str, text: &str) -> String {
    let folder = file(folder, "").with_extension("d");
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join(name), text).expect("a case");
    folder.display().to_string()
}

#[test]
fn a_case_of_a_vendor_is_a_file() {
    let case = "# Vendor 1.2: The node tells its name.\n# Group: own\n# Applies: 1008h\n\
        sdo read 1008h = \"GXMM\"\n$600#40 08 10 00 00 00 00 00\nexpect $580#43 08 10 00 47 58 *\n";
    let folder = cases("own-cases", "name.script", case);
    let args = [
        "conform",
        "--link",
        "bench:gxmm",
        "--node-id",
        "7",
        "--cases",
        &folder,
        "--only",
        "own",
    ];
    let done = odkit(&args, "");
    assert_eq!(done.code, 0, "{}{}", done.out, done.err);
    assert!(done.out.contains("1 case: 1 passed"), "{}", done.out);
    let text = "# Vendor 1.2: A title.\ncheck nosuch\n";
    let wrong = cases("wrong-cases", "x.script", text);
    let done = odkit(&["conform", "gxmm", "--cases", &wrong], "");
    assert_eq!(done.code, 2, "{}", done.err);
    assert!(
        done.err
            .contains("x.script:2: check `nosuch` does not exist"),
        "{}",
        done.err
    );
}

#[test]
fn a_device_that_differs_from_its_eds_fails() {
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
