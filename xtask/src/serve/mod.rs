//! A file server for one page on one machine: HTTP/1.1, GET and HEAD, 127.0.0.1 only.

mod files;
mod http;

use std::net::{Ipv4Addr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Duration;

use crate::error::{Error, Result};

/// The first port that is tried if none is asked for, and how many after it.
const PORTS: std::ops::Range<u16> = 8080..8180;

/// More connections at a time than a browser and a few test runs ever open.
const CONNECTIONS: usize = 256;

/// A server that is bound to its port, and so known to be reachable.
#[derive(Debug)]
pub(crate) struct Server {
    root: PathBuf,
    listener: TcpListener,
    port: u16,
}

impl Server {
    /// Binds to `port`, or to the first free one from 8080 on.
    pub(crate) fn bind(root: PathBuf, port: Option<u16>) -> Result<Server> {
        let bind = |port| TcpListener::bind((Ipv4Addr::LOCALHOST, port));
        let listener = match port {
            Some(port) => bind(port)
                .map_err(|e| Error::Failed(format!("cannot serve on 127.0.0.1:{port}: {e}")))?,
            None => PORTS
                .into_iter()
                .find_map(|port| bind(port).ok())
                .ok_or_else(|| Error::Failed(format!("no free port in {PORTS:?}")))?,
        };
        let port = listener
            .local_addr()
            .map_err(|e| Error::Failed(format!("cannot serve: {e}")))?
            .port();
        Ok(Server {
            root,
            listener,
            port,
        })
    }

    /// The address of the page.
    pub(crate) fn url(&self) -> String {
        format!("http://127.0.0.1:{}/", self.port)
    }

    /// Serves until the program ends.
    pub(crate) fn run(self) {
        let root: Arc<PathBuf> = Arc::new(self.root);
        let open = Arc::new(AtomicUsize::new(0));
        for stream in self.listener.incoming() {
            let Ok(stream) = stream else {
                // Out of file handles, most likely: let the open ones end.
                thread::sleep(Duration::from_millis(50));
                continue;
            };
            if open.fetch_add(1, Ordering::AcqRel) >= CONNECTIONS {
                open.fetch_sub(1, Ordering::AcqRel);
                http::refuse(stream);
                continue;
            }
            let (root, counter) = (Arc::clone(&root), Arc::clone(&open));
            let thread = thread::Builder::new().spawn(move || {
                http::answer(stream, &root);
                counter.fetch_sub(1, Ordering::AcqRel);
            });
            if thread.is_err() {
                open.fetch_sub(1, Ordering::AcqRel);
            }
        }
    }

    /// Serves in the background; the address of the page.
    pub(crate) fn spawn(self) -> String {
        let url = self.url();
        thread::spawn(move || self.run());
        url
    }
}
