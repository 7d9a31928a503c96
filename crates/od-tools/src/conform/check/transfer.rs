//! Expedited transfers, and requests that a server refuses.

use std::ops::RangeInclusive;

use od_model::{Access, Address, DataType, Entry, Group, values};
use od_wire::AbortCode::{
    InvalidCommand, Length, NoObject, NoSubIndex, ReadOnly, TooLong, TooShort, UnsupportedAccess,
    ValueRange, ValueTooHigh, ValueTooLow, WriteOnly,
};
use od_wire::{AbortCode, CanId, Frame};

use super::{block, segments};
use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::eds::is_number;
use crate::conform::end::{Checked, End, ensure, fail, lacks, optional};
use crate::conform::sdo::{abort_of, is_abort, request};

const TYPE: Address = Address::new(0x1000, 0);

/// Uploads every entry of one to four bytes: the command byte indicates the number, or no size (42h).
pub(super) fn upload_sizes(dut: &mut Dut<'_>) -> Checked {
    let entries = dut.eds.dictionary().entries();
    let readable = entries.filter(|entry| entry.access.readable());
    for entry in readable.collect::<Vec<Entry>>() {
        let Some(size @ 1..=4) = entry.data_type.size() else {
            continue;
        };
        let answer = dut.answer(request(0x40, entry.address, [0; 4]))?;
        // Other cases test whether an object is there.
        if abort_of(&answer).is_some() {
            continue;
        }
        let got = format!("{} came", values::hex(&answer));
        let wanted = 0x43 | (4 - size as u8) << 2;
        let done = ensure(
            answer[0] == wanted || answer[0] == 0x42,
            format!("{wanted:02X}h, {size} bytes, or 42h for {}", entry.address),
            got.clone(),
        );
        dut.fault(done)?;
        let done = ensure(
            answer[4 + size..].iter().all(|byte| *byte == 0),
            format!("0 in the bytes without data for {}", entry.address),
            got,
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn one_answer(dut: &mut Dut<'_>) -> Checked {
    let mut requests = vec![
        request(0x40, TYPE, [0; 4]),
        request(0x40, Address::new(0x1000, 0x7F), [0; 4]),
    ];
    if let Some((address, _)) = another_value(dut)? {
        let [low, high] = (dut.number(address.index, address.sub)? as u16).to_le_bytes();
        requests.push(request(0x2B, address, [low, high, 0, 0]));
    }
    let id = dut.id(0x580);
    for request in requests {
        dut.answer(request)?;
        let expected = format!("one response to {}", values::hex(&request));
        dut.silent(id, QUIET, &expected)?;
    }
    // By segments each request has one response, and nothing follows the end of a transfer.
    let from = dut.frames.len();
    if let Some((address, before)) = optional(segments::short_value(dut))? {
        let _ = dut.download_segments(address, &before, true, before.len() / 2)?;
    }
    if let Some((address, _)) = optional(segments::long_value(dut))? {
        dut.read(address)?;
    }
    dut.silent(
        id,
        QUIET,
        "no SDO response after the end of a transfer by segments",
    )?;
    let frames = dut.frames.get(from..).unwrap_or_default().iter();
    let asked = frames.clone().filter(|traced| traced.ours).count();
    let answered = frames.filter(|traced| is_data(&traced.frame, id)).count();
    ensure(
        answered == asked,
        format!("one response to each of {asked} requests of transfers by segments"),
        format!("{answered} came"),
    )?;
    block::serves(dut)?;
    dut.silent(id, QUIET, "no SDO response after the end of a block upload")?;
    Ok(())
}

pub(super) fn read_write_back(dut: &mut Dut<'_>) -> Checked {
    let mut entries = dut.eds.writable();
    // 1019h can be written only while 1006h is 0.
    entries.retain(|entry| entry.address.index != 0x1019);
    let mut of_communication = entries.iter().filter(|entry| entry.address.index < 0x2000);
    let Some(entry) = of_communication.next().or_else(|| entries.first()) else {
        return lacks("no object can be written");
    };
    let before = dut.read(entry.address)?;
    dut.write(entry.address, &before)?;
    let after = dut.read(entry.address)?;
    ensure(
        before == after,
        format!("{} again", values::hex(&before)),
        format!("{} was read", values::hex(&after)),
    )
}

/// A written value can be read back.
pub(super) fn write_holds(dut: &mut Dut<'_>) -> Checked {
    let Some((address, bytes)) = another_value(dut)? else {
        return lacks("no object can be written");
    };
    dut.set(address, &bytes)?;
    let after = dut.read(address)?;
    ensure(
        bytes == after,
        format!("{} in {address}", values::hex(&bytes)),
        format!("{} was read", values::hex(&after)),
    )
}

/// An object without side effects, and another value for it.
pub(super) fn another_value(dut: &mut Dut<'_>) -> Checked<Option<(Address, Vec<u8>)>> {
    another_saved(dut, None)
}

/// As [`another_value`], for an object that a sub-index of 1010h saves.
pub(super) fn another_saved(
    dut: &mut Dut<'_>,
    by: Option<u8>,
) -> Checked<Option<(Address, Vec<u8>)>> {
    for (index, sub) in [(0x1017, 0), (0x100C, 0), (0x1800, 5), (0x1801, 5)] {
        let entry = dut
            .eds
            .entry(index, sub)
            .filter(|entry| entry.access.writable());
        if let Some(entry) = entry
            && by.is_none_or(|by| entry.group.covered_by(by))
        {
            let address = entry.address;
            let before = dut.read(address)?;
            let value: u16 = if before.first() == Some(&0x2C) {
                301
            } else {
                300
            };
            return Ok(Some((address, value.to_le_bytes().to_vec())));
        }
    }
    Ok(None)
}

/// Command 22h: the server takes the bytes that the object has.
pub(super) fn download_no_size(dut: &mut Dut<'_>) -> Checked {
    let sync = dut.eds.entry(0x1005, 0);
    let sync = sync.filter(|entry| entry.access.writable());
    let mut all: Vec<Entry> = dut.eds.writable().into_iter().chain(sync).collect();
    all.sort_by_key(|entry| entry.address);
    all.dedup_by_key(|entry| (entry.address.index, entry.data_type.size()));
    // 1019h can be written only while 1006h is 0.
    all.retain(|entry| is_number(entry) && entry.address.index != 0x1019);
    for entry in all {
        let own = dut.upload(entry.address)?.unwrap_or_default();
        let is_allowed = dut.eds.excludes(entry.address, &own, dut.node).is_none();
        if is_allowed && matches!(own.len(), 1..=4) {
            let mut bytes = [0; 4];
            bytes[..own.len()].copy_from_slice(&own);
            let answer = dut.answer(request(0x22, entry.address, bytes))?;
            let done = ensure(
                answer[0] == 0x60,
                format!(
                    "60h, the confirmation of a download without a size to {}",
                    entry.address
                ),
                format!("{} came", values::hex(&answer)),
            );
            dut.fault(done)?;
        }
    }
    let Some((address, value)) = another_value(dut)? else {
        return lacks("no parameter of communication can be written");
    };
    dut.keep(address)?;
    let mut bytes = [0; 4];
    bytes[..value.len()].copy_from_slice(&value);
    let answer = dut.answer(request(0x22, address, bytes))?;
    ensure(
        answer[0] == 0x60,
        "60h, the confirmation of an expedited download without a size",
        format!("{} came", values::hex(&answer)),
    )?;
    let is = dut.read(address)?;
    ensure(
        is == value,
        format!("{} in {address}", values::hex(&value)),
        format!("{} was read", values::hex(&is)),
    )
}

pub(super) fn write_read_only(dut: &mut Dut<'_>) -> Checked {
    let before = dut.read(TYPE)?;
    let mut bytes = [0; 4];
    bytes[..before.len().min(4)].copy_from_slice(&before[..before.len().min(4)]);
    dut.refuses(request(0x23, TYPE, bytes), &[UnsupportedAccess, ReadOnly])
}

pub(super) fn read_write_only(dut: &mut Dut<'_>) -> Checked {
    let mut entries = dut.eds.dictionary().entries();
    let Some(entry) = entries.find(|entry| entry.access == Access::Wo) else {
        return lacks("no object is write only");
    };
    dut.refuses(
        request(0x40, entry.address, [0; 4]),
        &[UnsupportedAccess, WriteOnly],
    )
}

/// In each object that can be written, the sub-index after the last one, and 7Fh.
pub(super) fn write_no_sub_index(dut: &mut Dut<'_>) -> Checked {
    let mut ends: Vec<(u16, u8, usize)> = Vec::new();
    for entry in dut.eds.writable() {
        let Address { index, sub } = entry.address;
        let size = entry.data_type.size().filter(|size| *size <= 4);
        // The sub-index after a mapping or a communication parameter may be refused for its state.
        if let Some(size) = size.filter(|_| !(0x1400..=0x1BFF).contains(&index)) {
            match ends.iter_mut().find(|(known, ..)| *known == index) {
                Some((_, last, _)) => *last = sub.max(*last),
                None => ends.push((index, sub, size)),
            }
        }
    }
    if ends.is_empty() {
        let codes = &[NoSubIndex, UnsupportedAccess, ReadOnly];
        return dut.refuses(request(0x2B, Address::new(0x1000, 0x7F), [0; 4]), codes);
    }
    for (index, last, size) in ends {
        let command = 0x23 | (4 - size as u8) << 2;
        let all = [last.saturating_add(1), 0x7F];
        let missing = all
            .into_iter()
            .filter(|sub| dut.eds.entry(index, *sub).is_none());
        for sub in missing.collect::<Vec<u8>>() {
            let done = dut.refuses(
                request(command, Address::new(index, sub), [0; 4]),
                &[NoSubIndex],
            );
            dut.fault(done)?;
        }
    }
    Ok(())
}

pub(super) fn read_no_object(dut: &mut Dut<'_>) -> Checked {
    absent(dut, 0x40)
}

pub(super) fn write_no_object(dut: &mut Dut<'_>) -> Checked {
    absent(dut, 0x2B)
}

fn absent(dut: &mut Dut<'_>, command: u8) -> Checked {
    let Some(index) = dut.eds.missing() else {
        return lacks("the EDS has every object that could be missing");
    };
    // CiA 301 reserves the objects 0000h and FFFFh.
    for address in [(index, 0), (index, 1), (0, 0), (0xFFFF, 0)] {
        let address = Address::new(address.0, address.1);
        let done = dut.refuses(request(command, address, [0; 4]), &[NoObject]);
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn unknown_command(dut: &mut Dut<'_>) -> Checked {
    for command in 0xE0..=0xFF {
        let answer = dut.answer(request(command, TYPE, [0; 4]))?;
        is_abort(&answer, &[InvalidCommand])?;
    }
    dut.still_serves()
}

pub(super) fn too_long(dut: &mut Dut<'_>) -> Checked {
    refuses_lengths(dut, TooLong)
}

/// Each number refuses the other lengths of an expedited download that have this abort code.
fn refuses_lengths(dut: &mut Dut<'_>, code: AbortCode) -> Checked {
    let is_long = code == TooLong;
    for entry in numbers(dut, if is_long { 1..=3 } else { 2..=4 })? {
        let before = dut.keep(entry.address)?;
        let lens = if is_long {
            before.len() + 1..5
        } else {
            1..before.len()
        };
        for len in lens {
            let mut bytes = before.clone();
            bytes.resize(len, 0);
            let done = refuses_length(dut, &entry, &before, bytes, code);
            dut.fault(done)?;
        }
    }
    Ok(())
}

/// A value of another length is refused, and changes nothing.
fn refuses_length(
    dut: &mut Dut<'_>,
    entry: &Entry,
    before: &[u8],
    mut bytes: Vec<u8>,
    code: AbortCode,
) -> Checked {
    // Another value, so that the abort shows whether it was written.
    bytes.iter_mut().take(1).for_each(|byte| *byte ^= 1);
    dut.refuses_value(entry.address, &bytes, &[Length, code])?;
    unchanged(dut, entry.address, before)?;
    dut.write(entry.address, before)
}

/// A refused value does not change the object.
fn unchanged(dut: &mut Dut<'_>, address: Address, before: &[u8]) -> Checked {
    let after = dut.read(address)?;
    ensure(
        after == before,
        format!("{} in {address} after the abort", values::hex(before)),
        format!("{} was read", values::hex(&after)),
    )
}

pub(super) fn too_short(dut: &mut Dut<'_>) -> Checked {
    refuses_lengths(dut, TooShort)
}

/// Writable numbers of these sizes: the first of each object, and the inhibit time of EMCY messages.
fn numbers(dut: &Dut<'_>, sizes: RangeInclusive<usize>) -> Checked<Vec<Entry>> {
    let fits = |entry: &Entry| {
        let size = entry.data_type.size();
        is_number(entry) && size.is_some_and(|size| sizes.contains(&size))
    };
    let inhibit = dut.eds.entry(0x1015, 0);
    let inhibit = inhibit.filter(|entry| entry.access.writable());
    let all = dut.eds.writable().into_iter().chain(inhibit);
    let mut all: Vec<Entry> = all.filter(fits).collect();
    // 1019h can be written only while 1006h is 0.
    all.retain(|entry| entry.address.index != 0x1019);
    all.sort_by_key(|entry| entry.address);
    all.dedup_by_key(|entry| (entry.address.index, entry.data_type.size()));
    if all.is_empty() {
        let (least, most) = sizes.into_inner();
        return lacks(format!(
            "no number of {least} to {most} bytes can be written"
        ));
    }
    Ok(all)
}

pub(super) fn above_high(dut: &mut Dut<'_>) -> Checked {
    beyond(dut, true)
}

pub(super) fn below_low(dut: &mut Dut<'_>) -> Checked {
    beyond(dut, false)
}

/// The first object with a limit.
fn beyond(dut: &mut Dut<'_>, high: bool) -> Checked {
    for entry in dut.eds.writable() {
        if let Some(bytes) = outside(&entry, high, dut.node.raw()) {
            return out_of_range(dut, &entry, &bytes, high);
        }
    }
    lacks("no object that can be written has such a limit")
}

/// A value just outside a limit, if the type can express it.
pub(super) fn outside(entry: &Entry, high: bool, node: u8) -> Option<Vec<u8>> {
    let (least, most) = entry.data_type.integer_range()?;
    let (low, top) = (entry.low.integer(node), entry.high.integer(node));
    if low > top && top.is_some() {
        return None;
    }
    let value = if high { top? + 1 } else { low? - 1 };
    let size = entry.data_type.size()?;
    let fits = (least..=most).contains(&value);
    fits.then(|| value.to_le_bytes()[..size].to_vec())
}

/// A value outside a limit is refused.
pub(super) fn out_of_range(dut: &mut Dut<'_>, entry: &Entry, bytes: &[u8], high: bool) -> Checked {
    let code = if high { ValueTooHigh } else { ValueTooLow };
    let before = dut.read(entry.address)?;
    let done = dut.refuses_value(entry.address, bytes, &[ValueRange, code]);
    // A value that changes without a write, such as a counter, is not saved.
    let done = done.and_then(|()| match entry.group {
        Group::None => Ok(()),
        _ => unchanged(dut, entry.address, &before),
    });
    if done.is_err() {
        dut.undo.push((entry.address, before));
    }
    done
}

pub(super) fn parameters(dut: &mut Dut<'_>) -> Checked {
    let node = u64::from(dut.node.raw());
    for (sub, base) in [(1, 0x600), (2, 0x580)] {
        let is = dut.number(0x1200, sub)?;
        let right = base + node;
        ensure(
            is == right,
            format!("1200h:{sub:02} = {right:X}h"),
            format!("{is:X}h was read"),
        )?;
    }
    Ok(())
}

/// The node does not respond to requests for another node, which do not disturb a transfer of its own either.
pub(super) fn other_node(dut: &mut Dut<'_>) -> Checked {
    let raw = dut.node.raw();
    let other = 0x600 + u16::from(if raw == 127 { 126 } else { raw + 1 });
    let id = dut.id(0x580);
    // No node has node ID 0.
    for other in [other, 0x600] {
        dut.send_to(other, &request(0x40, TYPE, [0; 4]))?;
        dut.silent(id, QUIET, "no response to a request to another node")?;
    }
    dut.still_serves()?;
    let (address, bytes) = match segments::long_value(dut) {
        Err(End::NotApplicable(_)) => return Ok(()),
        found => found?,
    };
    segments::begin(dut, address)?;
    for (command, rest) in [(0x40, [0; 4]), (0x60, [0; 4]), (0x80, [0, 0, 0, 8])] {
        dut.send_to(other, &request(command, TYPE, rest))?;
    }
    // Without a pause: some servers end a transfer whose client waits for 25 ms. A response to these requests would be
    // taken for that to the next segment.
    let again = dut.segments(None)?;
    ensure(
        again == bytes,
        format!(
            "{} of {address}, after requests to another node",
            values::hex(&bytes)
        ),
        format!("{} came", values::hex(&again)),
    )
}

/// A frame of 29 bits whose number is that of the request is another frame.
pub(super) fn extended_frame(dut: &mut Dut<'_>) -> Checked {
    let id = CanId::extended(dut.id(0x600).into());
    dut.drain()?;
    dut.send(Frame::full(id, request(0x40, TYPE, [0; 4])))?;
    let id = dut.id(0x580);
    dut.silent(id, QUIET, "no response to a frame with a CAN-ID of 29 bits")?;
    dut.still_serves()
}

/// Frames that are not requests do not disturb the server.
pub(super) fn no_request(dut: &mut Dut<'_>) -> Checked {
    let id = dut.id(0x600);
    dut.send_to(id, &[])?;
    dut.send_to(id, &[0x40])?;
    dut.wait(QUIET)?;
    dut.ask_for(CanId::standard(id), 8)?;
    let response = dut.id(0x580);
    dut.silent(response, QUIET, "no SDO response to a remote frame")?;
    dut.still_serves()
}

/// Requests without a pause after each response.
pub(super) fn in_a_row(dut: &mut Dut<'_>) -> Checked {
    let first = dut.read(TYPE)?;
    for _ in 0..50 {
        let again = dut.read(TYPE)?;
        ensure(
            again == first,
            "the same value each time",
            values::hex(&again),
        )?;
    }
    Ok(())
}

/// The node does not respond to an abort of the client.
pub(super) fn abort_silence(dut: &mut Dut<'_>) -> Checked {
    let abort = request(0x80, TYPE, [0, 0, 0, 8]);
    dut.drain()?;
    dut.send(Frame::full(dut.node.plus(0x600), abort))?;
    let id = dut.id(0x580);
    match dut.next(QUIET, |frame| is_data(frame, id))? {
        Some(heard) => fail("no response to an abort", format!("{} came", heard.frame)),
        None => dut.still_serves(),
    }
}

/// The abort of a refused download names the object of its own request, also after other transfers.
pub(super) fn abort_names_object(dut: &mut Dut<'_>) -> Checked {
    for address in [Address::new(0x1000, 0x33), Address::new(0x1018, 0x77)] {
        let answer = dut.answer(request(0x40, address, [0; 4]))?;
        let got = format!("{} came", values::hex(&answer));
        let is_right = abort_of(&answer).is_some()
            && answer[1..3] == address.index.to_le_bytes()
            && answer[3] == address.sub;
        ensure(is_right, format!("an abort that names {address}"), got)?;
    }
    Ok(())
}

/// A transfer with its own object and value.
pub(super) type Act = Box<dyn Fn(&mut Dut<'_>) -> Checked>;

/// Each kind of transfer that the node has.
pub(super) fn kinds(dut: &mut Dut<'_>) -> Checked<Vec<(&'static str, Act)>> {
    let missing = Address::new(0x1000, 0x7F);
    let mut all: Vec<(&str, Act)> = vec![
        ("an upload", Box::new(|dut| dut.still_serves())),
        (
            "a refused upload",
            Box::new(move |dut| {
                let answer = dut.answer(request(0x40, missing, [0; 4]))?;
                ensure(
                    abort_of(&answer).is_some(),
                    format!("an abort for {missing}"),
                    format!("{} came", values::hex(&answer)),
                )
            }),
        ),
    ];
    if let Some((address, bytes)) = optional(segments::long_value(dut))? {
        let value = bytes.clone();
        let read = move |dut: &mut Dut<'_>| dut.is_as_written(address, &value);
        all.push(("an upload by segments", Box::new(read)));
        let read = move |dut: &mut Dut<'_>| block::has(dut, address, &bytes);
        all.push(("an upload by block", Box::new(read)));
        let break_off = move |dut: &mut Dut<'_>| {
            segments::begin(dut, address)?;
            dut.answer([0x60, 0, 0, 0, 0, 0, 0, 0])?;
            let abort = request(0x80, address, [0, 0, 0, 8]);
            dut.send(Frame::full(dut.node.plus(0x600), abort))
        };
        all.push(("an upload that the client aborts", Box::new(break_off)));
    }
    if let Some((address, bytes)) = segments::long_writable(dut)? {
        dut.keep(address)?;
        // Another text and then its own.
        let entry = dut.eds.entry(address.index, address.sub);
        let is_text = entry.is_some_and(|entry| entry.data_type == DataType::VisibleString);
        let mut other = bytes.clone();
        other
            .iter_mut()
            .take(1)
            .for_each(|byte| *byte ^= u8::from(is_text) << 5);
        let both = [other, bytes];
        let values = both.clone();
        let write = move |dut: &mut Dut<'_>| {
            let mut values = values.iter();
            values.try_for_each(|value| segments::written(dut, address, value, 7, true))
        };
        all.push(("a long download by segments", Box::new(write)));
        let write = move |dut: &mut Dut<'_>| {
            let mut values = both.iter();
            values.try_for_each(|value| block::writes(dut, address, value))
        };
        all.push(("a download by block", Box::new(write)));
    }
    if let Some((address, bytes)) = optional(segments::short_value(dut))? {
        let value = bytes.clone();
        let write = move |dut: &mut Dut<'_>| dut.write(address, &value);
        all.push(("a download", Box::new(write)));
        let write =
            move |dut: &mut Dut<'_>| segments::written(dut, address, &bytes, bytes.len() / 2, true);
        all.push(("a download by segments", Box::new(write)));
    }
    // A kind that the node does not have, or that is wrong alone, is the matter of another case.
    let mut here = Vec::new();
    for (name, act) in all {
        match dut.still_serves().and_then(|()| act(dut)) {
            Ok(()) => here.push((name, act)),
            Err(End::Lost(fault)) => return Err(End::Lost(fault)),
            Err(_) => {}
        }
    }
    Ok(here)
}

/// Each kind of transfer directly after each other one, and twice.
pub(super) fn each_after_each(dut: &mut Dut<'_>) -> Checked {
    let all = kinds(dut)?;
    for (before, first) in &all {
        for (name, second) in &all {
            let done = first(dut).and_then(|()| second(dut));
            let done = done.map_err(|end| match end {
                End::Fail { expected, got } => End::Fail {
                    expected: format!("{expected}, in {name} after {before}"),
                    got,
                },
                end => end,
            });
            dut.fault(done)?;
        }
    }
    Ok(())
}
