//! Findings about lines that are not plain INI.

use crate::finding::Finding;
use crate::rules::text::{w0101, w0102, w0103, w0104, w0105, w0108, w0110};
use crate::scan::lines::Fault;

/// The finding of a fault.
pub(crate) fn finding(fault: &Fault<'_>) -> Finding {
    match *fault {
        Fault::NoPair(line) => w0101::finding(line),
        Fault::NoKey(line) => w0102::finding(line),
        Fault::Open { line, name } => w0103::finding(line, name),
        Fault::Behind { name, text } => w0104::finding(name, text),
        Fault::NoName(line) => w0110::finding(line),
        Fault::NoSection { line, key } => w0105::finding(line, key),
        Fault::Colon { at, key, value } => w0108::finding(at, key, value),
    }
}
