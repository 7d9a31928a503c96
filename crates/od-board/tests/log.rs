//! The output for `defmt`: numbers that the host turns into text.
#![cfg(feature = "defmt")]
#![allow(unsafe_code)] // defmt needs a global logger

use std::sync::Mutex;

use odkit::board::Filter;
use odkit::{AbortCode, Address, CanId, Emcy, Event, Frame, Instant, NodeId, nmt};

static BYTES: Mutex<Vec<u8>> = Mutex::new(Vec::new());

#[defmt::global_logger]
struct Logger;

// SAFETY: the only test of this file logs from one thread.
unsafe impl defmt::Logger for Logger {
    fn acquire() {}
    unsafe fn flush() {}
    unsafe fn release() {}
    unsafe fn write(bytes: &[u8]) {
        BYTES.lock().unwrap().extend_from_slice(bytes);
    }
}

defmt::timestamp!("{=u8}", 0x7E);

/// The bytes of a value, after the index of the line and the timestamp.
fn logged(value: &impl defmt::Format) -> Vec<u8> {
    BYTES.lock().unwrap().clear();
    defmt::println!("{}", value);
    let bytes = std::mem::take(&mut *BYTES.lock().unwrap());
    assert_eq!(bytes[2], 0x7E);
    bytes[3..].to_vec()
}

/// Returns whether these bytes are among the logged bytes of a value.
fn has(value: &impl defmt::Format, numbers: &[u8]) -> bool {
    let bytes = logged(value);
    bytes.windows(numbers.len()).any(|part| part == numbers)
}

#[test]
fn frames_states_codes_and_events_are_logged() {
    let frame = Frame::standard(0x181, &[0x92, 0x95, 0x07]);
    assert!(has(&frame, &[0x81, 1]) && has(&frame, &[3, 0, 0, 0, 0x92, 0x95, 7]));
    let remote = Frame::remote(CanId::extended(0x0102_0304), 5).unwrap();
    assert!(
        has(&remote, &[4, 3, 2, 1, 0, 0, 5]),
        "{:?}",
        logged(&remote)
    );
    let abort = AbortCode::NoObject;
    assert!(has(&abort, &[0, 0, 2, 6]));
    assert_ne!(logged(&abort)[6..], logged(&AbortCode::ReadOnly)[6..]);
    let states = [nmt::State::Stopped, nmt::State::Operational].map(|state| logged(&state));
    assert_ne!(states[0], states[1]);
    assert!(has(
        &Event::Written(Address::new(0x1017, 2)),
        &[0x17, 0x10, 2]
    ));
    assert!(has(&Event::State(nmt::State::Stopped), &states[0][2..]));
    let emcy = Emcy {
        code: 0x8130,
        register: 0x11,
        info: [1, 2, 3, 4, 5],
    };
    assert!(has(&Event::Error(emcy), &[0x30, 0x81, 0x11]));
    assert_ne!(logged(&NodeId::ONE), logged(&NodeId::new(2).unwrap()));
    assert!(has(
        &Instant::from_micros(0x0102),
        &[2, 1, 0, 0, 0, 0, 0, 0]
    ));
    let filter = Filter {
        id: CanId::standard(0x601),
        mask: 0x7FF,
    };
    assert!(has(&filter, &[1, 6]) && has(&filter, &[0xFF, 7, 0, 0]));
}
