//! Upload frame by frame, and servers that misbehave.

use crate::support::{Machine, OBJECT, at, frame, upload};
use od_client::Error;
use od_client::sdo::{Channel, Expected, Options, Slice, Upload};
use od_client::{NodeId, sdo};
use od_model::Address;
use od_wire::sdo::Response;

const ASK: &str = "40032000";
const NEXT: [&str; 2] = ["60", "70"];

#[track_caller]
fn value(answer: &str, wanted: &[u8]) {
    let mut upload = upload(Options::DEFAULT);
    upload.talk(&[("", ASK), (answer, "-")]);
    assert_eq!(upload.outcome(), Some(Ok(())), "{answer}");
    assert_eq!(upload.bytes(), wanted);
    assert_eq!(upload.poll_timeout(), None);
}

/// Checks that the response ends the upload with this error and this abort, and that no further
/// frame is sent.
#[track_caller]
fn ends(mut upload: Upload<impl sdo::Buffer>, answer: &str, abort: &str, error: Error) {
    let code: String = abort
        .as_bytes()
        .rchunks(2)
        .map(|it| core::str::from_utf8(it).unwrap_or(""))
        .collect();
    upload.talk(&[(answer, &format!("80032000{code}"))]);
    assert_eq!(upload.outcome(), Some(Err(error)));
    assert_eq!(upload.poll_timeout(), None);
    upload.talk(&[("4303200001020304", "-"), ("80032000", "-")]);
    upload.handle_timeout(at(1_000_000));
    assert_eq!(
        (upload.out(at(1_000_000)), upload.outcome()),
        (vec![], Some(Err(error)))
    );
}

fn out_of_turn(expected: Expected, answer: &str) -> Error {
    let got = Response::parse(frame(&format!("581#{answer}")).bytes());
    Error::OutOfTurn { expected, got }
}

fn asked() -> Upload<Vec<u8>> {
    let mut upload = upload(Options::DEFAULT);
    upload.talk(&[("", ASK)]);
    upload
}

/// Two segments of a value of unknown length were read.
fn in_segments() -> Upload<Vec<u8>> {
    let mut upload = asked();
    upload.talk(&[
        ("40032000", NEXT[0]),
        ("0001020304050607", NEXT[1]),
        ("1011121314151617", NEXT[0]),
    ]);
    upload
}

#[test]
fn the_trace_of_the_bus_cover_manual() {
    // 000, chapter 6.4: 40 02 60 00 -> 43 02 60 00 00 00 00 20
    let object = Address::new(0x6002, 0);
    let channel = Channel::of(NodeId::new(2).expect("a node ID"));
    let mut upload = Upload::new(channel, object, Vec::new(), Options::DEFAULT);
    assert_eq!(upload.out(at(0)), ["602#4002600000000000"]);
    assert!(upload.on(at(0), "582#4302600000000020").is_empty());
    assert_eq!(upload.into_buffer(), [0, 0, 0, 0x20]);
}

#[test]
fn expedited_values_of_each_length() {
    value("4303200001020304", &[1, 2, 3, 4]);
    value("4703200001020304", &[1, 2, 3]);
    value("4B03200001020304", &[1, 2]);
    value("4F03200001020304", &[1]);
    // Without a size all four bytes are the value.
    value("4203200001020304", &[1, 2, 3, 4]);
}

#[test]
fn segments_with_and_without_a_size() {
    for initiate in ["4003200000000000", "4103200010000000"] {
        let mut upload = asked();
        upload.talk(&[
            (initiate, NEXT[0]),
            ("0001020304050607", NEXT[1]),
            ("1011121314151617", NEXT[0]),
            ("0B2122", "-"),
        ]);
        assert_eq!(upload.outcome(), Some(Ok(())));
        let wanted = [
            1, 2, 3, 4, 5, 6, 7, 0x11, 0x12, 0x13, 0x14, 0x15, 0x16, 0x17, 0x21, 0x22,
        ];
        assert_eq!(upload.bytes(), wanted);
    }
}

#[test]
fn an_empty_value_is_one_empty_segment() {
    let mut upload = asked();
    upload.talk(&[("41032000", NEXT[0]), ("0F", "-")]);
    assert_eq!((upload.outcome(), upload.bytes()), (Some(Ok(())), &[][..]));
}

#[test]
fn aborts_of_the_server_are_reported_unchanged() {
    for mut upload in [asked(), in_segments()] {
        upload.talk(&[("8003200011000906", "-")]);
        assert_eq!(upload.outcome(), Some(Err(Error::Abort(0x0609_0011))));
        assert_eq!(upload.poll_timeout(), None);
    }
    // A server after a reset does not know which transfer it aborts.
    let mut upload = in_segments();
    upload.talk(&[("8000000001000405", "-")]);
    assert_eq!(upload.outcome(), Some(Err(Error::Abort(0x0504_0001))));
}

#[test]
fn responses_for_another_object_are_unexpected() {
    for answer in [
        "4304200001020304",
        "4303210001020304",
        "4303200101020304",
        "4104200008000000",
    ] {
        let error = out_of_turn(Expected::Upload, answer);
        ends(asked(), answer, "05040001", error);
    }
    let abort = "8004200011000906";
    ends(
        asked(),
        abort,
        "05040001",
        out_of_turn(Expected::Upload, abort),
    );
    ends(
        in_segments(),
        abort,
        "05040001",
        out_of_turn(Expected::UploadSegment, abort),
    );
}

#[test]
fn other_commands_are_unexpected() {
    for answer in ["60032000", "00", "20", "A4032000", "C6032000", "E0"] {
        ends(
            asked(),
            answer,
            "05040001",
            out_of_turn(Expected::Upload, answer),
        );
    }
    for answer in ["20", "60032000", "4303200001020304", "E0"] {
        ends(
            in_segments(),
            answer,
            "05040001",
            out_of_turn(Expected::UploadSegment, answer),
        );
    }
    let toggle = "1021222324252627";
    ends(
        in_segments(),
        toggle,
        "05030000",
        out_of_turn(Expected::UploadSegment, toggle),
    );
}

#[test]
fn an_announced_length_is_kept() {
    let begun = |size: &str| {
        let mut upload = asked();
        upload.talk(&[(&format!("41032000{size}"), NEXT[0])]);
        upload
    };
    let error = |announced, received| Error::Length {
        announced,
        received,
    };
    ends(begun("06"), "0001020304050607", "06070010", error(6, 7));
    ends(begun("06"), "0501020304050607", "06070010", error(6, 5));
    ends(begun("08"), "0101020304050607", "06070010", error(8, 7));
    let mut exact = begun("06");
    exact.talk(&[("0301020304050607", "-")]);
    assert_eq!(exact.outcome(), Some(Ok(())));
}

#[test]
fn values_beyond_the_limit_are_refused() {
    let begun = |limit| {
        let mut options = Options::SEGMENTED;
        options.limit = limit;
        let mut upload = upload(options);
        upload.talk(&[("", ASK)]);
        upload
    };
    // 4 GB announced, or one byte more than the limit.
    ends(begun(1000), "41032000FFFFFFFF", "05040005", Error::TooLong);
    ends(begun(1000), "41032000E9030000", "05040005", Error::TooLong);
    ends(begun(3), "4303200001020304", "05040005", Error::TooLong);
    let mut exact = begun(1000);
    exact.talk(&[("41032000E8030000", NEXT[0])]);
    let mut without_end = begun(13);
    without_end.talk(&[("40032000", NEXT[0]), ("00", NEXT[1])]);
    ends(without_end, "10", "05040005", Error::TooLong);
    let mut to_the_limit = begun(14);
    to_the_limit.talk(&[("40032000", NEXT[0]), ("00", NEXT[1]), ("11", "-")]);
    assert_eq!(to_the_limit.outcome(), Some(Ok(())));
}

#[test]
fn a_buffer_of_the_caller_is_a_limit_too() {
    let mut room = [0; 13];
    for announced in ["4103200001000000", "410320000E000000"] {
        let channel = Channel::of(NodeId::ONE);
        let mut upload = Upload::new(channel, OBJECT, Slice::new(&mut room), Options::DEFAULT);
        upload.talk(&[("", ASK)]);
        if announced.starts_with("410320000E") {
            ends(upload, announced, "05040005", Error::TooLong);
        } else {
            upload.talk(&[(announced, NEXT[0]), ("0DAA", "-")]);
            assert_eq!(upload.bytes(), [0xAA]);
        }
    }
}

#[test]
fn segments_without_data_end_the_upload() {
    ends(in_segments(), "0E", "08000000", Error::NoProgress);
}

#[test]
fn frames_of_other_nodes_are_ignored() {
    let mut upload = upload(Options::DEFAULT);
    // Before the request was sent no frame can be its response.
    upload.talk(&[("4303200001020304", ASK)]);
    assert_eq!(upload.outcome(), None);
    for other in [
        "582#4303200001020304",
        "601#4303200001020304",
        "581#R",
        "081#8003200000000000",
    ] {
        assert!(upload.on(at(0), other).is_empty());
        assert_eq!(upload.outcome(), None, "{other}");
    }
    upload.handle_frame(at(0), &od_client::Frame::standard(0x581, &[]));
    assert_eq!(upload.outcome(), None);
    upload.handle_frame(
        at(0),
        &od_client::Frame::standard(0x581, &[0x4F, 0x03, 0x20, 0, 9]),
    );
    assert_eq!((upload.outcome(), upload.bytes()), (Some(Ok(())), &[9][..]));
}

/// The bytes that a short frame does not have are not 0. One that has the whole value is accepted, as from old devices.
#[test]
fn a_response_that_is_too_short_for_its_value_ends_the_upload() {
    for (data, needed) in [
        (&[0x43, 0x03, 0x20, 0, 0xD2][..], 8),
        (&[0x4B, 0x03, 0x20, 0, 0xD2], 6),
        (&[0x42, 0x03, 0x20, 0], 5),
        (&[0x41, 0x03, 0x20, 0, 20], 8),
        (&[0x43], 8),
        // An abort whose code is not known.
        (&[0x80, 0x03, 0x20, 0, 0x11, 0], 8),
    ] {
        let mut upload = asked();
        let _ = upload.out(at(0));
        let id = od_client::CanId::standard(0x581);
        upload.handle_frame(at(0), &od_client::Frame::new(id, data).expect("8 bytes"));
        let received = data.len() as u8;
        assert_eq!(
            upload.outcome(),
            Some(Err(Error::Short { needed, received }))
        );
        assert_eq!(upload.out(at(0)), ["601#8003200010000706"]);
    }
    let mut segment = in_segments();
    segment.handle_frame(at(0), &od_client::Frame::standard(0x581, &[0, 1, 2, 3]));
    let error = Error::Short {
        needed: 8,
        received: 4,
    };
    assert_eq!(segment.outcome(), Some(Err(error)));
    let mut last = in_segments();
    last.handle_frame(at(0), &od_client::Frame::standard(0x581, &[0x0B, 7, 8]));
    assert_ne!(last.outcome(), Some(Err(error)));
}

#[test]
fn while_a_request_waits_only_an_abort_ends_the_transfer() {
    let mut upload = asked();
    upload.handle_frame(at(0), &frame("581#4003200000000000"));
    upload.handle_frame(at(0), &frame("581#0001020304050607"));
    assert_eq!((upload.outcome(), upload.bytes().len()), (None, 0));
    upload.handle_frame(at(0), &frame("581#8003200000000008"));
    assert_eq!(upload.outcome(), Some(Err(Error::Abort(0x0800_0000))));
    assert!(
        upload.out(at(0)).is_empty(),
        "the request is not sent any more"
    );
}

#[test]
fn a_transfer_without_a_response_ends_after_the_timeout() {
    let mut upload = upload(Options::DEFAULT);
    assert_eq!(upload.poll_timeout(), None, "the host has not sent it yet");
    upload.handle_timeout(at(10_000));
    assert_eq!(upload.out(at(500)), ["601#4003200000000000"]);
    assert_eq!(upload.poll_timeout(), Some(at(1500)));
    upload.handle_timeout(at(1499));
    assert_eq!(upload.outcome(), None);
    upload.handle_timeout(at(1500));
    assert_eq!(upload.outcome(), Some(Err(Error::Silent)));
    assert_eq!(upload.out(at(1500)), ["601#8003200000000405"]);
    assert_eq!(upload.poll_timeout(), None);
    let mut upload = in_segments();
    upload.handle_timeout(at(1000));
    assert_eq!(upload.out(at(1000)), ["601#8003200000000405"]);
}

#[test]
fn each_request_has_its_own_time() {
    let mut upload = upload(Options::DEFAULT);
    upload.out(at(0));
    assert_eq!(upload.on(at(900), "581#40032000"), ["601#6000000000000000"]);
    assert_eq!(upload.poll_timeout(), Some(at(1900)));
    upload.handle_frame(at(1800), &frame("581#00"));
    assert_eq!(upload.poll_timeout(), None, "the host is at turn");
}

#[test]
fn cancelling_aborts_the_transfer_at_the_server() {
    let mut upload = asked();
    upload.cancel();
    assert_eq!(upload.outcome(), Some(Err(Error::Cancelled)));
    upload.talk(&[("", "8003200000000008")]);
    let mut unsent = crate::support::upload(Options::DEFAULT);
    unsent.cancel();
    assert!(
        unsent.out(at(0)).is_empty(),
        "the server knows nothing of it"
    );
    let mut done = asked();
    done.talk(&[("4F03200001", "-")]);
    done.cancel();
    assert_eq!(done.outcome(), Some(Ok(())));
}

#[test]
fn a_buffer_is_emptied_first() {
    let mut upload = Upload::new(
        Channel::of(NodeId::ONE),
        OBJECT,
        vec![7; 9],
        Options::DEFAULT,
    );
    upload.talk(&[("", ASK), ("4F03200001", "-")]);
    assert_eq!(upload.into_buffer(), [1]);
}

#[test]
fn a_value_without_a_size_has_that_of_its_type() {
    for (type_size, len) in [
        (Some(1), 1),
        (Some(2), 2),
        (Some(4), 4),
        (Some(8), 4),
        (None, 4),
    ] {
        let mut options = Options::DEFAULT;
        options.type_size = type_size;
        let mut unsized_value = upload(options);
        unsized_value.talk(&[("", "40032000"), ("42032000F4010203", "-")]);
        assert_eq!(unsized_value.outcome(), Some(Ok(())));
        assert_eq!(unsized_value.bytes(), &[0xF4, 1, 2, 3][..len]);
        // An indicated size is used.
        let mut sized = upload(options);
        sized.talk(&[("", "40032000"), ("47032000F4010203", "-")]);
        assert_eq!(sized.bytes(), [0xF4, 1, 2]);
    }
}
