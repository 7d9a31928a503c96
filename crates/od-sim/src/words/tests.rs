use std::string::ToString;

use od_runtime::NodeId;

use super::*;
use crate::bus::Bus;
use crate::device::loaded::EdsOptions;
use crate::logs::candump::parse_frame;

const STRINGS: &str = include_str!("../../../../tests/interop/strings.eds");

#[track_caller]
fn explained(device: VirtualDevice, frames: &[(&str, &str)]) {
    let mut bus = Bus::new();
    bus.add(device);
    bus.set_power(0, true);
    let mut decoder = Decoder::default();
    for (text, expected) in frames {
        let frame = parse_frame(text).expect(text);
        let words = decoder.explain(bus.devices(), &frame);
        assert_eq!(words.to_string(), *expected, "{text}");
        bus.receive(&frame);
    }
}

#[test]
fn frames_are_described_in_words() {
    let kind = od_devices::find("gxmm").expect("a built-in device");
    explained(
        VirtualDevice::new(kind, NodeId::ONE),
        &[
            ("701#00", "NMT EC node 1: boot-up"),
            (
                "601#4004600000000000",
                "SDO node 1: read 6004h Position value",
            ),
            (
                "581#4304600092950700",
                "SDO node 1: 6004h Position value is 497042 (79592h)",
            ),
            (
                "601#2200600005AABBCC",
                "SDO node 1: write 6000h Operating parameters = 43525 (AA05h): \
                 code sequence counter-clockwise, scaling enabled",
            ),
            (
                "581#6000600000000000",
                "SDO node 1: write of 6000h Operating parameters confirmed",
            ),
            (
                "601#2310100173617665",
                "SDO node 1: write 1010h:01 Store parameters.Save all parameters = \"save\"",
            ),
            (
                "581#8000200000000206",
                "SDO node 1: 2000h:00 aborted: 06020000h object does not exist",
            ),
            (
                "581#8000200099000906",
                "SDO node 1: 2000h:00 aborted: 06090099h value or sub-index is refused \
                 (CiA 301 does not define the code)",
            ),
            (
                "581#80002000BFFF000F",
                "SDO node 1: 2000h:00 aborted: 0F00FFBFh code of a device profile or of the \
                 manufacturer (CiA 301 does not define it)",
            ),
            (
                "581#4308100047584D4D",
                "SDO node 1: 1008h Manufacturer device name is \"GXMM\"",
            ),
            ("000#0101", "NMT node 1: start"),
            ("000#8100", "NMT: reset node, all nodes"),
            ("080#", "SYNC: triggers synchronous PDOs"),
            (
                "181#92950700",
                "PDO node 1: TPDO1 Position value = 497042 (79592h)",
            ),
            ("281#R", "PDO node 1: TPDO2 requested (RTR)"),
            ("701#7F", "NMT EC node 1: Pre-operational"),
            ("701#R", "NMT EC node 1: node guarding request"),
            (
                "081#00FF810000100000",
                "EMCY node 1: FF00h battery low, error register 81h, 00 00 10 00 00",
            ),
            // No device with this node ID is known, so only the standard speaks.
            (
                "082#00FF810000100000",
                "EMCY node 2: FF00h device-specific, error register 81h, 00 00 10 00 00",
            ),
            (
                "082#2073010000000000",
                "EMCY node 2: 7320h additional modules, error register 01h, 00 00 00 00 00",
            ),
            (
                "082#1023010000000000",
                "EMCY node 2: 2310h current, device output side, error register 01h, 00 00 00 00 00",
            ),
            (
                "7E5#0401",
                "LSS: switch state global: 2 bytes, but an LSS message has 8 (CiA 305)",
            ),
            ("7E5#1105000000000000", "LSS: configure node ID 5"),
            ("7E4#5AEC000000000000", "LSS: inquire vendor-ID: ECh"),
            ("385#0102", "PDO node 5: TPDO3 2 bytes"),
            ("1FFFFFFF#", "?: no service uses this CAN-ID"),
            ("000#77", "NMT: command not defined in CiA 301"),
            ("601#40", "SDO node 1: 1 byte, but an SDO message has 8"),
            (
                "601#40001000",
                "SDO node 1: read 1000h Device type: 4 bytes, but an SDO message has 8",
            ),
            (
                "581#430010",
                "SDO node 1: 3 bytes, but an SDO message has 8",
            ),
        ],
    );
}

#[test]
fn transfers_are_followed_to_their_end() {
    let device = VirtualDevice::from_eds(STRINGS, EdsOptions::default());
    explained(
        device.expect("a device"),
        &[
            (
                "607#4001200000000000",
                "SDO node 7: read 2001h Writable text",
            ),
            (
                "587#4101200009000000",
                "SDO node 7: 2001h Writable text has 9 bytes",
            ),
            (
                "607#6000000000000000",
                "SDO node 7: next segment of 2001h Writable text",
            ),
            (
                "587#0061626364656667",
                "SDO node 7: segment of 2001h Writable text, 7 bytes",
            ),
            (
                "607#7000000000000000",
                "SDO node 7: next segment of 2001h Writable text",
            ),
            (
                "587#1B68690000000000",
                "SDO node 7: last segment of 2001h Writable text: \"abcdefghi\"",
            ),
            (
                "607#C602200008000000",
                "SDO node 7: write 2002h Domain in blocks, 8 bytes",
            ),
            (
                "587#A40220007F000000",
                "SDO node 7: write of 2002h Domain accepted in blocks of 127",
            ),
            (
                "607#0101020304050607",
                "SDO node 7: segment 1 of a block of 2002h Domain",
            ),
            (
                "607#8208000000000000",
                "SDO node 7: last segment 2 of a block of 2002h Domain",
            ),
            (
                "587#A2027F0000000000",
                "SDO node 7: block of 2002h Domain confirmed up to segment 2",
            ),
            (
                "607#D9B4120000000000",
                "SDO node 7: 2002h Domain is complete, CRC 12B4h",
            ),
            (
                "587#A100000000000000",
                "SDO node 7: write of 2002h Domain confirmed",
            ),
            ("207#0500", "PDO node 7: RPDO1 Integer16 = 5"),
        ],
    );
}

#[test]
fn an_emergency_is_explained_by_the_profile_of_its_device() {
    let drive = STRINGS.replacen("DefaultValue=0x0\n", "DefaultValue=0x00020192\n", 1);
    let device = VirtualDevice::from_eds(&drive, EdsOptions::default());
    explained(
        device.expect("a device"),
        &[
            (
                "087#1023010000000000",
                "EMCY node 7: 2310h continuous over-current, device output side, error register 01h, 00 00 00 00 00",
            ),
            (
                "087#00FF010000000000",
                "EMCY node 7: FF00h device-specific, error register 01h, 00 00 00 00 00",
            ),
        ],
    );
}

#[test]
fn a_mapped_value_has_the_meaning_of_its_profile() {
    let kind = od_devices::find("drive").expect("a built-in device");
    let device = VirtualDevice::new(kind, NodeId::ONE);
    explained(
        device,
        &[
            (
                "201#0F0001",
                "PDO node 1: RPDO1 Controlword = 15 (Fh): enable operation, \
                 Modes of operation = 1: profile position",
            ),
            (
                "181#370206",
                "PDO node 1: TPDO1 Statusword = 567 (237h): Operation enabled, \
                 Modes of operation display = 6: homing",
            ),
        ],
    );
}
