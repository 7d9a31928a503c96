//! python-canopen, the `canopen` package of PyPI.
//!
//! It reads with `configparser`, with case-sensitive keys and comments after ` ;`, and rejects a file at the first
//! unexpected content. A node ID is given, as in `network.add_node(1, "device.eds")`.

use crate::fact::Key;
use crate::tools::tool::Tool;

mod read;
mod rules;

pub(crate) static TOOL: Tool = Tool {
    name: "python-canopen",
    version: "2.4.1",
    source: rules::SOURCE,
    tried: true,
    rules: &[
        &rules::ENCODING,
        &rules::LINE,
        &rules::TWICE,
        &rules::MISSING,
        &rules::NUMBER,
        &rules::ORDER,
        &rules::NAMES,
        &rules::DIFFERENCES.drops,
        &rules::DIFFERENCES.value,
        &rules::DIFFERENCES.limit,
        &rules::DIFFERENCES.field,
        &rules::COMPACT,
    ],
    read: read::read,
    value: Some(|key, text, data_type| match key {
        Key::LowLimit | Key::HighLimit => read::limit(text, data_type),
        _ => read::value(text, data_type),
    }),
    differences: Some(&rules::DIFFERENCES),
};
