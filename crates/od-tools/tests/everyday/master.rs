//! A master on a bench: its reads, and virtual time that passes.

use od_model::Address;
use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::link::Link;
use od_tools::master::Master;
use od_wire::{Instant, NodeId};

const DEVICE_TYPE: Address = Address::new(0x1000, 0);

fn bus() -> Bus {
    let kind = od_devices::find("gxmm").expect("a built-in device");
    let mut bus = Bus::new();
    let device = bus.add(VirtualDevice::new(kind, NodeId::ONE));
    bus.start(device);
    bus
}

#[test]
fn a_master_reads_and_writes() {
    let mut bus = bus();
    let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
    assert_eq!(
        master.upload(DEVICE_TYPE),
        Ok(vec![0x96, 1, 2, 0]),
        "1000h: CiA 406, multiturn"
    );
    let heartbeat = Address::new(0x1017, 0);
    assert_eq!(master.download(heartbeat, &[100, 0]), Ok(()));
    assert_eq!(master.upload(heartbeat), Ok(vec![100, 0]));
    let read_only = master.download(DEVICE_TYPE, &[0; 4]);
    assert_eq!(read_only, Err(Error::Abort(0x0601_0002)));
    let now = master.link().now();
    let heard = master.link().receive(now.plus_millis(1000));
    let heard = heard.expect("a link").expect("a heartbeat");
    assert_eq!(heard.frame.to_string(), "701#7F");
    assert!(heard.at > now && heard.at <= now.plus_millis(100));
}

#[test]
fn a_silent_node_is_reported_after_the_time_out() {
    let mut bus = bus();
    let node = NodeId::new(9).expect("a node ID");
    let mut master = Master::new(OnBench(&mut bus), node);
    let Err(Error::Node(text)) = master.upload(DEVICE_TYPE) else {
        panic!("node 9 is not there");
    };
    assert!(text.starts_with("node 9 does not respond"), "{text}");
    assert!(bus.now() >= Instant::from_millis(1000));
}
