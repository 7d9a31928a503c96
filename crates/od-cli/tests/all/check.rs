//! `odkit check` beyond the text report, and `odkit explain`.

use std::fs;

use crate::support::{file, folder, odkit, repository};

/// A safe fix, an unsafe fix, a remark, two kinds of line ends, and an encoding to keep.
const ODD: &[u8] =
    b"; \xB5 is Windows-1252\r\n[2000]\r\nParameterName=Gr\xF6\xDFe\r\nDataType:0x5\r\n\
    AccessType=rw\r\n; kept\r\nDefaultValue=010\r\nObjFlags=maybe\r\n";

fn odd(name: &str) -> String {
    let path = file(name, "");
    fs::write(&path, ODD).expect("a folder for test files");
    path.display().to_string()
}

#[test]
fn a_fix_keeps_every_other_byte_and_is_done_once() {
    let path = odd("fix.eds");
    let run = odkit(&["check", "--fix", &path], "");
    assert_eq!(run.code, 1, "errors are left: {}", run.out);
    assert!(run.out.contains("; 2 places fixed"), "{}", run.out);
    let expected = [
        (&b"DataType:0x5"[..], &b"DataType=0x5"[..]),
        (b"DefaultValue=010", b"DefaultValue=8"),
    ];
    let fixed = fs::read(&path).expect("it is there");
    assert_eq!(fixed, replaced(ODD, &expected));
    odkit(&["check", "--fix", &path], "");
    assert_eq!(fs::read(&path).expect("it is there"), fixed);
    odkit(&["check", "--unsafe-fixes", &path], "");
    let guessed = fs::read(&path).expect("it is there");
    assert_eq!(guessed, replaced(&fixed, &[(b"=maybe", b"=0")]));
}

fn replaced(bytes: &[u8], pairs: &[(&[u8], &[u8])]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for (old, new) in pairs {
        let at = bytes.windows(old.len()).position(|part| part == *old);
        let at = at.expect("what is to be replaced");
        bytes.splice(at..at + old.len(), new.iter().copied());
    }
    bytes
}

#[test]
fn diff_writes_no_file() {
    let path = odd("diff.eds");
    let run = odkit(&["check", "--diff", &path], "");
    assert_eq!(run.code, 1);
    for line in ["-DataType:0x5\n", "+DataType=0x5\n", "+DefaultValue=8\n"] {
        assert!(run.out.contains(line), "{}", run.out);
    }
    assert!(!run.out.contains("maybe\n+"), "{}", run.out);
    assert_eq!(fs::read(&path).expect("it is there"), ODD);
    let clean = repository("devices/eds/GXMM.eds");
    let run = odkit(&["check", "--diff", "--unsafe-fixes", &clean], "");
    assert_eq!(
        (run.code, run.out.as_str()),
        (0, "1 file checked: nothing to report\n")
    );
}

#[test]
fn remarks_are_shown_when_asked_for() {
    let path = odd("remarks.eds");
    let quiet = odkit(&["check", &path], "");
    assert!(!quiet.out.contains("I0408"), "{}", quiet.out);
    assert!(quiet.out.contains("add `--remarks`"), "{}", quiet.out);
    let all = odkit(&["check", "--remarks", &path], "");
    assert!(all.out.contains("remark[I0408]"), "{}", all.out);
}

#[test]
fn codes_are_allowed_by_file_and_by_object() {
    let path = odd("allow.eds");
    let run = odkit(&["check", &path, "--allow", "W0108:2000"], "");
    assert!(
        run.out.contains("W0108"),
        "it is about no object: {}",
        run.out
    );
    let run = odkit(
        &[
            "check",
            &path,
            "--allow",
            "w0108",
            "--allow",
            "W0406:0x2000",
        ],
        "",
    );
    assert!(
        !run.out.contains("W0108") && !run.out.contains("W0406"),
        "{}",
        run.out
    );
    for wrong in ["W99", "W0108:20000", ""] {
        let run = odkit(&["check", &path, "--allow", wrong], "");
        assert_eq!(run.code, 2, "{wrong}");
    }
}

#[test]
fn several_folders_and_files_have_one_report() {
    let folder = folder("tree/of/files", &[]);
    for name in ["b.eds", "a.DCF", "notes.txt"] {
        fs::write(folder.join(name), ODD).expect("a folder for test files");
    }
    let tree = folder.join("../..").display().to_string();
    let run = odkit(&["check", &tree, "--format", "json"], "");
    assert_eq!(run.code, 1);
    let report: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!(report["version"], 3);
    let files = report["files"].as_array().expect("a list");
    let names: Vec<_> = files.iter().map(|file| file["path"].as_str()).collect();
    assert_eq!(names.len(), 2, "{names:?}");
    assert!(names[0].is_some_and(|name| name.ends_with("a.DCF")));
    let findings = files[0]["diagnostics"].as_array().expect("a list");
    let octal = findings.iter().find(|d| d["code"] == "I0408");
    let octal = octal.expect("machine formats have remarks");
    assert_eq!(
        (&octal["object"], &octal["span"]["line"]),
        (&"2000h:00".into(), &7.into())
    );
    assert_eq!(octal["fix"]["applicability"], "safe");
    let edit = &octal["fix"]["edits"][0];
    let place = |key: &str| edit[key].as_u64().map_or(0, |n| n as usize);
    assert_eq!(&ODD[place("start")..place("end")], b"010");
    assert_eq!(edit["text"], "8");
}

/// The bytes of a text in an encoding, after its byte order mark.
fn encoded(text: &str, encoding: &str) -> Vec<u8> {
    let units = || text.encode_utf16();
    match encoding {
        "windows-1252" => text.chars().map(|c| c as u8).collect(),
        "utf-8" => text.as_bytes().to_vec(),
        "utf-8 with a mark" => [b"\xEF\xBB\xBF", text.as_bytes()].concat(),
        "utf-16le" => [0xFEFF]
            .into_iter()
            .chain(units())
            .flat_map(u16::to_le_bytes)
            .collect(),
        _ => [0xFEFF]
            .into_iter()
            .chain(units())
            .flat_map(u16::to_be_bytes)
            .collect(),
    }
}

/// Every place in a report is a place of the file on the disk.
#[test]
fn offsets_are_bytes_of_the_file() {
    let text: String = ODD.iter().map(|byte| char::from(*byte)).collect();
    for encoding in [
        "windows-1252",
        "utf-8",
        "utf-8 with a mark",
        "utf-16le",
        "utf-16be",
    ] {
        let bytes = encoded(&text, encoding);
        let body = |text: &str| {
            let mark = encoded("", encoding).len();
            encoded(text, encoding)[mark..].to_vec()
        };
        let path = file(&format!("{}.eds", encoding.replace(' ', "-")), "");
        fs::write(&path, &bytes).expect("a folder for test files");
        let path = path.display().to_string();
        let run = odkit(&["check", &path, "--format", "json"], "");
        let json: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
        let number = |value: &serde_json::Value| value.as_u64().expect("a number") as usize;
        let found = json["files"][0]["diagnostics"].as_array().expect("a list");
        for (code, part) in [("W0108", ":"), ("I0408", "010"), ("W0407", "maybe")] {
            let one = found.iter().find(|one| one["code"] == code).expect(code);
            let (start, end) = (number(&one["span"]["start"]), number(&one["span"]["end"]));
            assert_eq!(&bytes[start..end], body(part), "{encoding} {code}");
            for edit in one["fix"]["edits"].as_array().into_iter().flatten() {
                let replaced = &bytes[number(&edit["start"])..number(&edit["end"])];
                assert_eq!(replaced, body(part), "{encoding} {code}");
            }
        }
        let run = odkit(&["check", &path, "--format", "sarif"], "");
        let sarif: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
        let results = sarif["runs"][0]["results"].as_array().expect("a list");
        let octal = results
            .iter()
            .find(|one| one["ruleId"] == "I0408")
            .expect("octal");
        let region = &octal["locations"][0]["physicalLocation"]["region"];
        let fixed = &octal["fixes"][0]["artifactChanges"][0]["replacements"][0];
        for region in [region, &fixed["deletedRegion"]] {
            let start = number(&region["byteOffset"]);
            let end = start + number(&region["byteLength"]);
            assert_eq!(&bytes[start..end], body("010"), "{encoding}");
        }
        let at = number(&fixed["deletedRegion"]["charOffset"]);
        let chars: String = text.chars().skip(at).take(3).collect();
        assert_eq!(chars, "010", "{encoding}");
    }
}

#[test]
fn sarif_and_github_point_at_the_place() {
    let path = odd("machine.eds");
    let run = odkit(&["check", &path, "--format", "sarif"], "");
    let report: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!(report["version"], "2.1.0");
    let run_of = &report["runs"][0];
    let results = run_of["results"].as_array().expect("a list");
    let colon = results.iter().find(|result| result["ruleId"] == "W0108");
    let colon = colon.expect("the finding");
    let region = &colon["locations"][0]["physicalLocation"]["region"];
    assert_eq!(
        (&region["startLine"], &region["startColumn"]),
        (&4.into(), &9.into())
    );
    let rule = colon["ruleIndex"].as_u64().map_or(0, |n| n as usize);
    assert_eq!(run_of["tool"]["driver"]["rules"][rule]["id"], "W0108");
    let replacement = &colon["fixes"][0]["artifactChanges"][0]["replacements"][0];
    assert_eq!(replacement["insertedContent"]["text"], "=");
    let run = odkit(&["check", &path, "--format", "github"], "");
    let line = run.out.lines().find(|line| line.contains("title=W0108"));
    assert!(
        line.is_some_and(|line| line.contains(",line=4,endLine=4,col=9,endColumn=10,")),
        "{}",
        run.out
    );
}

#[test]
fn with_strict_warnings_are_errors() {
    let path = file("warned.eds", &format!("{}\n[Tool]\nstray\n", clean()));
    let path = path.display().to_string();
    assert_eq!(odkit(&["check", &path], "").code, 0);
    assert_eq!(odkit(&["check", "--strict", &path], "").code, 1);
}

fn clean() -> String {
    fs::read_to_string(repository("devices/eds/GXMM.eds")).expect("our own file")
}

#[test]
fn explain_has_a_page_for_each_code() {
    let one = odkit(&["explain", "w0108"], "");
    assert_eq!(one.code, 0);
    assert!(one.out.starts_with("W0108 (warning): "), "{}", one.out);
    assert!(one.out.contains("Source: CiA 306-1"), "{}", one.out);
    let list = odkit(&["explain", "--list"], "");
    assert!(list.out.lines().count() >= 60, "{}", list.out);
    let near = odkit(&["explain", "E0108"], "");
    assert_eq!(near.code, 2);
    assert!(near.err.contains("did you mean W0108?"), "{}", near.err);
    let codes = odkit(&["explain", "emcy", "8130h", "0x06070010"], "");
    assert!(codes.out.starts_with("8130h life guard"), "{}", codes.out);
    assert!(codes.out.contains("\n06070010h length"), "{}", codes.out);
    let fault = odkit(&["explain", "heartbeat-lost"], "");
    assert!(fault.out.contains("A heartbeat stops"), "{}", fault.out);
    let word = odkit(&["explain", "heartbeat"], "");
    assert!(
        word.err.contains("not a code of a rule (E0412), of an SDO"),
        "{}",
        word.err
    );
    assert_eq!(odkit(&["explain", "E9999"], "").code, 2);
    assert_eq!(odkit(&["explain"], "").code, 2);
}
