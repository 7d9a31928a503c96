//! Block download frame by frame: lost segments, servers without block transfers, servers that
//! misbehave.

use crate::support::blocks::{COMMAND, SEQUENCE, crc, fails, options, refuses, segment};
use crate::support::{Machine, at, download, frame, pattern};
use od_client::Error;
use od_client::sdo::{Download, Expected};

/// A block download of 37 bytes in blocks of four segments; the first block was sent.
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

#[test]
fn small_values_are_sent_in_segments() {
    let mut download = download(&pattern(7), options(4));
    download.talk(&[("", "2103200007")]);
    let mut longer = crate::support::download(&pattern(8), options(4));
    longer.talk(&[("", "C603200008")]);
}

#[test]
fn other_aborts_end_a_block_download() {
    let mut download = download(&pattern(8), options(4));
    download.talk(&[("", "C603200008"), ("8003200000000106", "-")]);
    assert_eq!(download.outcome(), Some(Err(Error::Abort(0x0601_0000))));
    let mut block = downloading(true);
    block.talk(&[("8003200004000405", "-")]);
    assert_eq!(block.outcome(), Some(Err(Error::Abort(0x0504_0004))));
}

#[test]
fn a_block_that_is_cancelled_sends_no_more_segments() {
    let mut download = download(&pattern(37), options(4));
    download.talk(&[("", "C603200025")]);
    download.handle_frame(at(0), &frame("581#A403200004"));
    let first = download.poll_transmit(at(0)).map(|frame| frame.to_string());
    assert_eq!(first.as_ref(), block(&pattern(37), 0, 1).first());
    download.cancel();
    assert_eq!(download.out(at(0)), ["601#8003200000000008"]);
    assert_eq!(download.outcome(), Some(Err(Error::Cancelled)));
}

#[test]
fn a_download_in_two_blocks() {
    let data = pattern(37);
    let mut download = downloading(true);
    // The server accepts blocks of one segment now, then of three.
    assert_eq!(download.on(at(0), "581#A20401"), block(&data, 28, 1));
    assert_eq!(download.on(at(0), "581#A20103"), block(&data, 35, 1));
    download.talk(&[("A20100", &format!("D5{}", crc(&data)))]);
    assert_eq!(download.outcome(), None);
    download.talk(&[("A1", "-")]);
    assert_eq!(download.outcome(), Some(Ok(())));
    assert_eq!(download.poll_timeout(), None);
}

#[test]
fn without_a_checksum_on_the_server_none_is_sent() {
    let data = pattern(37);
    let mut download = downloading(false);
    assert_eq!(download.on(at(0), "581#A2047F"), block(&data, 28, 2));
    download.talk(&[("A2027F", "D5"), ("A1", "-")]);
    assert_eq!(download.outcome(), Some(Ok(())));
}

#[test]
fn values_of_whole_segments_have_no_unused_bytes() {
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
fn segments_that_the_server_did_not_receive_are_sent_again() {
    let data = pattern(37);
    let mut download = downloading(true);
    assert_eq!(download.on(at(0), "581#A20104"), block(&data, 7, 4));
    assert_eq!(download.on(at(0), "581#A20004"), block(&data, 7, 4));
    assert_eq!(download.on(at(0), "581#A20402"), block(&data, 35, 1));
}

#[test]
fn a_server_that_confirms_no_segment_ends_the_download() {
    let data = pattern(37);
    let mut download = downloading(true);
    for _ in 0..3 {
        assert_eq!(download.on(at(0), "581#A20004"), block(&data, 0, 4));
    }
    assert_eq!(download.on(at(0), "581#A20104"), block(&data, 7, 4));
    for _ in 0..3 {
        assert_eq!(download.on(at(0), "581#A20004"), block(&data, 7, 4));
    }
    fails(&mut download, "A20004", SEQUENCE, Error::NoProgress);
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
fn an_unexpected_response_ends_a_block_download() {
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
fn a_block_download_waits_for_its_response() {
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
    assert_eq!(download.outcome(), Some(Err(Error::Silent)));
    assert_eq!(download.out(at(3000)), ["601#8003200000000405"]);
}
