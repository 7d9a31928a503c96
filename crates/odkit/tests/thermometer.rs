//! The thermometer of `examples/thermometer.rs`: frames in, frames out.
#![allow(dead_code)] // `main` of the example

#[path = "../examples/thermometer.rs"]
mod example;

use std::fs;
use std::path::Path;

use example::thermometer::{HEATER, LIMIT, TEMPERATURE};
use odkit::{CanId, Frame, Instant};

type Node = example::thermometer::Node<example::Heater, odkit::storage::File>;

const NOW: Instant = Instant::from_millis(1000);

fn path(name: &str) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    path.display().to_string()
}

/// A node in Operational with this file.
fn started(path: &str) -> Node {
    let mut node = example::node(path).expect("a file");
    node.power_on(Instant::ZERO);
    assert_eq!(send(&mut node, "000#0100"), ["701#00", "181#0000A041C800"]);
    node
}

/// Sends a frame; returns the frames of the node.
fn send(node: &mut Node, text: &str) -> Vec<String> {
    let (id, data) = text.split_once('#').expect("a frame");
    let byte = |at| u8::from_str_radix(&data[at..at + 2], 16).expect("hex");
    let data: Vec<u8> = (0..data.len()).step_by(2).map(byte).collect();
    let id = CanId::standard(u16::from_str_radix(id, 16).expect("hex"));
    node.handle_frame(NOW, &Frame::new(id, &data).expect("at most eight bytes"));
    sent(node)
}

fn sent(node: &mut Node) -> Vec<String> {
    let frames = std::iter::from_fn(|| node.poll_transmit(NOW));
    frames.map(|frame| frame.to_string()).collect()
}

fn measure(node: &mut Node, celsius: f32) -> Vec<String> {
    node.set(NOW, TEMPERATURE, celsius);
    sent(node)
}

#[test]
fn a_temperature_is_sent_when_it_changes() {
    let path = path("changes.eeprom");
    let _ = fs::remove_file(&path);
    let mut node = started(&path);
    assert_eq!(measure(&mut node, 21.5), ["181#0000AC41D700"]);
    assert_eq!(measure(&mut node, 21.5), [""; 0]);
    assert_eq!(measure(&mut node, -10.0), ["181#000020C19CFF"]);
}

#[test]
fn above_the_limit_there_is_an_emcy_and_no_heating() {
    let path = path("limit.eeprom");
    let _ = fs::remove_file(&path);
    let mut node = started(&path);
    assert_eq!(send(&mut node, "201#01"), [""; 0]);
    assert_eq!(node.get(HEATER), 1);
    // 80.5 °C: EMCY 4200h, and the heater is off.
    let hot = ["181#0000A1422503", "081#0042090000000000"];
    assert_eq!(measure(&mut node, 80.5), hot);
    assert_eq!(node.get(HEATER), 0);
    // The RPDO has no effect, and an SDO is aborted.
    assert_eq!(send(&mut node, "201#01"), [""; 0]);
    let answer = send(&mut node, "601#2F02200001000000");
    assert_eq!(answer, ["581#8002200022000008"]);
    assert_eq!(node.get(HEATER), 0);
    let cold = ["181#000000424001", "081#0000000000000000"];
    assert_eq!(measure(&mut node, 32.0), cold);
    assert_eq!(send(&mut node, "201#01"), [""; 0]);
    assert_eq!(node.get(HEATER), 1);
    // 2 is above the high limit.
    send(&mut node, "201#02");
    assert_eq!(node.get(HEATER), 1);
}

#[test]
fn a_saved_limit_survives_a_power_cycle() {
    let path = path("saved.eeprom");
    let _ = fs::remove_file(&path);
    let mut node = started(&path);
    send(&mut node, "201#01");
    // 2003h = 40.0, then "save".
    let set = send(&mut node, "601#2303200000002042");
    assert_eq!(set, ["581#6003200000000000"]);
    let saved = send(&mut node, "601#2310100173617665");
    assert_eq!(saved, ["581#6010100100000000"]);
    drop(node);
    let mut node = started(&path);
    assert_eq!(node.get(LIMIT), 40.0);
    assert_eq!(node.get(HEATER), 0, "2002h is not saved");
    assert_eq!(measure(&mut node, 41.0)[1], "081#0042090000000000");
}
