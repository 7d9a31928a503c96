//! dcf-tools, the package of Lely: `dcflint` and `dcfgen`.
//!
//! It checks a file before reading it: unknown keys and sections are errors, and so are values outside the range of
//! their type. A node ID is given, as in `dcflint -n 1 device.eds`.

use crate::span::Span;
use crate::tools::configparser::{Dialect, Ini};
use crate::tools::shared::faults;
use crate::tools::tool::{Input, Reading, Tool};

mod check;
mod compact_pdo;
mod device;
mod lint;
mod rules;
mod values;

pub(crate) static TOOL: Tool = Tool {
    name: "dcf-tools",
    version: "2.4.2",
    source: rules::SOURCE,
    tried: true,
    rules: &[
        &rules::NOT_TEXT,
        &rules::NO_PAIR,
        &rules::DOUBLE,
        &rules::UNKNOWN,
        &rules::MISSING,
        &rules::NUMBER,
        &rules::LIST,
        &rules::MEMBERS,
        &rules::RANGE,
        &rules::REFERENCE,
        &rules::DIFFERENCES.drops,
        &rules::DIFFERENCES.value,
        &rules::DIFFERENCES.limit,
        &rules::DIFFERENCES.field,
    ],
    read,
    value: Some(|_, text, data_type| values::value(text, data_type)),
    differences: Some(&rules::DIFFERENCES),
};

const DIALECT: Dialect = Dialect {
    inline: &['#', ';'],
    folds: true,
};

fn read(input: &Input<'_>) -> Reading {
    let mut reading = Reading::default();
    let Some(text) = input.text else {
        reading.push(rules::NOT_TEXT.at(Span::default()));
        return reading;
    };
    if input.has_mark {
        reading.push(
            rules::NOT_TEXT
                .at(Span::default())
                .form(&rules::NOT_TEXT.also[0]),
        );
    }
    let mut ini = Ini::read(text, &DIALECT);
    faults(&mut reading, &ini, &rules::NO_PAIR, &rules::DOUBLE);
    compact_pdo::add_compact_pdos(&mut ini, &mut reading);
    let mut reading = lint::lint(&ini, reading);
    device::read(&ini, &mut reading);
    reading
}
