//! Elements of a device besides its objects: versions of DeviceIdentity, characteristics.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::xml::{Xml, escape};
use crate::description::{Description, Value};
use crate::subject::start_value;
use crate::xdd::info::{COMMENTS, REVISION};
use od_model::Address;

/// Writes the versions from 1009h and 100Ah.
pub(super) fn versions(out: &mut Xml, description: &Description) {
    for (kind, index) in [("HW", 0x1009), ("SW", 0x100A)] {
        let entry = description.entry(Address::new(index, 0));
        if let Some(Value::Text(text)) = entry.and_then(start_value).map(|value| &value.value) {
            out.0.push_str(&format!(
                "{}<version versionType=\"{kind}\">{}</version>\n",
                out.indent(),
                escape(text)
            ));
        }
    }
}

/// Writes DeviceFunction: the profile of the device, and content for which XML has no other place.
pub(super) fn function(out: &mut Xml, description: &Description) {
    let mut all: Vec<(&str, Vec<String>)> = Vec::new();
    let device_type = description.entry(Address::new(0x1000, 0));
    if let Some(Value::Unsigned(number)) =
        device_type.and_then(start_value).map(|value| &value.value)
        && number & 0xFFFF != 0
    {
        let profile = alloc::vec![format!("CiA {}", number & 0xFFFF)];
        all.push(("Device profile", profile));
    }
    let info = description.section("FileInfo");
    if let Some(revision) = info.and_then(|info| info.get("FileRevision"))
        && !revision.is_empty()
    {
        all.push((REVISION, alloc::vec![revision.value.clone()]));
    }
    if let Some(section) = description.section("Comments") {
        let lines = section.pairs.iter();
        let lines = lines.filter(|(key, _)| !key.eq_ignore_ascii_case("Lines"));
        let lines: Vec<String> = lines.map(|(_, text)| text.value.clone()).collect();
        if !lines.is_empty() {
            all.push((COMMENTS, lines));
        }
    }
    if all.is_empty() {
        return;
    }
    out.element("DeviceFunction", &[], |out| {
        out.element("capabilities", &[], |out| {
            out.element("characteristicsList", &[], |out| {
                for (name, contents) in all {
                    out.element("characteristic", &[], |out| {
                        label(out, "characteristicName", name);
                        for content in contents {
                            label(out, "characteristicContent", &content);
                        }
                    });
                }
            });
        });
    });
}

fn label(out: &mut Xml, element: &str, text: &str) {
    out.element(element, &[], |out| {
        let label = format!(
            "{}<label lang=\"en\">{}</label>\n",
            out.indent(),
            escape(text)
        );
        out.0.push_str(&label);
    });
}
