//! The boot loader of `examples/boot_loader`: frames in, frames out.
#![allow(unreachable_pub)]

#[path = "boot_loader/control.rs"]
mod control;
#[path = "../examples/boot_loader/loader.rs"]
mod loader;
#[path = "../examples/boot_loader/rig.rs"]
mod rig;

use loader::{PROGRAM, SIZE};
use od_client::sdo::Options;
use od_client::{Client, Event, lss};
use odkit::{AbortCode, Frame, Instant, NodeId, StreamEnd, sdo};
use rig::Rig;

const SIZES: [usize; 12] = [0, 1, 3, 4, 5, 7, 8, 889, 890, 1025, 65_535, SIZE];

fn pattern(len: usize) -> Vec<u8> {
    (0..len).map(|at| (at * 31 % 251) as u8).collect()
}

fn rig(options: Options) -> Rig {
    let mut rig = Rig::new();
    rig.client = Client::with(options, lss::Options::DEFAULT);
    rig
}

fn blocks(block_size: u8) -> Options {
    let mut options = Options::DEFAULT;
    options.block_from = Some(0);
    options.block_upload = true;
    options.block_size = block_size;
    options
}

/// Writes a program and reads it back.
#[track_caller]
fn round_trip(rig: &mut Rig, len: usize) {
    let program = pattern(len);
    let written = rig.client.write(NodeId::ONE, PROGRAM, &program);
    let read = rig.client.read(NodeId::ONE, PROGRAM);
    let expected = [
        Event::Written(written, Ok(())),
        Event::Read(read, Ok(program)),
    ];
    assert!(rig.run() == expected, "{len} bytes");
    assert_eq!(rig.len(), Some(len));
}

#[test]
fn programs_of_every_length_by_segments() {
    let mut rig = rig(Options::SEGMENTED);
    for len in SIZES {
        round_trip(&mut rig, len);
    }
    assert!(
        rig.node
            .application
            .ends
            .iter()
            .all(|end| *end == StreamEnd::Complete)
    );
    assert_eq!(rig.node.application.ends.len(), 2 * SIZES.len());
}

#[test]
fn programs_of_every_length_by_blocks() {
    for block_size in [1, 20, 127] {
        let mut rig = rig(blocks(block_size));
        for len in SIZES {
            round_trip(&mut rig, len);
        }
    }
}

#[test]
fn lost_segments_are_sent_again() {
    let mut rig = rig(blocks(20));
    rig.loses = |number, frame| {
        let is_segment = matches!(frame.data(), [1..=19, rest @ ..] if rest != [0; 7]);
        is_segment && (number as u32).wrapping_mul(0x9E37_79B1) >> 28 == 0
    };
    for len in [889, 1025, 20_000] {
        round_trip(&mut rig, len);
    }
}

#[test]
fn a_program_one_byte_longer_than_the_flash_is_refused() {
    for options in [Options::SEGMENTED, Options::DEFAULT] {
        let mut rig = rig(options);
        let long = rig.client.write(NodeId::ONE, PROGRAM, &pattern(SIZE + 1));
        let abort = od_client::Error::Abort(AbortCode::TooLong.code());
        assert_eq!(rig.run(), [Event::Written(long, Err(abort))]);
        // The download did not even begin.
        assert_eq!((rig.frames, rig.node.application.ends.len()), (2, 0));
    }
    // Without an announced size, the byte after the last one of the flash is refused.
    let mut rig = Rig::new();
    assert_eq!(rig.ask("20501F0100000000"), "60501F0100000000");
    for at in 0..SIZE / 7 {
        let toggle = if at % 2 == 0 { "00" } else { "10" };
        rig.ask(&format!("{toggle}01020304050607"));
    }
    // 65,534 bytes arrived.
    assert_eq!(rig.ask("0901020300000000"), "80501F0112000706");
    assert_eq!(
        rig.node.application.ends,
        [StreamEnd::Aborted(AbortCode::TooLong)]
    );
    assert_eq!(rig.len(), None);
}

impl Rig {
    /// Bytes of the program in the flash.
    fn len(&self) -> Option<usize> {
        self.node
            .application
            .program()
            .map(|program| program.len as usize)
    }

    /// Sends a request to the device. Returns its responses at the same time, without the CAN-ID.
    fn send(&mut self, hex: &str) -> Vec<String> {
        let byte = |at| u8::from_str_radix(&hex[2 * at..2 * at + 2], 16).expect("hex");
        self.receive(&Frame::standard(
            0x601,
            &std::array::from_fn::<u8, 8, _>(byte),
        ));
        self.answers()
    }

    fn answers(&mut self) -> Vec<String> {
        let frames = std::iter::from_fn(|| self.poll());
        frames
            .map(|frame| frame.to_string().split_off("581#".len()))
            .collect()
    }

    /// As [`send`](Self::send), but lets time pass until there is a response.
    #[track_caller]
    fn ask(&mut self, hex: &str) -> String {
        let mut answers = self.send(hex);
        while answers.is_empty() {
            let due = self.due().expect("an answer that waits");
            self.wait_until(due);
            answers = self.answers();
        }
        assert_eq!(answers.len(), 1, "{hex}");
        answers.remove(0)
    }

    fn nmt(&mut self, command: u8) {
        self.receive(&Frame::standard(0, &[command, 1]));
    }

    /// A block download of 1,025 bytes after its first block of 127 segments.
    fn begun() -> Self {
        let mut rig = Self::new();
        assert_eq!(rig.ask("C6501F0101040000"), "A4501F017F000000");
        for at in 1..127 {
            assert_eq!(rig.send(&segment(at, at)), [""; 0]);
        }
        assert_eq!(rig.ask(&segment(127, 127)), "A27F7F0000000000");
        rig
    }
}

/// Segment `at` of [`pattern`], with this sequence number and last bit.
fn segment(at: usize, head: usize) -> String {
    let mut data = pattern(1025)[(at - 1) * 7..].to_vec();
    data.resize(7, 0);
    let hex: Vec<String> = data.iter().map(|byte| format!("{byte:02X}")).collect();
    format!("{head:02X}{}", hex.concat())
}

/// End of a download of these bytes of [`pattern`].
fn end(len: usize) -> String {
    let crc = sdo::crc16(&pattern(len)).to_le_bytes();
    let unused = sdo::unused(len);
    format!(
        "{:02X}{:02X}{:02X}0000000000",
        0xC1 | unused << 2,
        crc[0],
        crc[1]
    )
}

#[test]
fn the_master_waits_while_the_flash_is_busy() {
    let mut rig = Rig::new();
    assert_eq!(rig.send("C6501F0101040000"), ["A4501F017F000000"]);
    for at in 1..=127 {
        assert_eq!(
            rig.send(&segment(at, at)),
            [""; 0],
            "the flash erases itself"
        );
    }
    let erased = Instant::from_millis(80);
    assert_eq!(rig.due(), Some(erased));
    rig.wait_until(Instant::from_millis(79));
    assert_eq!(rig.answers(), [""; 0]);
    rig.wait_until(erased);
    assert_eq!(rig.answers(), ["A27F7F0000000000"]);
    // Three pages of 889 bytes are being written into the flash.
    for at in 128..147 {
        assert_eq!(rig.send(&segment(at, at - 127)), [""; 0]);
    }
    // The last block waits for the end request.
    assert_eq!(rig.send(&segment(147, 0x80 | 20)), ["A2146B0000000000"]);
    assert_eq!(rig.send(&end(1025)), [""; 0]);
    assert_eq!(
        (rig.len(), rig.due()),
        (None, Some(Instant::from_micros(81_200)))
    );
    rig.wait_until(Instant::from_micros(81_200));
    assert_eq!(rig.answers(), ["A100000000000000"]);
    assert_eq!(rig.len(), Some(1025));
    assert_eq!(rig.node.application.ends, [StreamEnd::Complete]);
}

#[test]
fn three_bytes_go_expedited_and_wait_too() {
    let mut rig = Rig::new();
    assert_eq!(rig.send("27501F0141424300"), [""; 0]);
    // Repeating the request continues the same transfer.
    assert_eq!(rig.send("27501F0141424300"), [""; 0]);
    rig.wait_until(Instant::from_millis(80));
    assert_eq!(rig.answers(), ["60501F0100000000"]);
    assert_eq!(
        rig.ask("40501F0100000000"),
        "41501F0103000000",
        "the flash is busy"
    );
    assert_eq!(rig.ask("6000000000000000"), "0941424300000000");
    assert_eq!(rig.send("40501F0100000000"), ["47501F0141424300"]);
    assert_eq!(rig.node.application.ends, [StreamEnd::Complete; 3]);
}

#[test]
fn an_abort_during_a_transfer_is_reported_to_the_stream() {
    let mut rig = Rig::begun();
    assert_eq!(rig.send("80501F0100000008"), [""; 0]);
    assert_eq!(
        rig.node.application.ends,
        [StreamEnd::Cancelled(0x0800_0000)]
    );
    assert_eq!(rig.len(), None);
    assert_eq!(rig.ask("40501F0100000000"), "80501F0124000008");
    // Also while the stream is awaited: nothing is sent when the flash is ready.
    let mut rig = Rig::new();
    rig.send("27501F0141424300");
    assert_eq!(rig.send("80501F0100000008"), [""; 0]);
    assert_eq!(
        rig.node.application.ends,
        [StreamEnd::Cancelled(0x0800_0000)]
    );
    assert_eq!(rig.due(), Some(Instant::from_millis(80)), "1F57h changes");
    rig.wait_until(Instant::from_millis(100));
    assert_eq!(rig.answers(), [""; 0]);
    assert_eq!(rig.send("4000100000000000"), ["4300100000000000"]);
    // The same in an upload.
    round_trip(&mut rig, 100);
    rig.node.application.ends.clear();
    rig.ask("40501F0100000000");
    rig.ask("6000000000000000");
    rig.send("80501F0100000008");
    assert_eq!(
        rig.node.application.ends,
        [StreamEnd::Cancelled(0x0800_0000)]
    );
}

#[test]
fn a_reset_or_a_stop_during_a_transfer_is_reported_to_the_stream() {
    for command in [0x81, 0x82, 0x02] {
        let mut rig = Rig::begun();
        rig.nmt(command);
        assert_eq!(rig.node.application.ends, [StreamEnd::Cut]);
        rig.answers();
        // A segment that arrives late belongs to no transfer.
        rig.nmt(0x80);
        assert_eq!(rig.ask("0041424344454647"), "8041424301000405");
        assert_eq!(rig.len(), None);
        assert_eq!(rig.node.application.ends, [StreamEnd::Cut], "once");
    }
}

#[test]
fn another_transfer_replaces_it() {
    for (request, answer) in [
        ("4000100000000000", "4300100000000000"),
        ("A4501F017F000000", "80501F0124000008"),
        ("2F511F0101000000", "80511F0124000008"),
        ("C6501F0101000100", "80501F0112000706"),
        ("2100100005000000", "8000100002000106"),
    ] {
        let mut rig = Rig::new();
        rig.ask("21501F0105000000");
        assert_eq!(rig.send(request), [answer]);
        assert_eq!(
            rig.node.application.ends,
            [StreamEnd::Replaced],
            "{request}"
        );
        rig.send("0541424344450000");
        assert_eq!(rig.len(), None);
    }
}

#[test]
fn a_program_with_a_wrong_checksum_does_not_exist() {
    let mut rig = Rig::begun();
    for at in 128..147 {
        rig.send(&segment(at, at - 127));
    }
    rig.ask(&segment(147, 0x80 | 20));
    assert_eq!(rig.ask(&end(1024)), "80501F0113000706", "a byte is missing");
    let mut rig = Rig::begun();
    for at in 128..147 {
        rig.send(&segment(at, at - 127));
    }
    rig.ask(&segment(147, 0x80 | 20));
    let wrong = end(1025).replace(&end(1025)[2..6], "0000");
    assert_eq!(rig.ask(&wrong), "80501F0104000405");
    assert_eq!(
        rig.node.application.ends,
        [StreamEnd::Aborted(AbortCode::Crc)]
    );
    assert_eq!(rig.len(), None);
}

#[test]
fn a_block_with_a_lost_segment_is_repeated_from_there() {
    let mut rig = Rig::begun();
    // Of 20 segments the third is lost.
    for at in (128..147).filter(|at| *at != 130) {
        rig.send(&segment(at, at - 127));
    }
    assert_eq!(rig.ask(&segment(147, 0x80 | 20)), "A2027F0000000000");
    for at in 130..147 {
        rig.send(&segment(at, at - 129));
    }
    assert_eq!(rig.ask(&segment(147, 0x80 | 18)), "A2126D0000000000");
    assert_eq!(rig.ask(&end(1025)), "A100000000000000");
    let read = rig.client.read(NodeId::ONE, PROGRAM);
    assert_eq!(rig.run(), [Event::Read(read, Ok(pattern(1025)))]);
}

#[test]
fn more_bytes_than_announced_are_refused_early() {
    let mut rig = Rig::new();
    rig.ask("C6501F0178030000");
    for at in 1..127 {
        rig.send(&segment(at, at));
    }
    // 889 bytes arrived, and 888 were announced.
    assert_eq!(rig.ask(&segment(127, 127)), "80501F0112000706");
    assert_eq!(
        rig.node.application.ends,
        [StreamEnd::Aborted(AbortCode::TooLong)]
    );
}

#[test]
fn a_transfer_ends_when_its_master_is_silent() {
    let mut rig = Rig::begun();
    let written = rig.due().expect("a deadline");
    assert_eq!(written, Instant::from_micros(81_200), "1F57h changes");
    rig.wait_until(written);
    let due = rig.due().expect("a deadline");
    assert_eq!(due, Instant::from_millis(80 + 5000));
    rig.wait_until(due);
    assert_eq!(rig.answers(), ["80501F0100000405"]);
    assert_eq!(
        rig.node.application.ends,
        [StreamEnd::Aborted(AbortCode::Timeout)]
    );
    assert_eq!(rig.len(), None);
    // The time in which the flash delays the master does not count.
    let mut rig = Rig::new();
    rig.ask("21501F0105000000");
    rig.send("0541424344450000");
    rig.wait_until(Instant::from_millis(90_000));
    assert_eq!(rig.answers(), ["2000000000000000"]);
    assert_eq!(rig.len(), Some(5));
}
