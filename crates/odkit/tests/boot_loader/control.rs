//! 1F51h, 1F56h and 1F57h.

use od_client::Event;
use odkit::{Instant, NodeId};

use super::loader::CONTROL;
use super::{Rig, round_trip};

#[test]
fn program_control_needs_a_program() {
    let mut rig = Rig::new();
    assert_eq!(rig.ask("2F511F0101000000"), "80511F0124000008");
    round_trip(&mut rig, 300);
    assert_eq!(rig.ask("2F511F0101000000"), "60511F0100000000");
    assert!(rig.node.application.is_running());
    assert_eq!(rig.ask("40511F0100000000"), "4F511F0101000000");
    assert_eq!(rig.ask("21501F0105000000"), "80501F0122000008", "it runs");
    assert_eq!(rig.ask("2F511F0103000000"), "80511F0122000008");
    assert_eq!(rig.ask("2F511F0100000000"), "60511F0100000000");
    assert_eq!(rig.ask("2F511F0103000000"), "60511F0100000000");
    assert_eq!(rig.ask("40501F0100000000"), "80501F0124000008", "erased");
}

#[test]
fn identification_and_status_are_those_of_the_program() {
    let mut rig = Rig::new();
    // No valid program: code 1.
    assert_eq!(rig.ask("40561F0100000000"), "43561F0100000000");
    assert_eq!(rig.ask("40571F0100000000"), "43571F0102000000");
    assert_eq!(rig.send("27501F0131323300"), [""; 0]);
    rig.wait_until(Instant::from_millis(80));
    assert_eq!(rig.answers(), ["60501F0100000000"]);
    // The CRC-32 of "123", while a page is being written.
    assert_eq!(rig.send("40561F0100000000"), ["43561F01D2634888"]);
    assert_eq!(rig.send("40571F0100000000"), ["43571F0101000000"]);
    assert_eq!(
        rig.send("2F511F0101000000"),
        ["80511F0122000008"],
        "not yet"
    );
    let due = rig.due().expect("the flash is busy");
    assert_eq!(due, Instant::from_micros(80_400));
    rig.wait_until(due);
    assert_eq!(rig.ask("40571F0100000000"), "43571F0100000000");
    assert_eq!(rig.ask("2F511F0104000000"), "80511F0131000906");
    let started = rig.client.write(NodeId::ONE, CONTROL, &[1]);
    assert_eq!(rig.run(), [Event::Written(started, Ok(()))]);
    assert_eq!(rig.ask("40511F0100000000"), "4F511F0101000000");
    assert_eq!(rig.ask("2F511F0102000000"), "60511F0100000000");
    assert_eq!(rig.ask("40511F0100000000"), "4F511F0100000000");
    assert_eq!(rig.ask("2F511F0103000000"), "60511F0100000000");
    assert_eq!(rig.ask("40561F0100000000"), "43561F0100000000");
    assert_eq!(
        rig.ask("40571F0100000000"),
        "43571F0103000000",
        "it erases itself"
    );
}
