//! Power-on, the two NMT resets, and how the services get their configuration.

use od_model::row::Row;
use od_wire::nmt::State;
use od_wire::{CanId, CobId, Instant, NodeId};

use super::clocks::produced_time_id;
use super::ear::{Ear, Quick};
use super::{BusEvent, Event, Machines, Node, Unfit};
use crate::application::Reset;
use crate::deadline::Deadline;
use crate::device::{Device, profile};
use crate::extras::Extras;
use crate::lent::Lent;
use crate::objects::Objects;
use crate::profile::{CommunicationReset, LssProfile};
use crate::rooms::Room;
use crate::storage::image::{self, Loaded};
use crate::store::StoreTooSmall;
use crate::{emcy, lss, pdo, sync};

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// Power comes: the values become the saved ones or their defaults, and the node boots up.
    ///
    /// # Errors
    /// [`Unfit`] where `device.values` is too short for the dictionary, or the node does not
    /// serve all that the dictionary has ([`fits`](Self::fits)). The node stays without power.
    pub fn power_on(&mut self, device: &mut Lent<'_>, now: Instant) -> Result<(), Unfit> {
        match &D::DICTIONARY {
            // The compiler has checked it.
            Some(known) if known.is_same(&device.dictionary) => {}
            Some(_) => return Err(Unfit::Dictionary),
            None => Self::fits(&device.dictionary)?,
        }
        Ok(self.power_on_partly(device, now)?)
    }

    /// [`power_on`](Self::power_on) for a dictionary that need not fit, such as that of a file.
    /// PDOs, SDO servers and a SYNC producer without room are not served; a value
    /// longer than the SDO buffer answers with SDO abort 05040005h.
    ///
    /// # Errors
    /// [`StoreTooSmall`] where `device.values` is too short for the dictionary. The node stays
    /// without power.
    #[inline(never)]
    pub fn power_on_partly(
        &mut self,
        device: &mut Lent<'_>,
        now: Instant,
    ) -> Result<(), StoreTooSmall> {
        let needed = device.dictionary.store_len();
        if device.values.len() < needed {
            return Err(StoreTooSmall { needed });
        }
        let node = &mut self.machines;
        node.now = now;
        node.pending = 0;
        node.powered = true;
        node.mute = None;
        node.discard_frames();
        if let Some((node, objects)) = &mut self.open(device, now) {
            node.reset(objects, Reset::PowerOn);
        }
        Ok(())
    }

    /// Ends an initialisation that takes its time ([`NmtProfile::reset_node_us`]), at once: for a
    /// host whose clock starts when the node boots up, and not when power came.
    ///
    /// [`NmtProfile::reset_node_us`]: crate::NmtProfile::reset_node_us
    pub fn boot_at_once(&mut self, device: &mut Lent<'_>, now: Instant) {
        if let Some((node, objects)) = &mut self.open(device, now)
            && node.boot_at.is_set()
        {
            node.boot_up(objects);
        }
    }

    /// Power goes: silence until [`power_on`](Self::power_on).
    pub fn power_off(&mut self) {
        self.saves = Room::BLANK;
        let node = &mut self.machines;
        node.powered = false;
        node.save_at = Room::BLANK;
        // If nothing waits, no deadline remains either.
        node.next = Instant::ZERO;
        node.pending = 0;
        node.ear = Ear::DEAF;
        node.quick = Quick::NONE;
        node.discard_frames();
        node.emcy.reset();
        node.forget_transfers();
        node.stop_pdos();
        node.state = State::Initialising;
        node.boot_at = Deadline::NEVER;
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    #[inline(never)]
    pub(super) fn reset(&mut self, objects: &mut Objects<'_, D>, reset: Reset) {
        let nmt = &objects.profile().nmt;
        let delay = match reset {
            Reset::PowerOn | Reset::Node => nmt.reset_node_us,
            Reset::Communication => nmt.reset_communication_us,
            Reset::Defaults => 0,
        };
        // NMT reset node may restart the NMT state only.
        let light = nmt.reset_node_light.filter(|_| reset == Reset::Node);
        let light = light.is_some_and(|switch| objects.has_bits(switch));
        self.cut_transfers(objects);
        self.stop_pdos();
        self.heartbeat.stop();
        self.monitor.reset();
        let pending = self.lss.all().first().and_then(|lss| lss.node_id);
        self.lss = Room::BLANK;
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
        if light {
            // Nothing of the device is reset, and a save goes on.
            self.forget_bus_errors(objects);
        } else {
            // A save that was not complete will not be; `load` finds out.
            objects.forget_save();
            self.save_at = Room::BLANK;
            if reset == Reset::Communication {
                self.forget_bus_errors(objects);
            } else {
                self.emcy.reset();
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

    /// Node ID of a device without an object for it: a start takes the stored one, NMT reset
    /// communication the pending one (CiA 305, chapter 6.3.1). Returns the bit rate of a start.
    #[inline(never)]
    fn take_own(
        &mut self,
        objects: &mut Objects<'_, D>,
        reset: Reset,
        pending: Option<u8>,
    ) -> Option<u8> {
        if !D::LSS || !objects.profile().lss.is_some_and(|lss| lss.is_own()) {
            return None;
        }
        let (node_id, bit_rate) = match reset {
            Reset::PowerOn | Reset::Node => {
                let [node_id, bit_rate] = lss::stored(objects);
                let made_with = match self.made_unconfigured {
                    true => lss::UNCONFIGURED,
                    false => self.made_with.raw(),
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

    /// Defaults, then what storage holds. The node ID may be among it, and defaults hang
    /// on the node ID, so a new one means a second pass.
    #[inline(never)]
    fn load(&mut self, objects: &mut Objects<'_, D>, reset: Reset) {
        let all = reset != Reset::Communication;
        // Reset communication takes 1000h–1FFFh back, and what the device starts on the
        // bus with, or all that can be saved or written; it leaves the errors that last.
        let lent = objects.lent_profile;
        let which = |row: &Row| {
            // Not as a part of it that is carried in: of a profile that the compiler knows nothing is read.
            let profile = profile::<D>(lent);
            let address = row.address();
            let starts_with = |lss: &LssProfile| address == lss.node_id || address == lss.bit_rate;
            all || match address.index {
                0x1001 | 0x1003 => false,
                0x1000..=0x1FFF => true,
                _ if profile.nmt.reset_communication == CommunicationReset::Everything => {
                    image::is_kept(row) || row.writable()
                }
                _ => profile.lss.as_ref().is_some_and(starts_with),
            }
        };
        for pass in 0..2 {
            let profile = &objects.profile().store;
            match all {
                true => profile.reset_all(&mut objects.store),
                false => profile.reset(&mut objects.store, &which),
            }
            let loaded = match D::STORAGE {
                true => objects.load(&which),
                false => Loaded::Blank,
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
            // A cut save is what power does to a memory that is sound.
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

    /// The end of initialisation: services take their configuration, the boot-up message
    /// goes out, Pre-operational begins.
    #[inline(never)]
    pub(super) fn boot_up(&mut self, objects: &mut Objects<'_, D>) {
        self.boot_at = Deadline::NEVER;
        if self.unconfigured {
            return self.listen(objects);
        }
        self.configure(objects);
        self.push_error_control(0);
        self.state = State::PreOperational;
        self.listen(objects);
        self.event(Event::State(self.state));
        if D::SYNC_PRODUCER || D::TIME {
            self.configure_clocks(objects);
        }
        self.heartbeat
            .configure::<D>(&objects.store, objects.profile(), objects.now);
        if Self::HAS_MONITOR {
            self.monitor
                .configure::<D>(&objects.store, objects.profile());
        }
        self.tick(objects);
        let self_start = objects.profile().nmt.self_start;
        if self_start.is_some_and(|switch| objects.has_bits(switch)) {
            self.enter(objects, State::Operational);
            self.react_to_lasting(objects);
        }
        self.finish(objects);
        self.reset_if_due(objects);
    }

    /// The CAN-IDs by which SYNC, EMCY and TIME are sent, which come before those of SDO servers and TPDOs. That of
    /// SYNC counts for a consumer, too: what it sends by it is a SYNC for all others.
    pub(super) fn senders(objects: &Objects<'_, D>) -> [Option<CanId>; 3] {
        let store = &objects.store;
        let time = if D::TIME {
            produced_time_id(store)
        } else {
            None
        };
        [sync::can_id(store), emcy::can_id(store), time]
    }

    /// Reports the services of one object whose CAN-ID is refused, once as long as it is.
    #[inline(never)]
    fn report_refused(&mut self, objects: &Objects<'_, D>) {
        let [sync, emcy, time] = Self::senders(objects);
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

    /// Every service reads its objects again.
    #[inline(never)]
    pub(super) fn configure(&mut self, objects: &mut Objects<'_, D>) {
        self.wanted_changed = true;
        self.sync_id = sync::can_id(&objects.store);
        self.report_refused(objects);
        if Self::PDOS.is_none() {
            let dictionary = objects.store.dictionary();
            self.tpdo_count = dictionary.tpdos().min(PDO) as u16;
            self.rpdo_count = dictionary.rpdos().min(Self::RPDOS) as u16;
        }
        let operates = self.state == State::Operational;
        let fixed = const { &pdo::Fixed::all::<D, PDO>() };
        self.configure_servers(objects);
        if D::SYNC_PRODUCER || D::TIME {
            self.configure_clocks(objects);
        }
        let others = Self::senders(objects);
        let count = self.tpdo_count();
        for (at, fixed) in fixed.iter().enumerate().take(count) {
            let Some((before, [tpdo, ..])) = self.tpdo.split_at_mut_checked(at) else {
                break;
            };
            let servers = self.extras.servers();
            let is_taken = |id| {
                others.contains(&Some(id))
                    || D::SERVERS && servers.iter().any(|one| one.sent_by() == Some(id))
                    || before.iter().any(|pdo| pdo.sent_by() == Some(id))
            };
            if tpdo.configure(objects, at as u16, fixed, &is_taken) {
                let (starts, refused) = (operates, tpdo.is_refused());
                if starts {
                    tpdo.start(objects);
                }
                if refused {
                    self.event(Event::CobIdRefused(0x1800 + at as u16));
                }
            }
        }
        if D::CHANGES && objects.profile().pdo.event_on_change {
            let (mut changes, mut live) = (false, false);
            for pdo in self.tpdos() {
                changes |= pdo.watches_changes();
                live |= pdo.watches_live();
            }
            (self.watches_changes, self.watches_live) = (changes, live);
        }
        if D::RPDOS {
            for at in 0..self.rpdo_count() {
                let rpdo = self.rpdo.all_mut().get_mut(at);
                if rpdo.is_some_and(|rpdo| rpdo.configure(objects, at as u16)) {
                    self.event(Event::CobIdRefused(0x1400 + at as u16));
                }
            }
        }
        self.listen(objects);
    }
}
