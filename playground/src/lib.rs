//! The odkit virtual encoder for JavaScript: a CAN bus with CANopen devices on it, in
//! virtual time.
//!
//! ```js
//! import init, { Bus } from 'od-playground';
//! await init();
//! const bus = new Bus();
//! bus.addDevice('gxmm', 1);
//! bus.advance(10_000, 100);                       // 10 ms pass
//! bus.send(0x601, new Uint8Array([0x40, 4, 0x60, 0, 0, 0, 0, 0]), false, false);
//! for (const frame of frames(bus.drain())) console.log(frame);
//! ```
//!
//! Only numbers, strings, byte arrays and plain records cross the boundary; frames
//! cross in bulk, packed. Nothing here reads a clock: time passes when
//! [`Bus::advance`] says so.

#![deny(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod bench;
mod codec;
#[cfg(feature = "eds")]
mod configured;
#[cfg(feature = "eds")]
mod fixes;
#[cfg(feature = "lessons")]
mod lesson;
#[cfg(feature = "logs")]
mod logs;
mod motion;
mod packed;
mod record;
mod types;
mod values;

use od_bench::VirtualDevice;
use od_bench::words;
use od_bench::words::{Service, Words};
#[cfg(feature = "eds")]
use od_eds::{Eds, Finding, Severity, say};
use od_model::Address;
use od_runtime::{Instant, NodeId};
use od_wire::nmt::State;
use wasm_bindgen::prelude::*;

#[cfg(feature = "eds")]
use fixes::Places;
#[cfg(feature = "lessons")]
pub use lesson::{judge_answer, parse_lesson};
use record::Record;

pub use codec::{Transfers, decode_value, encode_value, read_line, tag_names, tags, type_range};
#[cfg(feature = "logs")]
pub use logs::{read_log, write_log};

/// A CAN bus with CANopen devices on it, in virtual time.
#[wasm_bindgen]
#[derive(Default)]
pub struct Bus {
    bus: od_bench::Bus,
    clockwork: motion::Clockwork,
    batch: Vec<u8>,
    /// The lesson that somebody takes here.
    #[cfg(feature = "lessons")]
    taken: Option<lesson::Taken>,
}

#[wasm_bindgen]
impl Bus {
    /// A bus without devices; its time is `micros`, 0 if not given.
    #[wasm_bindgen(constructor)]
    pub fn new(micros: Option<f64>) -> Bus {
        let mut bus = Self::default();
        bus.bus
            .advance(Instant::from_micros(micros.unwrap_or(0.0) as u64));
        bus
    }

    /// Puts a device of ours on the bus and gives it power; answers with its number.
    /// `builtinDevices` lists the names. With a `place` it takes the place of the device
    /// with that number. A redundant encoder puts its further channels behind all devices.
    ///
    /// # Errors
    /// Where there is no such device, or the node ID is not 1 to 127.
    #[wasm_bindgen(js_name = addDevice)]
    pub fn add_device(
        &mut self,
        name: &str,
        node_id: u8,
        place: Option<usize>,
    ) -> Result<usize, JsError> {
        let node_id = valid(node_id)?;
        let kind = od_devices::find(name)
            .ok_or_else(|| JsError::new(&format!("there is no device `{name}`")))?;
        let number = self.put(VirtualDevice::new(kind, node_id), place);
        self.put_channels(kind, number, node_id);
        Ok(number)
    }

    /// Puts the device that an EDS or DCF text describes on the bus and gives it power.
    /// The answer has its number, or `null` and what is wrong with the text. A lenient bus
    /// runs what can be run of a text with errors.
    ///
    /// # Errors
    /// Where the node ID is not 1 to 127.
    #[cfg(feature = "eds")]
    #[wasm_bindgen(js_name = addEds, unchecked_return_type = "EdsResult")]
    pub fn add_eds(
        &mut self,
        text: &str,
        node_id: u8,
        lenient: Option<bool>,
        place: Option<usize>,
    ) -> Result<JsValue, JsError> {
        let options = od_bench::EdsOptions {
            node_id: Some(valid(node_id)?),
            lenient: lenient.unwrap_or_default(),
        };
        let (device, found) = VirtualDevice::read_eds(text, options);
        let device = device.map_or(JsValue::NULL, |device| {
            JsValue::from_f64(self.put(device, place) as f64)
        });
        Ok(Record::new()
            .with("device", device)
            .with("diagnostics", diagnostics(&found, text))
            .done())
    }

    /// Sends a frame from outside at the present moment. Of a remote frame only the
    /// number of bytes counts.
    pub fn send(&mut self, id: u32, data: &[u8], extended: bool, remote: bool) {
        let Some(frame) = packed::make(id, data, extended, remote) else {
            return;
        };
        let now = self.bus.now();
        let came_through = self.bus.receive(&frame);
        self.collect_trouble();
        if came_through {
            packed::push(&mut self.batch, now, None, &frame);
            self.saw(now, None, &frame);
        }
        self.collect();
    }

    /// Lets `micros` pass, or less if `max_frames` are sent before; answers with what passed.
    pub fn advance(&mut self, micros: f64, max_frames: usize) -> f64 {
        let start = self.bus.now();
        let end = start.plus_micros(micros.max(0.0) as u64);
        let full = self.batch.len() + max_frames.max(1) * packed::LEN;
        self.pass(end, full);
        self.bus.now().micros_since(start) as f64
    }

    /// Virtual microseconds.
    pub fn now(&self) -> f64 {
        self.bus.now().as_micros() as f64
    }

    /// Number of frames that wait to be drained.
    pub fn pending(&self) -> usize {
        self.batch.len() / packed::LEN
    }

    /// All frames since the last call, own and others', 24 bytes each.
    pub fn drain(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.batch)
    }

    /// One packed frame in plain words, with the names of the objects.
    pub fn describe(&self, frame: &[u8]) -> String {
        packed::frame(frame)
            .map(|frame| sentence(words::explain(self.bus.devices(), &frame)))
            .unwrap_or_default()
    }

    /// The objects in a packed PDO by the mapping that stands, three numbers each:
    /// `index * 256 + sub`, first bit, number of bits. Empty for other frames.
    pub fn layout(&self, frame: &[u8]) -> Vec<u32> {
        packed::frame(frame)
            .and_then(|frame| words::layout(self.bus.devices(), &frame))
            .unwrap_or_default()
            .into_iter()
            .flat_map(|(at, first, bits)| {
                [u32::from(at.index) << 8 | u32::from(at.sub), first, bits]
            })
            .collect()
    }

    /// The fields of a packed frame, one after the other; none for a frame that was disturbed.
    #[wasm_bindgen(unchecked_return_type = "Field[]")]
    pub fn fields(&self, frame: &[u8]) -> Vec<JsValue> {
        let known = packed::frame(frame).filter(|_| !packed::is_disturbed(frame));
        let fields = known.map(|frame| words::fields(self.bus.devices(), &frame));
        let record = |field: words::Field| {
            let key = |at: Address| u32::from(at.index) << 8 | u32::from(at.sub);
            Record::new()
                .with("from", field.from)
                .with("to", field.to)
                .with("name", field.name)
                .with("value", field.value)
                .with(
                    "object",
                    field.object.map_or(JsValue::NULL, |at| key(at).into()),
                )
                .done()
        };
        fields.unwrap_or_default().into_iter().map(record).collect()
    }

    /// The object dictionary of a device, one row for each value.
    #[wasm_bindgen(unchecked_return_type = "ObjectRecord[]")]
    pub fn dictionary(&self, device: usize) -> Vec<JsValue> {
        let Some(device) = self.bus.devices().get(device) else {
            return Vec::new();
        };
        values::dictionary(device.dictionary(), device.node_id().raw())
    }

    /// The value of an object as a master would read it now, without a frame on the bus;
    /// `null` where there is none.
    #[wasm_bindgen(unchecked_return_type = "Value")]
    pub fn read(&mut self, device: usize, index: u16, sub: u8) -> JsValue {
        let address = Address::new(index, sub);
        let value = self.bus.with(device, |device, now| {
            let data_type = device.dictionary().find(address).ok()?.data_type;
            device
                .is_powered()
                .then(|| values::value(data_type, &device.read(address, now)))
        });
        value.flatten().unwrap_or(JsValue::NULL)
    }

    /// A name for people.
    pub fn title(&self, device: usize) -> String {
        self.bus
            .devices()
            .get(device)
            .map(|device| device.title().into())
            .unwrap_or_default()
    }

    /// The active node ID.
    #[wasm_bindgen(js_name = nodeId)]
    pub fn node_id(&self, device: usize) -> u8 {
        self.bus
            .devices()
            .get(device)
            .map_or(0, |device| device.node_id().raw())
    }

    /// The NMT state, or `off`.
    #[wasm_bindgen(unchecked_return_type = "Nmt")]
    pub fn nmt(&self, device: usize) -> String {
        let Some(device) = self
            .bus
            .devices()
            .get(device)
            .filter(|device| device.is_powered())
        else {
            return "off".into();
        };
        match device.state() {
            State::Initialising => "initialising",
            State::PreOperational => "pre-operational",
            State::Operational => "operational",
            State::Stopped => "stopped",
        }
        .into()
    }

    /// What the two lamps do.
    #[wasm_bindgen(unchecked_return_type = "Leds")]
    pub fn leds(&self, device: usize) -> JsValue {
        let (green, red) = self
            .bus
            .devices()
            .get(device)
            .map_or(("off", "off"), |device| {
                let (green, red) = device.leds();
                (green.name(), red.name())
            });
        Record::new().with("green", green).with("red", red).done()
    }

    /// Is there power?
    pub fn powered(&self, device: usize) -> bool {
        self.bus
            .devices()
            .get(device)
            .is_some_and(VirtualDevice::is_powered)
    }

    /// Switches the power.
    #[wasm_bindgen(js_name = setPower)]
    pub fn set_power(&mut self, device: usize, on: bool) {
        self.bus.with(device, |device, now| {
            if on {
                device.power_on(now)
            } else {
                device.power_off(now)
            }
        });
        self.collect();
    }

    /// Where the shaft is, or `null` where there is none.
    #[wasm_bindgen(unchecked_return_type = "Shaft | null")]
    pub fn shaft(&mut self, device: usize) -> JsValue {
        let shaft = self
            .bus
            .with(device, |device, now| device.shaft(now))
            .flatten();
        shaft.map_or(JsValue::NULL, |shaft| {
            Record::new()
                .with("turns", shaft.turns)
                .with("rpm", shaft.rpm)
                .with("raw", shaft.raw as f64)
                .done()
        })
    }

    /// Lets the shaft run.
    #[wasm_bindgen(js_name = setRpm)]
    pub fn set_rpm(&mut self, device: usize, rpm: f64) {
        self.bus
            .with(device, |device, now| device.set_rpm(rpm, now));
        self.collect();
    }

    /// Brings the shaft to a number of revolutions from the sensor's zero point, at once.
    #[wasm_bindgen(js_name = turnTo)]
    pub fn turn_to(&mut self, device: usize, turns: f64) {
        self.bus
            .with(device, |device, now| device.turn_to(turns, now));
        self.collect();
    }

    /// Sets a device up for the bit rate of the line and gives it power.
    fn put(&mut self, mut device: VirtualDevice, place: Option<usize>) -> usize {
        let others = self.bus.devices().iter().enumerate();
        let rate = |(number, one): (usize, &VirtualDevice)| {
            one.bit_rate().filter(|_| Some(number) != place)
        };
        device.set_up_for(
            self.bus
                .line
                .bit_rate
                .or_else(|| others.clone().find_map(rate)),
        );
        let number = match place.filter(|place| *place < self.bus.devices().len()) {
            Some(place) => {
                self.clockwork.follow(place, &[], false, self.bus.now());
                self.bus.replace(place, device);
                place
            }
            // Identical devices have different serial numbers, or LSS could not tell them apart.
            None => match self.bus.devices().len() {
                0 => self.bus.add(device),
                others => self.bus.add(device.with_serial_number(others as u32 + 1)),
            },
        };
        self.bus.start(number);
        self.collect();
        number
    }

    /// The further channels of a redundant encoder: nodes with the next numbers, on its shaft.
    fn put_channels(
        &mut self,
        kind: &'static od_runtime::DeviceKind,
        first: usize,
        node_id: NodeId,
    ) {
        for channel in 1..kind.channels {
            let next = node_id.raw().checked_add(channel).and_then(NodeId::new);
            let mut device = VirtualDevice::new(kind, next.unwrap_or(NodeId::ONE))
                .with_serial_number(u32::from(channel) + 1);
            let rate = self
                .bus
                .devices()
                .get(first)
                .and_then(VirtualDevice::bit_rate);
            device.set_up_for(rate);
            let number = self.bus.add_beside(device, first);
            self.bus.start(number);
            self.collect();
        }
    }

    fn collect(&mut self) {
        self.collect_trouble();
        while let Some(sent) = self.bus.poll() {
            packed::push(&mut self.batch, sent.at, Some(sent.device), &sent.frame);
            self.saw(sent.at, Some(sent.device), &sent.frame);
        }
        self.look();
    }
}

/// The devices that `Bus.addDevice` knows.
#[wasm_bindgen(js_name = builtinDevices, unchecked_return_type = "Builtin[]")]
pub fn builtin_devices() -> Vec<JsValue> {
    let record = |kind: &od_runtime::DeviceKind| {
        Record::new()
            .with("name", kind.name)
            .with("title", kind.title)
            .done()
    };
    od_devices::DEVICES.iter().map(record).collect()
}

/// What there is to say about an EDS or DCF text.
#[cfg(feature = "eds")]
#[wasm_bindgen(js_name = checkEds, unchecked_return_type = "Diagnostic[]")]
pub fn check_eds(text: &str) -> Vec<JsValue> {
    let places = Places::of(text);
    od_eds::load(text)
        .diagnostics
        .iter()
        .map(|one| diagnostic(one, &places))
        .collect()
}

/// The text with what can be mended in it: safe fixes, or likely guesses as well.
#[cfg(feature = "eds")]
#[wasm_bindgen(js_name = mendEds)]
pub fn mend_eds(text: &str, guess: bool) -> String {
    use od_eds::fix::{Applicability, mend};
    let level = match guess {
        true => Applicability::Unsafe,
        false => Applicability::Safe,
    };
    let document = od_eds::Document::new(text);
    let mended = mend(&document, level, |document| document.load().diagnostics);
    mended.document.text().into()
}

/// The text in the bytes of an EDS or DCF file: UTF-8, UTF-16 or Windows-1252.
#[cfg(feature = "eds")]
#[wasm_bindgen(js_name = decodeEds)]
pub fn decode_eds(bytes: &[u8]) -> String {
    od_eds::decode(bytes).into()
}

/// What a frame says, with its node where the identifier alone does not tell.
fn sentence(words: Words) -> String {
    let mut text = match (words.service, words.node) {
        (Service::Nmt, Some(node)) => format!("{} node {node}", words.text),
        (Service::Nmt, None) => format!("{} all nodes", words.text),
        (Service::ErrorControl | Service::Emcy, Some(node)) => {
            format!("node {node}: {}", words.text)
        }
        _ => words.text,
    };
    if let Some(first) = text.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    text
}

fn valid(node_id: u8) -> Result<NodeId, JsError> {
    NodeId::new(node_id).ok_or_else(|| JsError::new("a node ID is 1 to 127"))
}

#[cfg(feature = "eds")]
fn diagnostics(found: &[Finding], text: &str) -> JsValue {
    let places = Places::of(text);
    record::list(found.iter().map(|one| diagnostic(one, &places)))
}

#[cfg(feature = "eds")]
fn diagnostic(one: &Finding, places: &Places<'_>) -> JsValue {
    let one = say(one, &Eds);
    let span = one.span.unwrap_or_default();
    Record::new()
        .with("code", one.code)
        .with(
            "severity",
            match one.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Info => "info",
            },
        )
        .with("message", one.message.as_str())
        .with("help", one.help.as_str())
        .with("line", span.line)
        .with("column", span.column)
        .with(
            "object",
            one.address
                .map(|address| address.to_string())
                .unwrap_or_default(),
        )
        .with("fix", places.fix(one.fix.as_ref()))
        .done()
}
