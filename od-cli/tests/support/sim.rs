//! `odkit sim` that clients connect to.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::time::Duration;

use super::command;

/// `odkit sim` on an slcan port of its own; it ends with this value.
pub(crate) struct Sim {
    pub(crate) child: Child,
    /// Its greeting.
    pub(crate) greeting: String,
    pub(crate) port: u16,
}

impl Sim {
    pub(crate) fn start(args: &[&str]) -> Self {
        let mut child = command()
            .arg("sim")
            .args(args)
            .args(["--slcan", "127.0.0.1:0"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
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
        let after = greeting.split("127.0.0.1:").nth(1).expect("an address");
        let digits: String = after.chars().take_while(char::is_ascii_digit).collect();
        let port = digits.parse().expect("a port");
        Self {
            child,
            greeting,
            port,
        }
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

/// Sends, and expects this answer.
#[track_caller]
pub(crate) fn say(client: &mut TcpStream, sent: &str, expected: &str) {
    client.write_all(sent.as_bytes()).expect("it reads");
    let mut answer = vec![0; expected.len()];
    client.read_exact(&mut answer).expect("an answer");
    assert_eq!(String::from_utf8_lossy(&answer), expected, "{sent:?}");
}
