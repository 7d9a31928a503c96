//! Scripts of `odkit run`: every text is read, or refused with a place in it, and a valid script
//! runs to its end or to a line with an error.

use od_model::Refused;
use od_runtime::{Frame, Instant, NodeId};
use od_sim::VirtualDevice;
use od_sim::script::{Bare, Host, Origin, Script, run as run_script};

use crate::files::files;
use crate::target::{Enough, Target};

pub(super) const TARGET: Target = Target {
    name: "script",
    run,
    seeds: || files("tests/conformance", &[".script"], 3000),
    words: WORDS,
    is_text: true,
    longest: 4096,
    ..Target::PLAIN
};

/// Words of the language.
pub(super) const WORDS: &[&str] = &[
    "device gxmm\n",
    "device eam_mt node 5 off as left\n",
    "device en580c node 0x7F\n",
    "use left\n",
    "shaft at 0x79592\n",
    "shaft turn -2.5\n",
    "shaft rpm 1e9\n",
    "power off\n",
    "power on\n",
    "power cycle 2s\n",
    "switch node 12\n",
    "switch bitrate 5\n",
    "fault battery-low on\n",
    "fault internal off\n",
    "wait 500ms\n",
    "at 1.5s ",
    "after 20us ",
    "random ",
    "random 3 times ",
    " | ",
    "0..5ms",
    "fault\n",
    "power cut\n",
    "(0.1) ",
    "(1600000000.5) ",
    "601#4000100000000000\n",
    "701#R4\n",
    "nmt start\n",
    "nmt reset all\n",
    "sync counter 3\n",
    "sync 15 times every 1ms\n",
    "send 080# 3 times every 10ms\n",
    "sdo read 6004h = 5\n",
    "sdo write 6001h = -1 as i8\n",
    "sdo read \"Position value\" aborts 06020000h\n",
    "ignore 181#*\n",
    "ignore nothing\n",
    "skip\n",
    "expect 701#00 within 50ms\n",
    "expect 181#.. xx * every 5ms 43 times\n",
    "expect silence 100ms\n",
    "expect abort 06090031h\n",
    "expect state operational\n",
    "expect value 6004h = 1\n",
    "expect led green flashing\n",
    "#",
    "\"",
    "[01 02]",
    "=",
    "ä",
    "\u{0}",
    "99999999999s",
    "18446744073709551615",
];

/// The built-in devices, and limits for slow scripts.
pub(super) struct Bounded(pub(super) u32);

impl Host for Bounded {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        self.0 += 1000;
        Bare(od_devices::DEVICES).device(name, node_id)
    }

    fn frame(&mut self, _: Instant, _: Origin, _: &Frame) {
        self.0 += 1;
        if self.0 > 10_000 {
            Enough::give_up();
        }
    }
}

fn run(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let script = match Script::parse(&text) {
        Ok(script) => script,
        Err(problems) => {
            let lines: Vec<&str> = text.lines().collect();
            assert!(!problems.is_empty(), "refused without a reason");
            for problem in problems {
                let line = lines
                    .get(problem.line as usize - 1)
                    .expect("a line of the script");
                let columns = line.chars().count() + 1;
                assert!(
                    (1..=columns).contains(&problem.column),
                    "{problem}: {line:?}"
                );
            }
            return;
        }
    };
    if is_short(&text)
        && let Err(stop) = run_script(&script, &mut Bounded(0))
    {
        assert!(!stop.to_string().is_empty());
    }
}

/// Hours of a simulated bus take minutes.
pub(super) fn is_short(text: &str) -> bool {
    let words = text.split([' ', '\n', '\t', '(', ')', '\r']);
    words.into_iter().all(|word| {
        let end = word
            .find(|c: char| !(c.is_ascii_digit() || c == '.'))
            .unwrap_or(word.len());
        let number: f64 = word[..end].parse().unwrap_or(0.0);
        let seconds = match &word[end..] {
            "us" => number / 1e6,
            "ms" => number / 1e3,
            "min" => number * 60.0,
            _ => number,
        };
        seconds < 3600.0 || !matches!(&word[end..], "us" | "ms" | "s" | "min" | "")
    })
}
