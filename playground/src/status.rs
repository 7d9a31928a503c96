//! State of a device as seen from outside.

use std::iter;

use od_bench::VirtualDevice;
use od_bench::notice::of_storage;
use od_model::Address;
use od_model::typed::Scalar;
use od_runtime::encoder;
use od_wire::nmt::State;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::objects::is_described;
use crate::record::{Record, integer, list};

#[wasm_bindgen]
impl Bus {
    /// The NMT state, or `off`.
    #[wasm_bindgen(unchecked_return_type = "Nmt")]
    pub fn nmt(&self, device: usize) -> String {
        let Some(device) = self.device(device).filter(|device| device.is_powered()) else {
            return "off".into();
        };
        #[cfg(feature = "real")]
        if device.is_described() && device.seen_state().is_none() {
            return "unknown".into();
        }
        match device.state() {
            State::Initialising => "initialising",
            State::PreOperational => "pre-operational",
            State::Operational => "operational",
            State::Stopped => "stopped",
        }
        .into()
    }

    /// Returns the state of the two LEDs.
    #[wasm_bindgen(unchecked_return_type = "Leds")]
    pub fn leds(&self, device: usize) -> JsValue {
        let (green, red) = self.device(device).map_or(("off", "off"), |device| {
            let (green, red) = device.leds();
            (green.name(), red.name())
        });
        Record::new().with("green", green).with("red", red).done()
    }

    /// Is there power?
    pub fn powered(&self, device: usize) -> bool {
        self.device(device).is_some_and(VirtualDevice::is_powered)
    }

    /// Returns the position of the shaft; `null` without one.
    #[wasm_bindgen(unchecked_return_type = "Shaft | null")]
    pub fn shaft(&mut self, device: usize) -> JsValue {
        let shaft = self
            .journal
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

    /// Returns the steps from the raw position: direction, scaling, position value (6004h); `null`
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
        let Some((operating, per_turn, position)) = self.journal.rig.with(device, read).flatten()
        else {
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
        let controller = self.journal.rig.bus.line.controller(device + 1);
        let Some(one) = self.device(device) else {
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
            .with("plugged", self.journal.rig.bus.line.is_plugged(device + 1))
            .with("moves", self.journal.rig.moves(device))
            .with("real", is_described(one))
            .done()
    }

    /// The bytes of a device's EEPROM.
    pub fn eeprom(&mut self, device: usize) -> Vec<u8> {
        self.journal
            .rig
            .with(device, |device, _| device.eeprom())
            .unwrap_or_default()
    }

    /// Returns what happened to the EEPROMs since the last call, a sentence each, and why inputs of
    /// a run that is made again could not be carried out; nothing of a save that succeeded.
    pub fn notices(&mut self) -> Vec<String> {
        let mut notices = self.journal.refused();
        for device in 0..self.device_count() {
            let told = |device: &mut VirtualDevice, _| {
                let (node, events) = (device.node_id(), iter::from_fn(|| device.poll_event()));
                let events: Vec<_> = events.filter_map(|event| of_storage(&event)).collect();
                events
                    .into_iter()
                    .map(move |text| format!("Node {node}: {text}"))
            };
            notices.extend(
                self.journal
                    .rig
                    .bus
                    .with(device, told)
                    .into_iter()
                    .flatten(),
            );
        }
        notices
    }

    /// Returns the state of the bus line, with the controller of the outside.
    #[wasm_bindgen(unchecked_return_type = "LineStatus")]
    pub fn line(&self) -> JsValue {
        let line = &self.journal.rig.bus.line;
        let outside = line.controller(0);
        let rate = line
            .bit_rate
            .or_else(|| self.journal.rig.bus.devices().iter().find_map(powered_rate));
        Record::new()
            .with("real", line.is_real)
            .with("timed", line.is_timed())
            .with("busy", line.busy() as f64)
            .with("terminators", line.terminators)
            .with(
                "fixedRate",
                line.bit_rate.map_or(JsValue::NULL, JsValue::from),
            )
            .with("rate", rate.map_or(JsValue::NULL, JsValue::from))
            .with("transmitErrors", outside.transmit)
            .with("receiveErrors", outside.receive)
            .with("controller", outside.condition().name())
            .with("plugged", line.is_plugged(0))
            .done()
    }
}

fn powered_rate(device: &VirtualDevice) -> Option<u16> {
    device.bit_rate().filter(|_| device.is_powered())
}
