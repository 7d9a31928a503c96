//! Segmented transfers.

use od_model::{Access, Address, Entry, values};
use od_wire::AbortCode::{
    self, InvalidCommand, Length, NoObject, OutOfMemory, ReadOnly, ToggleBit, TooLong, TooShort,
    UnsupportedAccess,
};
use od_wire::Frame;
use od_wire::nmt::Command;

use crate::conform::dut::{Dut, QUIET};
use crate::conform::eds::is_number;
use crate::conform::end::{Checked, ensure, fail, lacks, optional, skip};
use crate::conform::sdo::{abort_of, abort_text, is_abort, names, request, reserved_are_0};

/// An object with a value of more than four bytes, if possible of more than seven.
pub(super) fn long_value(dut: &mut Dut<'_>) -> Checked<(Address, Vec<u8>)> {
    long_value_except(dut, None)
}

/// As [`long_value`], of another object than this one.
pub(super) fn long_value_except(
    dut: &mut Dut<'_>,
    except: Option<Address>,
) -> Checked<(Address, Vec<u8>)> {
    let dictionary = dut.eds.dictionary();
    let fits = |entry: &Entry| {
        entry.access.readable()
            && entry.data_type.size().is_none_or(|size| size > 4)
            && except != Some(entry.address)
    };
    let mut found = None;
    for entry in dictionary.entries().filter(fits).take(12) {
        if let Ok(bytes) = dut.upload(entry.address)?
            && bytes.len() > 4
        {
            let enough = bytes.len() > 7;
            found.get_or_insert((entry.address, bytes.clone()));
            if enough {
                return Ok((entry.address, bytes));
            }
        }
    }
    match found {
        Some(found) => Ok(found),
        None => lacks("no value has more than four bytes"),
    }
}

/// A number of two or four bytes that can be written, and its value.
pub(super) fn short_value(dut: &mut Dut<'_>) -> Checked<(Address, Vec<u8>)> {
    let fits = |entry: &Entry| matches!(entry.data_type.size(), Some(2 | 4));
    let Some(entry) = dut.eds.writable().into_iter().find(fits) else {
        return lacks("no number of two or four bytes can be written");
    };
    let before = dut.keep(entry.address)?;
    Ok((entry.address, before))
}

/// Begins a segmented upload; returns the size, if the server indicates it.
pub(super) fn begin(dut: &mut Dut<'_>, address: Address) -> Checked<Option<usize>> {
    let answer = dut.answer(request(0x40, address, [0; 4]))?;
    let got = format!("{} came", values::hex(&answer));
    ensure(
        matches!(answer[0], 0x40 | 0x41),
        "41h or 40h, a segmented upload",
        got,
    )?;
    let size = u32::from_le_bytes([answer[4], answer[5], answer[6], answer[7]]) as usize;
    Ok((answer[0] == 0x41).then_some(size))
}

pub(super) fn upload(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    let size = begin(dut, address)?;
    let again = dut.segments(size)?;
    ensure(again == bytes, values::hex(&bytes), values::hex(&again))
}

pub(super) fn upload_unused(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    begin(dut, address)?;
    let mut toggle = 0;
    for _ in 0..bytes.len().div_ceil(7) {
        let answer = dut.answer([0x60 | toggle, 0, 0, 0, 0, 0, 0, 0])?;
        let unused = usize::from(answer[0] >> 1 & 7);
        let got = format!("{} came", values::hex(&answer));
        ensure(
            answer[8 - unused..].iter().all(|byte| *byte == 0),
            "0 in the bytes without data",
            got,
        )?;
        toggle ^= 0x10;
    }
    Ok(())
}

pub(super) fn upload_toggle(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    // In the first request, and, if there is one, in the second.
    let wrong: &[&[u8]] = &[&[0x70], &[0x60, 0x60]];
    for commands in &wrong[..if bytes.len() > 7 { 2 } else { 1 }] {
        begin(dut, address)?;
        let mut answer = [0; 8];
        for command in *commands {
            answer = dut.answer([*command, 0, 0, 0, 0, 0, 0, 0])?;
        }
        ends(&answer, address, &[ToggleBit])?;
        // The abort ended the transfer.
        let answer = dut.answer([0x60, 0, 0, 0, 0, 0, 0, 0])?;
        is_abort(&answer, &[InvalidCommand, ToggleBit])?;
    }
    dut.still_serves()
}

/// Fails unless the server ends the transfer of an object with one of these aborts, which names the object.
pub(super) fn ends(answer: &[u8; 8], address: Address, codes: &[AbortCode]) -> Checked {
    is_abort(answer, codes)?;
    names(answer, address)
}

pub(super) fn download(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = short_value(dut)?;
    written(dut, address, &before, before.len(), true)
}

pub(super) fn download_unsized(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = short_value(dut)?;
    written(dut, address, &before, before.len(), false)
}

/// Downloads two segments, so that the toggle bit changes.
pub(super) fn download_two(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = short_value(dut)?;
    written(dut, address, &before, before.len() / 2, true)
}

/// A download by segments of `step` bytes, and an upload of its value.
pub(super) fn written(
    dut: &mut Dut<'_>,
    address: Address,
    bytes: &[u8],
    step: usize,
    sized: bool,
) -> Checked {
    if let Err(code) = dut.download_segments(address, bytes, sized, step)? {
        need_not(dut, code)?;
        let got = format!("{} came", abort_text(code));
        ensure(false, format!("a segmented download to {address}"), got)?;
    }
    let after = dut.read(address)?;
    ensure(
        after == bytes,
        values::hex(bytes),
        format!("{} was read", values::hex(&after)),
    )
}

/// A server whose values all fit into one frame does not have to support segmented downloads.
fn need_not(dut: &Dut<'_>, code: u32) -> Checked {
    let is_refused = [InvalidCommand, UnsupportedAccess]
        .iter()
        .any(|one| one.code() == code);
    let mut entries = dut.eds.dictionary().entries();
    let is_long = |entry: &Entry| {
        entry.access.writable() && entry.data_type.size().is_none_or(|size| size > 4)
    };
    if is_refused && !entries.any(|entry| is_long(&entry)) {
        lacks("the node refuses segmented downloads, and no value needs them")
    } else {
        Ok(())
    }
}

/// Begins a segmented download.
pub(super) fn begin_download(dut: &mut Dut<'_>, address: Address, size: usize) -> Checked {
    let answer = dut.answer(request(0x21, address, (size as u32).to_le_bytes()))?;
    if let Some(code) = abort_of(&answer) {
        need_not(dut, code)?;
    }
    let got = format!("{} came", values::hex(&answer));
    ensure(
        answer[0] == 0x60,
        "the confirmation of a download, 60h",
        got,
    )
}

/// Writes the present long value again.
pub(super) fn download_long(dut: &mut Dut<'_>) -> Checked {
    match long_writable(dut)? {
        Some((address, bytes)) => written(dut, address, &bytes, 7, true),
        None => lacks("no value of more than seven bytes can be written"),
    }
}

/// An object with a value of more than seven bytes that can be written.
pub(super) fn long_writable(dut: &mut Dut<'_>) -> Checked<Option<(Address, Vec<u8>)>> {
    for entry in dut.eds.writable() {
        if entry.data_type.size().is_some_and(|size| size <= 4) {
            continue;
        }
        if let Ok(bytes) = dut.upload(entry.address)?
            && bytes.len() > 7
        {
            return Ok(Some((entry.address, bytes)));
        }
    }
    Ok(None)
}

/// The wrong toggle bit in the first segment, and in the second.
pub(super) fn download_toggle(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = short_value(dut)?;
    let mut other = before.clone();
    other[0] ^= 1;
    let (half, rest) = other.split_at(other.len() / 2);
    for (parts, toggle) in [(&[&other[..]][..], 0x10), (&[half, rest], 0)] {
        begin_download(dut, address, before.len())?;
        let mut answer = [0; 8];
        for (number, part) in (1..).zip(parts) {
            let last = u8::from(number == parts.len());
            answer = dut.answer(segment(toggle | last, part))?;
        }
        ends(&answer, address, &[ToggleBit])?;
        unchanged(dut, address, &before)?;
    }
    Ok(())
}

/// A segment of a download; `flags` are its toggle bit, and bit 0 of the last one.
pub(super) fn segment(flags: u8, part: &[u8]) -> [u8; 8] {
    let mut segment = [0; 8];
    segment[0] = flags | (7 - part.len() as u8) << 1;
    segment[1..=part.len()].copy_from_slice(part);
    segment
}

fn unchanged(dut: &mut Dut<'_>, address: Address, before: &[u8]) -> Checked {
    let after = dut.read(address)?;
    ensure(
        after == before,
        format!("{address} unchanged, {}", values::hex(before)),
        format!("{} was read", values::hex(&after)),
    )
}

/// The client announces more bytes than the object has, or sends more than it announced.
pub(super) fn download_too_long(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = short_value(dut)?;
    let mut bytes = before.clone();
    bytes.resize(8, 0);
    let codes = [Length, TooLong, OutOfMemory];
    match dut.download_segments(address, &bytes, true, 7)? {
        Ok(()) => ensure(
            false,
            "abort 06070010h or 06070012h",
            "8 bytes were accepted",
        )?,
        Err(code) => {
            need_not(dut, code)?;
            is_abort(&request(0x80, address, code.to_le_bytes()), &codes)?;
        }
    }
    unchanged(dut, address, &before)?;
    // More bytes than were announced.
    begin_download(dut, address, before.len())?;
    bytes[0] ^= 1;
    let answer = dut.answer(segment(1, &bytes[..7]))?;
    ends(&answer, address, &codes)?;
    unchanged(dut, address, &before)
}

/// The client sends the last segment before all announced bytes: of a number, and of a value of any length.
pub(super) fn download_too_short(dut: &mut Dut<'_>) -> Checked {
    let mut all = vec![short_value(dut)?];
    if let Some((address, before)) = long_writable(dut)? {
        dut.keep(address)?;
        all.push((address, before));
    }
    for (address, before) in all {
        begin_download(dut, address, before.len())?;
        let answer = dut.answer(segment(1, &[before[0] ^ 1]))?;
        ends(&answer, address, &[Length, TooShort])?;
        unchanged(dut, address, &before)?;
    }
    Ok(())
}

/// A segment without a transfer is refused, and one of an upload in a download and the reverse.
pub(super) fn no_transfer(dut: &mut Dut<'_>) -> Checked {
    const OF_UPLOAD: [u8; 8] = [0x60, 0, 0, 0, 0, 0, 0, 0];
    const OF_DOWNLOAD: [u8; 8] = [0x0D, 0, 0, 0, 0, 0, 0, 0];
    dut.still_serves()?;
    for segment in [OF_UPLOAD, OF_DOWNLOAD] {
        let answer = dut.answer(segment)?;
        is_abort(&answer, &[InvalidCommand, ToggleBit])?;
    }
    if let Some((address, bytes)) = optional(long_value(dut))? {
        begin(dut, address)?;
        let answer = dut.answer(OF_DOWNLOAD)?;
        is_abort(&answer, &[InvalidCommand, ToggleBit])?;
        dut.is_as_written(address, &bytes)?;
    }
    let Some((address, before)) = optional(short_value(dut))? else {
        return Ok(());
    };
    if optional(begin_download(dut, address, before.len()))?.is_some() {
        let answer = dut.answer(OF_UPLOAD)?;
        is_abort(&answer, &[InvalidCommand, ToggleBit])?;
        unchanged(dut, address, &before)?;
    }
    Ok(())
}

/// After an abort of the client no transfer is open.
pub(super) fn aborted(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    begin(dut, address)?;
    ended_by_abort(dut, address, &bytes, 0x60)
}

/// The client aborts an open upload. Then a request with the command `next` of this upload is refused, and the object can
/// be read again.
pub(super) fn ended_by_abort(
    dut: &mut Dut<'_>,
    address: Address,
    bytes: &[u8],
    next: u8,
) -> Checked {
    dut.send(Frame::full(
        dut.node.plus(0x600),
        request(0x80, address, [0, 0, 0, 8]),
    ))?;
    let id = dut.id(0x580);
    dut.silent(id, QUIET, "no response to an abort")?;
    let answer = dut.answer([next, 0, 0, 0, 0, 0, 0, 0])?;
    ensure(
        abort_of(&answer).is_some(),
        "an abort: the transfer is over",
        format!("{} came", values::hex(&answer)),
    )?;
    let again = dut.read(address)?;
    ensure(again == bytes, values::hex(bytes), values::hex(&again))
}

/// Reset communication ends an open transfer.
pub(super) fn over_reset(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    begin(dut, address)?;
    dut.reset(Command::ResetCommunication)?;
    let answer = dut.answer([0x60, 0, 0, 0, 0, 0, 0, 0])?;
    ensure(
        abort_of(&answer).is_some(),
        "an abort: the reset ended the transfer",
        format!("{} came", values::hex(&answer)),
    )?;
    let again = dut.read(address)?;
    ensure(again == bytes, values::hex(&bytes), values::hex(&again))
}

/// A client that restarts a transfer in the middle gets its value.
pub(super) fn begin_again(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes) = long_value(dut)?;
    if bytes.len() <= 7 {
        return skip("no value needs two segments");
    }
    begin(dut, address)?;
    dut.answer([0x60, 0, 0, 0, 0, 0, 0, 0])?;
    // A server may end the old transfer with an abort first.
    if abort_of(&dut.answer(request(0x40, address, [0; 4]))?).is_none() {
        dut.send(Frame::full(
            dut.node.plus(0x600),
            request(0x80, address, [0, 0, 0, 8]),
        ))?;
    }
    let again = dut.read(address)?;
    ensure(again == bytes, values::hex(&bytes), values::hex(&again))
}

/// Bytes that CiA 301 reserves in the responses to a download are 0.
pub(super) fn reserved(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = short_value(dut)?;
    let from = dut.frames.len();
    dut.write(address, &before)?;
    let segmented = dut.download_segments(address, &before, true, before.len() / 2)?;
    let segments: &[(u8, usize)] = &[(0x20, 1), (0x30, 1)];
    let segments = if segmented.is_ok() { segments } else { &[] };
    let first = [&[(0x60, 4)], segments].concat();
    reserved_are_0(dut, from, &first)?;
    // Of every number: its own value, which a node may refuse for a PDO or a service that is valid.
    let mut all = dut.eds.writable();
    let has_bit_31 = |entry: &Entry| {
        entry.access.writable()
            && matches!(
                entry.address.index,
                0x1005 | 0x1012 | 0x1014 | 0x1015 | 0x1400..=0x1BFF
            )
    };
    all.extend(dut.eds.dictionary().entries().filter(has_bit_31));
    // 1019h can be written only while 1006h is 0.
    all.retain(|entry| is_number(entry) && entry.address.index != 0x1019);
    let from = dut.frames.len();
    for entry in all {
        let own = dut.upload(entry.address)?.unwrap_or_default();
        let is_allowed = dut.eds.excludes(entry.address, &own, dut.node).is_none();
        if is_allowed && matches!(own.len(), 1..=4) {
            let _ = dut.download(entry.address, &own)?;
        }
    }
    reserved_are_0(dut, from, &[(0x60, 4)])
}

/// A client that leaves a download open gets the value of its next upload, and the download wrote nothing.
pub(super) fn download_left_open(dut: &mut Dut<'_>) -> Checked {
    let (address, before) = short_value(dut)?;
    begin_download(dut, address, before.len())?;
    let upload = request(0x40, address, [0; 4]);
    // A server may end the old transfer with an abort first.
    if abort_of(&dut.answer(upload)?).is_some() {
        let answer = dut.answer(upload)?;
        ensure(
            abort_of(&answer).is_none(),
            format!(
                "a value of {address}, since a new request ends the download that was left open"
            ),
            format!("{} came", values::hex(&answer)),
        )?;
    }
    unchanged(dut, address, &before)
}

/// A download by segments is refused as an expedited one: of an object that is read only, and of one that is missing.
pub(super) fn download_refused(dut: &mut Dut<'_>) -> Checked {
    let entries = dut.eds.dictionary().entries();
    let is_fixed = |entry: &Entry| {
        (0x1000..0x2000).contains(&entry.address.index)
            && matches!(entry.access, Access::Ro | Access::Const)
    };
    // Each object once: its first sub-object.
    let mut fixed: Vec<Address> = entries.filter(is_fixed).map(|one| one.address).collect();
    fixed.dedup_by_key(|address| address.index);
    for address in fixed {
        if let Ok(before) = dut.upload(address)?
            && (1..=64).contains(&before.len())
        {
            refuses(dut, address, &before, &[UnsupportedAccess, ReadOnly])?;
        }
    }
    match dut.eds.missing() {
        Some(index) => refuses(dut, Address::new(index, 0), &[0; 4], &[NoObject]),
        None => Ok(()),
    }
}

fn refuses(dut: &mut Dut<'_>, address: Address, bytes: &[u8], codes: &[AbortCode]) -> Checked {
    match dut.download_segments(address, bytes, true, 4)? {
        Ok(()) => fail(
            format!("an abort for a download by segments to {address}"),
            "it was accepted",
        ),
        Err(code) => is_abort(&request(0x80, address, code.to_le_bytes()), codes)
            .or_else(|fault| need_not(dut, code).and(Err(fault))),
    }
}
