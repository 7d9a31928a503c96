//! What can be seen of a device from outside.

use od_bench::VirtualDevice;
use od_model::Address;
use od_model::typed::Scalar;
use od_runtime::encoder;
use od_wire::nmt::State;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::record::{Record, integer, list};

#[wasm_bindgen]
impl Bus {
    /// The NMT state, or `off`.
    #[wasm_bindgen(unchecked_return_type = "Nmt")]
    pub fn nmt(&self, device: usize) -> String {
        let Some(device) = self
            .rig
            .bus
            .devices()
            .get(device)
            .filter(|device| device.is_powered())
        else {
            return "off".into();
        };
        match device.state() {
            State::Initialising => "initialising",
            State::PreOperational => "pre-operational",
            State::Operational => "operational",
            State::Stopped => "stopped",
        }
        .into()
    }

    /// What the two lamps do.
    #[wasm_bindgen(unchecked_return_type = "Leds")]
    pub fn leds(&self, device: usize) -> JsValue {
        let (green, red) = self
            .rig
            .bus
            .devices()
            .get(device)
            .map_or(("off", "off"), |device| {
                let (green, red) = device.leds();
                (green.name(), red.name())
            });
        Record::new().with("green", green).with("red", red).done()
    }

    /// Is there power?
    pub fn powered(&self, device: usize) -> bool {
        self.rig
            .bus
            .devices()
            .get(device)
            .is_some_and(VirtualDevice::is_powered)
    }

    /// Where the shaft is, or `null` where there is none.
    #[wasm_bindgen(unchecked_return_type = "Shaft | null")]
    pub fn shaft(&mut self, device: usize) -> JsValue {
        let shaft = self
            .rig
            .with(device, |device, now| device.shaft(now))
            .flatten();
        shaft.map_or(JsValue::NULL, |shaft| {
            Record::new()
                .with("turns", shaft.turns)
                .with("rpm", shaft.rpm)
                .with("raw", shaft.raw as f64)
                .done()
        })
    }

    /// What becomes of the raw position: direction, scaling, position value (6004h); `null`
    /// without a shaft.
    #[wasm_bindgen(unchecked_return_type = "Chain | null")]
    pub fn chain(&mut self, device: usize) -> JsValue {
        let read = |device: &mut VirtualDevice, now| {
            device.shaft(now)?;
            let mut number = |index| {
                let bytes = device.read(Address::new(index, 0), now);
                let is_number = device.is_powered() && (1..=8).contains(&bytes.len());
                is_number.then(|| u64::from_wire(&bytes))
            };
            Some((number(0x6000), number(0x6001), number(0x6004)))
        };
        let Some((operating, per_turn, position)) = self.rig.with(device, read).flatten() else {
            return JsValue::NULL;
        };
        let bit = |bit: u64| operating.map(|operating| operating & bit != 0);
        let scaled = per_turn.filter(|_| bit(encoder::SCALING) == Some(true));
        let number = |value: Option<u64>| value.map_or(JsValue::NULL, |one| integer(one.into()));
        Record::new()
            .with(
                "reversed",
                bit(encoder::REVERSED).map_or(JsValue::NULL, JsValue::from),
            )
            .with("perTurn", number(scaled))
            .with("position", number(position))
            .done()
    }

    /// Everything that can be seen of a device from outside.
    #[wasm_bindgen(unchecked_return_type = "Status")]
    pub fn status(&mut self, device: usize) -> JsValue {
        let (shaft, leds, nmt) = (self.shaft(device), self.leds(device), self.nmt(device));
        let controller = self.rig.bus.line.controller(device + 1);
        let Some(one) = self.rig.bus.devices().get(device) else {
            return JsValue::NULL;
        };
        let (node, rate) = one.switches();
        let known = one.faults();
        let broken = known.iter().filter(|name| one.is_broken(name));
        Record::new()
            .with("nodeId", one.node_id().raw())
            .with("powered", one.is_powered())
            .with("nmt", nmt)
            .with("leds", leds)
            .with("shaft", shaft)
            .with("nodeSwitch", node)
            .with("rateSwitch", rate)
            .with("rate", one.bit_rate().map_or(JsValue::NULL, JsValue::from))
            .with(
                "canBreak",
                list(known.iter().map(|name| JsValue::from_str(name))),
            )
            .with("faults", list(broken.map(|name| JsValue::from_str(name))))
            .with("transmitErrors", controller.transmit)
            .with("receiveErrors", controller.receive)
            .with("controller", controller.condition().name())
            .with("plugged", self.rig.bus.line.is_plugged(device + 1))
            .with("moves", self.rig.moves(device))
            .done()
    }
}
