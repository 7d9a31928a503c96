//! The language server of `odkit lsp`. It takes and returns messages of the Language Server Protocol 3.17.
//!
//! It is sans-io: it uses no file, no pipe and no clock. A message is the JSON text between two headers;
//! a [`Host`] provides the files of the disk and the settings of a project.
//!
//! ```
//! use od_lsp::{NoHost, Server};
//!
//! let mut server = Server::new(Box::new(NoHost));
//! server.receive(r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}"#);
//! while server.step() {}
//! assert!(server.poll().unwrap().contains("\"capabilities\""));
//! ```
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod cob_ids;
mod features;
mod file;
mod host;
mod keys;
mod layout;
mod macros;
mod mentions;
mod message;
mod project;
mod server;
mod standard;
mod text;
mod types;
mod uri;
mod words;
mod xdd;

pub use host::{Finder, Host, NoHost};
pub use server::Server;
