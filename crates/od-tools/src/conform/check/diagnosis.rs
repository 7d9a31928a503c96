//! The self-diagnosis of EAM: manual 001, chapters 9.3 to 9.5. A case injects errors by 2116h:01, which 0 ends.

use od_model::Address;
use od_wire::Frame;
use od_wire::nmt::Command;

use super::heartbeat::emcy_since;
use super::maker::{EAM, is_of};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};

const INJECTION: Address = Address::new(0x2116, 1);

/// Time in which the encoder signals an error, in microseconds.
const SIGNAL: u64 = 200_000;

/// A source of errors, and where it is signalled.
struct Source {
    injection: u32,
    /// Error code of its EMCY message.
    code: u16,
    /// Bits of 1001h, 6503h, 6505h and 2117h.
    register: u8,
    alarms: u16,
    warnings: u16,
    shown: u16,
}

const fn source(
    injection: u32,
    code: u16,
    register: u8,
    (alarms, warnings): (u16, u16),
    shown: u16,
) -> Source {
    Source {
        injection,
        code,
        register,
        alarms,
        warnings,
        shown,
    }
}

/// The sources that both designs have, and two of the design that is not redundant.
const SOURCES: [Source; 13] = [
    source(0x0008_0020, 0x4200, 9, (0, 0), 1 << 13),
    source(0x0001_0024, 0x5100, 1, (3, 0), 1 << 10 | 1 << 11),
    source(0x0008_0024, 0x5100, 0, (0, 1 << 3), 1 << 2),
    source(0x0008_0025, 0x6100, 0, (0, 1 << 2), 1 << 1),
    source(0x0008_0005, 0xFF00, 0, (0, 1 << 4), 1 << 3),
    source(0x0001_0004, 0xFF01, 1, (0x8001, 0), 1 << 10 | 1 << 15),
    source(0x0008_0004, 0xFF01, 0, (0, 1 << 13), 1 << 5),
    source(0x0008_0003, 0xFF02, 0, (0, 1 << 12), 1 << 4),
    source(0x0001_0009, 0xFF04, 1, (0x1001, 0), 1 << 10 | 1 << 14),
    source(0x0008_0009, 0xFF04, 0, (0, 1 << 13), 1 << 5),
    source(0x0008_0021, 0xFF05, 0, (0, 1), 1),
    source(0x0008_0022, 0xFF06, 0, (0, 1 << 14), 1 << 6),
    source(0x0008_0023, 0xFF07, 0, (0, 1 << 15), 1 << 7),
];

/// Each source of errors that can be injected is signalled where the manual says, and nowhere after its end.
pub(super) fn injection(dut: &mut Dut<'_>) -> Checked {
    is_of(dut, &[EAM])?;
    without_error(dut)?;
    dut.nmt(Command::Start)?;
    let mut any = false;
    for source in SOURCES {
        let from = dut.frames.len();
        // The other design does not have this source, or keeps it until the power is off.
        if dut
            .download(INJECTION, &source.injection.to_le_bytes())?
            .is_err()
        {
            continue;
        }
        any = true;
        let done = is_reported(dut, from, source.code, source.injection);
        dut.fault(done)?;
        let done = source.is_shown(dut);
        dut.fault(done)?;
        let from = dut.frames.len();
        dut.write(INJECTION, &[0; 4])?;
        let done = is_reported(dut, from, 0, 0).and_then(|()| {
            let none = self::source(0, 0, 0, (0, 0), 0);
            none.is_shown(dut)
        });
        dut.fault(done)?;
    }
    at_least_one(any, "the encoder takes no error injection code")
}

fn without_error(dut: &mut Dut<'_>) -> Checked {
    if dut.number(0x1001, 0)? != 0 || dut.number(0x6505, 0)? != 0 {
        return lacks("the encoder has an error or a warning");
    }
    Ok(())
}

/// An EMCY message with this code came since the frame `from`.
fn is_reported(dut: &mut Dut<'_>, from: usize, code: u16, injection: u32) -> Checked {
    let expected = format!("EMCY {code:04X}h after {injection:08X}h in {INJECTION}");
    let Some(frame) = emcy_since(dut, from, code, SIGNAL)? else {
        return fail(expected, "none came");
    };
    let register = dut.number(0x1001, 0)?;
    ensure(
        u64::from(frame.bytes()[2]) == register,
        format!("{expected}, with 1001h = {register:02X}h in byte 2"),
        format!("{frame} came"),
    )?;
    if code == 0 || dut.eds.entry(0x1003, 1).is_none() {
        return Ok(());
    }
    let newest = dut.number(0x1003, 1)? & 0xFFFF;
    ensure(
        newest == u64::from(code),
        format!("{code:04X}h in 1003h:01, the newest error"),
        format!("{newest:04X}h was read"),
    )
}

impl Source {
    /// Fails unless each object has the bits of this source.
    fn is_shown(&self, dut: &mut Dut<'_>) -> Checked {
        let all = [
            (0x1001, u16::from(self.register), None),
            (0x6503, self.alarms, Some(0x6504)),
            (0x6505, self.warnings, Some(0x6506)),
            (0x2117, self.shown, None),
        ];
        for (index, wanted, supported) in all {
            if dut.eds.entry(index, 0).is_none() {
                continue;
            }
            // The lists of the manual have a bit less than its table of sources.
            let mask = match supported.filter(|index| dut.eds.has(*index)) {
                Some(index) => dut.number(index, 0)? as u16,
                None => u16::MAX,
            };
            let is = dut.number(index, 0)? as u16;
            let done = ensure(
                (is ^ wanted) & mask == 0,
                format!(
                    "{wanted:04X}h in {index:04X}h with {:08X}h in {INJECTION}",
                    self.injection
                ),
                format!("{is:04X}h was read"),
            );
            dut.fault(done)?;
        }
        Ok(())
    }
}

/// 1029h:02 is the reaction to bit 0 of 1001h, and 1029h:03 that to bit 3, also when the node is started again.
pub(super) fn behaviour(dut: &mut Dut<'_>) -> Checked {
    const NOTHING: [u8; 1] = [1];
    is_of(dut, &[EAM])?;
    without_error(dut)?;
    dut.follow_state()?;
    let classes = [(2, 0x0001_0024_u32), (3, 0x0008_0020)];
    for (sub, _) in classes {
        dut.set(Address::new(0x1029, sub), &NOTHING)?;
    }
    for (sub, injection) in classes {
        let own = Address::new(0x1029, sub);
        for (value, state) in [(1, 5), (0, 0x7F), (2, 4)] {
            dut.write(own, &[value])?;
            dut.nmt(Command::Start)?;
            // A node that changes to Stopped need not respond.
            let [a, b, c, d] = injection.to_le_bytes();
            let request = [0x23, 0x16, 0x21, 1, a, b, c, d];
            dut.send(Frame::full(dut.node.plus(0x600), request))?;
            dut.wait(SIGNAL)?;
            let done = dut.is_in(state).and_then(|()| {
                dut.nmt(Command::Start)?;
                dut.wait(SIGNAL)?;
                dut.is_in(state)
            });
            if matches!(done, Err(End::Lost(_))) {
                return done;
            }
            dut.nmt(Command::EnterPreOperational)?;
            dut.drain()?;
            dut.write(INJECTION, &[0; 4])?;
            dut.wait(SIGNAL)?;
            dut.fault(done)?;
        }
        dut.write(own, &NOTHING)?;
    }
    Ok(())
}
