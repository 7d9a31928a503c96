//! Tools that read device files: the content that each rejects, drops or reads differently from the standard.
//!
//! A tool reads text, not odkit's description of it. Each therefore has a reader of its own here, which reads the
//! lines as the tool does; its result is compared with the description.
//!
//! ```
//! use od_eds::{Document, tools};
//!
//! let file = Document::new(b"[2000]\nParameterName=a\nDataType=0x5\nAccessType=rw\nDefaultValue=010\n");
//! let tool = tools::tool("python-canopen").unwrap();
//! let findings = tools::check(&file, &file.parse().description, &[tool]);
//! assert_eq!(findings[0].code(), "T0112");
//! assert_eq!(tools::verdict(&findings), tools::Verdict::Differs);
//! ```

mod canopen_rs;
mod canopennode_editor;
mod check;
mod codesys;
mod compare;
mod configparser;
mod dcf_tools;
pub(crate) mod list;
mod npm_canopen;
mod python;
mod python_canopen;
mod shared;
mod tool;
mod twincat;

pub use check::{Verdict, check, reading, verdict};
pub use list::{TOOLS, rules, tool, tool_of};
pub use tool::{Read, ReadEntry, Reading, Tool};

#[cfg(test)]
mod tests;
