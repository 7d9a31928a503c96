//! Bytes as events of a device: frames that are valid more often than random ones,
//! time, power, and inputs of the application.

use od_devices::DEVICES;
use od_model::Entry;
use od_runtime::{BusEvent, CanId, Frame, NodeId};
use od_sim::{EdsOptions, VirtualDevice};

/// Bytes of one step.
pub(super) const STEP: usize = 10;

/// Number of devices to choose from.
pub(super) fn kinds() -> usize {
    DEVICES.len() + FILES.len()
}

/// Devices of CiA 301: block transfers, RPDOs, strings and DOMAINs.
const FILES: [&str; 2] = [
    include_str!("../../../interop/strings.eds"),
    include_str!("../../../eds/small.eds"),
];

/// A device without power.
pub(super) fn device(number: usize) -> VirtualDevice {
    match DEVICES.get(number % kinds()) {
        Some(kind) => VirtualDevice::new(kind, NodeId::ONE),
        None => {
            let options = EdsOptions {
                node_id: Some(NodeId::ONE),
                lenient: true,
            };
            let text = FILES[number % kinds() - DEVICES.len()];
            VirtualDevice::from_eds(text, options).expect("an EDS of the project runs")
        }
    }
}

/// The device of that name.
pub(super) fn number_of(name: &str) -> usize {
    let found = DEVICES.iter().position(|kind| kind.name == name);
    found.expect("it is built in")
}

/// Number of the first device that comes from a file.
pub(super) const fn first_file() -> usize {
    DEVICES.len()
}

/// The effect of one step.
#[derive(Clone, Copy, Debug)]
pub(super) enum Act {
    Frame(Frame),
    /// Time passes, in microseconds.
    Time(u64),
    /// Switches power off for a time, in microseconds.
    Power(u64),
    Position(u64),
    Rpm(f64),
    Turn(f64),
    Switches(u8, u8),
    /// One of the faults, by number.
    Fault(usize, bool),
    /// Power goes off when this many more bytes are written to the EEPROM.
    Cut(usize),
    /// The CAN controller reports a change.
    Controller(BusEvent),
}

/// The action that these ten bytes encode; `entries` are those of the device's dictionary.
pub(super) fn act(step: &[u8; STEP], entries: &[Entry], node: u8) -> Act {
    let [op, a, b, c, rest @ ..] = *step;
    let own = u16::from(node);
    let number = u32::from_le_bytes([rest[0], rest[1], rest[2], rest[3]]);
    match op % 40 {
        // Transfers that a master would begin, on existing objects.
        0..=7 => Act::Frame(download(step, entries, node)),
        8..=13 => {
            let entry = &entries[usize::from(u16::from_le_bytes([b, c])) % entries.len()];
            Act::Frame(request(node, 0x40, entry.address, [0; 4]))
        }
        // Any command on an existing object.
        14..=19 => {
            const COMMANDS: [u8; 24] = [
                0x22, 0x23, 0x27, 0x2B, 0x2F, 0x21, 0x20, 0x40, 0x60, 0x70, 0x00, 0x10, 0x01, 0x11,
                0x80, 0xA0, 0xA4, 0xA3, 0xA2, 0xA1, 0xC0, 0xC6, 0xC1, 0x81,
            ];
            let entry = &entries[usize::from(u16::from_le_bytes([b, c])) % entries.len()];
            let command = COMMANDS[usize::from(a) % COMMANDS.len()];
            Act::Frame(request(node, command, entry.address, number.to_le_bytes()))
        }
        // Segments and other frames.
        20..=23 => {
            let data = [a, b, c, rest[0], rest[1], rest[2], rest[3], rest[4]];
            let dlc = if rest[5] < 200 { 8 } else { rest[5] % 9 };
            Act::Frame(Frame::with_dlc(CanId::standard(0x600 + own), data, dlc))
        }
        24 => Act::Frame(Frame::standard(
            0x600 + own,
            &[0x60 | (a & 1) << 4, 0, 0, 0, 0, 0, 0, 0],
        )),
        25 => {
            const IDS: [u16; 6] = [0x600, 0x580, 0x700, 0x180, 0x280, 0x000];
            let id = IDS[usize::from(a) % IDS.len()] + own;
            Act::Frame(Frame::remote(CanId::standard(id), b % 9).expect("8 at most"))
        }
        26 => {
            const COMMANDS: [u8; 8] = [0x01, 0x01, 0x80, 0x80, 0x02, 0x81, 0x82, 0x55];
            let to = [node, 0, node, node.wrapping_add(1)][usize::from(b) % 4];
            let command = COMMANDS[usize::from(a) % COMMANDS.len()];
            let dlc = if c < 240 { 2 } else { c % 9 };
            let data = [command, to, rest[0], 0, 0, 0, 0, 0];
            Act::Frame(Frame::with_dlc(CanId::standard(0), data, dlc))
        }
        27 => Act::Frame(match b % 8 {
            0 => Frame::standard(0x80, &[a]),
            _ => Frame::standard(0x80, &[]),
        }),
        28 => {
            const COMMANDS: [u8; 16] = [
                0x04, 0x04, 0x11, 0x13, 0x15, 0x17, 0x5A, 0x5B, 0x5C, 0x5D, 0x5E, 0x4C, 0x51, 0x40,
                0x43, 0x46,
            ];
            let command = COMMANDS[usize::from(a) % COMMANDS.len()];
            let data = [
                command,
                b % 4,
                c,
                rest[0],
                rest[1],
                rest[2],
                rest[3],
                rest[4],
            ];
            Act::Frame(Frame::standard(0x7E5, &data))
        }
        29 => Act::Frame(Frame::standard(0x601 + own, &[0x40, a, b, c, 0, 0, 0, 0])),
        30 => {
            // Some are CAN-IDs of the RPDOs.
            let rpdo = 0x200 + 0x100 * u16::from(a >> 6) + own;
            let id = match a % 4 {
                0 | 2 => CanId::standard(number as u16),
                1 => CanId::standard(rpdo),
                _ => CanId::extended(number),
            };
            let data = [b, c, rest[0], rest[1], rest[2], rest[3], rest[4], rest[5]];
            Act::Frame(Frame::with_dlc(id, data, b % 9))
        }
        31..=34 => Act::Time(u64::from(number % 40_000)),
        35 => Act::Time(u64::from(number % 20_000_000)),
        36 if a < 64 => Act::Power(u64::from(number % 15_000_000)),
        36 => Act::Switches(b % 100, c % 8),
        37 => Act::Fault(usize::from(b), a % 3 == 0),
        38 if a % 2 == 0 => Act::Position(u64::from(number)),
        38 => Act::Turn(f64::from(number as i32) / 65536.0),
        _ if a < 32 => Act::Cut(usize::from(b) * 4),
        _ if a < 96 => Act::Controller(match b % 6 {
            0 => BusEvent::Warning,
            1 => BusEvent::Passive,
            2 => BusEvent::Off,
            3 => BusEvent::Overrun,
            _ => BusEvent::Active,
        }),
        _ => Act::Rpm(f64::from(number as i32) / 100_000.0),
    }
}

fn request(node: u8, command: u8, address: od_model::Address, data: [u8; 4]) -> Frame {
    let [low, high] = address.index.to_le_bytes();
    let [w, x, y, z] = data;
    Frame::standard(
        0x600 + u16::from(node),
        &[command, low, high, address.sub, w, x, y, z],
    )
}

/// An expedited download with the length of the object and a value that is likely to be valid.
fn download(step: &[u8; STEP], entries: &[Entry], node: u8) -> Frame {
    let [_, a, b, c, rest @ ..] = *step;
    let entry = &entries[usize::from(u16::from_le_bytes([b, c])) % entries.len()];
    let any = u32::from_le_bytes([rest[0], rest[1], rest[2], rest[3]]);
    let of = |literal: od_model::Literal| literal.integer(node).map(|value| value as u32);
    let small = any % 16;
    let value = match a % 12 {
        0 | 1 => of(entry.default).unwrap_or(any),
        2 => of(entry.low).unwrap_or(0),
        3 => of(entry.high).unwrap_or(u32::MAX),
        4 => of(entry.low).unwrap_or(0).wrapping_sub(1),
        5 => of(entry.high).unwrap_or(0).wrapping_add(1),
        6 => of(entry.default).unwrap_or(0).wrapping_add(small),
        7 => u32::from_le_bytes(*b"save"),
        8 => u32::from_le_bytes(*b"load"),
        9 => small,
        10 => any & 0xFFFF,
        _ => any,
    };
    let len = entry.data_type.size().unwrap_or(4).min(4);
    let command = 0x23 | ((4 - len as u8) << 2);
    request(node, command, entry.address, value.to_le_bytes())
}
