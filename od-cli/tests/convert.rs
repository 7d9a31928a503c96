//! `odkit convert`: EDS, DCF, XDD, Markdown, C header, JSON.

mod support;

use std::io::Write;
use std::process::{Command, Stdio};

use support::{file, odkit, repository};

#[test]
fn an_eds_of_a_device_is_the_device() {
    let text = odkit(&["convert", "gcmm", "--to", "eds"], "");
    assert_eq!(text.code, 0, "{}", text.err);
    let path = file("gcmm.eds", &text.out).display().to_string();
    let diff = odkit(&["diff", "gcmm", &path, "--fail-on", "any"], "");
    assert_eq!(diff.code, 0, "{}", diff.out);
}

#[test]
fn a_dcf_is_one_device_with_its_values() {
    let dcf = [
        "convert",
        "gxmm",
        "--to",
        "dcf",
        "--node-id",
        "5",
        "--bit-rate",
        "250",
        "--set",
        "6001h=4096",
        "--set",
        "1017h=1000",
    ];
    let made = odkit(&dcf, "");
    assert_eq!(made.code, 0, "{}", made.err);
    for line in [
        "[DeviceComissioning]",
        "NodeID=5",
        "Baudrate=250",
        "ParameterValue=0x1000",
    ] {
        assert!(made.out.contains(line), "{line}\n{}", made.out);
    }
    let path = file("five.dcf", &made.out).display().to_string();
    let again = odkit(&["convert", &path, "--to", "dcf"], "");
    assert_eq!((again.code, again.out), (0, made.out));
    let script = format!("device {path}\nexpect 705#00\nsdo read 6001h = 4096\n");
    let run = odkit(&["run", "-"], &script);
    assert_eq!(run.code, 0, "{}", run.err);
}

#[test]
fn an_xdd_of_a_device_is_the_device() {
    for device in ["gxmm", "eam_mt", "en580c"] {
        let text = odkit(&["convert", device, "--to", "xdd"], "");
        assert_eq!(text.code, 0, "{}", text.err);
        let path = file(&format!("{device}.xdd"), &text.out)
            .display()
            .to_string();
        let diff = odkit(&["diff", device, &path, "--fail-on", "any"], "");
        assert_eq!(diff.code, 0, "{}{}", diff.out, diff.err);
        assert_eq!(odkit(&["check", &path], "").code, 0, "{device}");
    }
}

#[test]
fn markdown_has_the_objects() {
    let page = odkit(&["convert", "gxmm", "--to", "md"], "");
    assert_eq!(page.code, 0, "{}", page.err);
    assert!(page.out.contains("6004h"), "{}", page.out);
}

#[test]
fn what_cannot_be_set_is_said() {
    for (arguments, said) in [
        (&["--to", "dcf"][..], "--node-id 5"),
        (
            &["--to", "dcf", "--node-id", "5", "--set", "6004h=1"],
            "6004h is `ro` and cannot be set",
        ),
        (
            &["--to", "dcf", "--node-id", "5", "--set", "6001h=9999999"],
            "outside 1..8192",
        ),
        (
            &["--to", "dcf", "--node-id", "5", "--set", "5FFFh=1"],
            "5FFFh",
        ),
        (&["--to", "eds", "--node-id", "5"], "--to dcf"),
        (&["-o", "x.txt"], "--to eds"),
    ] {
        let run = odkit(&[&["convert", "gxmm"], arguments].concat(), "");
        assert_eq!(run.code, 2, "{arguments:?} {}", run.err);
        assert!(run.err.contains(said), "{arguments:?} {}", run.err);
    }
}

#[test]
fn json_has_every_entry() {
    let json = odkit(&["convert", "gxmm", "--to", "json"], "");
    let value: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    let objects = value["objects"].as_array().expect("a list");
    let position = objects.iter().find(|object| object["index"] == "0x6004");
    let position = &position.expect("a position")["entries"][0];
    assert_eq!(position["dataType"], "UNSIGNED32");
    assert_eq!(
        (&position["tpdo"], &position["access"]),
        (&true.into(), &"ro".into())
    );
    let cob_id = objects.iter().find(|object| object["index"] == "0x1014");
    assert_eq!(
        cob_id.expect("an object")["entries"][0]["default"]["nodeIdPlus"],
        128
    );
}

/// The header is C: a compiler takes it, with a use of what it defines.
#[test]
fn a_c_compiler_takes_the_header() {
    let eds = repository("devices/eds/GXMM.eds");
    let header = odkit(&["convert", &eds, "--to", "c"], "");
    assert_eq!(header.code, 0, "{}", header.err);
    assert!(
        header
            .out
            .contains("#define GXMM_POSITION_VALUE_INDEX 0x6004u")
    );
    let program = format!(
        "#define NODE_ID 5u\n{}\nunsigned a[] = {{ GXMM_POSITION_VALUE_INDEX, \
         GXMM_COB_ID_EMERGENCY_MESSAGE_DEFAULT, GXMM_MEASURING_UNITS_PER_REVOLUTION_MAX }};\n",
        header.out
    );
    let compiler = Command::new("cc")
        .args([
            "-x",
            "c",
            "-std=c99",
            "-Wall",
            "-Werror",
            "-fsyntax-only",
            "-",
        ])
        .stdin(Stdio::piped())
        .spawn();
    let Ok(mut compiler) = compiler else {
        assert!(
            std::env::var_os("CI").is_none(),
            "CI needs a C compiler `cc`"
        );
        println!("skipped: there is no C compiler `cc`");
        return;
    };
    let mut input = compiler.stdin.take().expect("a pipe");
    input.write_all(program.as_bytes()).expect("it reads");
    drop(input);
    assert!(compiler.wait().expect("it ends").success(), "{program}");
}
