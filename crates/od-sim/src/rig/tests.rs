use od_devices::DEVICES;

use super::*;

/// A rig with one device of each of these names, in Pre-operational.
fn rig(names: &[&str]) -> Rig {
    let mut rig = Rig::default();
    for (name, node) in names.iter().zip(1..) {
        let kind = DEVICES.iter().find(|kind| kind.name == *name).unwrap();
        rig.put_kind(kind, NodeId::new(node).unwrap(), None);
    }
    run(&mut rig, 10_000);
    rig
}

/// Lets time pass; requests are sent as they come.
fn run(rig: &mut Rig, micros: u64) {
    let end = rig.bus.now().plus_micros(micros);
    loop {
        while let Some(frame) = rig.request() {
            rig.send(&frame);
        }
        rig.pass(end, usize::MAX);
        if rig.bus.now() == end && !rig.client.has_request() {
            return;
        }
    }
}

fn frames(rig: &mut Rig) -> Vec<String> {
    let text = |seen: LineEvent| match seen {
        LineEvent::Frame { frame, .. } | LineEvent::Heard { frame, .. } => frame.to_string(),
        LineEvent::Disturbed(one) => format!("lost {}", one.frame),
    };
    rig.drain().into_iter().map(text).collect()
}

#[test]
fn a_restore_leads_back_to_the_node_id_of_the_bench() {
    let mut rig = rig(&["gxmm", "eam_mt", "en580c"]);
    let kind = DEVICES.iter().find(|kind| kind.name == "eam_red").unwrap();
    rig.put_kind(kind, NodeId::new(0x10).unwrap(), None);
    for node in [1_u16, 2, 3, 0x10, 0x11] {
        let parameter = |bytes: [u8; 8]| Frame::standard(0x600 + node, &bytes);
        let reset = |node: u16| Frame::standard(0, &[0x81, node as u8]);
        let save = parameter([0x23, 0x10, 0x10, 1, b's', b'a', b'v', b'e']);
        let load = [0x23, 0x11, 0x10, 1, b'l', b'o', b'a', b'd'];
        rig.send(&parameter([0x2F, 1, 0x21, 0, 9, 0, 0, 0]));
        for frame in [save, reset(node)] {
            rig.send(&frame);
            run(&mut rig, 1_000_000);
        }
        let moved = rig.bus.devices().iter().any(|one| one.node_id().raw() == 9);
        assert!(moved, "node {node}: LSS and 2101h still act");
        rig.send(&Frame::standard(0x609, &load));
        rig.drain();
        rig.send(&reset(9));
        run(&mut rig, 1_000_000);
        let boot_up = Frame::standard(0x700 + node, &[0]).to_string();
        assert!(frames(&mut rig).contains(&boot_up), "node {node}");
    }
}

#[test]
fn the_client_reads_and_writes_over_the_bus() {
    let mut rig = rig(&["gxmm"]);
    rig.drain();
    let name = rig.read(NodeId::ONE, Address::new(0x1008, 0));
    let time = rig.write(NodeId::ONE, Address::new(0x1017, 0), &[0xF4, 1]);
    let wrong = rig.write(NodeId::ONE, Address::new(0x1000, 0), &[0; 4]);
    run(&mut rig, 1000);
    let first = rig.outcome().unwrap();
    assert_eq!(
        (first.job, first.result.as_deref()),
        (name, Ok(&b"GXMM"[..]))
    );
    assert_eq!(
        rig.outcome().map(|one| (one.job, one.result)),
        Some((time, Ok(Vec::new())))
    );
    let last = rig.outcome().unwrap();
    assert_eq!(
        (last.job, last.result),
        (wrong, Err(od_client::Error::Abort(0x0601_0002)))
    );
    assert_eq!(rig.outcome(), None);
    assert_eq!(
        frames(&mut rig)[..2],
        ["601#4008100000000000", "581#4308100047584D4D"]
    );
}

#[test]
fn a_silent_node_is_asked_once_and_gets_no_abort() {
    let mut rig = rig(&["gxmm"]);
    rig.drain();
    let other = NodeId::new(9).unwrap();
    let job = rig.read(other, Address::new(0x1000, 0));
    run(&mut rig, 499_999);
    assert_eq!(rig.outcome(), None);
    run(&mut rig, 1);
    let silent = rig.outcome().map(|one| (one.job, one.result));
    assert_eq!(silent, Some((job, Err(od_client::Error::Silent))));
    assert_eq!(frames(&mut rig), ["609#4000100000000000"]);
}

#[test]
fn a_transfer_ends_with_its_bus() {
    let mut rig = rig(&["gxmm"]);
    let job = rig.read(NodeId::new(9).unwrap(), Address::new(0x1000, 0));
    rig.clear();
    assert_eq!(rig.bus.devices().len(), 0);
    assert_eq!(
        rig.outcome().map(|one| (one.job, one.result)),
        Some((job, Err(od_client::Error::Silent)))
    );
    let next = rig.read(NodeId::ONE, Address::new(0x1000, 0));
    assert_ne!(job, next);
}
