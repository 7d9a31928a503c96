//! Channels of a log: frames of two buses in one file.

use std::prelude::v1::*;

use super::record::{Record, fields};

/// The form of a text log, which says where the name of a channel is.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// `candump`: the interface.
    Candump,
    /// Vector ASC: a number after the time.
    Asc,
    /// Lines that python-can prints: after `Channel:`.
    Printed,
    /// A word of each line, counted from 0: TRC, BUSMASTER, Kvaser.
    Word(usize),
    /// A field of a table, counted from 0.
    Field(usize),
    /// No name of a channel is read.
    Other,
}

impl Form {
    /// The name of the channel in a line with a frame; empty without one.
    pub(super) fn name(self, line: &str) -> &str {
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
                if ["can", "canfd"].contains(&&*word.to_ascii_lowercase()) {
                    word = words.next().unwrap_or_default();
                }
                word
            }
            Self::Printed => line
                .rsplit_once("Channel:")
                .map_or("", |(_, name)| name.trim()),
            Self::Word(place) => line.split_whitespace().nth(place).unwrap_or_default(),
            Self::Field(place) => fields(line).nth(place).unwrap_or_default(),
            Self::Other => "",
        }
    }
}

/// As many channels are told apart.
const MOST: usize = 32;

/// Collects the channels of the records of a log.
#[derive(Default)]
pub(super) struct Channels {
    names: Vec<String>,
}

impl Channels {
    /// The number of the channel with this name.
    pub(super) fn number(&mut self, name: &str) -> u8 {
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
        let trc = ";$FILEVERSION=2.1\n;$COLUMNS=N,O,T,B,I,d,R,L,D\n1 10.0 DT 1 0701 Rx - 1 05\n2 11.0 DT 2 0701 Rx - 1 7F\n\
            3 12.0 ER 2 - Rx - 5 04 00 08 00 00\n";
        assert_eq!(told(trc), "1:1 2:2");
        assert_eq!(
            told(";$FILEVERSION=1.3\n 1) 10.0 1 Rx 0701 - 1 05\n 2) 11.0 3 Rx 0701 - 1 7F\n"),
            "1:1 3:1"
        );
        let savvy = "Time Stamp,ID,Extended,Dir,Bus,LEN,D1\n10,00000701,false,Rx,0,1,05,\n11,00000701,false,Rx,1,1,7F,\n";
        assert_eq!(told(savvy), "0:1 1:1");
        let kvaser = "Chn Identifier Flg   DLC  D0...1...2...3...4...5...6..D7       Time     Dir\n\
            0    00000701         1  00    1.5 R\n 1    00000701         1  05    1.6 R\n";
        assert_eq!(told(kvaser), "0:1 1:1");
    }

    #[test]
    fn many_names_are_told_apart_up_to_a_limit() {
        let lines = (0..100).map(|number| format!("(0.1) can{number} 701#05\n"));
        let mut log = read(lines.collect::<String>().as_bytes()).expect("a log");
        let all = log.take_channels();
        assert_eq!((all.len(), all[31].1.len()), (32, 69));
    }
}
