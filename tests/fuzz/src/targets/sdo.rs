//! The SDO server against any sequence of frames: it answers what it must and nothing else, and
//! what it acknowledged is what is read.

mod changes;
mod input;
mod model;

use super::bench::{self, Act, STEP};
use crate::target::Target;
use crate::trace::trace;
use model::Model;

pub(super) const TARGET: Target = Target {
    name: "sdo",
    run,
    make: Some(input::make),
    frames: Some(frames_of),
    unit: STEP,
    ..Target::PLAIN
};

/// Number of frames in an input.
fn frames_of(input: &[u8]) -> u64 {
    let steps = input.chunks_exact(STEP).skip(1);
    steps.filter(|step| step[0] % 40 < 31).count() as u64
}

fn run(input: &[u8]) {
    let mut steps = input.chunks_exact(STEP);
    let Some(head) = steps.next() else {
        return;
    };
    let number = usize::from(head[0]) % bench::kinds();
    let mut model = Model::new(number);
    for (count, step) in steps.enumerate() {
        let step = step.try_into().expect("chunks are that long");
        let node = model.node();
        let act = bench::act(step, &model.entries, node);
        trace(|| format!("> {act:?}"));
        match act {
            Act::Frame(frame) => model.send(&frame),
            Act::Time(micros) => model.wait(micros),
            _ => {}
        }
        if count % 64 == 0 {
            model.compare("of their own accord", &[]);
        }
    }
}
