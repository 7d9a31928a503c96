//! Records the behaviour of a node for some time, for a twin that repeats it.

use std::collections::{BTreeMap, BTreeSet};

use od_eds::Description;
use od_model::{Address, Kind};
use od_sim::recorded::Recorded;
use od_wire::emcy::Emcy;
use od_wire::nmt::{Command, Repr};
use od_wire::{Duration, Frame, Instant, NodeId};

use super::probe::Probe;
use crate::error::Error;
use crate::link::Link;
use crate::master::Master;

/// Longest time from a reset to the boot-up message.
const BOOT: Duration = Duration::from_secs(10);
/// EMCY messages within this time after the boot-up message belong to the start.
const START: Duration = Duration::from_secs(1);
/// Time between two rounds of reading the values that change, in ms.
const ROUND: u64 = 50;
/// Maximum number of changes of values that are recorded.
const CHANGES: usize = 10_000;

/// Options of [`record`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Watch {
    /// Time to listen, and then to read the values that change.
    pub length: Duration,
    /// Reset the node to measure its boot-up time and to see its EMCY messages, and start it for its PDOs.
    /// Afterwards it is in Operational if it was before, else in Pre-operational.
    pub reset: bool,
}

/// A recording, and the behaviour that it does not contain.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Recording {
    /// The recording, for [`od_sim::VirtualDevice::play_recorded`]; its text is appended to the EDS.
    pub recorded: Recorded,
    /// Behaviour that the recording does not contain, one sentence each.
    pub lacking: Vec<String>,
}

/// Records a node that was learned as `description`. Nothing is written.
///
/// # Errors
/// The link is lost, or the node stops responding.
pub fn record(
    mut link: impl Link,
    node: NodeId,
    description: &Description,
    watch: Watch,
) -> Result<Recording, Error> {
    let mut seen = Recording {
        recorded: Recorded {
            length: watch.length.as_micros() as u64,
            ..Recorded::default()
        },
        lacking: Vec::new(),
    };
    let result = begin(&mut link, node, watch, &mut seen).and_then(|state| {
        let listened = listen(&mut link, node, description, watch, &mut seen);
        let back = match (watch.reset, state) {
            (false, _) | (true, Some(5)) => Ok(()),
            (true, _) => {
                if matches!(listened, Err(Error::Interrupted)) {
                    link.resume();
                }
                nmt(&mut link, node, Command::EnterPreOperational)
            }
        };
        listened.and(back)
    });
    result?;
    let mut probe = Probe::new(&mut link, node);
    // Begins a download of two bytes in segments, and a block upload; neither is completed.
    seen.recorded.no_segments = probe.lacks_command(0x21, Address::new(0x1017, 0))?;
    seen.recorded.no_blocks = probe.lacks_command(0xA0, Address::new(0x1000, 0))?;
    values(link, node, description, watch, &mut seen)?;
    let always = [
        "state machines behind objects: a command changes another object only by the services of CiA 301",
        "physical values: what was recorded begins again after its length",
        "times of single responses: each takes the median",
    ];
    seen.lacking.extend(always.map(String::from));
    Ok(seen)
}

fn nmt(link: &mut impl Link, node: NodeId, command: Command) -> Result<(), Error> {
    let node = node.raw();
    link.send(&Frame::standard(0, &Repr { command, node }.emit()))
}

/// Resets and starts the node; returns its earlier NMT state, if a heartbeat shows it.
fn begin(
    link: &mut impl Link,
    node: NodeId,
    watch: Watch,
    seen: &mut Recording,
) -> Result<Option<u8>, Error> {
    if !watch.reset {
        let text = "boot-up time and errors at start: they need --allow-reset";
        seen.lacking.push(text.into());
        return Ok(None);
    }
    let mut state = None;
    let id = node.plus(0x700);
    let until = link.now() + watch.length;
    while let Some(heard) = link.receive(until)? {
        if heard.frame.id() == id && heard.frame.dlc() == 1 {
            state = Some(heard.frame.bytes()[0]);
            break;
        }
    }
    let from = link.now();
    nmt(link, node, Command::ResetNode)?;
    let mut booted: Option<Instant> = None;
    let mut until = from + BOOT;
    while let Some(heard) = link.receive(until)? {
        let frame = heard.frame;
        if frame.id() == id && frame.data() == [0] {
            booted = Some(heard.at);
            until = heard.at + START;
        } else if let (Some(booted), [low, high, register, info @ ..]) = (booted, frame.data())
            && frame.id() == node.plus(0x80)
            && let Ok(info) = <[u8; 5]>::try_from(info)
            && (*low, *high) != (0, 0)
        {
            let code = u16::from_le_bytes([*low, *high]);
            let error = Emcy {
                code,
                register: *register,
                info,
            };
            let at = heard.at.micros_since(booted);
            seen.recorded.errors.push((at, error));
        }
    }
    match booted {
        Some(at) => seen.recorded.boot_up = Some(at.micros_since(from)),
        None => {
            return Err(Error::Node(format!(
                "node {node} does not boot up within 10 s of a reset"
            )));
        }
    }
    nmt(link, node, Command::Start)?;
    Ok(state)
}

/// Heartbeat and TPDOs: the mean of their periods.
fn listen(
    link: &mut impl Link,
    node: NodeId,
    description: &Description,
    watch: Watch,
    seen: &mut Recording,
) -> Result<(), Error> {
    let default = |index: u16, sub: u8| {
        let entry = description.objects.get(&index)?.entries.get(&sub)?;
        entry.default.as_ref()?.value.integer(node.raw())
    };
    let tpdos = description.objects.range(0x1800..=0x19FF);
    let tpdos: BTreeMap<u16, u16> = tpdos
        .filter_map(|(index, _)| {
            let cob_id = default(*index, 1)?;
            let is_on = cob_id & 0x8000_0000 == 0;
            is_on.then_some(((cob_id & 0x7FF) as u16, index - 0x17FF))
        })
        .collect();
    let mut heard_at: BTreeMap<u16, Vec<Instant>> = BTreeMap::new();
    let until = link.now() + watch.length;
    while let Some(heard) = link.receive(until)? {
        if let Some(id) = heard
            .frame
            .id()
            .as_standard()
            .filter(|_| !heard.frame.is_remote())
        {
            heard_at.entry(id).or_default().push(heard.at);
        }
    }
    if let Some(period) = heard_at.get(&(0x700 + u16::from(node.raw()))) {
        seen.recorded.heartbeat = mean(period);
    }
    for (id, tpdo) in &tpdos {
        let Some(times) = heard_at.get(id) else {
            let text = format!("TPDO{tpdo}: none was heard");
            seen.lacking.push(text);
            continue;
        };
        match (mean(times), default(0x17FF + tpdo, 5)) {
            (Some(period), Some(1..)) => {
                seen.recorded.tpdos.insert(*tpdo, period);
            }
            _ => seen.lacking.push(format!(
                "TPDO{tpdo}: it was heard, but not by an event timer"
            )),
        }
    }
    Ok(())
}

/// The mean time between these moments if they are periodic, that is, if no gap is more than 1.5 times the mean.
fn mean(times: &[Instant]) -> Option<u64> {
    let (first, last) = (times.first()?, times.last()?);
    let gaps = times.len() as u64 - 1;
    let mean = last.micros_since(*first).checked_div(gaps)?;
    let longest = times
        .windows(2)
        .map(|pair| pair[1].micros_since(pair[0]))
        .max()?;
    (gaps >= 2 && longest <= mean + mean / 2).then_some(mean)
}

/// Response times, refused reads, and the values that change.
fn values(
    link: impl Link,
    node: NodeId,
    description: &Description,
    watch: Watch,
    seen: &mut Recording,
) -> Result<(), Error> {
    let mut master = Master::new(link, node);
    let mut last: BTreeMap<Address, Vec<u8>> = BTreeMap::new();
    let mut took = Vec::new();
    let mut changing = BTreeSet::new();
    let readable = description
        .entries()
        .filter(|(_, entry)| entry.access.readable());
    let readable: Vec<_> = readable
        .map(|(address, entry)| {
            let kind = entry.data_type.as_ref().map(|given| given.value.kind());
            (address, kind)
        })
        .collect();
    // Reads twice, so that changing values are found.
    for round in 0..2 {
        for (address, kind) in &readable {
            let from = master.link().now();
            match Error::or_abort(master.upload(*address))? {
                Ok(bytes) => {
                    if address.index == 0x1003 && address.sub > 0 && bytes.len() <= 4 {
                        seen.recorded.empty.insert(*address, bytes.clone());
                    }
                    if bytes.len() <= 4 {
                        took.push(master.link().now().micros_since(from));
                    }
                    let is_number = !matches!(kind, None | Some(Kind::Bytes | Kind::Text));
                    let before = last.insert(*address, bytes.clone());
                    if round == 1 && is_number && before.is_some_and(|before| before != bytes) {
                        changing.insert(*address);
                    }
                }
                Err(code) => {
                    seen.recorded.aborts.insert(*address, code);
                }
            }
        }
        let until = master.link().now().plus_millis(ROUND);
        while master.link().receive(until)?.is_some() {}
    }
    took.sort_unstable();
    seen.recorded.answer = took.get(took.len() / 2).copied().unwrap_or(0);
    let start = master.link().now();
    let until = start + watch.length;
    last.retain(|address, _| changing.contains(address));
    for (address, bytes) in &last {
        seen.recorded.values.push((0, *address, bytes.clone()));
    }
    while !changing.is_empty() && master.link().now() < until {
        for address in &changing {
            let Ok(bytes) = Error::or_abort(master.upload(*address))? else {
                continue;
            };
            let at = master.link().now().micros_since(start);
            if last.get(address) != Some(&bytes) && seen.recorded.values.len() < CHANGES {
                seen.recorded.values.push((at, *address, bytes.clone()));
                last.insert(*address, bytes);
            }
        }
        let next = master.link().now().plus_millis(ROUND);
        while master.link().receive(next)?.is_some() {}
    }
    Ok(())
}
