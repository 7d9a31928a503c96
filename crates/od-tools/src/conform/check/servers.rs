//! SDO servers besides the default one, and SDO clients.

use od_model::{Address, values};
use od_wire::AbortCode::NoObject;
use od_wire::{CanId, CobId, Frame};

use super::segments;
use super::transfer::another_value;
use crate::conform::dut::{ANSWER, Dut, FREE, QUIET};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, optional};
use crate::conform::sdo::{abort_text, is_abort, number, request};

const TYPE: Address = Address::new(0x1000, 0);

/// The node has the SDO servers of the EDS from 1201h on, and no others. Each responds on its own CAN-IDs; one that is not
/// valid gets some first.
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
        self.segments(dut, address)
    }

    /// The segments of an upload that has begun.
    fn segments(self, dut: &mut Dut<'_>, address: Address) -> Checked<Vec<u8>> {
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
    pub(super) fn serves(self, dut: &mut Dut<'_>, request: [u8; 8]) -> Checked<[u8; 8]> {
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

/// Each SDO server has a transfer of its own, which no request and no abort of another one ends.
pub(super) fn servers_parallel(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = segments::long_value(dut)?;
    // Another value by the other server, if there is one.
    let other = optional(segments::long_value_except(dut, Some(address)))?;
    let (second, further_bytes) = other.unwrap_or((address, bytes.clone()));
    let abort = request(0x80, address, [0, 0, 0, 8]);
    let mut any = false;
    for index in 0x1201..=0x1208 {
        let Some(channel) = Channel::of(dut, index)? else {
            continue;
        };
        any = true;
        segments::begin(dut, address)?;
        channel.serves(dut, request(0x40, TYPE, [0; 4]))?;
        // A server may refuse an object while another one sends its value.
        channel.serves(dut, request(0x40, second, [0; 4]))?;
        dut.send(Frame::full(channel.ask, abort))?;
        dut.settle(5_000)?;
        let first = dut.segments(None)?;
        channel.serves(dut, request(0x40, second, [0; 4]))?;
        let _ = dut.upload(address)?;
        dut.send(Frame::full(dut.node.plus(0x600), abort))?;
        dut.settle(5_000)?;
        let further = channel.segments(dut, second)?;
        let first_name = format!("{address} by the first SDO server, while {index:04X}h");
        let further_name = format!("{second} by {index:04X}h, while the first one");
        for (again, bytes, name) in [
            (first, &bytes, first_name),
            (further, &further_bytes, further_name),
        ] {
            let done = ensure(
                again == *bytes,
                format!(
                    "{} of {name} serves and is told of an abort, too",
                    values::hex(bytes)
                ),
                format!("{} came", values::hex(&again)),
            );
            dut.fault(done)?;
        }
        let kept = dut.undo.len();
        let done = downloads_parallel(dut, channel);
        dut.fault(done)?;
        dut.put_back_since(kept)?;
    }
    at_least_one(any, "the node has one SDO server")
}

/// A download of one segment by this server, between two segments of a download by the first one.
fn downloads_parallel(dut: &mut Dut<'_>, channel: Channel) -> Checked {
    let (Some((long, before)), Some((short, value))) =
        (segments::long_writable(dut)?, another_value(dut)?)
    else {
        return Ok(());
    };
    dut.keep(long)?;
    dut.keep(short)?;
    let mut bytes = before[..8].to_vec();
    bytes.rotate_left(1);
    segments::begin_download(dut, long, bytes.len())?;
    dut.answer(segments::segment(0, &bytes[..7]))?;
    let size = [value.len() as u8, 0, 0, 0];
    channel.serves(dut, request(0x21, short, size))?;
    channel.ask(dut, segments::segment(1, &value), ANSWER)?;
    dut.answer(segments::segment(0x11, &bytes[7..]))?;
    for (address, wanted) in [(long, bytes), (short, value)] {
        let is = dut.read(address)?;
        let done = ensure(
            is == wanted,
            format!(
                "{} in {address}, as two SDO servers received values at the same time",
                values::hex(&wanted)
            ),
            format!("{} was read", values::hex(&is)),
        );
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn clients(dut: &mut Dut<'_>) -> Checked {
    listed(dut, 0x1280..=0x1288)
}

/// While an SDO client is not valid its COB-IDs can have other CAN-IDs; then it can be made valid, keeps them while it is,
/// and can be made not valid again.
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
            if flag == 0 {
                for (address, id) in ids {
                    let done = client_keeps(dut, address, id);
                    dut.fault(done)?;
                }
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

/// The COB-ID of an SDO client that is valid takes its own value, and no other CAN-ID.
fn client_keeps(dut: &mut Dut<'_>, address: Address, id: u32) -> Checked {
    dut.write(address, &id.to_le_bytes())?;
    for other in [id ^ 1, id ^ 0x40, id | 1 << 29] {
        let done = dut.cannot_change(
            address,
            &other.to_le_bytes(),
            "as the SDO client is valid with another CAN-ID",
        );
        if done.is_err() {
            for value in [other | 1 << 31, id | 1 << 31, id] {
                dut.write(address, &value.to_le_bytes())?;
            }
        }
        done?;
    }
    dut.is_as_written(address, &id.to_le_bytes())
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
