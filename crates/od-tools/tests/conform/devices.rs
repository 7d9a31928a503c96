//! The twelve devices pass in virtual time, with another node ID than the default.

use od_sim::VirtualDevice;
use od_tools::bench::OnBench;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::Record;
use od_tools::conform::report::{About, Format, Report};
use od_tools::conform::session::{Permissions, Session};
use od_wire::NodeId;

use crate::simulated::alone;

/// Runs every case on a device that was just switched on, whose shaft turns with this number of revolutions per minute.
fn run(device: VirtualDevice, text: &str, rpm: f64) -> Report {
    let node = device.node_id();
    let mut bus = alone(device);
    if rpm > 0.0 {
        bus.with(0, |device, now| device.set_rpm(rpm, now));
    }
    let eds = Eds::read(text);
    let mut rig = OnBench(bus);
    let mut session = Session::new(&mut rig, &eds, node, Permissions::ALL);
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

fn all_pass(rpm: f64) {
    let mut wrong = String::new();
    for kind in od_devices::DEVICES {
        let node = NodeId::new(5).expect("a node ID");
        let device = VirtualDevice::new(kind, node).with_node_switch();
        let report = run(device, &od_devices::text::eds(kind), rpm);
        if !report.is_pass() {
            wrong += &report.render(Format::Text);
            wrong.push('\n');
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn the_twelve_devices_pass() {
    all_pass(0.0);
}

/// A shaft that turns changes positions between any two readings.
#[test]
fn the_twelve_devices_pass_while_they_turn() {
    all_pass(10.0);
}
