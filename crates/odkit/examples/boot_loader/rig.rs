//! A device with the loader and a master on one bus, in virtual time.

use od_client::Client;
use odkit::storage::NoStorage;
use odkit::{Frame, Instant, Node, NodeId};

use crate::loader::{BootLoader, device};

/// Time of a frame on the bus, in microseconds.
const FRAME_US: u64 = 130;

/// The bus with the device and the master.
pub struct Rig {
    pub node: device::Node<BootLoader>,
    pub client: Client,
    pub now: Instant,
    /// Frames so far.
    pub frames: usize,
    /// Returns whether the bus loses this frame, given its number.
    pub loses: fn(usize, &Frame) -> bool,
}

impl Rig {
    /// A device that has sent its boot-up message.
    pub fn new() -> Self {
        let mut rig = Self {
            node: Node::new(device::Device, NodeId::ONE, BootLoader::new(), NoStorage),
            client: Client::new(),
            now: Instant::ZERO,
            frames: 0,
            loses: |_, _| false,
        };
        rig.node.power_on(rig.now);
        assert_eq!(
            rig.poll().map(|frame| frame.to_string()),
            Some("701#00".into())
        );
        rig
    }

    /// The next frame of the device.
    pub fn poll(&mut self) -> Option<Frame> {
        self.node.poll_transmit(self.now)
    }

    /// The device receives a frame.
    pub fn receive(&mut self, frame: &Frame) {
        self.node.handle_frame(self.now, frame);
    }

    /// Time when the device has something to do.
    pub fn due(&self) -> Option<Instant> {
        self.node.poll_timeout()
    }

    /// Lets time pass until `now`; the device does what is due.
    pub fn wait_until(&mut self, now: Instant) {
        self.now = self.now.max(now);
        self.node.handle_timeout(self.now);
    }

    /// Runs until nothing is sent and nothing is due; returns the events of the master.
    pub fn run(&mut self) -> Vec<od_client::Event> {
        loop {
            while self.step() {}
            let next = [self.due(), self.client.poll_timeout()];
            let Some(next) = next.into_iter().flatten().min() else {
                break;
            };
            self.wait_until(next);
            self.client.handle_timeout(self.now);
        }
        std::iter::from_fn(|| self.client.poll_event()).collect()
    }

    /// Moves one frame over the bus.
    fn step(&mut self) -> bool {
        let answer = self.poll();
        let Some(frame) = answer.or_else(|| self.client.poll_transmit(self.now)) else {
            return false;
        };
        self.frames += 1;
        self.now = self.now.plus_micros(FRAME_US);
        if (self.loses)(self.frames, &frame) {
            return true;
        }
        match answer {
            Some(frame) => self.client.handle_frame(self.now, &frame),
            None => self.receive(&frame),
        }
        true
    }
}
