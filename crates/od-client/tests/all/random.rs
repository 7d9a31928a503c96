//! Random frames: no panic, no growth, each job ends, and the client works afterwards.

use crate::support::{OBJECT, at, frame, pattern};
use od_client::lss::Task;
use od_client::sdo::Options;
use od_client::{CanId, Client, Duration, Event, Frame, Instant, NodeId, lss};
use od_model::Address;

/// Numbers that look random; the same seed gives the same ones.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: u64) -> u64 {
        (self.next() >> 11) % end
    }
}

/// A frame that may have a meaning: usually an SDO response with the object of the test and a small
/// command.
fn any(random: &mut Random, last: Option<Frame>) -> Frame {
    const IDS: [u16; 8] = [0x581, 0x581, 0x581, 0x582, 0x7E4, 0x701, 0x81, 0x000];
    let mut data = random.next().to_le_bytes();
    match random.below(4) {
        0 => {
            data[0] = [
                0x43, 0x41, 0x60, 0x20, 0x30, 0x00, 0x10, 0xA4, 0xC6, 0xA1, 0xA2, 0xC1,
            ][random.below(12) as usize]
        }
        1 => data = core::array::from_fn(|at| [random.below(130) as u8, 0][usize::from(at > 3)]),
        2 => {
            // A frame that is almost the response to the last request.
            let request = last.map_or([0; 8], |last| *last.bytes());
            data = [
                request[0] ^ 0x20,
                request[1],
                request[2],
                request[3],
                9,
                0,
                0,
                0,
            ];
            data[random.below(8) as usize] ^= 1 << random.below(8);
        }
        _ => {}
    }
    if random.below(2) == 0 {
        data[1..4].copy_from_slice(&[0x03, 0x20, 0x00]);
    }
    let dlc = if random.below(16) == 0 {
        random.below(9) as u8
    } else {
        8
    };
    let id = IDS[random.below(8) as usize];
    Frame::with_dlc(CanId::standard(id), data, dlc)
}

/// Sends random frames until all jobs have ended; returns their number.
fn survive(seed: u64) {
    let mut random = Random(seed * 0x9E37_79B9 + 1);
    let mut options = Options::DEFAULT;
    options.limit = 2000;
    options.block_from = [None, Some(0), Some(64)][random.below(3) as usize];
    options.block_upload = random.below(2) == 0;
    options.block_size = random.below(256) as u8;
    let mut client = Client::with(options, lss::Options::DEFAULT);
    client.watch(NodeId::ONE, Duration::from_millis(10));
    let mut open = Vec::new();
    for round in 0..6 {
        let node = [NodeId::ONE, NodeId::new(2).expect("a node ID")][round % 2];
        let len = random.below(300) as usize;
        open.push(client.read(node, OBJECT));
        open.push(client.write(node, OBJECT, &pattern(len)));
        let task = [Task::Fastscan, Task::Store, Task::IdentifyNonConfigured][round % 3];
        open.push(client.lss(task));
    }
    let mut now = Instant::ZERO;
    let mut last = None;
    let mut turns = 0;
    while !open.is_empty() {
        turns += 1;
        assert!(turns < 200_000, "seed {seed}: no end");
        let mut burst = 0;
        while let Some(frame) = client.poll_transmit(now) {
            burst += 1;
            assert!(burst < 1000, "seed {seed}: sends without end");
            last = Some(frame);
        }
        while let Some(event) = client.poll_event() {
            let end = match event {
                Event::Read(job, result) => {
                    assert!(result.is_err() || result.is_ok_and(|value| value.len() <= 2000));
                    job
                }
                Event::Written(job, _) | Event::Lss(job, _) => job,
                _ => continue,
            };
            let at = open.iter().position(|job| *job == end);
            open.remove(at.unwrap_or_else(|| panic!("seed {seed}: {end:?} ends twice")));
        }
        if random.below(4) == 0 {
            now = client.poll_timeout().unwrap_or(now).max(now);
            client.handle_timeout(now);
        } else {
            now = now.plus_micros(random.below(20_000));
            client.handle_frame(now, &any(&mut random, last));
        }
    }
    assert_eq!(
        client.poll_timeout().filter(|at| *at > now.plus_millis(10)),
        None
    );
    while client.poll_transmit(now).is_some() {}
    // The client still works.
    let job = client.read(NodeId::ONE, Address::new(0x1000, 0));
    let request = client.poll_transmit(now);
    let is_upload = request == Some(frame("601#40001000"));
    assert!(
        is_upload || options.block_upload && request.is_some(),
        "{request:?}"
    );
    client.handle_frame(now, &frame("581#4F00100007"));
    let ends = core::iter::from_fn(|| client.poll_event());
    assert!(
        ends.into_iter()
            .any(|event| event == Event::Read(job, Ok(vec![7])))
    );
}

#[test]
fn random_frames_end_every_job_and_break_nothing() {
    for seed in 0..2000 {
        survive(seed);
    }
}

/// A server that responds to every request with the same frame.
#[test]
fn a_server_with_the_same_response_to_everything() {
    for command in 0..=255u8 {
        for rest in [
            "03200000000000",
            "03200001000000",
            "032000FFFFFFFF",
            "7F7F7F7F7F7F7F",
        ] {
            for len in [0, 1, 9, 1000] {
                let mut client = Client::new();
                let jobs = [
                    client.read(NodeId::ONE, OBJECT),
                    client.write(NodeId::ONE, OBJECT, &pattern(len)),
                ];
                let answer = frame(&format!("581#{command:02X}{rest}"));
                let mut ends = Vec::new();
                let mut turns = 0;
                while ends.len() < jobs.len() {
                    turns += 1;
                    assert!(turns < 2_000, "{answer} without end");
                    let now = at(turns * 50);
                    let sent = client.poll_transmit(now).is_some();
                    client.handle_frame(now, &answer);
                    if !sent {
                        client.handle_timeout(now);
                    }
                    ends.extend(core::iter::from_fn(|| client.poll_event()));
                }
            }
        }
    }
}
