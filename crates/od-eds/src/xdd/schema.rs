//! Elements and attributes of an XDD as the schema of CiA 311 has them: names, required attributes, and the form of their
//! values. The reader of an element checks the values that it uses; this check is about the others.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use roxmltree::Node;

use crate::finding::Severity;
use crate::fix::Fix;
use crate::rules::structure::reader::{w0318_attribute_misspelled, w0318_element_misspelled};
use crate::rules::text::{
    e0124_id_missing, e0124_id_twice, w0123_attribute_missing, w0123_attribute_not_valid,
    w0123_element_unknown,
};
use crate::scan::forms::near;
use crate::xdd::objects::ACCESSES;
use crate::xdd::source::{Reader, children};

/// An attribute of an element.
pub struct Attribute {
    /// Its name.
    pub name: &'static str,
    /// The form of its value.
    pub value: Value,
    /// Whether the schema requires it, and no other rule reports its absence.
    required: bool,
}

/// The types of the body of a profile.
const PROFILES: [&str; 2] = [
    "ProfileBody_Device_CANopen",
    "ProfileBody_CommunicationNetwork_CANopen",
];

/// The form of the value of an attribute.
#[derive(Clone, Copy)]
pub enum Value {
    /// A text, or a value that another rule checks.
    Any,
    /// One of these words.
    Words(&'static [&'static str]),
    /// The same; another rule reports a word in other capitals.
    Capitals(&'static [&'static str]),
    /// `true` or `false`.
    Flag,
    /// A number from 0 to this one.
    Number(u32),
    /// A number, also with a decimal point.
    Real,
    /// Hexadecimal digits without `0x`, two for each byte.
    Hex,
    /// The same with this number of digits; another rule reports what is not hexadecimal.
    Digits(usize),
    /// Year, month and day: `2026-11-27`.
    Date,
    /// Hour, minute and second: `09:30:00`.
    Time,
    /// The uniqueID of another element.
    Reference,
    /// The type of a profile of CANopen, which may have a prefix.
    Profile,
}

use Value::{
    Any, Capitals, Date, Digits, Flag, Hex, Number, Profile, Real, Reference, Time, Words,
};

const fn own(name: &'static str, value: Value) -> Attribute {
    Attribute {
        name,
        value,
        required: false,
    }
}

const fn required(name: &'static str, value: Value) -> Attribute {
    Attribute {
        name,
        value,
        required: true,
    }
}

const BODY: &[Attribute] = &[
    own("formatName", Any),
    own("formatVersion", Any),
    own("fileName", Any),
    own("fileCreator", Any),
    own("fileCreationDate", Date),
    own("fileCreationTime", Time),
    own("fileModifiedBy", Any),
    own("fileModificationDate", Date),
    own("fileModificationTime", Time),
    own("fileVersion", Any),
    own("supportedLanguages", Any),
    own(
        "deviceClass",
        Words(&["compact", "modular", "configurable"]),
    ),
    own("type", Profile),
];

/// The values of an object or a sub-object are checked where they are read.
const OBJECT: &[Attribute] = &[
    own("index", Digits(4)),
    own("name", Any),
    own("objectType", Any),
    own("dataType", Digits(4)),
    own("accessType", Any),
    own("lowLimit", Any),
    own("highLimit", Any),
    own("defaultValue", Any),
    own("actualValue", Any),
    own("denotation", Any),
    own("PDOmapping", Any),
    own("objFlags", Digits(2)),
    own("uniqueIDRef", Any),
    own("subNumber", Any),
    own("rangeSelector", Any),
];

const SUB_OBJECT: &[Attribute] = &[
    own("subIndex", Digits(2)),
    own("name", Any),
    own("objectType", Any),
    own("dataType", Digits(4)),
    own("accessType", Any),
    own("lowLimit", Any),
    own("highLimit", Any),
    own("defaultValue", Any),
    own("actualValue", Any),
    own("denotation", Any),
    own("PDOmapping", Any),
    own("objFlags", Digits(2)),
    own("uniqueIDRef", Any),
    own("rangeSelector", Any),
];

const PARAMETER: &[Attribute] = &[
    required("uniqueID", Any),
    own("access", Capitals(ACCESSES)),
    own("accessList", Any),
    own("support", Words(&["mandatory", "optional", "conditional"])),
    own("persistent", Flag),
    own("offset", Real),
    own("multiplier", Real),
    own("templateIDRef", Reference),
];

const TEXT: &[Attribute] = &[required("lang", Any), own("URI", Any)];
/// A value of a parameter: its default, a limit, a step.
const VALUE: &[Attribute] = &[
    required("value", Any),
    own("offset", Real),
    own("multiplier", Real),
];
const UNIQUE: &[Attribute] = &[own("uniqueIDRef", Reference)];

/// The elements whose attributes are checked, by name.
const ELEMENTS: &[(&str, &[Attribute])] = &[
    (
        "CANopenGeneralFeatures",
        &[
            own("groupMessaging", Any),
            own("dynamicChannels", Any),
            own("selfStartingDevice", Flag),
            own("SDORequestingDevice", Flag),
            required("granularity", Any),
            own("nrOfRxPDO", Any),
            own("nrOfTxPDO", Any),
            own("ngSlave", Flag),
            own("ngMaster", Flag),
            own("NrOfNG_MonitoredNodes", Number(0xFFFF)),
            own("bootUpSlave", Any),
            own("layerSettingServiceSlave", Any),
        ],
    ),
    (
        "CANopenMasterFeatures",
        &[
            own("bootUpMaster", Any),
            own("flyingMaster", Flag),
            own("SDOManager", Flag),
            own("configurationManager", Flag),
            own("layerSettingServiceMaster", Flag),
        ],
    ),
    ("CANopenObject", OBJECT),
    (
        "CANopenObjectList",
        &[
            own("mandatoryObjects", Any),
            own("optionalObjects", Any),
            own("manufacturerObjects", Any),
        ],
    ),
    ("CANopenSubObject", SUB_OBJECT),
    (
        "LED",
        &[
            required("LEDcolors", Words(&["monocolor", "bicolor"])),
            own("LEDtype", Words(&["IO", "device", "communication"])),
        ],
    ),
    (
        "LEDstate",
        &[
            required("uniqueID", Any),
            required("state", Words(&["on", "off", "flashing"])),
            required("LEDcolor", Words(&["green", "amber", "red"])),
            own("flashingPeriod", Number(u32::MAX)),
            own("impulsWidth", Number(0xFF)),
            own("numberOfImpulses", Number(0xFF)),
        ],
    ),
    ("LEDstateRef", &[required("stateIDRef", Reference)]),
    ("ProfileBody", BODY),
    ("actualValue", VALUE),
    ("baudRate", &[own("defaultValue", Any)]),
    ("dataTypeIDRef", UNIQUE),
    ("defaultValue", VALUE),
    ("description", TEXT),
    (
        "deviceCommissioning",
        &[
            // odkit writes the first one and reads both. No public file at hand has the element.
            own("nodeID", Any),
            own("NodeID", Any),
            own("nodeName", Any),
            own("actualBaudRate", Any),
            own("networkNumber", Any),
            own("networkName", Any),
            own("CANopenManager", Any),
        ],
    ),
    ("dummy", &[required("entry", Any)]),
    (
        "dynamicChannel",
        &[
            required("dataType", Digits(4)),
            required(
                "accessType",
                Words(&["readOnly", "writeOnly", "readWriteOutput"]),
            ),
            required("startIndex", Hex),
            required("endIndex", Hex),
            required("maxNumber", Number(u32::MAX)),
            required("addressOffset", Hex),
            own("bitAlignment", Number(0xFF)),
        ],
    ),
    ("label", TEXT),
    ("maxValue", VALUE),
    ("minValue", VALUE),
    ("parameter", PARAMETER),
    (
        "parameterGroup",
        &[required("uniqueID", Any), own("kindOfAccess", Any)],
    ),
    ("parameterRef", &[required("uniqueIDRef", Reference)]),
    ("parameterTemplate", PARAMETER),
    ("property", &[required("name", Any), required("value", Any)]),
    ("step", VALUE),
    ("substituteValue", VALUE),
    ("supportedBaudRate", &[required("value", Any)]),
    ("unit", &[own("multiplier", Real), own("unitURI", Any)]),
    ("variableRef", &[]),
];

/// The words of the text in an element, by its name: ProfileClassID of ISO 15745-1.
const TEXTS: &[(&str, &[&str])] = &[(
    "ProfileClassID",
    &[
        "AIP",
        "Process",
        "InformationExchange",
        "Resource",
        "Device",
        "CommunicationNetwork",
        "Equipment",
        "Human",
        "Material",
    ],
)];

/// Names of further elements, whose attributes are not checked.
const OTHERS: &[&str] = &[
    "AdditionalInformation",
    "ApplicationLayers",
    "ApplicationProcess",
    "BITSTRING",
    "BOOL",
    "BYTE",
    "CANopenObjects",
    "CHAR",
    "DINT",
    "DWORD",
    "DeviceFunction",
    "DeviceIdentity",
    "DeviceManager",
    "ExternalProfileHandle",
    "IASInterface",
    "IASInterfaceType",
    "INT",
    "ISO15745Edition",
    "ISO15745Part",
    "ISO15745Profile",
    "ISO15745ProfileContainer",
    "ISO15745Reference",
    "LEDList",
    "LINT",
    "LREAL",
    "LWORD",
    "NetworkManagement",
    "PhysicalLayer",
    "ProfileClassID",
    "ProfileDate",
    "ProfileHeader",
    "ProfileIdentification",
    "ProfileLocation",
    "ProfileName",
    "ProfileRevision",
    "ProfileSource",
    "ProfileTechnology",
    "REAL",
    "SINT",
    "STRING",
    "TransportLayers",
    "UDINT",
    "UINT",
    "ULINT",
    "USINT",
    "WORD",
    "WSTRING",
    "allowedValues",
    "allowedValuesTemplate",
    "array",
    "baseType",
    "buildDate",
    "buildNumber",
    "capabilities",
    "category",
    "characteristic",
    "characteristicContent",
    "characteristicName",
    "characteristicsList",
    "combinedState",
    "compliantWith",
    "conditionalSupport",
    "configVars",
    "connectedModule",
    "connectedModuleList",
    "connection",
    "count",
    "dataTypeList",
    "denotation",
    "derived",
    "descriptionRef",
    "deviceClass",
    "deviceFamily",
    "dictionary",
    "dictionaryList",
    "dummyUsage",
    "dynamicChannels",
    "enum",
    "enumValue",
    "file",
    "fileList",
    "functionInstance",
    "functionInstanceList",
    "functionType",
    "functionTypeList",
    "identity",
    "indicatorList",
    "inputVars",
    "instanceIDRef",
    "instanceList",
    "instanceName",
    "interface",
    "interfaceList",
    "labelRef",
    "memberRef",
    "moduleInterface",
    "moduleInterfaceList",
    "moduleManagement",
    "moduleType",
    "moduleTypeList",
    "orderCode",
    "orderNumber",
    "outputVars",
    "parameterGroupList",
    "parameterList",
    "picture",
    "picturesList",
    "productFamily",
    "productID",
    "productName",
    "productText",
    "range",
    "rangeList",
    "revisionNumber",
    "serialNumber",
    "specificationRevision",
    "standardComplianceList",
    "struct",
    "subrange",
    "templateList",
    "unitURI",
    "value",
    "varDeclaration",
    "variableIDRef",
    "vendorID",
    "vendorName",
    "vendorText",
    "vendorTextDescription",
    "version",
    "versionInfo",
];

/// The attributes of an element; none of one that is not in the table.
pub fn attributes(element: &str) -> &'static [Attribute] {
    let mut all = ELEMENTS.iter();
    let found = all.find(|(name, _)| *name == element);
    found.map_or(&[], |(_, attributes)| *attributes)
}

/// Returns whether the schema has an element of this name.
fn is_of_schema(node: Option<Node<'_, '_>>) -> bool {
    node.is_some_and(|node| {
        let name = node.tag_name().name();
        ELEMENTS.iter().any(|(known, _)| *known == name) || OTHERS.contains(&name)
    })
}

/// Returns whether an element of the table has an attribute of this name.
pub(super) fn is_attribute(name: &str) -> bool {
    let mut all = ELEMENTS.iter().flat_map(|(_, attributes)| *attributes);
    all.any(|own| own.name == name)
}

/// Returns whether an attribute of this name may have this word.
pub(super) fn has_word(name: &str, word: &str) -> bool {
    let mut all = ELEMENTS.iter().flat_map(|(_, attributes)| *attributes);
    all.any(|own| own.name == name && matches!(own.value, Words(words) if words.contains(&word)))
}

/// Reports elements and attributes that are misspelled or missing, values that the schema does not allow, and uniqueIDs
/// that two elements have or no element has.
pub(super) fn check(root: Node<'_, '_>, reader: &mut Reader<'_>) {
    let mut ids = BTreeMap::new();
    for node in root.descendants().filter(Node::is_element) {
        if let Some(id) = node.attribute("uniqueID") {
            match ids.get(id) {
                None => drop(ids.insert(id, node)),
                Some(first) => {
                    let first = reader.attribute(*first, "uniqueID");
                    if let Some((given, first)) = reader.attribute(node, "uniqueID").zip(first) {
                        reader.log.push(e0124_id_twice(&given, first.span));
                    }
                }
            }
        }
    }
    let namespace = |node: Node<'_, '_>| node.tag_name().namespace().map(String::from);
    let own_namespace = root.first_element_child().and_then(namespace);
    for node in root.descendants().filter(Node::is_element) {
        let name = node.tag_name().name();
        if !is_of_schema(Some(node)) {
            let known = ELEMENTS.iter().map(|(known, _)| *known);
            if let Some(meant) = near(name, known.chain(OTHERS.iter().copied())) {
                let at = reader.tag_name(node);
                reader.log.push(w0318_element_misspelled(at, name, meant));
            } else if is_of_schema(node.parent_element()) && namespace(node) == own_namespace {
                let at = reader.tag_name(node);
                reader.log.push(w0123_element_unknown(at, name));
            }
        }
        text(node, name, reader);
        let attributes = attributes(name);
        if attributes.is_empty() {
            continue;
        }
        for given in node.attributes() {
            let name = given.name();
            let names = attributes.iter().map(|own| own.name);
            // XML distinguishes upper and lower case.
            let capitals = || names.clone().find(|own| own.eq_ignore_ascii_case(name));
            if names.clone().all(|own| own != name)
                && let Some(meant) = capitals().or_else(|| near(name, names.clone()))
            {
                let at = reader.name(&given);
                reader.log.push(w0318_attribute_misspelled(at, name, meant));
            }
        }
        for own in attributes {
            match reader.attribute(node, own.name) {
                None if own.required => {
                    let at = reader.tag_name(node);
                    reader.log.push(w0123_attribute_missing(at, name, own.name));
                }
                Some(given) if given.is_empty() => {}
                Some(given)
                    if matches!(own.value, Reference) && !ids.contains_key(given.as_str()) =>
                {
                    reader.log.push(e0124_id_missing(&given));
                }
                Some(given) if !fits(own.value, &given) => {
                    let finding = w0123_attribute_not_valid(&given, own.name, form(own.value));
                    let finding = match own.value {
                        Digits(_) => finding.severity_of(Severity::Warning),
                        _ => finding,
                    };
                    let words = match own.value {
                        Words(words) | Capitals(words) => words,
                        _ => &[],
                    };
                    let meant = near(&given, words.iter().copied());
                    let meant = meant.map(|meant| Fix::unsafe_fix().replace(given.span, meant));
                    let meant = meant.or_else(|| match own.value {
                        // Every tool that accepts the digits reads the same number.
                        Capitals(_) => {
                            let word = parameter_word(&given)?;
                            Some(Fix::unsafe_fix().replace(given.span, word))
                        }
                        Digits(_) => {
                            let number = format!("0x{}", bare(&given));
                            Some(Fix::safe().replace(given.span, number))
                        }
                        _ => None,
                    });
                    reader
                        .log
                        .push(finding.fix(meant.unwrap_or(Fix::unsafe_fix())));
                }
                _ => {}
            }
        }
    }
}

/// Reports the text of an element that is not a number or not one of its words, or is not the class of the profile beside it.
fn text(node: Node<'_, '_>, name: &str, reader: &mut Reader<'_>) {
    let is_number = matches!(name, "ISO15745Part" | "ISO15745Edition");
    let words = TEXTS.iter().find(|(known, _)| *known == name);
    if !is_number && words.is_none() {
        return;
    }
    let Some(given) = reader.text(node).filter(|given| !given.is_empty()) else {
        return;
    };
    let Some((_, words)) = words else {
        if !matches!(given.parse::<u32>(), Ok(1..)) {
            let wanted = "a number, 1 or more".into();
            reader
                .log
                .push(w0123_attribute_not_valid(&given, name, wanted));
        }
        return;
    };
    let profile = node.ancestors().nth(2);
    let body = profile.and_then(|profile| children(profile, "ProfileBody").next());
    let body = body.and_then(|body| reader.attribute(body, "type"));
    let body = body.as_ref().map_or("", |body| body.as_str());
    let class = match body {
        _ if body.ends_with("ProfileBody_Device_CANopen") => "Device",
        _ if body.ends_with("ProfileBody_CommunicationNetwork_CANopen") => "CommunicationNetwork",
        _ => "",
    };
    let is_right = |word: &str| class.is_empty() || word == class;
    let right: Vec<&str> = words
        .iter()
        .copied()
        .filter(|word| is_right(word))
        .collect();
    if !right.contains(&given.as_str()) {
        let finding = w0123_attribute_not_valid(&given, name, one_of(&right));
        reader.log.push(if words.contains(&given.as_str()) {
            finding.severity_of(Severity::Warning)
        } else {
            finding
        });
    }
}

/// The access of a parameter for the access of an object.
fn parameter_word(text: &str) -> Option<&'static str> {
    Some(match text.to_ascii_lowercase().as_str() {
        "ro" => "read",
        "wo" => "write",
        "rw" => "readWrite",
        "rwr" => "readWriteInput",
        "rww" => "readWriteOutput",
        _ => return None,
    })
}

/// Hexadecimal digits without `0x`.
fn bare(text: &str) -> &str {
    text.strip_prefix("0x").unwrap_or(text)
}

/// Returns whether the schema allows this text.
pub(super) fn fits(value: Value, text: &str) -> bool {
    let digits =
        |text: &str, length| text.len() == length && text.bytes().all(|byte| byte.is_ascii_digit());
    match value {
        Any | Reference => true,
        Profile => {
            let (_, name) = text.split_once(':').unwrap_or(("", text));
            // A modular device has types of its own.
            text.contains("CANopen") && near(name, PROFILES.into_iter()).is_none()
        }
        Words(words) => words.contains(&text),
        Capitals(words) => words.iter().any(|word| word.eq_ignore_ascii_case(text)),
        Flag => matches!(text, "true" | "false" | "0" | "1"),
        Real => text.trim().parse::<f64>().is_ok_and(f64::is_finite),
        Number(most) => text.parse::<u32>().is_ok_and(|number| number <= most),
        Digits(most) => {
            let digits = bare(text);
            let is_read = digits.len() <= most && digits.bytes().all(|b| b.is_ascii_hexdigit());
            !is_read || digits.is_empty() || fits(Hex, text)
        }
        Hex => {
            let is_hex = text.bytes().all(|byte| byte.is_ascii_hexdigit());
            !text.is_empty() && text.len().is_multiple_of(2) && is_hex
        }
        Date => {
            let text = text
                .get(..10)
                .filter(|_| zone(text, 10))
                .unwrap_or_default();
            let mut parts = text.split('-');
            let parts = [parts.next(), parts.next(), parts.next()];
            let [Some(year), Some(month), Some(day)] = parts else {
                return false;
            };
            digits(year, 4)
                && (digits(month, 2) && ("01"..="12").contains(&month))
                && (digits(day, 2) && ("01"..="31").contains(&day))
        }
        Time => {
            let second = text.get(..8).unwrap_or_default();
            let mut parts = second.split(':');
            let parts = [parts.next(), parts.next(), parts.next()];
            let [Some(hour), Some(minute), Some(second)] = parts else {
                return false;
            };
            digits(hour, 2)
                && hour <= "24"
                && [minute, second]
                    .iter()
                    .all(|part| digits(part, 2) && *part < "60")
        }
    }
}

/// Returns whether a text ends at this byte, or has a time zone there.
fn zone(text: &str, at: usize) -> bool {
    let rest = text.get(at..).unwrap_or("?");
    rest.is_empty() || rest == "Z" || rest.starts_with(['+', '-'])
}

/// One of these words, in a sentence.
fn one_of(words: &[&str]) -> String {
    let mut words: Vec<String> = words.iter().map(|word| format!("`{word}`")).collect();
    let last = words.pop().unwrap_or_default();
    match words.as_slice() {
        [] => last,
        before => format!("{} or {last}", before.join(", ")),
    }
}

/// A value of this form in words, for a help.
fn form(value: Value) -> String {
    match value {
        Any | Reference => "a text".into(),
        Profile => {
            "`ProfileBody_Device_CANopen` or `ProfileBody_CommunicationNetwork_CANopen`".into()
        }
        Words(words) | Capitals(words) => one_of(words),
        Flag => "`true` or `false`".into(),
        Number(most) => format!("a number from 0 to {most}"),
        Real => "a number, such as `0.1`".into(),
        Digits(digits) => format!("{digits} hexadecimal digits, without `0x`"),
        Hex => "hexadecimal digits, two for each byte, without `0x`".into(),
        Date => "year, month and day, such as `2026-11-27`".into(),
        Time => "hour, minute and second, such as `09:30:00`".into(),
    }
}
