//! Expedited transfers, and requests that a server refuses.

use std::ops::RangeInclusive;

use od_model::{Access, Address, Entry, Group, values};
use od_wire::AbortCode::{
    InvalidCommand, Length, NoObject, NoSubIndex, ReadOnly, TooLong, TooShort, UnsupportedAccess,
    ValueRange, ValueTooHigh, ValueTooLow, WriteOnly,
};
use od_wire::{AbortCode, CanId, CobId, Frame};

use super::{block, segments};
use crate::conform::dut::{ANSWER, Dut, FREE, QUIET, is_data};
use crate::conform::eds::is_number;
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::{abort_of, abort_text, is_abort, number, request};

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

/// The object, if the node has one for this test.
fn optional<T>(found: Checked<T>) -> Checked<Option<T>> {
    match found {
        Err(End::NotApplicable(_)) => Ok(None),
        found => found.map(Some),
    }
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

/// The node has the SDO servers of the EDS from 1201h on, and no others.
/// Each server of the EDS responds on its own CAN-IDs; one that is not valid gets some first.
pub(super) fn servers(dut: &mut Dut<'_>) -> Checked {
    listed(dut, 0x1201..=0x1208)?;
    for index in 0x1201..=0x1208 {
        let done = serves(dut, index);
        dut.fault(done)?;
    }
    Ok(())
}

/// CAN-IDs of an SDO server: of its requests and of its responses.
#[derive(Clone, Copy)]
pub(super) struct Channel {
    ask: CanId,
    answer: CanId,
    /// Index of its parameters.
    index: u16,
}

impl Channel {
    /// The channel of a server from 1201h on, which gets CAN-IDs for the case if it is not valid; `None` if it cannot.
    pub(super) fn of(dut: &mut Dut<'_>, index: u16) -> Checked<Option<Self>> {
        if dut.eds.entry(index, 2).is_none() {
            return Ok(None);
        }
        // The COB-ID of the responses comes first: the channel is valid as soon as both are valid.
        let parts = [Address::new(index, 2), Address::new(index, 1)];
        let mut ids = Vec::new();
        for (address, free) in parts.into_iter().zip([0x6D0, 0x6B0]) {
            let mut cob_id = CobId::new(dut.number(index, address.sub)? as u32);
            if !cob_id.is_valid() {
                let own = CobId::new(free + u32::from(index & 0xF));
                dut.keep(address)?;
                if !dut.eds.writes(index, address.sub)
                    || dut.download(address, &own.raw().to_le_bytes())?.is_err()
                {
                    return Ok(None);
                }
                cob_id = own;
            }
            ids.push(cob_id.can_id());
        }
        let [answer, ask] = ids[..] else {
            return Ok(None);
        };
        Ok(Some(Self { ask, answer, index }))
    }

    /// Sends a request; returns the response, if one comes within the time.
    pub(super) fn ask(
        self,
        dut: &mut Dut<'_>,
        request: [u8; 8],
        micros: u64,
    ) -> Checked<Option<Frame>> {
        dut.drain()?;
        dut.send(Frame::full(self.ask, request))?;
        let heard = dut.awaited(micros, |frame| {
            frame.id() == self.answer && !frame.is_remote()
        })?;
        Ok(heard.map(|heard| heard.frame))
    }

    /// A value of more than four bytes, by segments.
    fn long(self, dut: &mut Dut<'_>, address: Address) -> Checked<Vec<u8>> {
        self.serves(dut, request(0x40, address, [0; 4]))?;
        let (mut bytes, mut toggle) = (Vec::new(), 0);
        loop {
            let Some(frame) = self.ask(dut, [0x60 | toggle, 0, 0, 0, 0, 0, 0, 0], ANSWER)? else {
                return fail(
                    format!("a segment {} of {address}", self.answer),
                    "none came",
                );
            };
            let [command, data @ ..] = *frame.bytes();
            ensure(
                command & 0xF0 == toggle && bytes.len() < 1 << 20,
                format!("a segment {toggle:02X}h to {:02X}h", toggle | 0xF),
                format!("{frame} came"),
            )?;
            bytes.extend_from_slice(&data[..7 - usize::from(command >> 1 & 7)]);
            if command & 1 == 1 {
                return Ok(bytes);
            }
            toggle ^= 0x10;
        }
    }

    /// The response to a request, which must be about its object.
    fn serves(self, dut: &mut Dut<'_>, request: [u8; 8]) -> Checked<[u8; 8]> {
        let Self { ask, answer, index } = self;
        let expected = format!("a response {answer} to {ask}, by the SDO server {index:04X}h");
        match self.ask(dut, request, ANSWER)? {
            Some(frame) => {
                ensure(
                    frame.dlc() == 8 && frame.bytes()[1..4] == request[1..4],
                    expected,
                    format!("{frame} came"),
                )?;
                Ok(*frame.bytes())
            }
            None => fail(expected, "none came"),
        }
    }
}

/// Uploads and a download by this server, and an abort.
fn serves(dut: &mut Dut<'_>, index: u16) -> Checked {
    let Some(channel) = Channel::of(dut, index)? else {
        return Ok(());
    };
    channel.serves(dut, request(0x40, TYPE, [0; 4]))?;
    if let Some(missing) = dut.eds.missing() {
        let answer = channel.serves(dut, request(0x40, Address::new(missing, 0), [0; 4]))?;
        is_abort(&answer, &[NoObject])?;
    }
    match segments::long_value(dut) {
        Err(End::NotApplicable(_)) => {}
        found => {
            let (address, bytes) = found?;
            let again = channel.long(dut, address)?;
            ensure(
                again == bytes,
                format!(
                    "{} of {address} by the SDO server {index:04X}h",
                    values::hex(&bytes)
                ),
                format!("{} came", values::hex(&again)),
            )?;
        }
    }
    let Some((address, value)) = another_value(dut)? else {
        return Ok(());
    };
    dut.keep(address)?;
    let answer = channel.serves(dut, request(0x2B, address, [value[0], value[1], 0, 0]))?;
    ensure(
        answer[0] == 0x60,
        format!("the confirmation of a download by the SDO server {index:04X}h, 60h"),
        format!("{} came", values::hex(&answer)),
    )?;
    let is = dut.read(address)?;
    ensure(
        is == value,
        format!(
            "{} in {address}, as written by the SDO server {index:04X}h",
            values::hex(&value)
        ),
        format!("{} was read", values::hex(&is)),
    )?;
    is_off(dut, channel)
}

/// A server whose COB-ID is not valid does not respond.
fn is_off(dut: &mut Dut<'_>, channel: Channel) -> Checked {
    let index = channel.index;
    if !dut.eds.writes(index, 1) {
        return Ok(());
    }
    let address = Address::new(index, 1);
    let off = number(&dut.keep(address)?) as u32 | 1 << 31;
    if dut.download(address, &off.to_le_bytes())?.is_err() {
        return Ok(());
    }
    match channel.ask(dut, request(0x40, TYPE, [0; 4]), QUIET)? {
        Some(frame) => fail(
            format!("no response of the SDO server {index:04X}h, whose COB-ID is not valid"),
            format!("{frame} came"),
        ),
        None => Ok(()),
    }
}

/// Each SDO server has a transfer of its own.
pub(super) fn servers_parallel(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = segments::long_value(dut)?;
    let mut any = false;
    for index in 0x1201..=0x1208 {
        let Some(channel) = Channel::of(dut, index)? else {
            continue;
        };
        any = true;
        segments::begin(dut, address)?;
        channel.serves(dut, request(0x40, TYPE, [0; 4]))?;
        let again = dut.segments(None)?;
        let done = ensure(
            again == bytes,
            format!(
                "{} of {address} by the first SDO server, while {index:04X}h serves, too",
                values::hex(&bytes)
            ),
            format!("{} came", values::hex(&again)),
        );
        dut.fault(done)?;
    }
    at_least_one(any, "the node has one SDO server")
}

pub(super) fn clients(dut: &mut Dut<'_>) -> Checked {
    listed(dut, 0x1280..=0x1288)
}

/// While an SDO client is not valid its COB-IDs can have other CAN-IDs; then it can be made valid, and not valid again.
pub(super) fn clients_valid(dut: &mut Dut<'_>) -> Checked {
    const NOT_VALID: u32 = 1 << 31;
    let mut any = false;
    for index in 0x1280..=0x1288 {
        let both = [1, 2].map(|sub| Address::new(index, sub));
        if !both.iter().all(|one| dut.eds.writes(one.index, one.sub)) {
            continue;
        }
        any = true;
        for address in both {
            dut.keep(address)?;
            let off = dut.number(index, address.sub)? as u32 | NOT_VALID;
            dut.write(address, &off.to_le_bytes())?;
        }
        let ids = both.map(|one| (one, u32::from(FREE + 0x18) + u32::from(one.sub)));
        for flag in [NOT_VALID, 0, NOT_VALID] {
            for (address, id) in ids {
                let value = (id | flag).to_le_bytes();
                dut.write(address, &value)?;
                let done = dut.is_as_written(address, &value);
                dut.fault(done)?;
            }
        }
        let server = Address::new(index, 3);
        if dut.eds.writes(index, 3) {
            let before = dut.keep(server)?;
            let other = [if before == [2] { 3 } else { 2 }];
            dut.write(server, &other)?;
            let done = dut.is_as_written(server, &other);
            dut.fault(done)?;
        }
    }
    at_least_one(any, "no COB-ID of an SDO client can be written")
}

/// The node has the objects of this range in the EDS, and no others.
pub(super) fn listed(dut: &mut Dut<'_>, range: impl Iterator<Item = u16>) -> Checked {
    for index in range {
        let has = dut.eds.has(index);
        let answer = dut.upload(Address::new(index, 0))?;
        match answer {
            Err(code) if code == NoObject.code() => {
                ensure(
                    !has,
                    format!("{index:04X}h, as the EDS has it"),
                    abort_text(code),
                )?;
            }
            _ => ensure(
                has,
                format!("no {index:04X}h, as the EDS has none"),
                "the node has it",
            )?,
        }
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
    dut.ask_for(od_wire::CanId::standard(id), 8)?;
    dut.wait(QUIET)?;
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
