//! Controllers with the traits of embedded-can: one with three mailboxes that replaces waiting
//! frames, and one that blocks.

mod support;

use std::collections::VecDeque;

use odkit::board::{Owner, Port};
use odkit::storage::NoStorage;
use odkit::{BusEvent, CanId, Event, Frame, Instant, NoApplication, Node, NodeId};
use support::{Random, frame, thermometer};

/// Mailboxes as in a bxCAN: the frame with the lowest CAN-ID is sent first. If all are full, a
/// frame with a lower CAN-ID replaces the one with the highest.
#[derive(Default)]
struct Mailboxes {
    pending: Vec<Frame>,
    received: VecDeque<Frame>,
    bus: Vec<Frame>,
    thrown_out: usize,
    fails: bool,
}

impl Mailboxes {
    /// Sends one frame.
    fn step(&mut self) {
        let first = (0..self.pending.len()).min_by_key(|at| (self.pending[*at].id(), *at));
        self.bus.extend(first.map(|at| self.pending.remove(at)));
    }
}

/// The only error of these controllers.
#[derive(Clone, Copy, PartialEq, Debug)]
struct Overrun(bool);

impl embedded_can::Error for Overrun {
    fn kind(&self) -> embedded_can::ErrorKind {
        if self.0 {
            embedded_can::ErrorKind::Overrun
        } else {
            embedded_can::ErrorKind::Acknowledge
        }
    }
}

impl embedded_can::nb::Can for Mailboxes {
    type Frame = Frame;
    type Error = Overrun;

    fn transmit(&mut self, frame: &Frame) -> nb::Result<Option<Frame>, Overrun> {
        if self.fails {
            return Err(nb::Error::Other(Overrun(false)));
        }
        if self.pending.len() < 3 {
            self.pending.push(*frame);
            return Ok(None);
        }
        let last = (0..3).max_by_key(|at| (self.pending[*at].id(), *at));
        let last = last.filter(|at| self.pending[*at].id() > frame.id());
        let Some(last) = last else {
            return Err(nb::Error::WouldBlock);
        };
        self.thrown_out += 1;
        let old = self.pending.remove(last);
        self.pending.push(*frame);
        Ok(Some(old))
    }

    fn receive(&mut self) -> nb::Result<Frame, Overrun> {
        self.received.pop_front().ok_or(nb::Error::WouldBlock)
    }
}

/// A node with these frames to send.
struct Talker(VecDeque<Frame>, Vec<BusEvent>);

impl Owner for Talker {
    fn handle_frame(&mut self, _: Instant, _: &Frame) {}
    fn handle_timeout(&mut self, _: Instant) {}
    fn handle_change(&mut self, _: Instant) {}
    fn handle_bus(&mut self, _: Instant, event: BusEvent) {
        self.1.push(event);
    }
    fn is_bus_off(&self) -> bool {
        false
    }
    fn poll_transmit(&mut self, _: Instant) -> Option<Frame> {
        self.0.pop_front()
    }
    fn poll_timeout(&self) -> Option<Instant> {
        None
    }
    fn poll_event(&mut self) -> Option<Event> {
        None
    }
    fn each_wanted_id(&mut self, _: &mut dyn FnMut(CanId)) {}
}

#[test]
fn no_frame_is_lost_and_frames_of_a_can_id_keep_their_order() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut thrown_out = 0;
    for _ in 0..200 {
        let (mut can, mut port) = (Mailboxes::default(), Port::new());
        let mut talker = Talker(VecDeque::new(), Vec::new());
        let (mut all, mut number) = (Vec::new(), 0u32);
        while number < 100 || can.bus.len() < all.len() {
            if number < 100 && random.below(2) == 0 {
                number += 1;
                let id = CanId::standard(random.one_of(&[0x81, 0x181, 0x281, 0x581, 0x701]));
                let frame = Frame::of(id, &number.to_le_bytes());
                all.push(frame);
                talker.0.push_back(frame);
            }
            can.fails = random.below(8) == 0;
            let sent = port.send_nb(&mut talker, &mut can, Instant::ZERO);
            assert!(sent.is_ok() || can.fails);
            if random.below(2) == 0 {
                can.step();
            }
        }
        thrown_out += can.thrown_out;
        assert!(port.is_empty());
        for id in [0x81, 0x181, 0x281, 0x581, 0x701] {
            let of = |frames: &[Frame]| -> Vec<Frame> {
                let of_id = |frame: &&Frame| frame.id() == CanId::standard(id);
                frames.iter().filter(of_id).copied().collect()
            };
            assert_eq!(of(&can.bus), of(&all));
        }
    }
    assert!(thrown_out > 100);
}

#[test]
fn a_frame_of_high_priority_overtakes_those_that_wait() {
    let (mut can, mut port) = (Mailboxes::default(), Port::new());
    let slow = ["701#01", "702#02", "703#03", "704#04"].map(frame);
    let mut talker = Talker(slow.into(), Vec::new());
    port.send_nb(&mut talker, &mut can, Instant::ZERO).unwrap();
    talker.0.push_back(frame("081#00"));
    port.send_nb(&mut talker, &mut can, Instant::ZERO).unwrap();
    assert!(can.pending.contains(&frame("081#00")));
    for _ in 0..5 {
        can.step();
        port.send_nb(&mut talker, &mut can, Instant::ZERO).unwrap();
    }
    let bus: Vec<_> = can.bus.iter().map(Frame::to_string).collect();
    assert_eq!(bus, ["081#00", "701#01", "702#02", "703#03", "704#04"]);
}

#[test]
fn nothing_overtakes_a_boot_up_message() {
    let (mut can, mut port) = (Mailboxes::default(), Port::new());
    let first = ["701#00", "081#00", "181#00"].map(frame);
    let mut talker = Talker(first.into(), Vec::new());
    // Frames of low priority, which all later frames of the node would replace.
    can.pending = vec![frame("700#"); 3];
    port.send_nb(&mut talker, &mut can, Instant::ZERO).unwrap();
    assert_eq!((can.pending.len(), can.thrown_out), (3, 0));
    can.pending.clear();
    port.send_nb(&mut talker, &mut can, Instant::ZERO).unwrap();
    assert_eq!(can.pending, first);
}

#[test]
fn a_node_answers_through_an_nb_controller() {
    let (mut can, mut port) = (Mailboxes::default(), Port::new());
    let mut node = Node::new(thermometer::Device, NodeId::ONE, NoApplication, NoStorage);
    node.power_on(Instant::ZERO);
    can.received.push_back(frame("601#4000100000000000"));
    can.received.push_back(frame("601#2B17100064000000"));
    port.serve_nb(&mut node, &mut can, Instant::ZERO).unwrap();
    let later = Instant::from_millis(100);
    while !can.pending.is_empty() {
        can.step();
    }
    port.serve_nb(&mut node, &mut can, later).unwrap();
    can.step();
    let bus: Vec<_> = can.bus.iter().map(Frame::to_string).collect();
    let expected = ["581#4300100000000000", "581#6017100000000000", "701#00"];
    assert_eq!(bus, [&expected[..], &["701#7F"]].concat());
}

#[test]
fn frames_from_before_bus_off_are_not_sent_after_it() {
    let (mut can, mut port) = (Mailboxes::default(), Port::new());
    let mut node = Node::new(thermometer::Device, NodeId::ONE, NoApplication, NoStorage);
    node.power_on(Instant::ZERO);
    // Frames of other nodes keep the mailboxes full.
    can.pending = vec![frame("080#"); 3];
    can.received.push_back(frame("601#4000100000000000"));
    port.serve_nb(&mut node, &mut can, Instant::ZERO).unwrap();
    assert!(!port.is_empty());
    node.handle_bus(Instant::ZERO, BusEvent::Off);
    port.serve_nb(&mut node, &mut can, Instant::ZERO).unwrap();
    assert!(port.is_empty());
    node.handle_bus(Instant::ZERO, BusEvent::Active);
    can.pending.clear();
    can.received.push_back(frame("601#4001100000000000"));
    port.serve_nb(&mut node, &mut can, Instant::ZERO).unwrap();
    let ids: Vec<_> = can.pending.iter().map(Frame::to_string).collect();
    assert_eq!(ids, ["581#4F01100000000000"]);
}

/// A controller whose calls block until they are done.
struct Waits(VecDeque<Result<Frame, Overrun>>, Vec<String>);

impl embedded_can::blocking::Can for Waits {
    type Frame = Frame;
    type Error = Overrun;

    fn transmit(&mut self, frame: &Frame) -> Result<(), Overrun> {
        self.1.push(frame.to_string());
        Ok(())
    }

    fn receive(&mut self) -> Result<Frame, Overrun> {
        self.0.pop_front().unwrap_or(Err(Overrun(false)))
    }
}

#[test]
fn a_node_answers_through_a_blocking_controller() {
    let mut node = Node::new(thermometer::Device, NodeId::ONE, NoApplication, NoStorage);
    node.power_on(Instant::ZERO);
    let mut port = Port::new();
    let mut can = Waits([Ok(frame("601#4000100000000000"))].into(), Vec::new());
    port.send_blocking(&mut node, &mut can, Instant::ZERO)
        .unwrap();
    let served = port.serve_blocking(&mut node, &mut can, || Instant::ZERO);
    assert_eq!(served, Ok(()));
    assert_eq!(can.1, ["701#00", "581#4300100000000000"]);
    let served = port.serve_blocking(&mut node, &mut can, || Instant::ZERO);
    assert_eq!(served, Err(Overrun(false)));
}

#[test]
fn an_overrun_is_reported_to_the_node() {
    let mut talker = Talker(VecDeque::new(), Vec::new());
    let mut can = Waits([Err(Overrun(true))].into(), Vec::new());
    let served = Port::new().serve_blocking(&mut talker, &mut can, || Instant::ZERO);
    assert_eq!(
        (served, talker.1),
        (Ok::<(), Overrun>(()), vec![BusEvent::Overrun])
    );
}
