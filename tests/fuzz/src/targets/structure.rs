//! A made device from end to end: EDS, description, tables, node, frames. The content of the EDS is
//! what a master reads, writes and receives in PDOs; a damaged EDS must only do no harm.

use od_eds::{Finding, Tables};
use od_model::Address;
use od_model::typed::emit::table;
use od_runtime::Frame;
use od_sim::{Bus, EdsOptions, VirtualDevice};

use super::eds;
use crate::choices::Choices;
use crate::generate::Device;
use crate::harness::trace;
use crate::made::{Made, NODE, integer};
use crate::random::Random;
use crate::sent::owner;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "structure",
    run,
    seeds: || vec![(0..=255).collect()],
    make: Some(make),
    ..Target::PLAIN
};

fn make(random: &mut Random) -> Vec<u8> {
    (0..random.size(11)).map(|_| random.next() as u8).collect()
}

fn run(input: &[u8]) {
    let mut choices = Choices(input);
    let is_damaged = choices.once_in(4);
    let mut made = Device::of(&mut choices);
    if is_damaged {
        damage(&mut made.text, &mut choices);
    }
    trace(|| made.text.clone());
    let parsed = od_eds::load(&made.text);
    if !is_damaged {
        let errors = parsed.findings.iter().filter(|finding| finding.is_error());
        let errors: Vec<&Finding> = errors.collect();
        assert!(errors.is_empty(), "{errors:?} in\n{}", made.text);
    }
    eds::written_again(&parsed.description);
    rows(&Tables::new(&parsed.description));
    let options = EdsOptions {
        node_id: None,
        lenient: is_damaged,
    };
    let device = match VirtualDevice::from_eds(&made.text, options) {
        Ok(device) => device,
        Err(findings) => panic!("it does not run: {findings:?} in\n{}", made.text),
    };
    let mut master = Master::of(device);
    if is_damaged {
        master.look_around();
    } else {
        master.check(&made, &mut choices);
    }
}

/// Removes a line, or repeats it, or replaces a number in it.
fn damage(text: &mut String, choices: &mut Choices<'_>) {
    let mut lines: Vec<&str> = text.lines().collect();
    let at = choices.below(lines.len());
    let other = lines[choices.below(lines.len())];
    let changed;
    match choices.below(4) {
        0 => drop(lines.remove(at)),
        1 => lines.insert(at, other),
        2 => lines[at] = other,
        _ => {
            let value = choices.number() >> choices.below(64);
            let key = lines[at].split('=').next().unwrap_or_default();
            changed = format!("{key}={value}");
            lines[at] = &changed;
        }
    }
    *text = lines.join("\n");
}

/// The rows that the macro writes into a binary are read back as the same tables.
fn rows(tables: &Tables) {
    let dictionary = tables.dictionary();
    for (row, entry) in tables.parts().0.iter().zip(dictionary.entries()) {
        assert_eq!(table::rows(&[row.number()]), [*row]);
        assert_eq!(dictionary.find(entry.address), Ok(entry));
    }
    for object in dictionary.objects() {
        assert_eq!(dictionary.object(object.index), Some(object));
    }
}

/// A master, and the only device on its bus.
struct Master(Bus);

impl Master {
    fn of(device: VirtualDevice) -> Self {
        let mut bus = Bus::new();
        bus.add(device);
        bus.start(0);
        while bus.poll().is_some() {}
        Self(bus)
    }

    /// The responses to a frame.
    fn send(&mut self, id: u16, data: &[u8]) -> Vec<Frame> {
        let mut bytes = [0; 8];
        bytes[..data.len()].copy_from_slice(data);
        let id = od_runtime::CanId::standard(id);
        let frame = Frame::with_dlc(id, bytes, data.len() as u8);
        trace(|| format!("> {frame}"));
        self.0.receive(&frame);
        let sent = std::iter::from_fn(|| self.0.poll()).map(|sent| sent.frame);
        let sent: Vec<Frame> = sent.collect();
        let node = self.0.devices()[0].node_id();
        for frame in &sent {
            owner(node, frame);
        }
        assert!(sent.len() < 1000, "{} answers to {frame}", sent.len());
        sent
    }

    fn ask(&mut self, request: [u8; 8]) -> [u8; 8] {
        let node = u16::from(NODE);
        match self.send(0x600 + node, &request)[..] {
            [answer] if answer.id() == Frame::standard(0x580 + node, &[]).id() => *answer.bytes(),
            ref other => panic!("{request:02X?} is answered with {other:?}"),
        }
    }

    /// An upload, expedited or in segments, or the abort code.
    fn read(&mut self, address: Address) -> Result<Vec<u8>, u32> {
        let [low, high] = address.index.to_le_bytes();
        let answer = self.ask([0x40, low, high, address.sub, 0, 0, 0, 0]);
        match answer[0] {
            0x80 => return Err(code(answer)),
            0x41 => {}
            command => {
                assert_eq!(command & 0xF3, 0x43, "{answer:02X?}");
                let len = 4 - usize::from(command >> 2 & 3);
                return Ok(answer[4..4 + len].to_vec());
            }
        }
        let mut bytes = Vec::new();
        for toggle in [0x60, 0x70].into_iter().cycle() {
            let answer = self.ask([toggle, 0, 0, 0, 0, 0, 0, 0]);
            if answer[0] == 0x80 {
                return Err(code(answer));
            }
            let len = 7 - usize::from(answer[0] >> 1 & 7);
            bytes.extend_from_slice(&answer[1..=len]);
            if answer[0] & 1 != 0 || bytes.len() > 0x2_0000 {
                break;
            }
        }
        Ok(bytes)
    }

    /// A download, expedited or in two segments.
    fn write(&mut self, address: Address, bytes: &[u8]) -> Result<(), u32> {
        let [low, high] = address.index.to_le_bytes();
        let mut request = [0x21, low, high, address.sub, bytes.len() as u8, 0, 0, 0];
        if bytes.len() <= 4 {
            request[0] = 0x23 | (4 - bytes.len() as u8) << 2;
            request[4..].fill(0);
            request[4..4 + bytes.len()].copy_from_slice(bytes);
        }
        let mut answer = self.ask(request);
        if bytes.len() > 4 && answer[0] != 0x80 {
            let chunks = bytes.chunks(7);
            let last = chunks.len() - 1;
            for (number, chunk) in chunks.enumerate() {
                let mut segment = [0; 8];
                let free = 7 - chunk.len() as u8;
                segment[0] = (number as u8 & 1) << 4 | free << 1 | u8::from(number == last);
                segment[1..=chunk.len()].copy_from_slice(chunk);
                answer = self.ask(segment);
                if answer[0] == 0x80 {
                    break;
                }
            }
        }
        match answer[0] {
            0x80 => Err(code(answer)),
            _ => Ok(()),
        }
    }

    /// Checks everything that the description promises.
    fn check(&mut self, made: &Device, choices: &mut Choices<'_>) {
        let mut values: Vec<Vec<u8>> = Vec::new();
        for one in &made.values {
            values.push(one.value.clone());
            self.check_read(one, &one.value);
        }
        for (one, value) in made.values.iter().zip(&mut values) {
            self.check_write(one, value, choices);
        }
        self.send(0, &[1, NODE]);
        for pdo in made.pdos.iter().filter(|pdo| pdo.is_received) {
            let mut data = Vec::new();
            for at in &pdo.mapped {
                let bytes = choices.number().to_le_bytes();
                values[*at] = bytes[..values[*at].len()].to_vec();
                data.extend_from_slice(&values[*at]);
            }
            self.send(pdo.id, &data);
            for at in &pdo.mapped {
                self.check_read(&made.values[*at], &values[*at]);
            }
        }
        let sent = self.send(0x80, &[]);
        let expected = made.pdos.iter().filter(|pdo| !pdo.is_received);
        let expected = expected.map(|pdo| {
            let data = pdo.mapped.iter().flat_map(|at| values[*at].clone());
            (u32::from(pdo.id), data.collect())
        });
        let expected: Vec<(u32, Vec<u8>)> = expected.collect();
        let sent = sent
            .iter()
            .map(|frame| (frame.id().raw(), frame.data().to_vec()));
        assert_eq!(sent.collect::<Vec<_>>(), expected, "after SYNC");
    }

    fn check_read(&mut self, one: &Made, value: &[u8]) {
        let expected = if one.is_readable() {
            Ok(value.to_vec())
        } else {
            Err(0x0601_0001)
        };
        assert_eq!(self.read(one.address), expected, "{one:?}");
    }

    fn check_write(&mut self, one: &Made, value: &mut Vec<u8>, choices: &mut Choices<'_>) {
        let range = one.data_type.integer_range();
        let Some((low, high)) = range.filter(|_| value.len() <= 8) else {
            return;
        };
        let number = integer(low, high, choices);
        let bytes = number.to_le_bytes()[..value.len()].to_vec();
        let (from, to) = one.limits.unwrap_or((low, high));
        let expected = match number {
            _ if !one.is_writable() => Err(0x0601_0002),
            number if number > to => Err(0x0609_0031),
            number if number < from => Err(0x0609_0032),
            _ => Ok(()),
        };
        let written = self.write(one.address, &bytes);
        assert_eq!(written, expected, "{number} is written to {one:?}");
        if expected.is_ok() {
            *value = bytes;
        }
        self.check_read(one, value);
    }

    /// Reads and writes all objects.
    fn look_around(&mut self) {
        let entries = self.0.devices()[0]
            .dictionary()
            .entries()
            .collect::<Vec<_>>();
        let node = u16::from(self.0.devices()[0].node_id().raw());
        self.send(0, &[1, 0]);
        for entry in entries.iter().take(40) {
            let [low, high] = entry.address.index.to_le_bytes();
            let sub = entry.address.sub;
            self.send(0x600 + node, &[0x40, low, high, sub, 0, 0, 0, 0]);
            self.send(0x600 + node, &[0x60, 0, 0, 0, 0, 0, 0, 0]);
            self.send(0x600 + node, &[0x2F, low, high, sub, 1, 0, 0, 0]);
        }
        for id in [0x80, 0x200 + node, 0x300 + node, 0x80] {
            self.send(id, &[1, 2, 3, 4, 5, 6, 7, 8]);
        }
        self.0.advance(self.0.now().plus_millis(20));
    }
}

fn code(answer: [u8; 8]) -> u32 {
    u32::from_le_bytes([answer[4], answer[5], answer[6], answer[7]])
}
