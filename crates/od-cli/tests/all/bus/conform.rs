//! `odkit conform` and `odkit learn` on a bus in real time: power, Ctrl-C, a lost link, a twin.

use std::io::{BufRead, BufReader};
#[cfg(unix)]
#[cfg(unix)]
use std::process::{Child, Command, Stdio};

use super::{done, fails};
#[cfg(unix)]
use crate::support::sim::Sim;
#[cfg(unix)]
use crate::support::{command, file, fresh};

/// A test over slcan that is disturbed while it runs: standard output and error, and the exit code.
#[cfg(unix)]
struct Run {
    child: Child,
    report: String,
}

#[cfg(unix)]
impl Run {
    /// Starts all cases, and waits until some are done.
    fn begin(sim: &Sim, name: &str) -> Self {
        let report = file(name, "").display().to_string();
        let link = format!("slcan:127.0.0.1:{}", sim.port);
        let mut child = command()
            .args([
                "conform", "--link", &link, "--eds", "gxmm", "--report", &report,
            ])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("odkit starts");
        let mut errors = BufReader::new(child.stderr.as_mut().expect("a pipe")).lines();
        let is_first = |line: &str| line.contains(" cases, about ");
        let first = errors.next().expect("a line").expect("UTF-8");
        assert!(is_first(&first), "{first}");
        let mut lines = errors.map_while(Result::ok);
        assert!(lines.any(|line| line.contains("[9/")));
        Self { child, report }
    }

    /// It ends with exit code 1, and this text is in the output and in the report.
    #[track_caller]
    fn ends(mut self, why: &str) {
        // It would not wait for a reader of its output.
        let mut errors = self.child.stderr.take().expect("a pipe");
        let reader = std::thread::spawn(move || std::io::copy(&mut errors, &mut std::io::sink()));
        let output = self.child.wait_with_output().expect("odkit ends");
        reader.join().expect("a reader").expect("a pipe");
        let text = String::from_utf8_lossy(&output.stdout);
        assert_eq!(output.status.code(), Some(1), "{text}");
        assert!(
            text.contains(&format!("the run ended early: {why}")),
            "{text}"
        );
        let report = std::fs::read_to_string(&self.report).expect("a report");
        assert!(report.contains(why), "{report}");
    }
}

#[cfg(unix)]
#[test]
fn a_lost_link_ends_in_a_report() {
    let mut sim = Sim::start(&["gxmm"]);
    let run = Run::begin(&sim, "lost.json");
    sim.child.kill().expect("a process");
    run.ends("the link is lost: ");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_in_a_report() {
    let sim = Sim::start(&["gxmm"]);
    let run = Run::begin(&sim, "stopped.html");
    let process = run.child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &process]).status();
    assert!(kill.expect("kill").success());
    run.ends("stopped by Ctrl-C");
}

#[cfg(unix)]
#[test]
fn a_command_switches_the_power() {
    let socket = fresh("power.sock");
    let place = format!("unix:{}", socket.display());
    let sim = Sim::start(&["gxmm", "--control", &place]);
    let link = format!("slcan:127.0.0.1:{}", sim.port);
    let odkit = command().get_program().to_string_lossy().into_owned();
    let power = format!("f() {{ '{odkit}' ctl '{place}' \"power $1\"; }}; f");
    let args = [
        "conform",
        "--link",
        &link,
        "--eds",
        "gxmm",
        "--only",
        "nmt-power-on",
    ];
    let text = done(&[&args[..], &["--power", &power]].concat());
    assert!(text.contains("  pass     nmt-power-on"), "{text}");
    assert!(done(&args).contains("the case needs --power COMMAND"));
}

#[test]
fn other_commands_accept_the_eds_of_a_twin() {
    let path = file("twin.eds", "").display().to_string();
    let args = ["learn", "1", "--link", "bench:gxmm", "-o", &path];
    done(&[&args[..], &["--twin", "--allow-reset", "--seconds", "1"]].concat());
    let text = std::fs::read_to_string(&path).expect("an EDS");
    assert!(text.contains(";odkit-twin=1\n;twin length 1s\n"), "{text}");
    assert!(text.contains("\n;twin boot-up "), "{text}");
    done(&["check", &path]);
    let report = done(&[
        "conform",
        &path,
        "--only",
        "sdo-upload*",
        "--only",
        "nmt-boot*",
    ]);
    assert!(report.contains(" 0 failed"), "{report}");
    let wrong = text.replace(";twin answer", ";twin reply");
    let line = 1 + text
        .lines()
        .take_while(|line| !line.starts_with(";twin answer"))
        .count();
    let path = file("twin-wrong.eds", &wrong).display().to_string();
    let told = fails(1, &["conform", &path, "--only", "eds-*"]);
    let expected = format!("twin-wrong.eds, line {line}: `reply` is not valid");
    assert!(told.contains(&expected), "{told}");
    // The options of a recording are refused if nothing is recorded.
    fails(2, &[&args[..], &["--seconds", "1"]].concat());
    fails(2, &[&args[..], &["--allow-reset"]].concat());
}
