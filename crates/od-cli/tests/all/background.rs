//! `odkit sim` in the background: its log, its ready file, and its output.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Stdio;

use crate::support::quiet::{Sim, until};
use crate::support::sim::say;
use crate::support::{command, odkit, temporary};
use od_sim::logs;
use serde_json::Value;

/// The readable frames of a log, with their time of day.
fn logged(path: &Path) -> Vec<String> {
    let bytes = fs::read(path).unwrap_or_default();
    let Ok(log) = logs::read(&bytes) else {
        return Vec::new();
    };
    let frames = log.records.iter().filter_map(|record| match record.what {
        logs::What::Frame(frame) => Some(frame.to_string()),
        logs::What::Error(_) => None,
    });
    frames.collect()
}

#[test]
fn a_log_outlives_a_kill() {
    let folder = temporary();
    for name in ["frames.log", "frames.pcapng"] {
        let log = folder.path().join(name);
        let mut sim = Sim::start(&["gxmm", "--log", &log.display().to_string()]);
        let mut client = sim.client();
        let answer = "\rz\rt58184300100096010200\r";
        say(&mut client, "O\rt60184000100000000000\r", answer);
        let frames = until("a log", || {
            Some(logged(&log)).filter(|frames| frames.len() >= 3)
        });
        assert_eq!(
            frames,
            ["701#00", "601#4000100000000000", "581#4300100096010200"],
            "{name}"
        );
        sim.end("-KILL");
        assert_eq!(logged(&log), frames, "{name}");
    }
    // Seconds since 1970.
    let log = folder.path().join("times");
    let _sim = Sim::start(&["gxmm", "--log", &log.display().to_string()]);
    let text = until("a log", || {
        fs::read_to_string(&log)
            .ok()
            .filter(|text| !text.is_empty())
    });
    assert!(
        text.starts_with("(1") && text.find('.') == Some(11),
        "{text}"
    );
}

#[test]
fn a_log_that_cannot_be_written_does_not_stop_the_bus() {
    if cfg!(target_os = "linux") {
        let mut sim = Sim::start(&["gxmm", "--log", "/dev/full"]);
        let mut client = sim.client();
        for round in 0..2 {
            let (open, answer) = [("O\r", "\r"), ("", "")][round];
            let sent = format!("{open}t60184000100000000000\r");
            say(
                &mut client,
                &sent,
                &format!("{answer}z\rt58184300100096010200\r"),
            );
        }
        let said = sim.end("-TERM");
        assert_eq!(said.lines().count(), 1, "{said}");
        assert!(
            said.contains("the log ends here, the bus continues"),
            "{said}"
        );
    }
    for (log, code, why) in [
        ("/nowhere/x.log", 1, "--log /nowhere/x.log"),
        (
            "x.asc",
            2,
            "write a name that ends in .log (candump) or .pcapng",
        ),
    ] {
        let done = odkit(&["sim", "gxmm", "--slcan", "127.0.0.1:0", "--log", log], "");
        assert_eq!(done.code, code, "{}", done.err);
        assert!(done.err.contains(why), "{}", done.err);
    }
}

#[test]
fn a_ready_file_exists_while_all_links_listen() {
    let folder = temporary();
    let ready = folder.path().join("ready");
    // A killed bench left this file.
    let old = r#"{"version":1,"pid":1,"links":[],"nodes":[],"control":null}"#;
    fs::write(&ready, old).expect("a file");
    let args = [
        "gxmm",
        "--slcan",
        "127.0.0.1:0",
        "--link",
        "slcan:pty",
        "--quiet",
    ];
    let mut child = command()
        .arg("sim")
        .args(args)
        .arg("--ready-file")
        .arg(&ready)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("odkit starts");
    let text = until("a ready file", || {
        let text = fs::read_to_string(&ready).ok()?;
        (text != old).then_some(text)
    });
    let report: Value = serde_json::from_str(&text).expect("JSON, whole");
    assert_eq!(report["pid"], child.id());
    assert_eq!(report["control"], Value::Null);
    assert!(report["started"].is_u64());
    let mode = fs::metadata(&ready).expect("a file").permissions().mode();
    assert_eq!(mode & 0o777, 0o600);
    let address = report["links"][0]["address"].as_str().expect("a port");
    let mut client = TcpStream::connect(address).expect("it listens");
    say(&mut client, "O\r", "\r");
    let terminal = report["links"][1]["path"].as_str().expect("a path");
    assert!(Path::new(terminal).exists(), "{terminal}");
    let pid = child.id().to_string();
    let kill = std::process::Command::new("kill")
        .args(["-TERM", &pid])
        .status();
    assert!(kill.expect("kill").success());
    assert!(child.wait().expect("it ends").success());
    assert!(!ready.exists());
    // It printed nothing.
    let mut said = String::new();
    let mut out = child.stdout.take().expect("a pipe");
    out.read_to_string(&mut said).expect("UTF-8");
    let mut error = child.stderr.take().expect("a pipe");
    error.read_to_string(&mut said).expect("UTF-8");
    assert_eq!(said, "");
}

#[test]
fn a_token_is_in_no_file() {
    let (folder, ready) = (temporary(), temporary());
    let (folder, ready) = (folder.path(), ready.path().join("ready"));
    // A killed bench, whose process ID another process has now.
    let user = nix::unistd::Uid::effective();
    let stale = folder.join(format!("odkit-sim-{user}-{}.json", std::process::id()));
    let own = std::process::id();
    let link = r#"[{"link":"slcan","address":"127.0.0.1:1"}]"#;
    let text = format!("{{\"version\":1,\"pid\":{own},\"started\":1,\"links\":{link}}}");
    fs::write(&stale, text).expect("a file");
    let args = [
        "--link",
        "ws:127.0.0.1:0?token=0123456789abcdef",
        "--slcan",
        "127.0.0.1:0",
    ];
    let mut child = command()
        .args(["sim", "gxmm", "--quiet", "--ready-file"])
        .arg(&ready)
        .args(args)
        .env("XDG_RUNTIME_DIR", folder)
        .spawn()
        .expect("odkit starts");
    until("a ready file", || fs::metadata(&ready).ok());
    let name = format!("odkit-sim-{user}-{}.json", child.id());
    for path in [&ready, &folder.join(name)] {
        let text = fs::read_to_string(path).expect("a file");
        assert!(text.contains("ws://") && !text.contains("token"), "{text}");
        let mode = fs::metadata(path).expect("a file").permissions().mode();
        assert_eq!(mode & 0o777, 0o600);
    }
    let get = ["get", "1", "1000h"];
    let done = command()
        .args(get)
        .env("XDG_RUNTIME_DIR", folder)
        .output()
        .expect("it ends");
    let _ = child.kill();
    let _ = child.wait();
    // The only bench that runs is the default.
    let said = String::from_utf8_lossy(&done.stderr);
    assert!(done.status.success(), "{said}");
    assert!(!stale.exists());
}

#[test]
fn a_file_limit_ends_the_log_and_not_the_bench() {
    let folder = temporary();
    for name in ["limit.log", "limit.pcapng"] {
        let log = folder.path().join(name);
        let mut child = std::process::Command::new("sh");
        let mut child = child
            .args(["-c", "ulimit -f 8; exec \"$@\"", "sh"])
            .arg(command().get_program())
            .args([
                "sim",
                "gxmm",
                "--slcan",
                "127.0.0.1:0",
                "--quiet",
                "--ready-file",
                "-",
                "--log",
            ])
            .arg(&log)
            .env("XDG_RUNTIME_DIR", folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("odkit starts");
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().expect("a pipe"));
        out.read_line(&mut line).expect("a line");
        let ready: Value = serde_json::from_str(&line).expect("JSON");
        let address = ready["links"][0]["address"].as_str().expect("a port");
        let mut client = TcpStream::connect(address).expect("it listens");
        say(&mut client, "O\r", "\r");
        // Each request and its answer are some 80 bytes of a log.
        for _ in 0..300 {
            client
                .write_all(b"t60184000100000000000\r")
                .expect("it reads");
        }
        let mut said = String::new();
        let mut errors = BufReader::new(child.stderr.take().expect("a pipe"));
        errors.read_line(&mut said).expect("a message");
        assert!(
            said.contains("the log ends here, the bus continues"),
            "{said}"
        );
        let frames = logged(&log).len();
        assert!(
            frames > 50,
            "{frames} of {} bytes",
            fs::metadata(&log).expect("a log").len()
        );
        assert!(
            child.try_wait().expect("a state").is_none(),
            "the bench has ended"
        );
        TcpStream::connect(address).expect("it listens");
        let _ = child.kill();
        let _ = child.wait();
    }
}

#[test]
fn the_hint_is_printed_once_in_a_terminal() {
    let (folder, others) = (temporary(), temporary());
    let greeting = || {
        let pair = nix::pty::openpty(None, None).expect("a terminal");
        let mut child = command()
            .args(["sim", "gxmm", "--slcan", "127.0.0.1:0"])
            .env("XDG_RUNTIME_DIR", folder.path())
            .env("TMPDIR", others.path())
            .stdout(pair.slave)
            .stderr(Stdio::null())
            .spawn()
            .expect("odkit starts");
        let mut lines = BufReader::new(fs::File::from(pair.master));
        let mut greeting = String::new();
        while !greeting.contains("Ctrl-C") {
            let read = lines.read_line(&mut greeting).expect("a greeting");
            assert_ne!(read, 0, "{greeting}");
        }
        let _ = child.kill();
        let _ = child.wait();
        greeting
    };
    assert!(greeting().contains("python-canopen"));
    let second = greeting();
    assert!(
        second.contains("GXMM") && !second.contains("python-canopen"),
        "{second}"
    );
    // If it cannot be recorded that the hint was shown, it is printed again.
    fs::remove_dir_all(folder.path()).expect("it is there");
    assert!(greeting().contains("python-canopen"));
    assert!(greeting().contains("python-canopen"));
}
