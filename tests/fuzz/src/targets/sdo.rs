//! The SDO server with any sequence of frames: it sends the required responses and no others, and
//! a confirmed value is read back.

mod changes;
mod input;
mod model;

use super::bench::{self, Act, STEP};
use crate::harness::trace;
use crate::target::Target;
use model::Model;

pub(super) const TARGET: Target = Target {
    name: "sdo",
    run,
    make: Some(input::make),
    ..Target::PLAIN
};

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
            model.compare("without a request", &[]);
        }
    }
}
