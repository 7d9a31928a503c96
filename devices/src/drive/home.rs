//! An axis during homing.

use odkit::Store;

use super::axis::Axis;
use super::homing::{Homing, METHODS, Method, Switch};
use super::motion::Limits;

impl Axis {
    /// Starts homing at the rising edge of bit 4 of the controlword.
    pub(super) fn start_homing(&mut self, store: &Store<'_>) {
        let number = self.get(store, 0x6098);
        self.homing = match Method::of(number) {
            Some(method) => Homing::Search(method),
            None if METHODS.contains(&number) => Homing::Found(self.actual.position),
            None => Homing::Failed,
        };
    }

    /// Carries out one step of homing.
    pub(super) fn home(&mut self, store: &Store<'_>) {
        let acceleration = self.get(store, 0x609A);
        match self.homing {
            Homing::Search(method) => {
                if self.is_active(method.switch) == method.active {
                    self.homing = Homing::Edge(method);
                } else if self.is_at_end(method.direction, method.switch) {
                    self.homing = Homing::Failed;
                }
                self.turn(store, method.direction, 1);
            }
            Homing::Edge(method) => {
                if self.is_active(method.switch) != method.active {
                    self.homing = if method.index {
                        Homing::Index(method, self.revolution())
                    } else {
                        Homing::Found(self.actual.position)
                    };
                }
                self.turn(store, -method.direction, 2);
            }
            Homing::Index(method, begin) => {
                let revolution = self.revolution();
                if revolution != begin {
                    let pulse = self.index_pulse(revolution.max(begin));
                    self.homing = Homing::Found(pulse);
                }
                self.turn(store, -method.direction, 2);
            }
            Homing::Found(place) => {
                self.demand.stop(acceleration);
                if self.demand.speed == 0 {
                    self.take_home(store, place);
                    self.homing = Homing::Attained;
                }
            }
            Homing::Idle | Homing::Attained | Homing::Failed => self.demand.stop(acceleration),
        }
    }

    /// Turns in a direction with one of the speeds of 6099h.
    fn turn(&mut self, store: &Store<'_>, direction: i64, speed: u8) {
        let rate = self.get(store, 0x609A);
        let speed = self.speed(store, 0x6099, speed);
        let limits = Limits {
            speed,
            acceleration: rate,
            deceleration: rate,
        };
        self.demand.ramp(speed * direction, limits);
    }

    const fn is_active(&self, switch: Switch) -> bool {
        match switch {
            Switch::Negative => self.world.negative_limit,
            Switch::Positive => self.world.positive_limit,
            Switch::Home => self.world.home,
        }
    }

    /// Ends homing at a limit switch that the method does not search for.
    fn is_at_end(&self, direction: i64, switch: Switch) -> bool {
        switch == Switch::Home
            && self.is_active(if direction > 0 {
                Switch::Positive
            } else {
                Switch::Negative
            })
    }
}
