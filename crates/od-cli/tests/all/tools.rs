//! `odkit check --for`: how other tools read a file.

use std::fs;

use crate::support::{Done, folder, odkit};

/// python-canopen reads it with another default and without the mapping; nothing stops it.
const DIFFERS: &str = "[2000]\nParameterName=Gain\nObjectType=7\nDataType=0x5\nAccessType=rw\n\
    DefaultValue=010\nPdoMapping=1\n";
/// It stops python-canopen, which expects numbers.
const STOPS: &str = "[DeviceInfo]\nVendorNumber=\n";

fn check(path: &std::path::Path, args: &[&str]) -> Done {
    let path = path.display().to_string();
    odkit(&[&["check"], args, &[path.as_str()]].concat(), "")
}

#[test]
fn a_tool_is_named_with_line_and_fix() {
    let file = folder("tools-fix", &[("a.eds", DIFFERS)]).join("a.eds");
    let run = check(&file, &["--output-format", "concise"]);
    assert!(!run.out.contains("python-canopen"), "{}", run.out);
    let args = ["--for", "python-canopen", "--output-format", "concise"];
    let run = check(&file, &args);
    for line in [
        ":6:14: warning[T0112] [fixable] 2000h \"Gain\": python-canopen drops DefaultValue, which is `8`",
        ":7:12: warning[T0114] [fixable] 2000h \"Gain\": python-canopen reads PDOMapping as `0`, not as `1`",
    ] {
        assert!(run.out.contains(line), "{line}\n{}", run.out);
    }
    check(&file, &["--for", "python-canopen", "--fix"]);
    let fixed = fs::read_to_string(&file).expect("it is there");
    assert_eq!(
        fixed,
        DIFFERS
            .replace("=010", "=8")
            .replace("PdoMapping", "PDOMapping")
    );
    let run = check(&file, &args);
    assert!(!run.out.contains("[T01"), "{}", run.out);
}

#[test]
fn a_file_that_a_tool_rejects_has_an_error_in_every_report() {
    let file = folder("tools-stop", &[("b.eds", STOPS)]).join("b.eds");
    let said = "python-canopen rejects the file: it cannot read `VendorNumber=` as a number";
    for format in ["full", "grouped", "github", "json", "sarif"] {
        let run = check(
            &file,
            &["--for", "PYTHON-canopen", "--output-format", format],
        );
        assert_eq!(run.code, 1);
        let out = run.out.replace("%3D", "=");
        assert!(
            out.contains("T0105") && out.contains(said),
            "{format}: {out}"
        );
    }
    let run = check(
        &file,
        &["--for", "python-canopen", "--output-format", "json"],
    );
    let at = run.out.find("\"tools\"").expect("the verdicts");
    let outcome = &run.out[at..at + 200];
    assert!(outcome.contains("\"verdict\": \"rejects\""), "{outcome}");
    let allowed = check(&file, &["--for", "python-canopen", "--allow", "T0105"]);
    assert!(!allowed.out.contains("T0105"), "{}", allowed.out);
}

#[test]
fn all_tools_make_a_table() {
    let files = [("a.eds", DIFFERS), ("b.eds", STOPS)];
    let folder = folder("tools-table", &files);
    let run = check(&folder, &["--for", "all"]);
    let row = |path: &str, tool: &str| {
        let of_file = run.out.split(path).nth(1).expect("the file");
        let mut lines = of_file.lines();
        let found = lines.find(|line| line.trim_start().starts_with(tool));
        found.expect("a line for each tool").to_owned()
    };
    assert!(row("a.eds", "python-canopen").contains("reads differently"));
    assert!(row("b.eds", "python-canopen").contains("rejects"));
    assert!(row("b.eds", "odkit").contains("error"));
    assert!(
        !run.out.contains("-->"),
        "a table, not findings: {}",
        run.out
    );
}

#[test]
fn a_project_names_its_tools() {
    let of_project = |name: &str, tools: &str| {
        let settings = format!("tools = [{tools}]\n");
        let files = [("odkit.toml", settings.as_str()), ("a.eds", DIFFERS)];
        check(&folder(name, &files), &["--output-format", "concise"])
    };
    let run = of_project("tools-project", "\"python-canopen\"");
    assert!(run.out.contains("T0112"), "{}", run.out);
    let run = of_project("tools-unknown", "\"python-kanopen\"");
    assert_eq!(run.code, 2);
    assert!(
        run.err.contains("`python-kanopen` is not a tool"),
        "{}",
        run.err
    );
    let run = odkit(&["check", "--for", "nosuch", "x.eds"], "");
    assert_eq!(run.code, 2);
}

#[test]
fn a_rule_of_a_tool_is_explained_and_can_be_allowed_in_the_file() {
    let run = odkit(&["explain", "t0105"], "");
    for part in ["T0105 (error)", "Tool:   python-canopen 2.4.1", "Example:"] {
        assert!(run.out.contains(part), "{}", run.out);
    }
    let text = DIFFERS.replace(
        "DefaultValue",
        ";odkit-allow=T0112 not read by us\nDefaultValue",
    );
    let file = folder("tools-allow", &[("c.eds", &text)]).join("c.eds");
    let run = check(&file, &["--for", "python-canopen", "--remarks"]);
    assert!(
        run.out.contains("T0114") && !run.out.contains("T0112"),
        "{}",
        run.out
    );
    // Without the tool, the comment is not reported as unused.
    let run = check(&file, &["--remarks"]);
    assert!(!run.out.contains("T0112"), "{}", run.out);
}
