//! First bytes of a file: they name its device, in lines that a person can read.

use std::format;
use std::string::String;
use std::vec::Vec;

use od_model::Dictionary;

use crate::storage::crc::Crc32;
use crate::storage::image;

/// Bytes of a header.
pub(super) const LEN: usize = 512;
/// Bytes before the checksum: eight digits and the end of the line.
const SUMMED: usize = LEN - 10;
/// The first bytes, which no other kind of file has; the digit is the version.
pub(super) const SIGNATURE: &[u8; 16] = b"odkit EEPROM 2\r\n";
/// Place of the version digit.
const VERSION: usize = 13;
/// Greatest length of a name or an identity, in bytes.
const LONGEST: usize = 200;

/// The device that a file belongs to.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Owner<'o> {
    /// Name for messages: that of a built-in device, or the path of its EDS.
    pub name: &'o str,
    /// Identity and layout in words; a file with another identity is refused.
    pub identity: &'o str,
    /// [`image::device`](crate::storage::image::device), to recognise a file with a damaged header.
    pub device: u32,
}

impl<'o> Owner<'o> {
    /// A device with this dictionary. `name` is its name in messages and its identity: a file that
    /// was made with another name is refused.
    ///
    /// ```no_run
    /// # use od_model::Dictionary;
    /// use od_runtime::storage::{File, Owner, image};
    ///
    /// # const DICTIONARY: Dictionary<'static> = Dictionary::EMPTY;
    /// let owner = Owner::of(&DICTIONARY, "thermometer");
    /// let eeprom = File::open("thermometer.eeprom", image::capacity_needed(&DICTIONARY), &owner);
    /// ```
    pub const fn of(dictionary: &Dictionary<'_>, name: &'o str) -> Self {
        Self {
            name,
            identity: name,
            device: image::device(dictionary),
        }
    }
}

/// Content of a header.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct Header {
    pub(super) name: String,
    pub(super) identity: String,
    /// Number of bytes after the header.
    pub(super) capacity: usize,
    /// The process that opened the file last.
    pub(super) process: u32,
}

/// Kind of the first bytes of a file.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Seen {
    /// Not a file of odkit.
    Other,
    /// Empty, or power failed while the file was made.
    Unfinished,
    /// A file of another version of odkit.
    Version(char),
    Whole(Header),
    Damaged,
}

/// Returns a text as a header contains it: one line, and only the end of a long text.
pub(super) fn line(text: &str) -> String {
    let mut from = text.len().saturating_sub(LONGEST);
    while !text.is_char_boundary(from) {
        from += 1;
    }
    text[from..].replace(char::is_control, " ")
}

impl Header {
    /// Returns the header of a file that this process uses.
    pub(super) fn write(owner: &Owner<'_>, capacity: usize, process: u32) -> Vec<u8> {
        let (name, identity) = (line(owner.name), line(owner.identity));
        let text = format!("{name}\r\n{identity}\r\n{capacity} bytes\r\nprocess {process}\r\n");
        let mut bytes = SIGNATURE.to_vec();
        bytes.extend(text.bytes());
        bytes.resize(SUMMED, b' ');
        let sum = checksum(&bytes);
        bytes.extend(sum.bytes());
        bytes
    }

    /// Reads the first bytes of a file.
    pub(super) fn read(bytes: &[u8]) -> Seen {
        let (start, rest) = bytes.split_at(bytes.len().min(SIGNATURE.len()));
        let wrong = |(byte, right): (&u8, &u8)| (byte ^ right).count_ones();
        let wrong: u32 = start.iter().zip(SIGNATURE).map(wrong).sum();
        let is_ours = start.len() == SIGNATURE.len() && wrong <= 1;
        match rest.len() + SIGNATURE.len() {
            LEN if is_ours => match (
                wrong,
                bytes[SUMMED..] == *checksum(&bytes[..SUMMED]).as_bytes(),
            ) {
                (0, true) => Self::parse(rest).map_or(Seen::Damaged, Seen::Whole),
                _ => Seen::Damaged,
            },
            _ if SIGNATURE.starts_with(start) => Seen::Unfinished,
            _ if start.len() == SIGNATURE.len() && start[..VERSION] == SIGNATURE[..VERSION] => {
                Seen::Version(start[VERSION].into())
            }
            _ => Seen::Other,
        }
    }

    fn parse(lines: &[u8]) -> Option<Self> {
        let mut lines = core::str::from_utf8(lines).ok()?.split("\r\n");
        Some(Self {
            name: lines.next()?.into(),
            identity: lines.next()?.into(),
            capacity: lines.next()?.strip_suffix(" bytes")?.parse().ok()?,
            process: lines.next()?.strip_prefix("process ")?.parse().ok()?,
        })
    }
}

/// Returns the last line of a header.
fn checksum(bytes: &[u8]) -> String {
    let mut crc = Crc32::new();
    crc.update(bytes);
    format!("{:08X}\r\n", crc.finish())
}
