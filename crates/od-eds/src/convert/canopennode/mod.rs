//! A description as the object dictionary of CANopenNode, version 4: `OD.c` and `OD.h`.
//!
//! The files have the form of CANopenEditor, so the sources of a device need no
//! change: names of variables, storage groups, counters and shortcuts are the same.

mod data;
mod fits;
mod header;
mod names;
mod node_id;
mod plan;
mod source;

use alloc::string::String;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::Finding;

/// The two files, and the content that they lack.
#[derive(Clone, PartialEq, Debug)]
pub struct Files {
    /// The text of `OD.c`.
    pub source: String,
    /// The text of `OD.h`.
    pub header: String,
    /// Findings about content that CANopenNode cannot express; one with severity "info" makes no difference to a master.
    pub findings: Vec<Finding>,
}

/// Returns the texts of `STEM.c` and `STEM.h`. `file` is named in the header.
///
/// CANopenNode itself adds the node ID to the COB-IDs of the pre-defined connection set. Other
/// values that depend on it are computed for `node`, or are findings.
pub fn write(description: &Description, stem: &str, file: &str, node: Option<u8>) -> Files {
    let objects = plan::plan(description, node);
    let name = names::dictionary(stem);
    Files {
        source: source::write(&objects, &name, stem),
        header: header::write(description, &objects, &name, (stem, file)),
        findings: fits::findings(description, &objects, node),
    }
}
