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

fn send(line: &mut Line, stations: &[Station], from: usize) -> bool {
    line.transmit(Instant::ZERO, stations, from, &Frame::standard(0x80, &[]))
}

#[test]
fn equal_rates_and_two_terminators_lose_nothing() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 500]));
    assert!((0..1000).all(|_| send(&mut line, &stations, 1)));
    assert_eq!(line.poll(), None);
    assert!(line.hears(&stations, 1, 2));
}

#[test]
fn a_station_with_another_rate_disturbs_until_error_passive_and_goes_bus_off_when_it_sends() {
    let (mut line, stations) = (real(2), stations(&[500, 500, 250]));
    assert!(send(&mut line, &stations, 0));
    let first = line.poll().expect("the first frame is disturbed");
    assert_eq!((first.trouble, first.attempts), (Trouble::OtherBitRate, 16));
    assert_eq!(line.controller(2).condition(), Condition::ErrorPassive);
    assert!(send(&mut line, &stations, 0));
    assert_eq!(line.poll(), None);
    assert!(!line.hears(&stations, 0, 2));
    while line.controller(2).condition() != Condition::BusOff {
        assert!(!send(&mut line, &stations, 2));
    }
    assert_eq!(line.controller(2).condition(), Condition::BusOff);
    line.restart(2);
    assert_eq!(line.controller(2).condition(), Condition::ErrorActive);
}

#[test]
fn alone_on_the_line_a_frame_is_given_up_and_nobody_goes_bus_off() {
    let (mut line, stations) = (real(2), stations(&[500, 500]));
    line.set_plugged(0, false);
    for _ in 0..3 {
        assert!(!send(&mut line, &stations, 1));
    }
    let lost = line.poll().expect("it was disturbed");
    assert_eq!(
        (lost.trouble, lost.delivered),
        (Trouble::NoAcknowledge, false)
    );
    assert_eq!(line.controller(1).condition(), Condition::ErrorPassive);
    line.set_plugged(0, true);
    assert!(send(&mut line, &stations, 1));
}

#[test]
fn a_missing_terminator_disturbs_fast_lines_and_a_seed_repeats_it() {
    let count = |rate, terminators| {
        let (mut line, stations) = (real(terminators), stations(&[rate, rate]));
        line.set_seed(7);
        for _ in 0..200 {
            send(&mut line, &stations, 0);
            line.restart(0);
        }
        core::iter::from_fn(|| line.poll()).count()
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
    assert_eq!(controller.condition(), Condition::ErrorPassive);
    controller.sent();
    assert_eq!(controller.transmit, 247);
    controller.erred_sending();
    assert_eq!(controller.condition(), Condition::ErrorPassive, "255");
    controller.erred_sending();
    assert_eq!(controller.condition(), Condition::BusOff, "256 at the most");
    assert_eq!(controller.transmit, 256);
}
