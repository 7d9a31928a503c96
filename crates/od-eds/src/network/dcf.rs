//! The DCF of a master.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use super::master::Master;
use super::node::Node;
use super::objects::{array, members, unsigned, value, var};
use super::partners::{self, applications, pdos};
use crate::description::{Description, Value};
use crate::span::Spanned;
use crate::write::describe::section;
use od_model::{Access, DataType, ObjectCode};

/// Returns the DCF of the master: it receives each TPDO of the nodes, and sends each of their RPDOs.
/// The writes are already in the values of the nodes ([`Node::apply`]). `remote` adds 5800h to 5FFFh, the PDOs of the
/// nodes: a driver of Lely core needs them to find a node's value in the PDOs of the master.
pub fn dcf(master: &Master, nodes: &[Node], remote: bool) -> Description {
    let mut made = Description::default();
    let [vendor, product, revision, serial] = master.identity;
    let text = |text: &str| text.to_string();
    let mut info = vec![
        (text("VendorNumber"), format!("0x{vendor:08X}")),
        (text("ProductNumber"), format!("0x{product:08X}")),
        (text("RevisionNumber"), format!("0x{revision:08X}")),
    ];
    for rate in [10, 20, 50, 125, 250, 500, 800, 1000] {
        info.push((format!("BaudRate_{rate}"), text("1")));
    }
    let flags = [
        ("SimpleBootUpMaster", "1"),
        ("SimpleBootUpSlave", "0"),
        ("Granularity", "1"),
    ];
    info.extend(flags.map(|(key, value)| (text(key), text(value))));
    info.push((text("LSS_Supported"), text("1")));
    let dummies = (1..=7).map(|code| (format!("Dummy{code:04}"), text("1")));
    made.sections = vec![section("DeviceInfo", info), section("DummyUsage", dummies)];
    made.commission("NodeID", &master.node_id.to_string());
    made.commission("Baudrate", &master.bit_rate.to_string());
    made.commission("NetNumber", "1");
    made.commission("CANopenManager", "1");
    made.commission("LSS_SerialNumber", &format!("0x{serial:08X}"));
    variables(&mut made, master);
    errors(&mut made, master, nodes);
    if master.consumes_heartbeat {
        heartbeats(&mut made, nodes);
    }
    identity(&mut made, master);
    let (received, sent) = (pdos(nodes, 0x1800), pdos(nodes, 0x1400));
    for (own, (first, application), what, access) in [
        (&received, (0x1400, 0x2000), "RPDO", Access::Rww),
        (&sent, (0x1800, 0x2200), "TPDO", Access::Rwr),
    ] {
        applications(&mut made, nodes, own, (first, application), what, access);
    }
    if remote {
        partners::remote(&mut made, nodes, &received, 0x5800, "TPDO");
        partners::remote(&mut made, nodes, &sent, 0x5C00, "RPDO");
    }
    slaves(&mut made, nodes);
    made
}

/// The objects of CiA 301 with one value.
fn variables(made: &mut Description, master: &Master) {
    use DataType::{Unsigned8, Unsigned16, Unsigned32};
    let rw = Access::Rw;
    for (index, name, data_type, access, default) in [
        (0x1000, "Device type", Unsigned32, Access::Ro, unsigned(0)),
        (0x1001, "Error register", Unsigned8, Access::Ro, None),
        (
            0x1005,
            "COB-ID SYNC message",
            Unsigned32,
            rw,
            unsigned(0x4000_0080),
        ),
        (
            0x1006,
            "Communication cycle period",
            Unsigned32,
            rw,
            unsigned(master.sync_period),
        ),
        (
            0x1007,
            "Synchronous window length",
            Unsigned32,
            rw,
            unsigned(master.sync_window),
        ),
        (
            0x1012,
            "COB-ID time stamp object",
            Unsigned32,
            rw,
            unsigned(master.time_cob_id),
        ),
        (0x1013, "High resolution time stamp", Unsigned32, rw, None),
        (
            0x1014,
            "COB-ID EMCY",
            Unsigned32,
            rw,
            Some(Value::NodeId(0x80)),
        ),
        (
            0x1015,
            "Inhibit time EMCY",
            Unsigned16,
            rw,
            unsigned(master.emcy_inhibit_time),
        ),
        (
            0x1017,
            "Producer heartbeat time",
            Unsigned16,
            rw,
            unsigned(master.heartbeat_producer),
        ),
        (
            0x1019,
            "Synchronous counter overflow value",
            Unsigned8,
            rw,
            unsigned(master.sync_overflow),
        ),
        (
            0x102A,
            "NMT inhibit time",
            Unsigned16,
            rw,
            unsigned(master.nmt_inhibit_time),
        ),
        (
            0x1F80,
            "NMT startup",
            Unsigned32,
            rw,
            unsigned(master.startup | 1),
        ),
        (
            0x1F89,
            "Boot time",
            Unsigned32,
            rw,
            unsigned(master.boot_time),
        ),
    ] {
        let mut entry = value(name, data_type, access, default);
        entry.mappable = Spanned::from(index == 0x1013);
        var(made, index, entry);
    }
}

/// The error history, the EMCY messages that the master receives, and its reaction to errors.
fn errors(made: &mut Description, master: &Master, nodes: &[Node]) {
    use DataType::{Unsigned8, Unsigned32};
    let history = ("Pre-defined error field", Unsigned32, Access::Ro);
    array(made, 0x1003, history, (254, 0), &[]);
    // The list of errors is empty; an application clears it by writing 0.
    if let Some(object) = made.objects.get_mut(&0x1003) {
        let count = value("Number of errors", Unsigned8, Access::Rw, unsigned(0));
        object.entries.insert(0, count);
    }
    let emcy = nodes.iter().filter(|node| node.has(0x1014));
    let emcy = emcy.map(|node| (node.id, node.number(0x1014, 0)));
    let emcy: Vec<_> = emcy.filter(|(_, cob_id)| cob_id >> 31 == 0).collect();
    let consumer = ("Emergency consumer object", Unsigned32, Access::Rw);
    array(made, 0x1028, consumer, (127, 1 << 31), &emcy);
    let behavior = ("Error behavior object", Unsigned8, Access::Rw);
    array(made, 0x1029, behavior, (254, 0), &master.error_behavior);
}

/// The heartbeats that the master monitors.
fn heartbeats(made: &mut Description, nodes: &[Node]) {
    let time = |node: &Node| match node.number(0x1017, 0) {
        0 => None,
        own => {
            let time = (f64::from(own) * node.heartbeat_multiplier) as u32;
            Some(u32::from(node.id) << 16 | time & 0xFFFF)
        }
    };
    let times: Vec<_> = (1..).zip(nodes.iter().filter_map(time)).collect();
    let object = ("Consumer heartbeat time", DataType::Unsigned32, Access::Rw);
    array(made, 0x1016, object, (127, 0), &times);
}

/// The identity of the master; its serial number is in [DeviceComissioning].
fn identity(made: &mut Description, master: &Master) {
    let names = [
        "Vendor-ID",
        "Product code",
        "Revision number",
        "Serial number",
    ];
    let numbers = (1..).zip(names.into_iter().zip(master.identity));
    let numbers = numbers.map(|(sub, (name, number))| {
        let default = unsigned(number).filter(|_| sub < 4);
        let entry = value(name, DataType::Unsigned32, Access::Ro, default);
        (sub, entry)
    });
    let object = ("Identity object", ObjectCode::Record);
    members(made, 0x1018, object, 4, numbers);
}

/// The objects of CiA 302-2: the list of nodes, and how the master starts them.
fn slaves(made: &mut Description, nodes: &[Node]) {
    use DataType::{Unsigned8, Unsigned32};
    let rw = Access::Rw;
    let all = |number: &dyn Fn(&Node) -> u32| -> Vec<(u8, u32)> {
        let numbers = nodes.iter().map(|node| (node.id, number(node)));
        numbers.filter(|(_, number)| *number != 0).collect()
    };
    let product = all(&|node| {
        if node.has_entry(0x1018, 2) {
            node.identity("ProductNumber", 2)
        } else {
            0
        }
    });
    for (index, name, data_type, access, numbers) in [
        (
            0x1F25,
            "Configuration request",
            Unsigned8,
            Access::Wo,
            Vec::new(),
        ),
        (
            0x1F55,
            "Expected software identification",
            Unsigned32,
            rw,
            Vec::new(),
        ),
        (
            0x1F81,
            "NMT slave assignment",
            Unsigned32,
            rw,
            all(&|node| node.assignment),
        ),
        (0x1F82, "Request NMT", Unsigned8, rw, Vec::new()),
        (
            0x1F84,
            "Device type identification",
            Unsigned32,
            rw,
            all(&|node| node.number(0x1000, 0)),
        ),
        (
            0x1F85,
            "Vendor identification",
            Unsigned32,
            rw,
            all(&|node| node.identity("VendorNumber", 1)),
        ),
        (0x1F86, "Product code", Unsigned32, rw, product),
        (0x1F87, "Revision number", Unsigned32, rw, Vec::new()),
        (0x1F88, "Serial number", Unsigned32, rw, Vec::new()),
        (
            0x1F8A,
            "Restore configuration",
            Unsigned8,
            rw,
            all(&|node| node.software.2.into()),
        ),
    ] {
        array(made, index, (name, data_type, access), (127, 0), &numbers);
    }
    for (index, name, file) in [
        (
            0x1F22,
            "Concise DCF",
            (|node| &node.configuration_file) as fn(&Node) -> &String,
        ),
        (0x1F58, "Program data", |node| &node.software.0),
    ] {
        if nodes.iter().all(|node| file(node).is_empty()) {
            continue;
        }
        let files = (1..=127).map(|id| {
            let mut entry = value(format!("Node ID {id}"), DataType::Domain, Access::Ro, None);
            let node = nodes
                .iter()
                .find(|node| node.id == id && !file(node).is_empty());
            let file = node.map(|node| ("UploadFile".to_string(), file(node).clone()));
            entry.extra.extend(file);
            (id, entry)
        });
        members(made, index, (name, ObjectCode::Array), 127, files);
    }
}
