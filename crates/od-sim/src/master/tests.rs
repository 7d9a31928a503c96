//! The master against devices of the bench, by the lines that a script has.

use std::format;
use std::string::ToString;

use super::plan::{Download, concise, from_concise};
use crate::script::{Bare, Script, run};
use od_model::Address;

/// Runs a script on the built-in devices; returns the frames of both sides, or why it stopped.
fn play(text: &str) -> Result<String, String> {
    struct Seen(Bare, String);
    impl crate::script::Host for Seen {
        fn device(
            &mut self,
            name: Option<&str>,
            node_id: Option<od_wire::NodeId>,
        ) -> Result<crate::VirtualDevice, od_model::Refused> {
            self.0.device(name, node_id)
        }

        fn frame(&mut self, _: od_wire::Instant, _: crate::script::Origin, frame: &od_wire::Frame) {
            self.1 += &format!("{frame}\n");
        }
    }
    let script = Script::parse(text).map_err(|all| all[0].to_string())?;
    let mut seen = Seen(Bare(od_devices::DEVICES), String::new());
    run(&script, &mut seen).map_err(|stop| stop.to_string())?;
    Ok(seen.1)
}

const LISTED: &str = "device gxmm node 5\nignore 705#*\nignore 585#*\nmaster slave 5\n";

fn listed(rest: &str) -> String {
    format!("{LISTED}{rest}")
}

#[test]
fn a_slave_that_follows_is_started_on_an_ideal_line_and_on_a_real_one() {
    for line in ["", "line real\n"] {
        let text = listed(
            "master expect 5 1000h = 0x00020196\nmaster expect 5 1018h:02 = 10\n\
             master write 5 1017h = 100\nmaster write 5 1800h:05 = 0\nmaster heartbeat 5 250ms\nmaster sync 50ms\n\
             expect master 5 waiting\nmaster boot\nexpect master 5 booting\nwait 3s\n\
             expect master 5 started\nexpect state operational\nexpect value 1017h = 100",
        );
        let frames = play(&format!("{line}{text}")).expect(line);
        // CiA 302-2: reset communication, device type, identity, configuration, start.
        let own: std::vec::Vec<&str> = (frames.lines())
            .filter(|frame| ["000#", "605#"].iter().any(|id| frame.starts_with(id)))
            .collect();
        assert_eq!(
            own,
            [
                "000#8205",
                "605#4000100000000000",
                "605#4018100200000000",
                "605#2B17100064000000",
                "605#2B00180500000000",
                "000#0105",
            ]
        );
        assert!(frames.matches("080#\n").count() > 50, "{frames}");
    }
}

#[test]
fn each_reason_to_stop_has_its_status_and_its_words() {
    for (lines, status, why) in [
        ("master expect 5 1000h = 0x00030191", "C", "00030191h"),
        ("master expect 5 1018h:01 = 1", "D", "00000001h"),
        ("master expect 5 1018h:02 = 11", "M", "0000000Bh"),
        ("master expect 5 1018h:03 = 99", "N", "00000063h"),
        ("master expect 5 1018h:04 = 4711", "O", "00001267h"),
        (
            "master write 5 2FFFh = 1 as u8",
            "J",
            "2FFFh: SDO abort 06020000h",
        ),
        ("master heartbeat 5 250ms", "K", "250 ms"),
        ("power off", "B", "no response"),
    ] {
        let text = listed(&format!(
            "{lines}\nmaster boot\nwait 4s\nexpect master 5 failed {status}"
        ));
        play(&text).expect(lines);
        // The words of the present state name the status, and the master the values that differ.
        let text = listed(&format!(
            "{lines}\nmaster boot\nwait 4s\nexpect master 5 started"
        ));
        let stop = play(&text).expect_err(lines);
        assert!(stop.contains(&format!("error status {status}")), "{stop}");
        let mut bench = crate::script::Bench::default();
        let script =
            Script::parse(&listed(&format!("{lines}\nmaster boot\nwait 4s"))).expect(lines);
        crate::script::run_on(&script, &mut bench, &mut Bare(od_devices::DEVICES)).expect(lines);
        let master = bench.bus.master().expect("it was used");
        assert!(
            master.boots()[0].reason.contains(why),
            "{}",
            master.boots()[0].reason
        );
        assert_ne!(
            bench.bus.devices()[0].state(),
            od_wire::nmt::State::Operational
        );
    }
    play("device gxmm node 5\nmaster boot 5\nexpect master 5 failed A").expect("not listed");
    let stop = play("device gxmm node 5\nmaster boot").expect_err("an empty list");
    assert!(stop.contains("master slave 5"), "{stop}");
}

#[test]
fn a_slave_that_is_lost_is_booted_again_when_it_reports() {
    let text = listed(
        "master write 5 1017h = 100\nmaster heartbeat 5 250ms\nmaster boot\nwait 3s\n\
         power off\nwait 100ms\nexpect master 5 started\nwait 300ms\nexpect master 5 lost\n\
         power on\nwait 3s\nexpect master 5 started\nexpect value 1017h = 100\nexpect state operational",
    );
    play(&text).expect("lost and found");
    // Alone on a real line, the master's own SYNC gets no acknowledgement.
    play(&format!("line real\n{text}").replace("master boot\n", "master sync 20ms\nmaster boot\n"))
        .expect("lost and found on a real line");
    // One that comes late is in the list, so its boot-up message starts the process.
    let text = "device gxmm node 5\ndevice gxmm node 6 off\nmaster slave 5\nmaster slave 6\nmaster boot 5\nwait 3s\n\
                expect master 6 waiting\nuse 2\npower on\nwait 3s\nexpect master 6 started";
    play(text).expect("late");
}

#[test]
fn a_concise_dcf_is_read_and_written() {
    let text = listed(
        "master dcf 5 [01 00 00 00 17 10 00 02 00 00 00 64 00]\nmaster boot\nwait 3s\nexpect value 1017h = 100",
    );
    play(&text).expect("a concise DCF");
    let downloads = [
        Download {
            address: Address::new(0x1017, 0),
            bytes: [100, 0].into(),
        },
        Download {
            address: Address::new(0x1018, 4),
            bytes: [].into(),
        },
    ];
    let bytes = concise(&downloads);
    assert_eq!(bytes[..11], [2, 0, 0, 0, 0x17, 0x10, 0, 2, 0, 0, 0]);
    assert_eq!(from_concise(&bytes).as_deref(), Ok(&downloads[..]));
    for end in 0..bytes.len() {
        from_concise(&bytes[..end]).expect_err("a part of it");
    }
    for (wrong, why) in [
        ([&bytes[..], &[0]].concat(), "1 byte follows"),
        ([0xFF; 11].to_vec(), "limit"),
        (
            [&[1, 0, 0, 0, 0, 0x10, 0][..], &[0xFF; 8]].concat(),
            "entry 1",
        ),
    ] {
        let said = from_concise(&wrong).expect_err(why);
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn a_list_is_the_lines_that_make_it() {
    let lines = [
        "slave 5",
        "expect 5 1000h = 0x20196",
        "expect 5 1018h:04 = 0x1",
        "write 5 1017h = 0x64 as u16",
        "write 5 1800h:02 = 0x1 as u8",
        "heartbeat 5 250ms",
        "slave 6",
        "dcf 6 [01 00 00 00 00 20 01 03 00 00 00 61 62 63]",
        "boot-time 5s",
        "sync 20ms",
    ];
    let text: std::string::String = lines
        .iter()
        .map(|line| format!("master {line}\n"))
        .collect();
    let mut bench = crate::script::Bench::default();
    let script = Script::parse(&text).expect("a list");
    crate::script::run_on(&script, &mut bench, &mut Bare(od_devices::DEVICES)).expect("a list");
    assert_eq!(bench.bus.master().expect("a list").plan().lines(), lines);
    let script = Script::parse("master clear 6\nmaster clear 5").expect("lines");
    crate::script::run_on(&script, &mut bench, &mut Bare(od_devices::DEVICES)).expect("lines");
    let left = bench.bus.master().expect("a list").plan().lines();
    assert_eq!(left, ["boot-time 5s", "sync 20ms"]);
}

#[test]
fn lines_of_a_master_say_what_to_write_instead() {
    for (line, why) in [
        ("master", "cannot"),
        ("master fly", "master slave 5"),
        ("master slave 0", "1 to 127"),
        ("master slave 128", "1 to 127"),
        ("master expect 5 6004h = 1", "1018h:04"),
        ("master expect 5 1018h:05 = 1", "1018h:04"),
        ("master expect 5 1000h", "1018h:04"),
        ("master sync 10us", "1ms"),
        ("master heartbeat 5 66s", "65.535s"),
        ("master dcf 5 17 10", "bytes"),
        ("master dcf 5 [01 00 00 00 17]", "entry 1"),
        ("expect master 5 happy", "started"),
        ("expect master 5 failed Z", "A, B"),
    ] {
        let said = play(line).expect_err(line);
        assert!(said.contains(why), "{line}: {said}");
    }
    let said = play("device gxmm node 5\nmaster write 9 1017h = 5").expect_err("no type");
    assert!(said.contains("as u16"), "{said}");
}
