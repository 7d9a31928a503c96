//! `odkit.toml`, formats of the report of `odkit check`, and findings of base and overlay.

use std::fs;

use crate::support::{Done, folder, odkit, repository};

/// A remark (I0410), a warning with a safe fix (W0108) and an error (E0412).
const FILE: &str = "[2000]\nParameterName=Gain\nDataType:0x2\nAccessType=rw\nDefaultValue=0xFF\n\
    [2001]\nParameterName=Speed\nDataType=0x5\nAccessType=rw\nDefaultValue=300\n";

fn check(folder: &std::path::Path, args: &[&str]) -> Done {
    let path = folder.display().to_string();
    odkit(&[&["check"], args, &[path.as_str()]].concat(), "")
}

#[test]
fn a_project_sets_its_own_severities() {
    let settings = "[rules]\nE0412 = \"warning\"\nW0108 = \"off\"\n\"I0410:2000\" = \"error\"\n\
        [[files]]\npattern = \"vendor/**\"\nrules = { W0108 = \"on\", E0412 = \"off\" }\n";
    let files = [
        ("odkit.toml", settings),
        ("a.eds", FILE),
        ("vendor/x/b.eds", FILE),
    ];
    let folder = folder("severities", &files);
    let run = check(&folder, &["--output-format", "concise"]);
    let (a, b) = (folder.join("a.eds"), folder.join("vendor/x/b.eds"));
    for line in [
        format!(
            "{}:10:14: warning[E0412] 2001h \"Speed\": DefaultValue `300`",
            a.display()
        ),
        format!(
            "{}:5:14: error[I0410] [fixable] 2000h \"Gain\": ",
            a.display()
        ),
        format!("{}:3:9: warning[W0108] [fixable] ", b.display()),
    ] {
        assert!(run.out.contains(&line), "{line}\n{}", run.out);
    }
    assert!(
        !run.out.contains(&format!("{}:3:9", a.display())),
        "{}",
        run.out
    );
    assert!(
        !run.out.contains(&format!("{}:10:14", b.display())),
        "{}",
        run.out
    );
    // --config selects another file, for every command.
    let other = folder.join("other.toml");
    fs::write(&other, "strict = true\nremarks = true\n").expect("written");
    let other = other.display().to_string();
    let run = check(&folder, &["--config", &other, "--output-format=concise"]);
    assert!(run.out.contains("a.eds:5:14: remark[I0410]"), "{}", run.out);
    assert!(run.out.contains("error[E0412]"), "{}", run.out);
    assert_eq!(run.code, 1);
}

#[test]
fn errors_in_the_settings_are_reported() {
    for (name, settings, expected) in [
        ("key", "ruls = 1\n", "unknown field `ruls`"),
        (
            "code",
            "[rules]\nW9999 = \"off\"\n",
            "`W9999` is not the code of a finding",
        ),
        (
            "value",
            "[rules]\nW0108 = \"loud\"\n",
            "unknown variant `loud`",
        ),
        ("toml", "[rules\n", "TOML parse error at line 1"),
        (
            "pattern",
            "[[files]]\nrules = {}\n",
            "missing field `pattern`",
        ),
    ] {
        let files = [("odkit.toml", settings), ("a.eds", FILE)];
        let folder = folder(&format!("settings-{name}"), &files);
        let run = check(&folder, &[]);
        assert_eq!(run.code, 2, "{}", run.err);
        assert!(
            run.err.contains(expected) && run.err.contains("odkit.toml"),
            "{}",
            run.err
        );
        let eds = folder.join("a.eds").display().to_string();
        let convert = odkit(&["convert", &eds, "-o", "-", "--to", "json"], "");
        assert_eq!(convert.code, 2, "{}", convert.err);
    }
    let missing = odkit(
        &[
            "check",
            "--config",
            "nowhere.toml",
            &repository("devices/eds/GXMM.eds"),
        ],
        "",
    );
    assert!(
        missing.err.contains("nowhere.toml: it does not exist"),
        "{}",
        missing.err
    );
}

#[test]
fn every_format_of_the_report_has_its_form() {
    let folder = folder("forms", &[("a.eds", FILE)]);
    let path = folder.join("a.eds");
    let full = check(&folder, &[]);
    assert!(
        full.out
            .contains("= note: object 2001h \"Speed\" (CiA 306-1, object sections")
    );
    assert!(full.out.contains("10 | DefaultValue=300"), "{}", full.out);
    let grouped = check(&folder, &["--output-format", "grouped"]);
    assert!(
        grouped.out.starts_with(&format!("{} (", path.display())),
        "{}",
        grouped.out
    );
    assert!(
        grouped
            .out
            .contains("\n  10:14: error[E0412] 2001h \"Speed\": "),
        "{}",
        grouped.out
    );
    let statistics = check(&folder, &["--statistics"]);
    let line = "      1  W0108  `:` instead of `=` in 1 file (1 with a safe fix)\n";
    assert!(statistics.out.contains(line), "{}", statistics.out);
    assert!(!statistics.out.contains("a.eds:"), "{}", statistics.out);
    let json = check(&folder, &["--statistics", "--output-format", "json"]);
    assert!(json.out.contains("\"code\": \"W0108\""), "{}", json.out);
}

#[test]
fn findings_of_an_overlay_have_the_lines_of_their_file() {
    let overlay =
        "; \u{b5}\n[5000]\nParameterName=Lamp\nDataType=0x0005\nAccessType=rw\nDefaultValue=300\n";
    let folder = folder("laid", &[("lamp.overlay", overlay)]);
    let overlay_path = folder.join("lamp.overlay").display().to_string();
    let name = format!("{}+{overlay_path}", repository("devices/eds/GXMM.eds"));
    let json = odkit(&["check", "--format", "json", &name], "");
    let report: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    let files = report["files"].as_array().expect("files");
    let own = files
        .iter()
        .find(|file| file["path"] == overlay_path.as_str());
    let found = own.expect("the overlay")["diagnostics"].as_array();
    let mut found = found.expect("findings").iter();
    let found = found.find(|one| one["code"] == "E0412");
    let found = found.expect("the value that does not fit");
    assert_eq!(found["span"]["line"], 6);
    let start = overlay.find("300").expect("it is there");
    assert_eq!(found["span"]["start"], start);
    let sarif = odkit(&["check", "--format", "sarif", &name], "");
    let report: serde_json::Value = serde_json::from_str(&sarif.out).expect("JSON");
    let results = report["runs"][0]["results"].as_array();
    let found = results.expect("results").iter();
    let mut own = found.filter(|one| one["ruleId"] == "E0412");
    let place = &own.next().expect("it is there")["locations"][0]["physicalLocation"];
    assert_eq!(place["region"]["startLine"], 6);
    assert_eq!(place["region"]["byteOffset"], start);
    let uri = place["artifactLocation"]["uri"].as_str().expect("a path");
    assert!(uri.ends_with("lamp.overlay"), "{uri}");
    let github = odkit(&["check", "--format", "github", &name], "");
    assert!(
        github.out.contains("lamp.overlay,line=6,"),
        "{}",
        github.out
    );
}

/// Messages of a client, in the format that the language server reads.
fn framed(messages: &[&str]) -> String {
    let frame = |text: &&str| format!("Content-Length: {}\r\n\r\n{text}", text.len());
    messages.iter().map(frame).collect()
}

#[test]
fn an_editor_sees_what_check_reports() {
    let settings = "[rules]\nE0412 = \"warning\"\nW0108 = \"off\"\n";
    let folder = folder("editor", &[("odkit.toml", settings), ("a.eds", FILE)]);
    let uri = format!("file://{}", folder.join("a.eds").display());
    let text = FILE.replace('\n', "\\n");
    let open = format!(
        r#"{{"jsonrpc":"2.0","method":"textDocument/didOpen","params":{{"textDocument":{{"uri":"{uri}","version":1,"text":"{text}"}}}}}}"#
    );
    let start = r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}"#;
    let stop = r#"{"jsonrpc":"2.0","id":2,"method":"shutdown"}"#;
    let exit = r#"{"jsonrpc":"2.0","method":"exit"}"#;
    // An unreadable message gets an answer, and the next message is read.
    let broken = "Content-Length: x\r\n\r\n";
    let input = framed(&[start]) + broken + &framed(&["{", &open]);
    let run = odkit(&["lsp"], &input);
    assert_eq!((run.code, run.err.as_str()), (1, ""), "no shutdown");
    assert_eq!(run.out.matches("\"code\":-32700").count(), 2, "{}", run.out);
    let said = run
        .out
        .split("Content-Length")
        .find(|text| text.contains("publishDiagnostics"));
    let said = said.expect("diagnostics");
    assert!(said.contains(r#""severity":2,"code":"E0412""#), "{said}");
    assert!(!said.contains("W0108"), "{said}");
    let run = odkit(&["lsp", "--stdio"], &framed(&[start, &open, stop, exit]));
    assert_eq!(run.code, 0);
    assert!(
        run.out
            .ends_with(r#"{"jsonrpc":"2.0","id":2,"result":null}"#),
        "{}",
        run.out
    );
}
