//! `odkit check`, `odkit dump`, and the command line itself.

use crate::support::{file, odkit, repository};

const BROKEN: &str = "\
[MandatoryObjects]
SupportedObjects=3
1=0x1000
2=0x1001
3=0x1018

[1000]
ParameterName=Device type
DataType=0x0007
AccessType=ro
DefaultValue=0.0
PDOMapping=0
";

#[test]
fn help_and_version_have_exit_code_zero() {
    let help = odkit(&["--help"], "");
    assert_eq!(help.code, 0);
    for word in [
        "sim",
        "run",
        "check",
        "explain",
        "dump",
        "gxmm",
        "Exit codes",
    ] {
        assert!(help.out.contains(word), "{word}\n{}", help.out);
    }
    let version = odkit(&["--version"], "");
    assert_eq!(
        (version.code, version.out),
        (0, format!("odkit {}\n", env!("CARGO_PKG_VERSION")))
    );
    for command in ["sim", "run", "check", "dump"] {
        let help = odkit(&[command, "--help"], "");
        assert_eq!(help.code, 0);
        assert!(help.out.contains("Usage: odkit"), "{}", help.out);
    }
}

#[test]
fn wrong_usage_has_exit_code_two() {
    let typo = odkit(&["chekc"], "");
    assert_eq!(typo.code, 2);
    assert!(typo.err.contains("'check'"), "{}", typo.err);
    assert_eq!(odkit(&[], "").code, 2);
    assert_eq!(odkit(&["check"], "").code, 2);
    let id = odkit(&["sim", "gxmm", "--node-id", "128"], "");
    assert_eq!(id.code, 2);
    assert!(id.err.contains("a node ID from 1 to 127"), "{}", id.err);
    assert_eq!(odkit(&["dump", "gxmm", "--format", "xml"], "").code, 2);
}

#[test]
fn check_shows_the_line_and_a_caret() {
    let path = file("broken.eds", BROKEN).display().to_string();
    let check = odkit(&["check", &path], "");
    assert_eq!(check.code, 1);
    assert!(
        check
            .out
            .contains("DefaultValue=0.0\n   |              ^^^"),
        "{}",
        check.out
    );
    assert!(
        check.out.contains(&format!("{path}:11:14")),
        "{}",
        check.out
    );
    assert!(check.out.contains("error[E"), "{}", check.out);
    assert!(check.out.contains("1 file checked: "), "{}", check.out);
    assert!(!check.out.contains('\u{1b}'), "no colours into a pipe");
}

#[test]
fn check_counts_findings_of_all_files() {
    let good = repository("devices/eds/GXMM.eds");
    let check = odkit(&["check", &good], "");
    assert_eq!(
        (check.code, check.out.as_str()),
        (0, "1 file checked: nothing to report\n")
    );
    let both = odkit(&["check", &good, "no-such.eds"], "");
    assert_eq!(both.code, 1);
    assert_eq!(both.err, "odkit: no-such.eds: it does not exist\n");
    assert!(
        both.out.ends_with("; 1 file could not be read\n"),
        "{}",
        both.out
    );
    assert_eq!(odkit(&["check", env!("CARGO_MANIFEST_DIR")], "").code, 1);
}

#[test]
fn crlf_files_are_shown_like_others() {
    let path = file("crlf.eds", &BROKEN.replace('\n', "\r\n"))
        .display()
        .to_string();
    let check = odkit(&["check", &path], "");
    assert!(
        check
            .out
            .contains("DefaultValue=0.0\n   |              ^^^"),
        "{}",
        check.out
    );
    assert!(!check.out.contains('\r'));
}

#[test]
fn dump_in_markdown_is_a_page() {
    let page = odkit(&["dump", "eam_mt", "--format", "md"], "");
    assert_eq!(page.code, 0);
    let written = repository("docs/datasheets/eam_mt.md");
    assert_eq!(page.out, std::fs::read_to_string(written).unwrap());
    let file = repository("devices/eds/GXMM.eds");
    let page = odkit(&["dump", &file, "--format", "md"], "");
    assert!(page.out.starts_with("# GXMM\n"), "{}", page.out);
    assert!(page.out.contains("| Position value |"), "{}", page.out);
}

#[test]
fn dump_is_an_aligned_table() {
    let dump = odkit(&["dump", "gxmm"], "");
    assert_eq!(dump.code, 0);
    let line = |start: &str| {
        let found = dump.out.lines().find(|line| line.starts_with(start));
        found
            .unwrap_or_else(|| panic!("{start}\n{}", dump.out))
            .to_owned()
    };
    let head = line("Index");
    let position = line("6004h");
    assert_eq!(head.find("Type"), position.find("UNSIGNED32"));
    assert_eq!(head.find("Access"), position.find("ro "));
    assert!(line("1014h").contains("80h+node ID"));
    assert!(line("1008h").contains("\"GXMM\""));
    let file = odkit(
        &[
            "dump",
            &repository("devices/eds/GXMM.eds"),
            "--format",
            "table",
        ],
        "",
    );
    assert_eq!((file.code, file.out), (0, dump.out));
}

#[test]
fn dump_refuses_what_is_not_a_device() {
    let missing = odkit(&["dump", "gxmx"], "");
    assert_eq!(missing.code, 1);
    assert!(
        missing
            .err
            .contains("`gxmx`\nhelp: built-in devices are gxmm, gxam"),
        "{}",
        missing.err
    );
    let other = odkit(&["dump", &repository("Cargo.toml")], "");
    assert_eq!(other.code, 1);
    assert!(
        other.err.contains("it has no section of an EDS"),
        "{}",
        other.err
    );
}

#[test]
fn check_of_a_network_names_the_command_for_it() {
    for (name, text) in [
        (
            "bus.yml",
            "options:\n  dcf_path: x\nmaster:\n  node_id: 1\n",
        ),
        ("nodelist.cpj", "[Topology]\nNodes=0\n"),
    ] {
        let path = file(name, text).display().to_string();
        let run = odkit(&["check", &path], "");
        assert_eq!(run.code, 1);
        let hint = "a project or a node list, not a device; `odkit network FILE` checks it";
        assert!(run.err.contains(hint), "{}", run.err);
    }
}

#[test]
fn a_file_with_errors_runs_with_its_valid_rest() {
    let path = file("runs.eds", BROKEN).display().to_string();
    let run = odkit(
        &["run", "-", "--device", &path],
        "expect 701#00\nsdo read 1000h = 0\n",
    );
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.err.contains("odkit leaves out the invalid objects"),
        "{}",
        run.err
    );
}

#[test]
fn closed_pipes_do_not_panic() {
    use std::process::Stdio;
    for args in [
        &["check", "no-such.eds"][..],
        &["run", "no-such.script"],
        &["dump", "gxmx"],
        &["bogus"],
    ] {
        let mut child = crate::support::command()
            .args(args)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("odkit starts");
        drop((child.stdout.take(), child.stderr.take()));
        let code = child.wait().expect("it ends").code();
        assert!(matches!(code, Some(1 | 2)), "{args:?}: {code:?}");
    }
}

#[test]
fn check_does_not_print_long_lines_in_full() {
    let text = format!("{BROKEN}{}\n", "ä".repeat(100_000));
    let path = file("long.eds", &text).display().to_string();
    let check = odkit(&["check", &path], "");
    assert_eq!(check.code, 1);
    assert!(check.out.contains("ä…`"), "{:.5000}", check.out);
    assert!(check.out.len() < 5000, "{} bytes", check.out.len());
}

#[test]
fn a_file_of_another_fieldbus_is_named() {
    let ip = "$ EZ-EDS\n[File]\n  DescText = \"Adapter\";\n[Device]\n  VendCode = 46;\n";
    let esi = "<?xml version=\"1.0\"?>\n<EtherCATInfo Version=\"1.2\"></EtherCATInfo>\n";
    for (name, text, kind) in [
        (
            "adapter.eds",
            ip,
            "it is an EDS of EtherNet/IP or DeviceNet (ODVA), not a device file of CANopen",
        ),
        (
            "slave.xml",
            esi,
            "it is an ESI file of EtherCAT, not a device file of CANopen",
        ),
    ] {
        let path = file(name, text).display().to_string();
        for command in ["check", "dump"] {
            let run = odkit(&[command, &path], "");
            let said = format!("{}{}", run.out, run.err);
            assert!(said.contains(kind), "{command}: {said}");
            assert_eq!(run.code, 1, "{command}");
        }
    }
}
