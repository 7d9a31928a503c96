//! Visible state of a device.

use std::iter;

use od_model::Address;
use od_model::typed::Scalar;
use od_runtime::encoder;
use od_sim::line::ErrorState;
use od_sim::notice::of_storage;
use od_sim::{Led, VirtualDevice};
use od_wire::nmt::State;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Crosses, Made, names, record, words};
use crate::objects::is_described;
use crate::record::integer;

words! {
    Nmt {
        Off = "off",
        Unknown = "unknown",
        Initialising = "initialising",
        PreOperational = "pre-operational",
        Operational = "operational",
        Stopped = "stopped",
    }
}

names! {
    Lamp: Led { Off, Flashing, On, }
    /// Error state of a CAN controller.
    Controller: ErrorState { ErrorActive, ErrorPassive, BusOff, }
}

record! {
    Leds {
        green: Led,
        red: Led,
    }

    Shaft {
        /// Revolutions from the sensor's zero point, with the fraction.
        turns: f64,
        rpm: f64,
        /// The sensor's position, before scaling.
        raw: f64,
    }

    /// The steps from the raw position to the position value; null if it cannot be read.
    Chain {
        reversed: Option<bool>,
        /// Measuring units per revolution; null without scaling.
        "perTurn" per_turn: Made<Option<f64>>,
        position: Made<Option<f64>>,
    }

    /// The visible state of a device.
    Status {
        "nodeId" node_id: u8,
        powered: bool,
        nmt: Nmt,
        leds: Leds,
        shaft: Option<Shaft>,
        /// Rotary switches, 0 to 99.
        "nodeSwitch" node_switch: u8,
        /// DIP switches, 0 to 7.
        "rateSwitch" rate_switch: u8,
        /// Bit rate in kbit/s since the last start; null if it follows the bus.
        rate: Option<u16>,
        /// Names of the faults that it can have.
        "canBreak" can_break: Made<Vec<&'static str>>,
        /// Names of its current faults.
        faults: Made<Vec<&'static str>>,
        "transmitErrors" transmit_errors: u16,
        "receiveErrors" receive_errors: u16,
        controller: ErrorState,
        /// Whether it is connected to the line.
        plugged: bool,
        /// The shaft follows a profile.
        moves: bool,
        /// Whether it describes a node of a real bus.
        real: bool,
    }

    /// The bus line, and the CAN controller of the program side.
    LineStatus {
        real: bool,
        /// Microseconds of all frames so far.
        busy: f64,
        terminators: u8,
        "fixedRate" fixed_rate: Option<u16>,
        rate: Option<u16>,
        "transmitErrors" transmit_errors: u16,
        "receiveErrors" receive_errors: u16,
        controller: ErrorState,
        plugged: bool,
    }
}

impl Bus {
    fn nmt_of(&self, device: usize) -> Nmt {
        let Some(device) = self.device(device).filter(|device| device.is_powered()) else {
            return Nmt::Off;
        };
        #[cfg(feature = "real")]
        if device.is_described() && device.seen_state().is_none() {
            return Nmt::Unknown;
        }
        match device.state() {
            State::Initialising => Nmt::Initialising,
            State::PreOperational => Nmt::PreOperational,
            State::Operational => Nmt::Operational,
            State::Stopped => Nmt::Stopped,
        }
    }

    fn leds_of(&self, device: usize) -> Leds {
        let off = (Led::Off, Led::Off);
        let (green, red) = self.device(device).map_or(off, VirtualDevice::leds);
        Leds { green, red }
    }

    fn shaft_of(&mut self, device: usize) -> Option<Shaft> {
        let rig = &mut self.journal.rig;
        let shaft = rig
            .with(device, |device, now| device.shaft(now))
            .flatten()?;
        Some(Shaft {
            turns: shaft.turns,
            rpm: shaft.rpm,
            raw: shaft.raw as f64,
        })
    }
}

#[wasm_bindgen]
impl Bus {
    /// The NMT state, or `off`.
    #[wasm_bindgen(unchecked_return_type = "Nmt")]
    pub fn nmt(&self, device: usize) -> String {
        self.nmt_of(device).text().into()
    }

    /// Returns the state of the two LEDs.
    #[wasm_bindgen(unchecked_return_type = "Leds")]
    pub fn leds(&self, device: usize) -> JsValue {
        self.leds_of(device).value()
    }

    /// Returns whether it has power.
    pub fn powered(&self, device: usize) -> bool {
        self.device(device).is_some_and(VirtualDevice::is_powered)
    }

    /// Returns the position of the shaft; `null` if there is no shaft.
    #[wasm_bindgen(unchecked_return_type = "Shaft | null")]
    pub fn shaft(&mut self, device: usize) -> JsValue {
        self.shaft_of(device).value()
    }

    /// Returns the steps from the raw position: code sequence, scaling, position value (6004h); `null`
    /// if there is no shaft.
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
        let number =
            |value: Option<u64>| Made::of(value.map_or(JsValue::NULL, |one| integer(one.into())));
        let chain = Chain {
            reversed: bit(encoder::REVERSED),
            per_turn: number(scaled),
            position: number(position),
        };
        chain.value()
    }

    /// The visible state of a device.
    #[wasm_bindgen(unchecked_return_type = "Status")]
    pub fn status(&mut self, device: usize) -> JsValue {
        let shaft = self.shaft_of(device);
        let (leds, nmt) = (self.leds_of(device), self.nmt_of(device));
        let controller = self.journal.rig.bus.line.controller(device + 1);
        let Some(one) = self.device(device) else {
            return JsValue::NULL;
        };
        let (node_switch, rate_switch) = one.switches();
        let known = one.faults();
        let broken = known.iter().filter(|name| one.is_broken(name));
        let status = Status {
            node_id: one.node_id().raw(),
            powered: one.is_powered(),
            nmt,
            leds,
            shaft,
            node_switch,
            rate_switch,
            rate: one.bit_rate(),
            can_break: Made::list(known.iter().copied()),
            faults: Made::list(broken.copied()),
            transmit_errors: controller.transmit,
            receive_errors: controller.receive,
            controller: controller.error_state(),
            plugged: self.journal.rig.bus.line.is_plugged(device + 1),
            moves: self.journal.rig.moves(device),
            real: is_described(one),
        };
        status.value()
    }

    /// The bytes of a device's EEPROM.
    pub fn eeprom(&mut self, device: usize) -> Vec<u8> {
        self.journal
            .rig
            .with(device, |device, _| device.eeprom())
            .unwrap_or_default()
    }

    /// Returns the events of EEPROMs since the last call, a sentence each, and why inputs of
    /// a repeated run failed; successful saves are not included.
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
        let status = LineStatus {
            real: line.is_real(),
            busy: line.busy() as f64,
            terminators: line.terminators,
            fixed_rate: line.bit_rate,
            rate,
            transmit_errors: outside.transmit,
            receive_errors: outside.receive,
            controller: outside.error_state(),
            plugged: line.is_plugged(0),
        };
        status.value()
    }
}

fn powered_rate(device: &VirtualDevice) -> Option<u16> {
    device.bit_rate().filter(|_| device.is_powered())
}
