//! A real bus behind a link: frames of the adapter are received by the bench, and frames of this side are sent.

use od_client::watch;
use od_model::Address;
use od_runtime::DeviceKind;
use od_sim::VirtualDevice;
use od_sim::links::adapter::{self, Message};
use od_sim::links::slcan;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::Crosses;
use crate::journal::{error, outcome, read, text_of};

#[wasm_bindgen]
impl Bus {
    /// Connects the bench to a real bus: its journal records no more inputs, and nothing is sent until
    /// [`setSending`](Self::set_sending).
    #[wasm_bindgen(js_name = goLive)]
    pub fn go_live(&mut self) {
        self.journal.go_live();
    }

    /// Allows or holds back the frames of this side: those of the page and of every device.
    #[wasm_bindgen(js_name = setSending)]
    pub fn set_sending(&mut self, on: bool) {
        self.journal.rig.set_sending(on);
    }

    /// Adds the description of a node of the real bus, as the input `add` adds a device.
    ///
    /// # Errors
    /// Reason why this is not a valid input.
    #[wasm_bindgen(js_name = addDescription, unchecked_return_type = "Applied")]
    pub fn add_description(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Input")] input: &JsValue,
    ) -> Result<JsValue, JsError> {
        let input = read(input).map_err(error)?;
        let added = self.journal.describe(&input);
        Ok(outcome(added, &text_of(&input)).value())
    }

    /// Stores a value that a node has sent: its description shows it from now on.
    pub fn learn(&mut self, device: usize, index: u16, sub: u8, bytes: &[u8]) {
        let learn = |one: &mut VirtualDevice, _| one.learn(Address::new(index, sub), bytes);
        self.journal.rig.with(device, learn);
    }

    /// Number of frames that were held back because sending is off.
    pub fn held(&self) -> f64 {
        self.journal.rig.held() as f64
    }

    /// Number of frames that were dropped because they were not drained in time.
    pub fn dropped(&self) -> f64 {
        self.journal.rig.dropped() as f64
    }
}

/// The built-in device with this vendor-ID and product code (1018h); `null` if there is none.
#[wasm_bindgen(unchecked_return_type = "string | null")]
pub fn identify(vendor: u32, product: u32) -> JsValue {
    known_as(vendor, product).map_or(JsValue::NULL, JsValue::from)
}

/// Part of the identity (1018h) of a built-in device.
fn number(kind: &DeviceKind, sub: u8) -> Option<u32> {
    let entry = kind.dictionary.entry(0x1018, sub)?;
    u32::try_from(entry.default.integer(1)?).ok()
}

fn known_as(vendor: u32, product: u32) -> Option<&'static str> {
    let identity = |kind: &DeviceKind| (number(kind, 1), number(kind, 2));
    let is_it = |kind: &&DeviceKind| identity(kind) == (Some(vendor), Some(product));
    let found = od_devices::DEVICES.iter().find(is_it)?;
    Some(found.name)
}

/// The protocol of an slcan adapter, or of `odkit sim`.
#[wasm_bindgen]
#[derive(Default)]
pub struct Adapter {
    adapter: adapter::Adapter,
    /// One bit for each node ID from which a heartbeat or an SDO response was received.
    nodes: u128,
    is_open: bool,
    is_closed: bool,
    frames: u32,
    refused: u32,
    noise: u32,
}

#[wasm_bindgen]
impl Adapter {
    /// No bytes were received yet.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// The bytes that open the channel at a bit rate in kbit/s, or at that of the adapter;
    /// empty if slcan does not have this rate.
    pub fn begin(&mut self, rate: Option<u16>) -> Vec<u8> {
        (self.is_open, self.is_closed) = (false, false);
        let opening = adapter::Opening {
            rate,
            ..adapter::Opening::default()
        };
        self.adapter.begin(opening).unwrap_or_default()
    }

    /// Handles bytes of the adapter; their frames are on the bus then.
    pub fn hear(&mut self, bus: &mut Bus, bytes: &[u8]) {
        let mut adapter = std::mem::take(&mut self.adapter);
        adapter.receive(bytes, |said| match said {
            Message::Frame(frame) => {
                // Some adapters never confirm; if frames arrive, the channel is open.
                self.is_open = true;
                self.frames = self.frames.saturating_add(1);
                let node = watch::parse(&frame).map(|(node, _)| node.raw());
                let answer = frame.id().as_standard().filter(|id| id & !0x7F == 0x580);
                let node = node.map(u16::from).or(answer.map(|id| id & 0x7F));
                self.nodes |= node.map_or(0, |node| 1 << node);
                bus.journal.rig.hear(&frame);
            }
            Message::Open => self.is_open = true,
            Message::Closed => self.is_closed = true,
            Message::Refused => self.refused = self.refused.saturating_add(1),
            Message::Noise(_) => self.noise = self.noise.saturating_add(1),
            Message::Nothing => {}
        });
        self.adapter = adapter;
        bus.journal.send_requests();
    }

    /// The lines to send now.
    pub fn outgoing(&self, bus: &mut Bus) -> Vec<u8> {
        let mut lines = Vec::new();
        while let Some(frame) = bus.journal.rig.outgoing() {
            slcan::write_frame(&frame, &mut lines);
            lines.push(b'\r');
        }
        lines
    }

    /// Returns whether the adapter has opened the channel, or sent a frame.
    #[wasm_bindgen(js_name = isOpen)]
    pub fn is_open(&self) -> bool {
        self.is_open
    }

    /// Returns whether the adapter has refused to open the channel.
    #[wasm_bindgen(js_name = isClosed)]
    pub fn is_closed(&self) -> bool {
        self.is_closed
    }

    /// Number of received frames.
    pub fn frames(&self) -> u32 {
        self.frames
    }

    /// Number of frames that the adapter refused to send.
    pub fn refused(&self) -> u32 {
        self.refused
    }

    /// Number of lines that are not slcan.
    pub fn noise(&self) -> u32 {
        self.noise
    }

    /// The node IDs of received frames, in order.
    pub fn nodes(&self) -> Vec<u8> {
        (1..=127)
            .filter(|node| self.nodes >> node & 1 != 0)
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use od_sim::journal::{Input, Source};

    use super::*;

    const BUILTIN: &str = "gxmm";

    fn live() -> (Bus, Adapter) {
        let mut bus = Bus::new(None);
        bus.go_live();
        let mut adapter = Adapter::new();
        assert_eq!(adapter.begin(Some(500)), b"\rC\rS6\rO\r");
        adapter.hear(&mut bus, b"\r\r\r");
        assert!(!adapter.is_open());
        adapter.hear(&mut bus, b"\r");
        assert!(adapter.is_open());
        (bus, adapter)
    }

    fn input(node_id: u8) -> Input {
        let source = Source::Builtin {
            name: BUILTIN.into(),
        };
        Input::Add {
            source,
            node_id,
            place: None,
        }
    }

    fn send(bus: &mut Bus, id: u32, data: &[u8]) {
        bus.journal.act(Input::Send {
            id,
            data: data.to_vec(),
            extended: false,
            remote: false,
        });
    }

    #[test]
    fn no_frame_is_sent_until_sending_is_on_and_the_journal_stays_empty() {
        let (mut bus, adapter) = live();
        bus.journal.act(input(1));
        send(&mut bus, 0, &[1, 0]);
        bus.advance(1_000_000.0, 100);
        assert_eq!(adapter.outgoing(&mut bus), b"");
        assert!(
            bus.held() >= 2.0,
            "the command, and the boot-up of the device"
        );
        assert!(bus.drain().is_empty(), "it was not on the bus");
        bus.set_sending(true);
        send(&mut bus, 0, &[0x81, 0]);
        bus.advance(1_000_000.0, 100);
        let lines = String::from_utf8_lossy(&adapter.outgoing(&mut bus)).into_owned();
        assert!(lines.starts_with("t00028100\r"), "{lines}");
        assert!(
            lines.contains("t701100\r"),
            "the virtual device boots: {lines}"
        );
        assert!(
            bus.journal.entries().is_empty(),
            "nothing can be made again"
        );
    }

    #[test]
    fn a_master_on_the_bus_reads_a_virtual_device() {
        let (mut bus, mut adapter) = live();
        bus.journal.act(input(1));
        bus.advance(2_000_000.0, 100);
        bus.set_sending(true);
        adapter.hear(&mut bus, b"t60184000100000000000\r");
        bus.advance(1_000.0, 100);
        let lines = String::from_utf8_lossy(&adapter.outgoing(&mut bus)).into_owned();
        assert!(lines.starts_with("t5818430010009601"), "{lines}");
    }

    #[test]
    fn a_description_shows_received_values_and_sends_nothing() {
        let (mut bus, mut adapter) = live();
        bus.set_sending(true);
        assert_eq!(bus.journal.describe(&input(5)).node, Some(0));
        bus.advance(2_000_000.0, 100);
        let known = |bus: &Bus, index| {
            bus.device(0)
                .map(|one| one.is_known(Address::new(index, 0)))
        };
        assert_eq!(adapter.outgoing(&mut bus), b"");
        assert_eq!(known(&bus, 0x6004), Some(false));
        assert_eq!(bus.nmt(0), "unknown");
        adapter.hear(&mut bus, b"t705100\r");
        assert_eq!(bus.nmt(0), "pre-operational");
        // Another master reads 1017h; the node responds.
        adapter.hear(&mut bus, b"t60584017100000000000\rt58584B171000F4010000\r");
        assert_eq!(known(&bus, 0x1017), Some(true));
        assert_eq!(
            bus.device(0).and_then(|one| one.stored(0x1017, 0)),
            Some(500)
        );
        // PDO1 contains the position value, and only an operational node sends it.
        adapter.hear(&mut bus, b"t1854D2040000\r");
        assert_eq!(bus.nmt(0), "operational");
        assert_eq!(
            bus.device(0).and_then(|one| one.stored(0x6004, 0)),
            Some(1234)
        );
        assert_eq!(adapter.nodes(), [5]);
        assert_eq!(adapter.frames(), 4);
    }

    #[test]
    fn the_client_of_the_page_reads_a_real_node() {
        let (mut bus, mut adapter) = live();
        bus.set_sending(true);
        bus.journal.describe(&input(5));
        let job = bus.transfer(5, 0x1008, 0, None).unwrap_or_default();
        assert_eq!(adapter.outgoing(&mut bus), b"t60584008100000000000\r");
        adapter.hear(&mut bus, b"t5858410810000A000000\r");
        assert_eq!(adapter.outgoing(&mut bus), b"t60586000000000000000\r");
        adapter.hear(&mut bus, b"t585800456E636F646572\r");
        assert_eq!(adapter.outgoing(&mut bus), b"t60587000000000000000\r");
        adapter.hear(&mut bus, b"t58581920474D00000000\r");
        let outcome = bus.journal.rig.outcome();
        assert_eq!(
            outcome.map(|one| (one.job, one.result)),
            Some((job, Ok(b"Encoder GM".to_vec())))
        );
        assert!(
            bus.device(0)
                .is_some_and(|one| one.is_known(Address::new(0x1008, 0)))
        );
    }

    #[test]
    fn a_slow_page_loses_the_oldest_frames_and_is_told_how_many() {
        let (mut bus, mut adapter) = live();
        for _ in 0..50_000 {
            adapter.hear(&mut bus, b"t0800\r");
        }
        let kept = bus.pending();
        assert!((20_000..=40_000).contains(&kept), "{kept}");
        assert_eq!(bus.dropped() + kept as f64, 50_000.0);
        assert_eq!(adapter.frames(), 50_000);
    }

    fn begin(bus: &mut Bus, text: &str) -> Result<(), String> {
        use od_sim::journal::InputProblem;
        let added = bus.journal.act(Input::Lesson { text: text.into() });
        match added.problem {
            InputProblem::Problems(all) => Err(all.iter().map(|one| one.message.clone()).collect()),
            _ => Ok(()),
        }
    }

    #[test]
    fn a_lesson_about_frames_and_objects_works_with_a_real_node() -> Result<(), String> {
        let (mut bus, mut adapter) = live();
        bus.set_sending(true);
        begin(&mut bus, include_str!("../lessons/04-aborts.md"))?;
        assert_eq!(bus.device_count(), 1);
        assert!(bus.device(0).is_some_and(VirtualDevice::is_described));
        let step = |bus: &mut Bus| {
            bus.journal
                .rig
                .lesson()
                .map(|(progress, _)| progress.step())
        };
        // Only the frame of the node is a response, not the one of the page.
        send(&mut bus, 0x601, &[0x2F, 0, 0x10, 0, 1, 0, 0, 0]);
        assert_eq!(step(&mut bus), Some(0));
        adapter.hear(&mut bus, b"t58188000100002000106\r");
        assert_eq!(step(&mut bus), Some(1));
        Ok(())
    }

    #[test]
    fn a_lesson_that_needs_a_simulation_is_refused_with_the_reason() {
        let (mut bus, _) = live();
        bus.journal.describe(&input(5));
        for (text, why) in [
            (
                include_str!("../lessons/01-boot-up-and-heartbeat.md"),
                "`device gxmm node 5 off`",
            ),
            (include_str!("../lessons/02-nmt.md"), "looks at an LED"),
            (include_str!("../lessons/06-pdo-sync.md"), "`shaft rpm 10`"),
            (
                include_str!("../lessons/09-store.md"),
                "looks into the EEPROM",
            ),
            (
                include_str!("../lessons/10-lss.md"),
                "two nodes have one node ID",
            ),
        ] {
            let said = begin(&mut bus, text).err().unwrap_or_default();
            assert!(said.contains(why), "{said}");
        }
        assert_eq!(bus.device_count(), 1, "what was there stays");
    }

    #[test]
    fn built_in_devices_are_found_by_their_identity() {
        let found = |name: &str| {
            let kind = od_devices::DEVICES.iter().find(|kind| kind.name == name)?;
            known_as(number(kind, 1)?, number(kind, 2)?)
        };
        assert_eq!(found(BUILTIN), Some(BUILTIN));
        assert_eq!(known_as(0xEC, 0xFFFF_FFFF), None);
    }
}
