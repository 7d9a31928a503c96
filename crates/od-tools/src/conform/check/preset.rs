//! CiA 406: preset values, and the position and the offset that they give.

use od_model::{Address, values};
use od_wire::nmt::Command;

use super::axis::signed;
use super::encoder::{NOISE, PRESET, scaled};
use super::maker;
use super::store::command;
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, at_least_one, ensure, lacks};
use crate::conform::sdo::abort_text;

/// A preset object: itself, the position, and the offset.
#[derive(Clone, Copy)]
struct Preset {
    preset: Address,
    position: Address,
    offset: Option<Address>,
}

/// 6003h, and each channel of 6010h.
fn all(dut: &Dut<'_>) -> Vec<Preset> {
    let position = Address::new(0x6004, 0);
    let has = |address: &Address| dut.eds.entry(address.index, address.sub).is_some();
    let mut all = vec![Preset {
        preset: PRESET,
        position,
        offset: Some(Address::new(0x6509, 0)).filter(has),
    }];
    for sub in (1..=0xFE).take_while(|sub| dut.eds.writes(0x6010, *sub)) {
        let own = Some(Address::new(0x6020, sub)).filter(has);
        if let Some(position) = own.or(Some(position).filter(|_| sub == 1)) {
            all.push(Preset {
                preset: Address::new(0x6010, sub),
                position,
                offset: Some(Address::new(0x650C, sub)).filter(has),
            });
        }
    }
    all
}

fn at(dut: &mut Dut<'_>, address: Address) -> Checked<u64> {
    dut.number(address.index, address.sub)
}

/// Measuring range: 0 in 6002h is that of 32 bits.
fn range(dut: &mut Dut<'_>) -> Checked<u64> {
    Ok(match dut.number(0x6002, 0)? {
        0 => 1 << 32,
        range => range,
    })
}

/// Distance of two values in a range.
fn apart(one: u64, other: u64, range: u64) -> u64 {
    let off = one.abs_diff(other);
    off.min(range.saturating_sub(off))
}

/// The greatest distance that two readings of a value at rest have for sure. One reading may be a wrong one.
fn tolerance(dut: &mut Dut<'_>, address: Address, range: u64) -> Checked<u64> {
    let mut all = Vec::new();
    for _ in 0..9 {
        all.push(at(dut, address)?);
        dut.wait(10_000)?;
    }
    let last = all[8];
    let mut off: Vec<u64> = all.iter().map(|one| apart(*one, last, range)).collect();
    off.sort_unstable();
    Ok(2 + 4 * off[7])
}

/// The position takes each preset value at once, with each code sequence (bit 0 of 6000h).
pub(super) fn preset(dut: &mut Dut<'_>) -> Checked {
    each(dut, takes)?;
    if !dut.eds.writes(SEQUENCE.index, 0) {
        return Ok(());
    }
    let before = dut.keep(SEQUENCE)?;
    let mut other = before.clone();
    if let Some(first) = other.first_mut() {
        *first ^= 1;
    }
    if dut.download(SEQUENCE, &other)?.is_err() {
        return Ok(());
    }
    let done = each(dut, takes);
    if matches!(done, Err(End::Lost(_))) {
        return done;
    }
    dut.write(SEQUENCE, &before)?;
    done
}

const SEQUENCE: Address = Address::new(0x6000, 0);

/// EAM links the objects of one sensor with those of its first channel (manual 001).
fn links(dut: &mut Dut<'_>) -> Checked {
    let pairs = [((0x6003, 0), (0x6010, 1)), ((0x6509, 0), (0x650C, 1))];
    for ((index, sub), (other, channel)) in pairs {
        let [one, other] = [Address::new(index, sub), Address::new(other, channel)];
        let has = |address: Address| dut.eds.entry(address.index, address.sub).is_some();
        if has(one) && has(other) {
            let (is, wanted) = (at(dut, other)?, at(dut, one)?);
            let done = ensure(
                is == wanted,
                format!("{wanted} in {other}, as in {one}"),
                format!("{is} was read"),
            );
            dut.fault(done)?;
        }
    }
    Ok(())
}

/// Tests each preset object of a shaft at rest, and puts back the position.
fn each(dut: &mut Dut<'_>, test: fn(&mut Dut<'_>, Preset, u64) -> Checked) -> Checked {
    for preset in all(dut) {
        let range = range(dut)?;
        if tolerance(dut, preset.position, range)? > 4 * NOISE {
            return lacks("the shaft turns");
        }
        let before = at(dut, preset.position)?;
        let old = dut.read(preset.preset)?;
        let done = test(dut, preset, range);
        if let Err(End::Lost(_)) = done {
            return done;
        }
        // The preset value that gives the earlier position.
        dut.write(preset.preset, &(before as u32).to_le_bytes())?;
        dut.notes.push(format!(
            "the position is {before} again; {} was {} before",
            preset.preset,
            values::hex(&old)
        ));
        dut.fault(done)?;
    }
    Ok(())
}

/// Values of each kind: near to the position, the ends of the range, and some whose bits differ.
fn some(before: u64, range: u64) -> Vec<u64> {
    let near = if before > 200 || range <= 400 {
        100
    } else {
        before + 100
    };
    let mut values = vec![near];
    if range > 4 * NOISE {
        let third = range / 3;
        values.extend([0, third, 2 * third, range / 2 + 1, range - 1]);
    }
    values
}

fn takes(dut: &mut Dut<'_>, of: Preset, range: u64) -> Checked {
    let before = at(dut, of.position)?;
    let near = tolerance(dut, of.position, range)?;
    // A preset value does not change the position of the shaft itself.
    let raw = dut.eds.entry(0x600C, 0).map(|entry| entry.address);
    let raw = match raw {
        Some(raw) => Some((raw, at(dut, raw)?, tolerance(dut, raw, u64::MAX)?)),
        None => None,
    };
    // Preset value, and offset after it.
    let mut offsets = Vec::new();
    for value in some(before, range) {
        dut.write(of.preset, &(value as u32).to_le_bytes())?;
        let is = at(dut, of.position)?;
        let shown = at(dut, of.preset)?;
        if let Some(offset) = of.offset {
            offsets.push((value, signed(&dut.read(offset)?)));
        }
        let done = ensure(
            shown == value,
            format!("{value} in {}, as written", of.preset),
            format!("{shown} was read"),
        )
        .and(ensure(
            apart(is, value, range) <= near,
            format!("{} = {value}, the preset value", of.position),
            format!("{is} was read"),
        ));
        dut.fault(done)?;
        if let Some((raw, before, near)) = raw {
            let is = at(dut, raw)?;
            let done = ensure(
                is.abs_diff(before) <= near,
                format!("{before} in {raw}, the raw value, as before the preset"),
                format!("{is} was read"),
            );
            dut.fault(done)?;
        }
    }
    let done = of
        .offset
        .map_or(Ok(()), |offset| follows(offset, &offsets, near, range));
    dut.fault(done)?;
    if maker::is_of(dut, &[maker::EAM]).is_ok() {
        links(dut)?;
    }
    Ok(())
}

/// An offset changes as much as the preset value; its sign is that of the manufacturer.
fn follows(offset: Address, all: &[(u64, i64)], near: u64, range: u64) -> Checked {
    let within = |value: i128| value.rem_euclid(i128::from(range)) as u64;
    let sums = |sign: i128| {
        let all = all.iter();
        all.map(|(value, offset)| within(i128::from(*offset) + sign * i128::from(*value)))
            .collect::<Vec<u64>>()
    };
    let is_same = |sums: &[u64]| sums.iter().all(|sum| apart(*sum, sums[0], range) <= near);
    let shown = |(value, offset): &(u64, i64)| format!("{offset} after {value}");
    let shown: Vec<String> = all.iter().map(shown).collect();
    ensure(
        is_same(&sums(1)) || is_same(&sums(-1)),
        format!("{offset}, the offset, to change as much as the preset value"),
        shown.join(", "),
    )
}

/// A value beyond the measuring range is refused, or gives the position at its place in the range.
pub(super) fn beyond(dut: &mut Dut<'_>) -> Checked {
    each(dut, |dut, of, range| {
        if range >= 1 << 32 {
            return lacks("6002h is the range of 32 bits");
        }
        for value in [
            range,
            range + 1,
            (range + 0x100).min(u32::MAX.into()),
            u32::MAX.into(),
        ] {
            let near = tolerance(dut, of.position, range)?;
            if dut
                .download(of.preset, &(value as u32).to_le_bytes())?
                .is_err()
            {
                continue;
            }
            let is = at(dut, of.position)?;
            let done = ensure(
                apart(is, value % range, range) <= near,
                format!(
                    "an abort for {value} in {}, or {} at {} then, as 6002h is {range}",
                    of.preset,
                    of.position,
                    value % range
                ),
                format!("the value was accepted, and the position is {is}"),
            );
            dut.fault(done)?;
        }
        Ok(())
    })
}

/// The position that a preset value gave is there after a save and a reset, and after the power was off.
pub(super) fn saved(dut: &mut Dut<'_>) -> Checked {
    if dut.number(0x1010, 1)? & 1 == 0 {
        return lacks("the node does not save on command");
    }
    let done = each(dut, |dut, of, range| {
        let near = tolerance(dut, of.position, range)?;
        let value = (at(dut, of.position)? + range / 3) % range;
        dut.write(of.preset, &(value as u32).to_le_bytes())?;
        let offset = of.offset.map(|offset| at(dut, offset)).transpose()?;
        command(dut, 0x1010, 1, b"save")?;
        dut.reset(Command::ResetNode)?;
        is_kept(
            dut,
            of,
            (value, offset),
            (near, range),
            "after a save and a reset",
        )?;
        if dut.rig.has_power() {
            dut.power(false)?;
            dut.wait(500_000)?;
            dut.drain()?;
            let from = dut.now();
            dut.power(true)?;
            dut.booted(from)?;
            is_kept(
                dut,
                of,
                (value, offset),
                (near, range),
                "after the power was off",
            )?;
        }
        Ok(())
    });
    if let Err(End::Lost(_)) = done {
        return done;
    }
    command(dut, 0x1010, 1, b"save")?;
    done
}

fn is_kept(
    dut: &mut Dut<'_>,
    of: Preset,
    (value, offset): (u64, Option<u64>),
    (near, range): (u64, u64),
    when: &str,
) -> Checked {
    let is = at(dut, of.position)?;
    let done = ensure(
        apart(is, value, range) <= near,
        format!("{value} in {} {when}, as the preset value", of.position),
        format!("{is} was read"),
    );
    dut.fault(done)?;
    let now = of.offset.map(|offset| at(dut, offset)).transpose()?;
    ensure(
        now == offset,
        format!("the same offset {when}"),
        format!("{} was read", now.unwrap_or(0)),
    )
}

/// The value of 2116h:02 is added to the position, as long as it is there.
pub(super) fn injected(dut: &mut Dut<'_>) -> Checked {
    const INJECTED: Address = Address::new(0x2116, 2);
    const POSITION: Address = Address::new(0x6004, 0);
    maker::is_of(dut, &[maker::EAM])?;
    let range = range(dut)?;
    let near = tolerance(dut, POSITION, range)?;
    if near > 4 * NOISE {
        return lacks("the shaft turns");
    }
    dut.set(INJECTED, &[0; 4])?;
    let before = at(dut, POSITION)?;
    for added in [0x321u32, 0x1234, 0] {
        dut.write(INJECTED, &added.to_le_bytes())?;
        let wanted = (before + u64::from(added)) % range;
        let is = at(dut, POSITION)?;
        let done = ensure(
            apart(is, wanted, range) <= near,
            format!("about {wanted} in {POSITION} with {added} in {INJECTED}"),
            format!("{is} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// The electronic gear of the manuals, 2001h. EAM divides the position after a save and a restart; EN580C computes
/// 6001h from the range, numerator and denominator.
pub(super) fn gear(dut: &mut Dut<'_>) -> Checked {
    let divides = maker::is_of(dut, &[maker::EAM]).is_ok();
    maker::is_of(dut, &[maker::EAM, maker::EN])?;
    scaled(
        dut,
        if divides {
            divides_position
        } else {
            computes_steps
        },
    )
}

const SWITCH: Address = Address::new(0x2001, 1);
const NUMERATOR: Address = Address::new(0x2001, 2);
const DENOMINATOR: Address = Address::new(0x2001, 3);

/// 6001h is 6002h · denominator / numerator while the gear is on, and its own value afterwards.
fn computes_steps(dut: &mut Dut<'_>) -> Checked {
    let before = dut.number(0x6001, 0)?;
    for address in [Address::new(0x6002, 0), SWITCH, NUMERATOR, DENOMINATOR] {
        dut.keep(address)?;
    }
    for (range, numerator, denominator) in
        [(10_000u32, 75u32, 10u32), (0x4000, 4, 1), (9_000, 9, 2)]
    {
        dut.write(SWITCH, &[0])?;
        for (address, value) in [(NUMERATOR, numerator), (DENOMINATOR, denominator)] {
            dut.write(address, &value.to_le_bytes())?;
        }
        if let Err(code) = dut.download(Address::new(0x6002, 0), &range.to_le_bytes())? {
            return lacks(format!("{range} in 6002h: {}", abort_text(code)));
        }
        dut.write(SWITCH, &[1])?;
        let wanted = u64::from(range) * u64::from(denominator) / u64::from(numerator);
        let is = dut.number(0x6001, 0)?;
        let place = dut.number(0x6004, 0)?;
        let done = ensure(
            is == wanted,
            format!(
                "{wanted} in 6001h, by the gear of {numerator} : {denominator} and 6002h = {range}"
            ),
            format!("{is} was read"),
        )
        .and(ensure(
            place < range.into(),
            format!("a position below 6002h = {range} while the gear is on"),
            format!("{place} was read"),
        ));
        dut.fault(done)?;
    }
    dut.write(SWITCH, &[0])?;
    let is = dut.number(0x6001, 0)?;
    let done = ensure(
        is == before,
        format!("{before} in 6001h after the gear was switched off"),
        format!("{is} was read"),
    );
    dut.fault(done)
}

/// The position is another one with the gear, and the one from before without it.
fn divides_position(dut: &mut Dut<'_>) -> Checked {
    let range = range(dut)?;
    if tolerance(dut, Address::new(0x6004, 0), range)? > 4 * NOISE {
        return lacks("the shaft turns");
    }
    let before = dut.number(0x6004, 0)?;
    let old = [SWITCH, NUMERATOR, DENOMINATOR].map(|address| dut.read(address));
    let mut places = Vec::new();
    for (switch, numerator, denominator) in [(2u8, 4u16, 1u16), (2, 8, 1), (2, 8, 2), (1, 8, 2)] {
        dut.write(NUMERATOR, &numerator.to_le_bytes())?;
        dut.write(DENOMINATOR, &denominator.to_le_bytes())?;
        dut.write(SWITCH, &[switch])?;
        command(dut, 0x1010, 1, b"save")?;
        dut.reset(Command::ResetNode)?;
        places.push(dut.number(0x6004, 0)?);
    }
    for (address, bytes) in [SWITCH, NUMERATOR, DENOMINATOR].into_iter().zip(old) {
        dut.write(address, &bytes?)?;
    }
    command(dut, 0x1010, 1, b"save")?;
    let [four, eight, again, off] = places[..] else {
        return Ok(());
    };
    at_least_one(
        before > 64 * NOISE,
        "the shaft is too near to 0 to show a gear; turn it",
    )?;
    for (is, wanted, what) in [
        (four, before / 4, "4 : 1"),
        (eight, before / 8, "8 : 1"),
        (again, before / 4, "8 : 2"),
        (off, before, "1 : 1, as it is off"),
    ] {
        let done = ensure(
            is.abs_diff(wanted) <= NOISE,
            format!("a position of about {wanted} with a gear of {what}"),
            format!("{is} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}
