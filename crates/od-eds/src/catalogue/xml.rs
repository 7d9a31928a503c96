//! The terms of an XDD in the sentences of findings, which are written in those of an EDS.

use alloc::format;
use alloc::string::String;

use crate::fact::Key;

/// The attribute of an object for a key of an EDS.
pub(super) const fn key(key: Key) -> &'static str {
    match key {
        Key::ParameterName => "name",
        Key::ObjectType => "objectType",
        Key::SubNumber => "subNumber",
        Key::DataType => "dataType",
        Key::AccessType => "accessType",
        Key::PdoMapping => "PDOmapping",
        Key::DefaultValue => "defaultValue",
        Key::ParameterValue => "actualValue",
        Key::LowLimit => "lowLimit",
        Key::HighLimit => "highLimit",
        Key::ObjFlags => "objFlags",
        other => other.name(),
    }
}

/// An attribute of an object with the value that an EDS writes.
pub(super) fn set(of: Key, value: &str) -> String {
    let value = match (of, value) {
        (Key::PdoMapping, "0") => "no",
        (Key::PdoMapping, "1") => "optional",
        // The direction is in PDOmapping.
        (Key::AccessType, "rwr" | "rww") => "rw",
        (Key::DataType | Key::ObjectType, value) => value.strip_prefix("0x").unwrap_or(value),
        (_, value) => value,
    };
    format!("{}=\"{value}\"", key(of))
}

/// An element to write.
pub(super) fn section(index: u16, sub: Option<u8>) -> String {
    match sub {
        Some(sub) => format!("a CANopenSubObject with subIndex=\"{sub:02X}\" in {index:04X}h"),
        None => format!("a CANopenObject with index=\"{index:04X}\""),
    }
}

/// Sentences, or parts of them, that are another one for an XDD.
const SENTENCES: &[(&str, &str)] = &[
    (
        "Baudrate is {given}, but BaudRate_{given} in [DeviceInfo] is 0",
        "actualBaudRate is {given} Kbps, but no supportedBaudRate has this value",
    ),
    (
        "write 10, 20, 50, 125, 250, 500, 800 or 1000 (kbit/s){fix}",
        "write 10, 20, 50, 125, 250, 500, 800 or 1000, and `Kbps` behind it{fix}",
    ),
    (
        "[DeviceInfo] sets every bit rate to 0",
        "no supportedBaudRate is a bit rate of CiA 301",
    ),
    (
        "write 1 for each supported bit rate, such as `BaudRate_125=1`",
        "add `<supportedBaudRate value=\"125 Kbps\"/>` for each supported bit rate",
    ),
    ("[{section}] lacks `{field}`", "{section} lacks {field}"),
    (
        "add `{field}=` and its value",
        "add the attribute {field} and its value",
    ),
    (
        "{name} `{given}` in [{section}] is not valid",
        "{name} `{given}` is not valid",
    ),
    ("write `0` or `1`", "write `true` or `false`"),
    (
        "LSS_Supported in [DeviceInfo] is 0",
        "layerSettingServiceSlave is false",
    ),
    ("LSS_Supported=0", "layerSettingServiceSlave=\"false\""),
    ("LSS_Supported=1", "layerSettingServiceSlave=\"true\""),
    ("CANopenManager=0", "CANopenManager=\"false\""),
    ("CANopenManager is 1", "CANopenManager is true"),
    ("Granularity=8", "granularity=\"8\""),
    ("`Dummy{code:04X}`", "`Dummy{code:04X}=0`"),
];

/// Keys and sections of an EDS, and attributes and elements of an XDD.
const WORDS: &[(&str, &str)] = &[
    ("[DeviceComissioning]", "deviceCommissioning"),
    ("[DeviceInfo]", "CANopenGeneralFeatures"),
    ("[DummyUsage]", "dummyUsage"),
    ("[DynamicChannels]", "dynamicChannels"),
    ("Baudrate", "actualBaudRate"),
    ("CreatedBy", "fileCreator"),
    ("CreationDate", "fileCreationDate"),
    ("CreationTime", "fileCreationTime"),
    ("DeviceComissioning", "deviceCommissioning"),
    ("DeviceInfo", "CANopenGeneralFeatures"),
    ("DynamicChannelsSupported", "dynamicChannels"),
    ("FileVersion", "fileVersion"),
    ("Granularity", "granularity"),
    ("GroupMessaging", "groupMessaging"),
    ("LSS_Supported", "layerSettingServiceSlave"),
    ("ModificationDate", "fileModificationDate"),
    ("ModificationTime", "fileModificationTime"),
    ("NetNumber", "networkNumber"),
    ("NetworkName", "networkName"),
    ("NodeName", "nodeName"),
    ("NrOfRXPDO", "nrOfRxPDO"),
    ("NrOfTXPDO", "nrOfTxPDO"),
    ("ProductName", "productName"),
    ("ProductNumber", "productID"),
    ("RevisionNumber", "revisionNumber"),
    ("SimpleBootUpMaster", "bootUpMaster"),
    ("SimpleBootUpSlave", "bootUpSlave"),
    ("VendorName", "vendorName"),
    ("VendorNumber", "vendorID"),
];

/// The name of a key or a section of an EDS in an XDD.
pub(super) fn word(eds: &str) -> &str {
    let found = WORDS.iter().find(|(own, _)| *own == eds);
    found.map_or(eds, |(_, xml)| xml)
}

/// A sentence, with its blanks, in the terms of an XDD.
pub(super) fn sentence(eds: &str) -> String {
    let mut text = String::from(eds);
    for (own, xml) in SENTENCES {
        text = text.replace(own, xml);
    }
    // Blanks and their names stay.
    let mut out = String::with_capacity(text.len());
    let mut rest = text.as_str();
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let end = match first {
            '{' => rest.find('}').map_or(rest.len(), |at| at + 1),
            '[' => rest.find(']').map_or(rest.len(), |at| at + 1),
            first if is_word(first) => rest.find(|c| !is_word(c)).unwrap_or(rest.len()),
            first => first.len_utf8(),
        };
        let (piece, behind) = rest.split_at(end);
        out.push_str(word(piece));
        rest = behind;
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rules::RULES;

    #[test]
    fn a_sentence_has_the_names_of_the_schema() {
        for (eds, xml) in [
            (
                "Baudrate `{given}` is not valid",
                "actualBaudRate `{given}` is not valid",
            ),
            (
                "correct Granularity in [DeviceInfo]",
                "correct granularity in CANopenGeneralFeatures",
            ),
            ("{Granularity} of [2000]", "{Granularity} of [2000]"),
            (
                "write `LSS_Supported=0`",
                "write `layerSettingServiceSlave=\"false\"`",
            ),
        ] {
            assert_eq!(sentence(eds), xml);
        }
        assert_eq!(set(Key::AccessType, "rww"), "accessType=\"rw\"");
        assert_eq!(set(Key::DataType, "0x0006"), "dataType=\"0006\"");
        assert_eq!(set(Key::PdoMapping, "1"), "PDOmapping=\"optional\"");
    }

    #[test]
    fn each_sentence_of_the_table_is_that_of_a_rule() {
        let forms = || RULES.iter().flat_map(|rule| rule.forms());
        for (eds, _) in SENTENCES {
            let mut all = forms();
            assert!(
                all.any(|form| form.says.contains(eds) || form.help.contains(eds)),
                "{eds}"
            );
        }
    }
}
