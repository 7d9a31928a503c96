//! Block transfers by hand: lost segments, servers without block transfers, servers that misbehave.

mod support;

use od_client::sdo::{Download, Expected, Options, SdoError, Upload};
use od_wire::sdo::{Response, crc16};
use support::{Machine, at, download, frame, pattern, upload};

/// Blocks of `size` segments from 8 bytes on.
fn options(size: u8) -> Options {
    let mut options = Options::DEFAULT;
    options.block_from = Some(8);
    options.block_size = size;
    options
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02X}")).collect()
}

/// Segment `number` of a block, with the seven bytes of `data` from `start`.
fn segment(number: u8, data: &[u8], start: usize) -> String {
    let end = data.len().min(start + 7);
    hex(&[number]) + &hex(&data[start..end])
}

fn crc(data: &[u8]) -> String {
    hex(&crc16(data).to_le_bytes())
}

/// A block upload of `len` bytes after its start: blocks of four segments, with CRC.
#[track_caller]
fn uploading(len: u8) -> Upload<Vec<u8>> {
    let mut upload = upload(options(4));
    upload.talk(&[("", "40032000")]);
    let announced = format!("581#41032000{len:02X}");
    let out = upload.on(at(0), &announced);
    assert_eq!(out, ["601#8003200000000008", "601#A403200004000000"]);
    upload.talk(&[(&format!("C6032000{len:02X}"), "A3")]);
    upload
}

/// A block download of 37 bytes in blocks of four segments: the first block is out.
#[track_caller]
fn downloading(crc: bool) -> Download<Vec<u8>> {
    let mut download = download(&pattern(37), options(4));
    download.talk(&[("", "C603200025")]);
    let head = if crc { "A4" } else { "A0" };
    let out = download.on(at(0), &format!("581#{head}03200004"));
    assert_eq!(out, block(&pattern(37), 0, 4));
    download
}

/// The frames of a block.
fn block(data: &[u8], start: usize, count: u8) -> Vec<String> {
    let segment = |number: u8| {
        let at = start + usize::from(number - 1) * 7;
        let last = if at + 7 >= data.len() { 0x80 } else { 0 };
        format!("601#{:0<16}", segment(number | last, data, at))
    };
    (1..=count).map(segment).collect()
}

#[track_caller]
fn fails(machine: &mut impl Machine, answer: &str, abort: &str, error: SdoError) {
    machine.talk(&[(answer, &format!("80032000{abort}"))]);
    assert_eq!(machine.outcome(), Some(Err(error)), "{answer}");
    assert_eq!(machine.poll_timeout(), None);
    machine.talk(&[("01", "-"), ("A20404", "-")]);
}

#[track_caller]
fn refuses(machine: &mut impl Machine, answer: &str, abort: &str, expected: Expected) {
    let got = match frame(&format!("581#{answer}")).bytes() {
        // The last segment of a block, and no abort.
        [0x81..=0x9F, ..] => Response::Unknown,
        data => Response::parse(data),
    };
    fails(
        machine,
        answer,
        abort,
        SdoError::OutOfTurn { expected, got },
    );
}

const COMMAND: &str = "01000405";
const SEQUENCE: &str = "03000405";

#[test]
fn an_upload_in_two_blocks() {
    let data = pattern(37);
    let mut upload = uploading(37);
    upload.talk(&[
        (&segment(1, &data, 0), "-"),
        (&segment(2, &data, 7), "-"),
        (&segment(3, &data, 14), "-"),
        (&segment(4, &data, 21), "A20404"),
        (&segment(1, &data, 28), "-"),
        (&segment(0x82, &data, 35), "A20204"),
    ]);
    assert_eq!(upload.outcome(), None);
    upload.talk(&[(&format!("D5{}", crc(&data)), "A1")]);
    assert_eq!(upload.outcome(), Some(Ok(())));
    assert_eq!(upload.bytes(), data);
    assert_eq!(upload.poll_timeout(), None);
}

#[test]
fn small_values_and_those_of_unknown_length_go_in_segments() {
    for announced in ["4103200007", "40032000FF"] {
        let mut upload = upload(options(4));
        upload.talk(&[("", "40032000"), (announced, "60")]);
    }
    let mut download = download(&pattern(7), options(4));
    download.talk(&[("", "2103200007")]);
    let mut longer = support::download(&pattern(8), options(4));
    longer.talk(&[("", "C603200008")]);
}

#[test]
fn a_lost_segment_is_sent_again() {
    let data = pattern(28);
    let mut upload = uploading(28);
    upload.talk(&[
        (&segment(1, &data, 0), "-"),
        (&segment(3, &data, 14), "-"),
        (&segment(0x84, &data, 21), "A20104"),
        (&segment(1, &data, 7), "-"),
        (&segment(2, &data, 14), "-"),
        // Twice the same, as after an acknowledge that came late.
        (&segment(2, &data, 14), "-"),
        (&segment(0x83, &data, 21), "A20304"),
        (&format!("C1{}", crc(&data)), "A1"),
    ]);
    assert_eq!(
        (upload.outcome(), upload.bytes()),
        (Some(Ok(())), &data[..])
    );
}

#[test]
fn a_block_whose_end_is_lost_is_confirmed_after_the_timeout() {
    let data = pattern(28);
    let mut upload = uploading(28);
    upload.handle_frame(at(0), &frame(&format!("581#{}", segment(1, &data, 0))));
    upload.handle_frame(at(700), &frame(&format!("581#{}", segment(2, &data, 7))));
    assert_eq!(upload.poll_timeout(), Some(at(1700)));
    upload.handle_timeout(at(1699));
    assert!(upload.out(at(1699)).is_empty());
    upload.handle_timeout(at(1700));
    assert_eq!(upload.out(at(1700)), ["601#A202040000000000"]);
    // The server says nothing any more.
    assert_eq!(upload.poll_timeout(), Some(at(2700)));
    upload.handle_timeout(at(2700));
    assert_eq!(upload.outcome(), Some(Err(SdoError::Silent)));
    assert_eq!(upload.out(at(2700)), ["601#8003200000000405"]);
}

#[test]
fn a_server_that_never_sends_the_first_segment_is_given_up() {
    let mut upload = uploading(28);
    for _ in 0..3 {
        upload.talk(&[("03", "-"), ("04", "A20004")]);
    }
    // Progress begins the count again.
    upload.talk(&[("01", "-"), ("03", "-"), ("04", "A20104")]);
    for _ in 0..3 {
        upload.talk(&[("84", "A20004")]);
    }
    fails(&mut upload, "84", SEQUENCE, SdoError::NoProgress);
}

#[test]
fn the_checksum_is_checked_where_the_server_makes_one() {
    let data = pattern(28);
    let segments = |upload: &mut Upload<Vec<u8>>| {
        for number in 1..4 {
            let start = usize::from(number - 1) * 7;
            upload.talk(&[(&segment(number, &data, start), "-")]);
        }
        upload.talk(&[(&segment(0x84, &data, 21), "A20404")]);
    };
    let mut wrong = uploading(28);
    segments(&mut wrong);
    fails(&mut wrong, "C1", "04000405", SdoError::Crc);
    let mut without = upload(options(4));
    without.talk(&[("", "40032000")]);
    assert_eq!(without.on(at(0), "581#410320001C").len(), 2);
    without.talk(&[("C20320001C", "A3")]);
    segments(&mut without);
    without.talk(&[("C1", "A1")]);
    assert_eq!(without.outcome(), Some(Ok(())));
}

#[test]
fn a_block_upload_keeps_its_announced_length() {
    let error = |announced, received| SdoError::Length {
        announced,
        received,
    };
    let mut long = uploading(8);
    long.talk(&[("01", "-")]);
    fails(&mut long, "02", "10000706", error(8, 14));
    let mut too_much = uploading(8);
    too_much.talk(&[("01", "-"), ("82", "A20204")]);
    fails(&mut too_much, "D1", "10000706", error(8, 10));
    let mut short = uploading(8);
    short.talk(&[("81", "A20104")]);
    fails(&mut short, "C1", "10000706", error(8, 7));
}

#[test]
fn a_block_upload_keeps_the_limit() {
    let mut options = options(4);
    options.limit = 100;
    let begun = || {
        let mut upload = upload(options);
        upload.talk(&[("", "40032000")]);
        assert_eq!(upload.on(at(0), "581#4103200064").len(), 2);
        upload
    };
    fails(
        &mut begun(),
        "C6032000FFFFFFFF",
        "05000405",
        SdoError::TooLong,
    );
    fails(&mut begun(), "C603200065", "05000405", SdoError::TooLong);
    // Without a size, and without an end.
    let mut upload = begun();
    upload.talk(&[("C4032000", "A3")]);
    for block in 0..4 {
        let last = if block == 3 { "80032000" } else { "A20404" };
        upload.talk(&[("01", "-"), ("02", "-")]);
        if block == 3 {
            fails(&mut upload, "03", "05000405", SdoError::TooLong);
        } else {
            upload.talk(&[("03", "-"), ("04", last)]);
        }
    }
}

#[test]
fn a_server_without_block_uploads_gets_segments() {
    let mut upload = upload(options(4));
    upload.talk(&[("", "40032000")]);
    assert_eq!(upload.on(at(0), "581#4103200008").len(), 2);
    assert!(!upload.refused_block());
    upload.talk(&[
        ("8003200001000405", "40032000"),
        ("4103200008", "60"),
        ("0001020304050607", "70"),
        ("1D08", "-"),
    ]);
    assert!(upload.refused_block());
    assert_eq!(
        (upload.outcome(), upload.bytes()),
        (Some(Ok(())), &[1, 2, 3, 4, 5, 6, 7, 8][..])
    );
}

#[test]
fn a_server_may_change_over_to_segments_itself() {
    let mut upload = upload(options(4));
    upload.talk(&[("", "40032000")]);
    assert_eq!(upload.on(at(0), "581#4103200008").len(), 2);
    upload.talk(&[("4103200008", "60"), ("00", "70"), ("1D08", "-")]);
    assert_eq!(upload.outcome(), Some(Ok(())));
    assert!(!upload.refused_block());
}

#[test]
fn other_aborts_end_a_block_transfer() {
    let asked = || {
        let mut upload = upload(options(4));
        upload.talk(&[("", "40032000")]);
        assert_eq!(upload.on(at(0), "581#4103200008").len(), 2);
        upload
    };
    let mut upload = asked();
    upload.talk(&[("8003200000000106", "-")]);
    assert_eq!(upload.outcome(), Some(Err(SdoError::Abort(0x0601_0000))));
    let mut segments = uploading(28);
    segments.talk(&[("01", "-"), ("8003200000000008", "-")]);
    assert_eq!(segments.outcome(), Some(Err(SdoError::Abort(0x0800_0000))));
    let mut download = download(&pattern(8), options(4));
    download.talk(&[("", "C603200008"), ("8003200000000106", "-")]);
    assert_eq!(download.outcome(), Some(Err(SdoError::Abort(0x0601_0000))));
    let mut block = downloading(true);
    block.talk(&[("8003200004000405", "-")]);
    assert_eq!(block.outcome(), Some(Err(SdoError::Abort(0x0504_0004))));
    // The code that means "no block transfers", from another transfer.
    refuses(
        &mut asked(),
        "8004200001000405",
        COMMAND,
        Expected::BlockUpload,
    );
}

#[test]
fn uploads_refuse_answers_out_of_turn() {
    let asked = || {
        let mut upload = upload(options(4));
        upload.talk(&[("", "40032000")]);
        assert_eq!(upload.on(at(0), "581#4103200008").len(), 2);
        upload
    };
    for answer in ["C604200008", "A403200004", "60032000", "C1"] {
        refuses(&mut asked(), answer, COMMAND, Expected::BlockUpload);
    }
    for answer in ["00", "05", "85", "7F", "C603200008"] {
        refuses(&mut uploading(28), answer, SEQUENCE, Expected::BlockSegment);
    }
    for answer in ["01", "84", "C603200008", "A1"] {
        let mut upload = uploading(28);
        upload.talk(&[("81", "A20104")]);
        refuses(&mut upload, answer, COMMAND, Expected::BlockUploadEnd);
    }
}

#[test]
fn a_download_in_two_blocks() {
    let data = pattern(37);
    let mut download = downloading(true);
    // The server takes blocks of one segment now, then of three.
    assert_eq!(download.on(at(0), "581#A20401"), block(&data, 28, 1));
    assert_eq!(download.on(at(0), "581#A20103"), block(&data, 35, 1));
    download.talk(&[("A20100", &format!("D5{}", crc(&data)))]);
    assert_eq!(download.outcome(), None);
    download.talk(&[("A1", "-")]);
    assert_eq!(download.outcome(), Some(Ok(())));
    assert_eq!(download.poll_timeout(), None);
}

#[test]
fn no_checksum_where_the_server_does_not_want_one() {
    let data = pattern(37);
    let mut download = downloading(false);
    assert_eq!(download.on(at(0), "581#A2047F"), block(&data, 28, 2));
    download.talk(&[("A2027F", "D5"), ("A1", "-")]);
    assert_eq!(download.outcome(), Some(Ok(())));
}

#[test]
fn values_of_whole_segments_leave_nothing_unused() {
    for (len, end) in [(14, "C1"), (13, "C5"), (8, "D9")] {
        let data = pattern(len);
        let mut download = download(&data, options(4));
        download.talk(&[("", &format!("C6032000{len:02X}"))]);
        assert_eq!(download.on(at(0), "581#A403200004"), block(&data, 0, 2));
        download.talk(&[("A20204", &format!("{end}{}", crc(&data))), ("A1", "-")]);
        assert_eq!(download.outcome(), Some(Ok(())));
    }
}

#[test]
fn what_the_server_lacks_is_sent_again() {
    let data = pattern(37);
    let mut download = downloading(true);
    assert_eq!(download.on(at(0), "581#A20104"), block(&data, 7, 4));
    assert_eq!(download.on(at(0), "581#A20004"), block(&data, 7, 4));
    assert_eq!(download.on(at(0), "581#A20402"), block(&data, 35, 1));
}

#[test]
fn a_server_that_takes_nothing_is_given_up() {
    let data = pattern(37);
    let mut download = downloading(true);
    for _ in 0..3 {
        assert_eq!(download.on(at(0), "581#A20004"), block(&data, 0, 4));
    }
    assert_eq!(download.on(at(0), "581#A20104"), block(&data, 7, 4));
    for _ in 0..3 {
        assert_eq!(download.on(at(0), "581#A20004"), block(&data, 7, 4));
    }
    fails(&mut download, "A20004", SEQUENCE, SdoError::NoProgress);
}

#[test]
fn block_sizes_have_to_be_valid() {
    const BLOCK_SIZE: &str = "02000405";
    for size in ["00", "80", "FF"] {
        let answer = format!("A4032000{size}");
        let mut download = download(&pattern(37), options(4));
        download.talk(&[("", "C603200025")]);
        refuses(&mut download, &answer, BLOCK_SIZE, Expected::BlockDownload);
        let answer = format!("A204{size}");
        refuses(
            &mut downloading(true),
            &answer,
            BLOCK_SIZE,
            Expected::BlockConfirmation,
        );
    }
}

#[test]
fn downloads_refuse_answers_out_of_turn() {
    for answer in ["A404200004", "60032000", "C603200004", "A20404"] {
        let mut download = download(&pattern(37), options(4));
        download.talk(&[("", "C603200025")]);
        refuses(&mut download, answer, COMMAND, Expected::BlockDownload);
    }
    for answer in ["A1", "60032000", "20", "A403200004"] {
        refuses(
            &mut downloading(true),
            answer,
            COMMAND,
            Expected::BlockConfirmation,
        );
    }
    refuses(
        &mut downloading(true),
        "A20504",
        SEQUENCE,
        Expected::BlockConfirmation,
    );
    for answer in ["A20204", "60032000", "20"] {
        let mut download = downloading(true);
        assert_eq!(download.on(at(0), "581#A20404").len(), 2);
        assert_eq!(download.on(at(0), "581#A20204").len(), 1);
        refuses(&mut download, answer, COMMAND, Expected::BlockDownloadEnd);
    }
}

#[test]
fn a_server_without_block_downloads_gets_segments() {
    let data = pattern(9);
    let mut download = download(&data, options(4));
    assert!(!download.refused_block());
    download.talk(&[
        ("", "C603200009"),
        ("8003200001000405", "2103200009"),
        ("60032000", "0001203F5E7D9CBB"),
        ("20", "1BDAF9"),
        ("30", "-"),
    ]);
    assert!(download.refused_block());
    assert_eq!(download.outcome(), Some(Ok(())));
}

#[test]
fn a_block_download_waits_for_its_answer() {
    let mut download = download(&pattern(37), options(4));
    download.out(at(0));
    download.handle_frame(at(100), &frame("581#A403200004"));
    assert_eq!(
        download.poll_timeout(),
        Some(at(1000)),
        "as long as nothing is sent"
    );
    for time in [500, 600, 700, 800] {
        assert!(download.poll_transmit(at(time)).is_some());
        assert_eq!(download.poll_timeout(), Some(at(time + 1000)));
    }
    assert_eq!(download.poll_transmit(at(900)), None);
    download.handle_frame(at(1000), &frame("581#A20404"));
    assert_eq!(download.poll_timeout(), None, "the host is at turn");
    download.out(at(2000));
    download.handle_timeout(at(3000));
    assert_eq!(download.outcome(), Some(Err(SdoError::Silent)));
    assert_eq!(download.out(at(3000)), ["601#8003200000000405"]);
}
