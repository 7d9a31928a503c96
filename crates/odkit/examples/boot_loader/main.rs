//! A boot loader: a master writes a program of 64 KiB to 1F50h:01 and starts it with 1F51h:01 (CiA
//! 302-3). The program is never in RAM as a whole: the SDO server has one block of it at a time,
//! the loader one page. While the flash is busy, the master waits for the response.
//!
//! `cargo run -p odkit --example boot_loader` plays the master, too.

#![allow(unreachable_pub)] // `loader.rs` is a file to copy

mod loader;
mod rig;

use od_client::Event;
use odkit::NodeId;
use rig::Rig;

fn main() {
    let program: Vec<u8> = (0..loader::SIZE).map(|at| (at * 31 % 251) as u8).collect();
    let mut rig = Rig::new();

    let written = rig.client.write(NodeId::ONE, loader::PROGRAM, &program);
    let read = rig.client.read(NodeId::ONE, loader::PROGRAM);
    let started = rig.client.write(NodeId::ONE, loader::CONTROL, &[1]);
    let expected = [
        Event::Written(written, Ok(())),
        Event::Read(read, Ok(program)),
        Event::Written(started, Ok(())),
    ];
    assert!(rig.run() == expected, "the program did not arrive");
    let arrived = rig
        .node
        .application
        .program()
        .map(|program| program.len as usize);
    assert_eq!(arrived, Some(loader::SIZE));
    assert!(rig.node.application.is_running());
    println!(
        "{} bytes written, read back and started: {} frames in {} ms",
        loader::SIZE,
        rig.frames,
        rig.now.as_micros() / 1000
    );
}

#[test]
fn the_program_arrives_and_starts() {
    main();
}
