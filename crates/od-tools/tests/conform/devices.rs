//! The twelve devices pass in virtual time, with another node ID than the default.

use od_sim::VirtualDevice;
use od_tools::bench::OnBench;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::Record;
use od_tools::conform::report::{About, Format, Report};
use od_tools::conform::session::{Leave, Session};
use od_wire::NodeId;

use crate::simulated::alone;

/// Runs every case on a device that was just switched on.
fn run(device: VirtualDevice, text: &str) -> Report {
    let node = device.node_id();
    let bus = alone(device);
    let eds = Eds::read(text);
    let mut rig = OnBench(bus);
    let mut session = Session::new(&mut rig, &eds, node, Leave::ALL);
    let records: Vec<Record> = built_in().iter().map(|case| session.run(case)).collect();
    Report {
        about: About::default(),
        device: eds.title(),
        eds: "the built-in EDS".into(),
        link: "bench".into(),
        node: node.raw(),
        records,
        times: session.times().clone(),
        lost: session.lost().map(str::to_owned),
    }
}

#[test]
fn the_twelve_devices_pass() {
    let mut wrong = String::new();
    for kind in od_devices::DEVICES {
        let node = NodeId::new(5).expect("a node ID");
        let device = VirtualDevice::new(kind, node).with_node_switch();
        let report = run(device, &od_devices::text::eds(kind));
        if !report.is_pass() {
            wrong += &report.render(Format::Text);
            wrong.push('\n');
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}
