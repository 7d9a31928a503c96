//! The encoder as the [`Application`] of a node.

use od_model::{Address, Kind};

use super::configure::STEPS;
use super::faults::{self, Faults};
use super::motion::Motion;
use super::position::Angle;
use super::profile::{Family, OptionObject, Role};
use super::state::Encoder;
use super::timer::{EVENT_TIMER, TIMER};
use crate::application::{Application, Context, Reset};
use crate::number::number_in;
use crate::store::Store;
use od_wire::{AbortCode, Instant, NodeId};

/// Position value (CiA 406).
const POSITION: Address = Address::new(0x6004, 0);

impl<M: Motion, F: Family> Application for Encoder<M, F> {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        let starts = matches!(reset, Reset::PowerOn | Reset::Node);
        if starts {
            self.start(cx, reset);
        }
        if let Some(serial_number) = self.serial_number {
            for address in [Address::new(0x1018, 4), Address::new(0x650B, 0)] {
                cx.store.set_unsigned(address, serial_number.into());
            }
        }
        self.agree_on_links(cx.store);
        // The load has replaced the value that the gear showed in 6001h.
        self.output = None;
        self.configure(cx.store);
        if starts {
            self.shaft
                .start(cx.now, self.profile().counter, self.sensor);
        }
        self.agree_on_timer(cx, starts);
        self.show_time(cx);
    }

    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        let at = self.profile().object(Role::NodeId)?;
        let switches = match self.profile().switch_rates {
            [] => None,
            _ => NodeId::new(self.switches.node_id),
        };
        switches.or_else(|| NodeId::new(u8::try_from(store.unsigned(at.index, at.sub)).ok()?))
    }

    fn is_live(&self, address: Address) -> bool {
        address == POSITION || self.profile().role(address).is_some_and(Role::is_live)
    }

    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        if address == POSITION {
            let angle = self.read_angle(cx);
            let position = self.scale.position(angle);
            cx.store.set_unsigned(POSITION, position.into());
        } else if let Some(role) = self.profile().role(address)
            && role.is_live()
        {
            self.show(cx, address, role);
        }
        Ok(())
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        let number = match cx.store.dictionary().row_at(address) {
            Some(row) if row.data_type().kind() == Kind::Unsigned => number_in(value),
            _ => return Ok(()),
        };
        let profile = self.profile();
        match profile.role(address) {
            Some(Role::OneOf(list)) => in_list(list.iter().copied(), number)?,
            Some(Role::NodeId) => self.between(number, 1, 127)?,
            Some(Role::BitRate) => {
                let code = usize::try_from(number).unwrap_or(usize::MAX);
                let rate = profile.bit_rates.get(code);
                only(rate.is_some_and(|rate| *rate != 0))?;
            }
            Some(Role::InjectedError) if Self::PARTS.injected_error => {
                only(Faults::knows(profile.reports, number as u32))?
            }
            _ => {}
        }
        for (_, movement) in self.movements() {
            if movement.selector == Some(address) {
                in_list(movement.sources.iter().map(|(value, _)| *value), number)?;
            }
            if movement.factor.is_some_and(|(_, at)| at == address) {
                self.between(number, 1, u64::MAX)?;
            }
        }
        match self.link(address).index {
            0x6001 => self.between(number, 1, self.sensor.steps.into()),
            0x6002 => self.check_range(cx.store, number),
            0x6003 => self.between(number, 0, self.scale.range() - 1),
            index if profile.gear.is_some_and(|gear| gear.index == index) => {
                self.check_gear(cx.store, address.sub, number)
            }
            _ => Ok(()),
        }
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        let first = self.link(address);
        if first != address {
            let value = cx.store.unsigned(address.index, address.sub);
            cx.store.set_unsigned(first, value);
        }
        self.show_link(cx.store, first);
        self.restart_movements(cx, |movement| {
            movement.selector == Some(address) || movement.interval == address
        });
        match first.index {
            0x6000 => self.configure(cx.store),
            // The gear shows its own value again (MANUALS.md U-14).
            0x6001 if self.computes_resolution(cx.store) => self.configure(cx.store),
            0x6001 | 0x6002 => self.change_resolution(cx),
            0x6003 => {
                let preset = cx.store.unsigned(0x6003, 0) as u32;
                let angle = self.read_angle(cx);
                let offset = self.offset_for(angle, preset);
                self.set_offset(cx.store, offset);
                self.configure(cx.store);
            }
            index if self.is_acting_gear(cx.store, index) => self.change_resolution(cx),
            index if first == TIMER || self.profile().options.is_some_and(|o| o.index == index) => {
                self.timer_to_event_timer(cx);
            }
            _ if first == EVENT_TIMER => self.event_timer_to_timer(cx),
            _ => self.inject(cx, address),
        }
    }

    fn saving(&mut self, cx: &mut Context<'_, '_>, begins: bool) {
        if self.output.is_some() {
            cx.store.set_unsigned(STEPS, self.own_steps);
            if !begins {
                self.configure(cx.store);
            }
        }
    }

    fn error_info(&self, store: &Store<'_>) -> [u8; 5] {
        faults::info(store)
    }

    fn storage_is(&mut self, sound: bool) {
        self.faults.set_damaged(!sound);
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        if self.shaft.due().is_some() {
            self.read_angle(cx);
        }
        self.faults.report(cx, self.profile());
        let deadlines = [self.keep_time(cx), self.shaft.due()];
        deadlines.into_iter().flatten().min()
    }
}

impl<M: Motion, F: Family> Encoder<M, F> {
    /// Reads the sensor. Returns its angle; the last one if the sensor fails.
    fn read_angle(&mut self, cx: &mut Context<'_, '_>) -> Angle {
        let read = self.shaft.angle(cx.now);
        if self.faults.sensed(read.err(), self.profile().reports) {
            cx.signals.wake();
        }
        if let Ok(angle) = read {
            self.angle = angle;
        }
        self.angle
    }

    /// Updates a live value that is not the position.
    pub(super) fn show(&mut self, cx: &mut Context<'_, '_>, address: Address, role: &Role) {
        let value = match role {
            Role::Seconds => self.seconds_at(cx.now).into(),
            Role::TenthHours => (self.seconds_at(cx.now) / 360).into(),
            Role::SecondsSinceStart => self.seconds_since_start(cx.now).into(),
            Role::TenthHoursSinceStart => (self.seconds_since_start(cx.now) / 360).into(),
            Role::TimeStamp if Self::PARTS.time_stamp => self.micros(cx.now),
            // The object holds it modulo 2³² (MANUALS.md U-13).
            Role::RawPosition if Self::PARTS.raw_position => self.sensor.raw(self.read_angle(cx)),
            Role::Diagnosis(mirrors) if Self::PARTS.diagnosis => {
                mirrors.iter().fold(0, |bits, mirror| {
                    let of = cx.store.unsigned(mirror.from, 0);
                    bits | (of >> mirror.bit & 1) << mirror.shown
                })
            }
            Role::Movement(movement) if Self::PARTS.movement => {
                return self.show_movement(cx, address, movement);
            }
            _ => return,
        };
        cx.store.set_unsigned(address, value);
    }

    /// Applies a new resolution or range: the offset becomes 0 unless an option keeps it
    /// (MANUALS.md C-X-23, U-11).
    fn change_resolution(&mut self, cx: &mut Context<'_, '_>) {
        if !self.has_option(cx.store, |options| options.keep_offset) {
            self.set_offset(cx.store, 0);
        }
        self.configure(cx.store);
    }

    /// Applies an error or an offset that a test injects (manual 001, object 2116h).
    fn inject(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        match self.profile().role(address) {
            Some(Role::InjectedError) if Self::PARTS.injected_error => {
                let code = cx.store.unsigned(address.index, address.sub) as u32;
                self.faults.inject(self.profile().reports, code);
                self.faults.report(cx, self.profile());
            }
            Some(Role::InjectedOffset) if Self::PARTS.injected_offset => self.configure(cx.store),
            _ => {}
        }
    }

    /// Returns whether one of these bits of the manufacturer options is set.
    pub(super) fn has_option(
        &self,
        store: &Store<'_>,
        bits: impl Fn(&OptionObject) -> u32,
    ) -> bool {
        let Some(options) = &self.profile().options else {
            return false;
        };
        store.unsigned(options.index, 0) & u64::from(bits(options)) != 0
    }
}

/// Accepts a number of a list; others abort with 06090030h.
fn in_list(mut list: impl Iterator<Item = u8>, number: u64) -> Result<(), AbortCode> {
    only(list.any(|known| u64::from(known) == number))
}

/// Accepts a value that is known; others abort with 06090030h.
fn only(is_known: bool) -> Result<(), AbortCode> {
    if is_known {
        Ok(())
    } else {
        Err(AbortCode::ValueRange)
    }
}
