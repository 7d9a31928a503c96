//! A virtual I/O module (CiA 401): 16 digital inputs and outputs, 4 analogue inputs, 2 analogue outputs.
//!
//! The dictionary is `eds/IO.eds`. At each change the module follows the drawing of CiA 401:
//! terminal → filter (6003h) → polarity (6002h) → 6000h, and 6200h → filter mask (6208h) → error
//! mode and value (6206h, 6207h) → polarity (6202h) → terminal. Event-driven TPDOs follow the
//! interrupt masks (6005h to 6008h, 6421h to 6428h).

use odkit::emcy::register;
use odkit::nmt::State;
use odkit::{
    AbortCode, Address, Application, ChangeKind, Context, Emcy, Instant, LssProfile, Profile,
    Reset, Store,
};
#[cfg(feature = "machines")]
use odkit::{DeviceKind, Pin, kind::Behaviour};

odkit::object_dictionary! {
    /// The I/O module.
    pub mod io {
        eds = "../eds/IO.eds";
        profile = cia401;
        behaves = PROFILE;
    }
}

#[cfg(feature = "machines")]
pub(crate) const fn kind(name: &'static str, title: &'static str) -> DeviceKind {
    DeviceKind {
        name,
        title,
        family: "io",
        dictionary: io::DICTIONARY,
        profile: &PROFILE,
        behaviour: Behaviour::Own(|| std::boxed::Box::new(Io::new())),
        leds: true,
        channels: 1,
    }
}

/// CiA 301 without deviations, with LSS.
pub static PROFILE: Profile = Profile {
    lss: Some(LssProfile::CIA305),
    ..Profile::CIA301
};

/// Number of digital inputs, and of digital outputs.
const BITS: usize = 16;
/// Number of analogue inputs.
const ANALOGUE_INPUTS: usize = 4;
/// Number of analogue outputs.
const ANALOGUE_OUTPUTS: usize = 2;

/// Places of the connections in `PINS`.
#[cfg(feature = "machines")]
const FIRST_ANALOGUE_INPUT: usize = BITS;
#[cfg(feature = "machines")]
const SHORT: usize = FIRST_ANALOGUE_INPUT + ANALOGUE_INPUTS;
#[cfg(feature = "machines")]
const FIRST_OUTPUT: usize = SHORT + 1;
#[cfg(feature = "machines")]
const FIRST_ANALOGUE_OUTPUT: usize = FIRST_OUTPUT + BITS;

/// The terminals, and `short`: 1 is a short circuit at a digital output.
#[cfg(feature = "machines")]
#[rustfmt::skip]
const PINS: &[Pin] = &[
    Pin::input("in1"), Pin::input("in2"), Pin::input("in3"), Pin::input("in4"),
    Pin::input("in5"), Pin::input("in6"), Pin::input("in7"), Pin::input("in8"),
    Pin::input("in9"), Pin::input("in10"), Pin::input("in11"), Pin::input("in12"),
    Pin::input("in13"), Pin::input("in14"), Pin::input("in15"), Pin::input("in16"),
    Pin::input("ain1"), Pin::input("ain2"), Pin::input("ain3"), Pin::input("ain4"),
    Pin::input("short"),
    Pin::output("out1"), Pin::output("out2"), Pin::output("out3"), Pin::output("out4"),
    Pin::output("out5"), Pin::output("out6"), Pin::output("out7"), Pin::output("out8"),
    Pin::output("out9"), Pin::output("out10"), Pin::output("out11"), Pin::output("out12"),
    Pin::output("out13"), Pin::output("out14"), Pin::output("out15"), Pin::output("out16"),
    Pin::output("aout1"), Pin::output("aout2"),
];

/// EMCY of CiA 401: short circuit at the outputs.
const SHORT_CIRCUIT: u16 = 0x2320;

/// The behaviour between terminals and objects.
#[derive(Clone, Debug, Default)]
pub struct Io {
    /// Terminals of the digital inputs, one bit each.
    pub inputs: u16,
    /// Terminals of the analogue inputs.
    pub analogue_inputs: [i16; ANALOGUE_INPUTS],
    /// A digital output has a short circuit.
    pub is_shorted: bool,
    /// Terminals of the digital outputs, one bit each.
    outputs: u16,
    /// Terminals of the analogue outputs.
    analogue_outputs: [i16; ANALOGUE_OUTPUTS],
    /// Digital inputs after the filter.
    filtered: u16,
    /// Terminals of the digital inputs at the last tick, and the time when each changed.
    seen: u16,
    changed_at: [Instant; BITS],
    /// Values that 6208h passes, before error mode and polarity.
    written: u16,
    /// The values of the last interrupt of each analogue input, and the inputs with an interrupt
    /// since 6422h was read.
    interrupted: [i16; ANALOGUE_INPUTS],
    sources: u32,
    /// Error values replace the values of the master (CiA 401, 6206h and 6443h).
    has_failed: bool,
}

impl Io {
    /// A module whose terminals are at 0.
    pub const fn new() -> Self {
        Self {
            inputs: 0,
            analogue_inputs: [0; ANALOGUE_INPUTS],
            is_shorted: false,
            outputs: 0,
            analogue_outputs: [0; ANALOGUE_OUTPUTS],
            filtered: 0,
            seen: 0,
            changed_at: [Instant::ZERO; BITS],
            written: 0,
            interrupted: [0; ANALOGUE_INPUTS],
            sources: 0,
            has_failed: false,
        }
    }

    /// Terminals of the digital outputs, one bit each.
    pub const fn outputs(&self) -> u16 {
        self.outputs
    }

    /// Terminals of the analogue outputs.
    pub const fn analogue_outputs(&self) -> [i16; ANALOGUE_OUTPUTS] {
        self.analogue_outputs
    }

    /// Updates 6000h: filter, then polarity. Returns when the filter passes the next change.
    fn read_inputs(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let filter = word(cx.store, 0x6003);
        let time = cx.store.unsigned(0x2000, 0);
        let mut next = None;
        for bit in 0..BITS {
            let mask = 1 << bit;
            if (self.seen ^ self.inputs) & mask != 0 {
                self.changed_at[bit] = cx.now;
            }
            let due = self.changed_at[bit].plus_millis(time);
            if (self.filtered ^ self.inputs) & mask == 0 {
                continue;
            }
            if filter & mask == 0 || due <= cx.now {
                self.filtered ^= mask;
            } else {
                next = Some(next.map_or(due, |at: Instant| at.min(due)));
            }
        }
        self.seen = self.inputs;
        let value = self.filtered ^ word(cx.store, 0x6002);
        for (sub, byte) in (1..).zip(value.to_le_bytes()) {
            cx.store
                .set_unsigned(Address::new(0x6000, sub), byte.into());
        }
        next
    }

    /// Updates 6401h and the interrupts of the analogue inputs.
    fn read_analogue_inputs(&mut self, cx: &mut Context<'_, '_>) {
        for (channel, value) in self.analogue_inputs.into_iter().enumerate() {
            let sub = channel as u8 + 1;
            cx.store
                .set_unsigned(Address::new(0x6401, sub), value as u16 as u64);
            let last = self.interrupted[channel];
            if value == last {
                continue;
            }
            let kind = analogue_change(cx.store, sub, last, value);
            if kind != ChangeKind::BelowThreshold {
                self.interrupted[channel] = value;
            }
            if kind == ChangeKind::Event {
                self.sources |= 1 << channel;
            }
        }
    }

    /// Updates the outputs: filter mask, error mode and value, polarity.
    fn write_outputs(&mut self, store: &Store<'_>) {
        let mask = word(store, 0x6208);
        self.written = self.written & !mask | word(store, 0x6200) & mask;
        let mut value = self.written;
        if self.has_failed {
            let mode = word(store, 0x6206);
            value = value & !mode | word(store, 0x6207) & mode;
        }
        self.outputs = value ^ word(store, 0x6202);
        for (channel, terminal) in self.analogue_outputs.iter_mut().enumerate() {
            let sub = channel as u8 + 1;
            let has_error_value = self.has_failed && store.unsigned(0x6443, sub) == 1;
            *terminal = if has_error_value {
                let value = store.signed(0x6444, sub);
                value.clamp(i16::MIN.into(), i16::MAX.into()) as i16
            } else {
                store.unsigned(0x6411, sub) as i16
            };
        }
    }
}

impl Application for Io {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        self.has_failed = false;
        if matches!(reset, Reset::PowerOn | Reset::Node) {
            (self.filtered, self.seen) = (self.inputs, self.inputs);
            self.written = word(cx.store, 0x6200);
            (self.interrupted, self.sources) = (self.analogue_inputs, 0);
        }
    }

    fn is_live(&self, address: Address) -> bool {
        address == Address::new(0x6422, 1)
    }

    /// 6422h shows the interrupts since it was last read.
    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        if address == Address::new(0x6422, 1) {
            let sources = core::mem::take(&mut self.sources);
            cx.store.set_unsigned(address, sources.into());
        }
        Ok(())
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        if address.index >= 0x2000 {
            cx.signals.wake();
        }
    }

    fn state_is(&mut self, cx: &mut Context<'_, '_>, state: State) {
        self.has_failed = match state {
            State::Stopped => true,
            State::Operational => false,
            _ => self.has_failed,
        };
        cx.signals.wake();
    }

    fn master_lost(&mut self, cx: &mut Context<'_, '_>) {
        self.has_failed = true;
        cx.signals.wake();
    }

    fn change_kind(&self, store: &Store<'_>, address: Address, last: u64, now: u64) -> ChangeKind {
        let sub = address.sub;
        let mask = |index| store.unsigned(index, sub);
        match address.index {
            0x6000 => {
                let changed = last ^ now;
                let events = changed & (mask(0x6006) | now & mask(0x6007) | last & mask(0x6008));
                if store.unsigned(0x6005, 0) != 0 && events != 0 {
                    ChangeKind::Event
                } else {
                    ChangeKind::Masked
                }
            }
            0x6401 if store.unsigned(0x6423, 0) == 0 => ChangeKind::BelowThreshold,
            0x6401 => analogue_change(store, sub, last as i16, now as i16),
            _ => ChangeKind::Event,
        }
    }

    #[cfg(feature = "machines")]
    fn pins(&self) -> &'static [Pin] {
        PINS
    }

    #[cfg(feature = "machines")]
    fn pin(&self, number: usize) -> i64 {
        let bit = |bits: u16, at: usize| i64::from(bits >> at & 1);
        match number {
            ..FIRST_ANALOGUE_INPUT => bit(self.inputs, number),
            SHORT => self.is_shorted.into(),
            FIRST_ANALOGUE_INPUT..SHORT => {
                self.analogue_inputs[number - FIRST_ANALOGUE_INPUT].into()
            }
            FIRST_OUTPUT..FIRST_ANALOGUE_OUTPUT => bit(self.outputs, number - FIRST_OUTPUT),
            _ => {
                let outputs = self.analogue_outputs.get(number - FIRST_ANALOGUE_OUTPUT);
                outputs.copied().unwrap_or_default().into()
            }
        }
    }

    #[cfg(feature = "machines")]
    fn set_pin(&mut self, number: usize, value: i64) {
        match number {
            ..FIRST_ANALOGUE_INPUT => {
                let mask = 1 << number;
                self.inputs = self.inputs & !mask | u16::from(value != 0) << number;
            }
            SHORT => self.is_shorted = value != 0,
            FIRST_ANALOGUE_INPUT..SHORT => {
                let value = value.clamp(i16::MIN.into(), i16::MAX.into());
                self.analogue_inputs[number - FIRST_ANALOGUE_INPUT] = value as i16;
            }
            _ => {}
        }
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let next = self.read_inputs(cx);
        self.read_analogue_inputs(cx);
        self.write_outputs(cx.store);
        if self.is_shorted {
            let error = Emcy::new(SHORT_CIRCUIT, register(SHORT_CIRCUIT));
            cx.signals.raise(error);
        } else {
            cx.signals.clear(SHORT_CIRCUIT, [0; 5]);
        }
        next
    }
}

/// Both sub-objects of an 8-bit object as 16 bits.
fn word(store: &Store<'_>, index: u16) -> u16 {
    (store.unsigned(index, 1) | store.unsigned(index, 2) << 8) as u16
}

/// The kind of a change of an analogue input from `last`, the value of its last interrupt, to `now`
/// (CiA 401, 6421h to 6428h). An exceeded limit causes an interrupt at each change, unless a delta is
/// selected, too. Limits and deltas have the unit of 6401h.
fn analogue_change(store: &Store<'_>, sub: u8, last: i16, now: i16) -> ChangeKind {
    let selected = store.unsigned(0x6421, sub);
    let has = |bit: u64| selected >> bit & 1 == 1;
    let limit = |index| store.signed(index, sub);
    let delta = |index| store.signed(index, sub);
    let change = i64::from(now) - i64::from(last);
    let now = i64::from(now);
    let limits = [
        has(0) && now >= limit(0x6424),
        has(1) && now < limit(0x6425),
    ];
    let deltas = [
        has(2) && change.abs() >= delta(0x6426),
        has(3) && -change >= delta(0x6427).max(1),
        has(4) && change >= delta(0x6428).max(1),
    ];
    let is_limited = selected & 0b11 != 0;
    let is_stepped = selected & 0b1_1100 != 0;
    if is_limited && !limits.contains(&true) {
        // Inside its limits; without a delta the next value outside is a change.
        if is_stepped {
            ChangeKind::BelowThreshold
        } else {
            ChangeKind::Masked
        }
    } else if selected == 0 || is_stepped && !deltas.contains(&true) {
        ChangeKind::BelowThreshold
    } else {
        ChangeKind::Event
    }
}
