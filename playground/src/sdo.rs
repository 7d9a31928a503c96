//! Objects read and written over the bus, and PDO mappings.

use od_bench::rig::Outcome;
use od_bench::{pdos, words};
use od_client::sdo::{Channel, SdoError};
use od_model::Address;
use od_model::typed::MapEntry;
use od_wire::sdo::Response;
use od_wire::{CobId, Frame};
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::device::valid;
use crate::frames::sentence;
use crate::record::{Record, bytes, list};

#[wasm_bindgen]
impl Bus {
    /// Starts to read an object over the bus as an SDO client, or with bytes to write it; the
    /// number comes back in an [`Outcome`](Self::outcomes). The node has 500 ms of virtual time
    /// for each answer.
    ///
    /// # Errors
    /// The node ID is not 1 to 127.
    pub fn transfer(
        &mut self,
        node: u8,
        index: u16,
        sub: u8,
        bytes: Option<Vec<u8>>,
    ) -> Result<u32, JsError> {
        let (node, address) = (valid(node)?, Address::new(index, sub));
        let rig = &mut self.journal.rig;
        let job = match bytes {
            Some(bytes) => rig.write(node, address, &bytes),
            None => rig.read(node, address),
        };
        self.journal.send_requests();
        Ok(job)
    }

    /// The transfers that ended since the last call.
    #[wasm_bindgen(unchecked_return_type = "Outcome[]")]
    pub fn outcomes(&mut self) -> Vec<JsValue> {
        let mut all = Vec::new();
        while let Some(one) = self.journal.rig.outcome() {
            all.push(self.outcome(one));
        }
        all
    }

    /// The PDOs of a device as they are now, TPDOs first.
    #[wasm_bindgen(unchecked_return_type = "Pdo[]")]
    pub fn pdos(&self, device: usize) -> Vec<JsValue> {
        let device = self.device(device);
        let all = device.map(pdos::pdos).unwrap_or_default();
        all.iter().map(pdo).collect()
    }

    /// The SDO downloads that change a mapping to `entries`, as in 1A00h:01. With a COB-ID the
    /// PDO is not valid meanwhile.
    #[wasm_bindgen(js_name = mappingSteps, unchecked_return_type = "MappingStep[]")]
    pub fn mapping_steps(
        &self,
        device: usize,
        mapping: u16,
        entries: &[u32],
        cob_id: Option<u32>,
    ) -> Vec<JsValue> {
        let devices = self.journal.rig.bus.devices();
        let (Some(device), Some(_)) = (devices.get(device), pdos::of_mapping(mapping)) else {
            return Vec::new();
        };
        let entries: Vec<_> = entries.iter().copied().map(MapEntry::parse).collect();
        let steps = pdos::steps(mapping, &entries, cob_id.map(CobId::new));
        let record = |step: &pdos::Step| {
            let frame = step.frame(device.node_id());
            Record::new()
                .with("part", part(step.part))
                .with("index", step.address.index)
                .with("sub", step.address.sub)
                .with("bytes", bytes(&step.bytes()))
                .with("id", frame.id().raw())
                .with("data", bytes(frame.data()))
                .with("words", sentence(words::explain(devices, &frame)))
                .done()
        };
        steps.iter().map(record).collect()
    }

    fn outcome(&self, one: Outcome) -> JsValue {
        let (kind, value, text, code) = match one.result {
            Ok(value) => ("done", bytes(&value), String::new(), 0),
            Err(SdoError::Silent) => ("silent", JsValue::NULL, String::new(), 0),
            Err(SdoError::Abort(code)) => {
                let address = one.address;
                let abort = Response::Abort { address, code }.emit();
                let frame = Frame::full(Channel::of(one.node).response, abort);
                let text = sentence(words::explain(self.journal.rig.bus.devices(), &frame));
                ("aborted", JsValue::NULL, text, code)
            }
            // A `Response` in words would be a lot of code for what no node does.
            Err(SdoError::OutOfTurn { expected, .. }) => {
                let text = format!("{expected} was expected");
                ("failed", JsValue::NULL, text, 0)
            }
            Err(_) => ("failed", JsValue::NULL, "the transfer failed".into(), 0),
        };
        Record::new()
            .with("job", one.job)
            .with("kind", kind)
            .with("bytes", value)
            .with("words", text)
            .with("wantsPdoOff", pdos::wants_pdo_disabled(code))
            .done()
    }
}

fn pdo(one: &pdos::Pdo) -> JsValue {
    let cob_id = |id: CobId| {
        Record::new()
            .with("raw", id.raw())
            .with("id", id.can_id().raw())
            .with("valid", id.is_valid())
            .done()
    };
    let entries = one.entries.iter().map(|entry| {
        Record::new()
            .with("index", entry.address.index)
            .with("sub", entry.address.sub)
            .with("bits", entry.bits)
            .done()
    });
    Record::new()
        .with("mapping", one.mapping)
        .with("parameter", one.parameter)
        .with("transmits", one.transmits)
        .with("number", one.number)
        .with("cobId", one.cob_id.map_or(JsValue::NULL, cob_id))
        .with("room", one.room)
        .with("isFixed", one.is_fixed)
        .with("entries", list(entries))
        .done()
}

const fn part(part: pdos::Part) -> &'static str {
    match part {
        pdos::Part::DisablePdo => "disable PDO",
        pdos::Part::DisableMapping => "disable mapping",
        pdos::Part::Entry => "entry",
        pdos::Part::EnableMapping => "enable mapping",
        pdos::Part::EnablePdo => "enable PDO",
    }
}
