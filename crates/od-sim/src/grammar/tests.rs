use std::format;
use std::prelude::v1::*;
use std::string::ToString;

use super::action::Action;
use super::deed::Deed;
use crate::script::Script;

#[track_caller]
fn check(text: &str, expected: &str) {
    let shown = match Script::parse(text) {
        Ok(script) => format!("{} lines", script.statements().len()),
        Err(problems) => problems
            .iter()
            .map(ToString::to_string)
            .collect::<Vec<_>>()
            .join("\n"),
    };
    assert!(shown.starts_with(expected), "{text}\n{shown}");
}

#[test]
fn every_kind_of_line_is_read() {
    check(
        "\u{feff}# comment\n\ndevice \"my device.eds\" node 0x10 as left off\nuse left\n\
         shaft at 79592h # behind\nshaft turn -2.5\nshaft rpm 60\npower cycle 2s\nswitch node 12\n\
         switch bitrate 7\nfault battery-low on\nwait 20us\nat 1.5s\nafter 2min sync\n\
         (3.5) can0 601#40.04.60.00\n701#R4\ncan0  601   [2]  40 04\nsend 080# 3 times every 10ms\n\
         nmt start all\nsync counter 3\nsync 5 times\nsdo read 6004h = 5\nsdo read 2000h aborts 06020000h\n\
         sdo write \"Identity object.Vendor-ID\" = 5 as u16 aborts 0x06010002\nignore 181#*\nignore nothing\n\
         skip\nguard\nread 1018h:01\nwrite 1017h=500 as u16\nexpect 581#43 05 05 5 times every 5ms\nexpect 581#* every 5ms 43 times\nexpect abort 06090031h\n\
         expect silence 1s\nexpect state off\nexpect value 6004h = 5\nexpect controller bus-off within 5s\nexpect led red flashing",
        "36 lines",
    );
}

#[test]
fn lines_about_several_devices_are_read() {
    check(
        "device eam_red node 1 2 as red\nuse red.2\ndevice gxmm node 3 on red\nbus bitrate 250\n\
         bus bitrate any\nfault temperature on\nexpect bitrate 50\nbus off\nbus active\nbus overrun\n\
         shaft ramp -6000 over 1.5s",
        "11 lines",
    );
    check("device eam_red node as red", "1:21: `as` is not valid");
    check("device gxmm on", "1:15: the name of a device is missing");
    check("bus bitrate 2000", "1:13: `2000` is not valid");
    check("shaft ramp 60", "1:14: `over` is missing");
    check("shaft ramp 60 over 5000s", "1:20: the ramp is too long");
    check("bus stop", "1:5: a bus cannot `stop`");
}

#[test]
fn each_mistake_has_its_place_and_message() {
    check("wait", "1:5: a duration is missing; write 500ms");
    check("\n  wait 5", "2:8: `5` is not a duration");
    check("wait 99999999999999999999s", "1:6: `99");
    check(
        "at 18446744073709.551615s nmt start",
        "1:4: `18446744073709.551615s` is too long; the limit is 100 years, 3153600000s",
    );
    check("wait 3153600000.000001s", "1:6: `3153600000.000001s` is");
    check("wait 52560001min", "1:6: `52560001min` is too long");
    check("wait 3153600000s\nafter 52560000min", "2 lines");
    check("(3153600001) 601#\n(5000000000) 601#", "2 lines");
    check(
        "(0.5) 601#\n(5000000000) 601#",
        "2:1: `(5000000000)` is too long",
    );
    check(
        "(99999999999999999999) 601#",
        "1:1: `(99999999999999999999)` is too",
    );
    check("expect 581#* within 99999999999999s", "1:21: `9999");
    check("sync 5 times every 3153600001s", "1:20: `3153600001s` is");
    for line in ["sync", "send 080#", "expect 080#", "expect 080# every 5ms"] {
        for number in ["18446744073709551615", "9".repeat(30).as_str(), "0", "-1"] {
            let column = line.chars().count() + 2;
            check(
                &format!("{line} {number} times"),
                &format!("1:{column}: `{number}` is not valid; write a number from 1 to 1000000"),
            );
        }
    }
    check("sync 1000000 times", "1 lines");
    check("sync 1000000 times every 3153s", "1 lines");
    for line in ["sync 1000000", "send 080# 1000000"] {
        check(
            &format!("{line} times every 3154s"),
            "1:6: `1000000 times` is too long; the limit is 100 years",
        );
    }
    check("device", "1:7: the device name is missing");
    check(
        "device gxmm node 128",
        "1:18: `128` is not valid; write a number from 1 to 127",
    );
    check(
        "device gxmm up 5",
        "1:8: a device name with blanks needs quotes",
    );
    check(
        "fault fire on",
        "1:7: fault `fire` does not exist; write position-error",
    );
    check(
        "nmt explode",
        "1:5: NMT command `explode` does not exist; write start, stop, preop",
    );
    check("expect 581", "1:8: `581` is not a frame");
    check("expect 581#40 0 times", "1:15: `0` is not valid");
    check(
        "expect state flying",
        "1:14: state `flying` does not exist; write operational,",
    );
    check(
        "sdo write 6004h",
        "1:5: the SDO line is not valid; write `sdo read 6004h`,",
    );
    check(
        "sdo read 6004h aborts 1",
        "1:23: abort code `1` does not exist",
    );
    check("(1.2.3) 601#", "1:1: `(1.2.3)` is not a time stamp");
    check("power on now", "1:10: unexpected `now`");
    check("after 5ms wait 5ms", "1:11: a line can have only one time");
}

#[test]
fn a_quoted_long_line_is_cut() {
    let long = "ä".repeat(100_000);
    for line in [
        "{}",
        "{}#40",
        "601#40 {}",
        "({})",
        "wait {}",
        "nmt {}",
        "sync {}",
        "sync 5{} times",
        "expect {}",
        "expect {}#40",
        "expect state {}",
        "shaft {}",
        "fault {} on",
        "device gxmm {}",
        "sdo read 6004h aborts {}",
        "{}` `{}",
    ] {
        for problem in Script::parse(&line.replace("{}", &long)).expect_err(line) {
            let length = problem.to_string().chars().count();
            assert!(length < 600, "{line}: {length} characters");
        }
    }
    let problem = &Script::parse(&"x".repeat(61)).expect_err("no statement")[0];
    let message = format!("`{}…` is not a verb or a frame", "x".repeat(60));
    assert_eq!(problem.message, message);
}

#[test]
fn a_frame_by_name_becomes_a_frame_for_the_device() {
    let kind = od_devices::find("gxmm").expect("it is built in");
    let node = od_runtime::NodeId::new(5).expect("1 to 127");
    let device = crate::VirtualDevice::new(kind, node);
    for (text, expected) in [
        ("605#40.17.10.00", "605#40171000"),
        (
            "(0.1) can0 605#4017100000000000 # a log",
            "605#4017100000000000",
        ),
        ("can0  605   [3]  40 17 10", "605#401710"),
        ("nmt start", "000#0105"),
        ("nmt stop all", "000#0200"),
        ("sync counter 3", "080#03"),
        ("guard", "705#R1"),
        ("read 1018h:01", "605#4018100100000000"),
        ("read \"producer heartbeat time\"", "605#4017100000000000"),
        ("write 1017h = 500", "605#2B171000F4010000"),
        ("write 1017h=5 as u8", "605#2F17100005000000"),
        ("write 1010h:01 = \"save\"", "605#2310100173617665"),
    ] {
        assert_eq!(typed(text, &device).as_deref(), Ok(expected), "{text}");
    }
    for (text, expected) in [
        (
            "write 1008h = \"a name\"",
            "an expedited download has 1 to 4 bytes",
        ),
        ("write 1017h = 99999", "UNSIGNED16"),
        ("read nothing", "no object is called `nothing`"),
    ] {
        let why = typed(text, &device).expect_err(text);
        assert!(why.starts_with(expected), "{why}");
    }
}

/// The frame that a line sends.
fn typed(text: &str, device: &crate::VirtualDevice) -> Result<String, String> {
    let tokens = super::tokens::Tokens::new(1, text);
    match super::line::line(tokens, &mut None).expect(text).1 {
        Action::Deed(Deed::Send { frame, .. }) => Ok(frame.of(device)?.to_string()),
        other => panic!("{text}: {other:?}"),
    }
}

#[test]
fn a_draw_is_read_with_both_ends_of_its_ranges() {
    check(
        "random shaft rpm -3000..3000\nrandom fault\nrandom power cut\nrandom power cut 1ms..2s\n\
         random wait 0..20ms\nrandom after 1ms..5ms power off\nrandom 1000 times fault | sync | read 1018h\n\
         random 601#40xxxx00xxxxxxxx # any object\nrandom sdo write 1017h = 5..50\nrandom use 1 | use 2\n\
         random set 6000h:01 = \"1|2..3\"",
        "11 lines",
    );
    for (line, problem) in [
        (
            "random",
            "1:7: the line to draw is missing; write `random shaft",
        ),
        ("random fault |", "1:15: the line to draw is missing"),
        ("random fault | | sync", "1:16: the line to draw is missing"),
        (
            "random fault | random fault",
            "1:16: a draw inside a draw; remove this `random`",
        ),
        (
            "random 0 times fault",
            "1:8: `0` is not valid; write a number from 1 to 10000",
        ),
        ("random 5 fault", "1:8: `5` is not a verb or a frame"),
        (
            "random expect 701#00",
            "1:8: `random` draws only what happens on the bench",
        ),
        ("random device gxmm", "1:8: `random` draws only what"),
        (
            "random wait 5ms..1ms",
            "1:8: `5ms..1ms` begins above its end; write",
        ),
        (
            "random wait 1..5",
            "1:8: `1` is not a duration; write 500ms",
        ),
        (
            "random fault | switch node 90..100",
            "1:16: `100` is not valid; write a number from 0 to 99",
        ),
        (
            "random shaft rpm 1..3000000",
            "1:8: the value is too large for a shaft",
        ),
        (
            "after 1ms random fault",
            "1:11: `random` begins the line; write the time after it",
        ),
    ] {
        check(line, problem);
    }
}
