//! The page's server: `playground/web/serve.mjs`.

use std::io::{BufRead, BufReader, Read};
use std::net::{Ipv4Addr, TcpListener};
use std::process::{Child, Command, Stdio};

use crate::error::{Error, Result};
use crate::repo::Repo;

/// A running server; it ends when this value is dropped or this program ends.
#[derive(Debug)]
pub(crate) struct Server {
    child: Child,
    /// The address of the page.
    pub(crate) url: String,
}

impl Server {
    /// Serves the bundled page on a port of 127.0.0.1, or on the first free one from 8080 on.
    pub(crate) fn start(repo: &Repo, port: Option<u16>) -> Result<Server> {
        let mut command = Command::new("node");
        command.arg("serve.mjs").current_dir(repo.web());
        command.args(port.map(|port| port.to_string()));
        // Its standard input is a pipe that closes when this program ends for any reason.
        command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| Error::Missing(format!("cannot start `node serve.mjs`: {e}")))?;
        let mut url = String::new();
        if let Some(out) = child.stdout.take() {
            let _ = BufReader::new(out).read_line(&mut url);
        }
        let mut server = Server {
            child,
            url: String::from(url.trim()),
        };
        if server.url.is_empty() {
            let mut why = String::new();
            if let Some(err) = &mut server.child.stderr {
                let _ = err.read_to_string(&mut why);
            }
            return Err(Error::Failed(format!("cannot serve: {}", why.trim())));
        }
        Ok(server)
    }

    /// Serves until Ctrl+C.
    pub(crate) fn wait(mut self) {
        // `wait` would close its standard input, which ends the server.
        let input = self.child.stdin.take();
        let _ = self.child.wait();
        drop(input);
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Returns whether the port is free. It is checked before the build, which takes minutes.
pub(crate) fn check(port: u16) -> Result<()> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .map(drop)
        .map_err(|e| Error::Failed(format!("cannot serve on 127.0.0.1:{port}: {e}")))
}
