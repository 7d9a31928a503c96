//! Power-on, the two NMT resets, and how the services get their configuration.

use od_model::row::Row;
use od_wire::nmt::State;
use od_wire::{CanId, CobId, Instant, NodeId};

use super::clocks::produced_time_id;
use super::{BusEvent, Event, Machines, Node};
use crate::application::{Application, Reset};
use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::device::Device;
use crate::emcy::RPDO_TIMEOUT;
use crate::objects::Objects;
use crate::profile::{CommunicationReset, LssProfile};
use crate::rooms::{Rooms, Saving, Sizes, Slave, Values};
use crate::storage::Storage;
use crate::storage::image::{self, Loaded};
use crate::{emcy, lss, sync};

impl<D: Device, A: Application, S: Storage> Node<D, A, S> {
    /// Switches the power on: the node loads the saved values or the defaults, and boots up.
    pub fn power_on(&mut self, now: Instant) {
        let node = &mut self.machines;
        if D::DICTIONARY.is_none() {
            let sizes = Sizes::of::<D>(&self.device.dictionary());
            node.rooms.fit(&sizes);
            self.values.fit(&sizes);
        }
        node.now = now;
        node.powered = true;
        node.mute = None;
        node.rooms.all_mut().frames.clear();
        self.call(now, |node, objects| node.reset(objects, Reset::PowerOn));
    }

    /// Ends an initialisation with a duration ([`NmtProfile::reset_node_us`]) at once, for a host
    /// whose clock starts at the boot-up and not at power-on.
    ///
    /// [`NmtProfile::reset_node_us`]: crate::NmtProfile::reset_node_us
    pub fn boot_at_once(&mut self, now: Instant) {
        self.call(now, |node, objects| {
            if node.boot_at.is_set() {
                node.boot_up(objects);
            }
        });
    }
}

impl<D: Device, A, S> Node<D, A, S> {
    /// Switches the power off: the node is silent until [`power_on`](Self::power_on).
    pub fn power_off(&mut self) {
        if let Some(saving) = self.values.lend().saving {
            *saving = Saving::BLANK;
        }
        let node = &mut self.machines;
        node.powered = false;
        node.idle = true;
        node.listeners = 0;
        node.next = Instant::ZERO;
        node.rooms.all_mut().frames.clear();
        node.emcy().reset();
        node.forget_transfers();
        node.stop_pdos();
        node.state = State::Initialising;
        node.boot_at = Deadline::NEVER;
    }
}

impl<D: Device> Machines<D> {
    /// Carries out a reset (CiA 301, chapter 7.3.2.2.1): stops all services, loads the values, and boots up, at once
    /// or after the time that the profile says.
    pub(super) fn reset(&mut self, objects: &mut Objects<'_, D>, reset: Reset) {
        let nmt = &objects.profile.nmt;
        let delay = match reset {
            Reset::PowerOn | Reset::Node => nmt.reset_node_us,
            Reset::Communication => nmt.reset_communication_us,
            Reset::Defaults => 0,
        };
        let switch = nmt.reset_node_light.filter(|_| reset == Reset::Node);
        let keeps_values = switch.is_some_and(|switch| objects.has_bits(switch));
        self.cut_transfers(objects);
        self.stop_pdos();
        self.heartbeat.stop();
        self.monitor().reset();
        let slaves = self.rooms.all_mut().lss;
        let pending = slaves.first().and_then(|lss| lss.node_id);
        slaves.fill(Slave::BLANK);
        if self.is_bus_off() {
            self.event(Event::BusOn);
        }
        self.mute = None;
        self.bus = BusEvent::Active;
        self.reset_due = false;
        self.lost = false;
        self.tick_at = Deadline::NEVER;
        self.wanted_changed = true;
        self.state = State::Initialising;
        if D::SYNC_PRODUCER {
            self.configure_clocks(objects);
        }
        let mut rate = None;
        if keeps_values {
            // Only the NMT state restarts, and a save continues.
            self.forget_bus_errors(objects);
        } else {
            // The reset ends an incomplete save; `load` detects it.
            objects.forget_save();
            if reset == Reset::Communication {
                self.forget_bus_errors(objects);
            } else {
                self.emcy().reset();
            }
            let bit_rate = self.take_own(objects, reset, pending);
            self.load(objects, reset);
            objects.restart(reset);
            rate = bit_rate;
        }
        self.event(Event::Reset(reset, self.node_id));
        if let Some(rate) = rate {
            self.event(Event::BitRate(rate));
        }
        self.boot_at = Deadline::at(objects.now.plus_micros(delay.into()));
        self.listen(objects);
        if delay == 0 {
            self.boot_up(objects);
        }
    }

    /// Sets the node ID of a device that has no object for it: the stored one at power-on and reset
    /// node, the pending one at reset communication (CiA 305, chapter 6.4.2). Returns the stored bit
    /// rate, except at reset communication.
    fn take_own(
        &mut self,
        objects: &mut Objects<'_, D>,
        reset: Reset,
        pending: Option<u8>,
    ) -> Option<u8> {
        if !D::LSS || !objects.profile.lss.is_some_and(|lss| lss.is_own()) {
            return None;
        }
        let (node_id, bit_rate) = match reset {
            Reset::PowerOn | Reset::Node => {
                let [node_id, bit_rate] = lss::stored(objects);
                let made_with = if self.made_unconfigured {
                    lss::UNCONFIGURED
                } else {
                    self.made_with.raw()
                };
                (node_id.or(Some(made_with)), bit_rate)
            }
            Reset::Communication | Reset::Defaults => (pending, None),
        };
        if let Some(node_id) = node_id {
            let node_id = NodeId::new(node_id);
            self.unconfigured = node_id.is_none();
            self.node_id = node_id.unwrap_or(self.node_id);
            objects.store.set_node_id(self.node_id);
        }
        bit_rate
    }

    /// Loads the defaults, then the saved values. If they set another node ID, a second pass loads
    /// everything again, because defaults may depend on the node ID.
    fn load(&mut self, objects: &mut Objects<'_, D>, reset: Reset) {
        let all = reset != Reset::Communication;
        // Reset communication restores 1000h to 1FFFh, except the errors (1001h, 1003h), and besides
        // them the objects of node ID and bit rate, or everything that can be saved or written.
        let profile = objects.profile;
        let is_loaded = |row: &Row| {
            let address = row.address();
            let starts_with = |lss: &LssProfile| address == lss.node_id || address == lss.bit_rate;
            all || match address.index {
                0x1001 | 0x1003 => false,
                0x1000..=0x1FFF => true,
                _ if profile.nmt.reset_communication == CommunicationReset::Everything => {
                    image::is_kept(row) || row.writable()
                }
                _ => D::LSS && profile.lss.as_ref().is_some_and(starts_with),
            }
        };
        for pass in 0..2 {
            profile.store.reset(&mut objects.store, &is_loaded);
            let loaded = if D::STORAGE {
                objects.load(&is_loaded)
            } else {
                Loaded::Blank
            };
            Self::forget_dynamic(objects);
            let news = match loaded {
                Loaded::Blank | Loaded::Complete => None,
                Loaded::Cut { factory } => Some(Event::SaveCut { factory }),
                other => Some(Event::Loaded(other)),
            };
            if let Some(event) = news.filter(|_| pass == 0) {
                self.event(event);
            }
            // After an interrupted save the memory is still sound.
            let sound = !matches!(loaded, Loaded::Damaged | Loaded::Foreign);
            objects.application.storage_is(sound);
            match objects.application.node_id(&objects.store) {
                Some(node_id) if node_id != self.node_id && pass == 0 => {
                    self.node_id = node_id;
                    objects.store.set_node_id(node_id);
                }
                _ => break,
            }
        }
    }

    /// Ends the initialisation: configures the services, sends the boot-up message, and enters
    /// Pre-operational.
    pub(super) fn boot_up(&mut self, objects: &mut Objects<'_, D>) {
        self.boot_at = Deadline::NEVER;
        if self.unconfigured {
            return self.listen(objects);
        }
        if D::GUARDING || D::CONSUMER {
            self.monitor()
                .configure::<D>(&objects.store, objects.profile);
        }
        self.configure(objects);
        self.push_error_control(0);
        self.state = State::PreOperational;
        self.event(Event::State(self.state));
        if D::SYNC_PRODUCER || D::TIME {
            self.configure_clocks(objects);
        }
        self.heartbeat
            .configure::<D>(&objects.store, objects.profile, objects.now);
        self.tick(objects);
        let self_start = objects.profile.nmt.self_start;
        if self_start.is_some_and(|switch| objects.has_bits(switch)) {
            self.enter(objects, State::Operational);
            self.react_to_active(objects);
        }
        self.finish(objects);
    }

    /// CAN-IDs with which SYNC, EMCY and TIME are sent; they have priority over those of SDO
    /// servers and TPDOs. The CAN-ID of SYNC is reserved for a consumer, too: all nodes would read
    /// a frame with it as SYNC.
    fn senders(objects: &Objects<'_, D>) -> [Option<CanId>; 3] {
        let store = &objects.store;
        let time = if D::TIME {
            produced_time_id(store)
        } else {
            None
        };
        [sync::can_id(store), emcy::can_id(store), time]
    }

    /// Reports SYNC, EMCY and TIME if their CAN-ID is refused: once, and again only after it was valid.
    fn report_refused(&mut self, objects: &Objects<'_, D>, senders: [Option<CanId>; 3]) {
        let [sync, emcy, time] = senders;
        let cob_id = |index| CobId::new(objects.store.word(index, 0, 0));
        let refused = [
            (0x1005, sync.is_none()),
            (
                0x1014,
                emcy.is_none() && objects.store.word(0x1014, 0, 1 << 31) >> 31 == 0,
            ),
            (
                0x1012,
                D::TIME && time.is_none() && cob_id(0x1012).produces_time(),
            ),
        ];
        for (at, (index, is_refused)) in refused.into_iter().enumerate() {
            let before = self.refused;
            self.refused = before & !(1 << at) | u8::from(is_refused) << at;
            if is_refused && before & 1 << at == 0 {
                self.event(Event::CobIdRefused(index));
            }
        }
    }

    /// Makes every service read its objects again.
    pub(super) fn configure(&mut self, objects: &mut Objects<'_, D>) {
        self.wanted_changed = true;
        self.sync_id = sync::can_id(&objects.store);
        self.sync_length = sync::Length::of(&objects.store);
        let senders = Self::senders(objects);
        self.report_refused(objects, senders);
        self.configure_servers(objects, senders);
        if D::SYNC_PRODUCER || D::TIME {
            self.configure_clocks(objects);
        }
        self.configure_tpdos(objects, senders);
        self.configure_rpdos(objects);
        self.listen(objects);
    }

    /// Configures the TPDOs. `senders` are the CAN-IDs with which other services send.
    fn configure_tpdos(&mut self, objects: &mut Objects<'_, D>, senders: [Option<CanId>; 3]) {
        let operates = self.state == State::Operational;
        let rooms = self.rooms.all_mut();
        let (mut first, mut changes, mut live) = (0, false, false);
        for at in 0..rooms.tpdos.len() {
            let Some((before, [tpdo, ..])) = rooms.tpdos.split_at_mut_checked(at) else {
                break;
            };
            let is_taken = |id| {
                senders.contains(&Some(id))
                    || rooms.servers.iter().any(|one| one.sent_by() == Some(id))
                    || before.iter().any(|pdo| pdo.sent_by() == Some(id))
            };
            let number = at as u16;
            if tpdo.configure(objects, number, first, rooms.mapped, &is_taken) {
                if operates {
                    tpdo.start(objects, rooms.mapped);
                }
                if D::EVENTS && tpdo.is_refused() {
                    rooms.events.push(Event::CobIdRefused(0x1800 + number));
                }
            }
            changes |= tpdo.watches_changes();
            live |= tpdo.watches_live();
            first += usize::from(objects.store.dictionary().last_sub(0x1A00 + number));
        }
        let sends_changes = D::CHANGES && objects.profile.pdo.event_on_change;
        (self.watches_changes, self.watches_live) =
            (changes && sends_changes, live && sends_changes);
    }

    fn configure_rpdos(&mut self, objects: &mut Objects<'_, D>) {
        let dictionary = objects.store.dictionary();
        let entries = |object| usize::from(dictionary.last_sub(object));
        let rooms = self.rooms.all_mut();
        let tpdos = 0x1A00..0x1A00 + rooms.tpdos.len() as u16;
        let mut first = tpdos.map(entries).sum();
        for (number, rpdo) in (0..).zip(rooms.rpdos) {
            if rpdo.configure(objects, number, first, rooms.mapped) && D::EVENTS {
                rooms.events.push(Event::CobIdRefused(0x1400 + number));
            }
            first += entries(0x1600 + number);
        }
        // A changed deadline (1400h:05) ends the error of a late RPDO.
        if D::DEADLINES && !self.rooms.all().rpdos.iter().any(|pdo| pdo.is_late()) {
            self.end_error(objects, RPDO_TIMEOUT);
        }
    }
}
