//! What a checkpoint asks for, in words.

use std::format;
use std::prelude::v1::*;

use od_model::Address;
use od_runtime::Frame;
use od_wire::nmt::Command;

use super::condition::{Alternative, Fact, Frames, How, Kind, Line, Seen, Test, What, Who};
use crate::device::VirtualDevice;
use crate::script::Pattern;
use crate::script::expect::duration;
use crate::words;
use od_model::values;

impl Line {
    /// The line in words, without what is missing of it.
    pub(super) fn words(&self, devices: &[VirtualDevice], at: impl Fn(&str) -> usize) -> String {
        if let Some(say) = &self.say {
            return say.clone();
        }
        let words = |one: &Alternative| match &one.what {
            What::Seen(seen) if one.not => format!("meanwhile nobody sends {}", seen.what(devices)),
            What::Seen(seen) => seen.words(devices),
            What::Fact(fact) => fact.words(devices, fact.device.as_deref().map_or(0, &at), one.not),
        };
        let all: Vec<_> = self.alternatives.iter().map(words).collect();
        let then = if self.then { "after that " } else { "" };
        format!("{then}{}", all.join(", or "))
    }
}

impl Seen {
    fn words(&self, devices: &[VirtualDevice]) -> String {
        let what = self.what(devices);
        let mut text = match (self.who, &self.device, &self.what) {
            (_, _, Frames::Read(_) | Frames::Written(_)) => what,
            (Who::Learner, _, _) => format!("you send {what}"),
            (Who::Device, Some(device), _) => format!("device {device} sends {what}"),
            (Who::Device, None, _) => format!("a device sends {what}"),
            (Who::Anybody, ..) => format!("somebody sends {what}"),
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

    fn what(&self, devices: &[VirtualDevice]) -> String {
        match &self.what {
            Frames::Pattern(one) => pattern(devices, one),
            Frames::Nmt(command, node) => {
                let name = match command {
                    Command::Start => "NMT start",
                    Command::Stop => "NMT stop",
                    Command::EnterPreOperational => "NMT enter Pre-operational",
                    Command::ResetNode => "NMT reset node",
                    Command::ResetCommunication => "NMT reset communication",
                };
                match node {
                    None => name.into(),
                    Some(0) => format!("{name} to all nodes"),
                    Some(node) => format!("{name} to node {node}"),
                }
            }
            Frames::BootUp => "a boot-up message".into(),
            Frames::Emcy(None) => "an EMCY".into(),
            Frames::Emcy(Some(code)) => {
                format!("EMCY {code:04X}h ({})", words::code_text(*code))
            }
            Frames::Abort(None) => "an SDO abort".into(),
            Frames::Abort(Some(code)) => format!("SDO abort {code}"),
            Frames::Read(address) => format!("{} is read", label(devices.first(), *address)),
            Frames::Written(address) => format!("{} is written", label(devices.first(), *address)),
        }
    }
}

/// A frame with gaps, and what it says where there are none.
fn pattern(devices: &[VirtualDevice], pattern: &Pattern) -> String {
    let whole: Option<Vec<u8>> = match pattern.bytes() {
        Some(bytes) if !pattern.is_open() => bytes.iter().copied().collect(),
        _ => None,
    };
    match whole.and_then(|bytes| Frame::new(pattern.id(), &bytes)) {
        Some(frame) => {
            let said = words::explain(devices, &frame);
            format!("`{pattern}` ({said})")
        }
        None => format!("`{pattern}`"),
    }
}

impl Fact {
    fn words(&self, devices: &[VirtualDevice], device: usize, not: bool) -> String {
        let one = devices.get(device);
        let is = if not { "is not" } else { "is" };
        let whose = match (&self.device, one) {
            (Some(name), _) => format!(" of device {name}"),
            (None, _) => String::new(),
        };
        let mut text = match &self.kind {
            Kind::Value(address, test) => {
                format!("{}{whose} {is} {}", label(one, *address), test.words())
            }
            Kind::Saved(address, test) => {
                let what = test.as_ref().map_or("what it is now".into(), Test::words);
                format!("{}{whose} in the EEPROM {is} {what}", label(one, *address))
            }
            Kind::Undisturbed => "no frame is disturbed on the wire".into(),
            Kind::Terminators(test) => format!("the wire has {} terminators", test.words()),
            Kind::State(state) => format!("the NMT state{whose} {is} {state}"),
            Kind::Led { green, led } => {
                let colour = if *green { "green" } else { "red" };
                format!("the {colour} LED{whose} {is} {}", led.name())
            }
            Kind::NodeId(test) => format!("the node ID{whose} {is} {}", test.words()),
            Kind::BitRate(test) => format!("the bit rate{whose} {is} {} kbit/s", test.words()),
            Kind::Turned(test) => {
                let turned = if not { "has not" } else { "has" };
                format!(
                    "the shaft{whose} {turned} turned {} revolutions",
                    test.words()
                )
            }
            Kind::Rpm(test) => format!("the speed{whose} {is} {} rpm", test.words()),
            Kind::Broken(name) => format!("the fault {name}{whose} {is} there"),
            Kind::Quiet(one) => {
                let comes = if not { "comes" } else { "no longer comes" };
                format!("`{one}` {comes}")
            }
        };
        if self.lasting > 0 {
            text.push_str(&format!(", for {}", duration(self.lasting)));
        }
        text
    }
}

impl Test {
    fn words(&self) -> String {
        match self.how {
            How::Equal => self.text.clone(),
            How::Unequal => format!("other than {}", self.text),
            How::Below => format!("below {}", self.text),
            How::AtMost => format!("at most {}", self.text),
            How::Above => format!("above {}", self.text),
            How::AtLeast => format!("at least {}", self.text),
            How::Between => self.text.replace("..", " to "),
        }
    }
}

fn label(device: Option<&VirtualDevice>, address: Address) -> String {
    match device {
        Some(device) => values::label(device.dictionary(), address),
        None => address.to_string(),
    }
}
