//! The state machine of a drive (CiA 402, device control), commanded by 6040h and shown by 6041h.

/// Following error (CiA 402, error codes).
pub(super) const FOLLOWING_ERROR: u16 = 0x8611;
/// EMCY code of safe torque off: a contact of the operating unit opened.
pub(super) const SAFE_TORQUE_OFF: u16 = 0x5441;
/// EMCY code of a failed heartbeat or life guarding; the node itself sends this message.
pub(super) const LOST: u16 = 0x8130;

/// State of an axis.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum State {
    SwitchOnDisabled,
    ReadyToSwitchOn,
    SwitchedOn,
    OperationEnabled,
    QuickStopActive,
    FaultReactionActive,
    Fault,
}

/// Command in bits 0 to 3 and 7 of the controlword.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Command {
    DisableVoltage,
    QuickStop,
    Shutdown,
    /// Also "disable operation", which has the same bits.
    SwitchOn,
    EnableOperation,
}

/// Effect of a command in a state.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Transition {
    /// At once.
    To(State),
    /// After a stop by an option code (605Ah, 605Bh, 605Ch).
    QuickStop,
    Shutdown,
    DisableOperation,
}

impl Command {
    /// Reads the command (CiA 402, command coding).
    pub(super) const fn of(controlword: u16) -> Self {
        match controlword & 0xF {
            word if word & 0b0010 == 0 => Self::DisableVoltage,
            word if word & 0b0100 == 0 => Self::QuickStop,
            word if word & 0b0001 == 0 => Self::Shutdown,
            word if word & 0b1000 == 0 => Self::SwitchOn,
            _ => Self::EnableOperation,
        }
    }
}

impl State {
    /// Returns the transition (2 to 12 and 16); `None`: the command has no effect in this state.
    pub(super) const fn transition(self, command: Command) -> Option<Transition> {
        use Command::{DisableVoltage, EnableOperation, QuickStop, Shutdown, SwitchOn};
        use State::{
            OperationEnabled, QuickStopActive, ReadyToSwitchOn, SwitchOnDisabled, SwitchedOn,
        };
        Some(match (self, command) {
            // 2, 6
            (SwitchOnDisabled | SwitchedOn, Shutdown) => Transition::To(ReadyToSwitchOn),
            // 3; with "enable operation" 4 follows at once.
            (ReadyToSwitchOn, SwitchOn | EnableOperation) => Transition::To(SwitchedOn),
            // 4, 16
            (SwitchedOn | QuickStopActive, EnableOperation) => Transition::To(OperationEnabled),
            // 5
            (OperationEnabled, SwitchOn) => Transition::DisableOperation,
            // 7, 10
            (ReadyToSwitchOn | SwitchedOn, DisableVoltage | QuickStop) => {
                Transition::To(SwitchOnDisabled)
            }
            // 8
            (OperationEnabled, Shutdown) => Transition::Shutdown,
            // 9, 12
            (OperationEnabled | QuickStopActive, DisableVoltage) => {
                Transition::To(SwitchOnDisabled)
            }
            // 11
            (OperationEnabled, QuickStop) => Transition::QuickStop,
            _ => return None,
        })
    }

    /// Bits 0 to 3, 5 and 6 of the statusword, and bit 4: the power stage has its supply.
    pub(super) const fn bits(self) -> u16 {
        0x10 | match self {
            Self::SwitchOnDisabled => 0x40,
            Self::ReadyToSwitchOn => 0x21,
            Self::SwitchedOn => 0x23,
            Self::OperationEnabled => 0x27,
            Self::QuickStopActive => 0x07,
            Self::FaultReactionActive => 0x0F,
            Self::Fault => 0x08,
        }
    }

    /// Returns whether the motor has torque, so that it follows the demand.
    pub(super) const fn has_torque(self) -> bool {
        matches!(
            self,
            Self::OperationEnabled | Self::QuickStopActive | Self::FaultReactionActive
        )
    }
}
