//! `odkit run`: exit codes, output, and messages about failed expectations.

use crate::support::{file, odkit, repository};

#[test]
fn candump_lines_in_and_candump_lines_out() {
    let script = "(0.100000) can0 601#4000100000000000\n(0.200000) can0 701#R\n";
    let run = odkit(&["run", "-"], script);
    assert_eq!(run.code, 0, "{}", run.err);
    assert_eq!(
        run.out,
        "(0.000000) can0 701#00\n(0.100000) can0 581#4300100096010200\n"
    );
    assert_eq!(run.err, "");
    let echo = odkit(&["run", "-", "--echo"], script);
    assert_eq!(
        echo.out,
        "(0.000000) can0 701#00\n(0.100000) can0 601#4000100000000000\n\
         (0.100000) can0 581#4300100096010200\n(0.200000) can0 701#R\n"
    );
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let trace = repository("tests/conformance/bus-cover/trace-6-4.script");
    let (first, second) = (odkit(&["run", &trace], ""), odkit(&["run", &trace], ""));
    assert_eq!((first.code, &first.out), (0, &second.out));
    assert!(first.err.contains("expectations held"), "{}", first.err);
}

#[test]
fn a_failed_expectation_shows_what_came_instead() {
    let script = "expect 701#00\n601#40 00 20 00\nexpect 581#43 *\n";
    let run = odkit(&["run", "-"], script);
    assert_eq!(run.code, 1);
    assert_eq!(
        run.err,
        "odkit: -: line 3 at 0.000000 s: expect 581#43 *\n  expected  581#43*\n  \
         but       (0.000000) 581#8000200000000206 came: SDO node 1: 2000h:00 aborted: \
         06020000h object does not exist\n"
    );
    assert!(run.out.ends_with("581#8000200000000206\n"));
}

#[test]
fn a_missing_frame_is_waited_for() {
    let run = odkit(
        &["run", "-"],
        "expect 701#00\nnmt start\nexpect 181#* within 500ms\n",
    );
    assert_eq!(run.code, 1);
    let expected = "nothing came by 0.500000 s; 15ms later (0.515000) 181#00000000 came: \
                    PDO node 1: TPDO1 Position value = 0";
    assert!(run.err.contains(expected), "{}", run.err);
}

#[test]
fn a_script_that_cannot_be_read_names_every_line() {
    let run = odkit(
        &["run", "-"],
        "frobnicate\nwait 5\nexpect 581#4\nshaft rpm fast\n601#4g\n",
    );
    assert_eq!(run.code, 2);
    for line in [
        "-:1:1: `frobnicate` is not a verb or a frame; begin the line with a frame",
        "-:2:6: `5` is not a duration; write 500ms",
        "-:3:12: half a byte; write bytes as two hex digits",
        "-:4:11: the number is missing; write `shaft at",
        "-:5:6: `g` is not a hex digit; write 0",
        "odkit: -: 5 lines cannot be read",
    ] {
        assert!(run.err.contains(line), "{line}\n{}", run.err);
    }
    assert_eq!(run.out, "");
}

#[test]
fn a_line_that_cannot_be_carried_out_is_a_mistake_of_the_script() {
    for (script, why) in [
        (
            "device gxmn",
            "`gxmn`\nhelp: built-in devices are gxmm, gxam",
        ),
        ("wait 1s\nat 500ms sync", "this moment is in the past"),
        (
            "use left",
            "device `left` does not exist; write its number, 1 to 1, or the name",
        ),
        ("expect value 2000h = 1", "object 2000h does not exist"),
        ("expect value \"Speed\" = 1", "no object is called `Speed`"),
        ("sdo write 2101h = 256", "UNSIGNED8 goes from 0 to 255"),
    ] {
        let run = odkit(&["run", "-"], script);
        assert_eq!(run.code, 2, "{script}: {}", run.err);
        assert!(run.err.contains(why), "{script}: {}", run.err);
    }
    let missing = odkit(&["run", "no-such.script"], "");
    assert_eq!(missing.code, 2);
    assert_eq!(missing.err, "odkit: no-such.script: it does not exist\n");
}

#[test]
fn long_lines_are_not_printed_in_full() {
    let long = "x".repeat(1_000_000);
    for (script, code) in [
        (format!("{long}\n"), 2),
        (format!("wait {long}\n"), 2),
        (format!("use {long}\n"), 2),
        (format!("device {long}\n"), 2),
        (format!("sdo read {long}\n"), 2),
        (format!("expect value 6004h = {long}\n"), 2),
        (format!("sdo write 6004h = {long} as u16\n"), 2),
        (format!("expect {}701#05\n", " ".repeat(1_000_000)), 1),
    ] {
        let run = odkit(&["run", "-"], &script);
        let start: String = script.chars().take(20).collect();
        assert_eq!(run.code, code, "{start}");
        assert!(
            run.err.len() < 2000,
            "{start}: {} bytes\n{:.2000}",
            run.err.len(),
            run.err
        );
    }
    let run = odkit(&["run", "-"], &long);
    let quoted = format!("-:1:1: `{}…` is not a verb or a frame", "x".repeat(60));
    assert!(run.err.starts_with(&quoted), "{:.2000}", run.err);
}

#[test]
fn virtual_time_has_a_limit() {
    for line in [
        "at 18446744073709.551615s nmt start",
        "wait 18446744073709.551615s",
        "(0.5) 601#\n(18446744073709.551615) 601#",
        "power cycle 99999999999999999999min",
        "send 080# 2 times every 3153600001s",
        "expect silence 3153600001s",
    ] {
        let run = odkit(&["run", "-"], line);
        assert_eq!(run.code, 2, "{line}: {}", run.err);
        assert!(run.err.contains("the limit is 100 years"), "{}", run.err);
    }
}

#[test]
fn eds_files_are_devices_too() {
    let eds = repository("tests/interop/strings.eds");
    let script = "expect 707#00\nsdo read 2000h = \"The quick brown fox jumps over the lazy dog\"\n\
                  sdo write \"Writable text\" = \"0123456789\"\nsdo read 2001h = \"0123456789\"\n";
    let run = odkit(&["run", "-", "--device", &eds], script);
    assert_eq!(run.code, 0, "{}", run.err);
    let other = odkit(
        &["run", "-", "--device", &eds, "--node-id", "0x10"],
        "expect 710#00",
    );
    assert_eq!(other.code, 0, "{}", other.err);
    // In a script, a path is relative to the script.
    std::fs::copy(&eds, file("beside.eds", "")).expect("a copy");
    let script = file("beside.script", "device beside.eds node 5\nexpect 705#00\n");
    let run = odkit(&["run", &script.display().to_string()], "");
    assert_eq!(run.code, 0, "{}", run.err);
}

#[test]
fn a_closed_pipe_does_not_panic() {
    let mut child = crate::support::command()
        .args(["run", "-"])
        .stdin(std::process::Stdio::piped())
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .expect("odkit starts");
    drop(child.stdout.take());
    let mut stdin = child.stdin.take().expect("a pipe");
    let script = "sdo write 1800h:05 = 1\nnmt start\nwait 60s\n";
    std::io::Write::write_all(&mut stdin, script.as_bytes()).expect("it reads its script");
    drop(stdin);
    let output = child.wait_with_output().expect("odkit ends");
    assert_eq!(output.status.code(), Some(0));
    let err = String::from_utf8_lossy(&output.stderr);
    assert!(!err.contains("panicked"), "{err}");
}

/// A short circuit takes the controller of the script off the bus; it stays off until it is restarted.
#[test]
fn a_script_restarts_its_controller_after_bus_off() {
    let script = "device gxmm node 5\nwait 1s\nline real\nline short\n605#4000100000000000\nwait 500ms\nline short off\n\
                  605#4000100000000000\nexpect silence 500ms\nline restart\nsdo read 1000h = 0x20196\n";
    let run = odkit(&["run", "-"], script);
    assert_eq!(run.code, 0, "{}", run.err);
}
