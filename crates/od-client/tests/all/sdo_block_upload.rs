//! Block upload frame by frame: lost segments, servers without block transfers, servers that
//! misbehave.

use crate::support::blocks::{COMMAND, SEQUENCE, crc, fails, options, refuses, segment};
use crate::support::{Machine, at, frame, pattern, upload};
use od_client::sdo::{Expected, Upload};
use od_client::{CanId, Error, Frame};

/// A block upload of `len` bytes after its start: blocks of four segments, with CRC.
#[track_caller]
fn uploading(len: u8) -> Upload<Vec<u8>> {
    let mut upload = upload(options(4));
    assert_eq!(upload.out(at(0)), ["601#A403200004000000"]);
    upload.talk(&[(&format!("C6032000{len:02X}"), "A3")]);
    upload
}

/// A block upload of eight bytes was requested.
#[track_caller]
fn asked() -> Upload<Vec<u8>> {
    let mut upload = upload(options(4));
    upload.talk(&[("", "A403200004")]);
    upload
}

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
fn without_block_uploads_a_value_of_any_length_is_one_transfer() {
    let mut options = options(4);
    options.block_upload = false;
    for announced in ["4103200007", "410320000010", "40032000FF"] {
        let mut upload = upload(options);
        upload.talk(&[("", "40032000"), (announced, "60")]);
    }
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
        // The same segment twice, as after a confirmation that arrived late.
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
    // The server sends nothing more.
    assert_eq!(upload.poll_timeout(), Some(at(2700)));
    upload.handle_timeout(at(2700));
    assert_eq!(upload.outcome(), Some(Err(Error::Silent)));
    assert_eq!(upload.out(at(2700)), ["601#8003200000000405"]);
}

#[test]
fn a_server_that_never_sends_the_first_segment_ends_the_upload() {
    let mut upload = uploading(28);
    for _ in 0..3 {
        upload.talk(&[("03", "-"), ("04", "A20004")]);
    }
    // Progress restarts the count.
    upload.talk(&[("01", "-"), ("03", "-"), ("04", "A20104")]);
    for _ in 0..3 {
        upload.talk(&[("84", "A20004")]);
    }
    fails(&mut upload, "84", SEQUENCE, Error::NoProgress);
}

#[test]
fn the_checksum_is_checked_if_the_server_sends_one() {
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
    fails(&mut wrong, "C1", "04000405", Error::Crc);
    let mut without = upload(options(4));
    without.talk(&[("", "A403200004"), ("C20320001C", "A3")]);
    segments(&mut without);
    without.talk(&[("C1", "A1")]);
    assert_eq!(without.outcome(), Some(Ok(())));
}

#[test]
fn a_block_upload_keeps_its_announced_length() {
    let error = |announced, received| Error::Length {
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
        upload.talk(&[("", "A403200004")]);
        upload
    };
    fails(&mut begun(), "C6032000FFFFFFFF", "05000405", Error::TooLong);
    fails(&mut begun(), "C603200065", "05000405", Error::TooLong);
    // Without a size, and without an end.
    let mut upload = begun();
    upload.talk(&[("C4032000", "A3")]);
    for block in 0..4 {
        let last = if block == 3 { "80032000" } else { "A20404" };
        upload.talk(&[("01", "-"), ("02", "-")]);
        if block == 3 {
            fails(&mut upload, "03", "05000405", Error::TooLong);
        } else {
            upload.talk(&[("03", "-"), ("04", last)]);
        }
    }
}

#[test]
fn a_server_without_block_uploads_gets_segments() {
    let mut upload = asked();
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
    let mut upload = asked();
    upload.talk(&[("4103200008", "60"), ("00", "70"), ("1D08", "-")]);
    assert_eq!(upload.outcome(), Some(Ok(())));
    assert!(!upload.refused_block());
}

#[test]
fn other_aborts_end_a_block_upload() {
    let mut upload = asked();
    upload.talk(&[("8003200000000106", "-")]);
    assert_eq!(upload.outcome(), Some(Err(Error::Abort(0x0601_0000))));
    let mut segments = uploading(28);
    segments.talk(&[("01", "-"), ("8003200000000008", "-")]);
    assert_eq!(segments.outcome(), Some(Err(Error::Abort(0x0800_0000))));
    // The code that means "no block transfers", for another transfer.
    refuses(
        &mut asked(),
        "8004200001000405",
        COMMAND,
        Expected::BlockUpload,
    );
}

#[test]
fn an_unexpected_response_ends_a_block_upload() {
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

/// A frame of the server with these bytes only.
fn short(data: &[u8]) -> Frame {
    Frame::new(CanId::standard(0x581), data).expect("8 bytes")
}

/// A block upload of 24 bytes of which this last segment came, and then the end with this first byte.
fn ended_by(last: &[u8], end: &str) -> Upload<Vec<u8>> {
    let data = pattern(21);
    let mut upload = uploading(24);
    for number in 1..4 {
        let start = usize::from(number - 1) * 7;
        upload.talk(&[(&segment(number, &data, start), "-")]);
    }
    upload.handle_frame(at(0), &short(last));
    if upload.outcome().is_none() {
        upload.talk(&[("", "A20404")]);
        upload.handle_frame(at(0), &frame(&format!("581#{end}{}", crc(&pattern(24)))));
    }
    upload
}

/// The bytes that a short frame does not have are not 0. The last segment may lack those that are not data.
#[test]
fn a_frame_of_a_block_upload_that_is_too_short_ends_it() {
    let too_short = |needed, received| Some(Err(Error::Short { needed, received }));
    let rest = &pattern(24)[21..];
    let whole = [&[0x84], rest].concat();
    assert_eq!(ended_by(&whole, "D1").outcome(), Some(Ok(())));
    assert_eq!(ended_by(&whole[..3], "D1").outcome(), too_short(4, 3));
    assert_eq!(ended_by(&[0x84], "D1").outcome(), too_short(2, 1));
    let mut first = uploading(24);
    first.handle_frame(at(0), &short(&[1, 0, 0, 0]));
    assert_eq!(first.outcome(), too_short(8, 4));
    let mut size = asked();
    size.handle_frame(at(0), &short(&[0xC2, 3, 0x20, 0, 24]));
    assert_eq!(size.outcome(), too_short(8, 5));
}
