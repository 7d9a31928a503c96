//! The homing methods (CiA 402, 6098h): switches and index pulses that define the home position.

/// The supported methods.
pub(super) const METHODS: [i64; 8] = [1, 2, 17, 18, 19, 20, 35, 37];

/// Progress of homing.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Homing {
    Idle,
    /// Moves to the switch.
    Search(Method),
    /// Moves back slowly over the edge of the switch.
    Edge(Method),
    /// Moves on to the index pulse; the number is the revolution at the start of this movement.
    Index(Method, i64),
    /// The home position was found at this position, and the axis stops.
    Found(i64),
    Attained,
    Failed,
}

/// Switch that a method searches for.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Switch {
    Negative,
    Positive,
    Home,
}

/// A method with a switch.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Method {
    pub(super) switch: Switch,
    /// Direction of the search; the edge is approached in the other direction.
    pub(super) direction: i64,
    /// The search ends when the switch becomes active (`true`) or not active.
    pub(super) active: bool,
    /// The home position is the first index pulse after the edge.
    pub(super) index: bool,
}

impl Method {
    pub(super) const fn of(number: i64) -> Option<Self> {
        let (switch, direction, active) = match number {
            1 | 17 => (Switch::Negative, -1, true),
            2 | 18 => (Switch::Positive, 1, true),
            19 => (Switch::Home, 1, true),
            20 => (Switch::Home, -1, false),
            _ => return None,
        };
        Some(Self {
            switch,
            direction,
            active,
            index: number < 17,
        })
    }
}
