//! TwinCAT with an EL6751, by its public help; it was not run.

use crate::finding::Rule;
use crate::scan::lines::sections;
use crate::scan::number::number;
use crate::tools::tool::{Input, OTHERWISE, Reading, Tool};

const SOURCE: &str =
    "infosys.beckhoff.com/content/1033/el6751/2519203979.html, CAN Node: Profile no., Add info";

pub(crate) static TOOL: Tool = Tool {
    name: "twincat",
    version: "EL6751",
    source: SOURCE,
    tried: false,
    rules: &[&DEVICE_TYPE],
    read,
    value: None,
    differences: None,
};

static DEVICE_TYPE: Rule = Rule {
    code: "T0801",
    title: "object 1000h without a value to compare",
    source: SOURCE,
    says: "{tool} does not compare object 1000h at start: the file has no value for it other than 0",
    help: "write the device type as DefaultValue of 1000h",
    example: "[1000] with DefaultValue=0",
    ..OTHERWISE
};

fn read(input: &Input<'_>) -> Reading {
    let mut reading = Reading::default();
    let sections = sections(input.decoded);
    let Some(object) = sections.iter().find(|section| &**section.name == "1000") else {
        return reading;
    };
    let value = object
        .get("ParameterValue")
        .or_else(|| object.get("DefaultValue"));
    if value.and_then(|value| number(value)).unwrap_or(0) == 0 {
        let span = value.map_or(object.header, |value| value.span.or(object.header));
        reading.push(DEVICE_TYPE.at(span));
    }
    reading
}
