//! COB-IDs: no service of the node has the CAN-ID of another service, at any node ID.

use od_model::{Address, CanIdOwner, CobIdService, Entry, values};
use od_wire::nmt::Command;
use od_wire::{AbortCode, CanId, CobId, Frame, NodeId};

use super::lss::renumber;
use crate::bench::OnBench;
use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::end::{Checked, End, ensure, fail, lacks, skip};
use crate::conform::sdo::{abort_text, number, request};

use od_sim::bus::Bus;

/// Time for which the node is observed in Operational, in microseconds.
const WATCHED: u64 = 1_000_000;
/// The highest node ID, with which a COB-ID is most likely outside its range.
const HIGHEST: NodeId = match NodeId::new(127) {
    Some(node) => node,
    None => NodeId::ONE,
};

/// Checks the COB-IDs of the node at its present node ID.
pub(super) fn here(dut: &mut Dut<'_>) -> Checked {
    read(dut)?;
    watch(dut)
}

/// The same check at node ID 127: a simulated device is made again, any other gets the node ID by
/// LSS.
pub(super) fn highest(dut: &mut Dut<'_>) -> Checked {
    if dut.node == HIGHEST {
        return here(dut);
    }
    match dut.fresh {
        Some(fresh) => {
            let device = fresh(Some(HIGHEST)).or_else(|why| skip(why.to_string()))?;
            let mut bus = Bus::new();
            let number = bus.add(device);
            bus.start(number);
            let mut rig = OnBench(bus);
            let mut other = Dut {
                rig: &mut rig,
                eds: dut.eds,
                node: HIGHEST,
                times: &mut *dut.times,
                frames: Vec::new(),
                undo: Vec::new(),
                notes: Vec::new(),
                silence: 0,
                faults: Vec::new(),
                fresh: None,
                ..*dut
            };
            let from = other.now();
            let done = other.booted(from).and_then(|()| here(&mut other));
            let (frames, notes, faults) = (other.frames, other.notes, other.faults);
            dut.frames.extend(frames);
            dut.notes.extend(notes);
            dut.faults.extend(faults);
            done
        }
        None => by_lss(dut),
    }
}

fn by_lss(dut: &mut Dut<'_>) -> Checked {
    if dut.eds.meets("lss") != Some(true) {
        return lacks("the node ID cannot be set by LSS");
    }
    let own = dut.node;
    dut.drain()?;
    let hello = request(0x40, Address::new(0x1000, 0), [0; 4]);
    dut.send(Frame::full(HIGHEST.plus(0x600), hello))?;
    if dut.next(QUIET, |frame| is_data(frame, 0x5FF))?.is_some() {
        return skip("another node has node ID 127");
    }
    if !renumber(dut, HIGHEST)? {
        dut.nmt(Command::EnterPreOperational)?;
        return lacks("the node does not take node ID 127 by LSS until it is stored");
    }
    let done = here(dut);
    dut.nmt(Command::EnterPreOperational)?;
    if !renumber(dut, own)? {
        let note = format!(
            "could not put back node ID {own}: the node has node ID 127 until it is switched off"
        );
        dut.notes.push(note.clone());
        done?;
        return fail("the node to take its own node ID again", note);
    }
    done
}

/// A COB-ID of the node.
struct Used {
    address: Address,
    service: CobIdService,
    cob_id: CobId,
}

impl Used {
    fn sends(&self) -> bool {
        match self.service {
            CobIdService::Sync | CobIdService::Time => self.cob_id.produces_sync(),
            CobIdService::Emcy | CobIdService::Tpdo => true,
            CobIdService::SdoServer => self.address.sub == 2,
            CobIdService::SdoClient => self.address.sub == 1,
            CobIdService::EmcyConsumer | CobIdService::Rpdo => false,
        }
    }
}

/// Reads every COB-ID. Each fits its frame and is not restricted, and no two services send with the
/// same one.
fn read(dut: &mut Dut<'_>) -> Checked {
    let entries: Vec<_> = dut.eds.dictionary().entries().collect();
    let mut all: Vec<Used> = Vec::new();
    for entry in entries.iter().filter(|entry| entry.access.readable()) {
        let address = entry.address;
        let Some(service) = CobIdService::at(address) else {
            continue;
        };
        // A missing object fails another case.
        let Ok(bytes) = dut.upload(address)? else {
            continue;
        };
        let cob_id = CobId::new(number(&bytes) as u32);
        if service.is_used(cob_id.raw()) && !is_idle(dut, address, service, cob_id)? {
            all.push(Used {
                address,
                service,
                cob_id,
            });
        }
    }
    for used in &all {
        let done = is_free(dut, used);
        dut.fault(done)?;
    }
    let sent: Vec<&Used> = all.iter().filter(|used| used.sends()).collect();
    for (at, used) in sent.iter().enumerate() {
        let same = |other: &&&Used| other.cob_id.can_id() == used.cob_id.can_id();
        if let Some(other) = sent[..at].iter().find(same) {
            let eds = dut.eds;
            let name = |used: &Used| values::label(eds.dictionary(), used.address);
            let done = fail(
                format!(
                    "a CAN-ID of {} that no other service of the node sends with",
                    name(used)
                ),
                format!(
                    "{} has the CAN-ID of {}, {}",
                    name(used),
                    name(other),
                    used.cob_id.can_id()
                ),
            );
            dut.fault(done)?;
        }
    }
    Ok(())
}

/// A COB-ID that a master can write according to the EDS accepts its own value.
pub(super) fn access(dut: &mut Dut<'_>) -> Checked {
    let entries: Vec<_> = dut.eds.dictionary().entries().collect();
    let is_one = |entry: &&Entry| {
        let address = entry.address;
        entry.access.writable()
            && entry.access.readable()
            // Writing the COB-ID of the SDO that is in use may end the transfer.
            && matches!(address.index, 0x1005 | 0x1012 | 0x1014 | 0x1400..=0x15FF | 0x1800..=0x19FF)
            && CobIdService::at(address).is_some()
    };
    let mut any = false;
    for entry in entries.iter().filter(is_one) {
        let Ok(bytes) = dut.upload(entry.address)? else {
            continue;
        };
        // A restricted COB-ID is refused; another case tests its presence.
        let cob_id = CobId::new(number(&bytes) as u32);
        if cob_id.is_valid() && (cob_id.is_restricted() || !cob_id.is_consistent()) {
            continue;
        }
        any = true;
        if let Err(code) = dut.download(entry.address, &bytes)? {
            let name = values::label(dut.eds.dictionary(), entry.address);
            let expected = format!("{name}, {} in the EDS, to take its own value", entry.access);
            dut.fault(fail(expected, abort_text(code)))?;
        }
    }
    if any {
        Ok(())
    } else {
        lacks("no COB-ID can be written")
    }
}

/// Restricted CAN-IDs, one of each range of the table of restricted CAN-IDs (CiA 301).
const RESTRICTED: [u32; 9] = [
    0x001, 0x07F, 0x101, 0x180, 0x581, 0x601, 0x6E0, 0x701, 0x7FF,
];

/// COB-IDs of PDO and EMCY refuse restricted CAN-IDs.
pub(super) fn restricted(dut: &mut Dut<'_>) -> Checked {
    let first = |base: u16| {
        let numbers = dut.eds.pdos(base).into_iter().map(|pdo| base + pdo);
        numbers
            .map(|com| Address::new(com, 1))
            .find(|address| dut.eds.writes(address.index, 1))
    };
    let mut all: Vec<Address> = [0x1400, 0x1800].into_iter().filter_map(first).collect();
    if dut.eds.writes(0x1014, 0) {
        all.push(Address::new(0x1014, 0));
    }
    let mut any = false;
    for address in all {
        let before = dut.keep(address)?;
        let off = number(&before) as u32 | 1 << 31;
        if dut.download(address, &off.to_le_bytes())?.is_err() {
            continue;
        }
        any = true;
        for id in RESTRICTED {
            let codes = [
                AbortCode::ValueRange,
                AbortCode::ValueTooHigh,
                AbortCode::ValueTooLow,
            ];
            let done = dut.refuses_value(address, &id.to_le_bytes(), &codes);
            if done.is_err() {
                dut.fault(done)?;
                // It may be valid now, with this CAN-ID.
                for value in [id | 1 << 31, off] {
                    let _ = dut.download(address, &value.to_le_bytes())?;
                }
                break;
            }
        }
    }
    if any {
        Ok(())
    } else {
        lacks("no COB-ID can be written")
    }
}

/// Returns whether the COB-ID is not used: 0 of a client, a consumer or a PDO that maps nothing.
fn is_idle(
    dut: &mut Dut<'_>,
    address: Address,
    service: CobIdService,
    cob_id: CobId,
) -> Checked<bool> {
    if cob_id.raw() != 0 {
        return Ok(false);
    }
    Ok(match service {
        CobIdService::SdoClient | CobIdService::EmcyConsumer => true,
        CobIdService::Rpdo | CobIdService::Tpdo if dut.eds.has(address.index + 0x200) => {
            dut.number(address.index + 0x200, 0)? == 0
        }
        _ => false,
    })
}

fn is_free(dut: &Dut<'_>, used: &Used) -> Checked {
    let Used {
        address,
        service,
        cob_id,
    } = used;
    let label = values::label(dut.eds.dictionary(), *address);
    let got = format!("{label} = {:08X}h", cob_id.raw());
    let node = dut.node;
    ensure(
        cob_id.is_consistent(),
        format!("a CAN-ID of 11 bits at node ID {node}"),
        &*got,
    )?;
    let Some(id) = cob_id.can_id().as_standard() else {
        return Ok(());
    };
    match od_model::restricted(id.into()) {
        Some((_, CanIdOwner::SdoRequest | CanIdOwner::SdoResponse))
            if *service == CobIdService::SdoClient =>
        {
            Ok(())
        }
        Some(_) if address.index == 0x1200 => {
            let base = if address.sub == 1 { 0x600 } else { 0x580 };
            ensure(
                node.plus(base) == cob_id.can_id(),
                format!("{base:X}h + node ID"),
                got,
            )
        }
        Some((_, owner)) => fail(
            format!(
                "a CAN-ID at node ID {node} that CiA 301 does not reserve for {}",
                owner.name()
            ),
            got,
        ),
        None => Ok(()),
    }
}

/// In Operational the node sends no frame with a CAN-ID that only a master may use, or that is
/// restricted.
fn watch(dut: &mut Dut<'_>) -> Checked {
    dut.nmt(Command::Start)?;
    let wrong = |frame: &Frame| match frame
        .id()
        .as_standard()
        .map(u32::from)
        .and_then(od_model::restricted)
    {
        Some((_, CanIdOwner::SdoResponse | CanIdOwner::ErrorControl)) | None => false,
        Some((_, CanIdOwner::Lss)) => frame.id() != CanId::standard(od_wire::lss::SLAVE),
        Some(_) => true,
    };
    let heard = dut.next(WATCHED, wrong)?;
    dut.nmt(Command::EnterPreOperational)?;
    match heard {
        Some(heard) => Err(End::Fail {
            expected: "no frame with a restricted CAN-ID (CiA 301)".into(),
            got: format!("{} came", heard.frame),
        }),
        None => Ok(()),
    }
}
