//! CiA 406: encoders.

use od_model::{Address, values};
use od_wire::AbortCode::{ValueRange, ValueTooHigh};
use od_wire::nmt::Command;

use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, at_least_one, ensure, lacks};
use crate::conform::sdo::abort_text;

pub(super) const PRESET: Address = Address::new(0x6003, 0);

pub(super) fn objects(dut: &mut Dut<'_>) -> Checked {
    for index in [0x6000, 0x6500] {
        dut.read(Address::new(index, 0))?;
    }
    let has_position = dut.eds.has(0x6004) || dut.eds.has(0x6020);
    ensure(
        has_position,
        "6004h or 6020h, a position value",
        "the EDS has neither",
    )
}

pub(super) fn position(dut: &mut Dut<'_>) -> Checked {
    let range = dut.number(0x6002, 0)?;
    let is = dut.number(0x6004, 0)?;
    ensure(
        range == 0 || is < range,
        format!("a position below 6002h = {range}"),
        format!("{is} was read"),
    )
}

/// 6500h shows the active bits of 6000h.
pub(super) fn status(dut: &mut Dut<'_>) -> Checked {
    let wanted = dut.number(0x6000, 0)?;
    let is = dut.number(0x6500, 0)?;
    ensure(
        (wanted ^ is) & 0b101 == 0,
        format!("bits 0 and 2 of 6500h as in 6000h = {wanted:04X}h"),
        format!("{is:04X}h was read"),
    )
}

/// An active alarm or warning is a supported one.
fn supported(dut: &mut Dut<'_>, shown: u16, supported: u16) -> Checked {
    let is = dut.number(shown, 0)?;
    let can = dut.number(supported, 0)?;
    ensure(
        is & !can == 0,
        format!("only bits of {supported:04X}h = {can:04X}h in {shown:04X}h"),
        format!("{is:04X}h was read"),
    )
}

pub(super) fn alarms(dut: &mut Dut<'_>) -> Checked {
    supported(dut, 0x6503, 0x6504)
}

pub(super) fn warnings(dut: &mut Dut<'_>) -> Checked {
    supported(dut, 0x6505, 0x6506)
}

pub(super) fn steps(dut: &mut Dut<'_>) -> Checked {
    let most = dut.number(0x6501, 0)?;
    let address = Address::new(0x6001, 0);
    if most >= u64::from(u32::MAX) {
        return lacks("6501h is the highest number that 6001h can hold");
    }
    dut.keep(address)?;
    let more = (most as u32 + 1).to_le_bytes();
    dut.refuses_value(address, &more, &[ValueRange, ValueTooHigh])
}

pub(super) fn serial(dut: &mut Dut<'_>) -> Checked {
    let is = dut.number(0x650B, 0)?;
    let wanted = dut.number(0x1018, 4)?;
    ensure(
        is == wanted,
        format!("650Bh = {wanted}, as 1018h:04"),
        format!("{is} was read"),
    )
}

/// 6200h is the event timer of the first TPDO.
pub(super) fn cyclic_timer(dut: &mut Dut<'_>) -> Checked {
    let pdo = super::transmit::first(dut)?;
    if pdo.com != 0x1800 {
        return lacks("TPDO1 is off");
    }
    super::transmit::event_driven(dut, &pdo)?;
    let views = [Address::new(0x6200, 0), Address::new(0x1800, 5)];
    for (written, other) in [(views[1], views[0]), (views[0], views[1])] {
        let has_both = dut.eds.writes(written.index, written.sub)
            && dut.eds.entry(other.index, other.sub).is_some();
        for millis in [300u16, 60, 0].into_iter().filter(|_| has_both) {
            dut.set(written, &millis.to_le_bytes())?;
            let is = dut.number(other.index, other.sub)?;
            // Some devices can delay the timer by a few milliseconds.
            ensure(
                is.abs_diff(millis.into()) <= 5,
                format!("{millis} ms in {other}, as {written} is the same timer"),
                format!("{is} was read"),
            )?;
        }
    }
    dut.set(views[0], &60u16.to_le_bytes())?;
    let shown = "every 60 ms, as 6200h says, 10 % off at most";
    let is_right = |gap: u64, slack: u64| gap.abs_diff(60_000) <= 6_000 + slack;
    super::transmit::gaps(dut, &pdo, 4, is_right, shown)
}

/// Bit 0 of 6000h reverses the code sequence: with a preset of 0 the position is mirrored.
pub(super) fn code_sequence(dut: &mut Dut<'_>) -> Checked {
    let address = Address::new(0x6000, 0);
    let before = dut.keep(address)?;
    let mut other = before.clone();
    other[0] ^= 1;
    let place = dut.number(0x6004, 0)?;
    dut.write(address, &other)?;
    let is = dut.number(0x6500, 0)?;
    let mirrored = dut.number(0x6004, 0)?;
    dut.write(address, &before)?;
    let again = dut.number(0x6004, 0)?;
    ensure(
        is as u8 & 1 == other[0] & 1,
        format!("bit 0 of 6500h = {}", other[0] & 1),
        format!("{is:04X}h was read"),
    )?;
    let range = dut.number(0x6002, 0)?;
    // At 0 and in the middle of the range both positions are the same.
    let is_clear = range > 64 * NOISE && (2 * place) % range > 4 * NOISE;
    ensure(
        !is_clear || mirrored.abs_diff(place) > NOISE,
        format!("another position than {place} with the other code sequence"),
        format!("{mirrored} was read"),
    )?;
    ensure(
        !is_clear || again.abs_diff(place) <= NOISE,
        format!("the position {place} again with the code sequence from before"),
        format!("{again} was read"),
    )
}

const STEPS: Address = Address::new(0x6001, 0);
const RANGE: Address = Address::new(0x6002, 0);

/// Position noise of a shaft at rest, in steps.
pub(super) const NOISE: u64 = 16;

/// Sets bit 2 of 6000h, which turns the scaling on.
fn scaling(dut: &mut Dut<'_>, on: bool) -> Checked {
    let address = Address::new(0x6000, 0);
    let mut bytes = dut.read(address)?;
    if let Some(first) = bytes.first_mut() {
        *first = *first & !4 | u8::from(on) << 2;
    }
    dut.write(address, &bytes)
}

/// Runs a test that changes the scaling and the offset, and resets the node, which then has its parameters again. A
/// device that saved the offset gets its position back by the preset value.
pub(super) fn scaled(dut: &mut Dut<'_>, test: fn(&mut Dut<'_>) -> Checked) -> Checked {
    let before = dut.number(0x6004, 0)?;
    let done = scaling(dut, true).and_then(|()| test(dut));
    if matches!(done, Err(End::Lost(_))) {
        return done;
    }
    dut.reset(Command::ResetNode)?;
    let after = dut.number(0x6004, 0)?;
    if after.abs_diff(before) > NOISE && dut.eds.writes(PRESET.index, 0) {
        dut.write(PRESET, &(before as u32).to_le_bytes())?;
        dut.notes
            .push(format!("the position is {before} again, by 6003h"));
    }
    done
}

/// With half the steps of a revolution the position is another one, and without scaling again.
pub(super) fn resolution(dut: &mut Dut<'_>) -> Checked {
    scaled(dut, |dut| {
        let steps = dut.number(STEPS.index, 0)? as u32;
        // Devices may clear the offset with a write.
        dut.write(STEPS, &steps.to_le_bytes())?;
        let before = dut.number(0x6004, 0)?;
        let half = steps / 2;
        if half == 0 || before % u64::from(steps) < 4 * NOISE {
            return lacks("the shaft is too near to 0 to show a change of 6001h; turn it");
        }
        if let Err(code) = dut.download(STEPS, &half.to_le_bytes())? {
            return lacks(format!("{half} in 6001h: {}", abort_text(code)));
        }
        let is = dut.number(0x6004, 0)?;
        ensure(
            is.abs_diff(before) > NOISE,
            format!("another position than {before}, as 6001h is half of {steps} now"),
            format!("{is} was read"),
        )?;
        scaling(dut, false)?;
        let raw = dut.number(0x6004, 0)?;
        ensure(
            raw.abs_diff(is) > NOISE,
            format!("another position than {is}, as bit 2 of 6000h turns the scaling off"),
            format!("{raw} was read"),
        )
    })
}

/// A position in the upper half is below a range of half the steps.
pub(super) fn range(dut: &mut Dut<'_>) -> Checked {
    scaled(dut, |dut| {
        let range = dut.number(RANGE.index, 0)? as u32;
        let half = range / 2;
        let high = range.saturating_sub(range / 8);
        if half < 64 || dut.download(PRESET, &high.to_le_bytes())?.is_err() {
            return lacks("the position cannot be set to the upper half of 6002h");
        }
        let before = dut.number(0x6004, 0)?;
        if let Err(code) = dut.download(RANGE, &half.to_le_bytes())? {
            return lacks(format!("{half} in 6002h: {}", abort_text(code)));
        }
        let is = dut.number(0x6004, 0)?;
        ensure(
            is < u64::from(half),
            format!("a position below {half}, the value of 6002h, after {before}"),
            format!("{is} was read"),
        )
    })
}

/// Steps in 100 ms of a shaft whose speed is not 0 in steps per second.
const FAST: u64 = 100;

/// The speed of a shaft that turns is not 0, unless a factor (6031h) divides it.
fn shows_speed(dut: &mut Dut<'_>, rates: &[Address]) -> Checked {
    let is_divided = dut.eds.entry(0x6031, 4).is_some() && dut.number(0x6031, 4)? != 1;
    let speeds = rates.iter().filter(|address| address.index == 0x6030);
    if is_divided || speeds.clone().next().is_none() {
        return lacks("the shaft turns, and 6030h is missing or divided by 6031h:04");
    }
    for address in speeds {
        let is = dut.read(*address)?;
        let done = ensure(
            is.iter().any(|byte| *byte != 0),
            format!("another value than 0 in {address} while the shaft turns"),
            format!("{} was read", values::hex(&is)),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// Speed and acceleration are 0 while the position stays the same; the speed of a shaft that turns is not.
pub(super) fn at_rest(dut: &mut Dut<'_>) -> Checked {
    const TURNS: u8 = 10;
    let entries: Vec<_> = dut.eds.dictionary().entries().collect();
    // 2118h is the speed of EAM in revolutions per minute (manual 001).
    let is_own = dut.eds.has(0x2118) && super::maker::is_of(dut, &[super::maker::EAM]).is_ok();
    let is_rate = |address: Address| match address.index {
        0x6030 | 0x6040 => address.sub > 0,
        index => is_own && index == 0x2118,
    };
    let rates: Vec<Address> = entries
        .iter()
        .map(|entry| entry.address)
        .filter(|address| is_rate(*address))
        .collect();
    let place = dut.number(0x6004, 0)?;
    let mut last = place;
    let mut is_fast = true;
    for _ in 0..TURNS {
        dut.wait(100_000)?;
        let now = dut.number(0x6004, 0)?;
        is_fast &= now.abs_diff(last) > FAST;
        last = now;
    }
    if is_fast {
        return shows_speed(dut, &rates);
    }
    if last != place {
        return lacks("the shaft turns");
    }
    for address in &rates {
        let is = dut.read(*address)?;
        let done = ensure(
            is.iter().all(|byte| *byte == 0),
            format!("0 in {address} while the position stays {place}"),
            format!("{} was read", values::hex(&is)),
        );
        dut.fault(done)?;
    }
    at_least_one(!rates.is_empty(), "the EDS has neither 6030h nor 6040h")
}

/// Resolution, revolutions, supported alarms and warnings, and versions are those of the EDS.
pub(super) fn constants(dut: &mut Dut<'_>) -> Checked {
    let mut any = false;
    for index in [0x6501, 0x6502, 0x6504, 0x6506, 0x6507] {
        let Some(entry) = dut.eds.entry(index, 0) else {
            continue;
        };
        // Many files leave out the value.
        let Some(wanted) = dut
            .eds
            .default(&entry, dut.node)
            .filter(|it| it.iter().any(|byte| *byte != 0))
        else {
            continue;
        };
        any = true;
        let is = dut.read(entry.address)?;
        let done = ensure(
            is == wanted,
            format!(
                "{} in {}, as in the EDS",
                values::hex(&wanted),
                entry.address
            ),
            format!("{} was read", values::hex(&is)),
        );
        dut.fault(done)?;
    }
    at_least_one(
        any,
        "the EDS has no value of 6501h, 6502h, 6504h, 6506h and 6507h",
    )
}

/// While the shaft turns, 2118h of EAM is the speed of 6030h in revolutions per minute (manual 001).
pub(super) fn revolutions(dut: &mut Dut<'_>) -> Checked {
    super::maker::is_of(dut, &[super::maker::EAM])?;
    let gear = Address::new(0x2001, 1);
    if dut.eds.entry(gear.index, gear.sub).is_some() && dut.number(gear.index, gear.sub)? != 1 {
        return lacks("the electronic gear is on");
    }
    let steps = dut.number(STEPS.index, 0)?.max(1) as i64;
    // A device computes a speed over some time.
    dut.wait(500_000)?;
    let [before, is, after] = [(0x6030, 1), (0x2118, 0), (0x6030, 1)].map(|(index, sub)| {
        dut.read(Address::new(index, sub))
            .map(|it| super::axis::signed(&it))
    });
    let (before, is, after) = (before?, is?, after?);
    let wanted = [before, after].map(|speed| 60 * speed / steps);
    if wanted.iter().any(|speed| speed.abs() < 5) {
        return lacks("the shaft does not turn fast enough");
    }
    let off = 1 + wanted[0].abs() / 10;
    ensure(
        (wanted[0].min(wanted[1]) - off..=wanted[0].max(wanted[1]) + off).contains(&is),
        format!("about {} in 2118h, as 6030h:01 is {after}", wanted[1]),
        format!("{is} was read"),
    )
}

/// While the shaft turns, 6030h is above 0 if the position counts up, with each code sequence (bit 0 of 6000h).
pub(super) fn speed_direction(dut: &mut Dut<'_>) -> Checked {
    let options = Address::new(0x2110, 0);
    let is_eam = super::maker::is_of(dut, &[super::maker::EAM]).is_ok();
    if is_eam && dut.eds.has(options.index) && dut.number(options.index, 0)? & 1 == 1 {
        return lacks("bit 0 of 2110h excludes the speed from the code sequence");
    }
    if dut.eds.entry(0x6031, 4).is_some() && dut.number(0x6031, 4)? != 1 {
        return lacks("6030h is divided by 6031h:04");
    }
    let range = match dut.number(RANGE.index, 0)? {
        0 => 1 << 32,
        range => range,
    };
    let sequence = Address::new(0x6000, 0);
    let own = dut.keep(sequence)?;
    for bit in [1, 0] {
        let mut bytes = own.clone();
        if let Some(first) = bytes.first_mut() {
            *first ^= bit;
        }
        if dut.download(sequence, &bytes)?.is_err() {
            continue;
        }
        // A device computes a speed over some time.
        dut.wait(500_000)?;
        let before = dut.number(0x6004, 0)?;
        let speed = dut.read(Address::new(0x6030, 1))?;
        let speed = super::axis::signed(&speed);
        dut.wait(100_000)?;
        let off = (dut.number(0x6004, 0)? + range - before % range) % range;
        let counts_up = off < range / 2;
        if off.min(range - off) < 4 * NOISE || speed == 0 {
            return lacks("the shaft does not turn fast enough");
        }
        // The position must not pass half of its range meanwhile.
        if speed.unsigned_abs() > range {
            return lacks("the shaft turns too fast");
        }
        let done = ensure(
            counts_up == (speed > 0),
            format!(
                "a speed {} 0 in 6030h:01, as the position counts {}, with {:02X}h in 6000h",
                if counts_up { "above" } else { "below" },
                if counts_up { "up" } else { "down" },
                bytes.first().copied().unwrap_or_default()
            ),
            format!("{speed} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// While the shaft turns, 6030h is multiplied by 6031h:03 and divided by 6031h:04.
pub(super) fn speed_factor(dut: &mut Dut<'_>) -> Checked {
    let [multiplier, divider] = [3, 4].map(|sub| Address::new(0x6031, sub));
    let mut speeds = Vec::new();
    for (times, by) in [(2u16, 1u16), (1, 1), (1, 2)] {
        dut.set(multiplier, &times.to_le_bytes())?;
        dut.set(divider, &by.to_le_bytes())?;
        // The integration time has 100 ms by default.
        dut.wait(500_000)?;
        let bytes = dut.read(Address::new(0x6030, 1))?;
        speeds.push(super::axis::signed(&bytes));
    }
    let wanted = speeds[1];
    if wanted.abs() < 100 {
        return lacks("the shaft does not turn fast enough");
    }
    if wanted.abs() > 10_000 {
        return lacks("the shaft turns too fast for a speed of 16 bits");
    }
    for (is, wanted, what) in [
        (speeds[0], 2 * wanted, "2 in 6031h:03"),
        (speeds[2], wanted / 2, "2 in 6031h:04"),
    ] {
        let done = ensure(
            (is - wanted).abs() <= wanted.abs() / 5,
            format!("about {wanted} in 6030h:01 with {what}"),
            format!("{is} was read"),
        );
        dut.fault(done)?;
    }
    Ok(())
}
