//! Lines for a running bench: each is carried out or refused, and none stops the
//! others.

use od_sim::Bus;
use od_sim::script::{Bench, Console};

use super::bench;
use super::script::WORDS;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "console",
    run,
    seeds: || {
        [
            "601#4000100000000000\npower cycle 2s\nuse 2\nnmt start\nshaft rpm 60\nwait 100ms\n",
            "(0.1) can0 601#4004600000000000\n(0.2) can0 701#R\nfault battery-low on\nsync\n",
        ]
        .map(|text| text.as_bytes().to_vec())
        .to_vec()
    },
    words: WORDS,
    is_text: true,
    longest: 1024,
    ..Target::PLAIN
};

fn run(input: &[u8]) {
    let mut bus = Bus::new();
    for number in [0, bench::number_of("eam_mt")] {
        let device = bus.add(bench::device(number));
        bus.start(device);
    }
    let mut bench = Bench::new(bus);
    let mut console = Console::default();
    for line in String::from_utf8_lossy(input).lines() {
        if let Err(problem) = console.push(line) {
            assert!(
                problem.column <= line.chars().count() + 1,
                "{problem}: {line:?}"
            );
        }
    }
    // A line may send a frame four billion times.
    for _ in 0..200 {
        while let Some(done) = console.step(&mut bench) {
            if let Ok(Some(frame)) = done {
                bench.bus.receive(&frame);
            }
            if console
                .deadline(bench.bus.now())
                .is_some_and(|at| at <= bench.bus.now())
                && bench.bus.now().as_micros() > 10_000_000
            {
                return;
            }
            while bench.bus.poll().is_some() {}
        }
        match console.deadline(bench.bus.now()) {
            Some(at) if at.as_micros() < 60_000_000 => bench.bus.advance(at),
            Some(_) => return,
            None => break,
        }
    }
    assert!(console.is_idle() || console.deadline(bench.bus.now()).is_some());
}
