//! No false failure on a simulated node, whatever its EDS lacks or has wrong. The traits are those
//! of files in use, each in a file of our own. Only the case about the file finds the errors.

use od_sim::{EdsOptions, VirtualDevice};
use od_tools::bench::OnBench;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::Verdict;
use od_tools::conform::session::{Permissions, Session};

use crate::simulated::alone;

const PLAIN: &str = include_str!("plain.eds");

/// A section, a key and its value; without a value the key is missing.
type Change = (&'static str, &'static str, &'static str);

/// The trait, the changes of `plain.eds`, and the cases that fail.
const TRAITS: &[(&str, &[Change], &[&str])] = &[
    ("nothing is unusual", &[], &[]),
    (
        "the identity is in [DeviceInfo] only",
        &[
            ("1018sub1", "DefaultValue", ""),
            ("1018sub2", "DefaultValue", ""),
            ("1018sub3", "DefaultValue", ""),
        ],
        &[],
    ),
    (
        "COB-IDs have no default",
        &[
            ("1005", "DefaultValue", ""),
            ("1014", "DefaultValue", ""),
            ("1200sub1", "DefaultValue", ""),
            ("1200sub2", "DefaultValue", ""),
        ],
        &[],
    ),
    (
        "the limits exclude 0, and no default is given",
        &[("2003", "DefaultValue", "")],
        &[],
    ),
    (
        "the limits exclude each other",
        &[("2003", "LowLimit", "100"), ("2003", "HighLimit", "10")],
        &["eds-no-errors", "object-own-value"],
    ),
    (
        "a BOOLEAN is mapped with 8 bits, as CANopenNode does",
        &[
            ("2001", "DataType", "0x0001"),
            ("2002", "DataType", "0x0001"),
        ],
        &[],
    ),
    (
        "what is mapped does not exist",
        &[
            ("1600sub2", "DefaultValue", "0x21000008"),
            ("1A00sub2", "DefaultValue", "0x21000008"),
        ],
        &["eds-no-errors", "pdo-mapped-objects"],
    ),
    (
        "what is mapped cannot be mapped",
        &[("2000", "PDOMapping", "0")],
        &["eds-no-errors"],
    ),
    (
        "the PDOs are multiplexed",
        &[
            ("1600sub0", "DefaultValue", "0xFE"),
            ("1A00sub0", "DefaultValue", "0xFF"),
        ],
        &[],
    ),
    (
        "the COB-ID of the TPDO is that of node 0, which CiA 301 restricts",
        &[("1800sub1", "DefaultValue", "0x180")],
        &["eds-no-errors", "cob-ids", "cob-ids-127"],
    ),
    (
        "the CAN-ID of the TPDO is restricted from node ID 96 on",
        &[("1800sub1", "DefaultValue", "$NODEID+0x680")],
        &["eds-no-errors", "cob-ids-127"],
    ),
    (
        "the CAN-ID of the TPDO has 12 bits at node ID 127",
        &[("1800sub1", "DefaultValue", "$NODEID+0x781")],
        &["eds-no-errors", "cob-ids", "cob-ids-127"],
    ),
    (
        "the node produces SYNC with a counter",
        &[
            ("1005", "DefaultValue", "0x40000080"),
            ("1006", "DefaultValue", "10000"),
            ("1019", "DefaultValue", "4"),
        ],
        &[],
    ),
    (
        "the limits of 1029h are those of its type",
        &[("1029sub1", "HighLimit", "255")],
        &[],
    ),
    (
        "1029h has no limits",
        &[("1029sub1", "LowLimit", ""), ("1029sub1", "HighLimit", "")],
        &[],
    ),
    (
        "nothing is saved",
        &[
            ("1010sub1", "DefaultValue", "0"),
            ("1011sub1", "DefaultValue", "0"),
        ],
        &[],
    ),
    (
        "the TPDO is synchronous and answers remote frames",
        &[("1800sub2", "DefaultValue", "1")],
        &[],
    ),
    (
        "the TPDO refuses remote frames",
        &[("1800sub1", "DefaultValue", "$NODEID+0x40000180")],
        &[],
    ),
    (
        "the file contradicts itself",
        &[
            ("DeviceInfo", "VendorNumber", "0x2"),
            ("DeviceInfo", "NrOfTXPDO", "4"),
        ],
        &["eds-device-info", "eds-pdo-count"],
    ),
];

#[test]
fn a_trait_of_an_eds_is_not_a_failure_of_the_node() {
    let mut wrong = String::new();
    for (what, changes, expected) in TRAITS {
        let text = changed(changes);
        let failed = failed(&text);
        let ids: Vec<&str> = failed.iter().map(|(id, _)| *id).collect();
        if ids != *expected {
            wrong += &format!("{what}: {failed:#?}\n");
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

fn changed(changes: &[Change]) -> String {
    let mut text = String::from(PLAIN);
    for (section, key, value) in changes {
        let header = format!("[{section}]\n");
        let start = text.find(&header).expect("a section") + header.len();
        let end = text[start..]
            .find("\n[")
            .map_or(text.len(), |at| start + at);
        let at = start + text[start..end].find(&format!("{key}=")).expect("a key");
        let line = at..at + text[at..].find('\n').expect("a line") + 1;
        let now = if value.is_empty() {
            String::new()
        } else {
            format!("{key}={value}\n")
        };
        text.replace_range(line, &now);
    }
    text
}

/// The failed cases with their reasons.
fn failed(text: &str) -> Vec<(&'static str, String)> {
    let options = EdsOptions {
        lenient: true,
        ..EdsOptions::default()
    };
    let device = VirtualDevice::from_eds(text, options).expect("a device");
    let node = device.node_id();
    let eds = Eds::read(text);
    let mut rig = OnBench(alone(device));
    let fresh = |node_id| {
        let options = EdsOptions { node_id, ..options };
        Ok(VirtualDevice::from_eds(text, options).expect("a device"))
    };
    let mut session = Session::new(&mut rig, &eds, node, Permissions::ALL);
    session.simulates("plain", &fresh);
    let mut failed = Vec::new();
    for case in built_in() {
        if let Verdict::Fail { expected, got } = session.run(case).verdict {
            failed.push((case.id.as_str(), format!("expected {expected}; {got}")));
        }
    }
    failed
}
