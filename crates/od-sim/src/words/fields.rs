//! Splits the bytes of a frame into fields.

use std::prelude::v1::*;
use std::string::ToString;

use od_client::pdo;
use od_model::{Address, values};
use od_wire::nmt::State;
use od_wire::sdo::{Request, Response, expedited_len};
use od_wire::{Frame, emcy, nmt};

use super::description::bytes;
use super::pdo::{Part, parts};
use super::tag::{TAGS, object_of_request, object_of_response, tag};
use super::value;
use crate::device::VirtualDevice;

/// A field of a frame.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Field {
    /// The first byte.
    pub from: u8,
    /// The byte after the last.
    pub to: u8,
    /// Name: `Index`, `Position value`.
    pub name: String,
    /// Value in words.
    pub value: String,
    /// Its object.
    pub object: Option<Address>,
}

/// Returns the fields of a frame, with object names of its device. A remote frame or a service
/// without fields has none.
pub fn fields(devices: &[VirtualDevice], frame: &Frame) -> Vec<Field> {
    let mut fields = Fields {
        len: frame.data().len(),
        all: Vec::new(),
    };
    if frame.is_remote() {
        return fields.all;
    }
    let tag = tag(frame);
    let device = devices.iter().find(|one| one.node_id().raw() == tag.node);
    let data = frame.data();
    if let Some((device, parts)) = parts(devices, frame) {
        mapped(&mut fields, device, frame, &parts);
        return fields.all;
    }
    match TAGS[usize::from(tag.tag)] {
        "NMT" => {
            let repr = nmt::Repr::parse(data);
            let command = repr.map_or("unknown", |repr| match repr.command {
                nmt::Command::Start => "Start",
                nmt::Command::Stop => "Stop",
                nmt::Command::EnterPreOperational => "Enter Pre-operational",
                nmt::Command::ResetNode => "Reset node",
                nmt::Command::ResetCommunication => "Reset communication",
            });
            fields.add(0, 1, "Command", command);
            let node = match tag.node {
                0 => "all".into(),
                node => node.to_string(),
            };
            fields.add(1, 2, "Node", node);
        }
        "HB" => {
            let byte = data.first().copied().unwrap_or_default();
            let state = match byte & 0x7F {
                0 => "boot-up".into(),
                code => State::from_code(code).map_or("unknown".into(), |state| state.to_string()),
            };
            let toggle = if byte & 0x80 != 0 {
                ", toggle bit 1"
            } else {
                ""
            };
            fields.add(0, 1, "State", format!("{state}{toggle}"));
        }
        "EMCY" => {
            if let Some(repr) = emcy::Emcy::parse(data) {
                fields.add(0, 2, "Error code", format!("{:04X}h", repr.code));
                let register = format!("{:02X}h", repr.register);
                let object = Address::new(0x1001, 0);
                fields.about(2, 3, "Error register 1001h", register, object);
                fields.add(3, 8, "Manufacturer-specific", values::hex(&repr.info));
            }
        }
        "SDO" => sdo(&mut fields, device, frame),
        "LSS" => {
            let command = data.first().copied().unwrap_or_default();
            fields.add(0, 1, "Command", format!("{command} ({command:02X}h)"));
            let value = number(data.get(1..).unwrap_or_default(), 4);
            fields.add(1, 5, "Value", format!("{value} ({value:08X}h)"));
        }
        "SYNC" => fields.add(0, 1, "Counter", number(data, 1).to_string()),
        _ => {}
    }
    fields.all
}

/// Adds fields to a frame; fields after the end of its data are left out.
struct Fields {
    len: usize,
    all: Vec<Field>,
}

impl Fields {
    fn add(&mut self, from: usize, to: usize, name: &str, value: impl Into<String>) {
        self.push(from, to, name.into(), value.into(), None);
    }

    fn about(&mut self, from: usize, to: usize, name: &str, value: String, object: Address) {
        self.push(from, to, name.into(), value, Some(object));
    }

    fn push(
        &mut self,
        from: usize,
        to: usize,
        name: String,
        value: String,
        object: Option<Address>,
    ) {
        if from < self.len {
            self.all.push(Field {
                from: from as u8,
                to: to.min(self.len) as u8,
                name,
                value,
                object,
            });
        }
    }
}

/// Up to `len` bytes as a number, low byte first.
fn number(data: &[u8], len: usize) -> u64 {
    let bytes = data.iter().take(len.min(8)).rev();
    bytes.fold(0, |value, byte| value << 8 | u64::from(*byte))
}

/// The objects of a PDO by its current mapping.
fn mapped(fields: &mut Fields, device: &VirtualDevice, frame: &Frame, parts: &[Part]) {
    let (dictionary, data) = (device.dictionary(), frame.data());
    for (address, first, bits) in parts {
        let (from, to) = (*first as usize / 8, (first + bits).div_ceil(8) as usize);
        if data.len() < to {
            break;
        }
        // A mapped object has bits, which may begin anywhere.
        let value = pdo::bits(data, *first as u8, *bits as u8).unwrap_or_default();
        let value = value.to_le_bytes();
        let bytes = &value[..bits.div_ceil(8) as usize];
        let (name, value) = match dictionary.find(*address) {
            Ok(entry) => (
                dictionary.text(entry.name).to_owned(),
                value::show_mapped(device, *address, entry.data_type, bytes, *bits as u8),
            ),
            Err(_) => (address.to_string(), values::hex(bytes)),
        };
        fields.push(from, to, name, value, Some(*address));
    }
}

/// Adds the command, object and data of an SDO frame.
fn sdo(fields: &mut Fields, device: Option<&VirtualDevice>, frame: &Frame) {
    let is_response = frame.id().raw() < 0x600;
    let (command, object, expedited, size) = if is_response {
        let response = Response::parse(frame.bytes());
        let (expedited, size) = match response {
            Response::InitiateUpload {
                expedited, size, ..
            } => (expedited, size),
            _ => (None, None),
        };
        (
            response_name(&response),
            object_of_response(&response),
            expedited,
            size,
        )
    } else {
        let request = Request::parse(frame.bytes());
        let (expedited, size) = match request {
            Request::InitiateDownload {
                expedited, size, ..
            } => (expedited, size),
            _ => (None, None),
        };
        (
            request_name(&request),
            object_of_request(&request),
            expedited,
            size,
        )
    };
    fields.add(0, 1, "Command", command);
    let Some(object) = object else {
        let rest = frame.data().get(1..).unwrap_or_default();
        fields.add(1, 8, "Data", values::hex(rest));
        return;
    };
    let dictionary = device.map(VirtualDevice::dictionary);
    let entry = dictionary.and_then(|dictionary| dictionary.find(object).ok());
    let record = dictionary.and_then(|dictionary| dictionary.object(object.index));
    let name = |range| dictionary.map_or("", |dictionary| dictionary.text(range));
    let of_object = record.map_or("", |record| name(record.name));
    let index = format!("{:04X}h {of_object}", object.index);
    fields.about(1, 3, "Index", index.trim_end().into(), object);
    let has_members = record.is_some_and(|record| record.code.has_members());
    let of_entry = entry
        .filter(|_| has_members)
        .map_or("", |entry| name(entry.name));
    let sub = format!("{} {of_entry}", object.sub);
    fields.about(3, 4, "Sub-index", sub.trim_end().into(), object);
    if frame.bytes()[0] == 0x80 {
        let code = number(&frame.bytes()[4..], 4);
        fields.add(4, 8, "Abort code", format!("{code:08X}h"));
    } else if let Some(data) = expedited {
        let len = expedited_len(size, entry.and_then(|entry| entry.data_type.size()));
        let value = match (device, entry) {
            (Some(device), Some(entry)) => {
                value::show(device, object, entry.data_type, &data[..len])
            }
            _ => values::hex(&data[..len]),
        };
        fields.about(4, 4 + len, "Data", value, object);
    } else if let Some(size) = size {
        fields.add(4, 8, "Length", bytes(size as usize));
    }
}

fn request_name(request: &Request) -> &'static str {
    match request {
        Request::InitiateDownload { .. } => "Initiate download",
        Request::DownloadSegment { .. } => "Download segment",
        Request::InitiateUpload { .. } => "Initiate upload",
        Request::UploadSegment { .. } => "Upload segment",
        Request::Abort { .. } => "Abort",
        Request::InitiateBlockUpload { .. }
        | Request::StartBlockUpload
        | Request::BlockUploadResponse { .. }
        | Request::EndBlockUpload => "Block upload",
        Request::InitiateBlockDownload { .. } | Request::EndBlockDownload { .. } => {
            "Block download"
        }
        Request::Unknown => "Unknown",
    }
}

fn response_name(response: &Response) -> &'static str {
    match response {
        Response::InitiateDownload { .. } => "Initiate download",
        Response::DownloadSegment { .. } => "Download segment",
        Response::InitiateUpload { .. } => "Initiate upload",
        Response::UploadSegment { .. } => "Upload segment",
        Response::Abort { .. } => "Abort",
        Response::InitiateBlockUpload { .. } | Response::EndBlockUpload { .. } => "Block upload",
        Response::InitiateBlockDownload { .. }
        | Response::BlockDownloadResponse { .. }
        | Response::EndBlockDownload => "Block download",
        Response::Unknown => "Unknown",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bus::Bus;
    use crate::logs::candump::parse_frame;
    use od_runtime::NodeId;

    #[track_caller]
    fn check(text: &str, expected: &[&str]) {
        let kind = od_devices::find("gxmm").expect("it is built in");
        let mut bus = Bus::new();
        bus.add(VirtualDevice::new(kind, NodeId::ONE));
        bus.set_power(0, true);
        let frame = parse_frame(text).expect(text);
        let shown = fields(bus.devices(), &frame).into_iter().map(|field| {
            let object = field.object.map(|object| format!(" @{object}"));
            let Field {
                from,
                to,
                name,
                value,
                ..
            } = field;
            format!("{from}-{to} {name}: {value}{}", object.unwrap_or_default())
        });
        assert_eq!(shown.collect::<Vec<_>>(), expected, "{text}");
    }

    #[test]
    fn every_byte_has_a_name() {
        check("000#0101", &["0-1 Command: Start", "1-2 Node: 1"]);
        check(
            "000#8000",
            &["0-1 Command: Enter Pre-operational", "1-2 Node: all"],
        );
        check("701#00", &["0-1 State: boot-up"]);
        check("701#85", &["0-1 State: Operational, toggle bit 1"]);
        check("080#07", &["0-1 Counter: 7"]);
        check("701#R1", &[]);
        check(
            "7E5#1105000000000000",
            &["0-1 Command: 17 (11h)", "1-5 Value: 5 (00000005h)"],
        );
        check(
            "601#2B17100064000000",
            &[
                "0-1 Command: Initiate download",
                "1-3 Index: 1017h Producer heartbeat time @1017h:00",
                "3-4 Sub-index: 0 @1017h:00",
                "4-6 Data: 100 (64h) @1017h:00",
            ],
        );
        check(
            "581#8000100002000106",
            &[
                "0-1 Command: Abort",
                "1-3 Index: 1000h Device type @1000h:00",
                "3-4 Sub-index: 0 @1000h:00",
                "4-8 Abort code: 06010002h",
            ],
        );
        check(
            "601#6000000000000000",
            &[
                "0-1 Command: Upload segment",
                "1-8 Data: 00 00 00 00 00 00 00",
            ],
        );
        check("181#05000000", &["0-4 Position value: 5 @6004h:00"]);
    }

    #[test]
    fn each_mapped_object_has_its_own_bits() {
        let kind = od_devices::find("gxmm").expect("it is built in");
        let device = VirtualDevice::new(kind, NodeId::ONE);
        let register = Address::new(0x1800, 2);
        let frame = parse_frame("181#0AFF").expect("a frame");
        let mut fields = Fields {
            len: 2,
            all: Vec::new(),
        };
        let parts = [(register, 0, 1), (register, 1, 3), (register, 4, 8)];
        mapped(&mut fields, &device, &frame, &parts);
        let values = fields.all.into_iter().map(|field| field.value);
        assert_eq!(values.collect::<Vec<_>>(), ["0", "5", "240 (F0h)"]);
    }
}
