//! Angles between samples, and how far back they reach.

use super::super::track::{Track, scaled};

#[test]
fn angles_between_samples_change_evenly() {
    let mut track: Track<4> = Track::new();
    assert_eq!((track.back(0), track.age(77)), (None, 0));
    track.add(100, 1000);
    track.add(110, 3000);
    track.add(130, -1000);
    assert_eq!(track.age(131), 1);
    let angles = [0, 5, 20, 25, 30, 31].map(|back| track.back(back));
    let expected = [-1000, 0, 3000, 2000, 1000];
    assert_eq!(angles[..5], expected.map(Some));
    assert_eq!(angles[5], None);
    track.clear();
    assert_eq!(track.back(0), None);
}

#[test]
fn it_reaches_as_far_as_it_is_told() {
    for (spacing, reach) in [(1, 2), (3, 50), (10, 65_535), (7, 1000)] {
        let mut track: Track<5> = Track::new();
        track.reach(reach);
        // Across the end of the times.
        let mut at = u32::MAX - 100;
        for step in 0..20_000i64 {
            track.add(at, step * spacing);
            assert_eq!(track.age(at), 0);
            let age = u64::from(reach).min(step as u64 * spacing as u64);
            let angle = step * spacing - age as i64;
            let back = track.back(age as u32).expect("it reaches there");
            assert!((back - angle).abs() <= 1, "{reach}: {back} {angle}");
            at = at.wrapping_add(spacing as u32);
        }
    }
}

#[test]
fn a_second_sample_of_a_moment_replaces_the_first() {
    let mut track: Track<3> = Track::new();
    track.add(1, 10);
    track.add(1, 20);
    track.add(2, 30);
    assert_eq!((track.back(0), track.back(1)), (Some(30), Some(20)));
}

#[test]
fn a_number_is_scaled_exactly() {
    for number in [0, 1, -1, 7 << 40, -(7 << 40) - 3, i64::MAX, i64::MIN] {
        for fraction in [0, 1, 1 << 31, u32::MAX] {
            let exact = (i128::from(number) * i128::from(fraction)) >> 32;
            assert_eq!(i128::from(scaled(number, fraction)), exact);
        }
    }
}
