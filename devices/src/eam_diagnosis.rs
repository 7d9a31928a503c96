//! Self-diagnosis of the EAM: manual 001, chapter 9.5.
//!
//! The two designs detect different errors: a redundant channel monitors its multiturn sensor
//! more closely, and tests its battery only while power is off (chapter 4.5). The codes
//! are those of object 2116h:01; the rows are in the order of the manual's table.

use odkit::encoder::{Appears, Fault, Mirror, Report, Role, Until};

/// 2117h: the warnings and alarms again, with other conditions of 1001h.
pub(crate) const DIAGNOSIS: Role = Role::Diagnosis(&[
    shows(0x6505, 0, 0),
    shows(0x6505, 2, 1),
    shows(0x6505, 3, 2),
    shows(0x6505, 4, 3),
    shows(0x6505, 12, 4),
    shows(0x6505, 13, 5),
    shows(0x6505, 14, 6),
    shows(0x6505, 15, 7),
    shows(0x6503, 0, 10),
    shows(0x6503, 1, 11),
    shows(0x1001, 4, 12),
    shows(0x1001, 3, 13),
    shows(0x6503, 12, 14),
    shows(0x6503, 15, 15),
]);

const fn shows(from: u16, bit: u8, shown: u8) -> Mirror {
    Mirror { from, bit, shown }
}

/// A fault that is detected at the start: an alarm, and an error.
const fn alarm(fault: Fault, code: u16, alarm: u16, until: Until, injection: u32) -> Report {
    Report {
        fault,
        code,
        register: 0x01,
        alarm,
        appears: Appears::Startup,
        until,
        injection: Some(injection),
        ..Report::BASE
    }
}

/// A fault that is detected at run time: a warning.
const fn warning(fault: Fault, code: u16, warning: u16, until: Until, injection: u32) -> Report {
    Report {
        fault,
        code,
        warning,
        appears: Appears::Runtime,
        until,
        injection: Some(injection),
        ..Report::BASE
    }
}

const TEMPERATURE: Report = Report {
    register: 0x09,
    ..warning(Fault::Temperature, 0x4200, 0, Until::Repaired, 0x0008_0020)
};
const MEMORY_AT_START: Report = alarm(Fault::Memory, 0x5100, 0x0003, Until::Reboot, 0x0001_0024);
/// MANUALS.md C-EAM-26.
const MEMORY: Report = warning(Fault::Memory, 0x5100, 0x0008, Until::Reboot, 0x0008_0024);
/// Known only after the restart (C-EAM-35).
const WATCHDOG: Report = Report {
    appears: Appears::Always,
    ..warning(Fault::Watchdog, 0x6100, 0x0004, Until::Reboot, 0x0008_0025)
};
const COMMUNICATION_AT_START: Report = alarm(
    Fault::MultiturnCommunication,
    0xFF04,
    0x1001,
    Until::Reboot,
    0x0001_0009,
);
const COMMUNICATION: Report = warning(
    Fault::MultiturnCommunication,
    0xFF04,
    0x2000,
    Until::Reboot,
    0x0008_0009,
);
const SPEED: Report = warning(Fault::Speed, 0xFF05, 0x0001, Until::Reboot, 0x0008_0021);
const SINGLETURN: Report = warning(
    Fault::SingleturnStrength,
    0xFF06,
    0x4000,
    Until::Reboot,
    0x0008_0022,
);
const SUPERVISION: Report = warning(
    Fault::Supervision,
    0xFF07,
    0x8000,
    Until::Reboot,
    0x0008_0023,
);

/// An encoder that is not redundant (chapter 9.1).
pub(crate) const SINGLE: &[Report] = &[
    TEMPERATURE,
    MEMORY_AT_START,
    MEMORY,
    WATCHDOG,
    warning(Fault::Battery, 0xFF00, 0x0010, Until::Repaired, 0x0008_0005),
    alarm(
        Fault::BatteryEmpty,
        0xFF01,
        0x8001,
        Until::Reboot,
        0x0001_0004,
    ),
    warning(
        Fault::BatteryEmpty,
        0xFF01,
        0x2000,
        Until::Reboot,
        0x0008_0004,
    ),
    Report {
        appears: Appears::Startup,
        ..warning(
            Fault::MultiturnSequence,
            0xFF02,
            0x1000,
            Until::Reboot,
            0x0004_0003,
        )
    },
    warning(
        Fault::MultiturnSequence,
        0xFF02,
        0x1000,
        Until::Reboot,
        0x0008_0003,
    ),
    COMMUNICATION_AT_START,
    COMMUNICATION,
    SPEED,
    SINGLETURN,
    SUPERVISION,
];

/// One channel of a redundant encoder (chapter 9.2).
pub(crate) const REDUNDANT: &[Report] = &[
    TEMPERATURE,
    MEMORY_AT_START,
    MEMORY,
    WATCHDOG,
    // C-EAM-37: it takes longer to see that the battery is low than that it is empty.
    Report {
        appears: Appears::Startup,
        off_ms: 11_000,
        ..warning(Fault::Battery, 0xFF00, 0x0010, Until::Reboot, 0x0004_001C)
    },
    Report {
        off_ms: 1_000,
        ..alarm(
            Fault::BatteryEmpty,
            0xFF01,
            0x8001,
            Until::Ever,
            0x0001_0004,
        )
    },
    Report {
        appears: Appears::Injected,
        ..warning(
            Fault::BatteryEmpty,
            0xFF01,
            0x2000,
            Until::Ever,
            0x0008_0004,
        )
    },
    alarm(
        Fault::MultiturnSequence,
        0xFF02,
        0x0001,
        Until::Ever,
        0x0001_001A,
    ),
    warning(
        Fault::MultiturnSequence,
        0xFF02,
        0x1000,
        Until::Ever,
        0x0008_001A,
    ),
    alarm(
        Fault::MultiturnStrength,
        0xFF03,
        0x0001,
        Until::Ever,
        0x0001_001B,
    ),
    warning(
        Fault::MultiturnStrength,
        0xFF03,
        0x1000,
        Until::Ever,
        0x0008_001B,
    ),
    COMMUNICATION_AT_START,
    COMMUNICATION,
    SPEED,
    SINGLETURN,
    SUPERVISION,
    alarm(
        Fault::MultiturnReset,
        0xFF17,
        0x8001,
        Until::Ever,
        0x0001_0014,
    ),
    warning(
        Fault::MultiturnReset,
        0xFF17,
        0x2000,
        Until::Ever,
        0x0008_0014,
    ),
];
