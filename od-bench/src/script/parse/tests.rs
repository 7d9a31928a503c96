use super::*;

#[track_caller]
fn check(text: &str, expected: &str) {
    let shown = match parse(text, 1) {
        Ok(script) => format!("{} lines", script.statements.len()),
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
         skip\nexpect 581#43 05 05 5 times every 5ms\nexpect 581#* every 5ms 43 times\nexpect abort 06090031h\n\
         expect silence 1s\nexpect state off\nexpect value 6004h = 5\nexpect led red flashing",
        "32 lines",
    );
}

#[test]
fn several_on_a_bus() {
    check(
        "device eam_red node 1 2 as red\nuse red.2\ndevice gxmm node 3 on red\nbus bitrate 250\n\
         bus bitrate any\nfault temperature on\nexpect bitrate 50\nbus off\nbus active\nbus overrun\n\
         shaft ramp -6000 over 1.5s",
        "11 lines",
    );
    check("device eam_red node as red", "1:21: `as` does not fit");
    check("device gxmm on", "1:15: a name is missing");
    check("bus bitrate 2000", "1:13: `2000` does not fit");
    check("shaft ramp 60", "1:14: `over` is missing");
    check("shaft ramp 60 over 5000s", "1:20: a ramp is too long");
    check("bus stop", "1:5: a bus cannot `stop`");
}

#[test]
fn mistakes_are_found_in_every_line() {
    check("wait", "1:5: a duration is missing; write it like 500ms");
    check("\n  wait 5", "2:8: `5` is no duration");
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
                &format!("1:{column}: `{number}` does not fit; write a number from 1 to 1000000"),
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
    check("device", "1:7: a device name is missing");
    check(
        "device gxmm node 128",
        "1:18: `128` does not fit; write a number from 1 to 127",
    );
    check(
        "device gxmm up 5",
        "1:8: a name with blanks stands in quotes",
    );
    check(
        "fault fire on",
        "1:7: there is no fault `fire`; there are position-error",
    );
    check("nmt explode", "1:5: there is no NMT command `explode`");
    check("expect 581", "1:8: `581` has no `#`");
    check("expect 581#40 0 times", "1:15: `0` does not fit");
    check("expect state flying", "1:8: there is no state `flying`");
    check("sdo write 6004h", "1:5: this is no SDO line");
    check("sdo read 6004h aborts 1", "1:23: `1` is no abort code");
    check("(1.2.3) 601#", "1:1: `(1.2.3)` is no time stamp");
    check("power on now", "1:10: `now` is too much here");
    check("after 5ms wait 5ms", "1:11: a time and a wait");
}

#[test]
fn long_lines_are_cut_where_they_are_quoted() {
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
        for problem in parse(&line.replace("{}", &long), 1).expect_err(line) {
            let length = problem.to_string().chars().count();
            assert!(length < 600, "{line}: {length} characters");
        }
    }
    let problem = &parse(&"x".repeat(61), 1).expect_err("no statement")[0];
    let message = format!("`{}…` begins no statement", "x".repeat(60));
    assert_eq!(problem.message, message);
}

#[test]
fn no_text_panics() {
    let pieces = [
        "expect", "581#", "..", "*", "5", "times", "every", "5ms", "sdo", "read", "=", "as",
        "aborts", "at", "(0.1)", "can0", "[8]", "\"", "#", "device", "node", "ä", "wait", " ",
        "\n", "send",
    ];
    let mut state = 7u32;
    for _ in 0..20_000 {
        let mut text = String::new();
        for _ in 0..state % 12 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            text.push_str(pieces[(state >> 16) as usize % pieces.len()]);
            text.push_str(if state & 0x100 == 0 { " " } else { "" });
        }
        state = state.wrapping_add(1);
        let _ = parse(&text, 1);
    }
}
