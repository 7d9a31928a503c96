//! Every value that a save keeps, a restore and a reset put back: of communication, of each PDO, of the application
//! and of the manufacturer.

use od_model::{Address, Entry, Group, values};
use od_wire::CobId;
use od_wire::nmt::Command;

use super::content::carries_values;
use super::each_tpdo::on_each;
use super::mapping::fillings;
use super::store::command;
use super::transmit::{Mapped, contradiction, is_on, mapping, timed_on};
use crate::conform::dut::{Dut, FREE};
use crate::conform::eds::is_number;
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::number;

/// A value before a change, and after it.
struct Change {
    address: Address,
    /// Empty for a mapping entry that was not in use, whose value then does not matter.
    before: Vec<u8>,
    other: Vec<u8>,
}

/// The parameters of a PDO that its COB-ID protects: they are written while the PDO is not valid.
#[derive(Clone, PartialEq, Eq)]
struct Pdo {
    com: u16,
    cob_id: u32,
    /// Inhibit time and SYNC start value, sub-indices 3 and 6, if they can be written.
    times: Vec<(Address, Vec<u8>)>,
    /// The entries of the mapping, if it can be written.
    entries: Option<Vec<u32>>,
}

impl Pdo {
    /// Reads them; `None` if the COB-ID cannot be written, or the EDS does not allow the mapping.
    fn read(dut: &mut Dut<'_>, com: u16) -> Checked<Option<Self>> {
        let cob_id = dut.number(com, 1)? as u32;
        // A restricted COB-ID of an invalid EDS could not be written back.
        if !dut.eds.writes(com, 1) || CobId::new(cob_id).is_valid() && !is_on(cob_id) {
            return Ok(None);
        }
        let mut times = Vec::new();
        for sub in [3, 6] {
            if dut.eds.writes(com, sub) && com >= 0x1800 {
                let address = Address::new(com, sub);
                times.push((address, dut.read(address)?));
            }
        }
        let map = com + 0x200;
        let all = mapping(dut, map)?;
        if contradiction(dut.eds, &all, com >= 0x1800).is_some() {
            return Ok(None);
        }
        let is_variable = dut.eds.writes(map, 0)
            && dut.eds.writes(map, 1)
            // A multiplexed PDO has FEh or FFh.
            && dut.number(map, 0)? <= 64;
        let entries = is_variable.then(|| all.iter().map(Mapped::raw).collect());
        Ok(Some(Self {
            com,
            cob_id,
            times,
            entries,
        }))
    }

    /// Another CAN-ID, other times and another mapping.
    fn other(&self, number: u16, entries: Option<Vec<u32>>) -> Self {
        let id = u32::from(FREE + 0x10 + number % 0x10);
        let times = self.times.iter().map(|(address, bytes)| {
            let mut other = bytes.clone();
            other.iter_mut().for_each(|byte| *byte ^= 3);
            (*address, other)
        });
        Self {
            com: self.com,
            cob_id: self.cob_id & !0x1FFF_FFFF | id,
            times: times.collect(),
            entries,
        }
    }

    /// Writes all of them by the procedure of CiA 301. Returns whether the node accepts them.
    fn write(&self, dut: &mut Dut<'_>) -> Checked<bool> {
        let com = Address::new(self.com, 1);
        let now = dut.number(self.com, 1)? as u32;
        let mut writes = vec![(com, (now | 1 << 31).to_le_bytes().to_vec())];
        if let Some(entries) = &self.entries {
            let map = self.com + 0x200;
            writes.push((Address::new(map, 0), vec![0]));
            for (sub, entry) in (1..).zip(entries) {
                writes.push((Address::new(map, sub), entry.to_le_bytes().to_vec()));
            }
            writes.push((Address::new(map, 0), vec![entries.len() as u8]));
        }
        writes.extend(self.times.iter().cloned());
        let mut is_taken = true;
        for (address, bytes) in writes {
            is_taken = dut.download(address, &bytes)?.is_ok();
            if !is_taken {
                break;
            }
        }
        for cob_id in [self.cob_id | 1 << 31, self.cob_id] {
            is_taken &= dut.download(com, &cob_id.to_le_bytes())?.is_ok();
        }
        Ok(is_taken)
    }

    fn values(&self) -> Vec<(Address, Vec<u8>)> {
        let mut all = vec![(
            Address::new(self.com, 1),
            self.cob_id.to_le_bytes().to_vec(),
        )];
        all.extend(self.times.iter().cloned());
        if let Some(entries) = &self.entries {
            let map = self.com + 0x200;
            all.push((Address::new(map, 0), vec![entries.len() as u8]));
            for (sub, entry) in (1..).zip(entries) {
                all.push((Address::new(map, sub), entry.to_le_bytes().to_vec()));
            }
        }
        all
    }
}

/// All changes of a case.
struct Changes {
    all: Vec<Change>,
    /// Each PDO as it was.
    pdos: Vec<Pdo>,
}

/// Other values, which the EDS allows: one that differs in each byte, one that differs by one, the limits, and one for
/// each bit, since an object may be a set of bits.
fn others(dut: &Dut<'_>, entry: &Entry, before: &[u8]) -> Vec<Vec<u8>> {
    let address = entry.address;
    let flip = |count: usize| {
        let mut other = before.to_vec();
        other.iter_mut().take(count).for_each(|byte| *byte ^= 1);
        other
    };
    let all = match (address.index, address.sub, before) {
        // Each entry monitors another node, which never sends.
        (0x1016, sub, [_, _, _, flags]) => {
            vec![vec![0x10, 0x27, 100u8.saturating_add(sub).min(127), *flags]]
        }
        (0x1400..=0x19FF, 2, [kind]) => vec![vec![if *kind == 1 { 255 } else { 1 }]],
        // An object of a manufacturer may be a list of options.
        (0x2000..=0x5FFF, ..) => vec![flip(1)],
        _ => {
            let literal = |literal: od_model::Literal| {
                let value = literal.integer(dut.node.raw())?;
                Some(value.to_le_bytes().get(..before.len())?.to_vec())
            };
            let limits = [literal(entry.low), literal(entry.high)];
            let mut all = vec![flip(8), flip(1)];
            all.extend(limits.into_iter().flatten());
            all.extend((1..8).map(|bit| {
                let mut other = before.to_vec();
                other.iter_mut().take(1).for_each(|byte| *byte ^= 1 << bit);
                other
            }));
            all
        }
    };
    let is_allowed =
        |other: &Vec<u8>| other != before && dut.eds.excludes(address, other, dut.node).is_none();
    all.into_iter().filter(is_allowed).collect()
}

/// COB-IDs, and the inhibit time of EMCY messages, which a case may change for a while.
const SERVICES: [u16; 4] = [0x1005, 0x1012, 0x1014, 0x1015];

/// Parameters that a case may change, by address: with the permission to set outputs also those of a module that act on
/// its outputs. 1006h and 1019h depend on each other, and have a case of their own.
fn parameters(dut: &Dut<'_>) -> Vec<Entry> {
    let mut all = dut.eds.writable();
    if dut.may_move {
        all.extend(dut.eds.reactions());
    }
    all.retain(|entry| is_number(entry) && !matches!(entry.address.index, 0x1006 | 0x1019));
    all.sort_by_key(|entry| entry.address);
    all.dedup_by_key(|entry| entry.address);
    all
}

impl Changes {
    /// Changes every value for which `which` is true and which the node lets a master change.
    fn make(dut: &mut Dut<'_>, which: impl Fn(&Entry) -> bool) -> Checked<Self> {
        let mut made = Self {
            all: Vec::new(),
            pdos: Vec::new(),
        };
        let done = made.change(dut, which);
        if let Err(End::Fail { .. } | End::NotApplicable(_) | End::Skip(_)) = done {
            made.undo(dut)?;
        }
        done.map(|()| made)
    }

    fn change(&mut self, dut: &mut Dut<'_>, which: impl Fn(&Entry) -> bool) -> Checked {
        let mut entries = parameters(dut);
        entries.retain(&which);
        // Read everything first: some objects are two views of one value.
        let mut before = Vec::new();
        for entry in &entries {
            if let Ok(bytes) = dut.upload(entry.address)?
                && !bytes.is_empty()
            {
                before.push((*entry, bytes));
            }
        }
        for index in SERVICES {
            if let Some(entry) = dut.eds.entry(index, 0).filter(|entry| which(entry)) {
                self.service(dut, &entry)?;
            }
        }
        for base in [0x1400, 0x1800] {
            for pdo in dut.eds.pdos(base) {
                let entry = dut.eds.entry(base + pdo, 1);
                if entry.is_some_and(|entry| which(&entry)) {
                    self.pdo(dut, base + pdo, pdo + (base - 0x1400) / 0x80)?;
                }
            }
        }
        for (entry, before) in before {
            for other in others(dut, &entry, &before) {
                if dut.download(entry.address, &other)?.is_ok() {
                    self.add(entry.address, before, other);
                    break;
                }
            }
        }
        // A later write may have changed an earlier value.
        let mut is_there = Vec::new();
        for change in &self.all {
            is_there.push(dut.upload(change.address)?.as_ref() == Ok(&change.other));
        }
        let mut is_there = is_there.into_iter();
        self.all.retain(|_| is_there.next() == Some(true));
        at_least_one(!self.all.is_empty(), "no parameter can be changed")
    }

    fn add(&mut self, address: Address, before: Vec<u8>, other: Vec<u8>) {
        self.all.push(Change {
            address,
            before,
            other,
        });
    }

    /// Another CAN-ID of a service without bit 31, or another inhibit time.
    fn service(&mut self, dut: &mut Dut<'_>, entry: &Entry) -> Checked {
        let address = entry.address;
        if !entry.access.writable() {
            return Ok(());
        }
        let before = dut.read(address)?;
        let other = match address.index {
            0x1015 => vec![0x64, 0],
            index => {
                let id = u32::from(FREE) + 0x30 + u32::from(index & 0xF);
                let raw = number(&before) as u32;
                (raw & !0x1FFF_FFFF & !(1 << 30) | id)
                    .to_le_bytes()
                    .to_vec()
            }
        };
        if address.index == 0x1014 {
            let off = (number(&before) as u32 | 1 << 31).to_le_bytes();
            let _ = dut.download(address, &off)?;
        }
        if dut.download(address, &other)?.is_ok() {
            let is = dut.read(address)?;
            let done = ensure(
                is == other,
                format!("{} in {address}, as written", values::hex(&other)),
                format!("{} was read", values::hex(&is)),
            );
            dut.fault(done)?;
            self.add(address, before, other);
        } else {
            let _ = dut.download(address, &before)?;
        }
        Ok(())
    }

    /// Another CAN-ID and another mapping of a PDO, or another CAN-ID only.
    fn pdo(&mut self, dut: &mut Dut<'_>, com: u16, number: u16) -> Checked {
        let Some(before) = Pdo::read(dut, com)? else {
            return Ok(());
        };
        let [full, once] = fillings(dut, com + 0x200);
        let tries = match &before.entries {
            Some(_) => vec![Some(full), Some(once), None],
            None => vec![None],
        };
        for entries in tries {
            let other = before.other(number, entries);
            if other.write(dut)? {
                let was = before.values();
                for (address, other) in other.values() {
                    let was = was.iter().find(|(one, _)| *one == address);
                    let was = was.map(|(_, bytes)| bytes.clone()).unwrap_or_default();
                    if was != other {
                        self.add(address, was, other);
                    }
                }
                self.pdos.push(before);
                return Ok(());
            }
        }
        before.write(dut).map(drop)
    }

    /// Writes every value from before.
    fn undo(&self, dut: &mut Dut<'_>) -> Checked {
        let of_pdo = |index: u16| (0x1400..0x1C00).contains(&index);
        for change in self.all.iter().rev() {
            let Address { index, sub } = change.address;
            if index == 0x1014 {
                let now = number(&dut.read(change.address)?) as u32;
                let off = number(&change.before) as u32 | 1 << 31;
                for value in [now | 1 << 31, off] {
                    let _ = dut.download(change.address, &value.to_le_bytes())?;
                }
            }
            if !of_pdo(index) || index & 0x200 == 0 && matches!(sub, 2 | 4 | 5) {
                let done = dut.download(change.address, &change.before)?;
                if let Err(code) = done {
                    dut.notes.push(format!(
                        "could not put back {}: {code:08X}h",
                        change.address
                    ));
                }
            }
        }
        for pdo in &self.pdos {
            if !pdo.write(dut)? {
                dut.notes
                    .push(format!("could not put back the PDO {:04X}h", pdo.com));
            }
        }
        Ok(())
    }

    /// Compares each value with the one from before, or the changed one.
    fn compare(
        &self,
        dut: &mut Dut<'_>,
        wanted: impl Fn(&Dut<'_>, &Change) -> Option<Vec<u8>>,
        when: &str,
    ) -> Checked {
        for change in &self.all {
            let Some(wanted) = wanted(dut, change) else {
                continue;
            };
            let is = dut.upload(change.address)?.unwrap_or_default();
            let name = values::label(dut.eds.dictionary(), change.address);
            let done = ensure(
                is == wanted,
                format!("{} in {name} {when}", values::hex(&wanted)),
                format!("{} was read", values::hex(&is)),
            );
            dut.fault(done)?;
        }
        Ok(())
    }
}

impl Change {
    /// The value before, if it matters.
    fn earlier(&self) -> Option<Vec<u8>> {
        (!self.before.is_empty()).then(|| self.before.clone())
    }
}

/// Returns whether a save, a restore and a reset are about the value.
fn is_saved(entry: &Entry) -> bool {
    entry.group.covered_by(1)
}

/// Runs a test of changed values, and puts back the values and the position of an encoder, which depends on some of them.
fn changed(
    dut: &mut Dut<'_>,
    which: impl Fn(&Entry) -> bool,
    test: impl FnOnce(&mut Dut<'_>, &Changes) -> Checked,
    saves: bool,
) -> Checked {
    let has_position = dut.eds.has(0x6004) && dut.eds.writes(0x6003, 0);
    let place = if has_position {
        Some(dut.read(Address::new(0x6004, 0))?)
    } else {
        None
    };
    let changes = Changes::make(dut, which)?;
    let done = test(dut, &changes);
    if let Err(End::Lost(_)) = done {
        return done;
    }
    dut.nmt(Command::EnterPreOperational)?;
    changes.undo(dut)?;
    if let Some(place) = place
        && dut.read(Address::new(0x6004, 0))? != place
    {
        let preset = Address::new(0x6003, 0);
        if dut.eds.excludes(preset, &place, dut.node).is_none() {
            let _ = dut.download(preset, &place)?;
        }
    }
    if saves {
        command(dut, 0x1010, 1, b"save")?;
        dut.notes
            .push(format!("saved {} values again", changes.all.len()));
    }
    done
}

/// Every value is there after a save and a reset.
pub(super) fn saves_each(dut: &mut Dut<'_>) -> Checked {
    if dut.number(0x1010, 1)? & 1 == 0 {
        return lacks("the node does not save on command");
    }
    let test = |dut: &mut Dut<'_>, changes: &Changes| {
        command(dut, 0x1010, 1, b"save")?;
        // A node that keeps its values at a reset must have saved these.
        changes.undo(dut)?;
        dut.reset(Command::ResetNode)?;
        let other = |_: &Dut<'_>, change: &Change| Some(change.other.clone());
        changes.compare(dut, other, "after the reset, as saved")
    };
    changed(dut, is_saved, test, true)
}

/// Every value that was saved is there after the power was off.
pub(super) fn saves_over_power(dut: &mut Dut<'_>) -> Checked {
    if dut.number(0x1010, 1)? & 1 == 0 {
        return lacks("the node does not save on command");
    }
    let test = |dut: &mut Dut<'_>, changes: &Changes| {
        command(dut, 0x1010, 1, b"save")?;
        changes.undo(dut)?;
        dut.power_cycle()?;
        let other = |_: &Dut<'_>, change: &Change| Some(change.other.clone());
        changes.compare(dut, other, "after the power was off, as saved")
    };
    changed(dut, is_saved, test, true)
}

/// A command in Operational that the node confirms has its effect. Returns whether the node confirms it: it may refuse.
fn in_operational_too(dut: &mut Dut<'_>, index: u16, signature: &[u8]) -> Checked<bool> {
    dut.nmt(Command::Start)?;
    let done = dut.download(Address::new(index, 1), signature)?;
    dut.wait(600_000)?;
    dut.nmt(Command::EnterPreOperational)?;
    Ok(done.is_ok())
}

/// A save in Operational is refused, or every value is there after a reset.
pub(super) fn saves_in_operational(dut: &mut Dut<'_>) -> Checked {
    let test = |dut: &mut Dut<'_>, changes: &Changes| {
        if !in_operational_too(dut, 0x1010, b"save")? {
            return lacks("the node does not save in Operational");
        }
        changes.undo(dut)?;
        dut.reset(Command::ResetNode)?;
        let other = |_: &Dut<'_>, change: &Change| Some(change.other.clone());
        changes.compare(dut, other, "after a save in Operational and the reset")
    };
    changed(dut, is_saved, test, true)
}

/// A restore in Operational is refused, or every value has its default after a reset.
pub(super) fn restores_in_operational(dut: &mut Dut<'_>) -> Checked {
    let test = |dut: &mut Dut<'_>, changes: &Changes| {
        command(dut, 0x1010, 1, b"save")?;
        if !in_operational_too(dut, 0x1011, b"load")? {
            return lacks("the node does not restore in Operational");
        }
        dut.reset(Command::ResetNode)?;
        let default = |dut: &Dut<'_>, change: &Change| {
            let entry = dut.eds.entry(change.address.index, change.address.sub)?;
            dut.eds.default(&entry, dut.node)
        };
        changes.compare(dut, default, "after a restore in Operational and the reset")
    };
    changed(dut, is_saved, test, true)
}

/// The parts of 1010h and 1011h: of communication, of the application, and of the manufacturer.
const PARTS: [(u8, Command); 3] = [
    (2, Command::ResetCommunication),
    (3, Command::ResetNode),
    (4, Command::ResetNode),
];

/// Returns whether a sub-index 2 to 4 of 1010h and 1011h is about the value, and no value of the other part is the same
/// one: 6200h of an encoder is also the event timer of the first TPDO (CiA 406).
fn is_of_part(entry: &Entry, is_encoder: bool) -> bool {
    let Address { index, sub } = entry.address;
    let is_shared = is_encoder && matches!((index, sub), (0x6200, _) | (0x1800, 5));
    is_saved(entry) && !is_shared
}

/// Returns whether this sub-index of 1010h and 1011h is about the changed value.
fn is_part(dut: &Dut<'_>, change: &Change, sub: u8) -> bool {
    let entry = dut.eds.entry(change.address.index, change.address.sub);
    entry.is_some_and(|entry| entry.group.covered_by(sub))
}

/// Returns whether this sub-index of 1010h or 1011h acts on command. One that has 0 refuses its signature.
fn acts(dut: &mut Dut<'_>, index: u16, sub: u8, signature: &[u8]) -> Checked<bool> {
    let address = Address::new(index, sub);
    let can = dut.number(index, sub)?;
    if can == 0 {
        let done = dut.cannot_change(address, signature, &format!("as {address} is 0"));
        dut.fault(done)?;
    }
    Ok(can & 1 == 1)
}

/// 1010h:02 to 1010h:04 save each value of their own, and no other.
pub(super) fn saves_parts(dut: &mut Dut<'_>) -> Checked {
    parts(dut, |dut, changes, sub, _| {
        command(dut, 0x1010, sub, b"save")?;
        changes.undo(dut)?;
        dut.reset(Command::ResetNode)?;
        let wanted = |dut: &Dut<'_>, change: &Change| {
            if is_part(dut, change, sub) {
                return Some(change.other.clone());
            }
            change.earlier()
        };
        let when = format!("after a save by 1010h:{sub:02X} and the reset");
        changes.compare(dut, wanted, &when)
    })
}

/// 1011h:02 to 1011h:04 restore each value of their own, and no other.
pub(super) fn restores_parts(dut: &mut Dut<'_>) -> Checked {
    parts(dut, |dut, changes, sub, reset| {
        if dut.eds.entry(0x1011, sub).is_none() || !acts(dut, 0x1011, sub, b"load")? {
            return Ok(());
        }
        command(dut, 0x1010, 1, b"save")?;
        command(dut, 0x1011, sub, b"load")?;
        dut.reset(reset)?;
        let wanted = |dut: &Dut<'_>, change: &Change| {
            if !is_part(dut, change, sub) {
                return Some(change.other.clone());
            }
            let entry = dut.eds.entry(change.address.index, change.address.sub)?;
            dut.eds.default(&entry, dut.node)
        };
        let when = format!("after a restore by 1011h:{sub:02X} and the reset");
        changes.compare(dut, wanted, &when)
    })
}

/// Runs a test for each of these parts that the node saves on command.
fn parts(
    dut: &mut Dut<'_>,
    test: impl Fn(&mut Dut<'_>, &Changes, u8, Command) -> Checked,
) -> Checked {
    if saves_itself(dut)? {
        return lacks("the node saves values itself");
    }
    if dut.number(0x1010, 1)? & 1 == 0 {
        return lacks("the node does not save on command");
    }
    let is_encoder = dut.eds.meets("cia406") == Some(true);
    let mut any = false;
    for (sub, reset) in PARTS {
        if dut.eds.entry(0x1010, sub).is_none() || !acts(dut, 0x1010, sub, b"save")? {
            continue;
        }
        any = true;
        // The memory has what the node has now.
        command(dut, 0x1010, 1, b"save")?;
        let test = |dut: &mut Dut<'_>, changes: &Changes| test(dut, changes, sub, reset);
        let done = changed(dut, |entry| is_of_part(entry, is_encoder), test, true);
        dut.fault(done)?;
    }
    at_least_one(any, "1010h has no sub-index 2 to 4 that saves on command")
}

/// Every value has its default after a save, a restore and a reset.
pub(super) fn restores_each(dut: &mut Dut<'_>) -> Checked {
    if dut.number(0x1010, 1)? & 1 == 0 || dut.number(0x1011, 1)? & 1 == 0 {
        return lacks("the node does not save and restore on command");
    }
    let test = |dut: &mut Dut<'_>, changes: &Changes| {
        command(dut, 0x1010, 1, b"save")?;
        command(dut, 0x1011, 1, b"load")?;
        dut.reset(Command::ResetNode)?;
        let default = |dut: &Dut<'_>, change: &Change| {
            let entry = dut.eds.entry(change.address.index, change.address.sub)?;
            dut.eds.default(&entry, dut.node)
        };
        changes.compare(dut, default, "after the reset, the default")?;
        // The TPDOs carry what their mappings say again.
        let carried = on_each(dut, |dut, pdo, _| {
            timed_on(dut, pdo, 50)?;
            carries_values(dut, pdo)
        });
        match carried {
            Err(End::NotApplicable(_)) => Ok(()),
            done => done,
        }
    };
    changed(dut, is_saved, test, true)
}

/// Returns whether the node saves some values itself (bit 1 of 1010h).
fn saves_itself(dut: &mut Dut<'_>) -> Checked<bool> {
    if !dut.eds.has(0x1010) {
        return Ok(false);
    }
    let highest = dut.upload(Address::new(0x1010, 0))?.unwrap_or_default();
    for sub in 1..=number(&highest).min(127) as u8 {
        let can = dut.upload(Address::new(0x1010, sub))?;
        if can.is_ok_and(|bytes| number(&bytes) & 2 != 0) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Every value that was not saved is lost after the reset.
fn forgets_each(
    dut: &mut Dut<'_>,
    groups: &[Group],
    when: &str,
    restart: impl FnOnce(&mut Dut<'_>) -> Checked,
) -> Checked {
    if saves_itself(dut)? {
        return lacks("the node saves values itself");
    }
    let which = |entry: &Entry| groups.contains(&entry.group);
    let test = |dut: &mut Dut<'_>, changes: &Changes| {
        restart(dut)?;
        let before = |_: &Dut<'_>, change: &Change| change.earlier();
        changes.compare(dut, before, &format!("after {when}, as before the change"))
    };
    changed(dut, which, test, false)
}

pub(super) fn reset_communication(dut: &mut Dut<'_>) -> Checked {
    forgets_each(dut, &[Group::Communication], "the reset", |dut| {
        dut.reset(Command::ResetCommunication)
    })
}

/// Reset communication keeps every parameter of the application, in each NMT state.
pub(super) fn keeps_application(dut: &mut Dut<'_>) -> Checked {
    let is_encoder = dut.eds.meets("cia406") == Some(true);
    let which = |entry: &Entry| entry.group == Group::Application && is_of_part(entry, is_encoder);
    let test = |dut: &mut Dut<'_>, changes: &Changes| {
        for state in [Command::EnterPreOperational, Command::Start, Command::Stop] {
            dut.nmt(state)?;
            dut.reset(Command::ResetCommunication)?;
            let other = |_: &Dut<'_>, change: &Change| Some(change.other.clone());
            changes.compare(dut, other, "after reset communication, as written")?;
        }
        Ok(())
    };
    changed(dut, which, test, false)
}

const BOTH: [Group; 2] = [Group::Communication, Group::Application];

pub(super) fn reset_node(dut: &mut Dut<'_>) -> Checked {
    forgets_each(dut, &BOTH, "the reset", |dut| dut.reset(Command::ResetNode))
}

pub(super) fn power_off(dut: &mut Dut<'_>) -> Checked {
    forgets_each(dut, &BOTH, "the power was off", |dut| dut.power_cycle())
}

/// A write of a sub-object changes no other sub-object of its object, and not the same one of the next objects.
pub(super) fn neighbours(dut: &mut Dut<'_>) -> Checked {
    let mut entries = parameters(dut);
    entries.retain(|entry| entry.group != Group::None);
    let addresses: Vec<Address> = entries.iter().map(|entry| entry.address).collect();
    let mut any = false;
    for entry in &entries {
        let own = entry.address;
        let is_near = |other: &&Address| {
            let is_next = own.index.abs_diff(other.index) == 1 && own.sub == other.sub;
            **other != own && (own.index == other.index || is_next)
        };
        let near: Vec<Address> = addresses.iter().filter(is_near).copied().collect();
        let before = dut.upload(own)?.unwrap_or_default();
        let first = read_all(dut, &near)?;
        let second = read_all(dut, &near)?;
        let mut is_written = false;
        for other in others(dut, entry, &before) {
            is_written = dut.download(own, &other)?.is_ok();
            if is_written {
                break;
            }
        }
        if !is_written {
            continue;
        }
        any = true;
        // A write of a manufacturer's object may be a command, after which it has its own value again.
        if !(0x2000..0x6000).contains(&own.index) && dut.upload(own)?.as_ref() == Ok(&before) {
            let done = fail(
                format!("another value in {own} after a write that the node accepted"),
                format!("{} was read, as before it", values::hex(&before)),
            );
            dut.fault(done)?;
        }
        let after = read_all(dut, &near)?;
        if let Err(code) = dut.download(own, &before)? {
            dut.notes
                .push(format!("could not put back {own}: {code:08X}h"));
        }
        for (at, address) in near.iter().enumerate() {
            // A value that differs between two readings changes without a write.
            let done = ensure(
                first[at] != second[at] || after[at] == first[at],
                format!("{} in {address} still", values::hex(&first[at])),
                format!(
                    "{} was read after a write of {own}",
                    values::hex(&after[at])
                ),
            );
            dut.fault(done)?;
        }
    }
    at_least_one(any, "no parameter can be changed")
}

fn read_all(dut: &mut Dut<'_>, all: &[Address]) -> Checked<Vec<Vec<u8>>> {
    let read = |address: &Address| Ok(dut.upload(*address)?.unwrap_or_default());
    all.iter().map(read).collect()
}

/// With 8 in 1F80h a node enters Operational after a reset, without a command.
pub(super) fn self_start(dut: &mut Dut<'_>) -> Checked {
    let address = Address::new(0x1F80, 0);
    let is_saved = dut.eds.entry(0x1F80, 0).map(|entry| entry.group);
    if !is_saved.is_some_and(|group| group.covered_by(1)) {
        return lacks("1010h:01 does not save 1F80h, by the EDS");
    }
    let before = dut.read(address)?;
    if dut.download(address, &[8, 0, 0, 0])?.is_err() {
        return lacks("the node does not start itself");
    }
    let done = (|| {
        command(dut, 0x1010, 1, b"save")?;
        for reset in [Command::ResetNode, Command::ResetCommunication] {
            dut.reset(reset)?;
            dut.follow_state()?;
            let done = dut.is_in(5);
            dut.fault(done)?;
        }
        Ok(())
    })();
    if let Err(End::Lost(_)) = done {
        return done;
    }
    dut.nmt(Command::EnterPreOperational)?;
    dut.write(address, &before)?;
    command(dut, 0x1010, 1, b"save")?;
    done
}

/// Every parameter has the same value in Operational as in Pre-operational.
pub(super) fn in_operational(dut: &mut Dut<'_>) -> Checked {
    let entries = dut.eds.dictionary().entries();
    let is_one = |entry: &Entry| {
        let is_identity = matches!(entry.address.index, 0x1000 | 0x1018);
        entry.access.readable()
            && (is_identity || entry.access.writable() && entry.group != Group::None)
            && entry.data_type.size().is_some_and(|size| size <= 4)
            && !(0x1F50..=0x1F5F).contains(&entry.address.index)
    };
    let all: Vec<Address> = entries.filter(is_one).map(|entry| entry.address).collect();
    let first = read_all(dut, &all)?;
    dut.nmt(Command::Start)?;
    let second = read_all(dut, &all)?;
    dut.nmt(Command::EnterPreOperational)?;
    let third = read_all(dut, &all)?;
    for (at, address) in all.iter().enumerate() {
        // A value that is not the same afterwards changes without a write.
        let name = values::label(dut.eds.dictionary(), *address);
        let done = ensure(
            first[at] == second[at] || first[at] != third[at],
            format!("{} in {name} in Operational, too", values::hex(&first[at])),
            format!("{} was read", values::hex(&second[at])),
        );
        dut.fault(done)?;
    }
    at_least_one(!all.is_empty(), "the EDS has no parameter")
}
