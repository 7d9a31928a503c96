//! A quiet `odkit sim`, for tests of runs in the background.

use std::io::{BufRead, BufReader, Read};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;
use tempfile::TempDir;

use super::{Done, command, odkit, temporary};

/// A quiet `odkit sim` on an slcan port of its own; it ends when this is dropped.
pub(crate) struct Sim {
    pub(crate) child: Child,
    /// Its line on standard output.
    pub(crate) ready: Value,
    /// The folder of the file by which other programs find it. A bench that is killed cannot remove that file.
    _reports: TempDir,
}

impl Sim {
    pub(crate) fn start(args: &[&str]) -> Self {
        Self::run(&[&["sim", "--slcan", "127.0.0.1:0"], args].concat())
    }

    /// Any subcommand that runs a live bench.
    pub(crate) fn run(args: &[&str]) -> Self {
        let reports = temporary();
        let mut child = command()
            .args(args)
            .env("XDG_RUNTIME_DIR", reports.path())
            .args(["--quiet", "--ready-file", "-"])
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("odkit starts");
        let mut line = String::new();
        let mut out = BufReader::new(child.stdout.take().expect("a pipe"));
        out.read_line(&mut line).expect("a line");
        let ready = serde_json::from_str(&line).unwrap_or_else(|why| panic!("{line:?}: {why}"));
        Self {
            child,
            ready,
            _reports: reports,
        }
    }

    pub(crate) fn client(&self) -> TcpStream {
        let address = self.ready["links"][0]["address"].as_str().expect("a port");
        let client = TcpStream::connect(address).expect("it listens");
        let patience = Some(Duration::from_secs(10));
        client.set_read_timeout(patience).expect("a time limit");
        client
    }

    pub(crate) fn control(&self) -> &str {
        self.ready["control"].as_str().expect("a control socket")
    }

    pub(crate) fn ctl(&self, lines: &[&str]) -> Done {
        odkit(&[&["ctl", self.control()], lines].concat(), "")
    }

    /// Ends it with a signal, and returns its standard error.
    pub(crate) fn end(&mut self, signal: &str) -> String {
        let pid = self.child.id().to_string();
        let kill = std::process::Command::new("kill")
            .args([signal, &pid])
            .status();
        assert!(kill.expect("kill").success());
        self.child.wait().expect("it ends");
        let mut said = String::new();
        let mut error = self.child.stderr.take().expect("a pipe");
        error.read_to_string(&mut said).expect("UTF-8");
        said
    }
}

impl Drop for Sim {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub(crate) fn unix(path: &Path) -> String {
    format!("unix:{}", path.display())
}

/// Waits until the closure returns a value.
#[track_caller]
pub(crate) fn until<T>(what: &str, mut look: impl FnMut() -> Option<T>) -> T {
    let start = Instant::now();
    loop {
        if let Some(found) = look() {
            return found;
        }
        assert!(start.elapsed() < Duration::from_secs(20), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}
