//! The content of an XDD besides its objects, as sections of an EDS.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use roxmltree::Node;

use crate::rules::lists::reader::w0252_in_xdd;
use crate::rules::standard::w0638_dcf_bit_rate::w0638_default_not_supported;
use crate::rules::text::w0123_attribute_not_valid;
use crate::scan::forms;
use crate::scan::section::TextSection;
use crate::span::{Span, Spanned};
use crate::xdd::schema;
use crate::xdd::source::Made;
use crate::xdd::source::{Reader, below, children};

/// Name of the characteristic with the lines of `[Comments]`.
pub(super) const COMMENTS: &str = "Comments";
/// Name of the characteristic with FileRevision.
pub(super) const REVISION: &str = "File revision";

/// FileInfo, DeviceInfo, DummyUsage, Comments and DeviceComissioning, if the file has them.
pub(super) fn sections(root: Node<'_, '_>, reader: &mut Reader<'_>) -> Vec<TextSection<'static>> {
    let mut made = Vec::new();
    let mut bodies = below(root, "ProfileBody");
    if let Some(body) = bodies.next() {
        made.push(file_info(root, body, reader));
    }
    made.extend(device_info(root, reader));
    made.extend(dummies(root, reader));
    made.extend(channels(root, reader));
    made.extend(comments(root, reader));
    made.extend(commissioning(root, reader));
    made
}

fn file_info(root: Node<'_, '_>, body: Node<'_, '_>, reader: &Reader<'_>) -> TextSection<'static> {
    let mut made = Made::new("FileInfo", reader.tag(body));
    let take = |name| {
        reader
            .attribute(body, name)
            .filter(|value| !value.is_empty())
    };
    made.put("FileName", take("fileName"));
    // A version may be a text here; an EDS has a number.
    let version = take("fileVersion");
    made.put(
        "FileVersion",
        version.filter(|text| text.parse::<u8>().is_ok()),
    );
    let revision = characteristic(root, REVISION, reader);
    made.put(
        "FileRevision",
        revision.and_then(|found| found.1.into_iter().next()),
    );
    made.put(
        "EDSVersion",
        Some(Spanned::new("4.0".into(), reader.tag(body))),
    );
    let take_as = |name, form| take(name).filter(|given| schema::fits(form, given));
    let description = below(root, "productText")
        .flat_map(|text| children(text, "description"))
        .find_map(|description| reader.text(description));
    made.put("Description", description);
    made.put(
        "CreationTime",
        take_as("fileCreationTime", schema::Value::Time).map(time),
    );
    made.put(
        "CreationDate",
        take_as("fileCreationDate", schema::Value::Date).map(date),
    );
    made.put("CreatedBy", take("fileCreator"));
    made.put(
        "ModificationTime",
        take_as("fileModificationTime", schema::Value::Time).map(time),
    );
    made.put(
        "ModificationDate",
        take_as("fileModificationDate", schema::Value::Date).map(date),
    );
    made.put("ModifiedBy", take("fileModifiedBy"));
    made.placed
}

/// Place and contents of the characteristic with this name.
fn characteristic(
    root: Node<'_, '_>,
    name: &str,
    reader: &Reader<'_>,
) -> Option<(Span, Vec<Spanned<String>>)> {
    let label = |node| children(node, "label").find_map(|label| reader.text(label));
    let mut all = below(root, "characteristic");
    let found = all.find(|one| {
        let mut names = children(*one, "characteristicName").filter_map(label);
        names.any(|own| own.value == name)
    })?;
    let contents = children(found, "characteristicContent").filter_map(label);
    Some((reader.tag(found), contents.collect()))
}

fn comments(root: Node<'_, '_>, reader: &Reader<'_>) -> Option<TextSection<'static>> {
    let (header, lines) = characteristic(root, COMMENTS, reader)?;
    let mut made = Made::new("Comments", header);
    let count = lines.len().to_string();
    made.put("Lines", Some(Spanned::new(count, header)));
    for (number, line) in (1..).zip(lines) {
        made.put(&format!("Line{number}"), Some(line));
    }
    Some(made.placed)
}

fn date(given: Spanned<String>) -> Spanned<String> {
    Spanned::new(forms::date(&given).trim().to_string(), given.span)
}

fn time(given: Spanned<String>) -> Spanned<String> {
    Spanned::new(forms::time(&given).trim().to_string(), given.span)
}

fn device_info(root: Node<'_, '_>, reader: &mut Reader<'_>) -> Option<TextSection<'static>> {
    let identity = below(root, "DeviceIdentity").next();
    let general = below(root, "CANopenGeneralFeatures").next();
    let master = below(root, "CANopenMasterFeatures").next();
    let header = reader.tag(identity.or(general)?);
    let mut made = Made::new("DeviceInfo", header);
    let text = |name| {
        let element = children(identity?, name).next()?;
        reader.text(element).filter(|text| !text.is_empty())
    };
    made.put("VendorName", text("vendorName"));
    made.put("VendorNumber", text("vendorID"));
    made.put("ProductName", text("productName"));
    made.put("ProductNumber", text("productID"));
    made.put("RevisionNumber", text("revisionNumber"));
    made.put(
        "OrderCode",
        text("orderCode").or_else(|| text("orderNumber")),
    );
    bit_rates(&mut made, root, reader);
    let reader = &*reader;
    let flag = |node: Option<Node<'_, '_>>, name| reader.attribute(node?, name).map(flag);
    let number = |name| reader.attribute(general?, name);
    made.put("SimpleBootUpMaster", flag(master, "bootUpMaster"));
    made.put("SimpleBootUpSlave", flag(general, "bootUpSlave"));
    made.put("Granularity", number("granularity"));
    made.put("DynamicChannelsSupported", number("dynamicChannels"));
    made.put("GroupMessaging", flag(general, "groupMessaging"));
    made.put("NrOfRXPDO", number("nrOfRxPDO"));
    made.put("NrOfTXPDO", number("nrOfTxPDO"));
    made.put("LSS_Supported", flag(general, "layerSettingServiceSlave"));
    Some(made.placed)
}

/// Bit rates of CiA 301 in kbit/s; 100 is one of older versions.
const RATES: [u32; 9] = [10, 20, 50, 100, 125, 250, 500, 800, 1000];

/// The supported bit rates as flags: `500 Kbps` becomes BaudRate_500. An EDS has no key for the default bit rate.
fn bit_rates(made: &mut Made, root: Node<'_, '_>, reader: &mut Reader<'_>) {
    let Some(rates) = below(root, "baudRate").next() else {
        return;
    };
    let header = reader.tag(rates);
    let given: Vec<Spanned<String>> = children(rates, "supportedBaudRate")
        .filter_map(|rate| reader.attribute(rate, "value"))
        .collect();
    let default = reader.attribute(rates, "defaultValue");
    let default = default.filter(|default| !default.is_empty() && !given.is_empty());
    if let Some(default) = default {
        let is_supported = |one: &Spanned<String>| kbits(one) == kbits(&default);
        if kbits(&default).is_none() || !given.iter().any(is_supported) {
            reader.log.push(w0638_default_not_supported(&default));
        }
    }
    for one in &given {
        spelled(one, reader);
    }
    for rate in RATES {
        let found = given.iter().find(|given| kbits(given) == Some(rate));
        // CiA 306 has no key for 100 kbit/s.
        if found.is_some() || rate != 100 {
            let flag = if found.is_some() { "1" } else { "0" };
            let span = found.map_or(header, |found| found.span);
            made.put(
                &format!("BaudRate_{rate}"),
                Some(Spanned::new(flag.into(), span)),
            );
        }
    }
}

/// Reports a bit rate that is not a word of the schema.
fn spelled(given: &Spanned<String>, reader: &mut Reader<'_>) {
    let is_known = RATES.iter().any(|rate| **given == format!("{rate} Kbps"));
    if !is_known && !given.starts_with("auto") {
        let meant = kbits(given).filter(|meant| RATES.contains(meant));
        reader.log.push(w0252_in_xdd(given, meant));
    }
}

/// The number of `500 Kbps`.
fn kbits(given: &str) -> Option<u32> {
    given
        .split(|c: char| !c.is_ascii_digit())
        .next()?
        .parse()
        .ok()
}

/// `true` becomes `1`.
fn flag(given: Spanned<String>) -> Spanned<String> {
    let value = match given.as_str() {
        "true" => "1".to_string(),
        "false" => "0".to_string(),
        _ => given.value,
    };
    Spanned::new(value, given.span)
}

/// `<dummy entry="Dummy0005=1"/>`
fn dummies(root: Node<'_, '_>, reader: &mut Reader<'_>) -> Option<TextSection<'static>> {
    let usage = below(root, "dummyUsage").next()?;
    let mut made = Made::new("DummyUsage", reader.tag(usage));
    for dummy in children(usage, "dummy") {
        let Some(entry) = reader.attribute(dummy, "entry") else {
            continue;
        };
        let Some((key, value)) = entry.split_once('=') else {
            let right = "a data type and 0 or 1, such as `Dummy0005=1`".to_string();
            let finding = w0123_attribute_not_valid(&entry, "entry", right);
            reader.log.push(finding);
            continue;
        };
        // Other texts cannot be keys of an EDS.
        let key = key.trim();
        if key.bytes().all(|byte| byte.is_ascii_alphanumeric()) {
            let value = Spanned::new(value.trim().to_string(), entry.span);
            made.put(key, Some(value));
        }
    }
    Some(made.placed)
}

/// The segments of a programmable device, as `[DynamicChannels]`.
fn channels(root: Node<'_, '_>, reader: &Reader<'_>) -> Option<TextSection<'static>> {
    let channels = below(root, "dynamicChannels").next()?;
    let header = reader.tag(channels);
    let mut made = Made::new("DynamicChannels", header);
    let mut count = 0;
    for channel in children(channels, "dynamicChannel") {
        count += 1;
        let hex = |name| {
            let given = reader.attribute(channel, name)?;
            Some(Spanned::new(format!("0x{}", given.value), given.span))
        };
        made.put(&format!("Type{count}"), hex("dataType"));
        let access = reader.attribute(channel, "accessType").map(|given| {
            let of_eds = match given.as_str() {
                "readOnly" => "ro",
                "writeOnly" => "wo",
                "readWriteOutput" => "rww",
                other => other,
            };
            Spanned::new(of_eds.to_string(), given.span)
        });
        made.put(&format!("Dir{count}"), access);
        if let Some((first, last)) = hex("startIndex").zip(hex("endIndex")) {
            let range = format!("{}-{}", first.value, last.value);
            made.put(
                &format!("Range{count}"),
                Some(Spanned::new(range, first.span)),
            );
        }
        made.put(&format!("PPOffset{count}"), hex("addressOffset"));
    }
    made.put("NrOfSeg", Some(Spanned::new(count.to_string(), header)));
    Some(made.placed)
}

fn commissioning(root: Node<'_, '_>, reader: &mut Reader<'_>) -> Option<TextSection<'static>> {
    let element = below(root, "deviceCommissioning").next()?;
    if let Some(given) = reader.attribute(element, "actualBaudRate")
        && kbits(&given).is_some_and(|rate| RATES.contains(&rate))
    {
        spelled(&given, reader);
    }
    let reader = &*reader;
    let mut made = Made::new("DeviceComissioning", reader.tag(element));
    let take = |name| {
        reader
            .attribute(element, name)
            .filter(|value| !value.is_empty())
    };
    made.put("NodeID", take("nodeID"));
    made.put("NodeName", take("nodeName"));
    made.put("Baudrate", take("actualBaudRate").map(rate));
    made.put("NetNumber", take("networkNumber"));
    made.put("NetworkName", take("networkName"));
    made.put("CANopenManager", take("CANopenManager").map(flag));
    Some(made.placed)
}

/// `500 Kbps` becomes `500`.
fn rate(given: Spanned<String>) -> Spanned<String> {
    let digits = given.bytes().take_while(u8::is_ascii_digit).count();
    let span: Span = given.span;
    match digits {
        0 => given,
        _ => Spanned::new(given[..digits].to_string(), span),
    }
}
