//! Values and errors of a device that the outside sets.

use od_model::Refused;
use std::prelude::v1::*;
use std::string::ToString;

use od_runtime::NodeId;

use crate::device::VirtualDevice;
use crate::device::loaded::EdsOptions;
use crate::script::{Bare, Host, Origin, Reason, Script, run};

/// An input module: a read-only value with limits that TPDO1 sends when it changes.
const EDS: &str = "\
[DeviceInfo]\nProductName=Inputs\n\
[1000]\nParameterName=Device type\nDataType=7\nAccessType=const\nDefaultValue=0x191\n\
[1001]\nParameterName=Error register\nDataType=5\nAccessType=ro\n\
[1014]\nParameterName=COB-ID EMCY\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+0x80\n\
[1017]\nParameterName=Producer heartbeat time\nDataType=6\nAccessType=rw\n\
[1800]\nParameterName=TPDO1\nObjectType=9\nSubNumber=3\n\
[1800sub0]\nParameterName=Highest\nDataType=5\nAccessType=const\nDefaultValue=2\n\
[1800sub1]\nParameterName=COB-ID\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+0x180\n\
[1800sub2]\nParameterName=Type\nDataType=5\nAccessType=rw\nDefaultValue=255\n\
[1A00]\nParameterName=Mapping\nObjectType=9\nSubNumber=2\n\
[1A00sub0]\nParameterName=Count\nDataType=5\nAccessType=rw\nDefaultValue=1\n\
[1A00sub1]\nParameterName=Entry\nDataType=7\nAccessType=rw\nDefaultValue=0x60000108\n\
[2000]\nParameterName=Temperature\nDataType=0x08\nAccessType=ro\n\
[2001]\nParameterName=Name\nDataType=9\nAccessType=ro\nDefaultValue=start\n\
[6000]\nParameterName=Read input\nObjectType=8\nSubNumber=2\n\
[6000sub0]\nParameterName=Highest\nDataType=5\nAccessType=const\nDefaultValue=1\n\
[6000sub1]\nParameterName=Input 1\nDataType=5\nAccessType=ro\nLowLimit=1\nHighLimit=9\nDefaultValue=1\n\
PDOMapping=1\n";

/// Its frames, for the device of [`EDS`] or a built-in one.
struct Inputs(Vec<String>);

impl Host for Inputs {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        if name.is_some_and(|name| name != "inputs") {
            return Bare(od_devices::DEVICES).device(name, node_id);
        }
        let options = EdsOptions {
            node_id,
            lenient: true,
        };
        VirtualDevice::from_eds(EDS, options).map_err(|_| "it does not load".into())
    }

    fn frame(&mut self, _: od_runtime::Instant, _: Origin, frame: &od_runtime::Frame) {
        self.0.push(frame.to_string());
    }
}

/// Runs lines, and returns their frames.
#[track_caller]
fn frames(lines: &str) -> Vec<String> {
    let script = Script::parse(lines).expect("lines");
    let mut host = Inputs(Vec::new());
    run(&script, &mut host).unwrap_or_else(|stop| panic!("{stop}"));
    host.0
}

/// The reason why the last line cannot be carried out.
#[track_caller]
fn refused(lines: &str) -> String {
    let script = Script::parse(lines).expect("lines");
    match run(&script, &mut Inputs(Vec::new())) {
        Err(stop) => match stop.reason {
            Reason::Impossible(why) => why,
            other => panic!("{other:?}"),
        },
        Ok(_) => panic!("`{lines}` is carried out"),
    }
}

#[test]
fn a_value_of_the_device_changes_and_its_tpdo_follows() {
    let lines = "device inputs node 5\nnmt start\nset 6000h:01 = 7\nset 6000h:01 = 7\nset \"Input 1\" = 9\n\
                 set 2000h = -1.5\nset 2001h = \"end\"\nset 1017h = 100\nwait 250ms\npower off\npower on";
    let sent = [
        "705#00", "000#0105", "185#01", "185#07", "185#09", "705#05", "705#05", "705#00",
    ];
    assert_eq!(frames(lines), sent);
    frames(
        "device inputs\nset 2000h = -1.5\nexpect value 2000h = -1.5\nset 2001h = \"end\"\nexpect value 2001h = \"end\"",
    );
    for (line, why) in [
        (
            "set 6000h:01 = 300",
            "6000h:01 Read input.Input 1: UNSIGNED8 goes from 0 to 255",
        ),
        (
            "set 6000h:01 = 10",
            "cannot be 10 (Ah): value above the upper limit, which is 9",
        ),
        (
            "set 6000h:01 = 0",
            "cannot be 0: value below the lower limit, which is 1",
        ),
        ("set 6000h:01 = fast", "`fast` is not a number"),
        ("set 6000h:01 = [01 02]", "UNSIGNED8 has 8 bits, not 16"),
        ("set 6000h:02 = 1", "sub-index 6000h:02 does not exist"),
        ("set 1000h = 1", "1000h Device type is `const`"),
        ("set 1001h = 1", "write `emcy 1000h`"),
        (
            "power off\nset 6000h:01 = 7",
            "the device has no power; write `power on`",
        ),
        (
            "device gxmm\nset 6004h = 5",
            "6004h Position value is computed by the device",
        ),
        ("device gxmm\nset 6503h = 5", "is computed by the device"),
        (
            "device eam_mt\nset 6030h:01 = 5",
            "is computed by the device",
        ),
        ("device en580c\nset 6508h = 5", "is computed by the device"),
        ("device gxmm\nset 1010h:01 = 5", "write `sdo write …`"),
    ] {
        let shown = refused(&std::format!("device inputs\n{line}"));
        assert!(shown.contains(why), "{line}: {shown}");
    }
    // A value that a master may write has the same effects, here a preset.
    frames(
        "device gxmm\nset 6003h = 77\nexpect value 6004h = 77\nset 1017h = 100\nexpect 701#7F after 100ms",
    );
}

#[test]
fn a_device_reports_errors() {
    let lines = "device inputs node 5\nemcy 4200h\nemcy 8130h register 81h info 01 AB\nemcy 4200h off\n\
                 emcy 5000h\nemcy 0000h\nexpect value 1001h = 0\nnmt stop\nemcy 1000h\nexpect value 1001h = 1";
    let sent = [
        "705#00",
        "085#0042090000000000",
        "085#30818901AB000000",
        "085#0000810000000000",
        "085#0050810000000000",
        "085#0000010000000000",
        "085#0000000000000000",
        "000#0205",
    ];
    assert_eq!(frames(lines), sent);
    // A start ends the errors; the family has default bytes of its own.
    frames(
        "device gxmm\nfault battery-low on\nskip\nemcy 4200h\nexpect 081#00 42 89 00 00 10 00 00\nnmt reset\nskip\nemcy 4200h\nexpect emcy 4200h",
    );
    for (line, why) in [
        (
            "emcy 4200h\nemcy 4200h",
            "error 4200h is active; write `emcy 4200h off` to end it",
        ),
        (
            "emcy 4200h off",
            "error 4200h of an `emcy` line is not active",
        ),
        ("emcy 0000h", "no error of an `emcy` line is active"),
        ("power off\nemcy 4200h", "the device has no power"),
    ] {
        let shown = refused(&std::format!("device inputs\n{line}"));
        assert!(shown.contains(why), "{line}: {shown}");
    }
}
