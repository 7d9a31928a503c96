//! Simulated devices, switched on.

use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use od_wire::NodeId;

/// A bus with this device.
pub(crate) fn alone(device: VirtualDevice) -> Bus {
    let mut bus = Bus::new();
    let number = bus.add(device);
    bus.start(number);
    bus
}

/// A bus with the built-in device of this name at node ID 1.
pub(crate) fn bus(name: &str) -> Bus {
    let kind = od_devices::find(name).expect("a device");
    alone(VirtualDevice::new(kind, NodeId::ONE))
}
