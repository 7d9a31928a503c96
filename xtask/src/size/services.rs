//! Cost of each service: a small node with it, and without all of them.

use std::fmt::Write as _;

use super::measure::{SMALL, build, play};
use super::text::{grouped, has_grown, row};
use crate::error::Result;
use crate::repo::Repo;

/// The lines of docs/PERFORMANCE.md around the table.
pub(super) const MARKS: (&str, &str) = ("<!-- services -->\n", "<!-- /services -->");
/// The program in `firmware/src/bin`.
const PROGRAM: &str = "service";
/// A measured variant: its name in the table, the feature of the program, and a description.
const SERVICES: [(&str, &str, &str); 16] = [
    (BASE, "service", "a node of 19 values without all of these"),
    ("segmented", "segmented", "segmented SDO transfers"),
    ("block", "block", "SDO block transfers"),
    ("servers", "servers", "a second SDO server"),
    ("rpdos", "rpdos", "RPDOs, and one of them"),
    (
        "deadlines",
        "deadlines",
        "RPDOs, and one of them with a deadline",
    ),
    (
        "changes",
        "changes",
        "TPDOs that are sent when a value changes",
    ),
    ("guarding", "guarding", "node guarding and life guarding"),
    ("consumer", "consumer", "heartbeat consumer of one node"),
    (
        "sync-length",
        "sync-length",
        "the length of SYNC is watched",
    ),
    ("sync-producer", "sync-producer", "SYNC producer"),
    ("time", "time", "TIME consumer and producer"),
    ("behaviour", "behaviour", "error behaviour"),
    ("events", "events", "events for the host"),
    ("storage", "storage", "saving and restoring"),
    (
        "lss",
        "lss",
        "LSS slave, which saves its node ID and bit rate",
    ),
];
/// The node to which a service is added.
const BASE: &str = "none";

/// Flash, static RAM and stack of the node with each service.
type Costs = Vec<(&'static str, [i64; 3])>;

/// Builds and runs the node with each service.
pub(super) fn measure(repo: &Repo) -> Result<Costs> {
    let one = |(name, feature, _): (&'static str, &str, &str)| {
        let folder = build(repo, &[PROGRAM], SMALL, &[feature])?;
        let cost = play(&folder.join(PROGRAM))?;
        Ok((
            name,
            [cost.flash, cost.ram, cost.stack].map(|bytes| bytes as i64),
        ))
    };
    SERVICES.into_iter().map(one).collect()
}

/// The node without services, and the cost of each service.
pub(super) fn table(costs: &Costs) -> String {
    let mut text = String::from("| | flash | static RAM | stack |\n|---|--:|--:|--:|\n");
    let base = costs.first().map_or([0; 3], |(_, bytes)| *bytes);
    for ((name, bytes), (.., about)) in costs.iter().zip(SERVICES) {
        let _ = write!(text, "| `{name}`: {about} |");
        for (number, base) in bytes.iter().zip(base) {
            let (sign, shown) = match number - base {
                _ if *name == BASE => ("", *number),
                more @ ..0 => ("-", -more),
                more => ("+", more),
            };
            let _ = write!(text, " {sign}{} |", grouped(shown.unsigned_abs()));
        }
        text.push('\n');
    }
    text
}

/// The rows in which the node with a service has grown by more than 5 %, and the rows that are not listed.
pub(super) fn grown(listed: &str, costs: &Costs) -> Vec<String> {
    let rows: Vec<_> = listed.lines().filter_map(row).collect();
    let base = rows.first().map_or(&[][..], |(_, numbers)| numbers);
    let before = |wanted: &str| -> Vec<i64> {
        let found = rows.iter().find(|(name, _)| *name == wanted);
        let numbers = found.map_or(&[][..], |(_, numbers)| numbers);
        let all = numbers.iter().zip(base);
        all.map(|(more, base)| more + if wanted == BASE { 0 } else { *base })
            .collect()
    };
    let is_grown = |(name, bytes): &&(&str, [i64; 3])| has_grown(&before(name), bytes);
    let told = |(name, [flash, ram, stack]): &(&str, [i64; 3])| {
        format!("{name}: {flash} bytes of flash, {ram} of RAM, {stack} of stack")
    };
    costs.iter().filter(is_grown).map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_service_that_has_grown_is_reported() {
        let costs = |block| vec![(BASE, [19_000, 540, 488]), ("segmented", [block, 530, 500])];
        let listed = table(&costs(20_000));
        assert!(listed.contains("| 19,000 | 540 | 488 |"), "{listed}");
        assert!(listed.contains("| +1,000 | -10 | +12 |"), "{listed}");
        assert!(grown(&listed, &costs(21_000)).is_empty());
        assert_eq!(grown(&listed, &costs(21_001)).len(), 1);
        assert_eq!(grown("", &costs(20_000)).len(), 2);
    }
}
