//! The TPDO that the cases use: finds it, configures it, and waits for it.

use od_model::{Address, TransmissionType};
use od_wire::nmt::Command;
use od_wire::{CanId, CobId, Frame};

use crate::conform::dut::Dut;
use crate::conform::eds::Eds;
use crate::conform::end::{Checked, ensure, fail, lacks};
use crate::link::Heard;

/// A valid TPDO; in some cases an RPDO.
#[derive(Clone, Copy)]
pub(super) struct Tpdo {
    /// Index of the communication parameters: 1800h and up, or 1400h and up for an RPDO.
    pub(super) com: u16,
    /// The earlier COB-ID.
    pub(super) cob_id: u32,
}

impl Tpdo {
    pub(super) fn address(&self, sub: u8) -> Address {
        Address::new(self.com, sub)
    }

    pub(super) fn map(&self) -> u16 {
        self.com + 0x200
    }

    pub(super) fn id(&self) -> CanId {
        CobId::new(self.cob_id).can_id()
    }

    pub(super) fn carries(&self, frame: &Frame) -> bool {
        frame.id() == self.id() && !frame.is_remote()
    }
}

/// One entry of a mapping.
pub(super) struct Mapped {
    pub(super) address: Address,
    pub(super) bits: usize,
}

impl Mapped {
    /// The mapping entry, as in 1A00h.
    pub(super) fn raw(&self) -> u32 {
        let Address { index, sub } = self.address;
        u32::from(index) << 16 | u32::from(sub) << 8 | self.bits as u32
    }
}

/// The mapping in the node; empty for a multiplexed PDO, whose sub-index 0 is FEh or FFh.
pub(super) fn mapping(dut: &mut Dut<'_>, map: u16) -> Checked<Vec<Mapped>> {
    let mut all = Vec::new();
    let count = match dut.number(map, 0)? {
        0xFE.. => return Ok(all),
        count => count.min(64) as u8,
    };
    for sub in 1..=count {
        let raw = dut.number(map, sub)?;
        all.push(Mapped {
            address: Address::new((raw >> 16) as u16, (raw >> 8) as u8),
            bits: (raw & 0xFF) as usize,
        });
    }
    Ok(all)
}

/// Reason why a node cannot have this mapping according to the EDS; the case pdo-mapped-objects
/// tests this.
pub(super) fn contradiction(eds: &Eds, all: &[Mapped], transmits: bool) -> Option<String> {
    all.iter().find_map(|Mapped { address, bits }| {
        if !transmits && address.index < 0x20 {
            return None;
        }
        let Some(entry) = eds.entry(address.index, address.sub) else {
            return Some(format!("{address} is mapped and missing"));
        };
        let may = if transmits {
            entry.maps_to_tpdo()
        } else {
            entry.maps_to_rpdo()
        };
        let own = entry.data_type.bits().map_or(0, usize::from);
        if !may {
            Some(format!("{address} cannot be mapped"))
        } else if own != *bits {
            Some(format!(
                "{address} is a {own}-bit value, mapped with length {bits}"
            ))
        } else {
            None
        }
    })
}

/// Returns whether a PDO is valid with this COB-ID. A restricted CAN-ID such as 0 comes from an
/// invalid EDS.
pub(super) fn is_on(cob_id: u32) -> bool {
    CobId::new(cob_id).is_valid() && !CobId::new(cob_id).is_restricted()
}

/// The first valid TPDO with a mapping that the EDS allows.
pub(super) fn first(dut: &mut Dut<'_>) -> Checked<Tpdo> {
    let mut why = String::from("no TPDO is on");
    for pdo in dut.eds.pdos(0x1800) {
        let com = 0x1800 + pdo;
        let cob_id = dut.number(com, 1)? as u32;
        if !is_on(cob_id) {
            continue;
        }
        let all = mapping(dut, com + 0x200)?;
        match contradiction(dut.eds, &all, true) {
            None if all.is_empty() => {}
            None => return Ok(Tpdo { com, cob_id }),
            Some(contradiction) => why = format!("no TPDO works, by its EDS: {contradiction}"),
        }
    }
    lacks(why)
}

/// Sets or clears bit 31 of the COB-ID of a PDO, which shows it.
pub(super) fn switch(dut: &mut Dut<'_>, pdo: &Tpdo, on: bool) -> Checked {
    let bit = if on { 0 } else { 1 << 31 };
    let wanted = pdo.cob_id | bit;
    dut.write(pdo.address(1), &wanted.to_le_bytes())?;
    let is = dut.number(pdo.com, 1)? as u32;
    ensure(
        is == wanted,
        format!("{wanted:08X}h in {}, as written", pdo.address(1)),
        format!("{is:08X}h was read"),
    )
}

/// The first TPDO, sent only by its event timer, at this interval in milliseconds.
pub(super) fn timed(dut: &mut Dut<'_>, millis: u16) -> Checked<Tpdo> {
    let pdo = first(dut)?;
    timed_on(dut, &pdo, millis)?;
    Ok(pdo)
}

/// As [`timed`], of this TPDO.
pub(super) fn timed_on(dut: &mut Dut<'_>, pdo: &Tpdo, millis: u16) -> Checked {
    if !dut.eds.writes(pdo.com, 5) {
        return lacks(format!(
            "{:04X}h:05, the event timer, cannot be written",
            pdo.com
        ));
    }
    event_driven(dut, pdo)?;
    dut.set(pdo.address(5), &millis.to_le_bytes())
}

/// Changes the transmission type to 254 or 255.
pub(super) fn event_driven(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    let now = dut.keep(pdo.address(2))?;
    if now
        .first()
        .is_some_and(|kind| TransmissionType::new(*kind).is_event_driven())
    {
        return Ok(());
    }
    for kind in [254, 255] {
        if dut.download(pdo.address(2), &[kind])?.is_ok() {
            return Ok(());
        }
    }
    lacks("the TPDO cannot be event-driven")
}

/// The first TPDO with this transmission type, without an event timer.
pub(super) fn typed(dut: &mut Dut<'_>, kind: u8) -> Checked<Tpdo> {
    let pdo = first(dut)?;
    typed_on(dut, &pdo, kind)?;
    Ok(pdo)
}

/// As [`typed`], of this TPDO.
pub(super) fn typed_on(dut: &mut Dut<'_>, pdo: &Tpdo, kind: u8) -> Checked {
    dut.keep(pdo.address(2))?;
    match dut.download(pdo.address(2), &[kind])? {
        Ok(()) => Ok(()),
        Err(_) => lacks(format!("the TPDO does not take transmission type {kind}")),
    }
}

/// Starts the node; a synchronous TPDO does not come with the start.
pub(super) fn starts_silent(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    let mut came = dut.frames.get(from..).unwrap_or_default().iter();
    match came.find(|traced| !traced.ours && pdo.carries(&traced.frame)) {
        Some(traced) => fail(
            "no TPDO without SYNC",
            format!("{} came with the start of the node", traced.frame),
        ),
        None => Ok(()),
    }
}

pub(super) fn next(dut: &mut Dut<'_>, pdo: &Tpdo, micros: u64) -> Checked<Option<Heard>> {
    dut.next(micros, |frame| pdo.carries(frame))
}

pub(super) fn none(dut: &mut Dut<'_>, pdo: &Tpdo, micros: u64, expected: &str) -> Checked {
    match next(dut, pdo, micros)? {
        Some(heard) => fail(expected, format!("{} came", heard.frame)),
        None => Ok(()),
    }
}

pub(super) fn sync(dut: &mut Dut<'_>) -> Checked {
    let raw = if dut.eds.has(0x1005) {
        dut.sync_id
    } else {
        0x80
    };
    let frame = Frame::new(CobId::new(raw).can_id(), &[]);
    frame.map_or(Ok(()), |frame| dut.send(frame))
}

/// Stores the CAN-ID of SYNC for [`sync`].
///
/// A node that produces SYNC itself stops until the end of the case, so that the test produces it.
pub(super) fn learn_sync(dut: &mut Dut<'_>) -> Checked {
    if !dut.eds.has(0x1005) {
        return Ok(());
    }
    let raw = dut.number(0x1005, 0)? as u32;
    dut.sync_id = raw & 0x3FFF_FFFF;
    if raw & PRODUCES == 0 {
        return Ok(());
    }
    if dut.eds.writes(0x1005, 0) {
        dut.set(Address::new(0x1005, 0), &(raw & !PRODUCES).to_le_bytes())
    } else {
        lacks("the node produces SYNC, and 1005h is read only")
    }
}

/// Bit 30 of 1005h.
const PRODUCES: u32 = 1 << 30;

/// The gaps between TPDOs in Operational; the median has to be right.
pub(super) fn gaps(
    dut: &mut Dut<'_>,
    pdo: &Tpdo,
    count: usize,
    is_right: impl Fn(u64, u64) -> bool,
    shown: &str,
) -> Checked {
    let all = gaps_between(dut, pdo, count, shown)?;
    let (middle, _) = all[all.len() / 2];
    ensure(
        is_right(middle, dut.rig.slack()),
        format!("a TPDO {shown}"),
        format!("they came every {}.{:03} ms", middle / 1000, middle % 1000),
    )
}

/// The gaps of a TPDO that its event timer sends, 10 % off at most, and none is missing. One with another value may come
/// earlier.
pub(super) fn timer_gaps(
    dut: &mut Dut<'_>,
    pdo: &Tpdo,
    count: usize,
    wanted: u64,
    shown: &str,
) -> Checked {
    let all = gaps_between(dut, pdo, count, shown)?;
    let (middle, is_same) = all[all.len() / 2];
    let longest = all.last().map_or(0, |(gap, _)| *gap);
    let off = wanted / 10 + dut.rig.slack();
    ensure(
        middle <= wanted + off && (!is_same || middle + off >= wanted),
        format!("a TPDO {shown}"),
        format!("they came every {}.{:03} ms", middle / 1000, middle % 1000),
    )?;
    ensure(
        longest < 2 * wanted - wanted / 10,
        format!("a TPDO {shown}, and none missing"),
        format!("one came after {} ms", longest / 1000),
    )
}

/// The gaps between TPDOs, in order of their length, and whether both have the same bytes.
fn gaps_between(
    dut: &mut Dut<'_>,
    pdo: &Tpdo,
    count: usize,
    shown: &str,
) -> Checked<Vec<(u64, bool)>> {
    dut.nmt(Command::Start)?;
    let mut last: Option<Heard> = None;
    let mut all = Vec::new();
    // The start of the node may cause the first one.
    for turn in 0..=count + 1 {
        let Some(heard) = next(dut, pdo, 500_000)? else {
            return fail(format!("a TPDO {shown}"), "none came within 500 ms");
        };
        let before = last.replace(heard);
        if turn > 1
            && let Some(before) = before
        {
            let is_same = heard.frame.data() == before.frame.data();
            all.push((heard.at.micros_since(before.at), is_same));
        }
    }
    all.sort_unstable();
    Ok(all)
}
