//! Values of the objects, and the values that they accept.

use super::*;

#[test]
fn the_trace_of_the_manual() {
    let mut bench = Bench::new(0x2000_0000);
    bench.at(0x7_9592);
    assert_eq!(bench.position(), 0x7_9592);
    bench.write(0x6002, 0, 0x1000_0000).unwrap();
    bench.write(0x6001, 0, 0x1000).unwrap();
    assert_eq!(bench.position(), 0x3_CAC9);
    bench.write(0x6003, 0, 0).unwrap();
    assert_eq!(bench.position(), 0);
    assert_eq!(bench.read(0x6509, 0), 0x1000_0000 - 0x3_CAC9);
    bench.write(0x6200, 0, 5).unwrap();
    assert_eq!(bench.read(0x1800, 5), 5);
    assert!(bench.signals.take(crate::application::Signals::RECONFIGURE));
    // 1011h restores the values and then reports it; it treats the two timers as one value.
    bench.with(|encoder, cx| {
        cx.store.reset(|row| row.index() >= 0x1800);
        encoder.reset(cx, Reset::Defaults);
    });
    assert_eq!(bench.position(), 0x7_9592);
    assert_eq!(
        (bench.read(0x1800, 5), bench.read(0x6200, 0)),
        (0x203, 0x203)
    );
}

#[test]
fn a_new_resolution_clears_the_offset_unless_an_option_keeps_it() {
    let mut bench = Bench::new(0x2000_0000);
    bench.at(1000);
    bench.write(0x6003, 0, 5).unwrap();
    assert_eq!(bench.position(), 5);
    bench.write(0x6001, 0, 0x2000).unwrap();
    assert_eq!((bench.position(), bench.read(0x6509, 0)), (1000, 0));
    bench.write(0x6003, 0, 5).unwrap();
    bench.write(0x2110, 0, 0x208).unwrap();
    bench.write(0x6002, 0, 0x1000_0000).unwrap();
    assert_eq!(bench.read(0x6509, 0), 0x2000_0000 - 995);
    assert_eq!(bench.position(), 5, "modulo the new range");
}

#[test]
fn code_sequence_and_scaling_keep_the_offset() {
    let mut bench = Bench::new(0x2000_0000);
    bench.at(1000);
    bench.write(0x6003, 0, 5).unwrap();
    let offset = bench.read(0x6509, 0);
    bench.write(0x6000, 0, 5).unwrap();
    assert_eq!(bench.read(0x6500, 0), 5);
    assert_eq!(bench.read(0x6509, 0), offset);
    assert_eq!(
        bench.position(),
        (0x2000_0000 - 1000 + offset) % 0x2000_0000
    );
    bench.write(0x6000, 0, 0xFFFE).unwrap();
    assert_eq!(bench.read(0x6500, 0), 4, "what there is");
    bench.write(0x6001, 0, 1000).unwrap();
    bench.at(0x1000);
    assert_eq!(bench.position(), 500);
    bench.write(0x6000, 0, 0).unwrap();
    assert_eq!(bench.position(), 0x1000);
}

#[test]
fn limits() {
    use AbortCode::{ValueRange, ValueTooHigh};
    let mut bench = Bench::new(0x2000_0000);
    for (index, sub, value, expected) in [
        (0x6001, 0, 0, Err(ValueRange)),
        (0x6001, 0, 0x2000, Ok(())),
        (0x6001, 0, 0x2001, Err(ValueTooHigh)),
        (0x6002, 0, 0, Err(ValueRange)),
        (0x6002, 0, 0x2000_0000, Ok(())),
        (0x6002, 0, 0x2000_0001, Err(ValueTooHigh)),
        (0x6002, 0, 1000, Ok(())),
        (0x6003, 0, 999, Ok(())),
        (0x6003, 0, 1000, Err(ValueTooHigh)),
        (0x2101, 0, 0, Err(ValueRange)),
        (0x2101, 0, 127, Ok(())),
        (0x2101, 0, 128, Err(ValueTooHigh)),
        (0x2100, 0, 8, Ok(())),
        (0x2100, 0, 9, Err(ValueRange)),
        (0x1029, 1, 3, Ok(())),
        (0x1029, 1, 4, Err(ValueRange)),
        (0x2110, 0, 0x28, Ok(())),
        (0x6000, 0, 0xFFFF, Ok(())),
    ] {
        assert_eq!(
            bench.write(index, sub, value),
            expected,
            "{index:X} {value:#X}"
        );
    }
}

/// 6031h:04 and 6041h:04 of the EN580C, also if the dictionary gives no lower limit.
#[test]
fn nothing_can_be_divided_by_0() {
    static DIVIDED: EncoderProfile = EncoderProfile {
        objects: &[(
            Address::new(0x6505, 0),
            Role::Movement(Movement {
                quantity: Quantity::Speed,
                selector: None,
                sources: &[(1, Source::Position)],
                interval: Address::new(0x6503, 0),
                factor: Some((Address::new(0x6000, 0), Address::new(0x6200, 0))),
            }),
        )],
        ..PROFILE
    };
    let mut bench = Bench::new(0x2000);
    bench.encoder = Encoder::new(&DIVIDED, Still(Angle::ZERO));
    assert_eq!(bench.write(0x6000, 0, 0), Ok(()), "but multiplied");
    for (divider, result) in [
        (0, Err(AbortCode::ValueRange)),
        (1, Ok(())),
        (0xFFFF, Ok(())),
    ] {
        assert_eq!(bench.write(0x6200, 0, divider), result, "{divider}");
    }
}

#[test]
fn two_timers_are_one() {
    let mut bench = Bench::new(0x2000_0000);
    bench.write(0x1800, 5, 40).unwrap();
    assert_eq!(bench.read(0x6200, 0), 40);
    bench.write(0x2110, 0, 0x108).unwrap();
    assert_eq!((bench.read(0x6200, 0), bench.read(0x1800, 5)), (40, 42));
    bench.write(0x6200, 0, 10).unwrap();
    assert_eq!(bench.read(0x1800, 5), 12);
    bench.write(0x1800, 5, 7).unwrap();
    assert_eq!(bench.read(0x6200, 0), 5);
    bench.write(0x6200, 0, 0).unwrap();
    assert_eq!(bench.read(0x1800, 5), 0, "off is off");
    bench.write(0x6200, 0, 0xFFFF).unwrap();
    assert_eq!(bench.read(0x1800, 5), 0xFFFF);
    bench.write(0x2110, 0, 8).unwrap();
    // The other object follows the one that a reset restored.
    bench.write(0x6200, 0, 9).unwrap();
    bench.with(|encoder, cx| {
        cx.store.reset(|row| row.index() < 0x2000);
        encoder.reset(cx, Reset::Communication);
    });
    assert_eq!(
        (bench.read(0x6200, 0), bench.read(0x1800, 5)),
        (0x203, 0x203)
    );
    // An event timer that differs from 6200h plus the delay has changed.
    bench.write(0x2110, 0, 0x108).unwrap();
    for (event_timer, timer) in [(8, 6), (20, 18), (12, 10)] {
        bench.write(0x6200, 0, 10).unwrap();
        bench.with(|encoder, cx| {
            cx.store.set_unsigned(Address::new(0x1800, 5), event_timer);
            encoder.reset(cx, Reset::Communication);
        });
        assert_eq!(
            (bench.read(0x6200, 0), bench.read(0x1800, 5)),
            (timer, event_timer)
        );
    }
    // FFFEh plus the delay would be above FFFFh, so it is limited to FFFFh and stays.
    bench.write(0x6200, 0, 0xFFFE).unwrap();
    bench.with(|encoder, cx| encoder.reset(cx, Reset::Communication));
    assert_eq!(
        (bench.read(0x6200, 0), bench.read(0x1800, 5)),
        (0xFFFE, 0xFFFF)
    );
    bench.write(0x2110, 0, 8).unwrap();
    // At a start the saved values apply; here only 6200h was saved.
    bench.with(|encoder, cx| {
        cx.store.reset(|_| true);
        cx.store.set_unsigned(Address::new(0x6200, 0), 11);
        encoder.reset(cx, Reset::Node);
    });
    assert_eq!((bench.read(0x6200, 0), bench.read(0x1800, 5)), (11, 11));
    for (reset, stored, expected) in [
        // Here only 1800h:05 was saved, with an unchanged value.
        (Reset::Node, [None, Some(30)], 30),
        (Reset::Node, [None, Some(30)], 30),
        (Reset::Node, [Some(12), Some(30)], 12),
        // A family whose NMT reset communication also loads 6200h.
        (Reset::Communication, [Some(11), None], 11),
    ] {
        bench.with(|encoder, cx| {
            cx.store.reset(|_| true);
            for (index, value) in [(0x6200, stored[0]), (0x1800, stored[1])] {
                let at = Address::new(index, if index == 0x1800 { 5 } else { 0 });
                value.map(|value| cx.store.set_unsigned(at, value));
            }
            encoder.reset(cx, reset);
        });
        assert_eq!(
            (bench.read(0x6200, 0), bench.read(0x1800, 5)),
            (expected, expected)
        );
    }
}

/// MANUALS.md C-EAM-04: 6003h and 6010h:01 have one value. This test links other objects: 6000h and
/// 6200h, which are saved, or 650Bh, which is not.
#[test]
fn the_saved_one_of_two_linked_objects_applies() {
    const LINK: [(Address, Address); 1] = [(Address::new(0x6000, 0), Address::new(0x6200, 0))];
    const UNSAVED: [(Address, Address); 1] = [(Address::new(0x6000, 0), Address::new(0x650B, 0))];
    const DEFAULT: u64 = 4;
    for (links, stored, shown) in [
        (&LINK, [None, None], DEFAULT),
        (&LINK, [Some(5), None], 5),
        (&LINK, [None, Some(6)], 6),
        (&LINK, [Some(5), Some(6)], 5),
        (&UNSAVED, [None, Some(6)], DEFAULT),
    ] {
        let profile =
            std::boxed::Box::leak(std::boxed::Box::new(EncoderProfile { links, ..PROFILE }));
        let mut bench = Bench::new(0x2000);
        bench.encoder = Encoder::new(profile, Still(Angle::ZERO));
        let (first, second) = links[0];
        let values = bench.with(|encoder, cx| {
            cx.store.reset(|_| true);
            for (at, value) in [first, second].into_iter().zip(stored) {
                value.map(|value| cx.store.set_unsigned(at, value));
            }
            encoder.agree_on_links(cx.store);
            [first, second].map(|at| cx.store.unsigned(at.index, at.sub))
        });
        assert_eq!(values, [shown, shown], "{second} {stored:?}");
    }
}

#[test]
fn a_dictionary_describes_its_sensor() {
    let sensor = |range| {
        let tables = tables(range);
        let profile = EncoderProfile::for_dictionary(tables.dictionary()).unwrap();
        profile.sensor_of(tables.dictionary())
    };
    assert_eq!(
        sensor(0x2000_0000),
        Sensor {
            steps: 0x2000,
            turns: 0x1_0000
        }
    );
    assert_eq!(
        sensor(0x2000),
        Sensor {
            steps: 0x2000,
            turns: 1
        }
    );
    let mut encoder = Encoder::new(&PROFILE, Still(Angle::ZERO)).with_serial_number(4711);
    let mut bench = Bench::new(0x2000);
    core::mem::swap(&mut bench.encoder, &mut encoder);
    bench.reset(Reset::PowerOn);
    assert_eq!((bench.read(0x1018, 4), bench.read(0x650B, 0)), (4711, 4711));
}
