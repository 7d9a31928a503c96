//! Download frame by frame, and servers that misbehave.

use crate::support::{Machine, at, download, frame, pattern};
use od_client::Error;
use od_client::sdo::{Channel, Download, Expected, Options};
use od_client::{Frame, NodeId};
use od_model::Address;
use od_wire::sdo::Response;

const TAKEN: &str = "60032000";

/// A download whose first frame is `request`.
#[track_caller]
fn begun(bytes: &[u8], request: &str) -> Download<Vec<u8>> {
    let mut download = download(bytes, Options::DEFAULT);
    download.talk(&[("", request)]);
    download
}

/// Nine bytes, whose first segment was sent.
fn in_segments() -> Download<Vec<u8>> {
    let mut download = begun(&pattern(9), "2103200009");
    download.talk(&[(TAKEN, "0001203F5E7D9CBB")]);
    download
}

/// Checks that the response ends the download with this error and this abort, and that no further
/// frame is sent.
#[track_caller]
fn ends(mut download: Download<Vec<u8>>, answer: &str, abort: &str, expected: Expected) {
    let got = Response::parse(frame(&format!("581#{answer}")).bytes());
    let error = Error::OutOfTurn { expected, got };
    download.talk(&[(answer, &format!("80032000{abort}"))]);
    assert_eq!(download.outcome(), Some(Err(error)));
    assert_eq!(download.poll_timeout(), None);
    download.talk(&[(TAKEN, "-"), ("80032000", "-")]);
    download.handle_timeout(at(1_000_000));
    assert!(download.out(at(1_000_000)).is_empty());
    assert_eq!(download.outcome(), Some(Err(error)));
}

#[test]
fn expedited_values_of_each_length() {
    for (bytes, request) in [
        (&[1][..], "2F03200001"),
        (&[1, 2], "2B0320000102"),
        (&[1, 2, 3], "27032000010203"),
        (&[1, 2, 3, 4], "2303200001020304"),
    ] {
        let mut download = begun(bytes, request);
        download.talk(&[(TAKEN, "-")]);
        assert_eq!(download.outcome(), Some(Ok(())), "{request}");
        assert_eq!(download.poll_timeout(), None);
        assert_eq!(download.into_data(), bytes);
    }
}

#[test]
fn a_second_channel_has_its_own_ids() {
    let channel = Channel {
        request: od_client::CanId::extended(0x1_2345),
        response: od_client::CanId::standard(0x6E0),
    };
    let object = Address::new(0x6001, 0);
    let mut download = Download::new(channel, object, [7], Options::DEFAULT);
    assert_eq!(download.out(at(0)), ["00012345#2F01600007000000"]);
    assert!(download.on(at(0), "6E0#60016000").is_empty());
    assert_eq!(download.outcome(), Some(Ok(())));
}

#[test]
fn segments_alternate_and_the_last_one_says_so() {
    let mut download = begun(&pattern(16), "2103200010");
    download.talk(&[
        (TAKEN, "0001203F5E7D9CBB"),
        ("20", "10DAF91837567594"),
        ("30", "0BB3D2"),
        ("20", "-"),
    ]);
    assert_eq!(download.outcome(), Some(Ok(())));
    let mut seven = begun(&pattern(7), "2103200007");
    seven.talk(&[(TAKEN, "0101203F5E7D9CBB"), ("20", "-")]);
    assert_eq!(seven.outcome(), Some(Ok(())));
}

#[test]
fn an_empty_value_is_one_empty_segment() {
    let mut download = begun(&[], "21032000");
    download.talk(&[(TAKEN, "0F"), ("20", "-")]);
    assert_eq!(download.outcome(), Some(Ok(())));
}

#[test]
fn aborts_of_the_server_are_reported_unchanged() {
    for mut download in [begun(&[1], "2F03200001"), in_segments()] {
        download.talk(&[("8003200030000906", "-")]);
        assert_eq!(download.outcome(), Some(Err(Error::Abort(0x0609_0030))));
        assert_eq!(download.poll_timeout(), None);
    }
}

#[test]
fn other_responses_are_unexpected() {
    const CODE: &str = "01000405";
    let short = || begun(&[1], "2F03200001");
    for answer in [
        "60042000",
        "60032001",
        "4F03200001",
        "20",
        "A403200001",
        "8004200000000008",
    ] {
        ends(short(), answer, CODE, Expected::Download);
    }
    for answer in ["60032000", "A20101", "00", "8004200000000008"] {
        ends(in_segments(), answer, CODE, Expected::DownloadSegment);
    }
    ends(in_segments(), "30", "00000305", Expected::DownloadSegment);
}

/// The missing bytes of a short frame are not an abort code of 0. A response that says all that it must is accepted.
#[test]
fn an_abort_without_its_code_is_not_an_abort_code() {
    let send = |download: &mut Download<Vec<u8>>, data: &[u8]| {
        let id = od_client::CanId::standard(0x581);
        download.handle_frame(at(0), &od_client::Frame::new(id, data).expect("8 bytes"));
    };
    let mut short = begun(&[1], "2F03200001");
    send(&mut short, &[0x80, 3, 0x20, 0, 0x11]);
    let (needed, received) = (8, 5);
    assert_eq!(
        short.outcome(),
        Some(Err(Error::Short { needed, received }))
    );
    let mut whole = begun(&[1], "2F03200001");
    send(&mut whole, &[0x60, 3, 0x20, 0]);
    assert_eq!(whole.outcome(), Some(Ok(())));
}

#[test]
fn a_transfer_without_a_response_ends_after_the_timeout() {
    let mut download = in_segments();
    assert_eq!(download.poll_timeout(), Some(at(1000)));
    download.handle_timeout(at(999));
    assert_eq!(download.outcome(), None);
    download.handle_timeout(at(1000));
    assert_eq!(download.outcome(), Some(Err(Error::Silent)));
    assert_eq!(download.out(at(1000)), ["601#8003200000000405"]);
}

#[test]
fn cancelling_aborts_the_transfer_at_the_server() {
    let mut download = in_segments();
    download.cancel();
    download.talk(&[("", "8003200000000008"), ("20", "-")]);
    assert_eq!(download.outcome(), Some(Err(Error::Cancelled)));
}

#[test]
fn frames_of_other_nodes_are_ignored() {
    let mut download = begun(&[1], "2F03200001");
    for other in [
        frame("582#60032000"),
        frame("581#R"),
        Frame::standard(0x581, &[]),
        Frame::of(od_client::CanId::extended(0x581), &[0x60, 3, 0x20, 0]),
    ] {
        download.handle_frame(at(0), &other);
        assert_eq!(download.outcome(), None, "{other}");
    }
    assert_eq!(download.poll_timeout(), Some(at(1000)));
    let channel = Channel::of(NodeId::new(127).expect("a node ID"));
    assert_eq!(
        (channel.request.raw(), channel.response.raw()),
        (0x67F, 0x5FF)
    );
}
