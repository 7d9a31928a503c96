//! The table of faults: each is found by the case that tests the behaviour.

use std::collections::BTreeSet;

use od_sim::bus::Bus;
use od_sim::{EdsOptions, VirtualDevice};
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::{Record, Verdict};
use od_tools::conform::session::{Permissions, Session};
use od_wire::NodeId;

use crate::mutant::Spoiled;

const TABLE: &str = include_str!("mutants.txt");

/// Objects that a case needs and `ds301` lacks: limits, a write-only value, 1020h.
const EXTENSION: &str = "
[2001]\nParameterName=Command\nObjectType=7\nDataType=5\nAccessType=wo\n
[2002]\nParameterName=Long\nObjectType=7\nDataType=9\nAccessType=rw\nDefaultValue=more than twenty letters\n
[1280]\nParameterName=SDO client\nObjectType=9\nSubNumber=4\n
[1280sub0]\nParameterName=Highest sub-index\nDataType=5\nAccessType=const\nDefaultValue=3\n
[1280sub1]\nParameterName=To server\nDataType=7\nAccessType=rw\nDefaultValue=0x80000000\n
[1280sub2]\nParameterName=To client\nDataType=7\nAccessType=rw\nDefaultValue=0x80000000\n
[1280sub3]\nParameterName=Server\nDataType=5\nAccessType=rw\nDefaultValue=2\n
[1020]\nParameterName=Verify configuration\nObjectType=8\nSubNumber=3\n
[1020sub0]\nParameterName=Highest sub-index\nDataType=5\nAccessType=const\nDefaultValue=2\n
[1020sub1]\nParameterName=Date\nDataType=7\nAccessType=rw\nDefaultValue=0\n
[1020sub2]\nParameterName=Time\nDataType=7\nAccessType=rw\nDefaultValue=0\n
";

/// The name of a device without that of its shaft.
fn kind(name: &str) -> &str {
    name.split(' ').next().unwrap_or(name)
}

/// 1021h with an EDS of the identity that `ds301` has.
fn stored_eds() -> String {
    let text = "[DeviceInfo]\nVendorNumber=1\nProductNumber=2\nRevisionNumber=3\n\
        [MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n\
        [1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\n";
    let hex: String = text.bytes().map(|byte| format!("{byte:02X}")).collect();
    format!(
        "\n[1021]\nParameterName=Store EDS\nObjectType=2\nDataType=15\nAccessType=ro\nDefaultValue={hex}\n"
    )
}

/// The EDS of a device of the table.
fn text(name: &str) -> String {
    match kind(name) {
        "ds301" => include_str!("../../../../firmware/eds/ds301.eds")
            .replace("LSS_Supported=0", "LSS_Supported=1"),
        "no-lss" => include_str!("../../../../firmware/eds/ds301.eds").into(),
        "dummies" => text("ds301").replace("Dummy0005=0", "Dummy0005=1"),
        "limited" => changed(&text("ds301"), "1017 DataType=0x0006\nHighLimit=5000"),
        "extended" => text("ds301") + EXTENSION,
        "stores-eds" => text("ds301") + &stored_eds(),
        "services" => include_str!("../../../../tests/eds/services.eds").into(),
        built_in => od_devices::text::eds(od_devices::find(built_in).expect("a device")),
    }
}

/// The text with `SECTION KEY=VALUE`.
fn changed(text: &str, change: &str) -> String {
    let (section, line) = change.split_once(' ').expect("a section and a line");
    let (key, _) = line.split_once('=').expect("a key");
    let header = format!("[{section}]");
    let at = text.find(&header).expect("the section");
    let from = at + text[at..].find(&format!("\n{key}=")).expect("the key") + 1;
    let to = from + text[from..].find('\n').expect("an end");
    format!("{}{line}{}", &text[..from], &text[to..])
}

/// Returns whether a case writes the memory of the device.
fn is_lasting(case: &str) -> bool {
    let lasting = [
        "store",
        "restore",
        "object-default",
        "lss",
        "heartbeat-saved",
        "heartbeat-consumer-saved",
        "guarding-saved",
        "nmt-self-start",
        "sync-saved",
        "sdo-clients",
        "encoder-preset-saved",
        "encoder-gear",
    ];
    lasting.iter().any(|start| case.starts_with(start))
}

/// A device of the table, switched on, and its EDS; read only once, since this takes most of the
/// time.
struct Bench {
    name: &'static str,
    text: String,
    eds: Eds,
    bus: Option<Bus>,
}

impl Bench {
    fn new(name: &'static str) -> Self {
        let text = text(name);
        Self {
            name,
            eds: Eds::read(&text),
            text,
            bus: None,
        }
    }

    fn device(&self) -> VirtualDevice {
        if let Some(kind) = od_devices::find(kind(self.name)) {
            return VirtualDevice::new(kind, NodeId::ONE);
        }
        let options = EdsOptions {
            node_id: None,
            lenient: true,
        };
        let (device, _) = VirtualDevice::read_eds(&self.text, options);
        device.expect("a device")
    }

    /// The device after power-on; a new one before and after a case that writes its memory.
    fn bus(&mut self, case: &str) -> Bus {
        if let Some(mut bus) = self.bus.take().filter(|_| !is_lasting(case)) {
            bus.set_power(0, false);
            bus.set_power(0, true);
            let now = bus.now();
            bus.advance(now.plus_millis(3000));
            while bus.poll().is_some() {}
            return bus;
        }
        let mut bus = Bus::new();
        let number = bus.add(self.device());
        bus.start(number);
        // A position of 0 would be 0 in any scale.
        bus.with(number, |device, now| device.turn(0.3, now));
        if self.name.ends_with(" turning") {
            bus.with(number, |device, now| device.set_rpm(10.0, now));
        }
        if self.name == "io" {
            for (output, input) in [
                ("out3", "in2"),
                ("out11", "in10"),
                ("aout1", "ain1"),
                ("aout2", "ain2"),
                ("aout1", "ain3"),
                ("aout2", "ain4"),
            ] {
                bus.connect((number, output), (number, input))
                    .expect("a wire");
            }
        }
        bus
    }

    /// Runs one case with these rules.
    fn run(&mut self, id: &str, rules: &str) -> Record {
        let case = built_in().iter().find(|one| one.id == id);
        let case = case.expect("a case of the table");
        let mut rig = Spoiled::new(self.bus(id), rules);
        let changes = rules
            .split(" ; ")
            .filter_map(|rule| rule.strip_prefix("eds "));
        let other = changes.fold(None, |text: Option<String>, change| {
            Some(changed(text.as_ref().unwrap_or(&self.text), change))
        });
        let other = other.map(|text| Eds::read(&text));
        let eds = other.as_ref().unwrap_or(&self.eds);
        let record = Session::new(&mut rig, eds, NodeId::ONE, Permissions::ALL).run(case);
        self.bus = (!is_lasting(id)).then(|| rig.into_bus());
        record
    }
}

#[test]
fn each_fault_is_found_by_its_case() {
    let lines = TABLE.lines().filter(|line| !line.starts_with('#'));
    let mut right = BTreeSet::new();
    let mut benches: Vec<Bench> = Vec::new();
    let (mut all, mut missed, mut broken) = (0, Vec::new(), Vec::new());
    for line in lines {
        let mut parts = line.splitn(3, " | ");
        let mut part = || parts.next().expect("case, device, rules");
        let (case, device, rules) = (part(), part(), part());
        let at = benches.iter().position(|bench| bench.name == device);
        let at = at.unwrap_or_else(|| {
            benches.push(Bench::new(device));
            benches.len() - 1
        });
        let bench = &mut benches[at];
        // The case passes on the device without faults.
        if right.insert((case, device)) {
            let record = bench.run(case, "");
            if !record.verdict.is_pass() {
                let frames = record.frames.iter().rev().take(14).rev();
                let frames: Vec<String> = frames.map(|one| one.frame.to_string()).collect();
                broken.push(format!(
                    "{case} on {device}: {:?} {frames:?}",
                    record.verdict
                ));
            }
        }
        all += 1;
        let record = bench.run(case, rules);
        if !matches!(record.verdict, Verdict::Fail { .. }) {
            missed.push(format!("{line}: {:?}", record.verdict));
        }
    }
    assert!(broken.is_empty(), "{}", broken.join("\n"));
    assert!(
        missed.is_empty(),
        "{} of {all} not found by their case:\n{}",
        missed.len(),
        missed.join("\n")
    );
}

/// The table has at least one fault for every case.
#[test]
fn every_case_has_a_way_to_fail() {
    let named: BTreeSet<&str> = TABLE
        .lines()
        .filter_map(|line| line.split(" | ").next())
        .collect();
    let without: Vec<&str> = built_in()
        .iter()
        .map(|case| case.id.as_str())
        .filter(|id| !named.contains(id))
        .collect();
    assert!(without.is_empty(), "{without:?}");
}

/// At least one case covers each of the 127 official cases.
#[test]
fn every_official_case_is_covered() {
    let text = include_str!("../../../../tests/conformance/cia/cases.txt");
    let numbers = text.lines().filter(|line| !line.starts_with('#'));
    let numbers: Vec<&str> = numbers
        .filter_map(|line| line.split(" | ").next())
        .collect();
    assert_eq!(numbers.len(), 127);
    let covered: BTreeSet<&str> = built_in()
        .iter()
        .flat_map(|case| od_tools::conform::official::numbers(&case.id).split(", "))
        .collect();
    let missing: Vec<&&str> = numbers
        .iter()
        .filter(|number| !covered.contains(**number))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}

/// The frames of a report lead to the failure. `sdo-upload-sizes` reads further objects after it.
#[test]
fn a_failure_is_found_at_its_frame() {
    let record = Bench::new("ds301").run("sdo-upload-sizes", "from 581#4B 17 10 *: set 0=4F");
    assert!(record.verdict.is_fail(), "{:?}", record.verdict);
    let frames: Vec<String> = record
        .frames
        .iter()
        .map(|one| one.frame.to_string())
        .collect();
    let (before, after) = frames.split_at(record.found);
    assert!(
        before
            .last()
            .is_some_and(|one| one.starts_with("581#4F1710")),
        "{before:?}"
    );
    assert!(
        after.iter().any(|one| one.starts_with("601#40")),
        "{after:?}"
    );
}

/// A node need not make a PDO valid that has no objects; CANopenNode does not.
#[test]
fn a_pdo_without_objects_need_not_be_valid() {
    let mut bench = Bench::new("ds301");
    let refuses = "to 601#23 00 18 01 F6 04 00 00: reply 581#80 00 18 01 30 00 09 06";
    let is_empty = "from 581#4F 00 1A 00 *: set 4=00";
    let record = bench.run("cob-id-free", refuses);
    assert!(record.verdict.is_fail(), "{:?}", record.verdict);
    let record = bench.run("cob-id-free", &format!("{refuses} ; {is_empty}"));
    assert!(record.verdict.is_pass(), "{:?}", record.verdict);
}

/// A behaviour that CiA 305 leaves open is a remark, and the case passes.
#[test]
fn a_fastscan_that_ends_early_is_a_remark() {
    let mut bench = Bench::new("ds301");
    let early = "since <7E5#51 .. .. .. .. 00 01 00> until <7E5#04 *> to 7E5#5A *: \
                 reply 7E4#5A 01 00 00 00 00 00 00";
    for (rules, is_there) in [("", false), (early, true)] {
        let record = bench.run("lss-fastscan", rules);
        assert!(record.verdict.is_pass(), "{rules}: {:?}", record.verdict);
        let remark = record
            .notes
            .iter()
            .any(|note| note.starts_with("remark, CiA 305 6.7"));
        assert_eq!(remark, is_there, "{rules}: {:?}", record.notes);
    }
}
