//! Findings about lines that are not plain INI.

use crate::log::Log;
use crate::rules;
use crate::rules::text::{e0118, w0101, w0102, w0103, w0104, w0105, w0108, w0110};
use crate::scan::lines::Fault;

/// Reports a fault.
pub(crate) fn report(fault: &Fault<'_>, log: &mut Log) {
    match *fault {
        Fault::Conflict(line) => log.add(&rules::E0118, || e0118::finding(line)),
        Fault::NoPair(line) => log.add(&rules::W0101, || w0101::finding(line)),
        Fault::NoSign { at, key, value } => {
            log.add(&rules::W0101, || w0101::no_sign(at, key, value));
        }
        Fault::NoKey(line) => log.add(&rules::W0102, || w0102::finding(line)),
        Fault::Open { line, name } => log.add(&rules::W0103, || w0103::finding(line, name)),
        Fault::Behind { name, text } => log.add(&rules::W0104, || w0104::finding(name, text)),
        Fault::NoName(line) => log.add(&rules::W0110, || w0110::finding(line)),
        Fault::NoSection { line, key } => log.push(w0105::finding(line, key)),
        Fault::Colon { at, key, value } => {
            log.add(&rules::W0108, || w0108::finding(at, key, value));
        }
    }
}
