use super::*;

#[track_caller]
fn check(line: &str, expected: &str) {
    let shown = match parse_line(line) {
        Ok(LogLine {
            at: Some(at),
            interface,
            frame,
        }) => format_line(at, interface.as_deref().unwrap_or("-"), &frame),
        Ok(LogLine { frame, .. }) => frame.to_string(),
        Err(error) => format!("{}: {}", error.column, error.message),
    };
    assert_eq!(shown, expected, "{line}");
}

#[test]
fn the_three_forms_read_the_same() {
    check(
        "(0.100000) can0 601#4004600000000000",
        "(0.100000) can0 601#4004600000000000",
    );
    check(
        "  (1600000000.5)  vcan1  701#R R",
        "(1600000000.500000) vcan1 701#R",
    );
    check("601#40.04.60.00", "601#40046000");
    check("1F334455#11", "1F334455#11");
    check("701#R4", "701#R4");
    check("080#", "080#");
    check(
        "can0  601   [8]  40 04 60 00 00 00 00 00",
        "601#4004600000000000",
    );
    check(
        " (003.1)  can0  701   [0]  remote request",
        "(3.100000) can0 701#R",
    );
    // -x, -a and -tA.
    check(
        " (0.1)  can0  TX - -  181   [3]  41 27 20   'A' '",
        "(0.100000) can0 181#412720",
    );
    check("can0  RX B E  181   [1]  41", "181#41");
    check("can0  RX - -  701   [1]  remote request", "701#R1");
    check(
        "(1970-01-01 00:00:01.5) can0 181 [1] 41 'A'",
        "(1.500000) can0 181#41",
    );
    // -i, -S, and a DLC above 8 (-8).
    check("can0 181 [2] 01000001 11101100", "181#41EC");
    check("can0 181 [3] 20`27`41", "181#412720");
    check("can0 181 [2] 11101100`01000001", "181#41EC");
    check("can0 181#0102030405060708_F", "181#0102030405060708");
}

/// The classes of `linux/can/error.h`. Lost arbitration is how CAN works, and a restart is no error.
#[test]
fn an_error_of_socketcan_says_which_one_it_is() {
    let lines = [
        (
            " (0.1)  can0  20000088   [8]  00 00 90 00 00 00 00 00   ERRORFRAME",
            Some(BusError::Frame),
        ),
        (
            " (0.1)  can0  RX - -  200000A8   [8]  00 00 80 19 00 00 08 00   ERRORFRAME",
            Some(BusError::NoAcknowledge),
        ),
        (
            "(0.1) can0 20000020#0000000000000000",
            Some(BusError::NoAcknowledge),
        ),
        (
            "(0.1) can0 20000004#0008000000006000",
            Some(BusError::Warning),
        ),
        (
            " (0.1)  can0  20000004   [8]  00 20 00 00 00 00 80 00   ERRORFRAME",
            Some(BusError::Passive),
        ),
        (
            "(0.1) can0 20000040#0000000000000000",
            Some(BusError::BusOff),
        ),
        (
            " (0.1)  can0  20000002   [8]  05 00 00 00 00 00 00 00   ERRORFRAME",
            None,
        ),
        ("(0.1) can0 20000100#0000000000000000", None),
        (
            " (0.1)  can0  20000004   [8]  00 40 00 00 00 00 5F 00   ERRORFRAME",
            None,
        ),
    ];
    for (line, wanted) in lines {
        let text = format!("{line}\n(0.2) can0 701#05\n");
        let log = crate::logs::read(text.as_bytes()).expect("a log");
        let found = match log.records[0].what {
            What::Error(error) => Some(error),
            What::Frame(_) => None,
        };
        assert_eq!(
            (found, log.others),
            (wanted, usize::from(wanted.is_none())),
            "{line}"
        );
        for format in [crate::logs::Format::Candump, crate::logs::Format::Pcapng] {
            let written = crate::logs::read(&format.write(&log.records));
            assert_eq!(written.expect("a log").records, log.records, "{line}");
        }
    }
}

/// People explain the frames of a log that they paste into a question, and others quote it.
#[test]
fn a_remark_may_follow_a_frame() {
    check("can0  000   [2]  82 0A      # NMT to node 0Ah", "000#820A");
    check("can0  70A   [1]  00   boot-up", "70A#00");
    check("can0  701   [0]  remote request  <- guarding", "701#R");
    check("(0.1) can0 70A#00 T // boot-up", "(0.100000) can0 70A#00");
    check("60A#4017 ; heartbeat", "60A#4017");
    check(
        "can0 701 [1] 00 05 boot-up",
        "17: unexpected `05` after the frame",
    );
    let quoted = "> > can0  70A   [1]  00\n> > can0  70A   [1]  7F   # why?\n";
    let log = crate::logs::read(quoted.as_bytes()).expect("a log");
    assert_eq!((log.records.len(), log.skipped.len()), (2, 0));
}

/// Columns that other options add to a log, and escape sequences of a terminal.
#[test]
fn a_log_may_have_other_lines() {
    let text = "```\n\u{1b}[31m  can0  701   [1]  00\u{1b}[0m\n\
        \x20 can0  20000004   [8]  00 08 00 00 00 00 60 00   ERRORFRAME\n\
        \tcontroller-problem{tx-error-warning}\n\terror-counter-tx-rx{{96}{0}}\n\
        DROPCOUNT: dropped 12 CAN frames on 'can0' socket (total drops 12)\n\
        \x20 can0  701   [1]  05\n```\n";
    let log = crate::logs::read(text.as_bytes()).expect("a log");
    assert_eq!(log.records.len(), 3);
    assert_eq!(log.records[1].what, What::Error(BusError::Warning));
    let problems: Vec<_> = log.skipped.iter().map(ToString::to_string).collect();
    assert_eq!(problems, ["line 6: candump lost frames here: 12"]);
}

#[test]
fn errors_name_the_place_and_the_problem() {
    check("601", "4: the line ends here");
    check("(x) can0 601#40", "1: `(x)` is not a time stamp");
    check("601#4", "5: half a byte");
    check("601#4g", "6: `g` is not a hex digit");
    check("601#112233445566778899", "22: more than 8 bytes");
    check("800#11", "1: CAN-ID 800 is too large");
    check("can0 6011#11", "6: `6011` has 4 digits");
    check("60x#11", "3: `60x` is not a valid CAN-ID");
    check("601#R9", "6: `9` is not a valid length");
    check("601##011", "5: `##` begins a CAN FD frame");
    check("can0 601 [9] 00", "10: the length is not valid");
    check("can0 601 [2] 00", "16: the line ends here");
    check("601#11 22", "8: unexpected `22` after the frame");
    check("ä#11", "1: `ä` is not a valid CAN-ID");
    check(
        "(1.5) can0 20000004#0000",
        "12: `20000004#0000` is an error frame",
    );
    check(
        "can0  20000004   [8]  00 00 00 00 00 00 00 00   ERRORFRAME",
        "7: `20000004` is an error frame",
    );
    check("can0 181 [2] 20`27`41", "14: `20`27`41` is not 2 bytes");
    check("can0 181 [1] 0000000x", "14: `0000000x` is not a byte");
    check("can0 181#01_F", "12: `_` is not a hex digit");
    check("can0 RX", "8: the line ends here");
    check("can0 RX X 601#11", "9: `X` is not a valid CAN-ID");
}

fn milliseconds(bytes: &[u8]) -> Vec<u64> {
    let log = crate::logs::read(bytes).expect("a log");
    assert_eq!(log.skipped, []);
    let records = log.records.iter();
    records.map(|one| one.at.as_micros() / 1000).collect()
}

#[test]
fn times_since_the_frame_before_are_added_up() {
    let deltas = " (000.000000)  can0  701   [1]  00\n (000.100000)  can0  601   [1]  40\n (000.001000)  can0  581   [1]  80\n";
    assert_eq!(milliseconds(deltas.as_bytes()), [0, 100, 101]);
    // The rows of a table can be in the order of their CAN-IDs.
    let rows = "Time Stamp,ID,Extended,Dir,Bus,LEN,D1,D2,D3,D4,D5,D6,D7,D8\n\
        0,00000181,false,Rx,0,1,05,\n100000,00000181,false,Rx,0,1,05,\n50000,00000281,false,Rx,0,1,05,\n";
    assert_eq!(milliseconds(rows.as_bytes()), [0, 50, 100]);
    // Two interfaces: one frame was printed late.
    let from_start = " (000.000000)  can0  701   [1]  00\n (000.100000)  can0  701   [1]  05\n (000.200001)  can0  701   [1]  05\n \
        (000.200000)  can1  701   [1]  05\n (000.300000)  can0  701   [1]  05\n (000.400000)  can0  701   [1]  05\n";
    assert_eq!(
        milliseconds(from_start.as_bytes()),
        [0, 100, 200, 200, 300, 400]
    );
}

#[test]
fn utf_16_is_read() {
    let text = "\u{feff}(0.5) can0 701#00\r\n(0.6) can0 701#05\r\n";
    for to_bytes in [u16::to_le_bytes, u16::to_be_bytes] {
        let bytes: Vec<u8> = text.encode_utf16().flat_map(to_bytes).collect();
        assert_eq!(milliseconds(&bytes), [500, 600]);
    }
}

#[test]
fn a_log_of_can_fd_frames_only_is_named() {
    let frames =
        "  can0  123   [12]  00 00 00 00 00 00 00 00 00 00 00 00\n  can0  701   [01]  05\n";
    let why = super::super::read::read(frames.as_bytes()).expect_err("no classic frame");
    assert!(why.to_string().contains("CAN FD"), "{why}");
}
