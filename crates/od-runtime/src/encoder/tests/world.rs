//! Switches, faults, power.

use super::*;

#[test]
fn switches_set_the_node_id_and_the_bit_rate() {
    let mut bench = Bench::new(0x2000_0000);
    bench.write(0x2101, 0, 7).unwrap();
    let id = |bench: &mut Bench| bench.with(|encoder, cx| encoder.node_id(cx.store).unwrap().raw());
    assert_eq!((id(&mut bench), bench.encoder.bit_rate()), (7, Some(50)));
    bench.encoder.set_switches(Switches {
        node_id: 42,
        bit_rate: 3,
    });
    assert_eq!((id(&mut bench), bench.encoder.bit_rate()), (42, Some(50)));
    bench.reset(Reset::Node);
    assert_eq!(bench.encoder.bit_rate(), Some(125));
    assert_eq!(bench.read(0x2100, 0), 2, "as it is stored");
}

#[test]
fn faults_raise_errors_with_alarms_and_warnings_and_are_counted() {
    let mut bench = Bench::new(0x2000_0000);
    bench.encoder.set_fault(Fault::Position, true);
    bench.encoder.set_fault(Fault::Battery, true);
    bench.encoder.set_fault(Fault::Watchdog, true);
    bench.with(|encoder, cx| encoder.tick(cx));
    let error = |code, register, info| {
        Change::Raised(od_wire::emcy::Emcy {
            code,
            register,
            info,
        })
    };
    let position = error(0x7320, 0x81, [1, 0, 0, 0, 0]);
    let battery = error(0xFF00, 0x81, [1, 0, 0x10, 0, 0]);
    assert_eq!(bench.errors(), [position, battery]);
    bench.with(|encoder, cx| encoder.tick(cx));
    assert_eq!(bench.errors(), [], "once");
    assert_eq!((bench.read(0x6503, 0), bench.read(0x6505, 0)), (1, 0x10));
    bench.encoder.set_fault(Fault::Position, false);
    bench.with(|encoder, cx| encoder.tick(cx));
    let cleared = Change::Cleared {
        code: 0x7320,
        register: Some(0x81),
        info: [0, 0, 0x10, 0, 0],
    };
    assert_eq!(bench.errors(), [cleared]);
    bench.reset(Reset::Node);
    let watchdog = error(0x6010, 0x01, [0, 0, 0x14, 0, 0]);
    assert_eq!(
        bench.errors(),
        [error(0xFF00, 0x81, [0, 0, 0x10, 0, 0]), watchdog]
    );
    bench.reset(Reset::PowerOn);
    assert_eq!(
        bench.read(0x6505, 0),
        0x10,
        "the watchdog did not bite again"
    );
    assert_eq!(
        (bench.read(0x2201, 1), bench.read(0x2201, 3)),
        (1, 1),
        "kept without power"
    );

    let mut singleturn = Bench::new(0x2000);
    singleturn.encoder.set_fault(Fault::Battery, true);
    singleturn.with(|encoder, cx| encoder.tick(cx));
    assert_eq!(singleturn.errors(), [], "it has no battery");
}

#[test]
fn time_without_power_is_not_operating_time() {
    let mut bench = Bench::new(0x2000_0000);
    bench.now = Instant::from_millis(800_000);
    assert_eq!((bench.read(0x2201, 2), bench.read(0x6508, 0)), (800, 2));
    let next = bench.with(|encoder, cx| encoder.tick(cx));
    assert_eq!(next, Some(Instant::from_millis(1_080_000)));
    bench.encoder.power_off(bench.now);
    bench.now = Instant::from_millis(900_000);
    bench.reset(Reset::PowerOn);
    assert_eq!((bench.read(0x2201, 2), bench.read(0x6508, 0)), (800, 0));
    bench.now = Instant::from_millis(960_500);
    bench.reset(Reset::Node);
    assert_eq!((bench.read(0x2201, 2), bench.read(0x6508, 0)), (860, 0));
}
