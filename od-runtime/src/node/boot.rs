//! Power-on, the two NMT resets, and how the services get their configuration.

use super::{BusEvent, Core, Event};
use crate::application::Reset;
use crate::objects::{Device, Objects, Outbox};
use crate::profile::{CommunicationReset, LssProfile};
use crate::storage::image::{self, Loaded};
use crate::store::StoreTooSmall;
use crate::{lss, pdo};
use od_wire::nmt::State;
use od_wire::{CobId, Frame, Instant};

impl<const PDO: usize, const SDO: usize> Core<PDO, SDO> {
    /// See [`Node::power_on`](super::Node::power_on).
    pub(super) fn power_on(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
    ) -> Result<(), StoreTooSmall> {
        let needed = device.dictionary.store_len();
        if device.values.len() < needed {
            return Err(StoreTooSmall { needed });
        }
        self.now = now;
        self.powered = true;
        self.mute = None;
        self.discard_frames();
        self.reset(device, outbox, now, Reset::PowerOn);
        Ok(())
    }

    /// Power goes: silence until [`power_on`](Self::power_on).
    pub(super) fn power_off(&mut self, outbox: &mut Outbox) {
        self.powered = false;
        self.drop_save(outbox);
        self.discard_frames();
        self.emcy.reset();
        self.sdo.forget();
        self.stop_pdos();
        self.state = State::Initialising;
        self.boot_at = None;
    }

    pub(super) fn reset(
        &mut self,
        device: &mut Device<'_>,
        outbox: &mut Outbox,
        now: Instant,
        reset: Reset,
    ) {
        let light = reset == Reset::Node && self.is_light(device, outbox, now);
        let delay = match reset {
            Reset::Node => device.profile.nmt.reset_node_us,
            Reset::Communication => device.profile.nmt.reset_communication_us,
            Reset::PowerOn | Reset::Defaults => 0,
        };
        self.sdo.forget();
        self.stop_pdos();
        self.heartbeat.stop();
        self.monitor.reset();
        self.lss = lss::Slave::new();
        if self.is_bus_off() {
            self.events.push(Event::BusOn);
        }
        self.mute = None;
        self.bus = BusEvent::Active;
        self.reset_due = false;
        self.lost = false;
        self.tick_at = None;
        self.state = State::Initialising;
        if light {
            // Nothing of the device is reset, and a save goes on.
            self.forget_bus_errors(device, outbox, now);
        } else {
            self.drop_save(outbox);
            if reset == Reset::Communication {
                self.forget_bus_errors(device, outbox, now);
            } else {
                self.emcy.reset();
            }
            self.load(device, outbox, now, reset);
        }
        self.events.push(Event::Reset(reset, self.node_id));
        self.boot_at = Some(now.plus_micros(delay.into()));
        if delay == 0 {
            self.boot_up(device, outbox, now);
        }
    }

    /// Does NMT reset node begin the NMT state alone anew?
    fn is_light(&self, device: &mut Device<'_>, outbox: &mut Outbox, now: Instant) -> bool {
        let switch = device.profile.nmt.reset_node_light;
        let objects = device.objects(self.node_id, now, outbox);
        objects.is_some_and(|objects| switch.is_some_and(|switch| objects.has_bits(switch)))
    }

    /// A save that was not complete will not be.
    fn drop_save(&mut self, outbox: &mut Outbox) {
        outbox.saving = None;
        self.save_at = None;
    }

    /// Defaults, then what storage holds. The node ID may be among it, and defaults hang
    /// on the node ID, so a new one means a second pass.
    fn load(&mut self, device: &mut Device<'_>, outbox: &mut Outbox, now: Instant, reset: Reset) {
        let all = reset != Reset::Communication;
        for pass in 0..2 {
            let Some(mut objects) = device.objects(self.node_id, now, outbox) else {
                return;
            };
            // Reset communication takes 1000h–1FFFh back, and what the device starts on the
            // bus with, or all that can be saved or written; it leaves the errors that last.
            let lss = objects.profile.lss;
            let scope = objects.profile.nmt.reset_communication;
            let which = |entry: &od_model::Entry| {
                let starts_with =
                    |lss: LssProfile| entry.address == lss.node_id || entry.address == lss.bit_rate;
                all || match entry.address.index {
                    0x1001 | 0x1003 => false,
                    0x1000..=0x1FFF => true,
                    _ if scope == CommunicationReset::Everything => {
                        image::is_kept(entry) || entry.access.writable()
                    }
                    _ => lss.is_some_and(starts_with),
                }
            };
            objects.store.reset(which);
            let profile = &objects.profile.store;
            let loaded = image::load(objects.storage, &mut objects.store, profile, &which);
            if pass == 0
                && !matches!(
                    loaded,
                    Ok(Loaded::Blank | Loaded::Complete | Loaded::Partial { .. })
                )
            {
                self.events.push(Event::StorageDamaged);
            }
            // A cut save is what power does to a memory that is sound.
            let sound = !matches!(loaded, Ok(Loaded::Damaged) | Err(_));
            objects.application.storage_is(sound);
            match objects.application.node_id(&objects.store) {
                Some(node_id) if node_id != self.node_id && pass == 0 => self.node_id = node_id,
                _ => {
                    objects.application(|application, context| application.reset(context, reset));
                    return;
                }
            }
        }
    }

    /// The end of initialisation: services take their configuration, the boot-up message
    /// goes out, Pre-operational begins.
    pub(super) fn boot_up(&mut self, device: &mut Device<'_>, outbox: &mut Outbox, now: Instant) {
        self.boot_at = None;
        let Some(mut objects) = device.objects(self.node_id, now, outbox) else {
            return;
        };
        self.configure(&mut objects);
        self.out.push(Frame::of(self.node_id.plus(0x700), &[0]));
        self.state = State::PreOperational;
        self.events.push(Event::State(self.state));
        self.heartbeat
            .configure(&objects.store, objects.profile, now);
        self.monitor.configure(&objects.store, objects.profile);
        self.tick_at = objects.application(|application, context| application.tick(context));
        let self_start = objects.profile.nmt.self_start;
        if self_start.is_some_and(|switch| objects.has_bits(switch)) {
            self.enter(&mut objects, State::Operational);
            self.react_to_lasting(&mut objects);
        }
        self.finish(&mut objects);
        self.reset_if_due(device, outbox, now);
    }

    /// Every service reads its objects again.
    pub(super) fn configure(&mut self, objects: &mut Objects<'_>) {
        let sync = objects.store.try_unsigned(0x1005, 0).unwrap_or(0x80);
        self.sync_id = CobId::new(sync as u32).can_id();
        self.tpdo_count = count(objects, 0x1800, PDO);
        self.rpdo_count = count(objects, 0x1400, PDO);
        for (number, tpdo) in self.tpdo.iter_mut().take(self.tpdo_count).enumerate() {
            if tpdo.configure(objects, number as u16) && self.state == State::Operational {
                tpdo.start(objects);
            }
        }
        let mut tpdos = self.tpdo.iter().take(self.tpdo_count);
        self.watches_changes =
            objects.profile.pdo.event_on_change && tpdos.any(pdo::Tpdo::watches_changes);
        for (number, rpdo) in self.rpdo.iter_mut().take(self.rpdo_count).enumerate() {
            rpdo.configure(objects, number as u16);
        }
    }
}

/// How many PDOs the dictionary has parameters for, from `first` on; those past the
/// node's room are not served.
fn count(objects: &Objects<'_>, first: u16, room: usize) -> usize {
    let dictionary = objects.store.dictionary();
    let last = (first..first + pdo::MAX)
        .rev()
        .find(|index| dictionary.object(*index).is_some());
    last.map_or(0, |last| usize::from(last - first) + 1)
        .min(room)
}
