//! XDD and XDC text: any text is read, and reads the same after it was written as XDD or EDS.

use od_eds::Tables;

use super::eds::{self, said};
use super::fix;
use crate::files::files;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "xdd",
    run,
    seeds: || {
        let mut seeds = files("tests/cases", &["input.xdd"], 16_384);
        seeds.extend(files("crates/od-eds/cases", &[".xdd"], 16_384));
        // The project has few; others are made from EDS files.
        seeds.extend(eds::seeds().iter().map(|bytes| {
            let parsed = od_eds::parse(&od_eds::decode(bytes));
            od_eds::xdd::write(&parsed.description).into_bytes()
        }));
        seeds
    },
    words: &[
        "<CANopenObject index=\"2000\" name=\"a\" objectType=\"7\" dataType=\"0007\" accessType=\"rw\"/>",
        "<CANopenSubObject subIndex=\"01\" name=\"b\" objectType=\"7\" dataType=\"0005\"/>",
        "<CANopenObjectList>",
        "</CANopenObjectList>",
        "<parameter uniqueID=\"p\" access=\"readWrite\">",
        "<templateList>",
        "<dummyUsage><dummy entry=\"Dummy0001=1\"/></dummyUsage>",
        " uniqueIDRef=\"p\"",
        " defaultValue=\"$NODEID+0x180\"",
        " actualValue=\"5\"",
        " lowLimit=\"-1\"",
        " highLimit=\"0xFFFFFFFFFFFFFFFF\"",
        " PDOmapping=\"default\"",
        " subNumber=\"3\"",
        " index=\"1018\"",
        " objectType=\"9\"",
        " dataType=\"001B\"",
        "<array uniqueID=\"a\"><subrange lowerLimit=\"0\" upperLimit=\"254\"/><UINT/></array>",
        "<struct uniqueID=\"s\"><varDeclaration name=\"v\" uniqueID=\"v\"><BOOL/></varDeclaration></struct>",
        "<!-- -->",
        "<![CDATA[]]>",
        "&amp;",
        "&#10;",
        "&#x0;",
        "<",
        ">",
        "/>",
        "\"",
        "'",
        "ä",
        "\u{feff}",
        "\r\n",
    ],
    is_text: true,
    longest: 32_768,
    ..Target::PLAIN
};

fn run(input: &[u8]) {
    let text = od_eds::decode(input);
    let parsed = od_eds::load(&text);
    said(&parsed.findings, &text);
    fix::run(input);
    let tables = Tables::new(&parsed.description);
    for entry in tables.dictionary().entries() {
        assert_eq!(tables.dictionary().find(entry.address), Ok(entry));
    }
    eds::written_again(&parsed.description);
    let written = od_eds::xdd::write(&parsed.description);
    let again = od_eds::parse(&written).description;
    eds::same_values(&parsed.description, &again, &written);
    let twice = od_eds::xdd::write(&again);
    eds::same_values(&again, &od_eds::parse(&twice).description, &twice);
}
