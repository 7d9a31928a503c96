//! COB-IDs: no service of the node has the CAN-ID of another service, at any node ID.

use od_model::{Address, CanIdOwner, CobIdService, Entry, values};
use od_wire::nmt::Command;
use od_wire::{AbortCode, CanId, CobId, Frame, NodeId};

use super::each_tpdo::on_each;
use super::lss_node_id::renumber;
use super::transmit::{Tpdo, learn_sync, timed_on};
use crate::bench::OnBench;
use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks, skip};
use crate::conform::sdo::{abort_text, is_abort, number, request};

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
                found: None,
                fresh: None,
                ..*dut
            };
            let from = other.now();
            let done = other.booted(from).and_then(|()| here(&mut other));
            let (frames, notes, faults) = (other.frames, other.notes, other.faults);
            let found = other.found.map(|found| dut.frames.len() + found);
            dut.found = dut.found.or(found);
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
        let name = values::label(dut.eds.dictionary(), entry.address);
        let mut written = vec![(bytes.clone(), "its own value")];
        let is_pdo = matches!(entry.address.index, 0x1400..=0x15FF | 0x1800..=0x19FF);
        if is_pdo && cob_id.is_valid() {
            let off = (cob_id.raw() | 1 << 31).to_le_bytes().to_vec();
            written.push((off, "bit 31"));
            written.push((bytes, "its own value again"));
        }
        for (value, shown) in written {
            if dut.eds.excludes(entry.address, &value, dut.node).is_some() {
                break;
            }
            if let Err(code) = dut.download(entry.address, &value)? {
                let expected = format!("{name}, {} in the EDS, to take {shown}", entry.access);
                dut.fault(fail(expected, abort_text(code)))?;
                break;
            }
        }
    }
    at_least_one(any, "no COB-ID can be written")
}

/// Restricted CAN-IDs, the first and the last of each range of the table of restricted CAN-IDs (CiA 301), and those of
/// LSS.
const RESTRICTED: [u32; 16] = [
    0x000, 0x001, 0x07F, 0x101, 0x180, 0x581, 0x5FF, 0x601, 0x67F, 0x6E0, 0x6FF, 0x701, 0x780,
    0x7E4, 0x7E5, 0x7FF,
];

/// The COB-IDs that can be written of PDOs and EMCY, in the order of their objects.
fn with_bit_31(dut: &Dut<'_>) -> Vec<Address> {
    let pdos = |base: u16| {
        let numbers = dut.eds.pdos(base).into_iter();
        numbers.map(move |pdo| Address::new(base + pdo, 1))
    };
    let all = [Address::new(0x1014, 0)].into_iter();
    let all = all.chain(pdos(0x1400)).chain(pdos(0x1800));
    all.filter(|address| dut.eds.writes(address.index, address.sub))
        .collect()
}

/// The CAN-ID of a valid PDO or EMCY cannot be changed.
pub(super) fn fixed(dut: &mut Dut<'_>) -> Checked {
    /// A CAN-ID that no service has.
    const OTHER: u32 = 0x4F5;
    let mut any = false;
    // The transfers of this case use the default server.
    let servers = (0x1201..=0x127F).flat_map(|index| [1, 2].map(|sub| Address::new(index, sub)));
    let servers = servers.filter(|address| dut.eds.writes(address.index, address.sub));
    let all: Vec<Address> = with_bit_31(dut).into_iter().chain(servers).collect();
    for address in all {
        let before = number(&dut.read(address)?) as u32;
        let cob_id = CobId::new(before);
        let other = (before & !0x3FFF_FFFF) | OTHER;
        if !cob_id.is_valid() || cob_id.is_restricted() || other == before {
            continue;
        }
        if dut
            .eds
            .excludes(address, &other.to_le_bytes(), dut.node)
            .is_some()
        {
            continue;
        }
        any = true;
        for command in [Command::EnterPreOperational, Command::Start] {
            dut.nmt(command)?;
            let done = dut.cannot_change(
                address,
                &other.to_le_bytes(),
                "as the COB-ID is valid with another CAN-ID",
            );
            if done.is_err() {
                dut.fault(done)?;
                for value in [other | 1 << 31, before | 1 << 31, before] {
                    let _ = dut.download(address, &value.to_le_bytes())?;
                }
            }
        }
    }
    dut.nmt(Command::EnterPreOperational)?;
    at_least_one(any, "no COB-ID that is valid can be written")
}

/// A service that is not in use can have another CAN-ID, and can be made valid with one in the same write.
pub(super) fn free(dut: &mut Dut<'_>) -> Checked {
    /// CAN-IDs that no service has.
    const OTHERS: [u32; 2] = [0x4F5, 0x4F6];
    const NOT_VALID: u32 = 1 << 31;
    let clocks = [0x1005, 0x1012].map(|index| Address::new(index, 0));
    let clocks = clocks
        .into_iter()
        .filter(|one| dut.eds.writes(one.index, 0));
    let all: Vec<Address> = with_bit_31(dut).into_iter().chain(clocks).collect();
    let mut any = false;
    for address in all {
        let before = number(&dut.keep(address)?) as u32;
        let cob_id = CobId::new(before);
        if cob_id.is_valid() && (cob_id.is_restricted() || !cob_id.is_consistent()) {
            continue;
        }
        let is_clock = matches!(address.index, 0x1005 | 0x1012);
        // Without the bits that make the node a producer, or the service valid.
        let (off, flags) = if is_clock {
            (before & 0x7FF, 0)
        } else {
            (before | NOT_VALID, before & 1 << 30)
        };
        let [one, other] = OTHERS.map(|id| flags | id);
        let wanted = if is_clock {
            vec![one, other]
        } else if maps_nothing(dut, address.index)? {
            vec![one | NOT_VALID, other | NOT_VALID, off]
        } else {
            vec![one | NOT_VALID, other, other | NOT_VALID, off]
        };
        let mut written = wanted.iter().chain([&off]);
        let excludes = |value: &u32| dut.eds.excludes(address, &value.to_le_bytes(), dut.node);
        if written.any(|value| excludes(value).is_some())
            || dut.download(address, &off.to_le_bytes())?.is_err()
        {
            continue;
        }
        any = true;
        for value in &wanted {
            let bytes = value.to_le_bytes();
            let done = match dut.download(address, &bytes)? {
                Ok(()) => dut.is_as_written(address, &bytes),
                Err(code) => fail(
                    format!(
                        "{} in {address}, whose service is not in use, to be written",
                        values::hex(&bytes)
                    ),
                    format!("{} came", abort_text(code)),
                ),
            };
            dut.fault(done)?;
        }
    }
    at_least_one(any, "no COB-ID can be written")
}

/// Returns whether this is the communication parameter of a PDO without objects: a node need not make it valid.
fn maps_nothing(dut: &mut Dut<'_>, index: u16) -> Checked<bool> {
    if !matches!(index, 0x1400..=0x15FF | 0x1800..=0x19FF) {
        return Ok(false);
    }
    let count = dut.upload(Address::new(index + 0x200, 0))?;
    Ok(count.is_ok_and(|count| count == [0]))
}

/// Each TPDO with a CAN-ID of 29 bits is sent with it, or the node refuses bit 29.
pub(super) fn extended(dut: &mut Dut<'_>) -> Checked {
    on_each(dut, |dut, pdo, _| {
        timed_on(dut, pdo, 50)?;
        is_extended(dut, pdo)
    })
}

fn is_extended(dut: &mut Dut<'_>, pdo: &Tpdo) -> Checked {
    const OTHER: u32 = 1 << 29 | 0x04F1_F1F1 & 0x1FFF_FFFF;
    if !dut.eds.writes(pdo.com, 1) {
        return lacks("the COB-ID cannot be written");
    }
    let address = pdo.address(1);
    let off = pdo.cob_id | 1 << 31;
    dut.write(address, &off.to_le_bytes())?;
    let codes = [AbortCode::ValueRange, AbortCode::ValueTooHigh];
    let mut done = Ok(());
    let mut is_taken = true;
    for value in [OTHER | 1 << 31, OTHER] {
        if let Err(code) = dut.download(address, &value.to_le_bytes())? {
            done = is_abort(&request(0x80, address, code.to_le_bytes()), &codes);
            is_taken = false;
            break;
        }
    }
    if is_taken {
        dut.nmt(Command::Start)?;
        let ids = [CobId::new(OTHER).can_id(), pdo.id()];
        let low = CanId::standard((OTHER & 0x7FF) as u16);
        let heard = dut.next(500_000, |frame| {
            (ids.contains(&frame.id()) || frame.id() == low) && !frame.is_remote()
        })?;
        dut.nmt(Command::EnterPreOperational)?;
        done = match heard {
            Some(heard) => ensure(
                heard.frame.id() == ids[0],
                format!("the TPDO with the CAN-ID {}, of 29 bits", ids[0]),
                format!("{} came", heard.frame),
            ),
            None => fail(
                format!("the TPDO with the CAN-ID {}, of 29 bits", ids[0]),
                "none came, and bit 29 was accepted",
            ),
        };
    }
    for value in [OTHER | 1 << 31, off, pdo.cob_id] {
        let _ = dut.download(address, &value.to_le_bytes())?;
    }
    done
}

/// SYNC and TIME refuse restricted CAN-IDs.
fn refuse_restricted(dut: &mut Dut<'_>, index: u16) -> Checked<bool> {
    let address = Address::new(index, 0);
    if !dut.eds.writes(index, 0) {
        return Ok(false);
    }
    let before = dut.keep(address)?;
    // Flag bits that make the node neither a producer nor a consumer during the test.
    let flags = number(&before) as u32 & !(0xC000_0000 | 0x1FFF_FFFF);
    for id in RESTRICTED {
        let codes = [
            AbortCode::ValueRange,
            AbortCode::ValueTooHigh,
            AbortCode::ValueTooLow,
        ];
        let done = dut.refuses_value(address, &(flags | id).to_le_bytes(), &codes);
        if done.is_err() {
            dut.fault(done)?;
            let _ = dut.download(address, &before)?;
            break;
        }
    }
    Ok(true)
}

/// COB-IDs of PDO, EMCY, further SDO servers, SYNC and TIME refuse restricted CAN-IDs.
pub(super) fn restricted(dut: &mut Dut<'_>) -> Checked {
    learn_sync(dut)?;
    let mut any = refuse_restricted(dut, 0x1005)? | refuse_restricted(dut, 0x1012)?;
    let servers = (0x1201..=0x127F).flat_map(|index| [1, 2].map(|sub| Address::new(index, sub)));
    let servers = servers.filter(|address| dut.eds.writes(address.index, address.sub));
    let all: Vec<_> = with_bit_31(dut).into_iter().chain(servers).collect();
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
    at_least_one(any, "no COB-ID can be written")
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
