//! COB-IDs from anywhere: the defaults of a dictionary, saved values, a master by SDO or RPDO, the application, with any
//! node ID, also one that LSS changes. No node sends
//! by a restricted CAN-ID but by the service that owns it, nor two services by one CAN-ID (CiA 301, table 40).

use std::collections::BTreeMap;
use std::fmt::Write as _;

use od_model::Address;
use od_runtime::storage::{Memory, image};
use od_runtime::{CanId, Frame, NodeId, Profile, Store};
use od_sim::{Bus, EdsOptions, VirtualDevice};

use crate::choices::Choices;
use crate::harness::trace;
use crate::random::Random;
use crate::sent::owner;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "cob_ids",
    run,
    seeds: || vec![(0..=255).collect()],
    make: Some(make),
    ..Target::PLAIN
};

fn make(random: &mut Random) -> Vec<u8> {
    (0..random.size(9)).map(|_| random.next() as u8).collect()
}

/// TPDOs, each with a value of its own.
const TPDOS: u16 = 3;

/// The objects with a COB-ID, and their value where nothing is wrong.
const COB_IDS: [(u16, u8, u32, bool); 12] = [
    (0x1005, 0, 0x4000_0080, false),
    (0x1012, 0, 0x4000_0100, false),
    (0x1014, 0, 0x80, true),
    (0x1200, 1, 0x600, true),
    (0x1200, 2, 0x580, true),
    (0x1201, 1, 0x8000_0000, false),
    (0x1201, 2, 0x8000_0000, false),
    (0x1400, 1, 0x200, true),
    (0x1401, 1, 0x300, true),
    (0x1800, 1, 0x180, true),
    (0x1801, 1, 0x280, true),
    (0x1802, 1, 0x380, true),
];

/// A COB-ID that is wrong more often than chance would have it; `true`: the node ID is added.
fn cob_id(choices: &mut Choices<'_>) -> (u32, bool) {
    let id = match choices.below(34) {
        33 => choices.number() as u32,
        at => [
            0x000,
            0x001,
            0x07F,
            0x080,
            0x0FF,
            0x100,
            0x101,
            0x180,
            0x181,
            0x200,
            0x201,
            0x57F,
            0x580,
            0x581,
            0x5FF,
            0x600,
            0x601,
            0x67F,
            0x680,
            0x6A0,
            0x6DF,
            0x6E0,
            0x6FF,
            0x700,
            0x701,
            0x780,
            0x790,
            0x7E4,
            0x7E5,
            0x7FF,
            0x800,
            0x1_0181,
            0x1FFF_FFFF,
        ][at],
    };
    let flags = choices.pick(&[0, 0, 0, 1 << 29, 1 << 30, 3 << 29, 1 << 31, 7 << 29]);
    (id | flags, choices.once_in(2))
}

/// A device with every service that has a COB-ID; TPDO n carries the number n, and an RPDO the value at `mapped`.
fn eds(mapped: (u16, u8), choices: &mut Choices<'_>) -> String {
    let mut objects: BTreeMap<(u16, u8), (u16, &str, String)> = BTreeMap::new();
    let mut put = |index, sub, data_type, access, default: String| {
        objects.insert((index, sub), (data_type, access, default));
    };
    put(0x1000, 0, 7, "const", "0".into());
    put(0x1001, 0, 5, "ro", "0".into());
    put(0x1006, 0, 7, "rw", "10000".into());
    put(0x1010, 0, 5, "const", "1".into());
    put(0x1010, 1, 7, "rw", "1".into());
    put(0x1017, 0, 6, "rw", "50".into());
    put(0x1018, 0, 5, "const", "1".into());
    put(0x1018, 1, 7, "ro", "0x5F".into());
    put(0x1200, 0, 5, "const", "2".into());
    put(0x1201, 0, 5, "const", "2".into());
    // The second RPDO writes a COB-ID.
    for (rpdo, (index, sub)) in (0..2).zip([(0x2010, 0), mapped]) {
        let entry = format!("0x{index:04X}{sub:02X}20");
        put(0x1400 + rpdo, 0, 5, "const", "2".into());
        put(0x1400 + rpdo, 2, 5, "rw", "255".into());
        put(0x1600 + rpdo, 0, 5, "const", "1".into());
        put(0x1600 + rpdo, 1, 7, "const", entry);
    }
    for tpdo in 0..TPDOS {
        let kind = choices.pick(&[1, 253, 254, 255]);
        put(0x1800 + tpdo, 0, 5, "const", "5".into());
        put(0x1800 + tpdo, 2, 5, "rw", kind.to_string());
        put(0x1800 + tpdo, 5, 6, "rw", "5".into());
        put(0x1A00 + tpdo, 0, 5, "const", "1".into());
        put(
            0x1A00 + tpdo,
            1,
            7,
            "const",
            format!("0x{:X}0020", 0x2000 + tpdo),
        );
        put(0x2000 + tpdo, 0, 7, "ro", tpdo.to_string());
    }
    put(0x2010, 0, 7, "rw", "0".into());
    for (index, sub, usual, with_node) in COB_IDS {
        let (id, with_node) = if choices.once_in(4) {
            (usual, with_node)
        } else {
            cob_id(choices)
        };
        let node = if with_node { "$NODEID+" } else { "" };
        put(index, sub, 7, "rw", format!("{node}0x{id:X}"));
    }
    let mut text =
        String::from("[DeviceInfo]\nProductName=COB-IDs\nLSS_Supported=1\nBaudRate_125=1\n");
    for ((index, sub), (data_type, access, default)) in &objects {
        let is_record = objects.contains_key(&(*index, 1));
        if is_record && *sub == 0 {
            let members = objects.range((*index, 0)..=(*index, u8::MAX)).count();
            let _ = write!(
                text,
                "\n[{index:X}]\nParameterName=Object\nObjectType=9\nSubNumber={members}\n"
            );
        }
        let member = if is_record {
            format!("sub{sub:X}")
        } else {
            String::new()
        };
        let mappable = u8::from(*index >= 0x2000 || mapped == (*index, *sub));
        let _ = write!(
            text,
            "\n[{index:X}{member}]\nParameterName=Value {sub}\nDataType={data_type}\nAccessType={access}\n\
             DefaultValue={default}\nPDOMapping={mappable}\n"
        );
    }
    text
}

/// An EEPROM with saved COB-IDs, as another firmware of the same device could have left it.
fn saved(device: &VirtualDevice, node: NodeId, choices: &mut Choices<'_>) -> Vec<u8> {
    let dictionary = device.dictionary();
    let mut values = vec![0; dictionary.store_len()];
    let mut memory = Memory::new(vec![0xFF; device.storage_needed()]);
    let mut store = Store::new(&dictionary, &mut values, node).expect("the values have room");
    store.reset(|_| true);
    for (index, sub, ..) in COB_IDS {
        if choices.once_in(2) {
            let (id, with_node) = cob_id(choices);
            let id = id.wrapping_add(u32::from(node.raw()) * u32::from(with_node));
            store.set_unsigned(Address::new(index, sub), id.into());
        }
    }
    image::save(&mut memory, &store, &Profile::CIA301.store, 1).expect("the values fit");
    memory.into_inner()
}

fn run(input: &[u8]) {
    let mut choices = Choices(input);
    let (index, sub, ..) = choices.pick(&COB_IDS);
    let text = eds((index, sub), &mut choices);
    trace(|| text.clone());
    let node = NodeId::new(1 + choices.below(127) as u8).unwrap_or(NodeId::ONE);
    let options = EdsOptions {
        node_id: Some(node),
        lenient: true,
    };
    let mut device = VirtualDevice::from_eds(&text, options).expect("a lenient device");
    if choices.once_in(2) {
        let bytes = saved(&device, node, &mut choices);
        device.set_eeprom(&bytes);
    }
    let mut bus = Bus::new();
    bus.add(device);
    bus.start(0);
    let mut seen = Seen {
        bus,
        node,
        owners: BTreeMap::new(),
    };
    seen.listen(0);
    seen.send(&Frame::standard(0, &[1, node.raw()]));
    seen.talk(&mut choices);
    for _ in 0..choices.below(6) {
        seen.change(&mut choices);
        seen.talk(&mut choices);
    }
}

/// A bus on which it is seen what the device sends.
struct Seen {
    bus: Bus,
    node: NodeId,
    /// The service that sends by each CAN-ID.
    owners: BTreeMap<(bool, u32), String>,
}

impl Seen {
    fn send(&mut self, frame: &Frame) {
        trace(|| format!("> {frame}"));
        self.bus.receive(frame);
        self.listen(0);
    }

    /// Lets milliseconds pass, and checks what is sent.
    fn listen(&mut self, millis: u64) {
        self.bus.advance(self.bus.now().plus_millis(millis));
        while let Some(sent) = self.bus.poll() {
            trace(|| format!("< {}", sent.frame));
            let (id, service) = (sent.frame.id(), service(self.node, &sent.frame));
            let owner = self.owners.entry((id.is_extended(), id.raw()));
            let owner = owner.or_insert_with(|| service.clone());
            assert_eq!(
                *owner,
                service,
                "both send by {}: node {}, {}",
                id.raw(),
                self.node,
                sent.frame
            );
        }
    }

    /// Everything that makes a service send.
    fn talk(&mut self, choices: &mut Choices<'_>) {
        let own = u16::from(self.node.raw());
        self.bus.with(0, |device, now| {
            // No EMCY producer, or the error is there already.
            let _ = device.raise_error(0x5000, 0x81, Some([0xEE; 5]), now);
        });
        self.send(&Frame::standard(0x80, &[]));
        for server in [0x600 + own, 0x680, 0x6A0, 0x6DF, 0x101] {
            self.send(&Frame::standard(server, &[0x40, 0, 0x10, 0, 0, 0, 0, 0]));
        }
        let ids: Vec<(bool, u32)> = self.owners.keys().copied().collect();
        let others = [0x180, 0x280, 0x380].map(|base| (false, u32::from(base + own)));
        for (is_extended, id) in ids.into_iter().chain(others) {
            let id = if is_extended {
                CanId::extended(id)
            } else {
                CanId::standard(id as u16)
            };
            // A TPDO is requested; and an RPDO is too short (8210h).
            self.send(&Frame::remote(id, 4).expect("4 bytes at most"));
        }
        self.send(&Frame::standard(0x200 + own, &[1]));
        self.bus.with(0, |device, now| {
            let _ = device.clear_error(0x5000, now);
        });
        self.listen(choices.pick(&[1, 20, 60, 1100]));
    }

    /// A master or the application writes a COB-ID, which the node may refuse, or LSS changes the node ID; services may
    /// change their CAN-IDs.
    fn change(&mut self, choices: &mut Choices<'_>) {
        let own = u16::from(self.node.raw());
        let (index, sub, ..) = choices.pick(&COB_IDS);
        let (id, with_node) = cob_id(choices);
        let id = id.wrapping_add(u32::from(own) * u32::from(with_node));
        let ([low, high], [a, b, c, d]) = (index.to_le_bytes(), id.to_le_bytes());
        self.owners.clear();
        match choices.below(8) {
            0..=3 => {
                let request = [0x23, low, high, sub, a, b, c, d];
                self.send(&Frame::standard(0x600 + own, &request));
            }
            4 => self.send(&Frame::standard(0x300 + own, &[a, b, c, d])),
            5 => {
                trace(|| format!("application: {index:04X}h:{sub:02X} = {id:X}"));
                self.bus.with(0, |device, now| {
                    let _ = device.set_value(Address::new(index, sub), &[a, b, c, d], now);
                });
            }
            _ => self.move_to(1 + choices.below(127) as u8),
        }
        self.listen(0);
        self.owners.clear();
    }

    /// LSS gives the node another node ID, which it has from the next reset on.
    fn move_to(&mut self, node: u8) {
        for command in [[0x04, 1], [0x11, node], [0x04, 0]] {
            let [first, second] = command;
            self.send(&Frame::standard(0x7E5, &[first, second, 0, 0, 0, 0, 0, 0]));
        }
        if let Some(node) = NodeId::new(node) {
            self.node = node;
        }
        self.send(&Frame::standard(0, &[0x82, 0]));
        self.listen(10);
        let is = self.bus.with(0, |device, _| device.node_id());
        assert_eq!(is, Some(self.node), "LSS sets the node ID");
        self.send(&Frame::standard(0, &[1, 0]));
    }
}

/// The service that sent a frame, by its CAN-ID or, where that can be any, by its data.
fn service(node: NodeId, frame: &Frame) -> String {
    if let Some(owner) = owner(node, frame) {
        return owner.into();
    }
    assert!(!frame.is_remote(), "node {node} sends {frame}");
    match *frame.data() {
        [] => "SYNC".into(),
        [number, 0, 0, 0] if u16::from(number) < TPDOS => format!("TPDO {}", number + 1),
        [_, _, _, _, _, _] => "TIME".into(),
        [0x43 | 0x4B | 0x4F | 0x80, 0, 0x10, ..] => "SDO server 2".into(),
        [_, _, _, _, _, _, _, _] => "EMCY".into(),
        _ => panic!("node {node} sends {frame}"),
    }
}
