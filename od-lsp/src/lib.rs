//! The language server behind `odkit lsp`: messages of the Language Server Protocol 3.17 in, messages out.
//!
//! Sans-io: it reads no file, no pipe and no clock. A message is the JSON text between two headers;
//! files of the disk and a project's settings come from a [`Host`].
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
mod server;
mod standard;
mod text;
mod types;
mod uri;
mod words;

pub use host::{Host, NoHost};
pub use server::Server;
