//! The functions of tools, on the bench and in virtual time.

mod configure;
mod late;
mod lss;
mod master;
mod objects;
mod scan;
mod strange;
mod time;

use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use od_wire::NodeId;

/// A node ID.
fn id(raw: u8) -> NodeId {
    NodeId::new(raw).expect("a node ID")
}

/// A bus with these built-in devices, with power.
fn bus(devices: &[(&str, u8)]) -> Bus {
    let mut bus = Bus::new();
    for (name, node) in devices {
        let kind = od_devices::find(name).expect("a built-in device");
        let device = bus.add(VirtualDevice::new(kind, id(*node)));
        bus.start(device);
    }
    bus
}
