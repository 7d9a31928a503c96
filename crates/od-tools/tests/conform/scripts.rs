//! Cases that are scripts: in the language of `odkit run`, on any link.

use od_tools::bench::OnBench;
use od_tools::conform::case::Case;
use od_tools::conform::eds::Eds;
use od_tools::conform::record::Verdict;
use od_tools::conform::session::{Permissions, Session};
use od_wire::NodeId;

fn case(steps: &str) -> Result<Case, String> {
    let text = format!("# Vendor 1.2: A rule.\n{steps}");
    Case::parse("own", &text).map_err(|mistake| mistake.to_string())
}

fn verdict(steps: &str) -> Verdict {
    let kind = od_devices::find("gxmm").expect("a device");
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = OnBench(super::simulated::bus("gxmm"));
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::ALL);
    session.run(&case(steps).expect("a case")).verdict
}

#[test]
fn a_line_that_cannot_be_read_is_refused_with_its_place() {
    for (steps, message) in [
        (
            "sdo write 1017h = 5 as u61\n",
            "own.script:2: type `u61` does not exist; write u8, u16, u32, i16 …",
        ),
        (
            "sync\n\nexpect silence 1 s\n",
            "own.script:4: `1` is not a duration; write 500ms, 1.5s, 20us or 2min",
        ),
        (
            "$600#4\n",
            "own.script:2: half a byte; write 0 to 8 bytes of two hex digits each",
        ),
    ] {
        assert_eq!(case(steps).map(|case| case.id), Err(message.into()));
    }
}

#[test]
fn every_line_for_a_bus_is_played() {
    for steps in [
        "sdo write 1017h = 50 as u16\nexpect $700#7F after 50ms\nexpect $700#7F 3 times every 50ms\n",
        "sdo write 1017h = 1 as u8 aborts 08000000h\n",
        "nmt reset\nexpect boot-up within 2s\n",
        "read 1000h\nexpect read 1000h\nsdo read 1F50h aborts 06020000h\n",
        "send $600#40 00 10 00 00 00 00 00 3 times every 10ms\nexpect $580#43 * 3 times\n",
        "at 1s sync\nat 2s $600#40 00 10 00 00 00 00 00\nexpect $580#43 *\n",
    ] {
        assert_eq!(verdict(steps), Verdict::Pass, "{steps}");
    }
}

#[test]
fn a_line_that_does_not_hold_fails_the_case() {
    for (steps, expected, got) in [
        (
            "expect boot-up within 1s\n",
            "boot-up within 1s",
            "nothing came",
        ),
        (
            "nmt reset\nexpect silence 2s\n",
            "silence 2s",
            "701#00 came",
        ),
        (
            "sdo read 1017h = 5 # The value is 0.\n",
            "1017h = 05 00",
            "00 00 was read",
        ),
        (
            "sdo write 1017h = 5 aborts 06090030h\n",
            "abort",
            "it succeeded",
        ),
    ] {
        match verdict(steps) {
            Verdict::Fail {
                expected: wanted,
                got: came,
            } => {
                assert!(wanted.contains(expected), "{steps}: {wanted}");
                assert!(came.contains(got), "{steps}: {came}");
            }
            other => panic!("{steps}: {other:?}"),
        }
    }
}

#[test]
fn a_line_about_a_simulated_device_skips_the_case() {
    for line in [
        "power off",
        "shaft rpm 60",
        "device gxmm",
        "expect state operational",
    ] {
        let why = format!("`{line}` is about a simulated device; `odkit run` plays it");
        assert_eq!(verdict(&format!("{line}\n")), Verdict::Skipped(why));
    }
}
