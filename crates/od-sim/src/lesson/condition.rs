//! Conditions of a checkpoint, as data.

use std::format;
use std::prelude::v1::*;

use od_runtime::Frame;

use crate::device::VirtualDevice;
use crate::grammar::duration::duration;
use crate::grammar::fact::Fact;
use crate::grammar::frames::Frames;
use crate::grammar::pattern::Pattern;
use crate::script::Origin;

/// One line of a checkpoint: one of its alternatives must hold.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Line {
    /// Line number in the lesson.
    pub(super) line: u32,
    /// The frame must come after the frame of the previous line.
    pub(super) then: bool,
    pub(super) alternatives: Vec<Alternative>,
    /// Text to show instead of the condition in words.
    pub(super) say: Option<String>,
}

#[derive(Clone, PartialEq, Debug)]
pub(super) struct Alternative {
    pub(super) not: bool,
    pub(super) what: What,
    /// Number or label of the device; `None`: any sender, or the first device.
    pub(super) device: Option<String>,
    /// It must hold for this time without a break, in microseconds.
    pub(super) lasting: u64,
}

#[derive(Clone, PartialEq, Debug)]
pub(super) enum What {
    /// A frame came since the step began.
    Seen(Seen),
    /// The condition holds now.
    Fact(Fact),
    /// No such frame comes.
    Quiet(Pattern),
    /// No frame is disturbed on the bus line.
    Undisturbed,
    /// This number of error frames came since the step began.
    Disturbed(u32),
}

/// Sender of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Who {
    Learner,
    Device,
    Anybody,
}

/// Expected frames.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Seen {
    pub(super) who: Who,
    pub(super) what: Frames,
    pub(super) times: u32,
    /// Shortest and longest time from one frame to the next, in microseconds.
    pub(super) every: Option<(u64, u64)>,
    /// Longest time after the event of the previous line, in microseconds.
    pub(super) within: Option<u64>,
}

impl Line {
    /// Returns whether all alternatives are frames.
    pub(super) fn waits(&self) -> bool {
        let seen =
            |one: &Alternative| !one.not && matches!(one.what, What::Seen(_) | What::Disturbed(_));
        self.alternatives.iter().all(seen)
    }

    /// The line in words, without the parts that are still missing.
    pub(super) fn words(&self, devices: &[VirtualDevice], at: impl Fn(&str) -> usize) -> String {
        if let Some(say) = &self.say {
            return say.clone();
        }
        let words = |one: &Alternative| {
            let device = devices.get(one.device.as_deref().map_or(0, &at));
            one.words(devices, device)
        };
        let all: Vec<_> = self.alternatives.iter().map(words).collect();
        let then = if self.then { "after that " } else { "" };
        format!("{then}{}", all.join(", or "))
    }
}

impl Alternative {
    fn words(&self, devices: &[VirtualDevice], device: Option<&VirtualDevice>) -> String {
        let mut text = match &self.what {
            What::Seen(seen) if self.not => {
                return format!("no device sends {} in between", seen.what.words(devices));
            }
            What::Seen(seen) => return seen.words(devices, self.device.as_deref()),
            What::Fact(fact) => {
                let name = self.device.as_ref();
                let whose = name.map_or(String::new(), |name| format!(" of device {name}"));
                fact.words(device, &whose, self.not)
            }
            What::Quiet(one) if self.not => format!("`{one}` comes"),
            What::Quiet(one) => format!("`{one}` no longer comes"),
            What::Undisturbed => "no frame is disturbed on the bus line".into(),
            What::Disturbed(1) => "an error frame comes".into(),
            What::Disturbed(times) => format!("{times} error frames come"),
        };
        if self.lasting > 0 {
            text.push_str(&format!(", for {}", duration(self.lasting)));
        }
        text
    }
}

impl Seen {
    /// Returns whether a frame matches. `device` is the number of the device that must send it.
    pub(super) fn matches(&self, origin: Origin, device: Option<usize>, frame: &Frame) -> bool {
        let by = match (self.who, origin) {
            (Who::Learner, Origin::Script) | (Who::Anybody, _) => true,
            (Who::Device, Origin::Device(sender)) => device.is_none_or(|wanted| wanted == sender),
            _ => false,
        };
        by && self.what.matches(frame)
    }

    fn words(&self, devices: &[VirtualDevice], device: Option<&str>) -> String {
        let what = self.what.words(devices);
        let mut text = match (self.who, device, &self.what) {
            (_, _, Frames::Read(_) | Frames::Written(_)) => what,
            (Who::Learner, _, _) => format!("you send {what}"),
            (Who::Device, Some(device), _) => format!("device {device} sends {what}"),
            (Who::Device, None, _) => format!("a device sends {what}"),
            (Who::Anybody, ..) => format!("a device or you send {what}"),
        };
        if self.times > 1 {
            text.push_str(&format!(", {} times", self.times));
        }
        match self.every {
            Some((low, high)) if low == high => {
                text.push_str(&format!(", every {}", duration(low)));
            }
            Some((low, high)) => {
                text.push_str(&format!(", {} to {} apart", duration(low), duration(high)));
            }
            None => {}
        }
        if let Some(within) = self.within {
            text.push_str(&format!(", within {}", duration(within)));
        }
        text
    }
}
