//! The meaning of values: what a number, or one of its bits, means in an object of the CiA
//! documents.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use od_model::{Address, DataType, Dictionary, Kind};

use super::in_first;

/// Values of one object, or of a range of objects of the same kind.
struct Row {
    /// Number of the device profile; 0 for CiA 301 and CiA 302.
    profile: u16,
    first: u16,
    last: u16,
    /// The sub-indices.
    subs: (u8, u8),
    what: What,
}

/// Table that gives a value its meaning.
enum What {
    /// First and last value, and their meaning.
    Values(&'static [(i64, i64, &'static str)]),
    /// Bits that can be set, each with its meaning.
    Bits(&'static [(u8, &'static str)]),
    /// A mask of bits, their pattern, and its meaning; the first match counts.
    Patterns(&'static [(i64, i64, &'static str)]),
    /// Meaning of a bit that is set; the number of the bit is that of the channel.
    Channels(&'static str),
    /// A unit of CiA 303-2.
    Unit,
    /// Version of the profile and of the software.
    Versions,
    /// A time in tenths of an hour; all bits are set in a device that does not count it.
    Hours,
    /// Bits that can be set in byte 0; byte 1 is the retry factor, bytes 2 and 3 are the guard time.
    Assignment(&'static [(u8, &'static str)]),
}

use What::{Assignment, Bits, Channels, Hours, Patterns, Unit, Values, Versions};

const fn row(profile: u16, first: u16, last: u16, subs: (u8, u8), what: What) -> Row {
    Row {
        profile,
        first,
        last,
        subs,
        what,
    }
}

const VAR: (u8, u8) = (0, 0);
const ALL: (u8, u8) = (1, 254);

const MODES: &[(i64, i64, &str)] = &[
    (-128, -1, "mode of the manufacturer"),
    (0, 0, "no mode"),
    (1, 1, "profile position"),
    (2, 2, "velocity (frequency converter)"),
    (3, 3, "profile velocity"),
    (4, 4, "profile torque"),
    (6, 6, "homing"),
    (7, 7, "interpolated position"),
    (8, 8, "cyclic synchronous position"),
    (9, 9, "cyclic synchronous velocity"),
    (10, 10, "cyclic synchronous torque"),
    (11, 11, "cyclic synchronous torque with commutation angle"),
];

const STOPS: &[(i64, i64, &str)] = &[
    (-32768, -1, "reaction of the manufacturer"),
    (0, 0, "disable the drive function"),
    (1, 1, "slow down on the slow down ramp"),
];

const OPERATING: &[(u8, &str)] = &[
    (0, "code sequence counter-clockwise"),
    (1, "commissioning diagnostics enabled"),
    (2, "scaling enabled"),
    (3, "measuring direction reversed"),
];

/// Formats of a stored file (1022h, 1F21h, 1F24h).
const FORMATS: &[(i64, i64, &str)] = &[
    (0, 0, "ASCII, not compressed"),
    (128, 255, "format of the manufacturer"),
];

/// States of a command (1023h:02, 1025h:02).
const COMMANDS: &[(i64, i64, &str)] = &[
    (0, 0, "done without an error or a reply"),
    (1, 1, "done without an error, with a reply"),
    (2, 2, "done with an error, without a reply"),
    (3, 3, "done with an error and a reply"),
    (255, 255, "is executed"),
];

const INVERTED: &[(i64, i64, &str)] = &[(0, 0, "not inverted"), (1, 1, "inverted")];
const INTERRUPTS: &[(i64, i64, &str)] =
    &[(0, 0, "interrupt disabled"), (1, 1, "interrupt enabled")];
const TAKES: &str = "takes the error value";
const SET: &str = "set by a write";
const ON: &str = "on";

/// The meanings, by profile.
#[rustfmt::skip]
const TABLE: &[Row] = &[
    row(0, 0x1001, 0x1001, VAR, Bits(&[
        (0, "generic error"), (1, "current"), (2, "voltage"), (3, "temperature"), (4, "communication error"),
        (5, "device profile specific"), (7, "manufacturer-specific"),
    ])),
    row(0, 0x1010, 0x1010, ALL, Bits(&[(0, "saves on command"), (1, "saves without a command")])),
    row(0, 0x1011, 0x1011, ALL, Bits(&[(0, "restores on command")])),
    row(0, 0x1022, 0x1022, VAR, Values(FORMATS)),
    row(0, 0x1023, 0x1023, (2, 2), Values(COMMANDS)),
    row(0, 0x1024, 0x1024, VAR, Values(&[
        (0, 0, "execute the next command at once"), (1, 1, "buffer the next command"),
        (2, 2, "execute the buffered commands"), (3, 3, "abort the command and the buffered ones"),
        (4, 255, "mode of the manufacturer"),
    ])),
    row(0, 0x1025, 0x1025, (2, 2), Values(COMMANDS)),
    row(0, 0x1029, 0x1029, ALL, Values(&[
        (0, 0, "Pre-operational, if the node is Operational"), (1, 1, "no change of the NMT state"), (2, 2, "Stopped"),
    ])),
    row(0, 0x1F80, 0x1F80, VAR, Bits(&[
        (0, "NMT master"), (1, "starts all nodes at once"), (2, "does not start itself"),
        (3, "does not start the slaves"), (4, "resets all nodes if a mandatory slave fails"), (5, "flying master"),
        (6, "stops all nodes if a mandatory slave fails"),
    ])),
    row(0, 0x1F81, 0x1F81, ALL, Assignment(&[
        (0, "slave of this master"), (2, "is booted again after an error control event"), (3, "mandatory slave"),
        (4, "is not reset while it is Operational"), (5, "its program is verified"), (6, "its program is updated"),
        (7, "its configuration is restored (1F8Ah)"),
    ])),
    row(0, 0x1F51, 0x1F51, ALL, Values(&[
        (0, 0, "stop the program"), (1, 1, "start the program"), (2, 2, "reset the program"), (3, 3, "clear the program"),
    ])),
    row(0, 0x1F21, 0x1F21, ALL, Values(FORMATS)),
    row(0, 0x1F24, 0x1F24, ALL, Values(FORMATS)),
    row(0, 0x1F82, 0x1F82, ALL, Values(&[
        (0, 0, "NMT state unknown"), (1, 1, "the node is missing"), (4, 4, "Stopped"), (5, 5, "Operational"),
        (6, 6, "reset node"), (7, 7, "reset communication"), (127, 127, "Pre-operational"),
    ])),
    row(0, 0x1F83, 0x1F83, ALL, Values(&[(0, 0, "the node is not guarded"), (1, 1, "the node is guarded")])),
    row(401, 0x1000, 0x1000, VAR, Bits(&[
        (16, "digital inputs"), (17, "digital outputs"), (18, "analogue inputs"), (19, "analogue outputs"),
    ])),
    row(401, 0x6000, 0x6000, ALL, Channels(ON)),
    row(401, 0x6002, 0x6002, ALL, Channels("inverted")),
    row(401, 0x6003, 0x6003, ALL, Channels("filter enabled")),
    row(401, 0x6005, 0x6005, VAR, Values(&[(0, 0, "interrupts disabled"), (1, 1, "interrupts enabled")])),
    row(401, 0x6006, 0x6008, ALL, Channels("interrupt enabled")),
    row(401, 0x6030, 0x6037, ALL, Values(INVERTED)),
    row(401, 0x6038, 0x603F, ALL, Values(&[(0, 0, "filter disabled"), (1, 1, "filter enabled")])),
    row(401, 0x6050, 0x6057, ALL, Values(INTERRUPTS)),
    row(401, 0x6060, 0x6067, ALL, Values(INTERRUPTS)),
    row(401, 0x6070, 0x6077, ALL, Values(INTERRUPTS)),
    row(401, 0x6100, 0x6100, ALL, Channels(ON)),
    row(401, 0x6102, 0x6102, ALL, Channels("inverted")),
    row(401, 0x6103, 0x6103, ALL, Channels("filter enabled")),
    row(401, 0x6106, 0x6108, ALL, Channels("interrupt enabled")),
    row(401, 0x6120, 0x6120, ALL, Channels(ON)),
    row(401, 0x6122, 0x6122, ALL, Channels("inverted")),
    row(401, 0x6123, 0x6123, ALL, Channels("filter enabled")),
    row(401, 0x6126, 0x6128, ALL, Channels("interrupt enabled")),
    row(401, 0x6200, 0x6200, ALL, Channels(ON)),
    row(401, 0x6202, 0x6202, ALL, Channels("inverted")),
    row(401, 0x6206, 0x6206, ALL, Channels(TAKES)),
    row(401, 0x6208, 0x6208, ALL, Channels(SET)),
    row(401, 0x6240, 0x6247, ALL, Values(INVERTED)),
    row(401, 0x6250, 0x6257, ALL, Values(&[
        (0, 0, "the output keeps its value after an error"), (1, 1, "the output takes the error value"),
    ])),
    row(401, 0x6270, 0x6277, ALL, Values(&[(0, 0, "the output is not set"), (1, 1, "the output is set")])),
    row(401, 0x6300, 0x6300, ALL, Channels(ON)),
    row(401, 0x6302, 0x6302, ALL, Channels("inverted")),
    row(401, 0x6306, 0x6306, ALL, Channels(TAKES)),
    row(401, 0x6308, 0x6308, ALL, Channels(SET)),
    row(401, 0x6320, 0x6320, ALL, Channels(ON)),
    row(401, 0x6322, 0x6322, ALL, Channels("inverted")),
    row(401, 0x6326, 0x6326, ALL, Channels(TAKES)),
    row(401, 0x6328, 0x6328, ALL, Channels(SET)),
    row(401, 0x6421, 0x6421, ALL, Bits(&[
        (0, "above the upper limit"), (1, "below the lower limit"), (2, "changed by more than the delta"),
        (3, "reduced by more than the negative delta"), (4, "increased by more than the positive delta"),
    ])),
    row(401, 0x6422, 0x6422, ALL, Channels("caused an interrupt")),
    row(401, 0x6423, 0x6423, VAR, Values(&[(0, 0, "interrupts disabled"), (1, 1, "interrupts enabled")])),
    row(401, 0x6443, 0x6443, ALL, Values(&[
        (0, 0, "the output keeps its value after an error"), (1, 1, "the output takes the error value (6444h, 6445h)"),
    ])),
    row(401, 0x6430, 0x6430, ALL, Unit),
    row(401, 0x6450, 0x6450, ALL, Unit),
    row(402, 0x1000, 0x1000, VAR, Bits(&[(16, "frequency converter"), (17, "servo drive"), (18, "stepper motor")])),
    row(402, 0x6007, 0x6007, VAR, Values(&[
        (0, 0, "no action"), (1, 1, "fault"), (2, 2, "disable voltage"), (3, 3, "quick stop"),
    ])),
    row(402, 0x6040, 0x6040, VAR, Patterns(&[
        (0x80, 0x80, "fault reset"), (0x07, 0x06, "shutdown"), (0x0F, 0x07, "switch on"),
        (0x0F, 0x0F, "enable operation"), (0x02, 0x00, "disable voltage"), (0x06, 0x02, "quick stop"),
    ])),
    row(402, 0x6041, 0x6041, VAR, Patterns(&[
        (0x4F, 0x00, "Not ready to switch on"), (0x4F, 0x40, "Switch on disabled"), (0x6F, 0x21, "Ready to switch on"),
        (0x6F, 0x23, "Switched on"), (0x6F, 0x27, "Operation enabled"), (0x6F, 0x07, "Quick stop active"),
        (0x4F, 0x0F, "Fault reaction active"), (0x4F, 0x08, "Fault"),
    ])),
    row(402, 0x605A, 0x605A, VAR, Values(&[
        (-32768, -1, "reaction of the manufacturer"), (0, 0, "disable the drive function"),
        (1, 1, "slow down ramp, then Switch on disabled"), (2, 2, "quick stop ramp, then Switch on disabled"),
        (3, 3, "current limit, then Switch on disabled"), (4, 4, "voltage limit, then Switch on disabled"),
        (5, 5, "slow down ramp, stay in Quick stop active"), (6, 6, "quick stop ramp, stay in Quick stop active"),
        (7, 7, "current limit, stay in Quick stop active"), (8, 8, "voltage limit, stay in Quick stop active"),
    ])),
    row(402, 0x605B, 0x605C, VAR, Values(STOPS)),
    row(402, 0x605D, 0x605D, VAR, Values(&[
        (-32768, -1, "reaction of the manufacturer"), (1, 1, "slow down ramp, stay in Operation enabled"),
        (2, 2, "quick stop ramp, stay in Operation enabled"), (3, 3, "current limit, stay in Operation enabled"),
        (4, 4, "voltage limit, stay in Operation enabled"),
    ])),
    row(402, 0x605E, 0x605E, VAR, Values(&[
        (-32768, -1, "reaction of the manufacturer"), (0, 0, "disable the drive function, the motor is free"),
        (1, 1, "slow down ramp"), (2, 2, "quick stop ramp"), (3, 3, "current limit"), (4, 4, "voltage limit"),
    ])),
    row(402, 0x6060, 0x6061, VAR, Values(MODES)),
    row(402, 0x606A, 0x606A, VAR, Values(&[
        (0, 0, "velocity from the position sensor"), (1, 1, "velocity from the velocity sensor"),
    ])),
    row(402, 0x607E, 0x607E, VAR, Bits(&[(6, "velocity inverted"), (7, "position inverted")])),
    row(402, 0x6086, 0x6086, VAR, Values(&[
        (-32768, -1, "profile of the manufacturer"), (0, 0, "linear ramp (trapezoidal)"), (1, 1, "sin² ramp"),
        (2, 2, "jerk-free ramp"), (3, 3, "jerk-limited ramp"),
    ])),
    row(402, 0x6088, 0x6088, VAR, Values(&[
        (-32768, -1, "profile of the manufacturer"), (0, 0, "linear ramp (trapezoidal)"), (1, 1, "sin² ramp"),
    ])),
    row(402, 0x6098, 0x6098, VAR, Values(&[
        (-128, -1, "method of the manufacturer"), (0, 0, "no homing"), (1, 1, "negative limit switch and index pulse"),
        (2, 2, "positive limit switch and index pulse"), (3, 4, "positive home switch and index pulse"),
        (5, 6, "negative home switch and index pulse"), (7, 14, "home switch and index pulse"),
        (17, 17, "negative limit switch"), (18, 18, "positive limit switch"), (19, 20, "positive home switch"),
        (21, 22, "negative home switch"), (23, 30, "home switch"), (33, 33, "index pulse in negative direction"),
        (34, 34, "index pulse in positive direction"), (35, 35, "current position"), (37, 37, "current position"),
    ])),
    row(402, 0x60A8, 0x60AB, VAR, Unit),
    row(402, 0x60B8, 0x60B8, VAR, Bits(&[
        (0, "touch probe 1 enabled"), (1, "touch probe 1 continuous"), (4, "touch probe 1 at the positive edge"),
        (5, "touch probe 1 at the negative edge"), (8, "touch probe 2 enabled"), (9, "touch probe 2 continuous"),
        (12, "touch probe 2 at the positive edge"), (13, "touch probe 2 at the negative edge"),
    ])),
    row(402, 0x60B9, 0x60B9, VAR, Bits(&[
        (0, "touch probe 1 enabled"), (1, "touch probe 1 has a positive edge"), (2, "touch probe 1 has a negative edge"),
        (8, "touch probe 2 enabled"), (9, "touch probe 2 has a positive edge"), (10, "touch probe 2 has a negative edge"),
    ])),
    row(402, 0x60C0, 0x60C0, VAR, Values(&[
        (-32768, -1, "interpolation of the manufacturer"), (0, 0, "linear interpolation"),
    ])),
    row(402, 0x60C2, 0x60C2, (2, 2), Values(&[
        (0, 0, "in seconds"), (-1, -1, "in 0.1 s"), (-2, -2, "in 10 ms"), (-3, -3, "in milliseconds"),
        (-4, -4, "in 0.1 ms"), (-5, -5, "in 10 µs"), (-6, -6, "in microseconds"),
    ])),
    row(402, 0x60C4, 0x60C4, (3, 3), Values(&[(0, 0, "FIFO buffer"), (1, 1, "ring buffer")])),
    row(402, 0x60C4, 0x60C4, (6, 6), Values(&[(0, 0, "clear the buffer, no access"), (1, 1, "access to the buffer")])),
    row(402, 0x60FD, 0x60FD, VAR, Bits(&[
        (0, "negative limit switch"), (1, "positive limit switch"), (2, "home switch"), (3, "interlock"),
    ])),
    row(402, 0x60FE, 0x60FE, ALL, Bits(&[(0, "brake")])),
    row(402, 0x6402, 0x6402, VAR, Values(&[
        (0, 0, "other motor"), (1, 1, "phase-modulated DC motor"), (2, 2, "frequency-controlled DC motor"),
        (3, 3, "permanent-magnet synchronous motor"), (4, 4, "frequency-controlled synchronous motor"),
        (5, 5, "switched reluctance motor"), (6, 6, "wound-rotor induction motor"),
        (7, 7, "squirrel-cage induction motor"), (8, 8, "stepper motor"), (9, 9, "microstep stepper motor"),
        (10, 10, "sinusoidal brushless motor"), (11, 11, "trapezoidal brushless motor"),
        (12, 12, "synchronous reluctance motor"), (13, 13, "DC motor with permanent magnets"),
        (14, 14, "DC motor with series winding"), (15, 15, "DC motor with shunt winding"),
        (16, 16, "DC motor with compound winding"),
    ])),
    row(402, 0x6502, 0x6502, VAR, Bits(&[
        (0, "profile position"), (1, "velocity"), (2, "profile velocity"), (3, "profile torque"), (5, "homing"),
        (6, "interpolated position"), (7, "cyclic synchronous position"), (8, "cyclic synchronous velocity"),
        (9, "cyclic synchronous torque"), (10, "cyclic synchronous torque with commutation angle"),
    ])),
    row(404, 0x1000, 0x1000, VAR, Bits(&[(17, "analogue inputs"), (19, "analogue outputs")])),
    row(404, 0x6131, 0x6131, ALL, Unit),
    row(404, 0x6150, 0x6150, ALL, Bits(&[(0, "not valid"), (1, "positive overload"), (2, "negative overload")])),
    row(404, 0x61A0, 0x61A0, ALL, Values(&[
        (0, 0, "no filter"), (1, 1, "moving average"), (2, 2, "repeating average"),
    ])),
    row(404, 0x6301, 0x6301, ALL, Unit),
    row(406, 0x1000, 0x1000, VAR, Patterns(&[
        (0xFFFF_0000, 0x0001_0000, "singleturn encoder"), (0xFFFF_0000, 0x0002_0000, "multiturn encoder"),
    ])),
    row(406, 0x6000, 0x6000, VAR, Bits(OPERATING)),
    row(406, 0x6300, 0x6300, ALL, Channels("cam active")),
    row(406, 0x6301, 0x6301, ALL, Channels("cam enabled")),
    row(406, 0x6302, 0x6302, ALL, Channels("cam inverted")),
    row(406, 0x6400, 0x6400, ALL, Bits(&[(0, "outside the work area"), (1, "above the work area"), (2, "below the work area")])),
    row(406, 0x6500, 0x6500, VAR, Bits(OPERATING)),
    row(406, 0x6503, 0x6504, VAR, Bits(&[(0, "position error"), (1, "commissioning diagnostics")])),
    row(406, 0x6505, 0x6506, VAR, Bits(&[
        (0, "frequency exceeded"), (1, "light control reserve"), (2, "watchdog"), (3, "operating time limit"),
        (4, "battery charge"), (5, "reference point"),
    ])),
    row(406, 0x6507, 0x6507, VAR, Versions),
    row(406, 0x6508, 0x6508, VAR, Hours),
];

/// Returns the meaning of a value of an object in a device of this profile: `profile position` for
/// 1 in 6060h of CiA 402. `None` if the documents give the number no meaning.
pub fn meaning(profile: Option<u16>, index: u16, sub: u8, number: i64) -> Option<String> {
    match row_of(profile, index, sub)?.what {
        Values(values) => {
            let mut values = values.iter();
            let value = values.find(|(first, last, _)| (*first..=*last).contains(&number))?;
            Some(value.2.to_string())
        }
        Bits(bits) => {
            let set = set_bits(bits, number);
            (!set.is_empty()).then(|| set.join(", "))
        }
        Patterns(patterns) => {
            let mut patterns = patterns.iter();
            let found = patterns.find(|(mask, pattern, _)| number & mask == *pattern)?;
            Some(found.2.to_string())
        }
        Channels(what) => {
            let set = (0..32).filter(|bit| number >> bit & 1 != 0);
            let set: Vec<String> = set.map(|bit| bit.to_string()).collect();
            let bits = if set.len() == 1 { "bit" } else { "bits" };
            (!set.is_empty()).then(|| format!("{what} at {bits} {}", set.join(", ")))
        }
        Unit => unit(u32::try_from(number).ok()?),
        Versions => {
            let [low, high, software_low, software] = u32::try_from(number).ok()?.to_le_bytes();
            Some(format!(
                "profile {high}.{low}, software {software}.{software_low}"
            ))
        }
        Hours if number == 0xFFFF_FFFF => Some("not counted".into()),
        Hours => Some(format!("{}.{} h", number / 10, number % 10)),
        Assignment(bits) => {
            let [_, retry, low, high] = u32::try_from(number).ok()?.to_le_bytes();
            let guard = u16::from_le_bytes([low, high]);
            let mut said: Vec<String> = set_bits(bits, number)
                .into_iter()
                .map(String::from)
                .collect();
            if retry != 0 {
                said.push(format!("retry factor {retry}"));
            }
            if guard != 0 {
                said.push(format!("guard time {guard} ms"));
            }
            (!said.is_empty()).then(|| said.join(", "))
        }
    }
}

/// The meanings of the bits that are set.
fn set_bits(bits: &[(u8, &'static str)], number: i64) -> Vec<&'static str> {
    let set = bits.iter().filter(|(bit, _)| number >> bit & 1 != 0);
    set.map(|(_, name)| *name).collect()
}

/// The row of an object in a device of this profile.
fn row_of(profile: Option<u16>, index: u16, sub: u8) -> Option<&'static Row> {
    let rows = TABLE.iter();
    let mut own = rows.filter(|row| row.profile == 0 || Some(row.profile) == profile);
    own.find(|row| {
        let own = in_first(row.profile, index);
        (row.first..=row.last).contains(&own) && (row.subs.0..=row.subs.1).contains(&sub)
    })
}

/// The values of an object to which the documents give a meaning, in a device of this profile. Of a range of values with
/// one meaning it has the first, and none below 0: those are the manufacturer's.
pub fn meanings(profile: Option<u16>, index: u16, sub: u8) -> Vec<(i64, &'static str)> {
    match row_of(profile, index, sub).map(|row| &row.what) {
        Some(Values(values)) => {
            let own = values.iter().filter(|(first, _, _)| *first >= 0);
            own.map(|(first, _, says)| (*first, *says)).collect()
        }
        _ => Vec::new(),
    }
}

/// Returns the [`meaning`] of the bytes of a value, in a device whose profile its 1000h gives. `None` also for bytes
/// that are not a number of this type.
pub fn meaning_of_bytes(
    dictionary: Dictionary<'_>,
    address: Address,
    data_type: DataType,
    bytes: &[u8],
) -> Option<String> {
    let size = bytes.len();
    if data_type.size() != Some(size) || !(1..=8).contains(&size) {
        return None;
    }
    let mut wide = [0; 8];
    wide[..size].copy_from_slice(bytes);
    let unused = 64 - 8 * size as u32;
    let number = match data_type.kind() {
        Kind::Unsigned => i64::try_from(u64::from_le_bytes(wide)).ok()?,
        Kind::Signed => i64::from_le_bytes(wide) << unused >> unused,
        _ => return None,
    };
    let kind = dictionary.entry(0x1000, 0)?.default.integer(0)?;
    let profile = u16::try_from(kind & 0xFFFF).ok();
    meaning(profile, address.index, address.sub, number)
}

/// Powers of ten by their number, which is a signed byte.
#[rustfmt::skip]
const PREFIXES: &[(i8, &str)] = &[
    (12, "T"), (9, "G"), (6, "M"), (3, "k"), (2, "h"), (1, "da"), (0, ""),
    (-1, "d"), (-2, "c"), (-3, "m"), (-6, "µ"), (-9, "n"), (-12, "p"),
];

/// Symbols of units by their number in CiA 303-2.
#[rustfmt::skip]
const UNITS: &[(u8, &str)] = &[
    (0x01, "m"), (0x02, "kg"), (0x03, "s"), (0x04, "A"), (0x05, "K"), (0x06, "mol"), (0x07, "cd"),
    (0x10, "rad"), (0x11, "sr"), (0x20, "Hz"), (0x21, "N"), (0x22, "Pa"), (0x23, "J"), (0x24, "W"), (0x25, "C"),
    (0x26, "V"), (0x27, "F"), (0x28, "Ω"), (0x29, "S"), (0x2A, "Wb"), (0x2B, "T"), (0x2C, "H"),
    (0x2D, "°C"), (0x2E, "lm"), (0x2F, "lx"), (0x41, "°"), (0x47, "min"), (0x48, "h"), (0x4E, "bar"),
    // The units of acceleration and jerk of drives.
    (0x57, "s²"), (0xA0, "s³"),
    (0xAB, "psi"), (0xAC, "°F"), (0xB4, "rev"), (0xB5, "inc"),
];

/// A unit in words: power of ten, numerator and denominator in bits 24 to 31, 16 to 23 and 8 to 15. `None` for a number
/// that is not listed.
fn unit(number: u32) -> Option<String> {
    let [_, denominator, numerator, prefix] = number.to_le_bytes();
    let symbol = |code: u8| {
        UNITS
            .iter()
            .find(|(own, _)| *own == code)
            .map(|(_, symbol)| *symbol)
    };
    let prefix = PREFIXES.iter().find(|(power, _)| *power == prefix as i8)?.1;
    let above = format!("{prefix}{}", symbol(numerator)?);
    match denominator {
        0 => Some(above),
        code => Some(format!("{above}/{}", symbol(code)?)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::standards::{cia301, profile_name};

    #[test]
    fn each_row_is_about_an_object_of_the_tables() {
        for row in TABLE {
            for index in [row.first, row.last] {
                let known = match row.profile {
                    0 => cia301::of(index).is_some(),
                    profile => index == 0x1000 || profile_name(profile, index).is_some(),
                };
                assert!(known, "CiA {}: {index:04X}h", row.profile);
            }
        }
    }

    #[test]
    fn a_value_has_the_meaning_of_its_profile() {
        for (profile, index, sub, number, expected) in [
            (402, 0x6060, 0, 1, Some("profile position")),
            (402, 0x6861, 0, 6, Some("homing")),
            (402, 0x6060, 0, -3, Some("mode of the manufacturer")),
            (402, 0x6060, 0, 5, None),
            (402, 0x6040, 0, 0x1F, Some("enable operation")),
            (402, 0x6040, 0, 0x86, Some("fault reset")),
            (402, 0x6041, 0, 0x0637, Some("Operation enabled")),
            (402, 0x6041, 0, 0x0250, Some("Switch on disabled")),
            (402, 0x6502, 0, 0x21, Some("profile position, homing")),
            (
                401,
                0x6421,
                1,
                7,
                Some(
                    "above the upper limit, below the lower limit, changed by more than the delta",
                ),
            ),
            (
                401,
                0x6443,
                1,
                0,
                Some("the output keeps its value after an error"),
            ),
            (
                406,
                0x6000,
                0,
                5,
                Some("code sequence counter-clockwise, scaling enabled"),
            ),
            (406, 0x6060, 0, 1, None),
            (401, 0x6002, 1, 0x05, Some("inverted at bits 0, 2")),
            (401, 0x6206, 1, 0x80, Some("takes the error value at bit 7")),
            (401, 0x6206, 1, 0, None),
            (401, 0x6A50, 1, 1, Some("the output takes the error value")),
            (
                402,
                0x60FD,
                0,
                0x5,
                Some("negative limit switch, home switch"),
            ),
            (
                402,
                0x6402,
                0,
                3,
                Some("permanent-magnet synchronous motor"),
            ),
            (404, 0x6150, 1, 0x3, Some("not valid, positive overload")),
            (
                406,
                0x6400,
                1,
                0x3,
                Some("outside the work area, above the work area"),
            ),
            (402, 0x1F82, 5, 127, Some("Pre-operational")),
            (402, 0x1023, 2, 255, Some("is executed")),
            (
                402,
                0x1001,
                0,
                0x11,
                Some("generic error, communication error"),
            ),
            (402, 0x1029, 1, 2, Some("Stopped")),
            (402, 0x1029, 0, 2, None),
            (404, 0x6131, 1, 0xFD4E_0000, Some("mbar")),
            (404, 0x6131, 2, 0x002D_0000, Some("°C")),
            (402, 0x60A9, 0, 0x00B4_4700, Some("rev/min")),
            (402, 0x60A8, 0, 0xFA01_0000, Some("µm")),
            (404, 0x6131, 1, 0x00FE_0000, None),
            (402, 0x60AA, 0, 0xFD01_5700, Some("mm/s²")),
            (402, 0x60AB, 0, 0xFD01_A000, Some("mm/s³")),
            (402, 0x60C2, 2, -3, Some("in milliseconds")),
            (402, 0x60C2, 1, 1, None),
            (
                401,
                0x1000,
                0,
                0x0003_0191,
                Some("digital inputs, digital outputs"),
            ),
            (406, 0x1000, 0, 0x0002_0196, Some("multiturn encoder")),
            (
                406,
                0x6507,
                0,
                0x0100_0302,
                Some("profile 3.2, software 1.0"),
            ),
            (406, 0x6508, 0, 1234, Some("123.4 h")),
            (406, 0x6508, 0, 0xFFFF_FFFF, Some("not counted")),
            (401, 0x6200, 1, 0x81, Some("on at bits 0, 7")),
            (
                401,
                0x1010,
                1,
                3,
                Some("saves on command, saves without a command"),
            ),
        ] {
            let found = meaning(Some(profile), index, sub, number);
            assert_eq!(
                found.as_deref(),
                expected,
                "{index:04X}h:{sub:02X} = {number}"
            );
        }
        assert_eq!(meaning(None, 0x6060, 0, 1), None);
        let slave = meaning(None, 0x1F81, 5, 0x81);
        assert_eq!(
            slave.as_deref(),
            Some("slave of this master, its configuration is restored (1F8Ah)")
        );
        let guarded = meaning(None, 0x1F81, 5, 0x0064_0301);
        assert_eq!(
            guarded.as_deref(),
            Some("slave of this master, retry factor 3, guard time 100 ms")
        );
        assert_eq!(meaning(None, 0x1F80, 0, 1).as_deref(), Some("NMT master"));
    }
}
