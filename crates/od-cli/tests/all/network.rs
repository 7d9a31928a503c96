//! `odkit network`: projects of dcfgen, node lists, and their reports.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{Done, folder, odkit, repository};

/// Runs a project or node list with this text.
fn network(name: &str, file: &str, text: &str) -> (Done, PathBuf) {
    let folder = folder(&format!("network-{name}"), &[(file, text)]);
    let path = folder.join(file);
    let out = folder.join("out");
    let paths = [path.display().to_string(), out.display().to_string()];
    (odkit(&["network", &paths[0], "-o", &paths[1]], ""), out)
}

/// The finding is there, and its place is this line of the file.
fn is_told_at(err: &str, said: &str, line: u32) {
    let found = err.find(said).unwrap_or_else(|| panic!("{said}\n{err}"));
    let place = err[found..].lines().nth(1).unwrap_or_default();
    assert!(place.contains(&format!(":{line}:")), "{said}\n{err}");
}

#[test]
fn concise_dcfs_are_those_of_dcfgen() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/network");
    let out = folder("network-dcfgen", &[]);
    let project = own.join("project.yml").display().to_string();
    let run = odkit(&["network", &project, "-o", &out.display().to_string()], "");
    assert_eq!(run.code, 0, "{}", run.err);
    for name in ["left.bin", "right.bin", "master.bin"] {
        let expected = fs::read(own.join(name)).expect("what dcfgen wrote");
        assert_eq!(fs::read(out.join(name)).ok(), Some(expected), "{name}");
    }
    let master = out.join("master.dcf").display().to_string();
    let checked = odkit(&["check", &master], "");
    assert_eq!(checked.code, 0, "{}", checked.out);
    let text = fs::read_to_string(&master).expect("master.dcf");
    let description = od_eds::parse(&text).description;
    let number = |index, sub| {
        let address = od_model::Address::new(index, sub);
        let entry = description.entry(address).expect("an entry");
        let value = entry.parameter.as_ref().or(entry.default.as_ref());
        value.and_then(|value| value.integer(1)).expect("a number")
    };
    // Three TPDOs of the nodes and one that is not enabled; heartbeats of 8 ms, monitored for 20 ms.
    for (index, sub, expected) in [
        (0x1006, 0, 10_000),
        (0x1016, 1, 0x10_0014),
        (0x1400, 1, 0x190),
        (0x1401, 1, 0x3F0),
        (0x1402, 1, 0x191),
        (0x1403, 1, 0x291),
        (0x1F81, 0x10, 0x305),
        (0x1F81, 0x11, 0x305),
        (0x1600, 1, 0x2000_0120),
        (0x1601, 1, 0x2000_0120),
    ] {
        assert_eq!(number(index, sub), expected, "{index:04X}h:{sub:02X}");
    }
    assert!(text.contains("UploadFile=left.bin"), "{text}");
    for line in [
        "Network: 3 nodes, 250 kbit/s",
        "  16  left                         13  left.bin, 131 bytes",
        "    3F0h  TPDO 2       left                         4  10 ms",
        "    190h  TPDO 1       left                         4  100 ms",
    ] {
        assert!(
            run.out.lines().any(|own| own == line),
            "{line}\n{}",
            run.out
        );
    }
}

/// The values are those that dcfgen 2.4.2 writes with `-r`.
#[test]
fn remote_pdos_are_those_of_dcfgen() {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/network");
    let project = own.join("project.yml").display().to_string();
    let read = |option: &[&str]| {
        let out = folder("network-remote", &[]);
        let path = out.display().to_string();
        let run = odkit(&[&["network", &project, "-o", &path], option].concat(), "");
        assert_eq!(run.code, 0, "{}", run.err);
        let text = fs::read_to_string(out.join("master.dcf")).expect("master.dcf");
        let loaded = od_eds::load(&text);
        let errors = loaded.findings.iter().filter(|one| one.is_error());
        assert_eq!(errors.count(), 0, "{text}");
        loaded.description
    };
    let (plain, remote) = (read(&[]), read(&["-r"]));
    let number = |index, sub| {
        let entry = remote
            .entry(od_model::Address::new(index, sub))
            .expect("an entry");
        let value = entry.parameter.as_ref().or(entry.default.as_ref());
        value.and_then(|value| value.integer(1)).expect("a number")
    };
    for (at, expected) in (0..).zip([0x110, 0x210, 0x111, 0x211]) {
        assert_eq!(number(0x5800 + at, 0), expected);
        assert_eq!(
            (number(0x5A00 + at, 0), number(0x5A00 + at, 1)),
            (1, 0x6004_0020)
        );
    }
    let more = remote
        .objects
        .keys()
        .filter(|index| !plain.objects.contains_key(index));
    assert_eq!(more.count(), 8);
}

/// The form of ros2_canopen: nodes below `nodes`, each with the keys of `defaults` that it does not have itself.
#[test]
fn nodes_with_defaults_are_those_of_the_plain_form() {
    let eds = repository("devices/eds/GXMM.eds");
    let master =
        "master: {node_id: 1, driver: \"ros2_canopen::MasterDriver\", sync_period: 10000}\n";
    let tpdo = "tpdo: {1: {enabled: true, cob_id: auto, transmission: 1}}";
    let merged = format!(
        "{master}defaults:\n  dcf: {eds}\n  heartbeat_producer: 100\n  {tpdo}\n\
         nodes:\n  left: {{node_id: 14}}\n  right:\n    node_id: 15\n    heartbeat_producer: 200\n"
    );
    let plain = format!(
        "{master}left:\n  dcf: {eds}\n  node_id: 14\n  heartbeat_producer: 100\n  {tpdo}\n\
         right:\n  dcf: {eds}\n  node_id: 15\n  heartbeat_producer: 200\n  {tpdo}\n"
    );
    let (one, ones) = network("defaults", "bus.yml", &merged);
    let (other, others) = network("no-defaults", "bus.yml", &plain);
    assert_eq!((one.code, other.code), (0, 0), "{}{}", one.err, other.err);
    assert_eq!(one.out, other.out);
    for file in ["left.bin", "right.bin", "master.bin"] {
        let written = fs::read(ones.join(file)).expect("a file");
        assert_eq!(fs::read(others.join(file)).ok(), Some(written), "{file}");
    }
}

/// A node of GXMM.eds with further keys.
fn node(name: &str, id: u8, keys: &str) -> String {
    let eds = repository("devices/eds/GXMM.eds");
    format!("{name}:\n  dcf: {eds}\n  node_id: {id}\n{keys}")
}

#[test]
fn contradictions_between_nodes_are_reported() {
    let fast = "  tpdo: {1: {transmission: 255, event_timer: 1}, 2: {transmission: 255, event_timer: 1}}\n";
    let text = [
        "master: {node_id: 9, baudrate: 125}\n".into(),
        node("a", 5, fast),
        node("b", 5, ""),
        node("c", 6, "  tpdo: {1: {cob_id: 0x185}}\n"),
        node(
            "d",
            7,
            "  heartbeat_producer: 100\n  hartbeat_producer: 5\n  scale_pos_to_dev: 1000\n",
        ),
        node(
            "e",
            8,
            "  sdo: [{index: 0x1016, sub_index: 1, value: 0x00070064}]\n",
        ),
        node(
            "f",
            10,
            "  sdo: [{index: 0x1016, sub_index: 1, value: 0x00630064}]\n",
        ),
    ];
    let (run, _) = network("odd", "odd.yml", &text.concat());
    assert_eq!(run.code, 1, "{}", run.err);
    for (line, said) in [
        (":8:", "error[E1201]: a and b have node ID 5"),
        (
            ":12:",
            "error[E1202]: TPDO 1 of a and TPDO 1 of c have CAN-ID 185h",
        ),
        (
            ":19:",
            "error[E1204]: e waits 100 ms for the heartbeat of d, which comes every 100 ms",
        ),
        (
            ":23:",
            "warning[W1203]: heartbeat consumer 1016h:01 of f waits for the heartbeat of node 99",
        ),
        (
            ":17:",
            "warning[W1208]: d: `hartbeat_producer` is not a key of dcfgen",
        ),
        ("", "warning[W1205]: periodic frames take up to "),
    ] {
        let mut lines = run.err.lines().skip_while(|own| !own.starts_with(said));
        let place = lines
            .nth(1)
            .unwrap_or_else(|| panic!("{said}\n{}", run.err));
        assert!(
            place.contains(&format!("odd.yml{line}")),
            "{said}\n{}",
            run.err
        );
    }
    let fits = [
        "master: {node_id: 1, heartbeat_producer: 1000, sync_period: 10000}\n".into(),
        node("a", 5, "  heartbeat_consumer: true\n"),
        node("b", 6, "  heartbeat_producer: 100\n"),
    ];
    let (run, out) = network("fits", "fits.yaml", &fits.concat());
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    // One write: 1016h:01 = node 1, 3000 ms.
    let bytes = fs::read(out.join("a.bin")).expect("a.bin");
    assert_eq!(
        bytes,
        [1, 0, 0, 0, 0x16, 0x10, 1, 4, 0, 0, 0, 0xB8, 0x0B, 1, 0]
    );
}

/// Each text of a project is reported once, at its line: the keys of `defaults` are those of two nodes.
#[test]
fn settings_of_a_master_and_of_several_nodes_are_checked() {
    let eds = repository("devices/eds/GXMM.eds");
    let text = format!(
        "options:\n  retry_facto: 2\nmaster:\n  node_id: 1\n  baudrate: 300\n  heartbeat_produce: 500\n\
         defaults:\n  dcf: {eds}\n  hartbeat_producer: 100\n\
         nodes:\n  left:\n    node_id: 5\n    tpdo:\n      2: {{cob_id: 0x5F0, transmission: 255}}\n\
         \n  right:\n    node_id: 6\n    Boot: true\n"
    );
    let (run, _) = network("settings", "bus.yml", &text);
    assert_eq!(run.code, 1, "{}", run.err);
    for (line, said) in [
        (2, "W1208]: options: `retry_facto` is not a key of dcfgen"),
        (5, "W1211]: the bit rate is 300 kbit/s"),
        (
            6,
            "W1208]: master: `heartbeat_produce` is not a key of dcfgen",
        ),
        (
            9,
            "W1208]: defaults: `hartbeat_producer` is not a key of dcfgen",
        ),
        (
            14,
            "E1210]: TPDO 2 of left has CAN-ID 5F0h, which CiA 301 reserves for the default SDO (server to client)",
        ),
        (18, "W1208]: right: `Boot` is not a key of dcfgen"),
    ] {
        is_told_at(&run.err, said, line);
    }
    assert_eq!(run.err.matches("[W1208]").count(), 4, "{}", run.err);
    // A setting without effect, and a value that only the device writes.
    let text = format!(
        "master:\n  node_id: 1\n  sync_window: 500\nleft:\n  dcf: {eds}\n  node_id: 5\n\
         \x20 sdo:\n    - {{index: 0x1016, sub_index: 1, value: 0}}\n    - {{index: 0x1001, value: 0}}\n\
         \x20 tpdo:\n    1:\n      transmission: 245\n    2: {{enabled: false}}\n  node_id: 5\n"
    );
    let (run, _) = network("no-effect", "bus.yml", &text);
    assert_eq!(run.code, 1, "{}", run.err);
    for (line, said) in [
        (
            3,
            "W1213]: `sync_window` has no effect without `sync_period`",
        ),
        (
            9,
            "E1212]: left: AccessType of 1001h \"Error register\" is `ro`",
        ),
        (
            12,
            "E1214]: left: 1800h:02: transmission type 245 is reserved (W0511)",
        ),
        (14, "W1208]: duplicate key `node_id`; dcfgen uses the last"),
    ] {
        is_told_at(&run.err, said, line);
    }
    assert_eq!(run.err.matches("[E1212]").count(), 1, "{}", run.err);
    let (run, _) = network("master-id", "bus.yml", "master:\n  node_id: 128\n");
    is_told_at(&run.err, "E1214]: master: node_id `128` is not valid", 2);
}

/// A SYNC producer with the period 0 sends no SYNC (CiA 301, object 1006h).
#[test]
fn a_synchronous_pdo_needs_a_period_of_sync() {
    let nodes = [
        node("a", 5, "  tpdo: {2: {transmission: 4}}\n"),
        node("b", 6, "  tpdo: {2: {transmission: 0}}\n"),
        node("c", 7, "  tpdo: {2: {transmission: 255}}\n"),
        node("d", 8, "  tpdo: {2: {transmission: 253}}\n"),
    ];
    let project = |period: &str| {
        [
            "master: {node_id: 1".into(),
            period.into(),
            "}\n".into(),
            nodes.concat(),
        ]
        .concat()
    };
    for (name, period) in [("none", ""), ("zero", ", sync_period: 0")] {
        let (run, _) = network(&format!("sync-{name}"), "sync.yml", &project(period));
        assert_eq!(run.code, 0, "{}", run.err);
        for (line, pdo) in [(5, "TPDO 2 of a"), (9, "TPDO 2 of b")] {
            let said = format!(
                "warning[W1203]: {pdo} is synchronous, but no node sends SYNC (CAN-ID 080h)\n"
            );
            let found = run
                .err
                .find(&said)
                .unwrap_or_else(|| panic!("{said}{}", run.err));
            let place = run.err[found..].lines().nth(1).unwrap_or_default();
            assert!(place.contains(&format!("sync.yml:{line}:")), "{}", run.err);
        }
        assert_eq!(run.err.matches("[W1203]").count(), 2, "{}", run.err);
        for (id, period) in [
            (5, "at each 4 SYNC messages"),
            (6, "at SYNC after an event"),
            (7, "256 ms"),
            (8, "on request"),
        ] {
            let id = format!("    {:03X}h  TPDO 2", 0x280 + id);
            let mut lines = run.out.lines().filter(|line| line.starts_with(&id));
            assert!(
                lines.next().is_some_and(|line| line.ends_with(period)),
                "{}",
                run.out
            );
        }
        assert!(!run.out.contains("  SYNC  "), "{}", run.out);
    }
    let (run, _) = network("sync-period", "sync.yml", &project(", sync_period: 10000"));
    assert_eq!((run.code, run.err.as_str()), (0, ""));
    assert!(run.out.contains("  40 ms"), "{}", run.out);
}

#[test]
fn what_ends_the_reading_of_a_project_is_a_finding_at_its_line() {
    for (text, said, line) in [
        ("a: 1\n", "E1216]: the section `master` is missing", 1),
        ("a: [1\nb: 2\n", "E1218]: ", 2),
        ("a:\n  <<: 1\n", "E1218]: `<<` needs a mapping", 3),
        (
            "master: {}\nx: {node_id: 5}\n",
            "E1216]: x: the key `dcf` is missing",
            2,
        ),
        (
            "master: {}\nx:\n  dcf: none.eds\n  node_id: 5\n",
            "E1217]: x: none.eds: ",
            3,
        ),
    ] {
        let (run, out) = network("none", "none.yml", text);
        assert_eq!((run.code, run.out.as_str()), (1, ""), "{}", run.err);
        is_told_at(&run.err, said, line);
        assert!(!out.exists(), "no file of a network that is not complete");
    }
    let project = |keys: &str| ["master: {}\n".into(), node("x", 5, keys)].concat();
    for (keys, said, line) in [
        (
            "  sdo: [{index: 0x5FFF}]\n",
            "E1214]: x: object 5FFFh:00 does not exist",
            5,
        ),
        (
            "  sdo:\n    - {value: 1}\n",
            "E1216]: x: the key `index` is missing",
            6,
        ),
        (
            "  sdo: [{index: 0x1017, value: 70000}]\n",
            "E1214]: x: 1017h:00: 70000 is not a valid UNSIGNED16",
            5,
        ),
        (
            "  rpdo: {1: {}}\n",
            "E1214]: x: object 1400h does not exist",
            5,
        ),
        (
            "  rpdo: {0: {}}\n",
            "E1214]: x: rpdo has `0`, which is not the number of a PDO",
            5,
        ),
        (
            "  heartbeat_producer: fast\n",
            "E1214]: x: heartbeat_producer `fast` is not a number",
            5,
        ),
        (
            "  heartbeat_producer: 70000\n",
            "E1214]: x: 1017h:00: 70000 is not a valid UNSIGNED16",
            5,
        ),
        (
            "  error_behavior: {1: -1}\n",
            "E1214]: x: error_behavior `-1` is not valid",
            5,
        ),
        (
            "  tpdo:\n    1:\n      mapping:\n        - {index: 0x6004}\n        - {index: 0x6999}\n",
            "E1214]: x: object 6999h:00 does not exist",
            9,
        ),
        (
            "  tpdo:\n    1:\n      cob_id: auto\n      transmission: 300\n",
            "E1214]: x: 1800h:02: 300 is not a valid UNSIGNED8",
            8,
        ),
        (
            "  tpdo:\n    1:\n      transmission: slow\n",
            "E1214]: x: transmission `slow` is not a number",
            7,
        ),
    ] {
        let (run, _) = network("keys", "keys.yml", &project(keys));
        assert_eq!(run.code, 1, "{}", run.err);
        is_told_at(&run.err, said, line);
    }
    // Each node has its own finding, and nodes are not compared with nodes that are missing.
    let nodes = [node("a", 200, ""), node("b", 6, "  serial_number: x\n")];
    let text = format!("master: {{sync_period: fast}}\n{}", nodes.concat());
    let (run, _) = network("all", "bus.yml", &text);
    for (said, line) in [
        ("master: sync_period `fast` is not a number", 1),
        ("a: node_id `200` is not valid", 4),
        ("b: serial_number `x` is not a number", 8),
    ] {
        is_told_at(&run.err, said, line);
    }
    assert_eq!(run.err.matches("error[").count(), 3, "{}", run.err);
}

#[test]
fn a_node_list_has_the_dcfs_of_its_nodes() {
    let folder = folder("network-list", &[]);
    let eds = repository("devices/eds/GXMM.eds");
    for (id, rest) in [
        ("4", ["--set", "1017h=200"]),
        ("5", ["--set", "1800sub2=1"]),
    ] {
        let path = folder.join(format!("n{id}.dcf")).display().to_string();
        let make = [
            "convert",
            &eds,
            "-o",
            &path,
            "--node-id",
            id,
            "--bit-rate",
            "500",
        ];
        assert_eq!(odkit(&[&make[..], &rest].concat(), "").code, 0);
    }
    let list = folder.join("nodelist.cpj");
    let text = "[TOPOLOGY]\nNetName=Line 4\nNodes=0x02\nNode4Present=0x01\nNode4Name=Left\n\
        Node4DCFName=n4.dcf\nNode5Present=0x01\nNode5DCFName=.\\n5.dcf\nNode6Present=0x00\nNode6DCFName=none.dcf\n";
    fs::write(&list, text).expect("a file");
    let out = folder.join("out");
    let paths = [list.display().to_string(), out.display().to_string()];
    // The number of nodes may also count those that are not present.
    for count in ["0x02", "3"] {
        let text = text.replace("0x02", count);
        fs::write(&list, text).expect("a file");
        let run = odkit(&["network", &paths[0]], "");
        assert!(!run.err.contains("W1207"), "{count}: {}", run.err);
    }
    let run = odkit(&["network", &paths[0], "-o", &paths[1]], "");
    // Two encoders consume SYNC only if a PDO is synchronous, and no node produces it.
    assert_eq!(run.code, 0, "{}", run.err);
    assert!(
        run.out
            .starts_with("Network `Line 4`: 2 nodes, 500 kbit/s\n"),
        "{}",
        run.out
    );
    assert!(
        run.err
            .contains("TPDO 1 of node5 is synchronous, but no node sends SYNC (CAN-ID 080h)"),
        "{}",
        run.err
    );
    let left = fs::read(out.join("Left.bin")).expect("Left.bin");
    assert_eq!(left, [1, 0, 0, 0, 0x17, 0x10, 0, 2, 0, 0, 0, 200, 0]);
    let right = fs::read(out.join("node5.bin")).expect("node5.bin");
    let first = [0, 0x18, 1, 4, 0, 0, 0, 0x85, 1, 0, 0x80];
    assert_eq!(right[4..15], first, "the PDO is not valid while it changes");
    let last = [0, 0x18, 1, 4, 0, 0, 0, 0x85, 1, 0, 0];
    assert_eq!(right[right.len() - 11..], last);

    // A list that contradicts itself and the DCFs, each at its line.
    let text = "[Topology]\nNodes=3\nNode4Present=yes\nNode4DCFName=n4.dcf\nNode6Present=1\n\
        Node6DCFName=n5.dcf\nNode0Present=1\nNode128DCFName=n4.dcf\nNode200Present=0\n";
    fs::write(&list, text).expect("a file");
    let run = odkit(&["network", &paths[0]], "");
    assert_eq!(run.code, 1, "{}", run.err);
    for (line, message) in [
        (2, "Nodes is 3, but 2 nodes are present"),
        (3, "Node4Present is `yes`"),
        (
            6,
            "the node ID is 6 in this list, but NodeID is 5 in the DCF",
        ),
        (7, "`Node0Present`: a node ID is 1 to 127"),
        (8, "`Node128DCFName`: a node ID is 1 to 127"),
    ] {
        let found = run
            .err
            .find(message)
            .unwrap_or_else(|| panic!("{message}: {}", run.err));
        let place = run.err[found..].lines().nth(1).unwrap_or_default();
        assert!(
            place.contains(&format!("nodelist.cpj:{line}:")),
            "{message}: {place}"
        );
    }
    assert_eq!(run.err.matches("[W1207]").count(), 5, "{}", run.err);
    let text = "[Topology]\nNodes=2\nNode4Present=1\nNode4Name=Left\nNode4DCFName=n4.dcf\nNode5Present=1\nNode5Name=Left\n\
        Node5DCFName=n5.dcf\nNode4Name=Right\nNode5DCFNam=Right\n[Topology]\nNodse=0\nNode6Refd=1\n";
    fs::write(&list, text).expect("a file");
    let run = odkit(&["network", &paths[0]], "");
    for (line, message) in [
        (7, "node 5 has the name `Left`, as node 4 has"),
        (9, "duplicate key `Node4Name`; odkit uses the first"),
        (10, "`Node5DCFNam` is not a key of a node list"),
        (11, "duplicate section [Topology]"),
        (12, "`Nodse` is not a key of a node list"),
    ] {
        let found = run
            .err
            .find(message)
            .unwrap_or_else(|| panic!("{message}: {}", run.err));
        let place = run.err[found..].lines().nth(1).unwrap_or_default();
        assert!(place.contains(&format!("nodelist.cpj:{line}:")), "{place}");
    }
    assert_eq!(run.err.matches("[W1207]").count(), 5, "{}", run.err);
    for (text, message, line) in [
        (
            "[Topology]\nNode3Present=1\n",
            "E1216]: Node3DCFName is missing",
            2,
        ),
        (
            "[Topology]\nNode3Present=1\nNode3DCFName=\n",
            "E1216]: Node3DCFName is missing",
            3,
        ),
        (
            "[Topology]\nNode3Present=1\nNode3DCFNam=n4.dcf\n",
            "`Node3DCFNam` is not a key of a node list",
            3,
        ),
        (
            "\n[Tropology]\nNodes=0\n",
            "[Tropology] is not a section of a node list",
            2,
        ),
        (
            "[Topology]\nNode3DCFName=none.dcf\n",
            "E1217]: node 3: none.dcf: ",
            2,
        ),
        (
            "[Topology]\nNodes=0\n[Topologyy]\nNodes=0\n",
            "[Topologyy] is not a section of a node list",
            3,
        ),
        (
            "[FileInfo]\n",
            "E1216]: the section [Topology] is missing",
            1,
        ),
    ] {
        fs::write(&list, text).expect("a file");
        let run = odkit(&["network", &paths[0]], "");
        assert_eq!(run.code, 1, "{}", run.err);
        is_told_at(&run.err, message, line);
    }
}

/// The DCFs `n4.dcf` and `n5.dcf` of two nodes at 500 kbit/s.
fn dcfs(folder: &Path) {
    let eds = repository("devices/eds/GXMM.eds");
    for id in ["4", "5"] {
        let path = folder.join(format!("n{id}.dcf")).display().to_string();
        let make = ["convert", &eds, "-o", &path, "--node-id", id];
        let run = odkit(&[&make[..], &["--bit-rate", "500"]].concat(), "");
        assert_eq!(run.code, 0, "{}", run.err);
    }
}

/// The text of a network file after safe and after all fixes.
fn fixed(name: &str, file: &str, text: &str) -> (String, String) {
    let folder = folder(&format!("network-fix-{name}"), &[(file, text)]);
    dcfs(&folder);
    let path = folder.join(file);
    let fix = |option| {
        odkit(&["network", &path.display().to_string(), option], "");
        fs::read_to_string(&path).expect("the file")
    };
    let safe = fix("--fix");
    assert_eq!(fix("--fix"), safe, "a second run changes nothing");
    let all = fix("--unsafe-fixes");
    assert_eq!(fix("--unsafe-fixes"), all, "a second run changes nothing");
    (safe, all)
}

#[test]
fn fixes_of_a_node_list_touch_what_is_wrong_only() {
    // A lower count, other node IDs and names change the meaning; a word for 1 and an equal line do not.
    let text = "[Tropology]\r\nNodes=3 ; ours\r\nNode4Present=yes\r\nNode4DCFName=n4.dcf\r\n\
        Node6Present=1\r\nNode6DCFName=n5.dcf\r\nNode6Name=b\r\nNode6Name=b\r\n";
    let (safe, all) = fixed("list", "nodelist.cpj", text);
    let same = text
        .replace("=yes", "=1")
        .replacen("Node6Name=b\r\n", "", 1);
    assert_eq!(safe, same);
    let same = same
        .replace("Tropology", "Topology")
        .replace("Node6", "Node5");
    assert_eq!(all, same.replace("Nodes=3", "Nodes=0x02"));
    // A count that is too low is safe to correct, unless a key of a node is wrong, too.
    let text = "[Topology]\nNodes=1\nNode4Present=1\nNode4DCFName=n4.dcf\nNode5Present=1\nNode5DCFName=n5.dcf\n";
    let (safe, _) = fixed("count", "nodelist.cpj", text);
    assert_eq!(safe, text.replace("Nodes=1", "Nodes=0x02"));
    let text = text.replace("Node5DCFName", "Node5DCFNam");
    let (safe, all) = fixed("key", "nodelist.cpj", &text);
    assert_eq!(safe, text);
    let right = text.replace("DCFNam=", "DCFName=");
    assert_eq!(all, right.replace("Nodes=1", "Nodes=0x02"));
    // A file that does not exist is reported under the right key.
    let text = text.replace("n5.dcf", "none.dcf");
    let (_, all) = fixed("none", "nodelist.cpj", &text);
    assert_eq!(all, text.replace("DCFNam=", "DCFName="));
}

#[test]
fn fixes_of_a_project_touch_what_is_wrong_only() {
    let text = "master:\n  node_id: 1\n  baudrate: 500 kbit/s # all\n  start: nein\n\
        left: {dcf: n4.dcf, heartbeat_produce: 100, heartbeat_consumer: ja, mandatory: \"true\"}\n\
        right:\n  dcf: n5.dcf\n  Boot: false\n  boot: 'no'\n  tpdo: {1: {Transmission: 1, enabled: vielleicht}}\n";
    let (safe, all) = fixed("project", "bus.yml", text);
    let same = text.replace(": ja", ": true");
    assert_eq!(safe, same);
    let same = same.replace("500 kbit/s", "500").replace("nein", "false");
    let same = same
        .replace("produce:", "producer:")
        .replace("'no'", "false");
    assert_eq!(all, same.replace("Transmission", "transmission"));
    for (given, right) in [("1000000", "1000"), ("125k", "125"), ("0.5 Mbit/s", "500")] {
        let text = format!("master: {{node_id: 1, baudrate: {given}}}\nleft: {{dcf: n4.dcf}}\n");
        let (_, all) = fixed("rate", "bus.yml", &text);
        assert_eq!(all, text.replace(given, right));
    }
    // An index without 0x, a number in quotes or with a unit; equal keys, of which the last is used.
    let node = |keys: &str| format!("master: {{node_id: 1}}\nleft:\n  dcf: n4.dcf\n{keys}");
    for (given, safe, all) in [
        (
            "  sdo: [{index: 6003, value: 1}]\n",
            None,
            "  sdo: [{index: 0x6003, value: 1}]\n",
        ),
        (
            "  tpdo: {1: {mapping: [{index: 6004}]}}\n",
            None,
            "  tpdo: {1: {mapping: [{index: 0x6004}]}}\n",
        ),
        (
            "  heartbeat_producer: \"0x64\" # \"ms\"\n",
            None,
            "  heartbeat_producer: 100 # \"ms\"\n",
        ),
        (
            "  heartbeat_producer: 2s\n",
            None,
            "  heartbeat_producer: 2000\n",
        ),
        (
            "  tpdo: {1: {inhibit_time: 2 ms}}\n",
            None,
            "  tpdo: {1: {inhibit_time: 20}}\n",
        ),
        (
            "  boot: no # 1\n  serial_number: 1\n  boot: no\n",
            Some("  serial_number: 1\n  boot: no\n"),
            "  serial_number: 1\n  boot: no\n",
        ),
        (
            "  serial_number: 1\n  serial_number: 2\n  serial_number: 2\n",
            Some("  serial_number: 1\n  serial_number: 2\n"),
            "  serial_number: 2\n",
        ),
    ] {
        let text = node(given);
        let (own, fixed) = fixed("meant", "bus.yml", &text);
        assert_eq!(own, node(safe.unwrap_or(given)), "{given}");
        assert_eq!(fixed, node(all), "{given}");
    }
    for given in [
        "  heartbeat_producer: 200 us\n",
        "  serial_number: &one 1\n  serial_number: *one\n",
        "  boot:\n    no\n  boot: no\n",
        "  sdo: [{index: 0x6003, index: 0x6003, value: 1}]\n",
    ] {
        assert_eq!(fixed("not-meant", "bus.yml", &node(given)).1, node(given));
    }
    for given in ["schnell", "300", "500 x", "[1]"] {
        let text = format!("master: {{node_id: 1, baudrate: {given}}}\nleft: {{dcf: n4.dcf}}\n");
        let (_, all) = fixed("other-rate", "bus.yml", &text);
        assert_eq!(all, text);
    }
}

/// The word and its opposite: dcfgen reads both as true.
#[test]
fn a_word_instead_of_a_flag_is_reported() {
    let folder = folder("network-flags", &[]);
    dcfs(&folder);
    for (given, severity) in [
        ("ja", "warning[W1215]"),
        ("nein", "error[W1215]"),
        ("\"false\"", "error[W1215]"),
        ("perhaps", "warning[W1215]"),
        ("\"true\"", ""),
        ("no", ""),
        ("0", ""),
    ] {
        let text = format!("master: {{node_id: 1}}\nx:\n  dcf: n4.dcf\n  boot: {given}\n");
        let path = folder.join("bus.yml");
        fs::write(&path, text).expect("a file");
        let run = odkit(&["network", &path.display().to_string()], "");
        match severity {
            "" => assert!(!run.err.contains("W1215"), "{given}: {}", run.err),
            severity => is_told_at(&run.err, severity, 4),
        }
    }
}
