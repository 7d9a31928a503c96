//! One axis: its modes, its supervision, and the values of its objects.

use odkit::{AbortCode, Address, Store};

use super::STEP;
use super::homing::{Homing, METHODS};
use super::motion::{Limits, Motion, UNIT, within};
use super::state::{Command, FOLLOWING_ERROR, LOST, SAFE_TORQUE_OFF, State, Transition};

/// Modes of operation (CiA 402, 6060h).
pub(super) mod mode {
    pub(crate) const NONE: i64 = 0;
    pub(crate) const PROFILE_POSITION: i64 = 1;
    pub(crate) const PROFILE_VELOCITY: i64 = 3;
    pub(crate) const HOMING: i64 = 6;
    pub(crate) const INTERPOLATED_POSITION: i64 = 7;
    pub(crate) const CYCLIC_POSITION: i64 = 8;
    pub(crate) const CYCLIC_VELOCITY: i64 = 9;
}
use mode::{
    CYCLIC_POSITION, CYCLIC_VELOCITY, HOMING, INTERPOLATED_POSITION, NONE, PROFILE_POSITION,
    PROFILE_VELOCITY,
};

/// Bits of the controlword that a mode reads.
mod control {
    /// 0 is the command quick stop.
    pub(super) const QUICK_STOP: u16 = 1 << 2;
    /// New set-point, start of homing, or start of interpolation.
    pub(super) const START: u16 = 1 << 4;
    pub(super) const AT_ONCE: u16 = 1 << 5;
    pub(super) const RELATIVE: u16 = 1 << 6;
    pub(super) const RESET: u16 = 1 << 7;
    pub(super) const HALT: u16 = 1 << 8;
}

/// Bits of the statusword besides the state.
mod status {
    pub(super) const REMOTE: u16 = 1 << 9;
    pub(super) const REACHED: u16 = 1 << 10;
    pub(super) const LIMIT: u16 = 1 << 11;
    /// Set-point acknowledged, speed zero, homing attained, interpolation active, command followed.
    pub(super) const OF_MODE: u16 = 1 << 12;
    /// Following error, homing error.
    pub(super) const ERROR: u16 = 1 << 13;
}

/// Deceleration of a shaft without torque, in units per second².
const FRICTION: i64 = 100_000;

/// Inputs of an axis that do not come from the bus.
#[derive(Clone, Copy, Debug, Default)]
pub struct World {
    /// The negative limit switch is active.
    pub negative_limit: bool,
    /// The positive limit switch is active.
    pub positive_limit: bool,
    /// The home switch is active.
    pub home: bool,
    /// Safe torque off.
    pub is_safe: bool,
    /// Something holds the shaft.
    pub is_held: bool,
}

impl World {
    #[cfg(feature = "machines")]
    /// Sets the input with this number among the connections of an axis.
    pub(super) fn set(&mut self, number: usize, on: bool) {
        match number {
            0 => self.negative_limit = on,
            1 => self.positive_limit = on,
            2 => self.home = on,
            3 => self.is_safe = on,
            4 => self.is_held = on,
            _ => {}
        }
    }

    /// Bits 0 to 3 of 60FDh: limit switches, home switch, interlock.
    fn bits(self) -> i64 {
        i64::from(self.negative_limit)
            | i64::from(self.positive_limit) << 1
            | i64::from(self.home) << 2
            | i64::from(self.is_safe) << 3
    }
}

/// A stop in progress.
#[derive(Clone, Copy, Debug)]
struct Stop {
    /// Deceleration in units per second².
    deceleration: i64,
    /// State after the stop; `None`: the present one.
    then: Option<State>,
}

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Distance of its objects from those of the first axis.
    base: u16,
    /// Its switches.
    pub world: World,
    state: State,
    stop: Option<Stop>,
    error: Option<u16>,
    controlword: u16,
    mode: i64,
    pub(super) demand: Motion,
    pub(super) actual: Motion,
    /// Position of the shaft where the position value is 0, in millionths of a unit.
    zero: i64,
    /// Target of the profile position mode.
    target: i64,
    is_moving: bool,
    /// The set-point after the present one.
    next: Option<i64>,
    is_acknowledged: bool,
    /// End of the present interpolation, and the steps until then.
    course: Option<(i64, i64)>,
    pub(super) homing: Homing,
    /// Numbers of steps: since the following error is too great, since the target is reached, since
    /// the shaft is at rest.
    late: u32,
    reached: u32,
    standing: u32,
    /// A limit stops the axis.
    pub(super) is_limited: bool,
}

impl Axis {
    pub(super) const fn new(base: u16) -> Self {
        Self {
            base,
            world: World {
                negative_limit: false,
                positive_limit: false,
                home: false,
                is_safe: false,
                is_held: false,
            },
            state: State::SwitchOnDisabled,
            stop: None,
            error: None,
            controlword: 0,
            mode: NONE,
            demand: Motion::ZERO,
            actual: Motion::ZERO,
            zero: 0,
            target: 0,
            is_moving: false,
            next: None,
            is_acknowledged: false,
            course: None,
            homing: Homing::Idle,
            late: 0,
            reached: 0,
            standing: 0,
            is_limited: false,
        }
    }

    /// The value of an object of this axis.
    pub(super) fn get(&self, store: &Store<'_>, index: u16) -> i64 {
        self.sub(store, index, 0)
    }

    pub(super) fn sub(&self, store: &Store<'_>, index: u16, sub: u8) -> i64 {
        store.signed(index + self.base, sub)
    }

    fn put(&self, store: &mut Store<'_>, index: u16, value: i64) {
        store.set_unsigned(Address::new(index + self.base, 0), value as u64);
    }

    /// The active error.
    pub(super) const fn error(&self) -> Option<u16> {
        self.error
    }

    /// Returns whether it needs a call in every step.
    pub(super) const fn is_busy(&self) -> bool {
        self.state.has_torque() || self.actual.speed != 0
    }

    /// Handles power-on and NMT reset node: the shaft keeps its angle, which gives the position.
    pub(super) fn reset(&mut self, store: &Store<'_>) {
        let shaft = Motion {
            position: self.actual.position + self.zero,
            speed: 0,
        };
        *self = Self {
            world: self.world,
            demand: shaft,
            actual: shaft,
            target: shaft.position,
            ..Self::new(self.base)
        };
        self.mode = self.get(store, 0x6060);
    }

    /// Angle of the shaft in 2⁻³² revolutions. A revolution has 10,000 units, the default of 2000h.
    pub(super) fn shaft(&self) -> i64 {
        let place = i128::from(self.actual.position + self.zero);
        ((place << 32) / i128::from(REVOLUTION)) as i64
    }

    #[cfg(feature = "machines")]
    pub(super) fn pin(&self, number: usize) -> i64 {
        match number {
            5 => self.shaft(),
            6 => self.state.has_torque().into(),
            _ => self.world_pin(number).into(),
        }
    }

    #[cfg(feature = "machines")]
    const fn world_pin(&self, number: usize) -> bool {
        match number {
            0 => self.world.negative_limit,
            1 => self.world.positive_limit,
            2 => self.world.home,
            3 => self.world.is_safe,
            _ => self.world.is_held,
        }
    }

    /// Checks values by rules that limits of the dictionary cannot express.
    pub(super) fn validate(&self, index: u16, sub: u8, value: &[u8]) -> Result<(), AbortCode> {
        let number = value.first().map_or(0, |byte| i64::from(*byte as i8));
        let is_valid = match (index, sub) {
            (0x6060, 0) => matches!(number, 0 | 1 | 3 | 6..=9),
            (0x605A, 0) => matches!(number, 0..=2 | 5 | 6),
            (0x6098, 0) => number == 0 || METHODS.contains(&number),
            _ => true,
        };
        if is_valid {
            Ok(())
        } else {
            Err(AbortCode::ValueRange)
        }
    }

    /// Handles an object that a master wrote.
    pub(super) fn written(&mut self, store: &mut Store<'_>, index: u16, sub: u8) {
        let is_cyclic = match index {
            0x6040 => return self.control(store),
            0x60FF => {
                self.reached = 0;
                false
            }
            0x607A => self.mode == CYCLIC_POSITION,
            0x60C1 => self.mode == INTERPOLATED_POSITION && sub == 1,
            _ => false,
        };
        if is_cyclic {
            let target = self.inside(store, self.sub(store, index, sub));
            self.course = Some((target, self.period(store)));
        }
    }

    /// Number of steps of the interpolation time period (60C2h).
    fn period(&self, store: &Store<'_>) -> i64 {
        let exponent = self.sub(store, 0x60C2, 2).clamp(-6, 0) + 6;
        let micros = self.sub(store, 0x60C2, 1) * 10_i64.pow(exponent as u32);
        (micros / STEP as i64).max(1)
    }

    /// The sign between position (or speed) values and the shaft (607Eh).
    fn sign(&self, store: &Store<'_>, bit: u32) -> i64 {
        1 - 2 * (self.get(store, 0x607E) >> bit & 1)
    }

    /// A position value in the units of the demand, within the software limits (607Dh).
    fn inside(&mut self, store: &Store<'_>, value: i64) -> i64 {
        let (low, high) = (self.sub(store, 0x607D, 1), self.sub(store, 0x607D, 2));
        let limited = value.max(low).min(high.max(low));
        self.is_limited |= limited != value;
        limited * UNIT * self.sign(store, 7)
    }

    /// The speed of an object in the units of the demand.
    pub(super) fn speed(&self, store: &Store<'_>, index: u16, sub: u8) -> i64 {
        let most = self.get(store, 0x607F);
        within(self.sub(store, index, sub), most) * UNIT
    }

    /// Limits of the profile modes.
    fn limits(&self, store: &Store<'_>, speed: u16) -> Limits {
        Limits {
            speed: self.speed(store, speed, 0),
            acceleration: self.get(store, 0x6083),
            deceleration: self.get(store, 0x6084),
        }
    }

    /// Handles the controlword.
    fn control(&mut self, store: &mut Store<'_>) {
        let word = self.get(store, 0x6040) as u16;
        let rising = word & !self.controlword;
        if (word ^ self.controlword) & control::HALT != 0 {
            self.reached = 0;
        }
        self.controlword = word;
        // 15
        if rising & control::RESET != 0 && self.state == State::Fault && !self.world.is_safe {
            self.error = None;
            self.put(store, 0x603F, 0);
            self.enter(State::SwitchOnDisabled);
        }
        self.obey(store);
        if self.state == State::OperationEnabled && rising & control::START != 0 {
            self.start(store);
        }
    }

    /// Carries out the command of the controlword, which stays until another one is written.
    fn obey(&mut self, store: &mut Store<'_>) {
        let command = Command::of(self.controlword);
        // "Enable operation" may follow "switch on" in one command.
        for _ in 0..2 {
            let is_stopping = self.state == State::QuickStopActive && self.stop.is_some();
            if is_stopping && command != Command::DisableVoltage {
                break;
            }
            match self.state.transition(command) {
                Some(Transition::To(state)) => self.enter(state),
                Some(Transition::QuickStop) => self.quick_stop(store),
                Some(Transition::Shutdown) => {
                    self.stop_by(store, 0x605B, State::ReadyToSwitchOn);
                }
                Some(Transition::DisableOperation) => {
                    self.stop_by(store, 0x605C, State::SwitchedOn);
                }
                None if command == Command::EnableOperation => {
                    // A stop before another state is cancelled.
                    self.stop = None;
                    break;
                }
                None => break,
            }
        }
    }

    /// A rising edge of bit 4: a new set-point, or homing.
    fn start(&mut self, store: &Store<'_>) {
        match self.mode {
            PROFILE_POSITION => {
                let value = self.get(store, 0x607A);
                let last = self.next.unwrap_or(self.target);
                let target = if self.controlword & control::RELATIVE != 0 {
                    let before = last / UNIT * self.sign(store, 7);
                    self.inside(store, before + value)
                } else {
                    self.inside(store, value)
                };
                if !self.is_moving || self.controlword & control::AT_ONCE != 0 {
                    (self.target, self.is_moving, self.next) = (target, true, None);
                } else if self.next.is_none() {
                    self.next = Some(target);
                } else {
                    return;
                }
                (self.is_acknowledged, self.reached) = (true, 0);
            }
            HOMING => self.start_homing(store),
            _ => {}
        }
    }

    /// Enters a state: the demand begins at the position of the shaft.
    fn enter(&mut self, state: State) {
        let had_torque = self.state.has_torque();
        self.state = state;
        self.stop = None;
        if !state.has_torque() || !had_torque {
            self.demand = self.actual;
            self.forget();
        }
    }

    /// Resets the modes.
    fn forget(&mut self) {
        (self.target, self.is_moving, self.next) = (self.demand.position, false, None);
        (self.is_acknowledged, self.course) = (false, None);
        self.homing = Homing::Idle;
        (self.late, self.reached) = (0, 0);
    }

    /// Stops the axis in transitions 5 and 8, by the option code of an object.
    fn stop_by(&mut self, store: &Store<'_>, code: u16, then: State) {
        if self.get(store, code) == 0 {
            return self.enter(then);
        }
        self.stop = Some(Stop {
            deceleration: self.get(store, 0x6084),
            then: Some(then),
        });
    }

    /// Stops the axis in transition 11, by the quick stop option code.
    fn quick_stop(&mut self, store: &Store<'_>) {
        let code = self.get(store, 0x605A);
        if code == 0 {
            return self.enter(State::SwitchOnDisabled);
        }
        self.state = State::QuickStopActive;
        self.stop = Some(Stop {
            deceleration: self.get(store, if code % 4 == 1 { 0x6084 } else { 0x6085 }),
            then: (code < 5).then_some(State::SwitchOnDisabled),
        });
    }

    /// Stops the axis in transitions 13 and 14, by the fault reaction option code.
    fn fault(&mut self, store: &mut Store<'_>, code: u16) {
        if matches!(self.state, State::Fault | State::FaultReactionActive) {
            return;
        }
        self.error = Some(code);
        self.put(store, 0x603F, code.into());
        let reaction = self.get(store, 0x605E);
        if reaction == 0 || code == SAFE_TORQUE_OFF || !self.state.has_torque() {
            return self.enter(State::Fault);
        }
        self.state = State::FaultReactionActive;
        self.stop = Some(Stop {
            deceleration: self.get(store, if reaction == 1 { 0x6084 } else { 0x6085 }),
            then: Some(State::Fault),
        });
    }

    /// Reacts to the loss of the master by the abort connection option code (6007h).
    pub(super) fn abort_connection(&mut self, store: &mut Store<'_>) {
        match (self.get(store, 0x6007), self.state) {
            (_, State::SwitchOnDisabled | State::Fault | State::FaultReactionActive) => {}
            (1, _) => self.fault(store, LOST),
            (2, _) => self.enter(State::SwitchOnDisabled),
            (3, State::OperationEnabled) => {
                // The last command must not end the stop: the axis would move again.
                self.controlword &= !control::QUICK_STOP;
                self.quick_stop(store);
            }
            _ => {}
        }
    }

    /// Carries out one step of time.
    pub(super) fn step(&mut self, store: &mut Store<'_>) {
        self.is_limited = false;
        if !self.state.has_torque() {
            self.actual.stop(FRICTION);
            if self.world.is_held {
                self.actual.speed = 0;
            }
            self.demand = self.actual;
            return;
        }
        if let Some(Stop { deceleration, then }) = self.stop {
            self.demand.stop(deceleration);
            self.follow(store);
            if self.demand.speed == 0 {
                self.stop = None;
                if let Some(state) = then {
                    self.enter(state);
                } else {
                    self.forget();
                }
                // The commands that arrived during the stop.
                self.obey(store);
            }
        } else {
            if self.state == State::OperationEnabled {
                self.drive(store);
            }
            self.follow(store);
        }
        self.supervise(store);
    }

    /// Computes the demand of the present mode.
    fn drive(&mut self, store: &Store<'_>) {
        let halt = match self.get(store, 0x605D) {
            2 => self.get(store, 0x6085),
            _ => self.get(store, 0x6084),
        };
        if self.controlword & control::HALT != 0 {
            return self.demand.stop(halt);
        }
        match self.mode {
            PROFILE_POSITION if self.is_moving => self.approach(store),
            PROFILE_VELOCITY => {
                let speed = self.speed(store, 0x60FF, 0) * self.sign(store, 6);
                if self.may_go(store, speed) {
                    self.demand.ramp(speed, self.limits(store, 0x607F));
                }
            }
            HOMING if self.controlword & control::START != 0 => self.home(store),
            CYCLIC_POSITION => self.interpolate(store),
            INTERPOLATED_POSITION if self.controlword & control::START != 0 => {
                self.interpolate(store);
            }
            CYCLIC_VELOCITY => {
                let wanted = self.get(store, 0x60FF) * UNIT * self.sign(store, 6);
                let speed = self.speed(store, 0x60FF, 0) * self.sign(store, 6);
                if self.may_go(store, speed) {
                    self.is_limited = speed != wanted;
                    self.demand.speed = speed;
                    self.demand.go();
                }
            }
            _ => self.demand.stop(halt),
        }
    }

    /// Profile position mode: approaches the set-point, then the next one.
    fn approach(&mut self, store: &Store<'_>) {
        let way = self.target - self.demand.position;
        if self.may_go(store, way)
            && self
                .demand
                .approach(self.target, self.limits(store, 0x6081))
        {
            match self.next.take() {
                Some(next) => self.target = next,
                None => self.is_moving = false,
            }
        }
    }

    /// Cyclic modes: moves evenly to the last target within the interpolation time period.
    fn interpolate(&mut self, store: &Store<'_>) {
        let Some((target, left @ 1..)) = self.course else {
            self.demand.speed = 0;
            return;
        };
        let most = self.get(store, 0x607F) * STEP as i64;
        let wanted = (target - self.demand.position) / left;
        let way = within(wanted, most);
        if !self.may_go(store, way) {
            return;
        }
        self.is_limited |= way != wanted;
        self.course = Some((target, if way == wanted { left - 1 } else { 1 }));
        self.demand.position += way;
        self.demand.speed = way * (UNIT / STEP as i64);
    }

    /// Returns whether the shaft may turn in this direction; otherwise limit switches or software
    /// limits stop it.
    fn may_go(&mut self, store: &Store<'_>, way: i64) -> bool {
        let sign = self.sign(store, 7);
        let limits = [1, 2].map(|sub| self.sub(store, 0x607D, sub) * UNIT);
        let place = self.demand.position * sign;
        let is_held = match way * sign {
            1.. => self.world.positive_limit || place >= limits[1] && limits[0] < limits[1],
            0 => false,
            _ => self.world.negative_limit || place <= limits[0] && limits[0] < limits[1],
        };
        if is_held {
            self.is_limited = true;
            self.demand.stop(self.get(store, 0x6085));
        }
        !is_held
    }

    /// Moves the shaft after the demand, with the lag of 2001h in milliseconds.
    fn follow(&mut self, store: &Store<'_>) {
        let before = self.actual.position;
        if !self.world.is_held {
            let axis = (self.base / super::AXIS) as u8 + 1;
            let lag = store.signed(0x2001, axis);
            let way = self.demand.position - before;
            self.actual.position += way.checked_div(lag + 1).unwrap_or(way);
        }
        self.actual.speed = (self.actual.position - before) * (UNIT / STEP as i64);
    }

    /// Supervises following error, target reached and speed zero.
    fn supervise(&mut self, store: &mut Store<'_>) {
        let count = |steps: &mut u32, holds: bool| {
            *steps = if holds { steps.saturating_add(1) } else { 0 };
        };
        let window = self.get(store, 0x6065);
        let error = (self.demand.position - self.actual.position).abs();
        let is_late = window != i64::from(u32::MAX) && error > window * UNIT;
        count(&mut self.late, is_late);
        let threshold = self.get(store, 0x606F) * UNIT;
        count(&mut self.standing, self.actual.speed.abs() <= threshold);
        let is_reached = match self.mode {
            _ if self.controlword & control::HALT != 0 => self.demand.speed == 0,
            PROFILE_VELOCITY => {
                let target = self.speed(store, 0x60FF, 0) * self.sign(store, 6);
                let window = self.get(store, 0x606D) * UNIT;
                (target - self.actual.speed).abs() <= window
            }
            HOMING => !self.is_homing(),
            INTERPOLATED_POSITION => self.course.is_none_or(|(_, left)| left == 0),
            _ => {
                let window = self.get(store, 0x6067) * UNIT;
                let error = (self.target - self.actual.position).abs();
                !self.is_moving && self.next.is_none() && error <= window
            }
        };
        count(&mut self.reached, is_reached);
        if i64::from(self.late) > self.get(store, 0x6066) {
            self.fault(store, FOLLOWING_ERROR);
        }
    }

    /// Updates the objects, also between steps of time.
    pub(super) fn update(&mut self, store: &mut Store<'_>) {
        if self.world.is_safe {
            self.fault(store, SAFE_TORQUE_OFF);
        }
        let mode = self.get(store, 0x6060);
        if mode != self.mode {
            self.mode = mode;
            self.forget();
        }
        // Bit 4 is 0 again, and there is room for another set-point.
        if self.controlword & control::START == 0 && self.next.is_none() {
            self.is_acknowledged = false;
        }
        let (place, pace) = (self.sign(store, 7), self.sign(store, 6));
        let error = self.demand.position - self.actual.position;
        for (index, value) in [
            (0x6041, self.statusword(store).into()),
            (0x6061, self.mode),
            (0x6062, self.demand.position / UNIT * place),
            (0x6064, self.actual.position / UNIT * place),
            (0x606B, self.demand.speed / UNIT * pace),
            (0x606C, self.actual.speed / UNIT * pace),
            (0x60F4, error / UNIT * place),
            (0x60FD, self.world.bits()),
        ] {
            self.put(store, index, value);
        }
    }

    /// Returns whether homing is in progress: bit 4 is set, nothing halts the axis, and the home position is not found.
    const fn is_homing(&self) -> bool {
        self.controlword & (control::START | control::HALT) == control::START
            && !matches!(
                self.homing,
                Homing::Idle | Homing::Attained | Homing::Failed
            )
    }

    fn statusword(&self, store: &Store<'_>) -> u16 {
        let mut word = self.state.bits() | status::REMOTE;
        let mut set = |bit, holds| word |= if holds { bit } else { 0 };
        set(status::LIMIT, self.is_limited);
        let after = |steps: u32, time| steps > 0 && i64::from(steps) > self.get(store, time);
        let is_late = after(self.late, 0x6066);
        let is_enabled = self.state == State::OperationEnabled;
        let (reached, of_mode, error) = match self.mode {
            PROFILE_POSITION => (after(self.reached, 0x6068), self.is_acknowledged, is_late),
            PROFILE_VELOCITY => (
                after(self.reached, 0x606E),
                after(self.standing, 0x6070),
                false,
            ),
            HOMING => (
                // Also while homing is not started, or interrupted: only its progress has 0 here.
                self.actual.speed == 0 && !self.is_homing(),
                self.homing == Homing::Attained,
                self.homing == Homing::Failed,
            ),
            INTERPOLATED_POSITION => (
                self.reached > 0,
                is_enabled && self.controlword & control::START != 0,
                is_late,
            ),
            CYCLIC_POSITION | CYCLIC_VELOCITY => {
                let is_halted = self.controlword & control::HALT != 0;
                let follows = is_enabled && !is_halted && self.stop.is_none();
                (false, follows && !self.is_limited, is_late)
            }
            _ => (false, false, false),
        };
        set(status::REACHED, reached && self.state.has_torque());
        set(status::OF_MODE, of_mode);
        set(status::ERROR, error || self.error == Some(FOLLOWING_ERROR));
        word
    }

    /// Makes the present position of the shaft the home position; the zero position differs from it
    /// by the home offset (607Ch).
    pub(super) fn take_home(&mut self, store: &Store<'_>, place: i64) {
        let offset = self.get(store, 0x607C) * UNIT * self.sign(store, 7);
        let by = -offset - place;
        self.demand.position += by;
        self.actual.position += by;
        self.zero -= by;
        self.target = self.demand.position;
    }

    /// Position of the index pulse at the beginning of a revolution of the shaft.
    pub(super) const fn index_pulse(&self, revolution: i64) -> i64 {
        revolution * REVOLUTION - self.zero
    }

    /// Number of the revolution of the shaft; it changes at the index pulse.
    pub(super) const fn revolution(&self) -> i64 {
        (self.actual.position + self.zero).div_euclid(REVOLUTION)
    }
}

/// A revolution in millionths of a unit.
const REVOLUTION: i64 = 10_000 * UNIT;
