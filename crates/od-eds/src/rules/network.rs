//! 12: nodes of a network that do not fit together: rules that `network::check` reports.

use crate::finding::{
    Finding, Rule,
    Severity::{Error, Warning},
};

table! {
    E1201 (example)
    E1202 (example)
    W1203 (example)
    E1204 (example)
    W1205 (example)
    W1206 (example)
}

pub(crate) static E1201: Rule = Rule {
    code: "E1201",
    severity: Error,
    title: "two nodes have one node ID",
    why: "Both nodes answer each SDO request, and send with the same CAN-IDs: the bus reports bit errors, and the master cannot tell them apart.",
    source: "CiA 301, node ID",
    example: "two nodes with node_id: 5",
    says: "{first} and {second} have node ID {id}",
    help: "give each node a node ID of its own, from 1 to 127",
    ..Rule::NEW
};

/// The finding about two nodes.
pub(crate) fn e1201_same_node_id(first: &str, second: &str, id: u8) -> Finding {
    let finding = E1201.finding().fact("first", first);
    finding.fact("second", second).fact("id", i128::from(id))
}

pub(crate) static E1202: Rule = Rule {
    code: "E1202",
    severity: Error,
    title: "two nodes send one CAN-ID",
    why: "Two frames with one CAN-ID that begin at the same time have a bit error, which no arbitration resolves; and no receiver can tell which node sent a frame.",
    source: "CiA 301, pre-defined connection set; ISO 11898-1",
    example: "TPDO 1 of two nodes has cob_id: 0x181",
    says: "{first} and {second} have CAN-ID {id:03X}h",
    help: "give one of them another COB-ID, or make it not valid",
    ..Rule::NEW
};

/// The finding about two senders.
pub(crate) fn e1202_same_can_id(first: &str, second: &str, id: u32) -> Finding {
    let finding = E1202.finding().fact("first", first);
    finding.fact("second", second).fact("id", i128::from(id))
}

pub(crate) static W1203: Rule = Rule {
    code: "W1203",
    severity: Warning,
    title: "consumer without a producer",
    why: "A node waits for a message that no node of the network sends: an RPDO keeps its values, a heartbeat consumer reports an error.",
    source: "CiA 301, PDO, SYNC, TIME and heartbeat",
    example: "1016h:01 = 0x000503E8, without node 5",
    says: "{consumer} waits for {what}, which no node sends",
    help: "add the producer, or make the consumer not valid",
    ..Rule::NEW
};

/// The finding about a consumer.
pub(crate) fn w1203_no_producer(consumer: &str, what: &str) -> Finding {
    let finding = W1203.finding().fact("consumer", consumer);
    finding.fact("what", what)
}

pub(crate) static E1204: Rule = Rule {
    code: "E1204",
    severity: Error,
    title: "heartbeat consumer time is too short",
    why: "The consumer time is not longer than the time between two heartbeats, so the consumer reports an error although the producer works.",
    source: "CiA 301, consumer heartbeat time (1016h)",
    example: "1016h:01 = 0x00050064 for a node 5 with 1017h = 100",
    says: "{consumer} waits {time} ms for the heartbeat of {producer}, which comes every {period} ms",
    help: "write at least 1.5 times the producer heartbeat time to 1016h",
    ..Rule::NEW
};

/// The finding about a consumer and its producer.
pub(crate) fn e1204_consumer_time_too_short(
    consumer: &str,
    time: u32,
    producer: &str,
    period: u32,
) -> Finding {
    let finding = E1204.finding().fact("consumer", consumer);
    let finding = finding
        .fact("time", i128::from(time))
        .fact("producer", producer);
    finding.fact("period", i128::from(period))
}

pub(crate) static W1205: Rule = Rule {
    code: "W1205",
    severity: Warning,
    title: "bus load is too high",
    why: "The periodic frames, with all stuff bits, take more than 80 % of the time: frames of low priority come late, and from 100 % on some never come.",
    source: "ISO 11898-1, frame format",
    example: "50 TPDOs of 8 bytes every 10 ms at 250 kbit/s",
    says: "periodic frames take up to {percent} % of {rate} kbit/s",
    help: "send them less often, or use a higher bit rate",
    ..Rule::NEW
};

/// The finding about the bus load in percent.
pub(crate) fn w1205_bus_load(load: f64, rate: u32) -> Finding {
    let finding = W1205.finding().fact("percent", load as i128);
    finding.fact("rate", i128::from(rate))
}

pub(crate) static W1206: Rule = Rule {
    code: "W1206",
    severity: Warning,
    title: "PDO is shorter than its consumer maps",
    why: "A node does not process a PDO that is shorter than its mapping, and sends EMCY 8210h.",
    source: "CiA 301, PDO length and EMCY error code 8210h",
    example: "TPDO 1 with 2 bytes, received by an RPDO with 4",
    says: "{consumer} maps {mapped:byte|bytes}, but {producer} sends {sent:byte|bytes}",
    help: "map as many bytes as the producer sends, or map more objects in the producer",
    ..Rule::NEW
};

/// The finding about a PDO and its consumer.
pub(crate) fn w1206_pdo_too_short(
    consumer: &str,
    mapped: u32,
    producer: &str,
    sent: u32,
) -> Finding {
    let finding = W1206
        .finding()
        .fact("consumer", consumer)
        .fact("producer", producer);
    let finding = finding.fact("mapped", i128::from(mapped));
    finding.fact("sent", i128::from(sent))
}
