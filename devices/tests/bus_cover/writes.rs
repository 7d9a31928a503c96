//! Downloads: the limits of every value, every length, every command byte.

use od_devices::find;
use odkit::Access;

use crate::bench::Bench;
use crate::models::{MODELS, Model};

const INVALID_COMMAND: u32 = 0x0504_0001;
const READ_ONLY: u32 = 0x0601_0002;
const NO_OBJECT: u32 = 0x0602_0000;
const NO_SUB_INDEX: u32 = 0x0609_0011;
const OUTSIDE: u32 = 0x0609_0030;
const TOO_GREAT: u32 = 0x0609_0031;
const GENERAL: u32 = 0x0800_0000;
const SIGNATURE: u32 = 0x0800_0020;

/// A writable object: index, sub-index, bytes, and the effect of a value.
type Rule = (u16, u8, usize, fn(u32, &Model) -> Result<(), u32>);

fn any(_: u32, _: &Model) -> Result<(), u32> {
    Ok(())
}

fn listed(listed: bool) -> Result<(), u32> {
    if listed { Ok(()) } else { Err(OUTSIDE) }
}

/// MANUALS.md U-05: below the lower limit 06090030h, above the upper one 06090031h.
fn between(value: u32, low: u32, high: u32) -> Result<(), u32> {
    match value {
        value if value < low => Err(OUTSIDE),
        value if value > high => Err(TOO_GREAT),
        _ => Ok(()),
    }
}

fn signature(_: u32, _: &Model) -> Result<(), u32> {
    Err(SIGNATURE)
}

fn transmission_type(value: u32, _: &Model) -> Result<(), u32> {
    listed(matches!(value, 1..=240 | 254))
}

/// A CAN-ID of 11 bits has 0 in its other bits, and is not one that CiA 301 (table 40) restricts;
/// with bit 31 set it may be any.
fn cob_id(value: u32, has_valid_bit: bool) -> Result<(), u32> {
    let id = value & 0x1FFF_FFFF;
    let is_extended = value & 1 << 29 != 0;
    let is_kept = matches!(
        id,
        0..=0x7F | 0x101..=0x180 | 0x581..=0x5FF | 0x601..=0x67F | 0x6E0..=0x6FF | 0x701..=0x7FF
    );
    let is_off = has_valid_bit && value & 1 << 31 != 0;
    listed(is_extended || (id < 1 << 11 && (is_off || !is_kept)))
}

/// Every writable object of manual 000. 6003h follows 6002h, which is its upper limit.
const RULES: &[Rule] = &[
    (0x1003, 0, 1, |value, _| listed(value == 0)),
    // U-21: no SYNC producer.
    (0x1005, 0, 4, |value, _| {
        cob_id(value, false).and(listed(value & 1 << 30 == 0))
    }),
    (0x100C, 0, 2, any),
    (0x100D, 0, 1, any),
    (0x1010, 1, 4, signature),
    (0x1010, 2, 4, signature),
    (0x1010, 3, 4, signature),
    (0x1010, 4, 4, signature),
    (0x1011, 1, 4, signature),
    (0x1011, 2, 4, signature),
    (0x1011, 3, 4, signature),
    (0x1011, 4, 4, signature),
    (0x1014, 0, 4, |value, _| cob_id(value, true)),
    (0x1016, 1, 4, any),
    (0x1017, 0, 2, any),
    (0x1029, 1, 1, |value, _| listed(value <= 3)),
    (0x1800, 1, 4, |value, _| cob_id(value, true)),
    (0x1800, 2, 1, transmission_type),
    (0x1800, 5, 2, any),
    (0x1801, 1, 4, |value, _| cob_id(value, true)),
    (0x1801, 2, 1, transmission_type),
    (0x1801, 5, 2, any),
    (0x2100, 0, 1, |value, _| listed(value <= 8)),
    (0x2101, 0, 1, |value, _| between(value, 1, 127)),
    (0x2110, 0, 4, any),
    (0x2300, 1, 2, any),
    (0x2300, 2, 2, any),
    (0x2300, 3, 2, any),
    (0x2300, 4, 2, any),
    (0x2300, 5, 2, any),
    (0x2300, 6, 2, any),
    (0x2300, 7, 2, any),
    (0x2300, 8, 2, any),
    (0x2800, 0, 1, any),
    (0x2801, 0, 1, any),
    (0x6000, 0, 2, any),
    (0x6001, 0, 4, |value, model| {
        between(value, 1, model.resolution)
    }),
    (0x6002, 0, 4, |value, model| between(value, 1, model.range)),
    (0x6003, 0, 4, |value, model| {
        between(value, 0, model.range - 1)
    }),
    (0x6200, 0, 2, any),
];

/// All values of one byte, and the limits of longer ones.
fn values(bytes: usize, model: &Model) -> Vec<u32> {
    if bytes == 1 {
        return (0..=0xFF).collect();
    }
    let mut values = vec![0, 1, 2, 0x7F, 0x80, 0xFF, 0x100, 0x7FFF, 0x8000, 0xFFFF];
    if bytes == 4 {
        for limit in [model.resolution, model.range, 1 << 11, 1 << 29, 1 << 30] {
            values.extend([limit - 1, limit, limit + 1]);
        }
        values.extend([0x7FFF_FFFF, 0x8000_0000, 0xFFFF_FFFF, 0x4000_0181]);
        values.extend([
            0x101, 0x180, 0x181, 0x580, 0x581, 0x5FF, 0x600, 0x601, 0x67F,
        ]);
        values.extend([
            0x680,
            0x6DF,
            0x6E0,
            0x7FF,
            0xC000_0000,
            0x2000_0000,
            0x8000_0601,
        ]);
        // Later values rely on the original range.
        values.push(model.range);
    }
    values
}

/// Returns the response to a frame of eight bytes; `None` if there is none.
fn answer(bench: &mut Bench, request: [u8; 8]) -> Option<Result<(), u32>> {
    let answers = bench.send(0x601, &request);
    let [answer] = &answers[..] else {
        assert!(answers.is_empty(), "{answers:?}");
        return None;
    };
    assert_eq!(answer.id().raw(), 0x581);
    assert_eq!(answer.data().len(), 8);
    assert_eq!(answer.data()[1..4], request[1..4], "the multiplexer");
    match answer.data() {
        [0x80, _, _, _, code @ ..] => Some(Err(u32::from_le_bytes(code.try_into().unwrap()))),
        [0x60, _, _, _, 0, 0, 0, 0] | [0x43 | 0x4B | 0x4F, ..] => Some(Ok(())),
        other => panic!("{other:02X?}"),
    }
}

fn request(command: u8, index: u16, sub: u8, value: u32) -> [u8; 8] {
    let ([low, high], [a, b, c, d]) = (index.to_le_bytes(), value.to_le_bytes());
    [command, low, high, sub, a, b, c, d]
}

#[test]
fn every_writable_object_has_a_rule() {
    for model in &MODELS {
        let entries = find(&model.id()).unwrap().dictionary.entries();
        let writable: Vec<_> = entries
            .iter()
            .filter(|entry| entry.access == Access::Rw)
            .map(|entry| {
                let bytes = entry.data_type.size().unwrap();
                (entry.address.index, entry.address.sub, bytes)
            })
            .collect();
        let rules: Vec<_> = RULES.iter().map(|rule| (rule.0, rule.1, rule.2)).collect();
        assert_eq!(writable, rules, "{}", model.name);
        // The manual has no write-only object.
        assert!(entries.iter().all(|entry| entry.access != Access::Wo));
    }
}

/// The values below, at and above both limits, with the codes of U-05; a refused value
/// is not stored, an accepted one is.
#[test]
fn the_limits_of_every_value() {
    for model in &MODELS {
        let mut bench = Bench::new(&model.id());
        for &(index, sub, bytes, rule) in RULES {
            for value in values(bytes, model) {
                let before = bench.read(index, sub);
                let expected = rule(value, model);
                let what = format!("{} {index:04X}h:{sub:02X} = {value:X}h", model.name);
                assert_eq!(bench.write(index, sub, value), expected, "{what}");
                let after = if expected.is_ok() { value } else { before };
                assert_eq!(bench.read(index, sub), after, "{what}");
            }
        }
    }
}

/// 23h, 27h, 2Bh, 2Fh indicate 4 to 1 bytes: fewer than the object has are a general error, of more
/// the low ones are used (C-GX-13). 22h indicates none, and the object decides (C-GX-12).
#[test]
fn every_length() {
    for model in &MODELS {
        let mut bench = Bench::new(&model.id());
        for &(index, sub, bytes, rule) in RULES {
            let low = bench.read(index, sub);
            let mask = u32::try_from((1u64 << (8 * bytes)) - 1).unwrap();
            let value = low | (0xA5A5_A5A5 & !mask);
            for (command, size) in [(0x23, 4), (0x27, 3), (0x2B, 2), (0x2F, 1), (0x22, bytes)] {
                let expected = if size < bytes {
                    Err(GENERAL)
                } else {
                    rule(low, model)
                };
                let what = format!("{} {index:04X}h:{sub:02X} {command:X}h", model.name);
                let given = answer(&mut bench, request(command, index, sub, value));
                assert_eq!(given, Some(expected), "{what}");
                assert_eq!(bench.read(index, sub), low, "{what}");
            }
        }
    }
}

/// Frames of 4 to 8 bytes are requests (C-GX-15); missing bytes are not data.
#[test]
fn every_dlc() {
    let model = &MODELS[0];
    let mut bench = Bench::new(&model.id());
    for &(index, sub, bytes, rule) in RULES {
        let value = bench.read(index, sub);
        for dlc in 0..=8 {
            for command in [0x22, 0x23] {
                let what = format!("{index:04X}h:{sub:02X} {command:X}h, {dlc} bytes");
                let frame = request(command, index, sub, value);
                let answers = bench.send(0x601, &frame[..dlc]);
                let expected = match dlc {
                    0..4 => None,
                    dlc if dlc - 4 < bytes => Some(Err(GENERAL)),
                    _ => Some(rule(value, model)),
                };
                let given = answers.first().map(|answer| match answer.data() {
                    [0x60, ..] => Ok(()),
                    [_, _, _, _, code @ ..] => Err(u32::from_le_bytes(code.try_into().unwrap())),
                    other => panic!("{other:02X?}"),
                });
                assert_eq!(given, expected, "{what}");
                assert_eq!(bench.read(index, sub), value, "{what}");
            }
        }
    }
}

#[test]
fn no_read_only_value_can_be_written() {
    for model in &MODELS {
        let mut bench = Bench::new(&model.id());
        let entries = find(&model.id()).unwrap().dictionary.entries();
        for entry in entries.iter().filter(|entry| entry.access != Access::Rw) {
            let (index, sub) = (entry.address.index, entry.address.sub);
            let before = bench.read(index, sub);
            for command in [0x22, 0x23, 0x27, 0x2B, 0x2F] {
                for value in [0, before, 0xFFFF_FFFF] {
                    let given = answer(&mut bench, request(command, index, sub, value));
                    assert_eq!(given, Some(Err(READ_ONLY)), "{index:04X}h:{sub:02X}");
                }
            }
            assert_eq!(bench.read(index, sub), before);
        }
    }
}

/// All indices and sub-indices: 06020000h and 06090011h for those outside the tables.
#[test]
fn objects_that_do_not_exist() {
    let mut bench = Bench::new("gxmm");
    let dictionary = find("gxmm").unwrap().dictionary;
    for index in 0..=u16::MAX {
        let there = dictionary.object(index).is_some();
        let subs = if there { 0..=255 } else { 0..=0 };
        for sub in subs {
            let expected = match (there, dictionary.entry(index, sub).is_some()) {
                (_, true) => Ok(()),
                (true, false) => Err(NO_SUB_INDEX),
                (false, _) => Err(NO_OBJECT),
            };
            let given = answer(&mut bench, request(0x40, index, sub, 0));
            assert_eq!(given, Some(expected), "{index:04X}h:{sub:02X}");
            if expected.is_err() {
                let given = answer(&mut bench, request(0x23, index, sub, 0));
                assert_eq!(given, Some(expected), "{index:04X}h:{sub:02X}");
            }
        }
    }
}

/// All 256 command bytes, to 6003h with four bytes of data. The list of the manual has 22h,
/// 23h, 2Bh, 2Fh, 40h and 80h; by CiA 301 some bits of them have no meaning.
#[test]
fn every_command_byte() {
    const VALUE: u32 = 0x0304;
    for model in &MODELS {
        let mut bench = Bench::new(&model.id());
        for command in 0..=255u8 {
            bench.write(0x6003, 0, 7).unwrap();
            let given = answer(&mut bench, request(command, 0x6003, 0, VALUE));
            let (expected, after) = match (command >> 5, command & 3, command >> 2 & 3) {
                // Download: expedited only, with a sufficient size.
                (1, 3, 1..) => (Some(Err(GENERAL)), 7),
                (1, 2 | 3, _) => (Some(Ok(())), VALUE),
                // Upload.
                (2, _, _) => (Some(Ok(())), 7),
                // Abort of a client.
                (4, _, _) => (None, 7),
                _ => (Some(Err(INVALID_COMMAND)), 7),
            };
            assert_eq!(given, expected, "{command:02X}h");
            assert_eq!(bench.read(0x6003, 0), after, "{command:02X}h");
        }
    }
}
