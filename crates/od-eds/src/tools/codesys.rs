//! CODESYS, by its public help; it was not run.

use crate::finding::Rule;
use crate::scan::lines::lines;
use crate::span::Span;
use crate::tools::tool::{Input, REJECTS, Reading, Tool};

const SOURCE: &str = "content.helpme-codesys.com, Command: Device Repository, Install: *.eds and *.dcf files for CAN devices";

pub(crate) static TOOL: Tool = Tool {
    name: "codesys",
    version: "V3",
    source: SOURCE,
    tried: false,
    rules: &[&XML],
    read,
    value: None,
    differences: None,
};

static XML: Rule = Rule {
    code: "T0701",
    title: "an XDD or XDC, where the tool installs EDS and DCF files",
    source: SOURCE,
    says: "{tool} rejects the file: for CAN devices it installs EDS and DCF files, and this is XML",
    help: "write an EDS with `odkit convert`",
    example: "a file that begins with <?xml",
    ..REJECTS
};

fn read(input: &Input<'_>) -> Reading {
    let mut reading = Reading::default();
    let text = input.decoded.trim_start_matches('\u{FEFF}');
    if text.trim_start().starts_with('<') {
        let line = lines(input.decoded).find(|line| !line.text.trim().is_empty());
        let span = line.map_or(Span::default(), |line| line.span(line.text));
        reading.push(XML.at(span));
    }
    reading
}
