//! The bench around the bus: what hangs on it, switches, faults, EEPROMs, the wire.

use od_bench::VirtualDevice;
use od_bench::wire::Trouble;
use od_model::Address;
use od_runtime::Instant;
use wasm_bindgen::prelude::*;

use crate::record::{Record, list};
use crate::{Bus, packed, values};

#[wasm_bindgen]
impl Bus {
    /// How many devices are on the bus.
    #[wasm_bindgen(js_name = deviceCount)]
    pub fn device_count(&self) -> usize {
        self.bus.devices().len()
    }

    /// Takes a device off the bus; the numbers of those behind it go down by one.
    #[wasm_bindgen(js_name = removeDevice)]
    pub fn remove_device(&mut self, device: usize) {
        if self.bus.remove(device).is_some() {
            self.clockwork.remove(device);
        }
    }

    /// Everything that can be seen of a device from outside.
    #[wasm_bindgen(unchecked_return_type = "Status")]
    pub fn status(&mut self, device: usize) -> JsValue {
        let (shaft, leds, nmt) = (self.shaft(device), self.leds(device), self.nmt(device));
        let controller = self.bus.line.controller(device + 1);
        let Some(one) = self.bus.devices().get(device) else {
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
            .with("plugged", self.bus.line.is_plugged(device + 1))
            .with("moves", self.clockwork.moves(device))
            .done()
    }

    /// Sets the rotary switches of the node ID (0–99) and the DIP switches of the bit rate
    /// (0–7); they are read at the next start.
    #[wasm_bindgen(js_name = setSwitches)]
    pub fn set_switches(&mut self, device: usize, node: u8, rate: u8) {
        self.bus.with(device, |device, now| {
            device.set_node_switch(node, now);
            device.set_bitrate_switch(rate, now);
        });
        self.collect();
    }

    /// Breaks something or mends it; answers whether this device has such a fault.
    #[wasm_bindgen(js_name = setFault)]
    pub fn set_fault(&mut self, device: usize, name: &str, broken: bool) -> bool {
        let found = self
            .bus
            .with(device, |device, now| device.set_fault(name, broken, now));
        self.collect();
        found.unwrap_or_default()
    }

    /// Lets a shaft follow a profile from now on: pairs of rpm and milliseconds. An empty one
    /// leaves the shaft as it is.
    pub fn follow(&mut self, device: usize, steps: &[f64], repeats: bool) {
        self.clockwork
            .follow(device, steps, repeats, self.bus.now());
    }

    /// Sends a frame every `micros` from now on; 0 ends it. `key` tells rhythms apart.
    pub fn repeat(
        &mut self,
        key: u32,
        id: u32,
        data: &[u8],
        extended: bool,
        remote: bool,
        micros: f64,
    ) {
        let Some(frame) = packed::make(id, data, extended, remote) else {
            return;
        };
        self.clockwork
            .repeat(key, frame, micros.max(0.0) as u64, self.bus.now());
    }

    /// The bytes of a device's EEPROM.
    pub fn eeprom(&mut self, device: usize) -> Vec<u8> {
        self.bus
            .with(device, |device, _| device.eeprom())
            .unwrap_or_default()
    }

    /// The bytes that the EEPROM would hold if everything were saved as it is now.
    pub fn image(&mut self, device: usize) -> Vec<u8> {
        self.bus
            .with(device, |device, _| device.image())
            .unwrap_or_default()
    }

    /// Hands a frame to one device alone, beside the wire; what it answers goes on the bus.
    pub fn deliver(&mut self, device: usize, id: u32, data: &[u8]) {
        let Some(frame) = packed::make(id, data, false, false) else {
            return;
        };
        self.bus
            .with(device, |device, now| device.handle_frame(now, &frame));
        self.collect();
    }

    /// Puts bytes into a device's EEPROM; they act at the next start.
    #[wasm_bindgen(js_name = setEeprom)]
    pub fn set_eeprom(&mut self, device: usize, bytes: &[u8]) {
        self.bus.with(device, |device, _| device.set_eeprom(bytes));
    }

    /// Lets a device's power go in the middle of a write to its EEPROM, after so many more bytes.
    #[wasm_bindgen(js_name = cutPowerAfter)]
    pub fn cut_power_after(&mut self, device: usize, bytes: usize) {
        self.bus
            .with(device, |device, _| device.cut_power_after(bytes));
    }

    /// The objects that would have another value after a power cycle, each as
    /// `index * 256 + sub`; with `saved`, those that are saved as they are.
    pub fn unsaved(&mut self, device: usize, saved: bool) -> Vec<u32> {
        let look = |device: &mut VirtualDevice| {
            if !device.is_powered() {
                return Vec::new();
            }
            let image = device.saved();
            let dictionary = device.dictionary();
            let of = |address: Address| device.is_unsaved(&image, address);
            let wanted = |address: &Address| of(*address) == Some(!saved);
            let addresses = dictionary.entries().iter().map(|entry| entry.address);
            let key = |address: Address| u32::from(address.index) << 8 | u32::from(address.sub);
            addresses.filter(wanted).map(key).collect()
        };
        self.bus
            .with(device, |device, _| look(device))
            .unwrap_or_default()
    }

    /// What the EEPROM would bring back for an object at the next start: its saved value, or
    /// its default; `null` where it is no object that is saved.
    #[wasm_bindgen(js_name = savedValue, unchecked_return_type = "Value")]
    pub fn saved_value(&mut self, device: usize, index: u16, sub: u8) -> JsValue {
        let address = Address::new(index, sub);
        let look = |device: &mut VirtualDevice| {
            let mut saved = device.saved();
            let data_type = device.dictionary().find(address).ok()?.data_type;
            Some(values::value(data_type, &saved.bytes(device, address)?))
        };
        self.bus
            .with(device, |device, _| look(device))
            .flatten()
            .unwrap_or(JsValue::NULL)
    }

    /// How the wire is: real or ideal, its terminators, the bit rate of the outside in kbit/s
    /// (none: that of the first device).
    #[wasm_bindgen(js_name = setLine)]
    pub fn set_line(&mut self, real: bool, terminators: u8, rate: Option<u16>) {
        let line = &mut self.bus.line;
        (line.is_real, line.terminators, line.bit_rate) = (real, terminators, rate);
    }

    /// Begins a new row of chances for what disturbs the wire; the same seed, the same row.
    #[wasm_bindgen(js_name = setSeed)]
    pub fn set_seed(&mut self, seed: u32) {
        self.bus.line.set_seed(seed.into());
    }

    /// Plugs a station in or out: 0 is the outside, devices count from 1.
    #[wasm_bindgen(js_name = setPlugged)]
    pub fn set_plugged(&mut self, station: usize, plugged: bool) {
        self.bus.line.set_plugged(station, plugged);
    }

    /// Starts the CAN controller of a station again after bus-off.
    #[wasm_bindgen(js_name = restartController)]
    pub fn restart_controller(&mut self, station: usize) {
        self.bus.restart_controller(station);
        self.collect();
    }

    /// How the wire is, with the controller of the outside.
    #[wasm_bindgen(unchecked_return_type = "LineStatus")]
    pub fn line(&self) -> JsValue {
        let line = &self.bus.line;
        let outside = line.controller(0);
        let rate = line
            .bit_rate
            .or_else(|| self.bus.devices().iter().find_map(powered_rate));
        Record::new()
            .with("real", line.is_real)
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

#[cfg(not(feature = "lessons"))]
impl Bus {
    /// Nobody takes a lesson here.
    pub(crate) fn saw(&mut self, _: Instant, _: Option<usize>, _: &od_runtime::Frame) {}

    pub(crate) fn lost(&mut self, _: Instant) {}

    pub(crate) fn look(&mut self) {}

    pub(crate) fn reached(&self) -> usize {
        0
    }
}

impl Bus {
    /// Lets time pass to `to`, with all that happens by itself, or less if the batch is full.
    pub(crate) fn pass(&mut self, to: Instant, full: usize) {
        let reached = self.reached();
        while self.batch.len() < full && self.reached() == reached {
            let due = self.clockwork.due().filter(|due| *due <= to);
            let target = due.unwrap_or(to).max(self.bus.now());
            let sent = self.bus.advance_until_sent(target);
            self.collect();
            if sent {
                continue;
            }
            match self.clockwork.take(self.bus.now()) {
                Some(tick) => {
                    if let Some(frame) = tick.happen(&mut self.bus, &mut self.batch) {
                        self.saw(self.bus.now(), None, &frame);
                    }
                    self.collect();
                }
                None if due.is_none() => return,
                None => {}
            }
        }
    }

    /// Takes what was disturbed on the wire into the batch.
    pub(crate) fn collect_trouble(&mut self) {
        while let Some(one) = self.bus.line.poll() {
            self.lost(one.at);
            let kind = match one.trouble {
                Trouble::NoAcknowledge => 1,
                Trouble::OtherBitRate => 2,
                Trouble::Reflections => 3,
            };
            let station = one.device.map_or(0, |device| device + 1);
            let [low, high] = self.bus.line.controller(station).transmit.to_le_bytes();
            let attempts = u8::try_from(one.attempts).unwrap_or(u8::MAX);
            let data = [
                kind,
                attempts,
                one.delivered.into(),
                one.bus_off.into(),
                low,
                high,
            ];
            packed::push_trouble(&mut self.batch, one.at, one.device, one.frame.id(), &data);
        }
    }
}
