//! Limits of a repeated run: it may come from a link of unknown origin.

use std::prelude::v1::*;

use od_wire::Instant;

use super::field::Error;
use super::input::{Entry, Input};
use crate::script::Limits;

/// Limit of devices on the bus, counting each channel of a redundant one.
pub(super) const MOST_DEVICES: usize = Limits::PAGE.devices;
/// Longest run in microseconds: a day.
const LONGEST: u64 = 86_400_000_000;
/// Shortest period of a cyclic frame, in microseconds.
const SHORTEST: u32 = 100;
/// Limit of frames from periodic inputs.
const MOST_FRAMES: u64 = 10_000_000;

/// Adds up the needs of a run to the time `until` before it starts. The lines of
/// scripts and lessons are checked when they are read.
///
/// # Errors
/// The limit that the run exceeds.
pub fn check(entries: &[Entry], until: Instant) -> Result<(), Error> {
    let last = entries.last().map_or(until, |entry| entry.at.max(until));
    if last.as_micros() > LONGEST {
        return Err(Error::Time);
    }
    let (mut devices, mut frames) = (0_usize, 0_u64);
    for (number, entry) in entries.iter().enumerate() {
        match entry.input {
            Input::Add { place, .. } => {
                devices += usize::from(place.is_none_or(|place| usize::from(place) >= devices));
            }
            Input::Remove { .. } => devices = devices.saturating_sub(1),
            Input::Lesson { .. } => devices = 0,
            Input::Repeat { key, micros, .. } if micros > 0 => {
                let is_end = |one: &&Entry| match one.input {
                    Input::Repeat { key: other, .. } => other == key,
                    Input::Lesson { .. } => true,
                    _ => false,
                };
                let behind = &entries[number + 1..];
                let end = behind.iter().find(is_end).map_or(last, |one| one.at);
                frames += end.micros_since(entry.at) / u64::from(micros.max(SHORTEST));
            }
            _ => {}
        }
        if devices > MOST_DEVICES {
            return Err(Error::Devices);
        }
        if frames > MOST_FRAMES {
            return Err(Error::Frames);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::parts::Source;
    use super::*;

    fn add(place: Option<u8>) -> Input {
        let name = "gxmm".into();
        let source = Source::Builtin { name };
        Input::Add {
            source,
            node_id: 1,
            place,
        }
    }

    fn repeat(micros: u32) -> Input {
        Input::Repeat {
            key: 1,
            id: 0x80,
            data: Vec::new(),
            extended: false,
            remote: false,
            micros,
        }
    }

    fn run(inputs: impl IntoIterator<Item = Input>, seconds: u64) -> Result<(), Error> {
        let at = Instant::ZERO;
        let entries: Vec<_> = inputs
            .into_iter()
            .map(|input| Entry { at, input })
            .collect();
        check(&entries, Instant::from_micros(seconds * 1_000_000))
    }

    #[test]
    fn a_run_within_its_limits_passes() {
        assert_eq!(run((0..16).map(|_| add(None)), 86_400), Ok(()));
        assert_eq!(run((0..2000).map(|_| add(Some(0))), 1), Ok(()));
        assert_eq!(
            run([repeat(1000), repeat(0)], 86_400),
            Ok(()),
            "it ends at once"
        );
        let goes = (0..100).flat_map(|_| [add(None), Input::Remove { node: 0 }]);
        assert_eq!(run(goes, 1), Ok(()));
    }

    #[test]
    fn each_limit_is_checked() {
        assert_eq!(run((0..17).map(|_| add(None)), 1), Err(Error::Devices));
        assert_eq!(run([add(None)], 86_401), Err(Error::Time));
        assert_eq!(run([repeat(1000)], 86_400), Err(Error::Frames));
        assert_eq!(
            run([repeat(1)], 1001),
            Err(Error::Frames),
            "100 us at the least"
        );
    }

    #[cfg(feature = "lessons")]
    #[test]
    fn scripts_and_lessons_of_a_journal_have_limits() {
        use super::super::{InputProblem, Journal};
        use std::format;

        let mut journal = Journal::new(od_devices::DEVICES);
        journal.restore(Vec::new(), false);
        journal.act(add(None));
        let at = journal.rig.bus.now();
        for text in ["wait 1000000000s", &"device gxmm\n".repeat(2000)] {
            let added = journal.act(Input::Script { text: text.into() });
            assert!(
                matches!(added.problem, InputProblem::Message(why) if why.contains("limit") || why.contains("room"))
            );
            assert_eq!(journal.rig.bus.now(), at, "nothing of it happened");
        }
        // Frames of devices count when they come: 1800h:05 is 1 ms.
        let text = "send 601#2B 00 18 05 01 00\nnmt start\nwait 500s";
        let added = journal.act(Input::Script { text: text.into() });
        assert!(
            matches!(&added.problem, InputProblem::Message(why) if why.contains("100000 frames")),
            "{:?}",
            added.problem
        );
        let lesson = "+++\ntitle = \"x\"\nlevel = 1\nminutes = 1\n+++\n```set-up\ndevice gxmm\nwait 1000000000s\n```\n\n\
            ## One\ntext\n```checkpoint\nstate operational\n```\n### Hint\nx\n```solution\nnmt start\n```\n\
            ### What just happened\nx\n";
        let added = journal.act(Input::Lesson {
            text: lesson.into(),
        });
        assert!(added.node.is_none());
        assert!(
            matches!(&added.problem, InputProblem::Problems(all) if format!("{all:?}").contains("limit")),
            "{:?}",
            added.problem
        );
    }
}
