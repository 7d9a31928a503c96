//! The page's server: `playground/web/serve.mjs`.

use std::io::{BufRead, BufReader, Read};
use std::net::{Ipv4Addr, TcpListener};
use std::process::{Child, Command, Stdio};

use crate::error::{Error, Result};
use crate::repo::Repo;

/// A server that answers; it ends with this value, or with this program.
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
        // The pipe to its standard input breaks when this program ends, however it does.
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
        // Waiting would close its standard input, and that ends it.
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

/// Is the port free? Known before a build that takes minutes, not after it.
pub(crate) fn check(port: u16) -> Result<()> {
    TcpListener::bind((Ipv4Addr::LOCALHOST, port))
        .map(drop)
        .map_err(|e| Error::Failed(format!("cannot serve on 127.0.0.1:{port}: {e}")))
}
