//! Reads and writes objects over the bus; PDO mappings.

use od_client::sdo::Channel;
use od_model::Address;
use od_model::typed::MapEntry;
use od_sim::rig;
use od_sim::{pdos, words};
use od_wire::sdo::Response;
use od_wire::{CobId, Frame};
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Bytes, Crosses, Made, record, words};
use crate::device::valid;
use crate::frames::sentence;

words! {
    OutcomeKind {
        Done = "done",
        Aborted = "aborted",
        Silent = "silent",
        Failed = "failed",
    }

    MappingPart {
        DisablePdo = "disable PDO",
        DisableMapping = "disable mapping",
        Entry = "entry",
        EnableMapping = "enable mapping",
        EnablePdo = "enable PDO",
    }
}

record! {
    /// A completed transfer of `Bus.transfer`.
    Outcome {
        job: u32,
        kind: OutcomeKind,
        /// The value that was read; empty after a write, null after an error.
        bytes: Option<Bytes>,
        /// Reason why it failed; empty if the node did not respond.
        words: String,
        /// The abort may be due to a mapping change while the PDO is valid.
        "wantsPdoOff" wants_pdo_off: bool,
    }

    Mapped {
        index: u16,
        sub: u8,
        bits: u8,
    }

    /// Value of a COB-ID object of a PDO, with its meaning.
    PdoCobId {
        raw: u32,
        id: u32,
        valid: bool,
    }

    /// The current state of a PDO.
    Pdo {
        /// Index of its mapping parameter.
        mapping: u16,
        /// Index of its communication parameter.
        parameter: u16,
        transmits: bool,
        /// Counted from 1.
        number: u16,
        /// Value of its COB-ID object; null if the device has no power.
        "cobId" cob_id: Option<PdoCobId>,
        /// Maximum number of mapping entries.
        room: u8,
        /// Whether the mapping is read only.
        "isFixed" is_fixed: bool,
        entries: Made<Vec<Mapped>>,
    }

    /// An SDO download, and its frame.
    MappingStep {
        part: MappingPart,
        index: u16,
        sub: u8,
        bytes: Bytes,
        id: u32,
        data: Bytes,
        words: String,
    }
}

#[wasm_bindgen]
impl Bus {
    /// Starts to read an object over the bus as an SDO client, or to write it if there are bytes; the
    /// number is returned by an [`Outcome`](Self::outcomes). The node has 500 ms of virtual time
    /// for each response.
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

    /// The transfers that were completed since the last call.
    #[wasm_bindgen(unchecked_return_type = "Outcome[]")]
    pub fn outcomes(&mut self) -> Vec<JsValue> {
        let mut all = Vec::new();
        while let Some(one) = self.journal.rig.outcome() {
            all.push(self.outcome(one).value());
        }
        all
    }

    /// The current PDOs of a device, TPDOs first.
    #[wasm_bindgen(unchecked_return_type = "Pdo[]")]
    pub fn pdos(&self, device: usize) -> Vec<JsValue> {
        let device = self.device(device);
        let all = device.map(pdos::pdos).unwrap_or_default();
        all.iter().map(|one| pdo(one).value()).collect()
    }

    /// The SDO downloads that change a mapping to `entries`, as in 1A00h:01. With a COB-ID the
    /// PDO is not valid during the change.
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
            MappingStep {
                part: part(step.part),
                index: step.address.index,
                sub: step.address.sub,
                bytes: Bytes(step.bytes().to_vec()),
                id: frame.id().raw(),
                data: frame.data().into(),
                words: sentence(words::explain(devices, &frame)),
            }
        };
        steps.iter().map(|step| record(step).value()).collect()
    }

    fn outcome(&self, one: rig::Outcome) -> Outcome {
        let (kind, bytes, words, code) = match one.result {
            Ok(value) => (OutcomeKind::Done, Some(Bytes(value)), String::new(), 0),
            Err(od_client::Error::Silent) => (OutcomeKind::Silent, None, String::new(), 0),
            Err(od_client::Error::Abort(code)) => {
                let address = one.address;
                let abort = Response::Abort { address, code }.emit();
                let frame = Frame::full(Channel::of(one.node).response, abort);
                let text = sentence(words::explain(self.journal.rig.bus.devices(), &frame));
                (OutcomeKind::Aborted, None, text, code)
            }
            // The words of a `Response` would be much code for something that no node does.
            Err(od_client::Error::OutOfTurn { expected, .. }) => {
                let text = format!("{expected} was expected");
                (OutcomeKind::Failed, None, text, 0)
            }
            Err(_) => (OutcomeKind::Failed, None, "the transfer failed".into(), 0),
        };
        Outcome {
            job: one.job,
            kind,
            bytes,
            words,
            wants_pdo_off: pdos::wants_pdo_disabled(code),
        }
    }
}

fn pdo(one: &pdos::Pdo) -> Pdo {
    let cob_id = |id: CobId| PdoCobId {
        raw: id.raw(),
        id: id.can_id().raw(),
        valid: id.is_valid(),
    };
    let mapped = |entry: &MapEntry| Mapped {
        index: entry.address.index,
        sub: entry.address.sub,
        bits: entry.bits,
    };
    Pdo {
        mapping: one.mapping,
        parameter: one.parameter,
        transmits: one.transmits,
        number: one.number,
        cob_id: one.cob_id.map(cob_id),
        room: one.room,
        is_fixed: one.is_fixed,
        entries: Made::list(one.entries.iter().map(mapped)),
    }
}

const fn part(part: pdos::Part) -> MappingPart {
    match part {
        pdos::Part::DisablePdo => MappingPart::DisablePdo,
        pdos::Part::DisableMapping => MappingPart::DisableMapping,
        pdos::Part::Entry => MappingPart::Entry,
        pdos::Part::EnableMapping => MappingPart::EnableMapping,
        pdos::Part::EnablePdo => MappingPart::EnablePdo,
    }
}
