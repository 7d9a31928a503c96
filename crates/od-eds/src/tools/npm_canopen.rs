//! The package `canopen` of npm, which reads with the package `ini`.
//!
//! It reads any text as INI, and rejects objects with unexpected keys. Its numbers are those of JavaScript.

use crate::fact::Key;
use crate::tools::tool::{Read, Tool};

mod ini;
mod javascript;
mod read;
mod rules;

pub(crate) static TOOL: Tool = Tool {
    name: "npm-canopen",
    version: "6.2.1",
    source: rules::SOURCE,
    tried: true,
    rules: &[
        &rules::MISSING,
        &rules::EXTRA,
        &rules::CODE,
        &rules::PARENT,
        &rules::TWICE,
        &rules::RANGE,
        &rules::LIMITS,
        &rules::DIFFERENCES.drops,
        &rules::DIFFERENCES.value,
        &rules::DIFFERENCES.limit,
        &rules::DIFFERENCES.field,
    ],
    read: read::read,
    value: Some(|key, text, data_type| match key {
        Key::LowLimit | Key::HighLimit => {
            javascript::parse_int(text).map(|it| Read::Number(it as i128))
        }
        _ => javascript::raw(&javascript::Given::Text(text.into()), data_type)
            .ok()
            .flatten(),
    }),
    differences: Some(&rules::DIFFERENCES),
};
