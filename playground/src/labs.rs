//! The labs of the page: the master on the bench, and the physics of the bus line.

use od_sim::line::cable::{QUANTA, bit_time};
use od_sim::master::{Boot, BootState, Stage, concise};
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Crosses, record};

record! {
    /// A slave of the master on the bench.
    MasterSlave {
        node: u8,
        /// `waiting`, `booting`, `started`, `failed` or `lost`.
        state: &'static str,
        /// Number of the present stage of the boot process, counted from 0; 0 to 7.
        stage: usize,
        /// Error status of CiA 302-2, a letter; empty if it has not failed.
        status: &'static str,
        /// The error status in words.
        meaning: &'static str,
        /// The reason, with the values that differ; may be empty.
        reason: String,
        /// No boot-up message came within the boot time.
        silent: bool,
        /// Virtual microseconds at which the stages began.
        began: Vec<f64>,
        /// Whether the list expects a device type or an identity, has a configuration, a heartbeat.
        checks: Vec<bool>,
        /// Its configuration as a concise DCF (1F22h), in hexadecimal; empty without one.
        dcf: String,
    }

    /// The master on the bench.
    MasterState {
        /// Its list, as lines of a script without `master`.
        lines: Vec<String>,
        slaves: Vec<MasterSlave>,
    }

    /// The physics of the bus line. Times are in nanoseconds.
    CableState {
        /// Metres; 0 is the short line of a bench.
        length: u16,
        /// Percent of a bit.
        "samplePoint" sample_point: f64,
        /// Time quanta of 16.
        sjw: u8,
        /// Deviation of each station's clock in percent; the program side first.
        clocks: Vec<f64>,
        /// Bit rate in kbit/s.
        rate: u16,
        bit: f64,
        "sampleTime" sample_time: f64,
        "roundTrip" round_trip: f64,
        /// Metres.
        longest: f64,
        settling: f64,
        /// Percent between two clocks.
        tolerance: f64,
        quanta: u16,
    }
}

#[wasm_bindgen]
impl Bus {
    /// The master on the bench; `null` if it got no order yet.
    #[wasm_bindgen(unchecked_return_type = "MasterState | null")]
    pub fn master(&self) -> JsValue {
        let Some(master) = self.journal.rig.bus.master() else {
            return JsValue::NULL;
        };
        let plan = master.plan();
        let listed = plan.slaves.iter().map(|slave| slave.node);
        let others = master.boots().iter().map(|boot| boot.node);
        let others = others.filter(|node| plan.slave(*node).is_none());
        let slave = |node| {
            let known = plan.slave(node);
            let boot = master.boot(node);
            let status = boot.and_then(|boot| match boot.state {
                BootState::Failed(status) => Some(status),
                _ => None,
            });
            let downloads = known.map_or(&[][..], |slave| &slave.downloads);
            let dcf = concise(downloads)
                .into_iter()
                .map(|byte| format!("{byte:02X} "));
            MasterSlave {
                node: node.raw(),
                state: boot.map_or("waiting", |boot| boot.state.name()),
                stage: boot
                    .map_or(0, |boot| boot.stage as usize)
                    .min(Stage::ALL.len() - 1),
                status: status.map_or("", |status| status.letter()),
                meaning: status.map_or("", |status| status.text()),
                reason: boot.map_or(String::new(), |boot| boot.reason.clone()),
                silent: boot.is_some_and(|boot| boot.is_silent),
                began: boot.map_or(Vec::new(), times),
                checks: vec![
                    known.is_some_and(|slave| slave.device_type != 0),
                    known.is_some_and(|slave| slave.identity != [0; 4]),
                    !downloads.is_empty(),
                    known.is_some_and(|slave| slave.heartbeat > 0),
                ],
                dcf: if downloads.is_empty() {
                    String::new()
                } else {
                    dcf.collect()
                },
            }
        };
        let slaves = listed.chain(others).map(slave).collect();
        let lines = plan.lines();
        MasterState { lines, slaves }.value()
    }

    /// The physics of the bus line.
    #[wasm_bindgen(unchecked_return_type = "CableState")]
    pub fn cable(&self) -> JsValue {
        let bus = &self.journal.rig.bus;
        let cable = &bus.line.cable;
        let rates = bus.devices().iter().filter(|device| device.is_powered());
        let rate = bus
            .line
            .bit_rate
            .or_else(|| rates.clone().find_map(|one| one.bit_rate()));
        let rate = rate.unwrap_or(500);
        let stations = rates.count() + 1;
        let percent = |station| f64::from(cable.deviation(station)) / 10_000.0;
        let state = CableState {
            length: cable.length,
            sample_point: f64::from(cable.sample_point) / 10.0,
            sjw: cable.jump,
            clocks: (0..=bus.devices().len()).map(percent).collect(),
            rate,
            bit: bit_time(rate) as f64,
            sample_time: cable.sample_time(rate) as f64,
            round_trip: cable.round_trip(rate) as f64,
            longest: cable.longest(rate) as f64,
            settling: cable.settling(bus.line.terminators, stations) as f64,
            tolerance: f64::from(cable.tolerance()) / 10_000.0,
            quanta: QUANTA,
        };
        state.value()
    }
}

fn times(boot: &Boot) -> Vec<f64> {
    boot.began.iter().map(|at| at.as_micros() as f64).collect()
}
