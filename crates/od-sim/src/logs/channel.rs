//! Channels of a log: frames of two buses in one file.

use std::prelude::v1::*;

use super::record::Record;

/// The form of a text log, which says where the name of a channel is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// `candump`: the interface.
    Candump,
    /// Vector ASC: a number after the time.
    Asc,
    /// Lines that python-can prints: after `Channel:`.
    Columns,
    /// No name of a channel is read.
    Other,
}

impl Form {
    /// The name of the channel in a line with a frame; empty without one.
    fn name(self, line: &str) -> &str {
        let line = line.trim_start();
        match self {
            Self::Candump => {
                let stamp = line.strip_prefix('(').and_then(|rest| rest.split_once(')'));
                let rest = stamp.map_or(line, |(_, rest)| rest);
                let word = rest.split_whitespace().next().unwrap_or_default();
                if word.contains('#') { "" } else { word }
            }
            Self::Asc => {
                let mut words = line.split_whitespace().skip(1);
                let mut word = words.next().unwrap_or_default();
                if word.eq_ignore_ascii_case("canfd") {
                    word = words.next().unwrap_or_default();
                }
                word
            }
            Self::Columns => line
                .rsplit_once("Channel:")
                .map_or("", |(_, name)| name.trim()),
            Self::Other => "",
        }
    }
}

/// As many channels are told apart.
const MOST: usize = 32;

/// Collects the channels of the records of a log.
pub(super) struct Channels {
    form: Form,
    names: Vec<String>,
}

impl Channels {
    pub(super) const fn new(form: Form) -> Self {
        Self {
            form,
            names: Vec::new(),
        }
    }

    /// The number of the channel that a line names.
    pub(super) fn number(&mut self, line: &str) -> u8 {
        let name = self.form.name(line);
        let known = self.names.iter().position(|known| known == name);
        let number = known.unwrap_or_else(|| {
            if self.names.len() < MOST {
                self.names.push(name.into());
            }
            self.names.len() - 1
        });
        number as u8
    }

    /// The names of two channels and more.
    pub(super) fn names(self) -> Vec<String> {
        let is_one = self.names.len() < 2;
        if is_one { Vec::new() } else { self.names }
    }
}

/// The records of each channel with its name; without names, all records without a name.
pub(super) fn apart(
    records: Vec<Record>,
    numbers: Vec<u8>,
    names: &[String],
) -> Vec<(String, Vec<Record>)> {
    if names.is_empty() {
        return Vec::from([(String::new(), records)]);
    }
    let mut all: Vec<(String, Vec<Record>)> = names
        .iter()
        .map(|name| (name.clone(), Vec::new()))
        .collect();
    for (record, number) in records.into_iter().zip(numbers) {
        if let Some((_, own)) = all.get_mut(usize::from(number)) {
            own.push(record);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use crate::logs::read;
    use std::format;
    use std::prelude::v1::*;

    #[test]
    fn each_channel_has_its_records() {
        let told = |text: &str| {
            let mut log = read(text.as_bytes()).expect("a log");
            let all = log.take_channels().into_iter();
            let all = all.map(|(name, records)| format!("{name}:{}", records.len()));
            all.collect::<Vec<_>>().join(" ")
        };
        assert_eq!(
            told("(0.1) can0 701#05\n(0.2) can1 701#05\n(0.3) can0 702#05\n"),
            "can0:2 can1:1"
        );
        assert_eq!(told("(0.1) can0 701#05\n(0.2) can0 701#05\n"), ":2");
        assert_eq!(
            told("  can0  701   [1]  05\n  can1  701   [1]  05\n"),
            "can0:1 can1:1"
        );
        assert_eq!(
            told(
                " (2026-11-28 15:50:01.5)  can0  701   [1]  05\n (2026-11-28 15:50:01.4)  vcan1  RX - -  701   [1]  05\n"
            ),
            "can0:1 vcan1:1"
        );
        assert_eq!(told("701#05\n702#05\n"), ":2");
        let asc = "date x\nbase hex  timestamps absolute\n   0.1 1  701  Rx   d 1 05\n   0.2 2  701  Rx   d 1 05\n   \
            0.3 CANFD 2 Rx 702 0 0 1 1 05 0 0 0\n   0.4 CAN 1 Status:chip status error active\n";
        assert_eq!(told(asc), "1:1 2:2");
        let printed = "Timestamp:  1.5    ID:  701    S Rx    DL:  1    00    Channel: can0\n\
            Timestamp:  1.4    ID:  701    S Rx    DL:  1    00    Channel: can3\n";
        assert_eq!(told(printed), "can0:1 can3:1");
    }

    #[test]
    fn many_names_are_told_apart_up_to_a_limit() {
        let lines = (0..100).map(|number| format!("(0.1) can{number} 701#05\n"));
        let mut log = read(lines.collect::<String>().as_bytes()).expect("a log");
        let all = log.take_channels();
        assert_eq!((all.len(), all[31].1.len()), (32, 69));
    }
}
