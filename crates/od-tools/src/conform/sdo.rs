//! Strict SDO transfers: every byte of a response is checked.

use od_model::{Address, values};
use od_wire::{AbortCode, AbortReason, Frame, sdo};

use super::dut::{ANSWER, Dut, is_data};
use super::end::{Checked, ensure, fail, skip};
use super::record::Traced;

/// The bytes of an upload, nothing for a download, or the abort code.
pub(crate) type Transfer<T> = Result<T, u32>;

/// A request about an object.
pub(crate) fn request(command: u8, address: Address, rest: [u8; 4]) -> [u8; 8] {
    let [low, high] = address.index.to_le_bytes();
    let [a, b, c, d] = rest;
    [command, low, high, address.sub, a, b, c, d]
}

/// An abort in words.
pub(crate) fn abort_text(code: u32) -> String {
    format!("abort {}", AbortReason(code))
}

/// A list of aborts in words.
fn any_of(codes: &[AbortCode]) -> String {
    let codes: Vec<_> = codes
        .iter()
        .map(|code| format!("{:08X}h", code.code()))
        .collect();
    format!("abort {}", codes.join(" or "))
}

/// The code of a response that is an abort.
pub(crate) fn abort_of(answer: &[u8; 8]) -> Option<u32> {
    (answer[0] == 0x80).then(|| u32::from_le_bytes([answer[4], answer[5], answer[6], answer[7]]))
}

impl Dut<'_> {
    /// Sends a request to the default SDO server and waits for the response.
    pub(crate) fn ask(&mut self, data: [u8; 8]) -> Checked<Option<[u8; 8]>> {
        self.ask_within(data, ANSWER)
    }

    pub(crate) fn ask_within(&mut self, data: [u8; 8], micros: u64) -> Checked<Option<[u8; 8]>> {
        // A server that answers an abort, which is the failure of one case, must not fail the next request, too.
        let is_abort = |traced: &Traced| {
            traced.ours
                && traced.frame.id() == self.node.plus(0x600)
                && traced.frame.bytes()[0] == 0x80
        };
        if self.frames.last().is_some_and(is_abort) {
            self.settle(10_000)?;
        }
        self.drain()?;
        self.send(Frame::full(self.node.plus(0x600), data))?;
        let from = self.now();
        let answer = self.response(micros)?;
        if answer.is_some() {
            let took = self.now().micros_since(from);
            self.times.answers.push(took);
        }
        Ok(answer)
    }

    /// The next response of the default SDO server.
    pub(crate) fn response(&mut self, micros: u64) -> Checked<Option<[u8; 8]>> {
        let id = self.id(0x580);
        let Some(heard) = self.awaited(micros, |frame| is_data(frame, id))? else {
            return Ok(None);
        };
        match heard.frame.dlc() {
            8 => Ok(Some(*heard.frame.bytes())),
            _ => fail(
                "an SDO response of 8 bytes",
                format!("{} came", heard.frame),
            ),
        }
    }

    /// As [`ask`](Self::ask); no response is a failure.
    pub(crate) fn answer(&mut self, data: [u8; 8]) -> Checked<[u8; 8]> {
        match self.ask(data)? {
            Some(answer) => Ok(answer),
            None => fail(
                format!("a response to {} within 1 s", values::hex(&data)),
                "none came",
            ),
        }
    }

    /// Checks that a response or an abort names the object of the request.
    fn about(&mut self, data: [u8; 8]) -> Checked<[u8; 8]> {
        let answer = self.answer(data)?;
        ensure(
            answer[1..4] == data[1..4],
            format!(
                "index and sub-index {} in the response",
                values::hex(&data[1..4])
            ),
            format!("{} came", values::hex(&answer)),
        )?;
        Ok(answer)
    }

    /// Fails unless the server aborts with one of these codes or 08000000h, and names the object.
    pub(crate) fn refuses(&mut self, data: [u8; 8], codes: &[AbortCode]) -> Checked {
        let answer = self.about(data)?;
        is_abort(&answer, codes)
    }

    /// Reads an object.
    pub(crate) fn upload(&mut self, address: Address) -> Checked<Transfer<Vec<u8>>> {
        let answer = self.about(request(0x40, address, [0; 4]))?;
        if let Some(code) = abort_of(&answer) {
            return Ok(Err(code));
        }
        let (command, data) = (answer[0], &answer[4..]);
        if command & 0xE2 == 0x42 {
            let unused = usize::from(command >> 2 & 3);
            let size = (command & 1 == 1).then_some(4 - unused as u32);
            let entry = self.eds.dictionary().find(address).ok();
            let own = entry.and_then(|entry| entry.data_type.size());
            let len = sdo::expedited_len(size, own);
            return Ok(Ok(data[..len].to_vec()));
        }
        if command & 0xE2 != 0x40 {
            let got = format!("{} came", values::hex(&answer));
            return fail("the response to an upload, 4xh", got);
        }
        let size = u32::from_le_bytes([data[0], data[1], data[2], data[3]]);
        let size = (command & 1 == 1).then_some(size as usize);
        self.segments(size).map(Ok)
    }

    /// The segments of an upload.
    pub(crate) fn segments(&mut self, size: Option<usize>) -> Checked<Vec<u8>> {
        let mut bytes = Vec::new();
        let mut toggle = 0;
        loop {
            let answer = self.answer([0x60 | toggle, 0, 0, 0, 0, 0, 0, 0])?;
            let got = || format!("{} came", values::hex(&answer));
            ensure(
                answer[0] & 0xE0 == 0,
                "an upload segment, 0xh or 1xh",
                got(),
            )?;
            let bit = toggle >> 4;
            ensure(
                answer[0] & 0x10 == toggle,
                format!("toggle bit {bit}"),
                got(),
            )?;
            let unused = usize::from(answer[0] >> 1 & 7);
            bytes.extend_from_slice(&answer[1..8 - unused]);
            if answer[0] & 1 == 1 {
                break;
            }
            ensure(
                unused == 0,
                "7 bytes in a segment that is not the last",
                got(),
            )?;
            if size.is_some_and(|size| bytes.len() > size) || bytes.len() > 1 << 20 {
                return fail("the last segment to be marked (bit 0)", got());
            }
            toggle ^= 0x10;
        }
        match size {
            Some(size) if size != bytes.len() => fail(
                format!("{size} bytes, as announced"),
                format!("{} bytes came", bytes.len()),
            ),
            _ => Ok(bytes),
        }
    }

    /// Reads an object; an abort is a failure.
    pub(crate) fn read(&mut self, address: Address) -> Checked<Vec<u8>> {
        let shown = values::label(self.eds.dictionary(), address);
        match self.upload(address)? {
            Ok(bytes) => Ok(bytes),
            Err(code) => fail(
                format!("a value of {shown}"),
                format!("{} came", abort_text(code)),
            ),
        }
    }

    /// Reads a number; an abort is a failure.
    pub(crate) fn number(&mut self, index: u16, sub: u8) -> Checked<u64> {
        let bytes = self.read(Address::new(index, sub))?;
        Ok(number(&bytes))
    }

    /// Writes an object.
    pub(crate) fn download(&mut self, address: Address, bytes: &[u8]) -> Checked<Transfer<()>> {
        if !(1..=4).contains(&bytes.len()) {
            return self.download_segments(address, bytes, true, 7);
        }
        let mut data = [0; 4];
        data[..bytes.len()].copy_from_slice(bytes);
        let command = 0x23 | (4 - bytes.len() as u8) << 2;
        let answer = self.about(request(command, address, data))?;
        Ok(match abort_of(&answer) {
            Some(code) => Err(code),
            None => {
                let right = answer[0] == 0x60;
                let got = format!("{} came", values::hex(&answer));
                ensure(right, "the confirmation of a download, 60h", got)?;
                Ok(())
            }
        })
    }

    /// Writes an object by segments of `step` bytes.
    pub(crate) fn download_segments(
        &mut self,
        address: Address,
        bytes: &[u8],
        sized: bool,
        step: usize,
    ) -> Checked<Transfer<()>> {
        let size = (bytes.len() as u32).to_le_bytes();
        let first = if sized {
            request(0x21, address, size)
        } else {
            request(0x20, address, [0; 4])
        };
        let answer = self.about(first)?;
        if let Some(code) = abort_of(&answer) {
            return Ok(Err(code));
        }
        let got = format!("{} came", values::hex(&answer));
        ensure(
            answer[0] == 0x60,
            "the confirmation of a download, 60h",
            got,
        )?;
        let mut toggle = 0;
        let mut parts = bytes.chunks(step).peekable();
        loop {
            let part = parts.next().unwrap_or_default();
            let last = u8::from(parts.peek().is_none());
            let mut segment = [0; 8];
            segment[0] = toggle | (7 - part.len() as u8) << 1 | last;
            segment[1..=part.len()].copy_from_slice(part);
            let answer = self.answer(segment)?;
            if let Some(code) = abort_of(&answer) {
                names(&answer, address)?;
                return Ok(Err(code));
            }
            let wanted = 0x20 | toggle;
            let got = format!("{} came", values::hex(&answer));
            ensure(
                answer[0] == wanted,
                format!("the confirmation of a segment, {wanted:02X}h"),
                got,
            )?;
            if last == 1 {
                return Ok(Ok(()));
            }
            toggle ^= 0x10;
        }
    }

    /// Writes an object; an abort is a failure.
    ///
    /// Skips the case if the EDS excludes the value.
    pub(crate) fn write(&mut self, address: Address, bytes: &[u8]) -> Checked {
        if let Some(why) = self.eds.excludes(address, bytes, self.node) {
            return skip(why);
        }
        let shown = values::label(self.eds.dictionary(), address);
        match self.download(address, bytes)? {
            Ok(()) => Ok(()),
            Err(code) => fail(
                format!("{shown} = {} to be written", values::hex(bytes)),
                format!("{} came", abort_text(code)),
            ),
        }
    }

    /// Tests that an object has the value that was written.
    pub(crate) fn is_as_written(&mut self, address: Address, written: &[u8]) -> Checked {
        let is = self.read(address)?;
        ensure(
            is == written,
            format!("{} in {address}, as written", values::hex(written)),
            format!("{} was read", values::hex(&is)),
        )
    }

    /// Returns the value of an object, and restores it after the case.
    pub(crate) fn keep(&mut self, address: Address) -> Checked<Vec<u8>> {
        let before = self.read(address)?;
        if !self.undo.iter().any(|(kept, _)| *kept == address) {
            self.undo.push((address, before.clone()));
        }
        Ok(before)
    }

    /// Writes an object; its earlier value is restored after the case.
    pub(crate) fn set(&mut self, address: Address, bytes: &[u8]) -> Checked {
        self.keep(address)?;
        self.write(address, bytes)
    }

    /// Fails unless a download is refused with one of these aborts or 08000000h; a value that was written is
    /// restored.
    pub(crate) fn refuses_value(
        &mut self,
        address: Address,
        bytes: &[u8],
        codes: &[AbortCode],
    ) -> Checked {
        let shown = values::label(self.eds.dictionary(), address);
        let hex = values::hex(bytes);
        match self.download(address, bytes)? {
            Ok(()) => fail(
                format!("{} for {shown} = {hex}", any_of(codes)),
                "the value was accepted",
            ),
            Err(code) => ensure(
                is_one_of(code, codes),
                any_of(codes),
                format!("{} came", abort_text(code)),
            ),
        }
    }

    /// Fails if a download is accepted, whatever the code of its abort. The caller restores a value that was written.
    pub(crate) fn cannot_change(&mut self, address: Address, bytes: &[u8], why: &str) -> Checked {
        let shown = values::label(self.eds.dictionary(), address);
        match self.download(address, bytes)? {
            Ok(()) => fail(
                format!("an abort for {shown} = {}, {why}", values::hex(bytes)),
                "the value was accepted",
            ),
            Err(_) => Ok(()),
        }
    }

    /// Fails unless the server is ready for a new transfer.
    pub(crate) fn still_serves(&mut self) -> Checked {
        // An abort is a response, too; another case tests whether 1000h exists.
        self.upload(Address::new(0x1000, 0)).map(drop)
    }
}

/// Fails unless the reserved bytes of the responses since `from`, the number of a frame, are 0.
///
/// `first` is the first reserved byte after each command byte; other responses are not checked.
pub(crate) fn reserved_are_0(dut: &mut Dut<'_>, from: usize, first: &[(u8, usize)]) -> Checked {
    let id = dut.id(0x580);
    let responses = dut.frames.get(from..).unwrap_or_default().iter();
    let responses: Vec<Frame> = responses
        .filter(|traced| !traced.ours && is_data(&traced.frame, id))
        .map(|traced| traced.frame)
        .collect();
    for frame in responses {
        let command = frame.bytes()[0];
        let Some((_, first)) = first.iter().find(|(known, _)| *known == command) else {
            continue;
        };
        let done = ensure(
            frame.bytes()[*first..].iter().all(|byte| *byte == 0),
            format!("0 in the reserved bytes {first} to 7 of the response {command:02X}h"),
            format!("{frame} came"),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// Fails unless an abort names this object, that of its transfer.
pub(crate) fn names(abort: &[u8; 8], address: Address) -> Checked {
    ensure(
        abort[1..4] == request(0x80, address, [0; 4])[1..4],
        format!("an abort that names {address}, the object of the transfer"),
        format!("{} came", values::hex(abort)),
    )
}

/// Fails unless a response is one of these aborts, or 08000000h.
pub(crate) fn is_abort(answer: &[u8; 8], codes: &[AbortCode]) -> Checked {
    match abort_of(answer) {
        Some(code) if is_one_of(code, codes) => Ok(()),
        Some(code) => fail(any_of(codes), format!("{} came", abort_text(code))),
        None => fail(any_of(codes), format!("{} came", values::hex(answer))),
    }
}

fn is_one_of(code: u32, codes: &[AbortCode]) -> bool {
    code == AbortCode::General.code() || codes.iter().any(|one| one.code() == code)
}

/// A number of up to 8 bytes.
pub(crate) fn number(bytes: &[u8]) -> u64 {
    let mut wide = [0; 8];
    let len = bytes.len().min(8);
    wide[..len].copy_from_slice(&bytes[..len]);
    u64::from_le_bytes(wide)
}

/// The checksum of a block transfer.
pub(crate) fn crc(bytes: &[u8]) -> u16 {
    sdo::crc16(bytes)
}
