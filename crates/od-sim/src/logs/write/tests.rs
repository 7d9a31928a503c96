//! Reads written logs back, and logs of other programs.

use std::prelude::v1::*;
use std::vec;

use od_wire::{CanId, Frame, Instant};

use crate::logs::{BusError, Format, Log, Record, What, read};

fn records() -> Vec<Record> {
    let frame = |at, sent, frame| Record {
        at: Instant::from_micros(at),
        sent,
        what: What::Frame(frame),
    };
    let extended = CanId::extended(0x1F33_4455);
    let remote = Frame::remote(CanId::standard(0x701), 1).expect("one byte");
    vec![
        frame(0, false, Frame::standard(0x701, &[0])),
        frame(
            100_000,
            true,
            Frame::standard(0x601, &[0x40, 4, 0x60, 0, 0, 0, 0, 0]),
        ),
        frame(
            100_137,
            false,
            Frame::standard(0x581, &[0x43, 4, 0x60, 0, 1, 2, 3, 4]),
        ),
        frame(200_000, true, remote),
        frame(300_000, false, Frame::standard(0x80, &[])),
        frame(1_500_001, false, Frame::of(extended, &[0xDE, 0xAD])),
        error(1_600_000, BusError::Frame),
        error(1_700_000, BusError::Warning),
        error(1_800_000, BusError::Passive),
        error(1_900_000, BusError::BusOff),
    ]
}

fn error(at: u64, error: BusError) -> Record {
    Record {
        at: Instant::from_micros(at),
        sent: false,
        what: What::Error(error),
    }
}

#[test]
fn a_written_log_is_read_back_unchanged() {
    for format in [Format::Candump, Format::Asc, Format::Trc, Format::Pcapng] {
        let Log {
            mut records,
            skipped,
            ..
        } = read(&format.write(&self::records())).expect("a log");
        assert_eq!(skipped, [], "{format:?}");
        let mut expected = self::records();
        // candump and pcapng have no direction.
        if matches!(format, Format::Candump | Format::Pcapng) {
            for record in records.iter_mut().chain(&mut expected) {
                record.sent = false;
            }
        }
        assert_eq!(records, expected, "{format:?}");
    }
}

#[test]
fn written_logs_are_byte_for_byte_the_same() {
    let text = |format: Format| String::from_utf8(format.write(&records())).expect("a text");
    assert_eq!(
        text(Format::Candump),
        "(0.000000) can0 701#00
(0.100000) can0 601#4004600000000000
(0.100137) can0 581#4304600001020304
(0.200000) can0 701#R1
(0.300000) can0 080#
(1.500001) can0 1F334455#DEAD
(1.600000) can0 20000008#0000040000000000
(1.700000) can0 20000004#000C000000000000
(1.800000) can0 20000004#0030000000000000
(1.900000) can0 20000040#0000000000000000
"
    );
    let asc = text(Format::Asc);
    let lines: Vec<_> = asc.lines().skip(5).collect();
    assert_eq!(
        lines[1],
        "   0.100000 1  601             Tx   d 8 40 04 60 00 00 00 00 00"
    );
    assert_eq!(lines[3], "   0.200000 1  701             Tx   r 1");
    assert_eq!(lines[5], "   1.500001 1  1F334455x       Rx   d 2 DE AD");
    assert_eq!(lines[6], "   1.600000 1  ErrorFrame");
    assert_eq!(
        lines[8],
        "   1.800000 CAN 1 Status:chip status error passive"
    );
    let trc = text(Format::Trc);
    let lines: Vec<_> = trc.lines().skip(8).collect();
    assert_eq!(
        lines[1],
        "      2       100.000 DT 1      0601 Tx -  8    40 04 60 00 00 00 00 00"
    );
    assert_eq!(lines[3], "      4       200.000 RR 1      0701 Tx -  1");
    assert_eq!(
        lines[5],
        "      6      1500.001 DT 1  1F334455 Rx -  2    DE AD"
    );
    assert_eq!(
        lines[8],
        "      9      1800.000 ST 1         - Rx -  4    00 04 00 00"
    );
}

#[test]
fn logs_of_other_tools_are_read() {
    for (text, expected) in [
        (
            "(1436509052.249713) vcan0 044#2A366C2BBA\n",
            "044#2A366C2BBA",
        ),
        (
            " (003.602976)  can0  181   [4]  01 02 03 04\n",
            "181#01020304",
        ),
        (
            " (003.602976)  can0  TX - -  181   [2]  41 42   'AB'\n",
            "181#4142",
        ),
        (" (0.1)  can0  701   [1]  remote request\n", "701#R1"),
        (
            "date Sam Sep 30 15:06:13.191 2017\nbase hex  timestamps absolute\n\
             internal events logged\n// version 9.0.0\n   2.501000 1  8               Tx   \
             d 8 00 00 00 00 00 00 00 00  Length = 0 BitCount = 64\n",
            "008#0000000000000000",
        ),
        (
            "date x\nbase dec  timestamps absolute\n   1.0 1  100             Rx   d 2 10 255\n",
            "064#0AFF",
        ),
        (
            "date x\nbase hex  timestamps absolute\n   0.1 1  64x             Rx   r\n",
            "00000064#R",
        ),
        (
            ";$FILEVERSION=1.1\n;$STARTTIME=43474.0\n     \
             1)      1059.9  Rx         0300  7  00 00 00 00 04 00 00\n",
            "300#00000000040000",
        ),
        (
            ";$FILEVERSION=1.1\n     1)      1059.9  Rx         0300  4  RTR\n",
            "300#R4",
        ),
        (
            ";$FILEVERSION=1.3\n     1)      1059.900 1  Rx        0300 -  2    00 07\n",
            "300#0007",
        ),
        (
            ";##########\n     1)      1841 0001 8 00 00 00 00 00 00 00 09\n;$STARTTIME=1\n",
            "001#0000000000000009",
        ),
        (
            ";$FILEVERSION=2.0\n;$STARTTIME=43008.0\n;$COLUMNS=N,O,T,I,d,l,D\n      \
             1      1059.900 DT     0300 Rx 7  00 00 00 00 04 00 00\n",
            "300#00000000040000",
        ),
        (
            "    310     18274.059 DT     0605 Rx 8  40 00 10 00 00 00 00 00 \n",
            "605#4000100000000000",
        ),
    ] {
        let log = read(text.as_bytes()).expect(text);
        assert_eq!(log.skipped, [], "{text}");
        let [
            Record {
                what: What::Frame(frame),
                ..
            },
        ] = log.records[..]
        else {
            panic!("one frame: {text}");
        };
        assert_eq!(frame.to_string(), expected, "{text}");
    }
}

#[test]
fn an_unreadable_log_is_an_error_that_names_it() {
    let cut = &Format::Pcapng.write(&records())[..90];
    for (bytes, why) in [
        (&b"hello\nworld\n"[..], "it is not a candump log"),
        (&b"\n"[..], "it is empty"),
        (b"LOGG\x90\0\0\0", "it has no CAN frame"),
        (
            b"MDF     4.10",
            "it is an MDF log (MF4), which odkit does not read; export it as ASC",
        ),
        (
            b"SQLite format 3\0",
            "it is a database, such as python-can writes",
        ),
        (
            b"No.     Time           Source\n1 0.0\n",
            "it is a text of Wireshark",
        ),
        (
            b"Time   ID     DLC Data                    Comment\n",
            "it is a trace of CANHacker",
        ),
        (b"(0.1) can0 zzz#00\n", "line 1: "),
        (cut, "it ends in the middle of a block"),
    ] {
        let error = read(bytes).expect_err(why).to_string();
        assert!(error.starts_with(why), "{error}");
    }
    let text = "(0.1) can0 601#40\n(0.2) can0 601#4\n(0.3) can0 801#00\n(0.4) can0 123##100\n";
    let log = read(text.as_bytes()).expect("a log");
    assert_eq!((log.records.len(), log.skipped.len()), (1, 3));
    assert_eq!(log.skipped[0].line, 2);
}

#[test]
fn a_candump_log_without_times_is_read_in_order() {
    let text = "  can0  603   [8]  40 18 10 01 00 00 00 00\n  can0  583   [8]  43 18 10 01 EC 00 00 00\n  \
                can0  TX - -  703   [1]  05\n";
    let log = read(text.as_bytes()).expect("a log");
    assert!(log.lacks_times);
    assert_eq!(log.skipped, []);
    let shown = log.records.iter().map(|record| match record.what {
        What::Frame(frame) => format!("{:?} {frame}", record.at.as_micros()),
        What::Error(_) => String::from("error"),
    });
    let wanted = [
        "0 603#4018100100000000",
        "0 583#43181001EC000000",
        "0 703#05",
    ];
    assert_eq!(shown.collect::<Vec<_>>(), wanted);
    let mixed = read(b"can0 603 [1] 00\n(0.1) can0 601#40\n").expect("a log");
    assert_eq!(
        (mixed.lacks_times, mixed.records.len(), mixed.skipped.len()),
        (false, 1, 1)
    );
}

#[test]
fn a_log_ends_with_its_last_record() {
    let text = "base hex  timestamps relative\n   0.5 1 80 Rx d 0\n \
                18446744073709.5 1 80 Rx d 0\n 18446744073709.5 1 80 Rx d 0\n";
    let log = read(text.as_bytes()).expect("a log");
    assert_eq!(log.records.last().map(|one| one.at), Some(Instant::MAX));
}

#[test]
fn times_of_day_become_times_from_the_start() {
    let log = read(b"(1436509052.5) can0 080#\n(1436509053.0) can0 080#\n").expect("a log");
    let times: Vec<_> = log.records.iter().map(|one| one.at.as_micros()).collect();
    assert_eq!(times, [0, 500_000]);
}

/// The frames of a log as text.
#[track_caller]
fn shown(log: &Log) -> Vec<String> {
    let shown = log.records.iter().map(|record| match record.what {
        What::Frame(frame) => frame.to_string(),
        What::Error(_) => String::from("error"),
    });
    shown.collect()
}

#[test]
fn frames_of_an_interface_with_can_fd_are_classic_ones() {
    let text = "base hex  timestamps absolute\n\
        0.000000 Start of measurement\n\
        0.001000 CANFD   1 Rx        701                     0 0 1  1 00   107914  58   200000 46500250\n\
        0.002000 CANFD   1 Tx        601  Sdo_Request        0 0 8  8 40 18 10 01 00 00 00 00   242136  125   200000\n\
        0.003000 CANFD   1 Rx        18DA0201x               0 0 2  2 01 02   242136  125   200000\n\
        0.004000 CANFD   1 Rx        701                     0 0 0  0   107914  58   200010\n\
        0.005000 CANFD   1 Rx   ErrorFrame\n\
        0.006000 CANFD   1 Rx        123                     1 0 9 12 01 02 03 04 05 06 07 08 09 0A 0B 0C   107914  58   303000\n\
        0.007000 CANFD   1 Rx        123                     0 0 8  8 01 02 03 04 05 06 07 08   107914  58   301000\n\
        0.008000 CANFD   Start of measurement\n\
        0.009000 CANFD   1 Rx        701                     0 0 1\n";
    let log = read(text.as_bytes()).expect("a log");
    assert_eq!(
        shown(&log),
        [
            "701#00",
            "601#4018100100000000",
            "18DA0201#0102",
            "701#R",
            "error"
        ]
    );
    assert!(log.records[1].sent && !log.records[0].sent);
    let lines: Vec<u32> = log.skipped.iter().map(|problem| problem.line).collect();
    assert_eq!(lines, [8, 9, 11]);
    assert!(log.skipped[0].why.contains("CAN FD"), "{}", log.skipped[0]);
    assert_eq!(log.others, 1);
}

#[test]
fn events_of_an_asc_are_counted_and_no_problem() {
    let text = "base hex  timestamps absolute\n\
        0.001231 1  701             Rx   d 1 05  Length = 107915 BitCount = 58 ID = 1793\n\
        0.024998 CAN 1 Status:chip status error active\n\
        0.031903 1  181             TxRq d 4 01 02 03 04 Length = 0 BitCount = 0 ID = 385\n\
        0.032903 1  181             Tx   d 4 01 02 03 04 Length = 0 BitCount = 0 ID = 385\n\
        1.100000 SV: 2 0 1 ::Sys::Var = 1\n\
        1.200000 1 OverloadFrame\n\
        1.300000 1 J1939TP FEE3p 6 0 0 - Rx d 23 A0\n\
        1.400000 1  zzz             Rx   d 1 05\n";
    let log = read(text.as_bytes()).expect("a log");
    assert_eq!(shown(&log), ["701#05", "181#01020304"]);
    assert_eq!((log.others, log.skipped.len()), (5, 1));
    assert_eq!(log.skipped[0].line, 9);
}

/// A pcap file of this link type with these packets, a microsecond from each to the next.
fn pcap(link: u32, packets: &[Vec<u8>]) -> Vec<u8> {
    let words = [0xA1B2_C3D4, 0x0004_0002, 0, 0, 0xFFFF, link];
    let mut out: Vec<u8> = words
        .iter()
        .flat_map(|word: &u32| word.to_le_bytes())
        .collect();
    for (at, packet) in (0..).zip(packets) {
        let length = packet.len() as u32;
        out.extend(
            [1, at, length, length]
                .iter()
                .flat_map(|word: &u32| word.to_le_bytes()),
        );
        out.extend(packet);
    }
    out
}

const BOOT_UP: [u8; 16] = [0, 0, 7, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

/// A packet of a capture on all interfaces: the header of this link type, then the frame.
fn cooked(link: u32, kind: u8, protocol: u8, frame: &[u8]) -> Vec<u8> {
    let mut header = match link {
        113 => vec![0; 16],
        _ => vec![0; 20],
    };
    if link == 113 {
        (header[1], header[15]) = (kind, protocol);
    } else {
        (header[10], header[1]) = (kind, protocol);
    }
    header.extend(frame);
    header
}

#[test]
fn a_capture_on_all_interfaces_has_its_can_frames() {
    for link in [113, 276] {
        let mut long = BOOT_UP.to_vec();
        long.resize(72, 0);
        let packets = [
            cooked(link, 0, 0x0C, &BOOT_UP),
            cooked(link, 4, 0x0C, &BOOT_UP),
            cooked(link, 0, 0x0D, &long),
            // IPv4.
            cooked(link, 0, 0x08, &[0; 40]),
            cooked(link, 0, 0x0C, &[0; 3]),
        ];
        let mut bytes = pcap(link, &packets);
        let log = read(&bytes).expect("a log");
        assert_eq!(shown(&log), ["701#00", "701#00"], "{link}");
        assert_eq!(log.records.iter().filter(|record| record.sent).count(), 1);
        assert_eq!(log.others, 1);
        let said: Vec<String> = log.skipped.iter().map(ToString::to_string).collect();
        assert!(
            said[0].starts_with("frame 3: it is a CAN FD frame"),
            "{said:?}"
        );
        assert!(said[1].starts_with("frame 5: "), "{said:?}");
        // A capture that was killed keeps what it has.
        bytes.pop();
        let cut = read(&bytes).expect("a log");
        assert_eq!((cut.records.len(), cut.skipped.len()), (2, 2));
    }
    let other = read(&pcap(113, &[cooked(113, 0, 0x08, &[0; 40])])).expect_err("no CAN");
    assert!(other.to_string().contains("not SocketCAN"), "{other}");
}

#[test]
fn a_long_frame_of_candump_is_named() {
    let text = "(0.1) can0  123  [12]  00 01 02 03 04 05 06 07 08 09 0A 0B\n(0.2) can0  123  [08]  \
        00 01 02 03 04 05 06 07\n(0.3) can0  123   [1]  00\n";
    let log = read(text.as_bytes()).expect("a log");
    assert_eq!((log.records.len(), log.skipped.len()), (1, 2));
    assert!(
        log.skipped.iter().all(|one| one.why.contains("CAN FD")),
        "{:?}",
        log.skipped
    );
}

/// A capture with two interfaces, of which one has a name.
#[test]
fn an_interface_of_a_capture_is_a_channel() {
    let block = |kind: u32, body: &[u8]| {
        let length = (12 + body.len() as u32).to_le_bytes();
        [&kind.to_le_bytes(), &length, body, &length].concat()
    };
    let mut all = Format::Pcapng.head();
    let name = b"\xE3\0\0\0\0\0\0\0\x02\0\x04\0can1\0\0\0\0";
    all.extend(block(1, name));
    for interface in [0u8, 1, 1] {
        let mut packet = vec![interface, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];
        packet.extend([16, 0, 0, 0, 16, 0, 0, 0]);
        packet.extend([0, 0, 7, 5, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
        all.extend(block(6, &packet));
    }
    let mut log = read(&all).expect("a log");
    let told = log.take_channels().into_iter();
    let told: Vec<_> = told.map(|(name, records)| (name, records.len())).collect();
    assert_eq!(told, [("0".into(), 1), (String::from("can1"), 2)]);
}
