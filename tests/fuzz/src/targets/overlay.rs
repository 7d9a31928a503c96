//! An EDS and an overlay: the result is read like any EDS, every finding has a
//! place in one of the two files, and an invalid line of the overlay is reported.

use od_eds::{Origin, Place};

use super::eds;
use crate::files::files;
use crate::target::Target;

/// Separates the two files of an input.
const SEAM: &str = "\n%%\n";

pub(super) const TARGET: Target = Target {
    name: "overlay",
    run,
    seeds: || {
        let overlays = files("tests", &[".overlay"], 16_384);
        assert!(overlays.len() > 2, "where are the overlays?");
        let bases = eds::seeds();
        let pairs = bases.iter().enumerate().map(|(at, base)| {
            // Its own overlay, that of another file, or a whole EDS.
            let over = overlays.get(at % (overlays.len() + 1)).unwrap_or(base);
            [base, SEAM.as_bytes(), over].concat()
        });
        pairs.collect()
    },
    words: WORDS,
    is_text: true,
    longest: 32_768,
    ..Target::PLAIN
};

/// Words of overlays.
const WORDS: &[&str] = &[
    "Remove=1\n",
    "Remove=0\n",
    "remove = 1 ; no\n",
    "[1000]\n",
    "[1018]\n",
    "[1018sub1]\n",
    "[1018Sub01]\n",
    "[2000]\n",
    "[5000]\n",
    "[DeviceInfo]\n",
    "[MandatoryObjects]\n",
    "[Comments]\n",
    "ParameterName=Mine\n",
    "DataType=0x0007\n",
    "AccessType=rw\n",
    "DefaultValue=5\n",
    "defaultvalue=6\n",
    "SubNumber=3\n",
    "CompactSubObj=4\n",
    "\n%%\n",
    "\r",
    "\r\n",
    "\u{feff}",
    "[",
    "]",
    "=",
    ";",
];

fn run(input: &[u8]) {
    let text = od_eds::decode(input);
    let (base, over) = text.split_once(SEAM).unwrap_or((&text, ""));
    // A line ends with `\n`, `\r\n` or `\r`.
    let lines = |text: &str| text.replace("\r\n", "\n").split(['\n', '\r']).count() as u32;
    let made = match od_eds::overlay(base, over) {
        Ok(made) => made,
        Err(faults) => {
            assert!(!faults.is_empty(), "refused without a reason");
            for (line, fault) in faults {
                let is_there = (1..=lines(over)).contains(&line);
                assert!(is_there && !fault.is_empty(), "line {line}: {fault}");
            }
            return;
        }
    };
    let parsed = od_eds::load(&made.text);
    eds::said(&parsed.findings, &made.text);
    for finding in parsed.findings {
        let code = finding.code();
        let (origin, finding) = made.place(finding);
        let file = match origin {
            Origin::Base => base,
            Origin::Overlay => over,
        };
        let Place::Text(span) = finding.place else {
            continue;
        };
        assert!(span.line <= lines(file), "{code} at {span:?} of {origin:?}");
        assert!(
            file.get(span.start as usize..span.end as usize).is_some(),
            "{code} at {span:?} of {origin:?}, {} bytes",
            file.len()
        );
    }
    eds::written_again(&parsed.description);
    if over.trim().is_empty() {
        let base_only = od_eds::parse(base).description;
        let same = od_eds::parse(&made.text).description;
        assert!(
            base_only.objects == same.objects,
            "nothing was laid over it"
        );
    }
}
