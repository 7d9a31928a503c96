//! The homing methods (CiA 402, 6098h): switches and index pulses that make a place the home position.

/// The methods that the drive has.
pub(super) const METHODS: [i64; 8] = [1, 2, 17, 18, 19, 20, 35, 37];

/// How far homing has come.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Homing {
    Idle,
    /// On the way to the switch.
    Search(Method),
    /// Slowly back over the edge of the switch.
    Edge(Method),
    /// On to the index pulse; the revolution where the way began.
    Index(Method, i64),
    /// The home position is behind, and the axis stops.
    Found(i64),
    Attained,
    Failed,
}

/// Switch that a method looks for.
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
    /// The direction of the search; the edge is approached in the other one.
    pub(super) direction: i64,
    /// The search ends where the switch is active, otherwise where it is not.
    pub(super) active: bool,
    /// The home position is the first index pulse behind the edge.
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

impl Homing {
    /// Returns whether it succeeded or failed.
    pub(super) const fn is_over(self) -> bool {
        matches!(self, Self::Attained | Self::Failed)
    }
}
