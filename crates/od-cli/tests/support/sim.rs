//! `odkit sim` that clients connect to.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, ChildStderr, Command, Stdio};
use std::time::Duration;

use tempfile::TempDir;

#[cfg(unix)]
use super::quiet::until;
use super::{command, temporary};

/// `odkit sim` on an slcan port of its own; it ends when this is dropped.
pub(crate) struct Sim {
    pub(crate) child: Child,
    /// Its greeting.
    pub(crate) greeting: String,
    pub(crate) port: u16,
    /// Its standard error, unless it is not captured.
    errors: Option<BufReader<ChildStderr>>,
    /// The folder of the file by which other programs find it. A bench that is killed cannot remove that file.
    _reports: TempDir,
}

impl Sim {
    pub(crate) fn start(args: &[&str]) -> Self {
        Self::spawn(command(), args, Stdio::null())
    }

    /// A bench whose messages a test [waits for](Self::told).
    pub(crate) fn start_heard(args: &[&str]) -> Self {
        Self::spawn(command(), args, Stdio::piped())
    }

    /// A bench that `sh` starts with this script, as `"$@"`.
    #[cfg(unix)]
    pub(crate) fn start_under(script: &str, args: &[&str]) -> Self {
        let mut shell = Command::new("sh");
        shell
            .args(["-c", script, "sh"])
            .arg(command().get_program());
        Self::spawn(shell, args, Stdio::piped())
    }

    fn spawn(mut command: Command, args: &[&str], errors: Stdio) -> Self {
        let reports = temporary();
        let mut child = command
            .env("XDG_RUNTIME_DIR", reports.path())
            .arg("sim")
            .args(args)
            .args(["--slcan", "127.0.0.1:0"])
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(errors)
            .spawn()
            .expect("odkit starts");
        let mut lines = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut greeting = String::new();
        while !greeting.contains("Ctrl-C") {
            assert_ne!(
                lines.read_line(&mut greeting).expect("a greeting"),
                0,
                "{greeting}"
            );
        }
        let errors = child.stderr.take().map(BufReader::new);
        let mut sim = Self {
            child,
            greeting,
            port: 0,
            errors,
            _reports: reports,
        };
        sim.port = sim.port_of("slcan on 127.0.0.1:");
        sim
    }

    /// The port that follows this text in the greeting.
    #[track_caller]
    pub(crate) fn port_of(&self, text: &str) -> u16 {
        let after = self.greeting.split(text).nth(1).expect("an address");
        let digits: String = after.chars().take_while(char::is_ascii_digit).collect();
        digits.parse().expect("a port")
    }

    /// Waits for a message with this text, and returns its line.
    #[track_caller]
    pub(crate) fn told(&mut self, text: &str) -> String {
        let errors = self.errors.as_mut().expect("one that is heard");
        let mut seen = String::new();
        loop {
            let mut line = String::new();
            let len = errors.read_line(&mut line).expect("standard error");
            assert_ne!(len, 0, "`{text}` is not in {seen}");
            if line.contains(text) {
                return line;
            }
            seen.push_str(&line);
        }
    }

    /// Stops it. On a busy computer a process stops some time after the signal.
    #[cfg(unix)]
    pub(crate) fn suspend(&self) {
        self.signal("-STOP");
        let process = self.child.id().to_string();
        until("a stopped process", || {
            let mut ps = Command::new("ps");
            ps.args(["-o", "stat=", "-p", &process]);
            let state = ps.output().expect("ps").stdout;
            state.starts_with(b"T").then_some(())
        });
    }

    /// Sends it a signal.
    #[cfg(unix)]
    pub(crate) fn signal(&self, name: &str) {
        let process = self.child.id().to_string();
        let kill = Command::new("kill").args([name, &process]).status();
        assert!(kill.expect("kill").success());
    }

    pub(crate) fn client(&self) -> TcpStream {
        let client = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        client
            .set_read_timeout(Some(Duration::from_secs(10)))
            .expect("a time limit");
        client
    }
}

impl Drop for Sim {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Sends a line, and expects this answer.
#[track_caller]
pub(crate) fn say(client: &mut TcpStream, sent: &str, expected: &str) {
    client.write_all(sent.as_bytes()).expect("it reads");
    let mut answer = vec![0; expected.len()];
    client.read_exact(&mut answer).expect("an answer");
    assert_eq!(String::from_utf8_lossy(&answer), expected, "{sent:?}");
}
