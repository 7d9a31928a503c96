//! Nodes without a node ID, and the LSS master that gives them one.

use std::prelude::v1::*;

use od_client::{Client, Event, lss};
use od_runtime::NodeId;

use super::heard;
use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::device::loaded::EdsOptions;

/// It has `LSS_Supported=1`.
const ENCODER: &str = include_str!("../../../../devices/eds/GXMM.eds");

/// An EDS that asks for LSS, without a node ID.
fn unconfigured(serial_number: u32) -> VirtualDevice {
    let device = VirtualDevice::from_eds(ENCODER, EdsOptions::default()).expect("no errors");
    let device = device.with_serial_number(serial_number);
    device.without_node_id().expect("LSS")
}

/// Runs one LSS service.
fn master(bus: &mut Bus, client: &mut Client, task: lss::Task) -> Option<lss::Answer> {
    let job = client.lss(task);
    loop {
        while let Some(frame) = client.poll_transmit(bus.now()) {
            bus.receive(&frame);
        }
        while let Some(sent) = bus.poll() {
            client.handle_frame(sent.at, &sent.frame);
        }
        while let Some(event) = client.poll_event() {
            if let Event::Lss(_, answer) = event {
                return answer.ok();
            }
        }
        let Some(at) = client.poll_timeout() else {
            panic!("{job:?} has no end")
        };
        bus.advance(at);
        client.handle_timeout(bus.now());
    }
}

/// MANUALS.md U-43: slaves without a node ID get one each, one after the other.
#[test]
fn three_slaves_are_commissioned_by_fastscan() {
    let serials = [0x1268, 7, 0xFFFF_FFFF];
    let mut bus = super::bench(serials.map(unconfigured).into());
    assert!(heard(&mut bus).is_empty(), "no boot-up message");
    let mut client = Client::new();
    let mut found = Vec::new();
    for node_id in [10, 11, 12] {
        let answer = master(&mut bus, &mut client, lss::Task::Fastscan);
        let Some(lss::Answer::Found(Some(identity))) = answer else {
            panic!("{answer:?}")
        };
        found.push(identity.serial);
        for task in [
            lss::Task::ConfigureNodeId(NodeId::new(node_id)),
            lss::Task::Store,
            lss::Task::SwitchGlobal {
                configuration: false,
            },
        ] {
            assert!(master(&mut bus, &mut client, task).is_some(), "{task:?}");
        }
        bus.advance(bus.now().plus_millis(1));
    }
    found.sort_unstable();
    assert_eq!(found, [7, 0x1268, 0xFFFF_FFFF]);
    let answer = master(&mut bus, &mut client, lss::Task::Fastscan);
    assert_eq!(answer, Some(lss::Answer::Found(None)));
    let mut ids: Vec<u8> = bus
        .devices()
        .iter()
        .map(|one| one.node_id().raw())
        .collect();
    ids.sort_unstable();
    assert_eq!(ids, [10, 11, 12]);
    heard(&mut bus);
    for device in 0..3 {
        bus.set_power(device, false);
        bus.set_power(device, true);
    }
    let boots = heard(&mut bus);
    assert_eq!(boots.len(), 3, "{boots:?}");
}
