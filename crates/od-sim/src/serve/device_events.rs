//! Prints events of the devices in words on the terminal.

use od_runtime::Event;

use super::terminal::{news, note};
use crate::bench::Bench;
use crate::device::notice;

/// Prints the `wanted` events of all devices since the last call.
pub(super) fn print(bench: &mut Bench, wanted: impl Fn(&Event) -> bool) {
    let several = bench.bus.devices().len() > 1;
    for number in 0..bench.bus.devices().len() {
        let events = bench.bus.with(number, |device, _| {
            let name = several.then(|| format!("node {}: ", device.node_id()));
            let events: Vec<_> = std::iter::from_fn(|| device.poll_event()).collect();
            (name.unwrap_or_default(), events)
        });
        let (name, events) = events.unwrap_or_default();
        for event in events.into_iter().filter(&wanted) {
            if let Some(text) = notice::of_storage(&event) {
                note(&format!("{name}{text}"));
            } else if let Some(text) = words(event) {
                news(&format!("{name}{text}"));
            }
        }
    }
}

/// The event in words; `None` if it is not printed.
fn words(event: Event) -> Option<String> {
    Some(match event {
        Event::State(state) => format!("state: {state}"),
        Event::Reset(_, node) => format!("reset, node {node}"),
        Event::Saved(_) => "parameters saved".into(),
        Event::Restored(_) => "defaults restored".into(),
        Event::BusOff { .. } => "bus-off".into(),
        Event::BusOn => "back from bus-off".into(),
        Event::Error(error) => format!("error {:04X}h", error.code),
        Event::ErrorCleared(code) => format!("error {code:04X}h cleared"),
        Event::CobIdRefused(index) => format!(
            "the CAN-ID in {index:04X}h is restricted, does not fit its frame, or is that of another service; \
             odkit keeps the service not valid (write another COB-ID)"
        ),
        Event::BitRate(code) => {
            format!("LSS set bit rate index {code}; the simulated bus has no bit rate")
        }
        _ => return None,
    })
}
