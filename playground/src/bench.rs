//! Actions of a user at the bench: power, shafts, switches, faults, EEPROMs, bus line.

use od_sim::journal::frame;
use od_sim::rig::Rig;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;

impl Bus {
    /// The bench, for a call that acts on it: a step of a lesson waits for an act.
    pub(crate) fn acting(&mut self) -> &mut Rig {
        self.journal.rig.note_act();
        &mut self.journal.rig
    }
}

#[wasm_bindgen]
impl Bus {
    /// Switches the power.
    #[wasm_bindgen(js_name = setPower)]
    pub fn set_power(&mut self, device: usize, on: bool) {
        self.acting().set_power(device, on);
    }

    /// Turns the shaft at a speed.
    #[wasm_bindgen(js_name = setRpm)]
    pub fn set_rpm(&mut self, device: usize, rpm: f64) {
        self.acting()
            .with(device, |device, now| device.set_rpm(rpm, now));
    }

    /// Moves the shaft to a number of revolutions from the sensor's zero point, at once.
    #[wasm_bindgen(js_name = turnTo)]
    pub fn turn_to(&mut self, device: usize, turns: f64) {
        self.acting()
            .with(device, |device, now| device.turn_to(turns, now));
    }

    /// Sets the rotary switches of the node ID (0–99) and the DIP switches of the bit rate
    /// (0–7); they are read at the next start.
    #[wasm_bindgen(js_name = setSwitches)]
    pub fn set_switches(&mut self, device: usize, node: u8, rate: u8) {
        self.acting().with(device, |device, now| {
            device.set_node_switch(node, now);
            device.set_bitrate_switch(rate, now);
        });
    }

    /// Sets or clears a fault; returns whether this device has such a fault.
    #[wasm_bindgen(js_name = setFault)]
    pub fn set_fault(&mut self, device: usize, name: &str, broken: bool) -> bool {
        let found = self
            .acting()
            .with(device, |device, now| device.set_fault(name, broken, now));
        found.unwrap_or_default()
    }

    /// Lets a shaft follow a profile from now on: pairs of rpm and milliseconds. An empty profile
    /// leaves the shaft as it is.
    pub fn follow(&mut self, device: usize, steps: &[f64], repeats: bool) {
        self.acting().follow(device, steps, repeats);
    }

    /// Sends a frame every `micros` from now on; 0 ends it. `key` identifies the cyclic frame.
    pub fn repeat(
        &mut self,
        key: u32,
        id: u32,
        data: &[u8],
        extended: bool,
        remote: bool,
        micros: f64,
    ) {
        if let Some(frame) = frame(id, data, extended, remote) {
            self.acting().repeat(key, frame, micros.max(0.0) as u64);
        }
    }

    /// The bytes that the EEPROM would contain after a save now.
    pub fn image(&mut self, device: usize) -> Vec<u8> {
        self.journal
            .rig
            .with(device, |device, _| device.image())
            .unwrap_or_default()
    }

    /// Gives a frame to one device only, without the bus; its response is sent on the bus.
    pub fn deliver(&mut self, device: usize, id: u32, data: &[u8]) {
        let Some(frame) = frame(id, data, false, false) else {
            return;
        };
        self.acting()
            .with(device, |device, now| device.handle_frame(now, &frame));
    }

    /// Writes bytes to a device's EEPROM; they take effect at the next start.
    #[wasm_bindgen(js_name = setEeprom)]
    pub fn set_eeprom(&mut self, device: usize, bytes: &[u8]) {
        self.acting()
            .with(device, |device, _| device.set_eeprom(bytes));
    }

    /// Cuts the power of a device during a write to its EEPROM, after this number of bytes.
    #[wasm_bindgen(js_name = cutPowerAfter)]
    pub fn cut_power_after(&mut self, device: usize, bytes: usize) {
        self.acting()
            .with(device, |device, _| device.cut_power_after(bytes));
    }

    /// Sets the bus line: real or ideal, its terminators, the bit rate of the program side in kbit/s
    /// (none: that of the first device).
    #[wasm_bindgen(js_name = setLine)]
    pub fn set_line(&mut self, real: bool, terminators: u8, rate: Option<u16>) {
        let line = &mut self.acting().bus.line;
        line.set_real(real);
        (line.terminators, line.bit_rate) = (terminators, rate);
    }

    /// Seeds the random disturbances of the bus line. The same seed gives the same sequence.
    #[wasm_bindgen(js_name = setSeed)]
    pub fn set_seed(&mut self, seed: u32) {
        self.journal.rig.bus.line.set_seed(seed.into());
    }

    /// Connects or disconnects a participant: 0 is the program, devices count from 1.
    #[wasm_bindgen(js_name = setPlugged)]
    pub fn set_plugged(&mut self, station: usize, plugged: bool) {
        self.acting().bus.line.set_plugged(station, plugged);
    }

    /// Restarts the CAN controller of a participant after bus-off.
    #[wasm_bindgen(js_name = restartController)]
    pub fn restart_controller(&mut self, station: usize) {
        self.acting().bus.restart_controller(station);
        self.journal.rig.collect_frames();
    }
}
