//! Tests of a profile's encoder: roles, offsets, ranges.

use super::*;
use crate::encoder::profile::Parts;

/// A family with one object of this role, or with none.
macro_rules! family {
    ($name:ident, $($role:expr)?) => {
        struct $name;

        impl Family for $name {
            const PROFILE: Option<&'static EncoderProfile> = {
                static OF: EncoderProfile = EncoderProfile {
                    objects: &[
                        (Address::new(0x2000, 0), Role::NodeId),
                        $((Address::new(0x2001, 0), $role),)?
                        (Address::new(0x2002, 0), Role::Cycles),
                    ],
                    ..EncoderProfile::CIA406
                };
                Some(&OF)
            };
        }
    };
}

const SPEED: Movement = Movement {
    quantity: Quantity::Speed,
    selector: None,
    sources: &[(0, Source::Raw)],
    interval: Address::new(0x2003, 0),
    factor: None,
};

family!(Plain,);
family!(Stamped, Role::TimeStamp);
family!(Raw, Role::RawPosition);
family!(Diagnosed, Role::Diagnosis(&[]));
family!(Moving, Role::Movement(SPEED));
family!(Faked, Role::InjectedError);
family!(Shifted, Role::InjectedOffset);

#[test]
fn the_compiler_knows_the_parts_of_a_family() {
    fn parts<F: Family>() -> [bool; 6] {
        let parts = Parts::of::<F>();
        [
            parts.time_stamp,
            parts.raw_position,
            parts.diagnosis,
            parts.movement,
            parts.injected_error,
            parts.injected_offset,
        ]
    }
    let all = [
        parts::<Stamped>(),
        parts::<Raw>(),
        parts::<Diagnosed>(),
        parts::<Moving>(),
        parts::<Faked>(),
        parts::<Shifted>(),
    ];
    for (at, parts) in all.iter().enumerate() {
        assert_eq!(*parts, core::array::from_fn(|of| of == at), "{at}");
    }
    assert_eq!(parts::<Plain>(), [false; 6]);
    assert_eq!(parts::<AnyFamily>(), [true; 6]);
}

#[test]
fn an_encoder_knows_what_it_computes() {
    static SHOWN: EncoderProfile = EncoderProfile {
        total: Total::Shown,
        objects: &[(Address::new(0x2202, 0), Role::Cycles)],
        ..EncoderProfile::CIA406
    };
    let of = |profile, index, sub| {
        let encoder = Encoder::new(profile, Still(Angle::ZERO));
        let address = Address::new(index, sub);
        (encoder.computes(address), encoder.is_live(address))
    };
    for (index, sub, computes, is_live) in [
        (0x6004, 0, true, true),
        (0x6500, 0, true, false),
        (0x6503, 0, true, false),
        (0x6505, 0, true, false),
        (0x6509, 0, true, false),
        (0x6501, 0, false, false),
        (0x6502, 0, false, false),
        (0x6000, 0, false, false),
        (0x6508, 0, true, true),
        (0x1029, 1, false, false),
        (0x2201, 1, true, false),
        (0x2201, 2, true, true),
        (0x2201, 3, true, false),
        (0x2201, 4, false, false),
    ] {
        assert_eq!(of(&PROFILE, index, sub), (computes, is_live), "{index:X}");
    }
    assert!(of(&SHOWN, 0x6502, 0).0);
    assert!(!of(&SHOWN, 0x6501, 0).0);
    assert_eq!(of(&SHOWN, 0x2202, 0), (true, false));
    let encoder = Encoder::new(&PROFILE, Still(Angle::ZERO));
    assert_eq!(encoder.serial_number(), None);
    let encoder = encoder.with_serial_number(4711);
    assert_eq!(encoder.serial_number(), Some(4711));
}

/// An encoder of another family with the same objects, which has had power for a while.
pub(super) fn bench(profile: &'static EncoderProfile) -> Bench {
    let mut bench = Bench::new(0x2000_0000);
    bench.encoder = Encoder::new(profile, Still(Angle::ZERO));
    bench.reset(Reset::PowerOn);
    bench.errors();
    bench
}

#[test]
fn a_signed_offset_is_one_of_32_bits() {
    static SIGNED: EncoderProfile = EncoderProfile {
        sensor: Some(Sensor {
            steps: 0x1_0000,
            turns: 0x1_0000,
        }),
        ..EncoderProfile::CIA406
    };
    for (count, preset, offset) in [
        (0, 2_147_483_647, 2_147_483_647),
        (0, 2_147_483_648, -852_516_352),
        (0, 2_500_000_000, -500_000_000),
        (1_000_000_000, 0, -1_000_000_000),
        (2_147_483_648, 0, -2_147_483_648),
        (2_147_483_649, 0, 852_516_351),
        (2_500_000_000, 0, 500_000_000),
        (7, 7, 0),
    ] {
        let mut bench = Bench::new(3_000_000_000);
        bench.encoder = Encoder::new(&SIGNED, Still(Angle::ZERO));
        bench.write(0x6001, 0, 0x2000).unwrap_or_default();
        bench.with(|_, cx| cx.store.set_unsigned(Address::new(0x6001, 0), 0x1_0000));
        bench.with(|encoder, cx| encoder.reset(cx, Reset::Communication));
        bench.at(count);
        bench.write(0x6003, 0, preset).unwrap();
        assert_eq!(bench.position(), preset);
        let shown = bench.read(0x6509, 0) as u32 as i32;
        assert_eq!(i64::from(shown), offset, "{count} {preset}");
    }
}

#[test]
fn ranges_go_by_the_rule_of_the_family() {
    use AbortCode::{ValueRange, ValueTooHigh};
    const fn rule(range_rule: RangeRule, zero_is_full: bool) -> EncoderProfile {
        EncoderProfile {
            sensor: Some(Sensor {
                steps: 0x2000,
                turns: 0x10,
            }),
            range_rule,
            zero_is_full,
            below_limit: ValueRange,
            ..EncoderProfile::CIA406
        }
    }
    static SENSOR: EncoderProfile = rule(RangeRule::Sensor, false);
    static SENSOR_FULL: EncoderProfile = rule(RangeRule::Sensor, true);
    static POWER: EncoderProfile = rule(RangeRule::PowerOfTwo, false);
    static POWER_FULL: EncoderProfile = rule(RangeRule::PowerOfTwo, true);
    static TURNS: EncoderProfile = rule(RangeRule::Turns, false);
    static TURNS_FULL: EncoderProfile = rule(RangeRule::Turns, true);
    for (profile, value, answer) in [
        (&SENSOR, 0, Err(ValueRange)),
        (&SENSOR, 1, Ok(())),
        (&SENSOR, 0x2_0000, Ok(())),
        (&SENSOR, 0x2_0001, Err(ValueTooHigh)),
        (&SENSOR_FULL, 0, Ok(())),
        (&SENSOR_FULL, 0x2_0001, Err(ValueTooHigh)),
        (&POWER, 0, Err(ValueRange)),
        (&POWER_FULL, 0, Ok(())),
        (&POWER, 1000, Ok(())),
        (&POWER, 2000, Ok(())),
        (&POWER, 3000, Err(ValueRange)),
        (&POWER, 4001, Err(ValueRange)),
        (&POWER, 500, Err(ValueRange)),
        (&POWER, 1000 << 20, Ok(())),
        (&TURNS, 0, Err(ValueRange)),
        (&TURNS_FULL, 0, Err(ValueRange)),
        (&TURNS, 16_000, Ok(())),
        (&TURNS, 16_001, Err(ValueTooHigh)),
    ] {
        let mut bench = bench(profile);
        bench.write(0x6001, 0, 1000).unwrap();
        assert_eq!(bench.write(0x6002, 0, value), answer, "{value}");
        if value == 0 && answer.is_ok() {
            assert_eq!(bench.encoder.scale().range(), 1 << 32);
        }
    }
}
