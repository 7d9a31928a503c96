//! Nodes that contradict each other: rules that `network::check` reports.

use alloc::string::String;

use crate::finding::{Finding, Form, Rule};
use crate::network::node::{Node, Setting};
use crate::span::Span;

pub(crate) static E1201: Rule = Rule {
    title: "two nodes have one node ID",
    why: "Both nodes answer each SDO request, and send with the same CAN-IDs: the bus reports bit errors, and the master cannot tell them apart.",
    source: "CiA 301, node ID",
    example: "two nodes with node_id: 5",
    says: "{first} and {second} have node ID {id}",
    help: "give each node a node ID of its own, from 1 to 127",
    ..Rule::of("E1201")
};

pub(crate) fn e1201_same_node_id(first: &Node, second: &Node) -> Finding {
    let place = |node: &Node| node.place_of(Setting::Key("node_id"));
    let finding = E1201.at(place(second)).related(place(first), FIRST);
    let finding = finding.fact("first", first.name.as_str());
    let finding = finding.fact("second", second.name.as_str());
    finding.fact("id", second.id)
}

/// Label of the first of two nodes or services.
const FIRST: &str = "{first}";

pub(crate) static E1202: Rule = Rule {
    title: "two nodes send one CAN-ID",
    why: "Two frames with one CAN-ID that begin at the same time have a bit error, which no arbitration resolves; and no receiver can tell which node sent a frame.",
    source: "CiA 301, pre-defined connection set; ISO 11898-1",
    example: "TPDO 1 of two nodes has cob_id: 0x181",
    says: "{first} and {second} have CAN-ID {id:03X}h",
    help: "give one of them another COB-ID, or make it not valid",
    ..Rule::of("E1202")
};

pub(crate) fn e1202_same_can_id(first: &Named, second: &Named, id: u32) -> Finding {
    let finding = E1202.at(second.1).related(first.1, FIRST);
    let finding = finding.fact("first", first.0.as_str());
    let finding = finding.fact("second", second.0.as_str());
    finding.fact("id", i128::from(id))
}

/// A service of a node in words, and its place in the project or the node list.
type Named = (String, Span);

pub(crate) static W1203: Rule = Rule {
    title: "consumer without a producer",
    why: "A node waits for a message that no node of the network sends: an RPDO keeps its values, a heartbeat consumer reports an error.",
    source: "CiA 301, PDO, SYNC, TIME and heartbeat",
    example: "1016h:01 = 0x000503E8, without node 5",
    says: "{consumer} waits for {what}, which no node sends",
    help: "add the producer, or make the consumer not valid",
    also: &[SYNC, SYNC_OF_MASTER],
    ..Rule::of("W1203")
};

/// Sentence for a synchronous PDO in a node list.
const SYNC: Form = Form {
    says: "{consumer} is synchronous, but no node sends SYNC (CAN-ID {id:03X}h)",
    help: "set bit 30 of 1005h and a period in 1006h in one node, or write another transmission type",
};

/// Sentence for a synchronous PDO in a project.
const SYNC_OF_MASTER: Form = Form {
    help: "write `sync_period: 10000` (microseconds) in `master`, or another transmission type",
    ..SYNC
};

pub(crate) fn w1203_no_producer(consumer: &Named, what: &str) -> Finding {
    let finding = W1203.at(consumer.1).fact("consumer", consumer.0.as_str());
    finding.fact("what", what)
}

/// The finding about a synchronous PDO without SYNC; `master` is the place where a project sets the period, or that of
/// its master.
pub(crate) fn w1203_no_sync(consumer: &Named, id: u32, master: Option<Span>) -> Finding {
    let finding = W1203.at(consumer.1).form(match master {
        Some(_) => &SYNC_OF_MASTER,
        None => &SYNC,
    });
    let finding = finding.fact("consumer", consumer.0.as_str()).fact("id", id);
    finding.related(master.unwrap_or_default(), "the master sends no SYNC")
}

pub(crate) static E1204: Rule = Rule {
    title: "heartbeat consumer time is too short",
    why: "The consumer time is not longer than the time between two heartbeats, so the consumer reports an error although the producer works.",
    source: "CiA 301, consumer heartbeat time (1016h)",
    example: "1016h:01 = 0x00050064 for a node 5 with 1017h = 100",
    says: "{consumer} waits {time} ms for the heartbeat of {producer}, which comes every {period} ms",
    help: "write at least 1.5 times the producer heartbeat time to 1016h",
    ..Rule::of("E1204")
};

pub(crate) fn e1204_consumer_time_too_short(
    consumer: &Node,
    time: u32,
    producer: &Node,
    period: u32,
) -> Finding {
    let place = consumer.place_of(Setting::Key("heartbeat_consumer"));
    let produced = producer.place_of(Setting::Key("heartbeat_producer"));
    let finding = E1204.at(place).related(produced, "the producer");
    let finding = finding.fact("consumer", consumer.name.as_str());
    let finding = finding.fact("time", i128::from(time));
    let finding = finding.fact("producer", producer.name.as_str());
    finding.fact("period", i128::from(period))
}

pub(crate) static W1205: Rule = Rule {
    title: "bus load is too high",
    why: "The periodic frames, with all stuff bits, take more than 80 % of the time: frames of low priority come late, and from 100 % on some never come.",
    source: "ISO 11898-1, frame format",
    example: "50 TPDOs of 8 bytes every 10 ms at 250 kbit/s",
    says: "periodic frames take up to {percent} % of {rate} kbit/s",
    help: "send them less often, or use a higher bit rate",
    ..Rule::of("W1205")
};

/// The finding about the bus load in percent.
pub(crate) fn w1205_bus_load(load: f64, rate: u32) -> Finding {
    let finding = W1205.finding().fact("percent", load as i128);
    finding.fact("rate", i128::from(rate))
}

pub(crate) static W1206: Rule = Rule {
    title: "PDO is shorter than its consumer maps",
    why: "A node does not process a PDO that is shorter than its mapping, and sends EMCY 8210h.",
    source: "CiA 301, PDO length and EMCY error code 8210h",
    example: "TPDO 1 with 2 bytes, received by an RPDO with 4",
    says: "{consumer} maps {mapped:byte|bytes}, but {producer} sends {sent:byte|bytes}",
    help: "map as many bytes as the producer sends, or map more objects in the producer",
    ..Rule::of("W1206")
};

pub(crate) fn w1206_pdo_too_short(
    consumer: &Named,
    mapped: u32,
    producer: &Named,
    sent: u32,
) -> Finding {
    let finding = W1206.at(consumer.1).related(producer.1, "the producer");
    let finding = finding.fact("consumer", consumer.0.as_str());
    let finding = finding.fact("producer", producer.0.as_str());
    let finding = finding.fact("mapped", i128::from(mapped));
    finding.fact("sent", i128::from(sent))
}

pub(crate) static E1210: Rule = Rule {
    title: "CAN-ID of a network is reserved for another service",
    why: "A message with a CAN-ID of NMT, SDO, error control or LSS disturbs that service in all nodes.",
    source: "CiA 301, restricted CAN-IDs",
    example: "cob_id: 0x5F0",
    says: "{service} has CAN-ID {id:03X}h, which CiA 301 reserves for {owner}",
    help: "write a CAN-ID that CiA 301 leaves free, such as 0x181 to 0x57F for PDOs",
    ..Rule::of("E1210")
};

/// The finding about a service with this CAN-ID; `None` if no other service has it.
pub(crate) fn e1210_can_id_reserved(service: &Named, id: u32) -> Option<Finding> {
    let (_, owner) = od_model::restricted(id)?;
    let finding = E1210.at(service.1).fact("service", service.0.as_str());
    let finding = finding.fact("id", i128::from(id));
    Some(finding.fact("owner", owner.name()))
}
