//! Writes a description as XDD or XDC text (CiA 311 1.1).

mod data_types;
mod function;
mod xml;

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use data_types::elementary;
use xml::{Attributes, Xml, escape, vec_of};

use crate::description::{Description, EntryDescription, ObjectDescription, Section, Value};
use crate::read::fields;
use crate::read::values::text as value_text;
use crate::span::Spanned;
use od_model::{Access, Address};

/// The head of the text.
const HEAD: &str = "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<ISO15745ProfileContainer \
    xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" \
    xmlns=\"http://www.canopen.org/xml/1.1\">\n";

/// Returns the XDD of a description; for a configured device (a DCF) the XDC, with actual values
/// and commissioning.
///
/// The text gives the same objects again. Objects contain all their attributes; objects that 1010h
/// saves also have a parameter with the group.
pub fn write(description: &Description) -> String {
    let mut out = Xml::new(HEAD);
    let info = |key: &str| value(description, "FileInfo", key);
    let body = |kind: &str| {
        let date = |key| date(&info(key));
        vec_of([
            ("xsi:type", format!("ProfileBody_{kind}_CANopen")),
            ("formatName", "CANopen".into()),
            ("formatVersion", "1.0".into()),
            ("fileName", info("FileName")),
            ("fileCreator", info("CreatedBy")),
            (
                "fileCreationDate",
                date("CreationDate").unwrap_or_else(|| "1970-01-01".into()),
            ),
            (
                "fileCreationTime",
                time(&info("CreationTime")).unwrap_or_default(),
            ),
            (
                "fileModificationDate",
                date("ModificationDate").unwrap_or_default(),
            ),
            (
                "fileModificationTime",
                time(&info("ModificationTime")).unwrap_or_default(),
            ),
            ("fileModifiedBy", info("ModifiedBy")),
            (
                "fileVersion",
                Some(info("FileVersion"))
                    .filter(|version| !version.is_empty())
                    .unwrap_or_else(|| "1".into()),
            ),
            ("supportedLanguages", "en".into()),
        ])
    };
    out.profile("CANopen device profile", "Device", |out| {
        out.element("ProfileBody", &body("Device"), |out| {
            device(out, description);
        });
    });
    out.profile(
        "CANopen communication network profile",
        "CommunicationNetwork",
        |out| {
            out.element("ProfileBody", &body("CommunicationNetwork"), |out| {
                network(out, description);
            });
        },
    );
    out.0.push_str("</ISO15745ProfileContainer>\n");
    out.0
}

fn device(out: &mut Xml, description: &Description) {
    let info = |key: &str| value(description, "DeviceInfo", key);
    out.element("DeviceIdentity", &[], |out| {
        for (name, key) in [
            ("vendorName", "VendorName"),
            ("vendorID", "VendorNumber"),
            ("productName", "ProductName"),
            ("productID", "ProductNumber"),
        ] {
            out.text(name, &info(key));
        }
        let text = value(description, "FileInfo", "Description");
        if !text.is_empty() {
            out.element("productText", &[], |out| {
                out.0.push_str(&format!(
                    "{}<description lang=\"en\">{}</description>\n",
                    out.indent(),
                    escape(&text)
                ));
            });
        }
        for (name, key) in [
            ("orderNumber", "OrderCode"),
            ("revisionNumber", "RevisionNumber"),
        ] {
            let text = info(key);
            if !text.is_empty() {
                out.text(name, &text);
            }
        }
        function::versions(out, description);
    });
    function::function(out, description);
    let saved: Vec<_> = description
        .entries()
        .filter(|(_, entry)| has_parameter(entry))
        .collect();
    let mut objects = description.objects.iter();
    let has_types = objects.any(|(index, object)| data_types::parameter(*index, object).is_some());
    if saved.is_empty() && !has_types {
        return;
    }
    out.element("ApplicationProcess", &[], |out| {
        data_types::list(out, description);
        out.element("parameterList", &[], |out| {
            data_types::parameters(out, description);
            for (address, entry) in saved {
                parameter(out, address, entry);
            }
        });
    });
}

/// Returns whether an entry has content that the list of objects cannot hold.
fn has_parameter(entry: &EntryDescription) -> bool {
    entry.group.is_some()
        || fields::kept(&entry.extra).is_some()
        || matches!(*entry.access, Access::Rwr | Access::Rww) && !*entry.mappable
}

/// The parameter of an entry: name, type and the group that saves it.
fn parameter(out: &mut Xml, address: Address, entry: &EntryDescription) {
    let access = match *entry.access {
        Access::Const => "const",
        Access::Ro => "read",
        Access::Wo => "write",
        Access::Rw => "readWrite",
        Access::Rwr => "readWriteInput",
        Access::Rww => "readWriteOutput",
    };
    let attributes = vec_of([("uniqueID", id(address)), ("access", access.into())]);
    out.element("parameter", &attributes, |out| {
        out.0.push_str(&format!(
            "{}<label lang=\"en\">{}</label>\n",
            out.indent(),
            escape(&entry.name)
        ));
        let data_type = entry.data_type.map(|data_type| data_type.value);
        out.empty(elementary(data_type), &[]);
        let word = fields::kept(&entry.extra).map(|(word, _)| word);
        let storage = word.or_else(|| Some(fields::location(**entry.group.as_ref()?)));
        if let Some(storage) = storage {
            let property = [
                ("name", "CO_storageGroup".into()),
                ("value", storage.into()),
            ];
            out.empty("property", &vec_of(property));
        }
    });
}

fn network(out: &mut Xml, description: &Description) {
    out.element("ApplicationLayers", &[], |out| {
        out.element("CANopenObjectList", &[], |out| {
            for (index, described) in &description.objects {
                object(out, *index, described);
            }
        });
        out.element("dummyUsage", &[], |out| {
            for dummy in 1..=7 {
                let key = format!("Dummy{dummy:04}");
                let used = value(description, "DummyUsage", &key);
                let used = if used == "1" { "1" } else { "0" };
                out.empty("dummy", &vec_of([("entry", format!("{key}={used}"))]));
            }
        });
    });
    let info = |key: &str| decimal(value(description, "DeviceInfo", key));
    out.element("TransportLayers", &[], |out| {
        out.element("PhysicalLayer", &[], |out| {
            out.element("baudRate", &[], |out| {
                for rate in [10, 20, 50, 100, 125, 250, 500, 800, 1000] {
                    if info(&format!("BaudRate_{rate}")) == "1" {
                        let rate = format!("{rate} Kbps");
                        out.empty("supportedBaudRate", &vec_of([("value", rate)]));
                    }
                }
            });
        });
    });
    let flag = |key: &str| match info(key).as_str() {
        "" => String::new(),
        "1" => "true".into(),
        _ => "false".into(),
    };
    // The schema requires it. Most devices map whole bytes.
    let granularity = Some(info("Granularity")).filter(|given| !given.is_empty());
    out.element("NetworkManagement", &[], |out| {
        out.empty(
            "CANopenGeneralFeatures",
            &vec_of([
                ("granularity", granularity.unwrap_or("8".into())),
                ("nrOfRxPDO", info("NrOfRXPDO")),
                ("nrOfTxPDO", info("NrOfTXPDO")),
                ("bootUpSlave", flag("SimpleBootUpSlave")),
                ("layerSettingServiceSlave", flag("LSS_Supported")),
                ("groupMessaging", flag("GroupMessaging")),
                ("dynamicChannels", info("DynamicChannelsSupported")),
            ]),
        );
        out.empty(
            "CANopenMasterFeatures",
            &vec_of([("bootUpMaster", flag("SimpleBootUpMaster"))]),
        );
        commissioning(out, description);
    });
}

fn commissioning(out: &mut Xml, description: &Description) {
    let names = ["DeviceComissioning", "DeviceCommissioning"];
    let Some(section) = names.iter().find_map(|name| description.section(name)) else {
        return;
    };
    let take = |key: &str| text_of(section, key);
    let number = |key: &str| decimal(take(key));
    let rate = match number("Baudrate") {
        rate if rate.is_empty() => rate,
        rate => format!("{rate} Kbps"),
    };
    let manager = match number("CANopenManager").as_str() {
        "" => String::new(),
        "1" => "true".into(),
        _ => "false".into(),
    };
    out.empty(
        "deviceCommissioning",
        &vec_of([
            ("nodeID", number("NodeID")),
            ("nodeName", take("NodeName")),
            ("actualBaudRate", rate),
            ("networkNumber", number("NetNumber")),
            ("networkName", take("NetworkName")),
            ("CANopenManager", manager),
        ]),
    );
}

fn object(out: &mut Xml, index: u16, object: &ObjectDescription) {
    let mut attributes = vec_of([
        ("index", format!("{index:04X}")),
        ("name", object.name.value.clone()),
        ("objectType", object.code.code().to_string()),
    ]);
    if !object.code.has_members() {
        if let Some(entry) = object.entries.get(&0) {
            let address = Address::new(index, 0);
            attributes.extend(entry_attributes(address, entry));
        }
        out.empty("CANopenObject", &attributes);
        return;
    }
    attributes.push(("subNumber", object.entries.len().to_string()));
    attributes.push(("objFlags", flags(object.flags)));
    let parameter = data_types::parameter(index, object);
    attributes.push(("uniqueIDRef", parameter.unwrap_or_default()));
    out.element("CANopenObject", &attributes, |out| {
        for (sub, entry) in &object.entries {
            let mut attributes = vec_of([
                ("subIndex", format!("{sub:02X}")),
                ("name", entry.name.value.clone()),
                ("objectType", "7".into()),
            ]);
            attributes.extend(entry_attributes(Address::new(index, *sub), entry));
            out.empty("CANopenSubObject", &attributes);
        }
    });
}

fn entry_attributes(address: Address, entry: &EntryDescription) -> Attributes {
    let data_type = entry.data_type.map(|data_type| data_type.value);
    let text = |value: &Option<Spanned<Value>>| match value {
        Some(value) => value_text(value, data_type),
        None => String::new(),
    };
    // The list of objects has no word for `rwr` and `rww`: the mapping direction shows them, or the
    // parameter if there is no mapping.
    let (access, mapping) = match (*entry.access, *entry.mappable) {
        (Access::Rwr | Access::Rww, false) => ("", "no"),
        (access, false) => (access.name(), "no"),
        (Access::Rwr, true) => ("rw", "TPDO"),
        (Access::Rww, true) => ("rw", "RPDO"),
        (Access::Rw, true) => ("rw", "optional"),
        (Access::Wo, true) => ("wo", "RPDO"),
        (access @ (Access::Ro | Access::Const), true) => (access.name(), "TPDO"),
    };
    let mut attributes = vec_of([
        (
            "dataType",
            data_type.map_or_else(|| unknown_type(entry), |t| format!("{:04X}", t.code())),
        ),
        ("accessType", access.into()),
        ("PDOmapping", mapping.into()),
        ("defaultValue", text(&entry.default)),
        ("actualValue", text(&entry.parameter)),
        ("lowLimit", text(&entry.low)),
        ("highLimit", text(&entry.high)),
        ("objFlags", flags(entry.flags)),
    ]);
    let denotation = entry
        .extra
        .iter()
        .find(|(key, _)| key.eq_ignore_ascii_case("Denotation"));
    if let Some((_, denotation)) = denotation {
        attributes.push(("denotation", denotation.clone()));
    }
    if has_parameter(entry) {
        attributes.push(("uniqueIDRef", id(address)));
    }
    attributes
}

/// The hexadecimal digits of a type that odkit does not know, or its text; empty without one.
fn unknown_type(entry: &EntryDescription) -> String {
    let found = entry
        .extra
        .iter()
        .find(|(key, _)| key.eq_ignore_ascii_case("DataType"));
    let text = found.map_or("", |(_, text)| text.as_str());
    let number = crate::scan::number::number(text);
    let number = number.and_then(|number| u64::try_from(number).ok());
    // A text that is not a number is read again unchanged.
    number.map_or_else(|| text.into(), |number| format!("{number:04X}"))
}

fn flags(flags: u32) -> String {
    match flags {
        0 => String::new(),
        flags => format!("{flags:04X}"),
    }
}

fn id(address: Address) -> String {
    format!("UID_{:04X}{:02X}", address.index, address.sub)
}

/// A value of a section; empty if missing.
fn value(description: &Description, section: &str, key: &str) -> String {
    description
        .section(section)
        .map_or(String::new(), |section| text_of(section, key))
}

fn text_of(section: &Section, key: &str) -> String {
    section
        .get(key)
        .map_or(String::new(), |value| value.value.trim().into())
}

/// A number in the form of the schema (`xsd:unsignedByte` and others), which allows no hexadecimal
/// digits. Other texts stay.
fn decimal(text: String) -> String {
    match od_model::values::integer(&text) {
        Some(number) => number.to_string(),
        None => text,
    }
}

/// `07-14-2026` becomes `2026-07-14`; `None` for other texts.
fn date(text: &str) -> Option<String> {
    let parts: Vec<&str> = text.split('-').collect();
    let digits = |part: &str, len| part.len() == len && part.bytes().all(|b| b.is_ascii_digit());
    match parts[..] {
        [month, day, year] if digits(month, 2) && digits(day, 2) && digits(year, 4) => {
            Some(format!("{year}-{month}-{day}"))
        }
        _ => None,
    }
}

/// `02:05PM` becomes `14:05:00`; `None` for other texts.
fn time(text: &str) -> Option<String> {
    let (time, half) = text
        .trim()
        .split_at_checked(text.trim().len().checked_sub(2)?)?;
    let (hour, minute) = time.trim_end().split_once(':')?;
    let (hour, minute): (u8, u8) = (hour.parse().ok()?, minute.parse().ok()?);
    let noon = match half.to_ascii_uppercase().as_str() {
        "AM" => 0,
        "PM" => 12,
        _ => return None,
    };
    let fits = (1..=12).contains(&hour) && minute < 60;
    fits.then(|| format!("{:02}:{minute:02}:00", hour % 12 + noon))
}

#[cfg(test)]
mod tests;
