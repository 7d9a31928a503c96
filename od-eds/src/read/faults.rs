//! Findings about lines that are not plain INI.

use crate::log::Log;
use crate::rules;
use crate::rules::text::{
    e0118_merge_conflict, w0101_unknown_line, w0102_no_key, w0103_no_closing_bracket,
    w0104_text_after_header, w0105_key_before_section, w0108_colon, w0110_header_without_name,
};
use crate::scan::lines::Fault;

/// Reports a fault.
pub(crate) fn report(fault: &Fault<'_>, log: &mut Log) {
    match *fault {
        Fault::Conflict(line) => log.add(&rules::E0118, || e0118_merge_conflict::finding(line)),
        Fault::NoPair(line) => log.add(&rules::W0101, || w0101_unknown_line::finding(line)),
        Fault::NoSign { at, key, value } => {
            log.add(&rules::W0101, || {
                w0101_unknown_line::no_sign(at, key, value)
            });
        }
        Fault::NoKey(line) => log.add(&rules::W0102, || w0102_no_key::finding(line)),
        Fault::Open { line, name } => log.add(&rules::W0103, || {
            w0103_no_closing_bracket::finding(line, name)
        }),
        Fault::Behind { name, text } => log.add(&rules::W0104, || {
            w0104_text_after_header::finding(name, text)
        }),
        Fault::NoName(line) => log.add(&rules::W0110, || w0110_header_without_name::finding(line)),
        Fault::NoSection { line, key } => log.push(w0105_key_before_section::finding(line, key)),
        Fault::Colon { at, key, value } => {
            log.add(&rules::W0108, || w0108_colon::finding(at, key, value));
        }
    }
}
