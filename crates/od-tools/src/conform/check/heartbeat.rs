//! Error control: heartbeat producer and consumer.

use od_model::Address;
use od_wire::nmt::Command;
use od_wire::{AbortCode, Frame};

use super::segments;
use crate::conform::dut::{Dut, is_data, state_name};
use crate::conform::end::{Checked, ensure, fail, lacks, optional};
use crate::conform::sdo::request;

pub(super) const PRODUCER: Address = Address::new(0x1017, 0);
const CONSUMER: Address = Address::new(0x1016, 1);

pub(super) fn period(dut: &mut Dut<'_>) -> Checked {
    every(dut, 100, 30, (Command::EnterPreOperational, 0x7F))?;
    every(dut, 100, 6, (Command::Start, 5))?;
    every(dut, 100, 6, (Command::Stop, 4))?;
    dut.nmt(Command::EnterPreOperational)
}

pub(super) fn other_period(dut: &mut Dut<'_>) -> Checked {
    let state = (Command::EnterPreOperational, 0x7F);
    every(dut, 100, 2, state)?;
    every(dut, 250, 4, state)?;
    // A time that needs both bytes.
    every(dut, 1000, 2, state)?;
    for millis in [5000u16, 0x8000, 0xFFFF] {
        let time = millis.to_le_bytes();
        if dut.eds.excludes(PRODUCER, &time, dut.node).is_some() {
            continue;
        }
        // The longer time takes effect at once, or after the heartbeat that was due.
        every(dut, 100, 1, state)?;
        dut.write(PRODUCER, &time)?;
        let heard = dut.all_of(dut.id(0x700), 1_000_000)?;
        ensure(
            heard.len() < 3,
            format!("at most two heartbeats in the first second with {millis} in 1017h"),
            format!("{} came", heard.len()),
        )?;
    }
    Ok(())
}

/// Checks that heartbeats arrive at this period, within 10 %, in the state after this command.
fn every(dut: &mut Dut<'_>, millis: u16, count: usize, (command, state): (Command, u8)) -> Checked {
    dut.nmt(Command::EnterPreOperational)?;
    dut.set(PRODUCER, &millis.to_le_bytes())?;
    dut.nmt(command)?;
    dut.drain()?;
    let id = dut.id(0x700);
    let period = u64::from(millis) * 1000;
    let off = period / 10 + dut.rig.slack();
    let mut last = None;
    let mut spans = Vec::new();
    for _ in 0..=count {
        let Some(heard) = dut.next_of(id, 2 * period)? else {
            return fail(
                format!("a heartbeat every {millis} ms"),
                "none came for twice as long",
            );
        };
        let got = format!("{} came", heard.frame);
        ensure(
            heard.frame.data() == [state],
            format!("the heartbeat of {}, {state:02X}h", state_name(state)),
            got,
        )?;
        if let Some(before) = last.replace(heard.at) {
            spans.push(heard.at.micros_since(before));
        }
    }
    let wrong = spans.iter().find(|span| span.abs_diff(period) > off);
    match wrong {
        Some(span) => fail(
            format!("a heartbeat every {millis} ms, 10 % off at most"),
            format!("one came after {}.{:03} ms", span / 1000, span % 1000),
        ),
        None => Ok(()),
    }
}

pub(super) fn off(dut: &mut Dut<'_>) -> Checked {
    dut.set(PRODUCER, &[50, 0])?;
    let id = dut.id(0x700);
    if dut.next_of(id, 200_000)?.is_none() {
        return fail("a heartbeat every 50 ms", "none came");
    }
    dut.write(PRODUCER, &[0, 0])?;
    dut.drain()?;
    dut.silent(id, 300_000, "no heartbeat with 1017h = 0")?;
    dut.write(PRODUCER, &[50, 0])?;
    if dut.next_of(id, 200_000)?.is_none() {
        return fail("a heartbeat every 50 ms again after 1017h = 0", "none came");
    }
    dut.write(PRODUCER, &[0, 0])?;
    for (command, state, micros) in [(Command::Start, 5, 1_100_000), (Command::Stop, 4, 300_000)] {
        dut.nmt(command)?;
        dut.drain()?;
        let expected = format!("no heartbeat in {} with 1017h = 0", state_name(state));
        dut.silent(id, micros, &expected)?;
    }
    Ok(())
}

/// Heartbeats come while the node serves SDO requests, refuses them and is told of an abort, and after it.
pub(super) fn beside_transfers(dut: &mut Dut<'_>) -> Checked {
    dut.set(PRODUCER, &[100, 0])?;
    dut.drain()?;
    let (first, begin) = (dut.frames.len(), dut.now());
    while dut.now() < begin.plus_millis(1000) {
        dut.still_serves()?;
        // A missing sub-index, and an abort of the client.
        let _ = dut.upload(Address::new(0x1018, 0x77))?;
        dut.send(Frame::full(
            dut.node.plus(0x600),
            [0x80, 0, 0, 0, 0, 0, 0, 8],
        ))?;
        dut.settle(20_000)?;
    }
    dut.wait(200_000)?;
    // A transfer that the client leaves open.
    if let Some((address, _)) = optional(segments::long_value(dut))? {
        segments::begin(dut, address)?;
        dut.wait(500_000)?;
        let abort = request(0x80, address, [0, 0, 0, 8]);
        dut.send(Frame::full(dut.node.plus(0x600), abort))?;
    }
    let id = dut.id(0x700);
    let all = dut.frames.get(first..).unwrap_or_default().iter();
    let beats = all.filter(|traced| !traced.ours && is_data(&traced.frame, id));
    let count = beats.count() as u64;
    let due = dut.now().micros_since(begin) / 100_000;
    ensure(
        (due - due / 4..=due + 2).contains(&count),
        format!(
            "about {due} heartbeats, one every 100 ms, while SDO requests are served and refused, and while a transfer is open"
        ),
        format!("{count} came"),
    )
}

pub(super) fn states(dut: &mut Dut<'_>) -> Checked {
    dut.set(PRODUCER, &[50, 0])?;
    for (command, state) in [
        (Command::Start, 5),
        (Command::Stop, 4),
        (Command::EnterPreOperational, 0x7F),
    ] {
        dut.nmt(command)?;
        dut.is_in(state)?;
    }
    Ok(())
}

/// A node ID without a node, for the node under test to monitor.
pub(super) fn watched(dut: &Dut<'_>) -> u8 {
    if dut.node.raw() == 100 { 101 } else { 100 }
}

/// Lets 1016h:01 monitor that node.
pub(super) fn watch(dut: &mut Dut<'_>, millis: u16) -> Checked<u8> {
    if !dut.eds.writes(0x1016, 1) {
        return lacks("1016h:01 cannot be written");
    }
    sends_emcy(dut)?;
    let node = watched(dut);
    let [low, high] = millis.to_le_bytes();
    dut.set(CONSUMER, &[low, high, node, 0])?;
    Ok(node)
}

pub(super) fn beat(dut: &mut Dut<'_>, node: u8) -> Checked {
    dut.send_to(0x700 + u16::from(node), &[5])
}

/// 1001h before an error. One that is already present would hide it, and a reset ends that, if the test may reset the node.
pub(super) fn register_before(dut: &mut Dut<'_>) -> Checked<u64> {
    if dut.number(0x1001, 0)? != 0 && dut.may_reset {
        dut.reset(Command::ResetCommunication)?;
    }
    dut.number(0x1001, 0)
}

/// The next EMCY of the node with this code.
pub(super) fn emcy(dut: &mut Dut<'_>, code: u16, micros: u64) -> Checked<Option<Frame>> {
    let id = dut.id(0x80);
    let [low, high] = code.to_le_bytes();
    let is_it = |frame: &Frame| is_data(frame, id) && frame.data().starts_with(&[low, high]);
    Ok(dut.next(micros, is_it)?.map(|heard| heard.frame))
}

/// As [`emcy`], with those that came since `from`, the number of a frame: also while the test waited for another frame.
pub(super) fn emcy_since(
    dut: &mut Dut<'_>,
    from: usize,
    code: u16,
    micros: u64,
) -> Checked<Option<Frame>> {
    let id = dut.id(0x80);
    let came = |dut: &Dut<'_>| {
        let frames = dut.frames.get(from..).unwrap_or_default().iter();
        let mut own = frames.filter(|traced| !traced.ours && is_data(&traced.frame, id));
        let found = own.find(|traced| traced.frame.data().starts_with(&code.to_le_bytes()));
        found.map(|traced| traced.frame)
    };
    match came(dut) {
        Some(frame) => Ok(Some(frame)),
        None => emcy(dut, code, micros),
    }
}

/// Ends the case as not applicable if the node has no EMCY according to the EDS.
pub(super) fn sends_emcy(dut: &Dut<'_>) -> Checked {
    let Some(entry) = dut.eds.entry(0x1014, 0) else {
        return lacks("the EDS does not have 1014h");
    };
    match entry.default.integer(dut.node.raw()) {
        Some(raw) if raw & 0x8000_0000 != 0 || raw & 0x7FF == 0 => {
            lacks(format!("no EMCY is sent: 1014h is {raw:X}h in the EDS"))
        }
        _ => Ok(()),
    }
}

pub(super) fn consumer_in_time(dut: &mut Dut<'_>) -> Checked {
    let node = watch(dut, 200)?;
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    for state in [5, 4, 0x7F, 5, 4, 0x7F] {
        dut.send_to(0x700 + u16::from(node), &[state])?;
        if let Some(frame) = emcy_since(dut, from, 0x8130, 100_000)? {
            return fail(
                "no EMCY 8130h while the heartbeat is in time",
                format!("{frame} came"),
            );
        }
    }
    Ok(())
}

pub(super) fn consumer_too_late(dut: &mut Dut<'_>) -> Checked {
    let node = watch(dut, 200)?;
    // Also after Stopped.
    dut.nmt(Command::Stop)?;
    dut.nmt(Command::Start)?;
    reports_silence(dut, node, 200)?;
    // A time that needs both bytes.
    beat(dut, node)?;
    dut.write(CONSUMER, &[0xE8, 3, node, 0])?;
    reports_silence(dut, node, 1000)
}

/// All entries of 1016h at once, eight at most: each of their nodes is missed while the others send their heartbeats.
pub(super) fn consumer_together(dut: &mut Dut<'_>) -> Checked {
    let mut all = consumers(dut)?;
    all.truncate(8);
    let own = dut.node.raw();
    sends_emcy(dut)?;
    let nodes: Vec<u8> = (104..)
        .filter(|node| *node != own)
        .take(all.len())
        .collect();
    for (address, node) in all.iter().zip(&nodes) {
        dut.set(*address, &[200, 0, *node, 0])?;
    }
    dut.nmt(Command::Start)?;
    for missing in &nodes {
        for node in &nodes {
            beat(dut, *node)?;
        }
        let from = dut.frames.len();
        let (mut came, end) = (None, dut.now().plus_millis(1000));
        while came.is_none() && dut.now() < end {
            for node in nodes.iter().filter(|node| *node != missing) {
                beat(dut, *node)?;
            }
            came = emcy_since(dut, from, 0x8130, 50_000)?;
        }
        if came.is_none() {
            let expected = format!("EMCY 8130h within 1 s of the last heartbeat of node {missing}");
            dut.fault(fail(expected, "none came"))?;
        }
    }
    // All are missing, then one of them only.
    for node in &nodes {
        beat(dut, *node)?;
    }
    dut.wait(50_000)?;
    let before = dut.number(0x1001, 0)?;
    dut.wait(400_000)?;
    let lost = dut.number(0x1001, 0)?;
    let (last, others) = nodes.split_last().unwrap_or((&0, &[]));
    for _ in 0..3 {
        for node in others {
            beat(dut, *node)?;
        }
        dut.wait(50_000)?;
    }
    let is = dut.number(0x1001, 0)?;
    ensure(
        is == lost || lost == before,
        format!("1001h = {lost:02X}h until the heartbeat of node {last} comes again, too"),
        format!("{is:02X}h was read"),
    )
}

/// After the heartbeats come again, 1001h has the value from before the error, and the node follows NMT commands.
pub(super) fn consumer_ends(dut: &mut Dut<'_>) -> Checked {
    let before = register_before(dut)?;
    let shows_state = optional(dut.follow_state())?.is_some();
    let node = watch(dut, 200)?;
    dut.nmt(Command::Start)?;
    reports_silence(dut, node, 200)?;
    for _ in 0..3 {
        beat(dut, node)?;
        dut.wait(50_000)?;
    }
    let after = dut.number(0x1001, 0)?;
    ensure(
        after == before,
        format!("1001h = {before:02X}h when heartbeats come again, as before the error"),
        format!("{after:02X}h was read"),
    )?;
    dut.write(CONSUMER, &[0, 0, node, 0])?;
    if shows_state {
        for (command, state) in [
            (Command::Start, 5),
            (Command::Stop, 4),
            (Command::Start, 5),
            (Command::EnterPreOperational, 0x7F),
        ] {
            dut.nmt(command)?;
            dut.is_in(state)?;
        }
    }
    Ok(())
}

/// Heartbeats of another node do not replace those of the monitored one.
pub(super) fn consumer_other_node(dut: &mut Dut<'_>) -> Checked {
    let node = watch(dut, 200)?;
    let other = if dut.node.raw() == 110 { 111 } else { 110 };
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    beat(dut, node)?;
    for _ in 0..20 {
        beat(dut, other)?;
        if emcy_since(dut, from, 0x8130, 50_000)?.is_some() {
            return Ok(());
        }
    }
    fail(
        "EMCY 8130h within 1 s of the last heartbeat of the monitored node, while another node sends its own",
        "none came",
    )
}

/// The node monitors in Pre-operational, too.
pub(super) fn consumer_pre_operational(dut: &mut Dut<'_>) -> Checked {
    let node = watch(dut, 200)?;
    reports_silence(dut, node, 200)
}

/// One heartbeat, and EMCY 8130h after the heartbeat time.
pub(super) fn reports_silence(dut: &mut Dut<'_>, node: u8, millis: u64) -> Checked {
    beat(dut, node)?;
    let from = dut.now();
    match emcy(dut, 0x8130, (millis + 800) * 1000)? {
        Some(_) => {
            let took = dut.now().micros_since(from);
            ensure(
                took + 1000 >= millis * 1000,
                format!("EMCY 8130h after {millis} ms"),
                format!("it came after {} ms", took / 1000),
            )
        }
        None => fail(
            format!(
                "EMCY 8130h within {} ms of the last heartbeat",
                millis + 800
            ),
            "none came",
        ),
    }
}

/// A node that never sent a heartbeat is not reported as lost.
pub(super) fn consumer_waits(dut: &mut Dut<'_>) -> Checked {
    watch(dut, 100)?;
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    match emcy_since(dut, from, 0x8130, 500_000)? {
        Some(frame) => fail(
            "no EMCY 8130h before the first heartbeat",
            format!("{frame} came"),
        ),
        None => Ok(()),
    }
}

pub(super) fn consumer_twice(dut: &mut Dut<'_>) -> Checked {
    let others = consumers(dut)?.split_off(1);
    let node = watch(dut, 200)?;
    for address in others {
        dut.keep(address)?;
        let done = dut.refuses_value(address, &[200, 0, node, 0], &[AbortCode::Incompatible]);
        dut.fault(done)?;
        // An entry with the time 0 monitors no node.
        let done = dut.write(address, &[0, 0, node, 0]);
        dut.fault(done)?;
    }
    Ok(())
}

/// The entries of 1016h that can be written, at least two: the first sixteen and the last.
fn consumers(dut: &Dut<'_>) -> Checked<Vec<Address>> {
    let mut all: Vec<Address> = (1..=127)
        .filter(|sub| dut.eds.writes(0x1016, *sub))
        .map(|sub| Address::new(0x1016, sub))
        .collect();
    if all.len() < 2 {
        return lacks("1016h has one entry");
    }
    if all.len() > 17 {
        all.drain(16..all.len() - 1);
    }
    Ok(all)
}

/// Each entry of 1016h monitors a node.
pub(super) fn consumer_each(dut: &mut Dut<'_>) -> Checked {
    let all = consumers(dut)?;
    sends_emcy(dut)?;
    let node = watched(dut);
    for address in all {
        let before = dut.keep(address)?;
        dut.write(address, &[200, 0, node, 0])?;
        dut.nmt(Command::Start)?;
        beat(dut, node)?;
        if emcy(dut, 0x8130, 1_000_000)?.is_none() {
            let expected = format!("EMCY 8130h by {address} within 1 s of the last heartbeat");
            dut.fault(fail(expected, "none came"))?;
        }
        // The heartbeat ends the error.
        beat(dut, node)?;
        dut.wait(20_000)?;
        dut.write(address, &before)?;
    }
    Ok(())
}

/// An entry of 1016h with the time 0, or with a node ID above 127, monitors no node, also if it monitored one before.
pub(super) fn consumer_off(dut: &mut Dut<'_>) -> Checked {
    let node = watch(dut, 0)?;
    for (entry, shown) in [
        ([0, 0, node, 0], "the time 0"),
        ([0; 4], "the value 0"),
        ([200, 0, node | 0x80, 0], "a node ID above 127"),
    ] {
        for was_on in [false, true] {
            if was_on {
                dut.write(CONSUMER, &[200, 0, node, 0])?;
                beat(dut, node)?;
            }
            // A node may refuse a node ID above 127.
            if dut.download(CONSUMER, &entry)?.is_err() {
                dut.write(CONSUMER, &[0; 4])?;
                continue;
            }
            let from = dut.frames.len();
            dut.nmt(Command::Start)?;
            if !was_on {
                beat(dut, node)?;
            }
            if let Some(frame) = emcy_since(dut, from, 0x8130, 500_000)? {
                let done = fail(
                    format!("no EMCY 8130h with {shown} in 1016h"),
                    format!("{frame} came"),
                );
                dut.fault(done)?;
            }
        }
    }
    Ok(())
}

/// After a reset the node monitors what 1016h has then, from its next heartbeat on.
pub(super) fn consumer_reset(dut: &mut Dut<'_>) -> Checked {
    let node = watch(dut, 200)?;
    dut.nmt(Command::Start)?;
    beat(dut, node)?;
    dut.wait(50_000)?;
    dut.reset(Command::ResetCommunication)?;
    let from = dut.frames.len();
    dut.nmt(Command::Start)?;
    match emcy_since(dut, from, 0x8130, 700_000)? {
        Some(frame) => fail(
            "no EMCY 8130h after reset communication, as no heartbeat came since",
            format!("{frame} came"),
        ),
        None => Ok(()),
    }
}

/// After reset communication the heartbeat is what 1017h says then.
pub(super) fn over_reset(dut: &mut Dut<'_>) -> Checked {
    let id = dut.id(0x700);
    dut.set(PRODUCER, &[50, 0])?;
    if dut.next_of(id, 200_000)?.is_none() {
        return fail("a heartbeat every 50 ms", "none came");
    }
    dut.reset(Command::ResetCommunication)?;
    match dut.number(0x1017, 0)? {
        0 => {
            dut.drain()?;
            dut.silent(id, 300_000, "no heartbeat after the reset with 1017h = 0")
        }
        50 => lacks("1017h is 50 after the reset"),
        millis => {
            let heard = [millis, millis]
                .map(|millis| dut.next_of(id, (2 * millis + 500) * 1000))
                .into_iter()
                .collect::<Checked<Vec<_>>>()?;
            let [Some(first), Some(second)] = heard[..] else {
                return fail(
                    format!("heartbeats after the reset, as 1017h = {millis}"),
                    "none came",
                );
            };
            let gap = second.at.micros_since(first.at);
            ensure(
                gap + dut.rig.slack() + 10_000 >= 900 * millis,
                format!("a heartbeat every {millis} ms after the reset"),
                format!("one came after {} ms", gap / 1000),
            )
        }
    }
}
