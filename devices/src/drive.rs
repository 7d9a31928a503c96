//! A virtual servo drive with two axes (CiA 402).
//!
//! The dictionary is `eds/DRIVE.eds`; the objects of the second axis are 800h above those of the first.
//!
//! | file | contents |
//! |---|---|
//! | `state` | the state machine of 6040h and 6041h (CiA 402, device control) |
//! | `motion` | ramps: position and speed from one step to the next, in integer arithmetic |
//! | `axis` | an axis: its modes, its supervision, and the values of its objects |
//! | `homing`, `home` | the homing methods, and an axis during homing |

mod axis;
mod home;
mod homing;
mod motion;
mod state;

pub use axis::{Axis, World};

use odkit::nmt::State;
use odkit::{AbortCode, Address, Application, Context, Emcy, Instant, LssProfile, Profile, Reset};
#[cfg(feature = "machines")]
use odkit::{DeviceKind, Pin, kind::Behaviour};

odkit::object_dictionary! {
    /// The drive.
    pub mod drive {
        eds = "../eds/DRIVE.eds";
        profile = cia402;
        behaves = PROFILE;
    }
}

#[cfg(feature = "machines")]
pub(crate) const fn kind(name: &'static str, title: &'static str) -> DeviceKind {
    DeviceKind {
        name,
        title,
        family: "drive",
        dictionary: drive::DICTIONARY,
        profile: &PROFILE,
        behaviour: Behaviour::Own(|| std::boxed::Box::new(Drive::new())),
        leds: true,
        channels: 1,
    }
}

/// CiA 301 without deviations, with LSS.
pub static PROFILE: Profile = Profile {
    lss: Some(LssProfile::CIA305),
    ..Profile::CIA301
};

/// Axes of the drive.
const AXES: usize = 2;
/// Distance between the objects of two axes, 800h (CiA 402).
const AXIS: u16 = 0x800;
/// Number of connections of each axis in `PINS`.
#[cfg(feature = "machines")]
const PINS_OF_AXIS: usize = 7;

/// For each axis: limit switches, home switch, safe torque off (1: off), a held shaft (1), the
/// angle of the shaft in 2⁻³² revolutions, and the brake (1: released).
#[cfg(feature = "machines")]
const PINS: &[Pin] = &[
    Pin::input("limit1-"),
    Pin::input("limit1+"),
    Pin::input("home1"),
    Pin::input("sto1"),
    Pin::input("held1"),
    Pin::kept("shaft1"),
    Pin::output("brake1"),
    Pin::input("limit2-"),
    Pin::input("limit2+"),
    Pin::input("home2"),
    Pin::input("sto2"),
    Pin::input("held2"),
    Pin::kept("shaft2"),
    Pin::output("brake2"),
];

/// Errors that the drive reports: EMCY code, and the bits of 1001h (generic, device profile).
const ERRORS: [u16; 2] = [state::FOLLOWING_ERROR, state::SAFE_TORQUE_OFF];
const REGISTER: u8 = 0x21;

/// Length of a step of the ramps in microseconds.
const STEP: u64 = 1000;
/// Maximum number of steps of one call; a call that is later skips the rest.
const MOST_STEPS: u32 = 100;

/// The behaviour: two axes, and the time of their next step.
#[derive(Clone, Debug)]
pub struct Drive {
    axes: [Axis; AXES],
    /// Time of the next step; `None`: the axes are at rest without torque.
    next: Option<Instant>,
}

impl Default for Drive {
    fn default() -> Self {
        Self::new()
    }
}

impl Drive {
    /// A drive whose axes are at 0.
    pub const fn new() -> Self {
        Self {
            axes: [Axis::new(0), Axis::new(AXIS)],
            next: None,
        }
    }

    /// Gives access to the world of an axis, counted from 0: switches, safe torque off. Tell the
    /// node about a change ([`Node::change`](odkit::Node::change)).
    pub fn world(&mut self, axis: usize) -> Option<&mut World> {
        self.axes.get_mut(axis).map(|axis| &mut axis.world)
    }

    /// Angle of the shaft of an axis, counted from 0, in 2⁻³² revolutions.
    pub fn shaft(&self, axis: usize) -> Option<i64> {
        self.axes.get(axis).map(Axis::shaft)
    }

    /// The axis that an object belongs to.
    fn axis_of(&mut self, address: Address) -> Option<(&mut Axis, u16)> {
        let above = address.index.checked_sub(0x6000)?;
        let axis = self.axes.get_mut(usize::from(above / AXIS))?;
        Some((axis, address.index - above / AXIS * AXIS))
    }

    /// Reports errors: the axes with the error are bits of the first manufacturer-specific byte of
    /// the EMCY message.
    fn report(&self, cx: &mut Context<'_, '_>) {
        for code in ERRORS {
            let mut axes = 0;
            for (bit, axis) in self.axes.iter().enumerate() {
                axes |= u8::from(axis.error() == Some(code)) << bit;
            }
            if axes == 0 {
                cx.signals.clear(code, [0; 5]);
            } else {
                let mut error = Emcy::new(code, REGISTER);
                error.info[0] = axes;
                cx.signals.raise(error);
            }
        }
    }
}

impl Application for Drive {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        if matches!(reset, Reset::PowerOn | Reset::Node) {
            for axis in &mut self.axes {
                axis.reset(cx.store);
            }
            self.next = None;
        }
    }

    fn is_live(&self, _: Address) -> bool {
        false
    }

    fn validate(
        &mut self,
        _: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        match self.axis_of(address) {
            Some((axis, index)) => axis.validate(index, address.sub, value),
            None => Ok(()),
        }
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        if let Some((axis, index)) = self.axis_of(address) {
            axis.written(cx.store, index, address.sub);
            cx.signals.wake();
        }
    }

    fn state_is(&mut self, cx: &mut Context<'_, '_>, state: State) {
        if state == State::Stopped {
            self.master_lost(cx);
        }
    }

    fn master_lost(&mut self, cx: &mut Context<'_, '_>) {
        for axis in &mut self.axes {
            axis.abort_connection(cx.store);
        }
        cx.signals.wake();
    }

    #[cfg(feature = "machines")]
    fn pins(&self) -> &'static [Pin] {
        PINS
    }

    #[cfg(feature = "machines")]
    fn pin(&self, number: usize) -> i64 {
        let axis = self.axes.get(number / PINS_OF_AXIS);
        axis.map_or(0, |axis| axis.pin(number % PINS_OF_AXIS))
    }

    #[cfg(feature = "machines")]
    fn set_pin(&mut self, number: usize, value: i64) {
        if let Some(axis) = self.axes.get_mut(number / PINS_OF_AXIS) {
            axis.world.set(number % PINS_OF_AXIS, value != 0);
        }
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let mut due = self.next.take();
        for _ in 0..MOST_STEPS {
            let Some(at) = due.filter(|at| *at <= cx.now) else {
                break;
            };
            for axis in &mut self.axes {
                axis.step(cx.store);
            }
            due = Some(at.plus_micros(STEP));
        }
        for axis in &mut self.axes {
            axis.update(cx.store);
        }
        self.report(cx);
        if self.axes.iter().any(Axis::is_busy) {
            let first = cx.now.plus_micros(STEP);
            self.next = Some(due.filter(|at| *at > cx.now).unwrap_or(first));
        }
        self.next
    }
}
