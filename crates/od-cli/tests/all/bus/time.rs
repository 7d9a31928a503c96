//! `monitor`, `watch`, `record`, `replay`, `decode`.

use std::io::{Read, Write};
use std::process::Stdio;

use serde_json::Value;

use super::{done, fails, link};
use crate::support::quiet::{Sim, until};
use crate::support::{command, file, odkit};

const LOG: &str = "(0.100000) can0 000#0105\n(0.110000) can0 185#9295070000000000\n\
                   (0.120000) can0 085#3081110000000000\n(0.130000) can0 605#4000100000000000\n\
                   (0.131000) can0 585#4300100096010200\n(0.200000) can0 705#05\n";

#[test]
fn signals_of_a_dbc_file_are_beside_the_words() {
    let log = file("bus-dbc.log", LOG).display().to_string();
    let dbc = file(
        "bus.dbc",
        &done(&["convert", "gxmm", "--to", "dbc", "--node-id", "5"]),
    );
    let dbc = dbc.display().to_string();
    let text = done(&["decode", &log, "--eds", "5=gxmm", "--dbc", &dbc]);
    let pdo = text
        .lines()
        .find(|line| line.contains(" 185 "))
        .unwrap_or_default();
    assert!(
        pdo.ends_with("Position value = 497042 (79592h)  | N5_TPDO1: Position_value 497042"),
        "{text}"
    );
    let csv = done(&["decode", &log, "--dbc", &dbc, "--format", "csv"]);
    assert!(
        csv.starts_with("time,id,data,service,node,object,error,text,signals\n"),
        "{csv}"
    );
    let json = done(&["decode", &log, "--dbc", &dbc, "--format", "json"]);
    let report: Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(
        report["frames"][1]["signals"][0]["value"], "497042",
        "{json}"
    );
    // The filter looks for words of signals, too.
    let name = report["frames"][1]["signals"][0]["name"]
        .as_str()
        .unwrap_or_default();
    let only = done(&[
        "decode",
        &log,
        "--dbc",
        &dbc,
        "--filter",
        &name.to_lowercase(),
    ]);
    assert!(only.lines().count() == 1 && only.contains(name), "{only}");
    let wrong = file("wrong.dbc", "VERSION \"\"\nBO_ x\n")
        .display()
        .to_string();
    let failed = odkit(&["decode", &log, "--dbc", &wrong], "");
    assert!(
        failed.code == 1 && failed.err.contains("wrong.dbc: line 2: `BO_ x`"),
        "{}",
        failed.err
    );
}

#[test]
fn a_log_of_any_format_is_shown_in_words() {
    let log = file("bus-a.log", LOG).display().to_string();
    let text = done(&["decode", &log, "--eds", "5=gxmm"]);
    assert!(text.contains("TPDO1 Position value = 497042"), "{text}");
    assert!(
        text.contains("! EMCY node 5: 8130h life guard or heartbeat error"),
        "{text}"
    );
    // A file without a node ID supplies names for all nodes.
    assert_eq!(done(&["decode", &log, "--eds", "gxmm"]), text);
    let plain = done(&["decode", &log]);
    assert!(
        plain.contains("PDO node 5") && !plain.contains("Position"),
        "{plain}"
    );
    for (ending, made) in [
        (
            "asc",
            "date x\nbase hex timestamps absolute\n 0.110000 1 185 Rx d 8 92 95 07 00 00 00 00 00\n",
        ),
        (
            "trc",
            ";$FILEVERSION=1.1\n  1) 110.0 Rx 0185 8 92 95 07 00 00 00 00 00\n",
        ),
    ] {
        let path = file(&format!("bus-a.{ending}"), made).display().to_string();
        let text = done(&["decode", &path, "--eds", "5=gxmm"]);
        assert!(
            text.contains("TPDO1 Position value = 497042"),
            "{ending}: {text}"
        );
    }
    let csv = done(&["decode", &log, "--eds", "5=gxmm", "--format", "csv"]);
    let mut rows = csv.lines();
    assert_eq!(
        rows.next(),
        Some("time,id,data,service,node,object,error,text")
    );
    assert!(
        csv.contains("0.120000,085,30 81 11 00 00 00 00 00,EMCY,5,,true,\"8130h"),
        "{csv}"
    );
    assert_eq!(rows.count(), 6);
    let json = done(&[
        "decode",
        &log,
        "--eds",
        "5=gxmm",
        "--format",
        "json",
        "--filter",
        "pdo or 1000",
    ]);
    let report: Value = serde_json::from_str(&json).expect("JSON");
    let frames = report["frames"].as_array().expect("frames");
    assert_eq!(frames.len(), 3, "{json}");
    assert_eq!(frames[0]["fields"][0]["name"], "Position value");
    assert_eq!(frames[0]["fields"][0]["object"], "6004h:00");
    assert!(fails(2, &["decode", &log, "--filter", "node:200"]).contains("1 to 127"));
    assert!(fails(1, &["decode", "bus-is-not-here.log"]).contains("does not exist"));
    let broken = file("bus-broken.log", &format!("{LOG}(0.3) can0 xyz\n"))
        .display()
        .to_string();
    let said = odkit(&["decode", &broken], "");
    assert!(
        said.code == 1 && said.err.contains("line 7"),
        "{}",
        said.err
    );
    assert_eq!(said.out.lines().count(), 6, "{}", said.out);
}

/// A GXMM encoder without a heartbeat sends nothing after its boot-up message.
#[test]
fn the_diagnosis_of_a_silent_bus_says_so() {
    let sim = Sim::start(&["gxmm", "--node-id", "5"]);
    let link = link(&sim);
    let args = ["diagnose", "--link", &link, "--for", "0.5"];
    // The boot-up message may come now.
    odkit(&args, "");
    let silent = odkit(&args, "");
    assert_eq!(silent.code, 0, "{}", silent.err);
    assert!(
        silent.err.contains("no frame was received"),
        "{}",
        silent.err
    );
}

#[test]
fn a_bus_is_recorded_replayed_and_monitored() {
    let sim = Sim::start(&["gxmm", "--node-id", "5"]);
    let link = link(&sim);
    let at = ["--link", &link];
    done(&[&["set", "5", "1017h=20"], &at[..]].concat());
    let names = ["--eds", "5=gxmm"];
    let lines = done(
        &[
            &["monitor", "--plain", "--count", "3", "--filter", "hb"],
            &names[..],
            &at,
        ]
        .concat(),
    );
    assert_eq!(lines.lines().count(), 3);
    assert!(lines.contains("NMT EC node 5: Pre-operational"), "{lines}");
    let by_id = done(
        &[
            &["monitor", "--by-id", "--count", "4", "--format", "json"],
            &at[..],
        ]
        .concat(),
    );
    let report: Value = serde_json::from_str(&by_id).expect("JSON");
    // A bench that got no processor time sends what is due in a burst, so the values are tested with given times, in
    // `monitor::stats`.
    let row = &report["ids"][0];
    assert_eq!(
        (row["id"].as_str(), row["frames"].as_u64()),
        (Some("705"), Some(4)),
        "{by_id}"
    );
    assert!(
        row["period_ms"].is_number() && report["load_percent"].is_number(),
        "{by_id}"
    );
    for ending in ["log", "pcapng"] {
        let path = file(&format!("bus-recorded.{ending}"), "")
            .display()
            .to_string();
        let said = done(&[&["record", &path, "--count", "5"], &at[..]].concat());
        assert!(said.contains("5 frames"), "{said}");
        assert_eq!(
            done(&["decode", &path, "--filter", "hb"]).lines().count(),
            5
        );
    }
    fails(2, &[&["record", "bus.asc"], &at[..]].concat());
    // Replayed frames are received: an NMT command, then SYNC messages.
    let log = file("bus-start.log", "(1.0) can0 000#0105\n(1.05) can0 080#\n")
        .display()
        .to_string();
    assert!(done(&[&["replay", &log], &at[..]].concat()).contains("2 frames sent"));
    let state = ["monitor", "--plain", "--count", "1", "--filter", "hb"];
    let lines = done(&[&state[..], &at].concat());
    assert!(lines.contains("Operational"), "{lines}");
}

#[test]
fn values_are_watched_by_tpdo_and_by_polls() {
    // The drive has no shaft of an encoder; `--rpm` leaves it as it is.
    let sim = Sim::start(&["gxmm@5,drive@6", "--rpm", "60"]);
    let link = link(&sim);
    let at = ["--link", &link];
    done(&[&["set", "5", "1800h:05=10"], &at[..]].concat());
    done(&[&["nmt", "5", "start", "--wait", "0"], &at[..]].concat());
    let csv = file("bus-watch.csv", "").display().to_string();
    let watched = odkit(
        &[
            &[
                "watch", "5", "6004h", "6000h", "--every", "50", "--count", "12", "--csv", &csv,
            ],
            &at[..],
        ]
        .concat(),
        "",
    );
    assert_eq!(watched.code, 0, "{}", watched.err);
    assert!(
        watched.err.contains("6004h Position value: TPDO1"),
        "{}",
        watched.err
    );
    assert!(
        watched
            .err
            .contains("6000h Operating parameters: SDO, every 50 ms"),
        "{}",
        watched.err
    );
    assert_eq!(watched.out.lines().count(), 12);
    let rows = std::fs::read_to_string(&csv).expect("a file");
    assert_eq!(rows.lines().count(), 13, "{rows}");
    assert!(
        rows.starts_with("time,object,name,value\n")
            && rows.contains(",6000h,Operating parameters,4\n"),
        "{rows}"
    );
    let lines = done(
        &[
            &["watch", "5", "6000h", "--count", "2", "--format", "json"],
            &at[..],
        ]
        .concat(),
    );
    let value: Value = serde_json::from_str(lines.lines().next().expect("a line")).expect("JSON");
    assert_eq!(value["value"], 4);
}

/// Ctrl-C ends a command that runs without an end, with exit code 0.
#[test]
fn ctrl_c_ends_endless_commands_without_an_error() {
    let mut sim = Sim::start(&["gxmm", "--node-id", "5"]);
    let link = link(&sim);
    done(&["set", "5", "1017h=20", "--link", &link]);
    let mut monitor = command();
    monitor
        .args(["monitor", "--plain", "--link", &link])
        .stdout(Stdio::piped());
    let mut monitor = monitor.spawn().expect("odkit starts");
    let mut byte = [0];
    monitor
        .stdout
        .as_mut()
        .expect("a pipe")
        .read_exact(&mut byte)
        .expect("a frame");
    let pid = monitor.id().to_string();
    std::process::Command::new("kill")
        .args(["-INT", &pid])
        .status()
        .expect("kill");
    assert_eq!(monitor.wait().expect("it ends").code(), Some(0));
    // A lost bus is an error.
    let mut monitor = command();
    monitor.args(["monitor", "--plain", "--link", &link]);
    let mut monitor = monitor
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("odkit starts");
    monitor
        .stdout
        .as_mut()
        .expect("a pipe")
        .read_exact(&mut byte)
        .expect("a frame");
    sim.end("-TERM");
    let output = monitor.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("closed the connection"), "{said}");
}

#[test]
fn the_console_works_on_a_terminal() {
    let sim = Sim::start(&["gxmm", "--node-id", "5"]);
    let link = link(&sim);
    done(&["set", "5", "1017h=20", "--link", &link]);
    let terminal = nix::pty::openpty(
        Some(&nix::pty::Winsize {
            ws_row: 24,
            ws_col: 80,
            ws_xpixel: 0,
            ws_ypixel: 0,
        }),
        None,
    );
    let terminal = terminal.expect("a terminal");
    let end = || Stdio::from(terminal.slave.try_clone().expect("a terminal"));
    let mut monitor = command();
    monitor
        .args(["monitor", "--link", &link])
        .stdin(end())
        .stdout(end())
        .stderr(end());
    let mut monitor = monitor.spawn().expect("odkit starts");
    let mut keys = std::fs::File::from(terminal.master.try_clone().expect("a terminal"));
    let mut screen = std::fs::File::from(terminal.master);
    let (send, shown) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let mut bytes = [0; 4096];
        while let Ok(len) = screen.read(&mut bytes) {
            if send
                .send(String::from_utf8_lossy(&bytes[..len]).into_owned())
                .is_err()
            {
                break;
            }
        }
    });
    let mut seen = String::new();
    let mut sees = |text: &str| {
        until(text, || {
            seen.extend(shown.try_iter());
            seen.contains(text).then(|| seen.clear())
        });
    };
    sees("NMT EC node 5: Pre-operational");
    keys.write_all(b"\t").expect("keys");
    sees("COB-ID");
    keys.write_all(b"/sdo\r").expect("keys");
    sees("filter: sdo");
    keys.write_all(b"q").expect("keys");
    assert_eq!(monitor.wait().expect("it ends").code(), Some(0));
    // The terminal has its earlier mode.
    sees("\u{1b}[?1049l");
}

#[test]
fn a_log_without_times_is_shown_with_a_note() {
    let text = "  can0  603   [8]  40 18 10 01 00 00 00 00\n  can0  703   [1]  05\n";
    let log = file("untimed.log", text).display().to_string();
    let run = odkit(&["decode", &log], "");
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out.contains("heartbeat") || run.out.contains("Operational"),
        "{}",
        run.out
    );
    assert!(
        run.err.contains("the log has no times; `candump -ta`"),
        "{}",
        run.err
    );
}
