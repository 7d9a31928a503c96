//! A device that describes a node of a real bus: names and types come from its dictionary, values and state
//! from the frames of the bus. It sends nothing.

use std::prelude::v1::*;

use od_client::pdo::bits;
use od_client::watch;
use od_model::Address;
use od_runtime::{Frame, Instant};
use od_wire::nmt::{self, Command, State};
use od_wire::sdo::{self, Request, Response};

use crate::device::role::{Described, Role, Tpdo};
use crate::device::{VirtualDevice, pdos};
use crate::sdo::default_sdo;
use crate::words::fold;

impl VirtualDevice {
    /// Makes it the description of a node of a real bus, with the values of its file.
    #[must_use]
    pub(crate) fn describing(mut self) -> Self {
        // A node has room for its values from its first power-on.
        self.node.power_on(Instant::ZERO);
        self.node.power_off();
        while self.node.poll_event().is_some() {}
        self.node.look(|_, store| store.reset(|_| true));
        self.role = Role::Described(Box::default());
        self
    }

    /// Returns whether it only describes a node.
    pub fn is_described(&self) -> bool {
        self.described().is_some()
    }

    /// Knowledge of the node that it describes.
    fn described(&self) -> Option<&Described> {
        match &self.role {
            Role::Described(described) => Some(described),
            _ => None,
        }
    }

    fn described_mut(&mut self) -> Option<&mut Described> {
        match &mut self.role {
            Role::Described(described) => Some(described),
            _ => None,
        }
    }

    /// Returns the state of the node that it describes, as far as the bus has shown it.
    pub fn seen_state(&self) -> Option<State> {
        self.described()?.state
    }

    /// Returns whether the value of an object is the one of the node. It is not if the device describes a node of a real bus
    /// and the value was not seen yet: then it comes from the file.
    pub fn is_known(&self, address: Address) -> bool {
        let described = self.described();
        described.is_none_or(|one| one.known.contains_key(&address))
    }

    /// Returns the last value of an object that was seen on the bus.
    pub(crate) fn seen_value(&self, address: Address) -> Option<&[u8]> {
        let described = self.described()?;
        described.known.get(&address).map(Vec::as_slice)
    }

    /// Stores a value that was seen on the bus.
    pub fn learn(&mut self, address: Address, bytes: &[u8]) {
        let Self {
            node,
            role: Role::Described(described),
            ..
        } = self
        else {
            return;
        };
        node.look(|_, store| {
            let Ok(entry) = store.dictionary().find(address) else {
                return;
            };
            let size = entry.data_type.size().unwrap_or(bytes.len());
            let bytes = bytes.get(..size).unwrap_or(bytes);
            described.known.insert(address, bytes.to_vec());
            // The store has no room for a constant.
            let _ = store.put(&entry, bytes);
        });
        if (0x1800..0x1C00).contains(&address.index) {
            described.tpdos = None;
        }
    }

    /// Returns whether it describes the node that sent this frame.
    pub(crate) fn is_sender(&self, frame: &Frame) -> bool {
        let own = u16::from(self.node_id().raw());
        let id = frame.id().as_standard();
        self.is_described()
            && ([0x80, 0x580, 0x700]
                .map(|base| Some(base + own))
                .contains(&id)
                || self.tpdo(frame).is_some())
    }

    /// The TPDO of the node with this CAN-ID, if its TPDOs were looked up.
    fn tpdo(&self, frame: &Frame) -> Option<&Tpdo> {
        let all = self.described()?.tpdos.as_ref()?;
        all.iter().find(|pdo| pdo.id == frame.id())
    }

    fn look_up_tpdos(&mut self) {
        if !matches!(self.described(), Some(one) if one.tpdos.is_none()) {
            return;
        }
        let tpdo = |pdo: pdos::Pdo| {
            let id = pdo.cob_id.filter(|id| pdo.transmits && id.is_valid())?;
            (id.can_id().raw() != 0).then_some(Tpdo {
                id: id.can_id(),
                entries: pdo.entries,
            })
        };
        let all = pdos::pdos(self).into_iter().filter_map(tpdo).collect();
        if let Some(one) = self.described_mut() {
            one.tpdos = Some(all);
        }
    }

    /// Learns from a frame of the node's bus.
    pub(crate) fn observe(&mut self, frame: &Frame) {
        let node = self.node_id();
        if frame.id().raw() == 0 && !frame.id().is_extended() {
            return self.commanded(frame);
        }
        if let Some((_, state)) = watch::parse(frame).filter(|(sender, _)| *sender == node)
            && let Some(described) = self.described_mut()
        {
            // A node that has started has other values. After its boot-up message it is Pre-operational.
            if state == State::Initialising {
                described.known.clear();
            }
            described.state = Some(match state {
                State::Initialising => State::PreOperational,
                state => state,
            });
        }
        self.look_up_tpdos();
        if let Some(pdo) = self.tpdo(frame).filter(|_| !frame.is_remote()) {
            let pdo = pdo.clone();
            self.received(&pdo, frame);
        }
        match default_sdo(frame) {
            Some((server, is_response)) if server == node.raw() => self.sdo(frame, is_response),
            _ => {}
        }
    }

    /// Assumes that the node follows an NMT command; its next heartbeat corrects that.
    fn commanded(&mut self, frame: &Frame) {
        let node = self.node_id().raw();
        if let Some(command) = nmt::Repr::parse(frame.data())
            && [0, node].contains(&command.node)
            && let Some(described) = self.described_mut()
        {
            described.state = match command.command {
                Command::Start => Some(State::Operational),
                Command::Stop => Some(State::Stopped),
                Command::EnterPreOperational => Some(State::PreOperational),
                Command::ResetNode | Command::ResetCommunication => None,
            };
        }
    }

    /// Stores the values in a PDO of the node. It is Operational, since only then it sends PDOs.
    fn received(&mut self, pdo: &Tpdo, frame: &Frame) {
        if let Some(described) = self.described_mut() {
            described.state = Some(State::Operational);
        }
        let mut first = 0;
        for entry in &pdo.entries {
            let Some(value) = bits(frame.data(), first, entry.bits) else {
                return;
            };
            let len = usize::from(entry.bits.div_ceil(8));
            self.learn(entry.address, &value.to_le_bytes()[..len]);
            first += entry.bits;
        }
    }

    /// Stores the values in the SDO transfers of any client with the node.
    fn sdo(&mut self, frame: &Frame, is_response: bool) {
        let entry = self.dictionary().find(sdo::address(frame.bytes())).ok();
        let own = entry.and_then(|entry| entry.data_type.size());
        let Some(described) = self.described_mut() else {
            return;
        };
        described.count = described.count.wrapping_add(1);
        let number = described.count;
        if let Some(first) = described.folder.take(frame, number) {
            let done = described.folder.fold(first);
            if let Some(done) = done.filter(|one| one.state == fold::State::Done) {
                let (object, bytes) = (done.object, done.bytes.clone());
                described.folder.clear();
                self.learn(object, &bytes);
            }
            return;
        }
        if frame.data().len() < 8 {
            return;
        }
        let value =
            |bytes: [u8; 4], size: Option<u32>| bytes[..sdo::expedited_len(size, own)].to_vec();
        if !is_response {
            described.folder.forget_before(number);
            described.written = match Request::parse(frame.bytes()) {
                Request::InitiateDownload {
                    address,
                    size,
                    expedited: Some(bytes),
                } => Some((address, value(bytes, size))),
                _ => None,
            };
            return;
        }
        let seen = match Response::parse(frame.bytes()) {
            Response::InitiateUpload {
                address,
                size,
                expedited: Some(bytes),
            } => Some((address, value(bytes, size))),
            Response::InitiateDownload { address } => {
                let written = described.written.take();
                written.filter(|(object, _)| *object == address)
            }
            _ => None,
        };
        if let Some((address, bytes)) = seen {
            self.learn(address, &bytes);
        }
    }
}
