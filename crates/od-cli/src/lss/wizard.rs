//! The wizard sets up new devices one after the other.

use std::collections::BTreeSet;
use std::io::{self, IsTerminal};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::time::Duration;

use od_client::lss::Identity;
use od_runtime::NodeId;
use od_tools::Error;
use od_tools::lss::Lss;
use od_tools::scan::{self, ScanTimes};
use serde_json::json;

use crate::bus::{self, Format};
use crate::failure::Failure;
use crate::output::{self, Bar, note};
use crate::report::plural;
use crate::source;

/// Answer of the user to a proposal.
enum Reply {
    Take(NodeId),
    Skip,
    Quit,
}

pub(super) fn run(args: &bus::Args, first: NodeId, yes: bool, store: bool) -> Result<(), Failure> {
    let names = args.names()?;
    let mut bus = args.open()?;
    let mut bar = Bar::new("looking for node IDs in use");
    let there = scan::scan(&mut bus, ScanTimes::default(), |percent| bar.show(percent))?;
    bar.clear();
    let mut used: BTreeSet<NodeId> = there.nodes.iter().map(|one| one.node).collect();
    if !used.is_empty() {
        let ids: Vec<String> = used.iter().map(|node| node.raw().to_string()).collect();
        tell(&format!("node IDs in use: {}", ids.join(", ")));
    }
    tell("looking for LSS slaves without a node ID; each takes some seconds");
    let mut slaves = Lss::new(&mut bus).scan(|one| tell(&names.slave_title(one)))?;
    slaves.sort_by_key(|one| one.serial);
    if slaves.is_empty() {
        return Err(Failure::Failed(
            "no LSS slave without a node ID is on the bus; check power and bit rate".into(),
        ));
    }
    let answers = answers();
    let mut set_up = Vec::new();
    for (at, slave) in (1..).zip(&slaves) {
        tell("");
        tell(&format!(
            "{at} of {}: look at the device with serial number {}",
            slaves.len(),
            slave.serial
        ));
        let Some(proposed) = free(first, &used) else {
            return Err(Failure::Failed("all node IDs are in use".into()));
        };
        let reply = if yes {
            Reply::Take(proposed)
        } else {
            ask(&answers, proposed, &used)?
        };
        let node = match reply {
            Reply::Take(node) => node,
            Reply::Skip => continue,
            Reply::Quit => break,
        };
        let has_booted = Lss::new(&mut bus).set_node_id(*slave, node, store)?;
        used.insert(node);
        set_up.push((*slave, node, has_booted));
        let node = node.raw();
        tell(&if has_booted {
            format!("node {node} boots")
        } else {
            format!("node {node}: no boot-up message came; switch its power off and on")
        });
    }
    report(args.format, &set_up)
}

/// The lowest free node ID from `first`.
fn free(first: NodeId, used: &BTreeSet<NodeId>) -> Option<NodeId> {
    let ids = (first.raw()..=127).chain(1..first.raw());
    ids.filter_map(NodeId::new)
        .find(|node| !used.contains(node))
}

/// The lines of standard input, read by a thread: Ctrl-C does not interrupt a read.
fn answers() -> Receiver<String> {
    let (send, answers) = channel();
    std::thread::spawn(move || {
        let lines = io::stdin().lines().map_while(Result::ok);
        // The wizard may end before all lines are read.
        let _ = lines.map(|line| send.send(line)).all(|sent| sent.is_ok());
    });
    answers
}

/// The next line; `None` at the end of the input.
fn answer(answers: &Receiver<String>) -> Result<Option<String>, Failure> {
    let stop = bus::stop()?;
    loop {
        match answers.recv_timeout(Duration::from_millis(50)) {
            Ok(line) => return Ok(Some(line)),
            Err(RecvTimeoutError::Disconnected) => return Ok(None),
            Err(RecvTimeoutError::Timeout) if stop.load(Ordering::Relaxed) => {
                output::note_text("\n");
                return Err(Failure::from(Error::Interrupted));
            }
            Err(RecvTimeoutError::Timeout) => {}
        }
    }
}

fn ask(
    answers: &Receiver<String>,
    proposed: NodeId,
    used: &BTreeSet<NodeId>,
) -> Result<Reply, Failure> {
    loop {
        let question = format!("node ID [{}], `s` to skip, `q` to stop: ", proposed.raw());
        output::note_text(&question);
        let line = answer(answers)?;
        if !io::stdin().is_terminal() {
            output::note_text("\n");
        }
        let Some(line) = line else {
            return Ok(Reply::Quit);
        };
        match line.trim() {
            "" => return Ok(Reply::Take(proposed)),
            "s" => return Ok(Reply::Skip),
            "q" => return Ok(Reply::Quit),
            text => match source::node_id(text) {
                Ok(node) if used.contains(&node) => {
                    tell(&format!("node ID {} is in use", node.raw()));
                }
                Ok(node) => return Ok(Reply::Take(node)),
                Err(why) => tell(&why.to_string()),
            },
        }
    }
}

fn report(format: Format, set_up: &[(Identity, NodeId, bool)]) -> Result<(), Failure> {
    if format == Format::Json {
        let nodes = set_up.iter().map(|(slave, node, has_booted)| {
            json!({
                "node": node.raw(),
                "serial_number": slave.serial,
                "booted": has_booted,
            })
        });
        let report = json!({ "nodes": nodes.collect::<Vec<_>>() });
        return output::print(&format!("{report:#}"));
    }
    let lines = set_up
        .iter()
        .map(|(slave, node, _)| format!("node {:<3}  serial number {}", node.raw(), slave.serial));
    let mut lines: Vec<String> = lines.collect();
    lines.push(format!("{} set up", plural(set_up.len(), "device")));
    output::print(&lines.join("\n"))
}

/// A line of the wizard.
fn tell(text: &str) {
    note!("{text}");
}
