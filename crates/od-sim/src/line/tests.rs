use std::vec;

use super::*;

fn real(terminators: u8) -> Line {
    Line {
        is_real: true,
        terminators,
        ..Line::default()
    }
}

fn stations(rates: &[u16]) -> Vec<Station> {
    let station = |rate: &u16| Station {
        present: true,
        rate: Some(*rate),
    };
    rates.iter().map(station).collect()
}

/// Tries to send a frame up to 100 times; returns the reasons of the failed attempts, and whether it got through.
fn send(line: &mut Line, stations: &[Station], from: usize) -> (Vec<FrameError>, bool) {
    let mut failed = Vec::new();
    while failed.len() < 100 && line.controller(from).error_state() != ErrorState::BusOff {
        let frame = Frame::standard(0x80, &[]);
        match line
            .try_once(Instant::ZERO, stations, &[(from, frame)])
            .error
        {
            Some(error) => failed.push(error),
            None => return (failed, true),
        }
    }
    (failed, false)
}

#[test]
fn equal_rates_and_two_terminators_lose_nothing() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 500]));
    assert!((0..1000).all(|_| send(&mut line, &stations, 1) == (Vec::new(), true)));
    assert!(line.hears(&stations, 1, 2));
}

#[test]
fn a_station_with_another_rate_disturbs_until_error_passive_and_goes_bus_off_when_it_sends() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 250]));
    let first = send(&mut line, &stations, 0);
    assert_eq!(first, (vec![FrameError::OtherBitRate; 16], true));
    assert_eq!(line.controller(2).error_state(), ErrorState::ErrorPassive);
    assert_eq!(send(&mut line, &stations, 0), (Vec::new(), true));
    assert!(!line.hears(&stations, 0, 2));
    let (failed, through) = send(&mut line, &stations, 2);
    assert_eq!((failed.len(), through), (32, false));
    assert_eq!(line.controller(2).error_state(), ErrorState::BusOff);
    line.restart(2);
    assert_eq!(line.controller(2).error_state(), ErrorState::ErrorActive);
}

#[test]
fn alone_on_the_line_a_node_repeats_and_is_never_bus_off() {
    let (mut line, stations) = (real(2), stations(&[500, 500]));
    line.set_plugged(0, false);
    let alone = (vec![FrameError::NoAcknowledge; 100], false);
    assert_eq!(send(&mut line, &stations, 1), alone);
    assert_eq!(line.controller(1).transmit, 128);
    assert_eq!(line.controller(1).error_state(), ErrorState::ErrorPassive);
    line.set_plugged(0, true);
    assert_eq!(send(&mut line, &stations, 1), (Vec::new(), true));
    assert_eq!(line.controller(1).transmit, 127);
}

#[test]
fn different_frames_with_one_identifier_destroy_each_other_while_error_active() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 500]));
    // The first difference is the fourth bit of byte 1, which is recessive in the second frame.
    let (low, high) = (
        Frame::standard(0x581, &[0, 0xE5]),
        Frame::standard(0x581, &[0, 0xF5]),
    );
    let mut both = || line.try_once(Instant::ZERO, &stations, &[(1, low), (2, high)]);
    for _ in 0..16 {
        let attempt = both();
        assert_eq!(
            (attempt.error, attempt.beaten),
            (Some(FrameError::SameId), vec![])
        );
        assert!((44..62).contains(&attempt.bits), "{}", attempt.bits);
    }
    // Error passive, the one with the recessive bit cannot stop the other.
    let attempt = both();
    assert_eq!((attempt.error, attempt.beaten), (None, vec![2]));
    assert_eq!(line.controller(1).transmit, 127);
    assert_eq!(line.controller(2).transmit, 136);
    assert_eq!(line.controller(0).receive, 15);
}

#[test]
fn equal_frames_of_one_moment_are_one_frame_and_need_a_third_station_to_acknowledge() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 500]));
    let boot_up = Frame::standard(0x701, &[0]);
    let both = [(1, boot_up), (2, boot_up)];
    let attempt = line.try_once(Instant::ZERO, &stations, &both);
    assert_eq!((attempt.error, attempt.beaten), (None, vec![]));
    line.set_plugged(0, false);
    let attempt = line.try_once(Instant::ZERO, &stations, &both);
    assert_eq!(attempt.error, Some(FrameError::NoAcknowledge));
    assert_eq!(line.controller(2).transmit, 8);
}

#[test]
fn an_error_passive_sender_counts_if_it_sees_the_error_flag_of_another() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 500]));
    let boot_up = Frame::standard(0x701, &[0]);
    line.set_plugged(0, false);
    line.set_plugged(2, false);
    // Alone on the line until it is error passive; then another node sends the same frame with it.
    for _ in 0..20 {
        line.try_once(Instant::ZERO, &stations, &[(1, boot_up)]);
    }
    assert_eq!(line.controller(1).transmit, 128);
    line.set_plugged(2, true);
    let both = [(1, boot_up), (2, boot_up)];
    for attempt in 1..=16 {
        let outcome = line.try_once(Instant::ZERO, &stations, &both);
        assert_eq!(outcome.error, Some(FrameError::NoAcknowledge));
        let is_off = attempt == 16;
        assert_eq!(
            line.controller(1).error_state() == ErrorState::BusOff,
            is_off,
            "{attempt}"
        );
    }
    // The other one is error passive now, and no other station sees its flag.
    line.try_once(Instant::ZERO, &stations, &[(2, boot_up)]);
    assert_eq!(line.controller(2).transmit, 128);
}

/// The acknowledgement arrives in the bit after the slot: an error active sender destroys the frame there; an error passive
/// one sees a dominant bit in its error flag, while the receivers take the frame.
#[cfg(feature = "training")]
#[test]
fn a_late_acknowledgement_leads_to_bus_off_and_frames_that_arrive_several_times() {
    let (mut line, stations) = (real(2), stations(&[500, 500]));
    line.cable.length = 150;
    let frame = Frame::standard(0x705, &[0x7F]);
    let mut received = Vec::new();
    while line.controller(1).error_state() != ErrorState::BusOff {
        let attempt = line.try_once(Instant::ZERO, &stations, &[(1, frame)]);
        assert_eq!(attempt.error, Some(FrameError::NoAcknowledge));
        received.push(attempt.received);
    }
    assert_eq!(received.len(), 32);
    assert_eq!(received.iter().position(|one| *one), Some(16));
    assert_eq!(line.controller(0).receive, 0, "16 errors, then 16 frames");
}

/// Without a dominant bit the start of frame is a bit error of its sender, and the others see nothing.
#[cfg(feature = "training")]
#[test]
fn on_a_short_circuited_line_each_sender_goes_bus_off() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 500]));
    line.cable.shorted = true;
    let (frame, other) = (
        Frame::standard(0x705, &[0]),
        Frame::standard(0x705, &[0x7F]),
    );
    for starters in [&[(1, frame)][..], &[(0, frame), (2, other)]] {
        for _ in 0..32 {
            let attempt = line.try_once(Instant::ZERO, &stations, starters);
            assert_eq!(attempt.error, Some(FrameError::ShortCircuit));
            assert!(!attempt.received);
        }
    }
    for station in 0..3 {
        let controller = line.controller(station);
        assert_eq!(controller.error_state(), ErrorState::BusOff, "{station}");
        assert_eq!(controller.receive, 0, "{station}");
        line.restart(station);
    }
    line.cable.shorted = false;
    let attempt = line.try_once(Instant::ZERO, &stations, &[(1, frame)]);
    assert_eq!(attempt.error, None);
}

#[test]
fn a_missing_terminator_disturbs_fast_lines_and_a_seed_repeats_it() {
    let count = |rate, terminators| {
        let (mut line, stations) = (real(terminators), stations(&[rate, rate]));
        line.set_seed(7);
        let mut failed = 0;
        for _ in 0..200 {
            failed += send(&mut line, &stations, 0).0.len();
            line.restart(0);
        }
        failed
    };
    assert_eq!(count(50, 1), 0);
    assert!(count(500, 1) > 5);
    assert!(count(1000, 1) > count(500, 1));
    assert!(count(50, 0) > 10);
    assert_eq!(count(500, 1), count(500, 1));
}

#[test]
fn a_transmit_error_counts_8_and_a_success_1() {
    let mut controller = Line::default().controller(0);
    for errors in 1..=31 {
        controller.erred_sending();
        assert_eq!(controller.transmit, 8 * errors);
    }
    assert_eq!(controller.error_state(), ErrorState::ErrorPassive);
    controller.sent();
    assert_eq!(controller.transmit, 247);
    controller.erred_sending();
    assert_eq!(controller.error_state(), ErrorState::ErrorPassive, "255");
    controller.erred_sending();
    assert_eq!(
        controller.error_state(),
        ErrorState::BusOff,
        "256 at the most"
    );
    assert_eq!(controller.transmit, 256);
}
