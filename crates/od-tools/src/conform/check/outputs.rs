//! CiA 401: outputs that change. Each case needs the permission `motion`.
//!
//! An output is seen at the input that is wired to it. A case looks for such a pair first: in each group of digital
//! outputs, and for each analogue output.

use od_model::Address;
use od_wire::CobId;
use od_wire::nmt::Command;

use super::heartbeat::{beat, watch};
use super::maker::{IO, is_of};
use super::transmit::{Tpdo, is_on, learn_sync, mapping, next, sync, typed_on};
use crate::conform::dut::{Dut, QUIET};
use crate::conform::end::{Checked, End, ensure, fail, lacks};

/// Time in which an input follows an output, in microseconds.
const REACTION: u64 = 50_000;

/// A bit of an 8-bit object.
#[derive(Clone, Copy)]
struct Bit {
    sub: u8,
    mask: u8,
}

impl Bit {
    /// Reads the bit of an object.
    fn read(self, dut: &mut Dut<'_>, index: u16) -> Checked<bool> {
        Ok(dut.number(index, self.sub)? & u64::from(self.mask) != 0)
    }

    /// Writes the bit of an object, and gives the module time; the old value returns after the case.
    fn write(self, dut: &mut Dut<'_>, index: u16, on: bool) -> Checked {
        let address = Address::new(index, self.sub);
        if dut.eds.entry(index, self.sub).is_none() {
            return lacks(format!("the EDS does not have {address}"));
        }
        let old = dut.keep(address)?;
        let old = old.first().copied().unwrap_or_default();
        let new = if on {
            old | self.mask
        } else {
            old & !self.mask
        };
        dut.write(address, &[new])?;
        dut.wait(REACTION)
    }

    fn toggle(self, dut: &mut Dut<'_>, index: u16) -> Checked {
        let is = self.read(dut, index)?;
        self.write(dut, index, !is)
    }
}

/// An output that is wired to an input.
struct Wire {
    output: Bit,
    input: Bit,
}

impl Wire {
    /// The wires of the module, if necessary after a reset: it may still show the values of an error that has ended.
    fn find(dut: &mut Dut<'_>) -> Checked<Vec<Self>> {
        let mut found = Self::seen(dut)?;
        if found.is_empty() && dut.may_reset {
            dut.put_back_since(0)?;
            dut.reset(Command::ResetNode)?;
            found = Self::seen(dut)?;
        }
        if found.is_empty() {
            return lacks("no digital output is wired to an input; connect one to run this case");
        }
        Ok(found)
    }

    /// Switches the outputs of each group, one after the other, until an input changes.
    fn seen(dut: &mut Dut<'_>) -> Checked<Vec<Self>> {
        dut.nmt(Command::Start)?;
        let before = all(dut, 0x6000)?;
        let mut found = Vec::new();
        for sub in 1..=dut.number(0x6200, 0)?.min(0xFE) as u8 {
            for mask in (0..8).map(|bit| 1 << bit) {
                let output = Bit { sub, mask };
                output.toggle(dut, 0x6200)?;
                let after = all(dut, 0x6000)?;
                output.toggle(dut, 0x6200)?;
                let pairs = before.iter().zip(&after);
                let changed = (1..).zip(pairs.map(|(before, after)| before ^ after));
                let input = changed
                    .map(|(sub, mask)| Bit { sub, mask })
                    .find(|input| input.mask.count_ones() == 1);
                if let Some(input) = input {
                    found.push(Self { output, input });
                    break;
                }
            }
        }
        Ok(found)
    }

    /// Fails unless the input has this value.
    fn shows(&self, dut: &mut Dut<'_>, wanted: bool, why: &str) -> Checked {
        let is = self.input.read(dut, 0x6000)?;
        let Bit { sub, mask } = self.input;
        ensure(
            is == wanted,
            format!(
                "{} in bit {} of 6000h:{sub:02X} {why}",
                u8::from(wanted),
                mask.trailing_zeros()
            ),
            format!("{} was read", u8::from(is)),
        )
    }
}

/// Tests each of these wires. The case applies if it applies to one of them.
fn each<W>(
    dut: &mut Dut<'_>,
    wires: Vec<W>,
    test: impl Fn(&mut Dut<'_>, &W) -> Checked,
) -> Checked {
    let (mut lacking, mut is_tested) = (None, false);
    for wire in wires {
        // The test of an earlier wire may have ended in an error.
        dut.nmt(Command::Start)?;
        match test(dut, &wire) {
            Err(End::NotApplicable(why)) => lacking = Some(why),
            done => {
                dut.fault(done)?;
                is_tested = true;
            }
        }
    }
    match lacking.filter(|_| !is_tested) {
        Some(why) => lacks(why),
        None => Ok(()),
    }
}

/// The bytes of all sub-objects.
fn all(dut: &mut Dut<'_>, index: u16) -> Checked<Vec<u8>> {
    let count = dut.number(index, 0)?.min(0xFE) as u8;
    (1..=count)
        .map(|sub| Ok(dut.number(index, sub)? as u8))
        .collect()
}

/// The CAN-ID of an event-driven TPDO with this object.
fn event_of(dut: &mut Dut<'_>, index: u16, sub: u8) -> Checked<u16> {
    let pdo = event_driven_of(dut, index, sub)?;
    Ok(pdo.id().as_standard().unwrap_or_default())
}

fn event_driven_of(dut: &mut Dut<'_>, index: u16, sub: u8) -> Checked<Tpdo> {
    for pdo in dut.eds.pdos(0x1800) {
        let cob_id = dut.number(0x1800 + pdo, 1)? as u32;
        let kind = dut.number(0x1800 + pdo, 2)?;
        let is_mapped = mapping(dut, 0x1A00 + pdo)?
            .iter()
            .any(|one| one.address == Address::new(index, sub));
        let has_id = CobId::new(cob_id).can_id().as_standard().is_some();
        if is_on(cob_id) && has_id && is_mapped && kind >= 0xFE {
            let com = 0x1800 + pdo;
            return Ok(Tpdo { com, cob_id });
        }
    }
    lacks(format!("no event-driven TPDO has {index:04X}h:{sub:02X}"))
}

/// Each output holds what was written.
pub(super) fn hold(dut: &mut Dut<'_>) -> Checked {
    dut.nmt(Command::Start)?;
    for sub in 1..=dut.number(0x6200, 0)?.min(0xFE) as u8 {
        let address = Address::new(0x6200, sub);
        let old = dut.keep(address)?;
        let new: Vec<u8> = old.iter().map(|byte| !byte).collect();
        let others = all(dut, 0x6200)?;
        dut.write(address, &new)?;
        dut.wait(REACTION)?;
        let is = dut.read(address)?;
        let now = all(dut, 0x6200)?;
        let pairs = (1..).zip(others.iter().zip(&now));
        let mut changed = pairs.filter(|(other, (was, is))| *other != sub && was != is);
        if let Some((other, (was, is))) = changed.next() {
            let done = fail(
                format!("{was:02X}h in 6200h:{other:02X} after a write of {address}"),
                format!("{is:02X}h was read"),
            );
            dut.fault(done)?;
        }
        let done = ensure(
            is == new,
            format!("{new:02X?} in {address}, as was written"),
            format!("{is:02X?} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn polarity(dut: &mut Dut<'_>) -> Checked {
    let wires = Wire::find(dut)?;
    each(dut, wires, |dut, wire| {
        let before = wire.input.read(dut, 0x6000)?;
        wire.output.toggle(dut, 0x6202)?;
        wire.shows(dut, !before, "after 6202h inverted its output")
    })
}

/// The built-in module has the time of its filters in 2000h, in milliseconds.
pub(super) fn filter(dut: &mut Dut<'_>) -> Checked {
    is_of(dut, &[IO])?;
    let wires = Wire::find(dut)?;
    dut.set(Address::new(0x2000, 0), &300u16.to_le_bytes())?;
    each(dut, wires, |dut, wire| {
        for is_filtered in [true, false] {
            wire.input.write(dut, 0x6003, is_filtered)?;
            let before = wire.input.read(dut, 0x6000)?;
            wire.output.toggle(dut, 0x6200)?;
            let when = format!(
                "50 ms after its output changed, with {} in 6003h",
                u8::from(is_filtered)
            );
            wire.shows(dut, before ^ !is_filtered, &when)?;
            dut.wait(400_000)?;
            wire.shows(dut, !before, "450 ms after its output changed")?;
        }
        Ok(())
    })
}

pub(super) fn filter_mask(dut: &mut Dut<'_>) -> Checked {
    let wires = Wire::find(dut)?;
    each(dut, wires, |dut, wire| {
        // An output at 0 and one at 1 keep their values.
        for _ in 0..2 {
            let before = wire.input.read(dut, 0x6000)?;
            wire.output.write(dut, 0x6208, false)?;
            wire.output.toggle(dut, 0x6200)?;
            wire.shows(dut, before, "while 6208h masks its output")?;
            wire.output.write(dut, 0x6208, true)?;
            wire.shows(dut, !before, "when 6208h masks its output no more")?;
        }
        Ok(())
    })
}

/// Error mode 1: the error value; error mode 0: the last value.
pub(super) fn error_value(dut: &mut Dut<'_>) -> Checked {
    let wires = Wire::find(dut)?;
    each(dut, wires, |dut, wire| {
        let before = wire.input.read(dut, 0x6000)?;
        let value = wire.output.read(dut, 0x6200)?;
        wire.output.write(dut, 0x6207, !value)?;
        // One bit of 6206h, and all of them.
        for (mode, others) in [
            (true, None),
            (false, None),
            (true, Some(0xFF)),
            (false, Some(0)),
        ] {
            wire.output.write(dut, 0x6206, mode)?;
            if let Some(byte) = others {
                dut.write(Address::new(0x6206, wire.output.sub), &[byte])?;
            }
            let wanted = before ^ mode;
            let node = watch(dut, 200)?;
            dut.nmt(Command::Start)?;
            beat(dut, node)?;
            wire.shows(dut, before, "while the heartbeat is in time")?;
            dut.wait(500_000)?;
            let why = format!(
                "after a heartbeat is lost, with {} in 6206h",
                u8::from(mode)
            );
            wire.shows(dut, wanted, &why)?;
        }
        Ok(())
    })
}

pub(super) fn interrupt_mask(dut: &mut Dut<'_>) -> Checked {
    let wires = Wire::find(dut)?;
    each(dut, wires, |dut, wire| {
        let id = event_of(dut, 0x6000, wire.input.sub)?;
        for (on, index) in [(false, 0x6007), (false, 0x6008), (true, 0x6006)] {
            if dut.eds.has(index) {
                wire.input.write(dut, index, on)?;
            }
        }
        for (enabled, mask) in [(1, true), (1, false), (0, true)] {
            dut.set(Address::new(0x6005, 0), &[enabled])?;
            wire.input.write(dut, 0x6006, mask)?;
            let sent = caused(dut, id, |dut| wire.output.toggle(dut, 0x6200))?;
            let when = format!(
                "after an input changed, with {enabled} in 6005h and {} in 6006h",
                u8::from(mask)
            );
            expect(sent, enabled == 1 && mask, id, &when)?;
            if enabled == 1 && mask {
                shows_inputs(dut, id)?;
            }
        }
        Ok(())
    })
}

/// The last TPDO with this CAN-ID has the present values of its objects.
fn shows_inputs(dut: &mut Dut<'_>, id: u16) -> Checked {
    let mut sent = dut.frames.iter().rev();
    let last = sent.find(|one| !one.ours && crate::conform::dut::is_data(&one.frame, id));
    let Some(last) = last.map(|one| one.frame) else {
        return Ok(());
    };
    for pdo in dut.eds.pdos(0x1800) {
        let cob_id = CobId::new(dut.number(0x1800 + pdo, 1)? as u32);
        if cob_id.can_id().as_standard() != Some(id) {
            continue;
        }
        let mut wanted = Vec::new();
        for mapped in mapping(dut, 0x1A00 + pdo)? {
            wanted.extend(dut.read(mapped.address)?);
        }
        return ensure(
            last.data() == wanted,
            format!("{wanted:02X?} in the TPDO {id:03X}, the values of its objects"),
            format!("{last} came"),
        );
    }
    Ok(())
}

/// Number of data frames with this CAN-ID since the frame `from`.
fn sent(dut: &Dut<'_>, from: usize, id: u16) -> usize {
    let frames = dut.frames.get(from..).unwrap_or_default().iter();
    frames
        .filter(|one| !one.ours && crate::conform::dut::is_data(&one.frame, id))
        .count()
}

fn expect(sent: usize, wanted: bool, id: u16, when: &str) -> Checked {
    match (wanted, sent) {
        (true, 0) => fail(format!("the TPDO {id:03X} {when}"), "none came"),
        (false, 1..) => fail(format!("no TPDO {id:03X} {when}"), format!("{sent} came")),
        _ => Ok(()),
    }
}

/// 6007h: from 0 to 1 only; 6008h: from 1 to 0 only.
pub(super) fn edge_masks(dut: &mut Dut<'_>) -> Checked {
    let wires = Wire::find(dut)?;
    each(dut, wires, |dut, wire| {
        let id = event_of(dut, 0x6000, wire.input.sub)?;
        dut.set(Address::new(0x6005, 0), &[1])?;
        wire.input.write(dut, 0x6006, false)?;
        for (rising, falling) in [(true, false), (false, true)] {
            wire.input.write(dut, 0x6007, rising)?;
            wire.input.write(dut, 0x6008, falling)?;
            for _ in 0..2 {
                let is_rising = !wire.input.read(dut, 0x6000)?;
                let sent = caused(dut, id, |dut| wire.output.toggle(dut, 0x6200))?;
                let when = format!(
                    "after an input became {}, with {} in 6007h and {} in 6008h",
                    u8::from(is_rising),
                    u8::from(rising),
                    u8::from(falling)
                );
                expect(sent, is_rising == rising, id, &when)?;
            }
        }
        Ok(())
    })
}

/// With transmission type 0 an input that changed sends its TPDO with the next SYNC.
pub(super) fn acyclic(dut: &mut Dut<'_>) -> Checked {
    let wires = Wire::find(dut)?;
    learn_sync(dut)?;
    each(dut, wires, |dut, wire| {
        let pdo = event_driven_of(dut, 0x6000, wire.input.sub)?;
        let kept = dut.undo.len();
        if dut.eds.writes(0x6005, 0) {
            dut.set(Address::new(0x6005, 0), &[1])?;
        }
        typed_on(dut, &pdo, 0)?;
        dut.nmt(Command::Start)?;
        for _ in 0..2 {
            sync(dut)?;
            dut.wait(QUIET)?;
            wire.output.toggle(dut, 0x6200)?;
            dut.wait(REACTION)?;
            dut.drain()?;
            sync(dut)?;
            if next(dut, &pdo, QUIET)?.is_none() {
                let expected = format!(
                    "TPDO{} with the SYNC after an input changed, with transmission type 0",
                    pdo.com - 0x17FF
                );
                return fail(expected, "none came");
            }
            let id = pdo.id().as_standard().unwrap_or_default();
            shows_inputs(dut, id)?;
        }
        dut.put_back_since(kept)
    })
}

/// Number of frames with this CAN-ID that an action causes.
fn caused(
    dut: &mut Dut<'_>,
    id: u16,
    action: impl FnOnce(&mut Dut<'_>) -> Checked,
) -> Checked<usize> {
    dut.drain()?;
    let from = dut.frames.len();
    action(dut)?;
    dut.wait(QUIET)?;
    Ok(sent(dut, from, id))
}

/// Distance of the values that an analogue output gets.
const STEP: i16 = 2000;

/// An analogue output that is wired to an input.
struct Analogue {
    output: Address,
    /// Sub-index of the input in 6401h.
    input: u8,
}

impl Analogue {
    /// Changes one output after the other, and looks for the inputs that change.
    fn find(dut: &mut Dut<'_>) -> Checked<Vec<Self>> {
        dut.nmt(Command::Start)?;
        let mut found = Vec::new();
        let count = dut.number(0x6401, 0)?.min(0xFE) as u8;
        for sub in 1..=dut.number(0x6411, 0)?.min(0xFE) as u8 {
            let output = Address::new(0x6411, sub);
            dut.keep(output)?;
            let mut seen = [Vec::new(), Vec::new()];
            for (value, seen) in [0, STEP].into_iter().zip(&mut seen) {
                put(dut, output, value)?;
                for input in 1..=count {
                    seen.push(dut.number(0x6401, input)?);
                }
            }
            let inputs = (1..).zip(seen[0].iter().zip(&seen[1]));
            let changed = inputs.filter(|(_, (before, after))| before != after);
            found.extend(changed.map(|(input, _)| Self { output, input }));
        }
        if found.is_empty() {
            return lacks("no analogue output is wired to an input; connect one to run this case");
        }
        Ok(found)
    }

    /// The value of the input.
    fn read(&self, dut: &mut Dut<'_>) -> Checked<i16> {
        Ok(dut.number(0x6401, self.input)? as i16)
    }

    /// Writes the output; returns the value of the input then.
    fn after(&self, dut: &mut Dut<'_>, value: i16) -> Checked<i16> {
        put(dut, self.output, value)?;
        self.read(dut)
    }

    /// Fails unless the input has this value, or nearly so.
    fn shows(&self, dut: &mut Dut<'_>, wanted: i16, why: &str) -> Checked {
        let is = self.read(dut)?;
        ensure(
            is.abs_diff(wanted) < STEP.unsigned_abs() / 4,
            format!("about {wanted} in 6401h:{:02X} {why}", self.input),
            format!("{is} was read"),
        )
    }

    /// Lets only this input send its TPDO, for these reasons (6421h).
    fn select(&self, dut: &mut Dut<'_>, reasons: u8) -> Checked {
        for input in 1..=dut.number(0x6421, 0)?.min(0xFE) as u8 {
            let is_it = input == self.input;
            dut.set(
                Address::new(0x6421, input),
                &[if is_it { reasons } else { 0 }],
            )?;
        }
        dut.set(Address::new(0x6423, 0), &[1])
    }
}

/// Writes an analogue output, and gives the module time.
fn put(dut: &mut Dut<'_>, output: Address, value: i16) -> Checked {
    dut.write(output, &value.to_le_bytes())?;
    dut.wait(REACTION)
}

/// Each analogue output holds each value, and an input that is wired to it follows.
pub(super) fn analogue_hold(dut: &mut Dut<'_>) -> Checked {
    const VALUES: [i16; 4] = [0, STEP, 2 * STEP, 3 * STEP];
    const OTHERS: [i16; 3] = [-STEP, i16::MAX, i16::MIN];
    let wires = match Analogue::find(dut) {
        Err(End::NotApplicable(_)) => Vec::new(),
        found => found?,
    };
    for sub in 1..=dut.number(0x6411, 0)?.min(0xFE) as u8 {
        let output = Address::new(0x6411, sub);
        dut.keep(output)?;
        let wire = wires.iter().find(|wire| wire.output == output);
        let mut seen = Vec::new();
        // The input is not asked about values that it may not be able to show.
        for value in OTHERS.into_iter().chain(VALUES) {
            put(dut, output, value)?;
            let is = dut.read(output)?;
            let done = ensure(
                is == value.to_le_bytes(),
                format!("{value} in {output}, as was written"),
                format!("{is:02X?} was read"),
            );
            dut.fault(done)?;
            if let Some(wire) = wire.filter(|_| VALUES.contains(&value)) {
                seen.push(wire.read(dut)?);
            }
        }
        let is_monotonic =
            seen.is_sorted_by(|one, next| one < next) || seen.is_sorted_by(|one, next| one > next);
        let done = ensure(
            is_monotonic,
            format!("another value of the input of {output} for each of {VALUES:?}"),
            format!("{seen:?} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// A small change and a great one.
pub(super) fn delta(dut: &mut Dut<'_>) -> Checked {
    const SMALL: i16 = 100;
    const DELTA: u32 = 1000;
    let wires = Analogue::find(dut)?;
    each(dut, wires, |dut, wire| {
        let id = event_of(dut, 0x6401, wire.input)?;
        dut.set(Address::new(0x6426, wire.input), &DELTA.to_le_bytes())?;
        wire.select(dut, 1 << 2)?;
        // The value of the last interrupt is STEP, or 0 of an earlier one: this change passes in either case.
        put(dut, wire.output, 2 * STEP)?;
        dut.wait(QUIET)?;
        for (value, wanted) in [
            (2 * STEP + SMALL, false),
            (3 * STEP, true),
            (3 * STEP - SMALL, false),
            (2 * STEP, true),
        ] {
            let sent = caused(dut, id, |dut| put(dut, wire.output, value))?;
            let when = format!(
                "after 6401h:{:02X} changed, with {DELTA} in 6426h",
                wire.input
            );
            expect(sent, wanted, id, &when)?;
        }
        dut.set(Address::new(0x6423, 0), &[0])?;
        let sent = caused(dut, id, |dut| put(dut, wire.output, STEP))?;
        expect(sent, false, id, "with 0 in 6423h")
    })
}

/// A fall and a rise by more than the delta of its direction.
pub(super) fn delta_direction(dut: &mut Dut<'_>) -> Checked {
    const DELTA: u32 = 1000;
    let wires = Analogue::find(dut)?;
    each(dut, wires, |dut, wire| {
        let id = event_of(dut, 0x6401, wire.input)?;
        if wire.after(dut, 0)? >= wire.after(dut, STEP)? {
            return lacks("the input falls when the output rises");
        }
        let signed = [(0x6427, 3, -STEP), (0x6428, 4, STEP)];
        for (index, reason, change) in signed.into_iter().filter(|one| dut.eds.has(one.0)) {
            dut.set(Address::new(0x6426, wire.input), &1u32.to_le_bytes())?;
            dut.set(Address::new(index, wire.input), &DELTA.to_le_bytes())?;
            // The value of the last interrupt is that of two steps.
            wire.select(dut, 1 << 2)?;
            for value in [0, 2 * STEP] {
                put(dut, wire.output, value)?;
            }
            dut.wait(QUIET)?;
            wire.select(dut, 1 << reason)?;
            for (value, wanted) in [
                (2 * STEP + change / 40, false),
                (2 * STEP - change, false),
                (2 * STEP + change, true),
            ] {
                let sent = caused(dut, id, |dut| put(dut, wire.output, value))?;
                let when = format!(
                    "after 6401h:{:02X} became {value}, with {DELTA} in {index:04X}h",
                    wire.input
                );
                expect(sent, wanted, id, &when)?;
            }
        }
        Ok(())
    })
}

/// Values on both sides of an upper and a lower limit, and the interrupt source.
pub(super) fn limits(dut: &mut Dut<'_>) -> Checked {
    let wires = Analogue::find(dut)?;
    each(dut, wires, |dut, wire| {
        let id = event_of(dut, 0x6401, wire.input)?;
        // The limit is between one and two steps.
        let (below, above) = (wire.after(dut, STEP)?, wire.after(dut, 2 * STEP)?);
        let limit = (i32::from(below) + i32::from(above)) / 2;
        let source = Address::new(0x6422, 1 + (wire.input - 1) / 32);
        for (reasons, index, outside, inside) in [(1, 0x6424, 3, 0), (2, 0x6425, 0, 3)] {
            dut.set(Address::new(index, wire.input), &limit.to_le_bytes())?;
            wire.select(dut, reasons)?;
            put(dut, wire.output, inside * STEP)?;
            let near = (inside + 1).min(2);
            for (steps, wanted) in [
                (near, false),
                (outside, true),
                (near, false),
                (outside, true),
            ] {
                if dut.eds.has(0x6422) {
                    dut.read(source)?;
                }
                let sent = caused(dut, id, |dut| put(dut, wire.output, steps * STEP))?;
                let when = format!(
                    "after 6401h:{:02X} became {}, with {limit} in {index:04X}h and {reasons} in 6421h",
                    wire.input,
                    wire.read(dut)?
                );
                expect(sent, wanted, id, &when)?;
                if dut.eds.has(0x6422) {
                    shows_source(dut, source, wire.input, wanted)?;
                }
            }
        }
        Ok(())
    })
}

/// 6422h has the bit of the input after its interrupt, and reading it clears the bit.
fn shows_source(dut: &mut Dut<'_>, source: Address, input: u8, is_set: bool) -> Checked {
    for (wanted, when) in [
        (is_set, "after the input was inside or outside its limit"),
        (false, "after it was read"),
    ] {
        let bits = dut.number(source.index, source.sub)?;
        let bit = (input - 1) % 32;
        ensure(
            (bits >> bit & 1 == 1) == wanted,
            format!("{} in bit {bit} of {source} {when}", u8::from(wanted)),
            format!("{bits:08X}h was read"),
        )?;
    }
    Ok(())
}

/// Error mode 1: the error value; error mode 0: the last value.
pub(super) fn analogue_error(dut: &mut Dut<'_>) -> Checked {
    let wires = Analogue::find(dut)?;
    each(dut, wires, |dut, wire| {
        let sub = wire.output.sub;
        let above = wire.after(dut, 3 * STEP)?;
        let below = wire.after(dut, -3 * STEP)?;
        let value = wire.after(dut, STEP)?;
        for (mode, error, wanted) in [
            (1, 3 * STEP, above),
            (0, 3 * STEP, value),
            (1, -3 * STEP, below),
        ] {
            dut.set(Address::new(0x6444, sub), &i32::from(error).to_le_bytes())?;
            dut.set(Address::new(0x6443, sub), &[mode])?;
            let node = watch(dut, 200)?;
            dut.nmt(Command::Start)?;
            beat(dut, node)?;
            wire.shows(dut, value, "while the heartbeat is in time")?;
            dut.wait(500_000)?;
            let why =
                format!("after a heartbeat is lost, with {mode} in 6443h and {error} in 6444h");
            wire.shows(dut, wanted, &why)?;
        }
        Ok(())
    })
}
