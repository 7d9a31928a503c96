//! NMT: boot-up, states and commands.

use od_model::{Address, values};
use od_wire::nmt::{Command, Repr};
use od_wire::{CanId, CobId, Frame};

use super::servers::Channel;
use super::transfer::{another_value, kinds};
use super::{block, heartbeat, segments, transmit};
use crate::conform::dut::{Dut, QUIET, is_data, state_name};
use crate::conform::end::{Checked, End, ensure, fail, lacks, optional};
use crate::conform::record::Traced;
use crate::conform::sdo::request;

const OPERATIONAL: u8 = 5;
const STOPPED: u8 = 4;
const PRE_OPERATIONAL: u8 = 0x7F;

const TYPE: Address = Address::new(0x1000, 0);

pub(super) fn boot_up(dut: &mut Dut<'_>) -> Checked {
    for state in [Command::EnterPreOperational, Command::Start, Command::Stop] {
        dut.nmt(state)?;
        boots_once(dut, Command::ResetNode)?;
    }
    Ok(())
}

/// A reset, and one boot-up message.
fn boots_once(dut: &mut Dut<'_>, reset: Command) -> Checked {
    dut.drain()?;
    let id = dut.id(0x700);
    let node = dut.node.raw();
    let from = dut.now();
    dut.send(Frame::standard(0, &[reset as u8, node]))?;
    let Some(heard) = dut.next_of(id, 10_000_000)? else {
        return fail(
            format!("the boot-up message {id:03X}#00 within 10 s"),
            "none came",
        );
    };
    let got = format!("{} came", heard.frame);
    ensure(
        heard.frame.data() == [0],
        format!("the boot-up message {id:03X}#00"),
        got,
    )?;
    dut.times.boots.push(heard.at.micros_since(from));
    let more = dut.all_of(id, QUIET)?;
    let again = more.iter().find(|heard| heard.frame.data() == [0]);
    if let Some(heard) = again {
        return fail("one boot-up message", format!("{} came again", heard.frame));
    }
    let Some(heard) = more.first() else {
        return Ok(());
    };
    let period = Address::new(0x1017, 0);
    let has_none = !dut.eds.has(0x1017) || dut.upload(period)? == Ok(vec![0, 0]);
    ensure(
        !has_none,
        "no heartbeat after the boot-up message, as 1017h is 0",
        format!("{} came", heard.frame),
    )
}

pub(super) fn boot_up_after_communication(dut: &mut Dut<'_>) -> Checked {
    for state in [Command::EnterPreOperational, Command::Start, Command::Stop] {
        dut.nmt(state)?;
        boots_once(dut, Command::ResetCommunication)?;
    }
    Ok(())
}

/// No service before the boot-up message.
pub(super) fn first_frame(dut: &mut Dut<'_>, command: Command) -> Checked {
    dut.drain()?;
    let node = dut.node.raw();
    dut.send(Frame::standard(0, &Repr { command, node }.emit()))?;
    boots_first(dut)
}

/// The first frame of the node is its boot-up message.
fn boots_first(dut: &mut Dut<'_>) -> Checked {
    let ids = [0x80, 0x180, 0x280, 0x380, 0x480, 0x580, 0x700].map(|base| dut.id(base));
    let ours = |frame: &Frame| frame.id().as_standard().is_some_and(|id| ids.contains(&id));
    let boot = dut.id(0x700);
    match dut.next(10_000_000, ours)? {
        Some(heard) if heard.frame.id().as_standard() == Some(boot) => ensure(
            heard.frame.data() == [0],
            "the boot-up message as the first frame",
            format!("{} came", heard.frame),
        ),
        // CiA 301 lets a device report an error of its start first.
        Some(heard) if heard.frame.id().as_standard() == Some(dut.id(0x80)) => Ok(()),
        Some(heard) => fail(
            "the boot-up message as the first frame",
            format!("{} came", heard.frame),
        ),
        None => fail("the boot-up message within 10 s", "none came"),
    }
}

/// From boot-up to the first start the node sends heartbeats, SYNC if it produces it, and responses.
pub(super) fn silent_before_start(dut: &mut Dut<'_>) -> Checked {
    transmit::learn_sync(dut)?;
    silent_after(dut, Command::ResetNode)?;
    silent_after(dut, Command::ResetCommunication)
}

/// Fails if the node sends a PDO, or an EMCY message without an error, between this reset and the next start.
fn silent_after(dut: &mut Dut<'_>, reset: Command) -> Checked {
    let mut ids = vec![
        CanId::standard(dut.id(0x80)),
        CanId::standard(dut.id(0x580)),
    ];
    let mut with_rtr = Vec::new();
    for pdo in dut.eds.pdos(0x1800) {
        let cob_id = CobId::new(dut.number(0x1800 + pdo, 1)? as u32);
        if transmit::is_on(cob_id.raw()) {
            ids.push(cob_id.can_id());
            with_rtr.extend(cob_id.allows_rtr().then_some(cob_id.can_id()));
        }
    }
    dut.drain()?;
    let (boot, node) = (dut.id(0x700), dut.node.raw());
    dut.send(Frame::standard(0, &[reset as u8, node]))?;
    if dut
        .next(10_000_000, |frame| {
            is_data(frame, boot) && frame.data() == [0]
        })?
        .is_none()
    {
        return fail("the boot-up message within 10 s", "none came");
    }
    // EMCY 0000h means that there is no error.
    let is_own = |frame: &Frame| {
        ids.contains(&frame.id())
            && !frame.is_remote()
            && !(frame.id() == ids[0] && frame.data().starts_with(&[0, 0]))
    };
    let mut heard = dut.next(200_000, is_own)?;
    if heard.is_none() {
        transmit::sync(dut)?;
        heard = dut.next(QUIET, is_own)?;
    }
    for id in with_rtr {
        if heard.is_none() {
            dut.ask_for(id, 8)?;
            heard = dut.next(50_000, is_own)?;
        }
    }
    let Some(heard) = heard else {
        return Ok(());
    };
    if heard.frame.id() == ids[0] && dut.number(0x1001, 0)? != 0 {
        dut.notes.push(format!(
            "{}: an error is present after the reset",
            heard.frame
        ));
        return Ok(());
    }
    fail(
        "no PDO, EMCY or SDO response between boot-up and start",
        format!("{} came", heard.frame),
    )
}

pub(super) fn power_on(dut: &mut Dut<'_>) -> Checked {
    dut.drain()?;
    dut.power(false)?;
    dut.wait(500_000)?;
    dut.drain()?;
    dut.power(true)?;
    boots_first(dut)?;
    if let Some(heard) = boot_up_in(dut, QUIET)? {
        return fail("one boot-up message", format!("{heard} came again"));
    }
    match dut.follow_state() {
        Err(End::NotApplicable(_)) => Ok(()),
        seen => seen.and_then(|()| dut.is_in(PRE_OPERATIONAL)),
    }
}

/// A boot-up message within this time.
fn boot_up_in(dut: &mut Dut<'_>, micros: u64) -> Checked<Option<Frame>> {
    let all = dut.all_of(dut.id(0x700), micros)?;
    let mut frames = all.into_iter().map(|heard| heard.frame);
    Ok(frames.find(|frame| frame.data() == [0]))
}

pub(super) fn pre_operational_after_reset(dut: &mut Dut<'_>) -> Checked {
    for reset in [Command::ResetNode, Command::ResetCommunication] {
        // The first command after the reset has its effect, too.
        for (command, state) in [(Command::Stop, STOPPED), (Command::Start, OPERATIONAL)] {
            dut.reset(reset)?;
            dut.follow_state()?;
            dut.is_in(PRE_OPERATIONAL)?;
            dut.nmt(command)?;
            dut.is_in(state)?;
        }
    }
    Ok(())
}

/// After a boot-up message the node serves before the first NMT command, as after one.
pub(super) fn first_services(dut: &mut Dut<'_>) -> Checked {
    let by_block = block::serves(dut)?;
    let by_segments = optional(segments::long_value(dut))?;
    let is_guarded = dut.guarded()?.is_some();
    for reset in [Command::ResetNode, Command::ResetCommunication] {
        dut.reset(reset)?;
        if let Some((address, bytes)) = &by_segments {
            dut.is_as_written(*address, bytes)?;
        }
        ensure(
            !by_block || block::serves(dut)?,
            "a block upload before the first NMT command",
            "the node refuses block transfers",
        )?;
        for index in 0x1201..=0x1208 {
            if let Some(channel) = Channel::of(dut, index)? {
                channel.serves(dut, request(0x40, TYPE, [0; 4]))?;
            }
        }
        ensure(
            !is_guarded || dut.guarded()?.is_some(),
            "a response to node guarding before the first NMT command",
            "none came",
        )?;
        optional(heartbeat::consumer_pre_operational(dut))?;
        if optional(dut.follow_state())?.is_some() {
            for _ in 0..3 {
                dut.is_in(PRE_OPERATIONAL)?;
            }
        }
    }
    Ok(())
}

pub(super) fn start(dut: &mut Dut<'_>) -> Checked {
    change(dut, &[(Command::Start, OPERATIONAL)])
}

pub(super) fn stop(dut: &mut Dut<'_>) -> Checked {
    change(dut, &[(Command::Stop, STOPPED)])
}

pub(super) fn enter_pre_operational(dut: &mut Dut<'_>) -> Checked {
    change(
        dut,
        &[
            (Command::Start, OPERATIONAL),
            (Command::EnterPreOperational, PRE_OPERATIONAL),
        ],
    )
}

pub(super) fn transitions(dut: &mut Dut<'_>) -> Checked {
    use Command::{EnterPreOperational, Start, Stop};
    change(
        dut,
        &[
            (Start, OPERATIONAL),
            (Start, OPERATIONAL),
            (Stop, STOPPED),
            (Stop, STOPPED),
            (Start, OPERATIONAL),
            (Stop, STOPPED),
            (EnterPreOperational, PRE_OPERATIONAL),
            (EnterPreOperational, PRE_OPERATIONAL),
            (Stop, STOPPED),
            (EnterPreOperational, PRE_OPERATIONAL),
        ],
    )
}

fn change(dut: &mut Dut<'_>, steps: &[(Command, u8)]) -> Checked {
    dut.follow_state()?;
    dut.is_in(PRE_OPERATIONAL)?;
    let from = dut.frames.len();
    let emcy = dut.id(0x80);
    for (command, state) in steps {
        let sent = dut.frames.len();
        dut.nmt(*command)?;
        dut.is_in(*state)?;
        let mut heard = dut.frames.get(sent..).unwrap_or_default().iter();
        let heard = heard.find(|traced| !traced.ours && is_data(&traced.frame, emcy));
        if let Some(traced) = heard.filter(|_| *state == STOPPED) {
            return fail(
                "no EMCY message in Stopped",
                format!("{} came after the command stop", traced.frame),
            );
        }
    }
    let boot = dut.id(0x700);
    let sent = dut.frames.get(from..).unwrap_or_default().iter();
    let mut own = sent.filter(|traced| !traced.ours && is_data(&traced.frame, boot));
    match own.find(|traced| traced.frame.data() == [0]) {
        Some(traced) => fail(
            "a boot-up message after a reset only",
            format!("{} came after another command", traced.frame),
        ),
        None => Ok(()),
    }
}

pub(super) fn all_nodes(dut: &mut Dut<'_>) -> Checked {
    dut.follow_state()?;
    for (command, state) in [
        (1, OPERATIONAL),
        (2, STOPPED),
        (1, OPERATIONAL),
        (0x80, PRE_OPERATIONAL),
        (2, STOPPED),
        (0x80, PRE_OPERATIONAL),
    ] {
        dut.send(Frame::standard(0, &[command, 0]))?;
        dut.wait(20_000)?;
        dut.is_in(state)?;
    }
    // The other nodes on the bus are reset, too.
    let resets: &[u8] = if dut.may_reset { &[0x82, 0x81] } else { &[] };
    for reset in resets {
        for state in [0x80, 1, 2] {
            dut.send(Frame::standard(0, &[state, 0]))?;
            dut.wait(20_000)?;
            dut.drain()?;
            let from = dut.now();
            dut.send(Frame::standard(0, &[*reset, 0]))?;
            dut.booted(from)?;
        }
    }
    Ok(())
}

/// Every command to another node, in Pre-operational and in Operational.
pub(super) fn other_node(dut: &mut Dut<'_>) -> Checked {
    dut.follow_state()?;
    let other = if dut.node.raw() == 127 {
        126
    } else {
        dut.node.raw() + 1
    };
    let id = dut.id(0x700);
    // The node IDs end at 127, so a node must compare all eight bits.
    let beyond = dut.node.raw() | 0x80;
    for (state, other) in [
        (PRE_OPERATIONAL, other),
        (PRE_OPERATIONAL, beyond),
        (OPERATIONAL, other),
    ] {
        if state == OPERATIONAL {
            dut.nmt(Command::Start)?;
        }
        for command in [1, 2, 0x80, 0x81, 0x82] {
            dut.drain()?;
            dut.send(Frame::standard(0, &[command, other]))?;
            let heard = dut.all_of(id, QUIET)?;
            if let Some(boot) = heard.iter().find(|heard| heard.frame.data() == [0]) {
                return fail(
                    format!("no reset by the command {command:02X}h to node {other}"),
                    format!("{} came", boot.frame),
                );
            }
            dut.is_in(state)?;
        }
    }
    // Node IDs that differ in one bit: only the command that cannot start another node.
    for bit in 0..7 {
        let other = dut.node.raw() ^ 1 << bit;
        if other != 0 {
            dut.send(Frame::standard(0, &[0x80, other]))?;
            dut.settle(20_000)?;
            dut.is_in(OPERATIONAL)?;
        }
    }
    Ok(())
}

/// A frame of 29 bits whose number is 0 is not an NMT command.
pub(super) fn extended_frame(dut: &mut Dut<'_>) -> Checked {
    dut.follow_state()?;
    let node = dut.node.raw();
    let boot = "no reset by a frame with a CAN-ID of 29 bits";
    for command in [
        Command::Start,
        Command::Stop,
        Command::ResetNode,
        Command::ResetCommunication,
    ] {
        for node in [node, 0] {
            let data = Repr { command, node }.emit();
            if let Some(frame) = Frame::new(CanId::extended(0), &data) {
                dut.send(frame)?;
            }
            if let Some(heard) = boot_up_in(dut, QUIET)? {
                return fail(boot, format!("{heard} came"));
            }
            dut.is_in(PRE_OPERATIONAL)?;
        }
    }
    Ok(())
}

pub(super) fn unknown_command(dut: &mut Dut<'_>) -> Checked {
    dut.follow_state()?;
    let node = dut.node.raw();
    let boot = dut.id(0x700);
    for (command, state) in [
        (Command::EnterPreOperational, PRE_OPERATIONAL),
        (Command::Start, OPERATIONAL),
    ] {
        dut.nmt(command)?;
        let missing = (0..=0xFF).filter(|code| Command::from_code(*code).is_none());
        // A node in the wrong state shows it after sixteen commands, as none of them leads back.
        for some in missing.collect::<Vec<u8>>().chunks(16) {
            let sent = dut.frames.len();
            for code in some {
                dut.send(Frame::standard(0, &[*code, node]))?;
                dut.settle(2_000)?;
            }
            dut.settle(20_000)?;
            dut.is_in(state)?;
            let mut heard = dut.frames.get(sent..).unwrap_or_default().iter();
            if heard.any(|one| is_data(&one.frame, boot) && one.frame.data() == [0]) {
                return fail(
                    format!("no reset by one of the commands {some:02X?}"),
                    "a boot-up message came",
                );
            }
        }
    }
    Ok(())
}

pub(super) fn short_command(dut: &mut Dut<'_>) -> Checked {
    dut.follow_state()?;
    for (state, code) in [
        (Command::EnterPreOperational, PRE_OPERATIONAL),
        (Command::Start, OPERATIONAL),
        (Command::Stop, STOPPED),
    ] {
        dut.nmt(state)?;
        for command in [None, Some(1), Some(2), Some(0x80), Some(0x81), Some(0x82)] {
            if command == Some(state as u8) {
                continue;
            }
            let command: Vec<u8> = command.into_iter().collect();
            dut.send_to(0, &command)?;
            if let Some(heard) = boot_up_in(dut, 50_000)? {
                return fail(
                    format!("no reset by the bytes {command:02X?} without a node ID"),
                    format!("{heard} came"),
                );
            }
            dut.is_in(code)?;
        }
        dut.ask_for(CanId::standard(0), 2)?;
        dut.wait(20_000)?;
        dut.is_in(code)?;
    }
    Ok(())
}

/// A node may follow a command with more than two bytes or ignore it, and must not take it for another one.
pub(super) fn long_command(dut: &mut Dut<'_>) -> Checked {
    dut.follow_state()?;
    let node = dut.node.raw();
    let other = if node == 127 { 126 } else { node + 1 };
    for len in [3, 4, 8] {
        for (command, state) in [(1, OPERATIONAL), (2, STOPPED), (0x80, PRE_OPERATIONAL)] {
            dut.drain()?;
            let before = dut.state()?;
            let bytes = [command, node, other, 0x81, 1, 0x82, node, 2];
            dut.send_to(0, &bytes[..len])?;
            if let Some(heard) = boot_up_in(dut, 30_000)? {
                return fail(
                    format!("no reset by the bytes {}", values::hex(&bytes[..len])),
                    format!("{heard} came"),
                );
            }
            dut.drain()?;
            let is = dut.state()?;
            ensure(
                is == state || is == before,
                format!(
                    "NMT state {} or still {} after the bytes {}",
                    state_name(state),
                    state_name(before),
                    values::hex(&bytes[..len])
                ),
                format!("the node is in {}", state_name(is)),
            )?;
        }
        dut.nmt(Command::EnterPreOperational)?;
        for command in [1, 2, 0x81, 0x82] {
            let mut bytes = [node; 8];
            bytes[..2].copy_from_slice(&[command, other]);
            dut.send_to(0, &bytes[..len])?;
            if let Some(heard) = boot_up_in(dut, 50_000)? {
                return fail(
                    format!(
                        "no reset by the bytes {}, a command to node {other}",
                        values::hex(&bytes[..len])
                    ),
                    format!("{heard} came"),
                );
            }
            dut.is_in(PRE_OPERATIONAL)?;
        }
    }
    Ok(())
}

/// Each kind of SDO transfer that the node has in Pre-operational is right in Operational, too.
pub(super) fn sdo_in_operational(dut: &mut Dut<'_>) -> Checked {
    let mut all = kinds(dut)?;
    // A device may refuse to change the parameters of a PDO in this state.
    if another_value(dut)?.is_some_and(|(address, _)| address.index >= 0x1400) {
        all.retain(|(name, _)| !name.starts_with("a download"));
    }
    dut.nmt(Command::Start)?;
    for (name, act) in all {
        let done = match act(dut) {
            Err(End::NotApplicable(_)) => fail(
                format!("{name} in Operational, as in Pre-operational"),
                "the node refuses it",
            ),
            done => done,
        };
        dut.fault(done)?;
    }
    Ok(())
}

pub(super) fn no_sdo_in_stopped(dut: &mut Dut<'_>) -> Checked {
    let mut requests = vec![request(0xA0, TYPE, [127, 0, 0, 0])];
    // Segments, blocks and ends of transfers that do not exist, and a command that does not exist.
    for command in [0x00, 0x60, 0x70, 0x81, 0xA1, 0xA2, 0xA3, 0xC1, 0xE0] {
        requests.push(request(command, TYPE, [0; 4]));
    }
    let entries = dut.eds.dictionary().entries();
    let read = entries.filter(|entry| entry.address.index < 0x2000 && entry.access.readable());
    requests.extend(
        read.take(64)
            .map(|entry| request(0x40, entry.address, [0; 4])),
    );
    let before = match another_value(dut)? {
        Some((address, bytes)) => {
            requests.push(request(0x2B, address, [bytes[0], bytes[1], 0, 0]));
            Some((address, dut.keep(address)?))
        }
        None => None,
    };
    let mut channels = Vec::new();
    for index in 0x1201..=0x1208 {
        channels.extend(Channel::of(dut, index)?);
    }
    dut.nmt(Command::Stop)?;
    for channel in channels {
        let upload = request(0x40, TYPE, [0; 4]);
        if let Some(frame) = channel.ask(dut, upload, QUIET)? {
            return fail(
                "no response of another SDO server in Stopped",
                format!("{frame} came"),
            );
        }
    }
    let from = dut.frames.len();
    for request in requests {
        dut.send_to(dut.id(0x600), &request)?;
        dut.settle(3_000)?;
    }
    dut.wait(QUIET)?;
    let id = dut.id(0x580);
    let frames = dut.frames.get(from..).unwrap_or_default();
    let response = |traced: &Traced| !traced.ours && is_data(&traced.frame, id);
    if let Some(at) = frames.iter().position(response) {
        let asked = frames[..at].iter().rev().find(|traced| traced.ours);
        let asked = asked.map_or(String::new(), |traced| format!(" to {}", traced.frame));
        return fail(
            format!("no SDO response in Stopped{asked}"),
            format!("{} came", frames[at].frame),
        );
    }
    dut.nmt(Command::EnterPreOperational)?;
    dut.still_serves()?;
    let Some((address, before)) = before else {
        return Ok(());
    };
    let after = dut.read(address)?;
    ensure(
        after == before,
        format!(
            "{address} unchanged by a download in Stopped, {}",
            values::hex(&before)
        ),
        format!("{} was read", values::hex(&after)),
    )
}

/// Values that were not saved are lost after the reset.
pub(super) fn forgets(dut: &mut Dut<'_>, command: Command) -> Checked {
    let Some((address, bytes)) = another_value(dut)? else {
        return lacks("no parameter of communication can be written");
    };
    let before = dut.read(address)?;
    dut.set(address, &bytes)?;
    dut.reset(command)?;
    let after = dut.read(address)?;
    ensure(
        after == before,
        format!(
            "{} in {address}, as before the change",
            values::hex(&before)
        ),
        format!("{} was read", values::hex(&after)),
    )
}

/// A parameter of the application that was changed, its new value, and the one before.
fn changed_application(dut: &mut Dut<'_>) -> Checked<(Address, Vec<u8>, Vec<u8>)> {
    for entry in dut.eds.writable() {
        if !(0x2000..0xA000).contains(&entry.address.index) {
            continue;
        }
        let Some((bytes, before)) = another_of(dut, &entry)? else {
            continue;
        };
        dut.undo.push((entry.address, before.clone()));
        if dut.download(entry.address, &bytes)?.is_ok() {
            return Ok((entry.address, bytes, before));
        }
    }
    lacks("no parameter of the application can be changed")
}

/// A parameter of the application is restored by reset node, to this node and to all.
pub(super) fn reset_application(dut: &mut Dut<'_>) -> Checked {
    let (address, bytes, before) = changed_application(dut)?;
    for (node, to) in [(dut.node.raw(), "of this node"), (0, "of all nodes")] {
        dut.write(address, &bytes)?;
        dut.drain()?;
        let from = dut.now();
        let command = Command::ResetNode;
        dut.send(Frame::standard(0, &Repr { command, node }.emit()))?;
        dut.booted(from)?;
        let after = dut.read(address)?;
        ensure(
            after == before,
            format!(
                "{} in {address} after reset node {to}, as before the change",
                values::hex(&before)
            ),
            format!("{} was read", values::hex(&after)),
        )?;
    }
    Ok(())
}

/// The value of a number with two limits, and another one between them.
pub(super) fn another_of(
    dut: &mut Dut<'_>,
    entry: &od_model::Entry,
) -> Checked<Option<(Vec<u8>, Vec<u8>)>> {
    let node = dut.node.raw();
    let (Some(low), Some(high)) = (entry.low.integer(node), entry.high.integer(node)) else {
        return Ok(None);
    };
    let before = dut.read(entry.address)?;
    let Some(size) = entry.data_type.size().filter(|_| low < high) else {
        return Ok(None);
    };
    let bytes = |value: i128| value.to_le_bytes()[..size].to_vec();
    let other = if before == bytes(low) {
        bytes(high)
    } else {
        bytes(low)
    };
    Ok(Some((other, before)))
}
