//! Errors in words.

use od_client::Error;
use od_client::pdo::TooShort;
use od_client::sdo::Expected;
use od_wire::sdo::Response;

#[test]
fn every_expected_response_has_a_name_of_its_own() {
    use Expected::*;
    let all = [
        (Upload, "an upload response"),
        (UploadSegment, "an upload segment"),
        (Download, "a download response"),
        (DownloadSegment, "a download segment response"),
        (BlockUpload, "a block upload response"),
        (BlockSegment, "a block segment"),
        (BlockUploadEnd, "the end of a block upload"),
        (BlockDownload, "a block download response"),
        (BlockConfirmation, "a block response"),
        (BlockDownloadEnd, "the end of a block download"),
    ];
    for (expected, text) in all {
        assert_eq!(expected.to_string(), text);
        let got = Response::EndBlockDownload;
        let error = Error::OutOfTurn { expected, got };
        let whole = format!("{text} was expected, but another SDO response came");
        assert_eq!(error.to_string(), whole);
    }
}

#[test]
fn a_response_out_of_turn_is_named_by_its_object_or_its_toggle_bit() {
    let shown = |expected, data: [u8; 8]| {
        let got = Response::parse(&data);
        Error::OutOfTurn { expected, got }.to_string()
    };
    assert_eq!(
        shown(Expected::Upload, [0x43, 0x01, 0x10, 2, 0, 0, 0, 0]),
        "an upload response was expected, but a response for 1001h:02 came"
    );
    assert_eq!(
        shown(Expected::UploadSegment, [0x10, 1, 2, 3, 4, 5, 6, 7]),
        "an upload segment was expected, but one with the wrong toggle bit came"
    );
    assert_eq!(
        shown(Expected::DownloadSegment, [0x30, 0, 0, 0, 0, 0, 0, 0]),
        "a download segment response was expected, but one with the wrong toggle bit came"
    );
}

#[test]
fn errors_name_their_numbers() {
    let known = "SDO abort 06020000h object does not exist";
    assert_eq!(Error::Abort(0x0602_0000).to_string(), known);
    let other = "SDO abort 06020001h object or its content does not exist (CiA 301 does not define the code)";
    assert_eq!(Error::Abort(0x0602_0001).to_string(), other);
    let error = Error::Length {
        announced: 7,
        received: 5,
    };
    let text = "the SDO server announces a length of 7 and sends 5";
    assert_eq!(error.to_string(), text);
    let refused = |error, specific| Error::Refused { error, specific }.to_string();
    assert_eq!(refused(1, 9), "the LSS slave responds with error 1");
    assert_eq!(
        refused(255, 9),
        "the LSS slave responds with specific error 9"
    );
    let error = TooShort {
        mapped: 32,
        received: 16,
    };
    assert_eq!(error.to_string(), "the PDO has 16 bits, but its mapping 32");
}

#[test]
fn busy_and_full_are_explained() {
    let busy = "the LSS master is at work on another service";
    assert_eq!(od_client::lss::Busy.to_string(), busy);
    assert_eq!(
        od_client::watch::Full.to_string(),
        "no more nodes can be watched"
    );
}
