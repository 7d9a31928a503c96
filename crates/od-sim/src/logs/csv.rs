//! Logs that are tables with a line of names: GVRET (SavvyCAN), CL2000 and CANedge, Kvaser, IXXAT, python-can.

use std::format;
use std::prelude::v1::*;

use od_wire::Instant;

use super::channel::Form;
use super::record::{Entry, FD, Reader, Record, bases, fields, frame, id};
use super::stamp;

/// Content of a column. A column with another name is ignored.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Column {
    Time,
    Id,
    /// Whether the CAN-ID has 29 bits.
    Extended,
    /// Whether the frame is a remote frame.
    Remote,
    /// Whether it is an error frame.
    Error,
    /// Whether it is a frame of CAN FD.
    Fd,
    /// Received or sent.
    Direction,
    /// Letters: `R` remote, `X` 29 bits, `E` error frame, `Self` sent.
    Flags,
    Length,
    /// All bytes.
    Data,
    /// All bytes in base 64.
    Base64,
    /// Name or number of the bus.
    Channel,
    /// The first byte; the others follow.
    First,
}

/// Names of columns in lower case.
const NAMES: [(&str, Column); 26] = [
    ("time stamp", Column::Time),
    ("timestamp", Column::Time),
    ("timestampepoch", Column::Time),
    ("time", Column::Time),
    ("id", Column::Id),
    ("arbitration_id", Column::Id),
    ("identifier (hex)", Column::Id),
    ("extended", Column::Extended),
    ("ide", Column::Extended),
    ("type", Column::Extended),
    ("format", Column::Extended),
    ("remote", Column::Remote),
    ("error", Column::Error),
    ("edl", Column::Fd),
    ("dir", Column::Direction),
    ("flags", Column::Flags),
    ("len", Column::Length),
    ("dlc", Column::Length),
    ("data", Column::Data),
    ("databytes", Column::Data),
    ("data (hex)", Column::Data),
    ("bus", Column::Channel),
    ("buschannel", Column::Channel),
    ("channel", Column::Channel),
    ("d0", Column::First),
    ("d1", Column::First),
];

/// Returns whether this line names the columns of a log.
pub(super) fn is_one(line: &str) -> bool {
    let columns = columns(line);
    let has = |wanted| columns.contains(&Some(wanted));
    let has_data = [Column::Data, Column::Base64, Column::First].map(has);
    has(Column::Time) && has(Column::Id) && has_data != [false; 3]
}

/// Where a table has the name of the bus.
pub(super) fn form(lines: &[&str]) -> Form {
    let head = lines.iter().find(|line| is_one(line));
    let columns = head.map(|head| columns(head)).unwrap_or_default();
    let place = columns
        .iter()
        .position(|column| *column == Some(Column::Channel));
    place.map_or(Form::Other, Form::Field)
}

fn columns(line: &str) -> Vec<Option<Column>> {
    let mut found = Vec::new();
    for name in fields(line) {
        let name = name.to_ascii_lowercase();
        let column = NAMES.iter().find(|(known, _)| *known == name);
        let column = column.map(|(_, column)| *column);
        let is_twice = column.is_some() && found.contains(&column);
        found.push(column.filter(|_| !is_twice));
    }
    if line.contains("arbitration_id") {
        let data = found.iter_mut().find(|one| **one == Some(Column::Data));
        data.into_iter()
            .for_each(|data| *data = Some(Column::Base64));
    }
    found
}

pub(super) fn reader<'t>(lines: &[&'t str]) -> Reader<'t> {
    let head = lines.iter().find(|line| is_one(line));
    let head = head.copied().unwrap_or_default();
    let columns = columns(head);
    let bases = bases(lines);
    let mut is_begun = false;
    Box::new(move |line| {
        let is_head = line == head;
        is_begun |= is_head;
        // Lines about the logger come before the names.
        if !is_begun || is_head || line.starts_with('#') {
            return Ok(Entry::Nothing);
        }
        let words: Vec<&str> = fields(line).collect();
        record(&columns, &words, bases)
    })
}

fn record(
    columns: &[Option<Column>],
    words: &[&str],
    [base, data_base]: [u32; 2],
) -> Result<Entry, String> {
    let place = |wanted| columns.iter().position(|column| *column == Some(wanted));
    let field = |wanted| {
        let at = place(wanted)?;
        words.get(at).copied()
    };
    let is = |wanted| field(wanted).is_some_and(is_set);
    let flag = |flag: char| {
        let flags = field(Column::Flags).unwrap_or_default();
        flags.eq_ignore_ascii_case(flag.encode_utf8(&mut [0; 4]))
    };
    let needed = [Column::Id, Column::Length, Column::Data];
    if needed
        .into_iter()
        .filter_map(place)
        .any(|at| at >= words.len())
    {
        return Err("the row is cut".into());
    }
    let word = field(Column::Time).unwrap_or_default();
    let at = time(word).ok_or_else(|| format!("`{word}` is not a time"))?;
    let at = Instant::from_micros(at);
    if is(Column::Error) || flag('E') {
        return Ok(Entry::Record(Record::error(at)));
    }
    if is(Column::Fd) {
        return Err(FD.into());
    }
    let digits = field(Column::Id).unwrap_or_default();
    let digits = digits.strip_prefix("0x").unwrap_or(digits);
    // Some of these logs do not say that a CAN-ID has 29 bits.
    let says = place(Column::Extended).or(place(Column::Flags)).is_some();
    let is_long = !says && u32::from_str_radix(digits, base).is_ok_and(|raw| raw > 0x7FF);
    let id = id(digits, base, is(Column::Extended) || flag('X') || is_long)?;
    let remote = is(Column::Remote) || flag('R');
    if let Some(text) = field(Column::Base64).filter(|_| !remote) {
        let data = base64(text).ok_or_else(|| format!("`{text}` is not bytes in base 64"))?;
        let frame = od_wire::Frame::new(id, &data);
        let frame = frame.ok_or_else(|| format!("the length {} is more than 8", data.len()))?;
        return Ok(Entry::Record(Record::received(at, frame)));
    }
    let bytes = match (place(Column::First), field(Column::Data)) {
        (Some(at), _) => words.get(at..).unwrap_or_default().to_vec(),
        (None, data) => pairs(data.unwrap_or_default())?,
    };
    let bytes = bytes.into_iter().take_while(|byte| !byte.is_empty());
    let bytes: Vec<&str> = bytes.collect();
    let dlc = match field(Column::Length) {
        Some(word) => word
            .parse()
            .map_err(|_| format!("`{word}` is not a valid length"))?,
        None => u8::try_from(bytes.len()).unwrap_or(u8::MAX),
    };
    let frame = frame(id, dlc, remote, bytes.into_iter(), data_base)?;
    let sent = match field(Column::Direction) {
        Some(word) => word == "1" || word.eq_ignore_ascii_case("tx"),
        None => field(Column::Flags).is_some_and(|flags| flags.eq_ignore_ascii_case("self")),
    };
    Ok(Entry::Record(Record::received(at, frame).sent(sent)))
}

fn is_set(word: &str) -> bool {
    ["1", "true", "ext"].contains(&word.to_ascii_lowercase().as_str())
}

/// The bytes of a text in base 64 (RFC 4648, 4).
fn base64(text: &str) -> Option<Vec<u8>> {
    const DIGITS: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let text = text.trim_end_matches('=');
    let (mut bits, mut count) = (0, 0);
    let mut bytes = Vec::new();
    for digit in text.chars() {
        bits = bits << 6 & 0xFFFF | DIGITS.find(digit)?;
        count += 6;
        if count >= 8 {
            count -= 8;
            bytes.push((bits >> count) as u8);
        }
    }
    (count < 6).then_some(bytes)
}

/// The bytes of `4018100100000000` or `40 18 10 01`.
fn pairs(text: &str) -> Result<Vec<&str>, String> {
    if text.contains(' ') {
        return Ok(text.split_whitespace().collect());
    }
    let wrong = || format!("`{text}` is not hex bytes");
    let starts = (0..text.len()).step_by(2);
    starts
        .map(|at| text.get(at..at + 2).ok_or_else(wrong))
        .collect()
}

/// Reads a time in microseconds: seconds with a fraction, whole microseconds (SavvyCAN), `15:50:01.123`, or the date and
/// time of a CL2000, `20261125T155001123`.
fn time(text: &str) -> Option<u64> {
    if let Some((date, clock)) = text.split_once('T') {
        let at = |from: usize, to: usize| clock.get(from..to).unwrap_or_default();
        let (year, rest) = date.split_at_checked(4)?;
        let (month, day) = rest.split_at_checked(2)?;
        let (hour, minute, second) = (at(0, 2), at(2, 4), at(4, 6));
        let fraction = at(6, clock.len());
        return stamp::date(&format!(
            "{year}-{month}-{day} {hour}:{minute}:{second}.{fraction}"
        ));
    }
    let mut parts = text.rsplitn(3, ':');
    let seconds = parts.next()?;
    if text.contains(':') {
        let minutes: u64 = parts.next()?.parse().ok()?;
        let hours: u64 = parts.next().unwrap_or("0").parse().ok()?;
        let whole = hours.checked_mul(60)?.checked_add(minutes)?;
        return whole
            .checked_mul(60_000_000)?
            .checked_add(stamp::seconds(seconds)?);
    }
    if seconds.contains('.') {
        stamp::seconds(seconds)
    } else {
        seconds.parse().ok()
    }
}

#[cfg(test)]
mod tests {
    use crate::logs::read;
    use std::format;
    use std::prelude::v1::*;

    /// The frames of a log with their times in milliseconds, and the problems.
    fn told(text: &str) -> Vec<String> {
        let log = read(text.as_bytes()).expect("a log");
        let records = log.records.iter().map(|record| {
            let what = match record.what {
                crate::logs::What::Frame(frame) => format!("{frame}"),
                crate::logs::What::Error(_) => "error".into(),
            };
            let sent = if record.sent { " sent" } else { "" };
            format!("{} {what}{sent}", record.at.as_micros() / 1000)
        });
        let problems = log.skipped.iter().map(|problem| format!("{problem}"));
        records.chain(problems).collect()
    }

    #[test]
    fn each_program_has_its_own_columns() {
        let read = "601#4018100100000000";
        let gvret = "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n\
            1000,00000701,false,Rx,0,1,00,\n\
            3000,00000601,false,Tx,0,8,40,18,10,01,00,00,00,00,\n\
            4000,00000123,true,Rx,0,0,";
        assert_eq!(
            told(gvret),
            ["1 701#00", &format!("3 {read} sent"), "4 00000123#"]
        );
        let cl2000 = "# Logger type: CL2000\n# Value separator: \";\"\nTimestamp;Type;ID;Data\n\
            20261125T155001123;0;701;00\n20261125T155001223;0;601;4018100100000000\n\
            20261125T155001225;1;123;";
        assert_eq!(
            told(cl2000),
            ["0 701#00", &format!("100 {read}"), "102 00000123#"]
        );
        let canedge = "TimestampEpoch;BusChannel;ID;IDE;DLC;DataLength;Dir;EDL;BRS;DataBytes\n\
            1764085801.123;1;701;0;1;1;0;0;0;00\n1764085801.223;1;601;0;8;8;1;0;0;4018100100000000\n\
            1764085801.323;1;601;0;9;12;1;1;0;401810010000000000000000";
        assert_eq!(
            told(canedge),
            [
                "0 701#00",
                &format!("100 {read} sent"),
                "line 4: it is a CAN FD frame, and CANopen does not use CAN FD"
            ]
        );
        let kvaser = "Time Stamp,Channel,ID,Flags,DLC,D0,D1,D2,D3,D4,D5,D6,D7,Counter\n\
            0.5,1,701,,1,00,,,,,,,,1\n0.6,1,601,,8,40,18,10,01,00,00,00,00,2\n0.7,1,701,R,0,,,,,,,,,3\n\
            0.8,1,0,E,0,,,,,,,,,4";
        assert_eq!(
            told(kvaser),
            [
                "500 701#00",
                &format!("600 {read}"),
                "700 701#R",
                "800 error"
            ]
        );
        let python = "timestamp,arbitration_id,extended,remote,error,dlc,data\n1764085801.123,0x701,0,0,0,1,AA==\n\
            1764085801.223,0x601,0,0,0,8,QBgQAQAAAAA=\n1764085801.323,0x701,0,1,0,1,\n1764085801.423,0x0,0,0,1,0,\n\
            1764085801.523,0x123,1,0,0,0,\n1764085801.623,0x123,0,0,0,1,A*==";
        assert_eq!(
            told(python),
            [
                "0 701#00",
                &format!("100 {read}"),
                "200 701#R1",
                "300 error",
                "400 00000123#",
                "line 7: `A*==` is not bytes in base 64"
            ]
        );
        let ixxat = "\"Time\",\"Identifier (hex)\",\"Format\",\"Flags\",\"Data (hex)\"\n\
            \"00:01:00.500\",\"701\",\"Std\",\"\",\"00\"\n\
            \"00:01:00.600\",\"601\",\"Std\",\"Self\",\"40 18 10 01 00 00 00 00\"";
        assert_eq!(told(ixxat), ["60500 701#00", &format!("60600 {read} sent")]);
    }

    #[test]
    fn kvaser_names_the_base_of_its_numbers() {
        let text = "Kvaser Memorator Log\n   Format of data field: DEC\n   Format of id field:   DEC\n\
            Time,Channel,ID,Flags,DLC,D0,D1,D2,D3,D4,D5,D6,D7,Counter\n0.5,1,1793,,1,127,,,,,,,,1\n";
        assert_eq!(told(text), ["500 701#7F"]);
        let undeclared = text.replace("DEC", "HEX") + "0.6,1,701,,1,05,,,,,,,,2\n";
        assert_eq!(
            told(&undeclared),
            ["600 701#05", "line 5: the CAN-ID 1793 is too large"]
        );
    }

    #[test]
    fn a_row_that_cannot_be_read_is_named() {
        let head = "Time Stamp,ID,Extended,Dir,Bus,LEN,D1";
        for (row, why) in [
            ("x,701,false,Rx,0,1,00", "line 3: `x` is not a time"),
            (
                "1,7G1,false,Rx,0,1,00",
                "line 3: `7G1` is not a valid CAN-ID",
            ),
            (
                "1,701,false,Rx,0,9,00",
                "line 3: the length 9 is more than 8",
            ),
            ("1,701,false,Rx,0,2,00", "line 3: the data is not 2 bytes"),
            ("1,701", "line 3: the row is cut"),
        ] {
            let text = format!("{head}\n2,701,false,Rx,0,1,05\n{row}\n");
            assert_eq!(told(&text), ["0 701#05", why], "{row}");
        }
    }
}
