//! Block transfers, which a server does not have to support.

use od_model::{Address, Entry, values};
use od_wire::AbortCode::{
    self, Crc, InvalidBlockSize, InvalidCommand, InvalidSequence, Length, NoObject, OutOfMemory,
    ReadOnly, TooLong, TooShort, UnsupportedAccess,
};
use od_wire::Frame;

use super::segments::{ended_by_abort, ends, long_value, short_value};
use crate::conform::dut::{ANSWER, Dut, QUIET, is_data};
use crate::conform::end::{Checked, End, ensure, fail, lacks};
use crate::conform::record::Traced;
use crate::conform::sdo::{abort_of, abort_text, crc, is_abort, names, request, reserved_are_0};

/// Variant of a block transfer of a client.
#[derive(Clone, Copy)]
struct How {
    crc: bool,
    /// Segments in the first block.
    size: u8,
    /// Segments in each further block.
    next: u8,
    /// The client treats this segment of the first block as lost.
    lost: Option<u8>,
}

const PLAIN: How = How {
    crc: false,
    size: 127,
    next: 127,
    lost: None,
};

/// Returns whether this is the abort of a server without block transfers.
fn refused(answer: &[u8; 8]) -> bool {
    let codes = [InvalidCommand.code(), AbortCode::UnsupportedAccess.code()];
    abort_of(answer).is_some_and(|code| codes.contains(&code))
}

fn without<T>() -> Checked<T> {
    lacks("the node refuses block transfers")
}

/// Begins a block upload; returns the size and whether the server computes a checksum.
fn begin(dut: &mut Dut<'_>, address: Address, how: How) -> Checked<(Option<usize>, bool)> {
    let first = request(0xA0 | u8::from(how.crc) << 2, address, [how.size, 0, 0, 0]);
    let answer = dut.answer(first)?;
    if refused(&answer) {
        return without();
    }
    let got = format!("{} came", values::hex(&answer));
    let is_right = answer[0] & 0xF9 == 0xC0 && answer[1..4] == first[1..4];
    ensure(
        is_right,
        "the response to a block upload, C0h to C6h, with the object",
        got,
    )?;
    let size = u32::from_le_bytes([answer[4], answer[5], answer[6], answer[7]]) as usize;
    Ok(((answer[0] & 2 != 0).then_some(size), answer[0] & 4 != 0))
}

/// Reads an object by block transfer.
fn read(dut: &mut Dut<'_>, address: Address, mut how: How) -> Checked<Vec<u8>> {
    let (size, server_crc) = begin(dut, address, how)?;
    dut.drain()?;
    dut.send(Frame::full(
        dut.node.plus(0x600),
        [0xA3, 0, 0, 0, 0, 0, 0, 0],
    ))?;
    let mut bytes = Vec::new();
    loop {
        let (mut good, mut is_last) = (0, false);
        let mut broken = false;
        for number in 1..=how.size {
            let Some(segment) = dut.response(ANSWER)? else {
                return fail(format!("segment {number} of the block"), "none came");
            };
            let got = format!("{} came", values::hex(&segment));
            if segment[0] == 0x80 {
                return fail(format!("segment {number} of the block"), got);
            }
            ensure(
                segment[0] & 0x7F == number,
                format!("sequence number {number}"),
                got,
            )?;
            broken |= how.lost == Some(number);
            if !broken {
                good = number;
                bytes.extend_from_slice(&segment[1..]);
                is_last = segment[0] & 0x80 != 0;
            }
            if segment[0] & 0x80 != 0 {
                break;
            }
        }
        (how.lost, how.size) = (None, how.next);
        dut.send(Frame::full(
            dut.node.plus(0x600),
            [0xA2, good, how.size, 0, 0, 0, 0, 0],
        ))?;
        if is_last {
            break;
        }
        ensure(
            bytes.len() < 1 << 20,
            "the last segment to be marked",
            "more than 1 MiB came",
        )?;
    }
    let Some(end) = dut.response(ANSWER)? else {
        return fail("the end of the block upload, C1h", "none came");
    };
    let got = format!("{} came", values::hex(&end));
    ensure(
        end[0] & 0xE3 == 0xC1,
        "the end of the block upload, C1h to DDh",
        got.clone(),
    )?;
    let unused = usize::from(end[0] >> 2 & 7);
    bytes.truncate(bytes.len().saturating_sub(unused));
    if how.crc && server_crc {
        let right = crc(&bytes);
        let is = u16::from_le_bytes([end[1], end[2]]);
        ensure(is == right, format!("checksum {right:04X}h"), got)?;
    } else {
        let is_none = end[1..3] == [0; 2];
        ensure(
            is_none,
            "0 in the bytes 1 and 2, as there is no checksum",
            got,
        )?;
    }
    dut.send(Frame::full(
        dut.node.plus(0x600),
        [0xA1, 0, 0, 0, 0, 0, 0, 0],
    ))?;
    let id = dut.id(0x580);
    dut.silent(id, 5_000, "no response to the end of a block upload")?;
    match size {
        Some(size) if size != bytes.len() => fail(
            format!("{size} bytes, as announced"),
            format!("{} bytes came", bytes.len()),
        ),
        _ => Ok(bytes),
    }
}

/// Reads a long value by block transfer. Returns whether the node has block transfers, and a value for one.
pub(super) fn serves(dut: &mut Dut<'_>) -> Checked<bool> {
    match same(dut, PLAIN) {
        Err(End::NotApplicable(_)) => Ok(false),
        done => done.map(|()| true),
    }
}

fn same(dut: &mut Dut<'_>, how: How) -> Checked {
    let (address, bytes) = long_value(dut)?;
    carries(dut, address, &bytes, how)?;
    dut.still_serves()
}

/// Fails unless a block upload with a checksum has these bytes.
pub(super) fn has(dut: &mut Dut<'_>, address: Address, bytes: &[u8]) -> Checked {
    carries(dut, address, bytes, How { crc: true, ..PLAIN })
}

/// Fails unless a block upload has these bytes.
fn carries(dut: &mut Dut<'_>, address: Address, bytes: &[u8], how: How) -> Checked {
    let again = read(dut, address, how)?;
    ensure(
        again == bytes,
        format!("{} in {address}", values::hex(bytes)),
        format!("{} came", values::hex(&again)),
    )
}

pub(super) fn upload(dut: &mut Dut<'_>) -> Checked {
    same(dut, PLAIN)
}

pub(super) fn upload_crc(dut: &mut Dut<'_>) -> Checked {
    let how = How { crc: true, ..PLAIN };
    same(dut, how)?;
    // Other lengths: a last segment that is full, and a value that fits a segment.
    let entries = dut.eds.dictionary().entries();
    let texts = entries.filter(|one| one.access.readable() && one.data_type.size().is_none());
    for entry in texts.take(8).collect::<Vec<Entry>>() {
        if let Ok(bytes) = dut.upload(entry.address)?
            && !bytes.is_empty()
        {
            let done = carries(dut, entry.address, &bytes, how);
            dut.fault(done)?;
        }
    }
    Ok(())
}

/// Uploads with a block for each segment, and with further blocks that are longer or shorter than the first.
pub(super) fn upload_blocks(dut: &mut Dut<'_>) -> Checked {
    for (size, next) in [(1, 1), (1, 2), (2, 1)] {
        let how = How {
            crc: true,
            size,
            next,
            lost: None,
        };
        let done = same(dut, how);
        dut.fault(done)?;
    }
    Ok(())
}

/// The first segments, each one lost in a transfer of its own.
pub(super) fn upload_lost(dut: &mut Dut<'_>) -> Checked {
    let (_, bytes) = long_value(dut)?;
    for lost in 1..=bytes.len().div_ceil(7).min(4) as u8 {
        let how = How {
            lost: Some(lost),
            crc: true,
            ..PLAIN
        };
        same(dut, how)?;
    }
    Ok(())
}

/// Uploads a short value by block, without a change to another protocol.
pub(super) fn upload_short(dut: &mut Dut<'_>) -> Checked {
    for (index, sub) in [
        (0x1000, 0),
        (0x1018, 0),
        (0x1018, 1),
        (0x1018, 3),
        (0x1017, 0),
    ] {
        let address = Address::new(index, sub);
        let is_there = dut.eds.entry(index, sub).is_some();
        if let Some(Ok(bytes)) = is_there.then(|| dut.upload(address)).transpose()? {
            carries(dut, address, &bytes, PLAIN)?;
        }
    }
    Ok(())
}

pub(super) fn upload_size_128(dut: &mut Dut<'_>) -> Checked {
    let (address, _) = long_value(dut)?;
    // A node without block transfers refuses the right sizes, too.
    begin(dut, address, PLAIN)?;
    let close = request(0x80, address, [0, 0, 0, 8]);
    dut.send(Frame::full(dut.node.plus(0x600), close))?;
    for size in [128, 0] {
        let answer = dut.answer(request(0xA0, address, [size, 0, 0, 0]))?;
        is_abort(&answer, &[InvalidBlockSize])?;
    }
    dut.still_serves()
}

/// Command of the end of a block upload, which has no response.
const END: u8 = 0xA1;

/// A request that does not belong to this part of a block upload gets an abort or nothing, and the next upload is right.
pub(super) fn upload_out_of_place(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    let with_crc = How { crc: true, ..PLAIN };
    let count = bytes.len().div_ceil(7).min(127) as u8;
    let confirm = [0xA2, count, 127];
    // Before the start of the upload, after its segments, and after the last confirmation.
    for (place, wrong) in [
        (0, confirm),
        (0, [END, 0, 0]),
        (1, [0xA3, 0, 0]),
        (1, [END, 0, 0]),
        (1, [0x60, 0, 0]),
        (2, [0xA3, 0, 0]),
        (2, confirm),
        (2, [0x60, 0, 0]),
    ] {
        let full = |[a, b, c]: [u8; 3]| [a, b, c, 0, 0, 0, 0, 0];
        begin(dut, address, PLAIN)?;
        if place > 0 {
            dut.send(Frame::full(dut.node.plus(0x600), full([0xA3, 0, 0])))?;
            for _ in 0..count {
                dut.response(ANSWER)?;
            }
        }
        if place > 1 {
            dut.answer(full(confirm))?;
        }
        if let Some(answer) = dut.ask_within(full(wrong), QUIET)? {
            let done = ensure(
                abort_of(&answer).is_some(),
                format!(
                    "an abort for {:02X}h {}",
                    wrong[0],
                    [
                        "before the start of a block upload",
                        "after a block",
                        "after the last block"
                    ][place]
                ),
                format!("{} came", values::hex(&answer)),
            );
            dut.fault(done)?;
        } else {
            let close = request(0x80, address, [0, 0, 0, 8]);
            dut.send(Frame::full(dut.node.plus(0x600), close))?;
            dut.settle(10_000)?;
        }
        carries(dut, address, &bytes, with_crc)?;
    }
    Ok(())
}

pub(super) fn upload_ack_128(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    let codes = [InvalidSequence, InvalidBlockSize, InvalidCommand];
    // A next block of 128 or of 0 segments, for the segments that the client lost.
    let sizes: &[[u8; 2]] = &[[128, 127], [1, 0], [1, 128]];
    for [number, size] in &sizes[..if bytes.len() > 7 { 3 } else { 1 }] {
        begin(dut, address, PLAIN)?;
        dut.send(Frame::full(
            dut.node.plus(0x600),
            [0xA3, 0, 0, 0, 0, 0, 0, 0],
        ))?;
        for _ in 0..bytes.len().div_ceil(7).min(127) {
            dut.response(ANSWER)?;
        }
        let answer = dut.answer([0xA2, *number, *size, 0, 0, 0, 0, 0])?;
        let refused = if *number == 128 {
            &[InvalidSequence, InvalidCommand][..]
        } else {
            &codes
        };
        ends(&answer, address, refused)?;
    }
    dut.still_serves()
}

/// Bytes that can be written, if possible more than one segment.
fn writable(dut: &mut Dut<'_>) -> Checked<(Address, Vec<u8>)> {
    for entry in dut.eds.writable() {
        if entry.data_type.size().is_none()
            && let Ok(bytes) = dut.upload(entry.address)?
            && bytes.len() > 7
        {
            return Ok((entry.address, bytes));
        }
    }
    short_value(dut)
}

/// Begins a block download; returns the size of a block, and whether the server checks the CRC.
fn begin_download(
    dut: &mut Dut<'_>,
    address: Address,
    how: How,
    len: usize,
) -> Checked<(u8, bool)> {
    let size = (len as u32).to_le_bytes();
    let first = request(0xC2 | u8::from(how.crc) << 2, address, size);
    let answer = dut.answer(first)?;
    if refused(&answer) {
        return without();
    }
    let got = format!("{} came", values::hex(&answer));
    let is_right = answer[0] & 0xFB == 0xA0 && answer[1..4] == first[1..4];
    ensure(
        is_right,
        "the response to a block download, A0h or A4h, with the object",
        got.clone(),
    )?;
    ensure(
        (1..=127).contains(&answer[4]),
        "a block of 1 to 127 segments",
        got,
    )?;
    Ok((answer[4], answer[0] & 4 != 0))
}

/// Writes bytes by block transfer; `spoil` makes the checksum wrong.
fn write(
    dut: &mut Dut<'_>,
    (address, bytes): (Address, &[u8]),
    how: How,
    spoil: u16,
) -> Checked<Result<(), u32>> {
    write_announced(dut, (address, bytes), how, spoil, bytes.len())
}

/// As [`write`], with another size in the first request.
fn write_announced(
    dut: &mut Dut<'_>,
    (address, bytes): (Address, &[u8]),
    mut how: How,
    spoil: u16,
    announced: usize,
) -> Checked<Result<(), u32>> {
    let (mut block, _) = begin_download(dut, address, how, announced)?;
    let segments: Vec<&[u8]> = bytes.chunks(7).collect();
    let mut done = 0;
    while done < segments.len() {
        let end = segments.len().min(done + usize::from(block));
        let mut wanted = (end - done) as u8;
        for (number, part) in (1u8..).zip(&segments[done..end]) {
            let is_last = done + usize::from(number) == segments.len();
            let mut data = [0; 8];
            data[0] = number | u8::from(is_last) << 7;
            data[1..=part.len()].copy_from_slice(part);
            if how.lost == Some(number) {
                wanted = number - 1;
                continue;
            }
            dut.send(Frame::full(dut.node.plus(0x600), data))?;
        }
        how.lost = None;
        let Some(answer) = dut.response(ANSWER)? else {
            return fail("the confirmation of a block, A2h", "none came");
        };
        if let Some(code) = abort_of(&answer) {
            names(&answer, address)?;
            return Ok(Err(code));
        }
        let got = format!("{} came", values::hex(&answer));
        let is_right = answer[0] == 0xA2 && answer[1] == wanted;
        ensure(
            is_right,
            format!("the confirmation of {wanted} segments, A2h {wanted:02X}h"),
            got,
        )?;
        ensure(
            (1..=127).contains(&answer[2]),
            "a next block of 1 to 127 segments",
            format!("{} came", values::hex(&answer)),
        )?;
        done += usize::from(wanted);
        block = answer[2];
    }
    let unused = (segments.len() * 7 - bytes.len()) as u8;
    let sum = if how.crc {
        (crc(bytes) ^ spoil).to_le_bytes()
    } else {
        [0; 2]
    };
    let answer = dut.answer([0xC1 | unused << 2, sum[0], sum[1], 0, 0, 0, 0, 0])?;
    if let Some(code) = abort_of(&answer) {
        names(&answer, address)?;
        return Ok(Err(code));
    }
    let got = format!("{} came", values::hex(&answer));
    ensure(answer[0] == 0xA1, "the end of the block download, A1h", got)?;
    let id = dut.id(0x580);
    dut.silent(id, 10_000, "one response to the end of the block download")?;
    Ok(Ok(()))
}

fn written(dut: &mut Dut<'_>, how: How) -> Checked {
    let (address, bytes) = writable(dut)?;
    puts(dut, address, &bytes, how)
}

/// A block download without a checksum, and an upload of its value.
pub(super) fn writes(dut: &mut Dut<'_>, address: Address, bytes: &[u8]) -> Checked {
    puts(dut, address, bytes, PLAIN)
}

fn puts(dut: &mut Dut<'_>, address: Address, bytes: &[u8], how: How) -> Checked {
    if let Err(code) = write(dut, (address, bytes), how, 0)? {
        return fail(
            format!("a block download to {address}"),
            format!("{} came", abort_text(code)),
        );
    }
    let after = dut.read(address)?;
    ensure(
        after == bytes,
        values::hex(bytes),
        format!("{} was read", values::hex(&after)),
    )
}

pub(super) fn download(dut: &mut Dut<'_>) -> Checked {
    written(dut, PLAIN)
}

pub(super) fn download_crc(dut: &mut Dut<'_>) -> Checked {
    written(dut, How { crc: true, ..PLAIN })
}

pub(super) fn download_lost(dut: &mut Dut<'_>) -> Checked {
    let (_, bytes) = writable(dut)?;
    let segments = bytes.len().div_ceil(7);
    if segments < 2 {
        return lacks("no value that can be written needs two segments");
    }
    // The server cannot know that the last one is lost.
    for lost in 1..segments.min(5) as u8 {
        let how = How {
            lost: Some(lost),
            crc: true,
            ..PLAIN
        };
        written(dut, how)?;
    }
    Ok(())
}

pub(super) fn download_wrong_crc(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = writable(dut)?;
    let how = How { crc: true, ..PLAIN };
    let (_, checks) = begin_download(dut, address, how, bytes.len())?;
    dut.send(Frame::full(
        dut.node.plus(0x600),
        request(0x80, address, [0, 0, 0, 8]),
    ))?;
    if !checks {
        return lacks("the server does not check a checksum");
    }
    match write(dut, (address, &bytes), how, 0x5555)? {
        Ok(()) => fail("abort 05040004h", "a wrong checksum was accepted"),
        Err(code) => is_abort(&request(0x80, address, code.to_le_bytes()), &[Crc]),
    }
}

/// A block download of more or of fewer bytes than the client announced is refused, and changes nothing.
pub(super) fn download_wrong_size(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = writable(dut)?;
    dut.keep(address)?;
    written(dut, PLAIN)?;
    let mut other = before.clone();
    other.iter_mut().take(1).for_each(|byte| *byte ^= 1);
    let codes = [Length, TooLong, TooShort, OutOfMemory, InvalidCommand];
    for announced in [before.len() + 1, before.len() - 1] {
        // A server may refuse the size itself.
        let size = (announced as u32).to_le_bytes();
        let answer = dut.answer(request(0xC2, address, size))?;
        if abort_of(&answer).is_some() {
            is_abort(&answer, &codes)?;
            continue;
        }
        let close = request(0x80, address, [0, 0, 0, 8]);
        dut.send(Frame::full(dut.node.plus(0x600), close))?;
        let done = match write_announced(dut, (address, &other), PLAIN, 0, announced)? {
            Ok(()) => fail(
                format!(
                    "an abort for {} bytes by a block download that announced {announced}",
                    other.len()
                ),
                "they were accepted",
            ),
            Err(code) => is_abort(&request(0x80, address, code.to_le_bytes()), &codes),
        };
        dut.fault(done)?;
        let done = dut.is_as_written(address, &before);
        dut.fault(done)?;
    }
    Ok(())
}

/// Bytes that CiA 301 reserves in the responses of a block download, and in the end of a block upload, are 0.
pub(super) fn reserved(dut: &mut Dut<'_>) -> Checked {
    let from = dut.frames.len();
    written(dut, PLAIN)?;
    reserved_are_0(dut, from, &[(0xA0, 5), (0xA4, 5), (0xA2, 3), (0xA1, 1)])?;
    let (address, _) = long_value(dut)?;
    read(dut, address, PLAIN)?;
    // The frames before the end are segments, whose first byte may have any value.
    let id = dut.id(0x580);
    let is_response = |traced: &Traced| !traced.ours && is_data(&traced.frame, id);
    let Some(end) = dut.frames.iter().rposition(is_response) else {
        return Ok(());
    };
    let command = dut.frames[end].frame.bytes()[0];
    reserved_are_0(dut, end, &[(command, 3)])
}

/// An abort of the client ends a block upload, before its start and after a block. The next one is right.
pub(super) fn aborted(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    let with_crc = How { crc: true, ..PLAIN };
    begin(dut, address, PLAIN)?;
    ended_by_abort(dut, address, &bytes, 0xA3)?;
    let how = How { size: 1, ..PLAIN };
    begin(dut, address, how)?;
    dut.answer([0xA3, 0, 0, 0, 0, 0, 0, 0])?;
    // As a client that restarts: its abort, and at once the next upload by block.
    let close = request(0x80, address, [0, 0, 0, 8]);
    dut.send(Frame::full(dut.node.plus(0x600), close))?;
    carries(dut, address, &bytes, with_crc)
}

/// An abort of the client ends a block download, which then wrote nothing.
pub(super) fn download_aborted(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = writable(dut)?;
    begin_download(dut, address, PLAIN, before.len())?;
    let server = dut.node.plus(0x600);
    let len = before.len().min(7);
    // A server may refuse a full segment for a shorter value at once.
    if before.len() > 7 {
        let mut segment = [1, 0, 0, 0, 0, 0, 0, 0];
        segment[1..].copy_from_slice(&before[..7]);
        segment[1] ^= 1;
        dut.send(Frame::full(server, segment))?;
    }
    dut.send(Frame::full(server, request(0x80, address, [0, 0, 0, 8])))?;
    let id = dut.id(0x580);
    dut.silent(id, QUIET, "no response to an abort")?;
    let unused = (7 - len) as u8;
    let answer = dut.answer([0xC1 | unused << 2, 0, 0, 0, 0, 0, 0, 0])?;
    ensure(
        abort_of(&answer).is_some(),
        "an abort: the transfer is over",
        format!("{} came", values::hex(&answer)),
    )?;
    let after = dut.read(address)?;
    ensure(
        after == before,
        format!("{address} unchanged, {}", values::hex(&before)),
        format!("{} was read", values::hex(&after)),
    )?;
    // The next block download is right.
    written(dut, PLAIN)
}

/// Block transfers are refused as other transfers: of an object that is missing, and a download to one that is read only.
pub(super) fn refused_objects(dut: &mut Dut<'_>) -> Checked {
    let (address, _) = long_value(dut)?;
    read(dut, address, PLAIN)?;
    if let Some(index) = dut.eds.missing() {
        let missing = Address::new(index, 0);
        let answer = dut.answer(request(0xA0, missing, [127, 0, 0, 0]))?;
        is_abort(&answer, &[NoObject])?;
    }
    let device_type = Address::new(0x1000, 0);
    let mut answer = dut.answer(request(0xC2, device_type, 4u32.to_le_bytes()))?;
    if answer[0] & 0xFB == 0xA0 {
        // A server may refuse the value at the end.
        answer = dut.answer([0x81, 0, 0, 0, 0, 0, 0, 0])?;
        if answer[0] == 0xA2 {
            answer = dut.answer([0xC1 | 3 << 2, 0, 0, 0, 0, 0, 0, 0])?;
        }
    } else if abort_of(&answer) == Some(InvalidCommand.code()) {
        return Ok(());
    }
    is_abort(&answer, &[UnsupportedAccess, ReadOnly])
}
