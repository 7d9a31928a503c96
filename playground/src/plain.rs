//! The description of a node without an EDS: the objects of CiA 301 that any node may have.

use std::fmt::Write;

use od_eds::outline::{data_type, specified};
use od_model::DataType;
use wasm_bindgen::prelude::*;

/// Returns an EDS for an unknown node: objects that any node may have, with four PDOs each way.
#[wasm_bindgen(js_name = plainEds)]
pub fn plain_eds(name: &str) -> String {
    let mut objects = Vec::new();
    communication(&mut objects);
    for (kind, parameter, mapping, base) in
        [('R', 0x1400, 0x1600, 0x200), ('T', 0x1800, 0x1A00, 0x180)]
    {
        for number in 0..4 {
            let base = base + 0x100 * u32::from(number);
            pdo(&mut objects, kind, number, parameter, mapping, base);
        }
    }
    let name = name.replace(['\r', '\n'], " ");
    let mut text = format!(
        "[DeviceInfo]\nVendorName=\nProductName={name}\nNrOfRXPDO=4\nNrOfTXPDO=4\n\n{}\n{}\n{}",
        list("MandatoryObjects", &objects, is_mandatory),
        list("OptionalObjects", &objects, |index| !is_mandatory(index)),
        list("ManufacturerObjects", &objects, |_| false),
    );
    for object in &objects {
        text.push('\n');
        text.push_str(&object.text);
    }
    text
}

/// An object, and its sections.
struct Object {
    index: u16,
    text: String,
}

impl Object {
    /// A VAR with name, type and access of CiA 301.
    fn standard(index: u16, value: &str) -> Self {
        let found = specified(index);
        let name = found.as_ref().map_or("", |found| found.name);
        let (first, rest) = name.split_at(name.len().min(1));
        let name = first.to_uppercase() + rest;
        let data_type = data_type(index, 0, true).unwrap_or(DataType::Unsigned32);
        let access = found.map_or("ro", |found| found.access.name());
        let text = section(&format!("{index:X}"), &name, data_type, access, value);
        Self { index, text }
    }

    /// A record; its sub-objects are counted from sub-index 0.
    fn record(index: u16, name: &str, members: &[(String, DataType, &str, String)]) -> Self {
        let count = members.len();
        let mut text =
            format!("[{index:X}]\nParameterName={name}\nObjectType=0x9\nSubNumber={count}\n");
        for (sub, (name, data_type, access, value)) in members.iter().enumerate() {
            let place = format!("{index:X}sub{sub:X}");
            text.push('\n');
            text.push_str(&section(&place, name, *data_type, access, value));
        }
        Self { index, text }
    }
}

fn section(place: &str, name: &str, data_type: DataType, access: &str, value: &str) -> String {
    let code = data_type.code();
    format!(
        "[{place}]\nParameterName={name}\nObjectType=0x7\nDataType=0x{code:04X}\nAccessType={access}\n\
         DefaultValue={value}\nPDOMapping=0\n"
    )
}

fn communication(objects: &mut Vec<Object>) {
    let identity = [
        "Highest sub-index",
        "Vendor-ID",
        "Product code",
        "Revision number",
        "Serial number",
    ];
    let identity = (0..).zip(identity).map(|(sub, name)| {
        let data_type = data_type(0x1018, sub, false).unwrap_or(DataType::Unsigned32);
        let value = if sub == 0 { "4" } else { "0" };
        (name.into(), data_type, "ro", value.into())
    });
    let identity: Vec<_> = identity.collect();
    objects.extend([
        Object::standard(0x1000, "0"),
        Object::standard(0x1001, "0"),
        Object::record(0x1018, "Identity object", &identity),
    ]);
    for (index, value) in [
        (0x1002, "0"),
        (0x1005, "0x80"),
        (0x1014, "$NODEID+0x80"),
        (0x1017, "0"),
        (0x1008, ""),
        (0x1009, ""),
        (0x100A, ""),
    ] {
        objects.push(Object::standard(index, value));
    }
}

fn pdo(
    objects: &mut Vec<Object>,
    kind: char,
    number: u16,
    parameter: u16,
    mapping: u16,
    base: u32,
) {
    use DataType::{Unsigned8, Unsigned32};
    let rw = |name: String, data_type, value: String| (name, data_type, "rw", value);
    let highest = (
        "Highest sub-index".into(),
        Unsigned8,
        "ro",
        String::from("2"),
    );
    let parameters = [
        highest,
        rw("COB-ID".into(), Unsigned32, format!("$NODEID+0x{base:X}")),
        rw("Transmission type".into(), Unsigned8, "255".into()),
    ];
    let mut mapped = vec![rw("Number of mapped objects".into(), Unsigned8, "0".into())];
    mapped.extend((1..=8).map(|sub| rw(format!("Mapped object {sub}"), Unsigned32, "0".into())));
    let name = |what| format!("{kind}PDO{} {what} parameter", number + 1);
    objects.push(Object::record(
        parameter + number,
        &name("communication"),
        &parameters,
    ));
    objects.push(Object::record(mapping + number, &name("mapping"), &mapped));
}

const fn is_mandatory(index: u16) -> bool {
    matches!(index, 0x1000 | 0x1001 | 0x1018)
}

/// A list of objects in the format of CiA 306.
fn list(name: &str, objects: &[Object], belongs: impl Fn(u16) -> bool) -> String {
    let indices = objects.iter().map(|object| object.index);
    let indices: Vec<_> = indices.filter(|index| belongs(*index)).collect();
    let mut text = format!("[{name}]\nSupportedObjects={}\n", indices.len());
    for (place, index) in indices.iter().enumerate() {
        let _ = writeln!(text, "{}=0x{index:X}", place + 1);
    }
    text
}

#[cfg(test)]
mod tests {
    use od_eds::Severity;

    use super::plain_eds;

    #[test]
    fn an_unknown_node_has_a_valid_description() {
        let parsed = od_eds::load(&plain_eds("A\nname"));
        // Nothing is known of the device: the keys of [DeviceInfo] and [FileInfo] are missing.
        let errors = parsed.findings.iter();
        let errors: Vec<_> = errors
            .filter(|one| one.rule.severity == Severity::Error)
            .map(|one| one.rule.code)
            .collect();
        assert_eq!(errors, [""; 0]);
        assert_eq!(parsed.description.objects.len(), 26);
        let info = parsed.description.section("DeviceInfo");
        let name = info.and_then(|info| info.get("ProductName"));
        assert_eq!(name.map(|name| name.value.as_str()), Some("A name"));
    }
}
