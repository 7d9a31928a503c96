//! References in the text of a lesson to files and objects.

use std::prelude::v1::*;
use std::{format, vec};

use od_model::Address;

use super::content::Lesson;
use crate::device::VirtualDevice;
use crate::grammar::problem::Problem;

/// EMCY error codes that look like objects of the device profile.
const ERROR_CODES: [u16; 2] = [0x1000, 0x6010];

/// Collects the references of a line of text.
pub(super) fn collect(lesson: &mut Lesson, number: u32, line: &str) {
    let mut rest = line;
    while let Some(at) = rest.find("](") {
        rest = &rest[at + 2..];
        if let Some(end) = rest.find(')') {
            lesson.links.push((number, rest[..end].to_owned()));
        }
    }
    for address in objects(line) {
        lesson.objects.push((number, address));
    }
}

/// `1017h`, `1018h:02`: objects of the communication area, of manufacturers and of CiA 406.
fn objects(line: &str) -> Vec<Address> {
    let mut found = vec![];
    let separates = |c: char| !c.is_ascii_alphanumeric() && c != ':';
    for word in line.split(separates) {
        let (index, sub) = word
            .trim_end_matches(':')
            .split_once(':')
            .unwrap_or((word, "00"));
        let Some(digits) = index.trim_end_matches(':').strip_suffix('h') else {
            continue;
        };
        let number = match digits.len() {
            4 => u16::from_str_radix(digits, 16).ok(),
            _ => None,
        };
        let sub = u8::from_str_radix(sub.trim_end_matches('h'), 16);
        if let (Some(index), Ok(sub)) = (number, sub)
            && matches!(index, 0x1000..=0x1FFF | 0x2000..=0x2FFF | 0x6000..=0x6FFF)
            && !ERROR_CODES.contains(&index)
            // `1000h to 1FFFh` is a range.
            && index & 0xFFF != 0xFFF
        {
            found.push(Address::new(index, sub));
        }
    }
    found
}

impl Lesson {
    /// The relative links of the text, each with its line number: names of files, without the part
    /// after `#`.
    pub fn files(&self) -> impl Iterator<Item = (u32, &str)> {
        let file = |(line, link): &'_ (u32, String)| {
            let end = link.find(['#', ' ']).unwrap_or(link.len());
            (*line, end)
        };
        self.links
            .iter()
            .map(move |one| {
                let (line, end) = file(one);
                (line, &one.1[..end])
            })
            .filter(|(_, link)| !link.is_empty() && !link.contains("://"))
    }

    /// Objects in the text that no device of the bench has.
    pub(super) fn unknown_objects(&self, devices: &[VirtualDevice]) -> Vec<Problem> {
        let known = |address: &Address| {
            let found = |device: &VirtualDevice| {
                let dictionary = device.dictionary();
                dictionary.find(*address).is_ok()
                    || (address.sub == 0 && dictionary.object(address.index).is_some())
            };
            self.absent.contains(address) || devices.iter().any(found)
        };
        let unknown = self.objects.iter().filter(|(_, address)| !known(address));
        unknown
            .map(|(line, address)| {
                let message = format!("no device of the set-up has object {address}");
                let help =
                    "correct the address, or add it to the front matter: `absent = \"2FFFh\"`";
                Problem::new(*line, message, help)
            })
            .collect()
    }
}
