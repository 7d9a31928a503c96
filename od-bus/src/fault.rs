//! Errors between a program and a bus.

use std::fmt;

/// Reason why a link or a node did not do its work. The text names the place, the error and the correction.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Fault {
    /// The request is not possible: an unknown kind of link, an invalid address.
    Usage(String),
    /// The link cannot be opened, or is lost.
    Link(String),
    /// A node is silent, or says what no node should.
    Node(String),
    /// The user stopped the program (Ctrl-C).
    Interrupted,
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Usage(text) | Self::Link(text) | Self::Node(text) => f.write_str(text),
            Self::Interrupted => f.write_str("stopped by Ctrl-C"),
        }
    }
}

impl std::error::Error for Fault {}
