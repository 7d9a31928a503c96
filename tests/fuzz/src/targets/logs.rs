//! Logs of other tools: candump, ASC, BLF, TRC, pcap, pcapng. Records are read in the order of time,
//! and a log written in any format reads the same.

use od_runtime::{CanId, Frame, Instant};
use od_sim::logs::{BusError, Format, Log, Record, What, read};

use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "logs",
    run,
    seeds: || {
        let written = FORMATS.map(|format| format.write(&records()));
        let texts = TEXTS.iter().map(|text| text.as_bytes().to_vec());
        let captures = [false, true].map(capture);
        let others = captures.into_iter().chain([blf()]);
        written.into_iter().chain(texts).chain(others).collect()
    },
    words: &[
        "date Sam Sep 30 15:06:13.191 2017\n",
        "base hex  timestamps absolute\n",
        "base dec  timestamps relative\n",
        "   2.501000 1  8x              Tx   d 8 00 00 00 00 00 00 00 00\n",
        "   2.5 1 100 Rx r\n",
        "   2.5 1 ErrorFrame\n",
        "   2.5 CANFD 1 Rx 100 0 0 8 8 00 00 00 00 00 00 00 00\n",
        ";$FILEVERSION=1.1\n",
        ";$FILEVERSION=1.3\n",
        ";$FILEVERSION=2.1\n",
        ";$STARTTIME=43008.0\n",
        ";$COLUMNS=N,O,T,B,I,d,R,L,D\n",
        "      1      1059.900 DT     0300 Rx 7  00 00 00 00 04 00 00\n",
        "      1      1059.900 ER     Rx 04 00 02 00 00\n",
        "RTR",
        "(1436509052.249713) vcan0 044#2A366C2BBA\n",
        "(0.1) can0 20000008#0000040000000000\n",
        "(99999999999999999999.9)",
        "\u{0}\u{0}\u{0}\u{1}",
        "\n",
        "\r",
        "-",
        "x",
        " ",
    ],
    is_text: true,
    longest: 4096,
    ..Target::PLAIN
};

const FORMATS: [Format; 4] = [Format::Candump, Format::Asc, Format::Trc, Format::Pcapng];

/// Lines of other tools.
const TEXTS: [&str; 8] = [
    " (003.602976)  can0  TX - -  181   [2]  41 42   'AB'\n (0.1)  can0  701   [1]  remote request\n",
    "date x\nbase dec  timestamps absolute\n   1.0 1  100             Rx   d 2 10 255\n",
    "date x\nbase hex  timestamps relative\n   0.1 1  64x             Rx   r\n   0.1 1 ErrorFrame\n",
    ";$FILEVERSION=1.1\n;$STARTTIME=43474.0\n     1)      1059.9  Rx         0300  4  RTR\n",
    ";$FILEVERSION=1.3\n     1)      1059.900 1  Rx        0300 -  2    00 07\n",
    ";##########\n     1)      1841 0001 8 00 00 00 00 00 00 00 09\n;$STARTTIME=1\n",
    ";$FILEVERSION=2.0\n;$STARTTIME=43008.0\n;$COLUMNS=N,O,T,I,d,l,D\n      1      1059.900 DT     0300 Rx 7  00 00 00 00 04 00 00\n",
    "(1436509052.249713) vcan0 044#2A366C2BBA\n(1436509052.3) vcan0 1F334455#R\n",
];

fn records() -> Vec<Record> {
    let frames = [
        Frame::standard(0x701, &[0]),
        Frame::standard(0x601, &[0x40, 4, 0x60, 0, 0, 0, 0, 0]),
        Frame::of(CanId::extended(0x1F33_4455), &[0xDE, 0xAD]),
        Frame::standard(0x80, &[]),
    ];
    let remote = Frame::remote(CanId::standard(0x701), 1);
    let whats = frames.into_iter().chain(remote).map(What::Frame);
    let whats = whats.chain([What::Error(BusError::Frame)]);
    let record = |(at, what)| Record {
        at: Instant::from_micros(at * 100_137),
        sent: at % 2 == 1,
        what,
    };
    (0_u64..).zip(whats).map(record).collect()
}

/// A pcap file with one frame, of either byte order.
fn capture(is_big: bool) -> Vec<u8> {
    let head = [0xA1B2_C3D4_u32, 0x0004_0002, 0, 0, 0xFFFF, 227];
    let packet = [1_u32, 500_000, 16, 16];
    let words = head.into_iter().chain(packet);
    let mut bytes: Vec<u8> = words
        .flat_map(|word| {
            if is_big {
                word.to_be_bytes()
            } else {
                word.to_le_bytes()
            }
        })
        .collect();
    bytes.extend([0, 0, 6, 1, 8, 0, 0, 0, 0x40, 4, 0x60, 0, 0, 0, 0, 0]);
    bytes
}

/// A BLF log with one frame, in a container that is not packed.
fn blf() -> Vec<u8> {
    let frame = [&[1, 0, 0, 1][..], &0x701_u32.to_le_bytes(), &[0; 8]].concat();
    let head = |len: usize, kind: u32| {
        let parts = [
            &b"LOBJ\x20\0\x01\0"[..],
            &(32 + len as u32).to_le_bytes(),
            &kind.to_le_bytes(),
        ];
        parts.concat()
    };
    let event = [
        &head(frame.len(), 86)[..],
        &[0; 8],
        &1_000_000_u64.to_le_bytes(),
        &frame,
    ]
    .concat();
    let container = [&head(event.len(), 10)[..], &[0; 16], &event].concat();
    [&b"LOGG\x08\0\0\0"[..], &container].concat()
}

fn run(input: &[u8]) {
    let log = match read(input) {
        Ok(log) => log,
        Err(why) => {
            assert!(!why.to_string().is_empty(), "refused without a reason");
            return;
        }
    };
    let is_ordered = log.records.is_sorted_by_key(|record| record.at);
    assert!(is_ordered, "records are in the order of their times");
    let lines = String::from_utf8_lossy(input).split(['\n', '\r']).count() as u32;
    for problem in &log.skipped {
        let is_there = problem.is_frame || (1..=lines).contains(&problem.line);
        assert!(is_there && !problem.why.is_empty(), "{problem}");
    }
    // The readers of TRC and pcapng use 53 bits.
    let last = log.records.last().map_or(0, |record| record.at.as_micros());
    if last > 1_000_000 << 31 {
        return;
    }
    for format in FORMATS {
        let bytes = format.write(&log.records);
        let shown = || String::from_utf8_lossy(&bytes).into_owned();
        if log.records.is_empty() {
            // The format of a log without a record cannot be recognised.
            let _ = read(&bytes);
            continue;
        }
        let again = read(&bytes).unwrap_or_else(|why| panic!("{format:?}: {why}:\n{}", shown()));
        assert_eq!(again.skipped, [], "{format:?}:\n{}", shown());
        let expected = kept(format, &log);
        assert_eq!(kept(format, &again), expected, "{format:?}:\n{}", shown());
    }
}

/// The records that a format can keep: candump and pcapng have no direction, the others do not say why a frame was destroyed.
fn kept(format: Format, log: &Log) -> Vec<Record> {
    let is_of_socketcan = matches!(format, Format::Candump | Format::Pcapng);
    let kept = log.records.iter().map(|record| Record {
        sent: record.sent && !is_of_socketcan,
        what: match record.what {
            What::Error(BusError::NoAcknowledge) if !is_of_socketcan => {
                What::Error(BusError::Frame)
            }
            what => what,
        },
        ..*record
    });
    kept.collect()
}
