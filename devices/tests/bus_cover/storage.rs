//! Save, restore and power cycles of a gxmm (manual 000, objects 1010h and 1011h,
//! chapter 7.2.1).

use od_devices::find;
use odkit::Frame;
use odkit::encoder::{Fault, Switches};

use crate::bench::Bench;

const SAVE: u32 = u32::from_le_bytes(*b"save");
const LOAD: u32 = u32::from_le_bytes(*b"load");

#[test]
fn saved_values_are_loaded_after_a_power_cycle() {
    let mut bench = Bench::new("gxmm");
    bench.set_raw(0x7_9592);
    bench.write(0x6003, 0, 1000).unwrap();
    bench.write(0x6200, 0, 7).unwrap();
    bench.write(0x2300, 3, 0xBEEF).unwrap();
    bench.write(0x1017, 0, 100).unwrap();
    bench.power_cycle();
    assert_eq!(bench.read(0x6004, 0), 0x7_9592, "nothing was saved");
    bench.write(0x6003, 0, 1000).unwrap();
    bench.write(0x6200, 0, 7).unwrap();
    bench.write(0x2300, 3, 0xBEEF).unwrap();
    assert_eq!(bench.write(0x1010, 1, LOAD), Err(0x0800_0020));
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.power_cycle();
    assert_eq!(bench.read(0x6004, 0), 1000);
    assert_eq!((bench.read(0x6200, 0), bench.read(0x1800, 5)), (7, 7));
    assert_eq!(bench.read(0x2300, 3), 0xBEEF);
    bench.write(0x1011, 1, LOAD).unwrap();
    assert_eq!(bench.read(0x6004, 0), 0x7_9592, "at once");
    bench.power_cycle();
    assert_eq!(bench.read(0x6004, 0), 0x7_9592, "and after a power cycle");
}

#[test]
fn the_node_id_takes_effect_at_the_next_start() {
    let mut bench = Bench::new("gxmm");
    assert_eq!(bench.booted, 1);
    bench.write(0x2101, 0, 2).unwrap();
    bench.write(0x1010, 4, SAVE).unwrap();
    assert_eq!(bench.read(0x2101, 0), 2, "still answers as node 1");
    bench.power_cycle();
    assert_eq!(bench.booted, 2);
    assert_eq!(bench.read(0x1800, 1), 0x182, "the default follows");
    bench.write(0x1800, 1, 0x181).unwrap();
    bench.write(0x1010, 2, SAVE).unwrap();
    bench.node.application.set_switches(Switches {
        node_id: 42,
        bit_rate: 4,
    });
    bench.power_cycle();
    assert_eq!(
        (bench.booted, bench.node.application.bit_rate()),
        (42, Some(250))
    );
    assert_eq!((bench.read(0x2101, 0), bench.read(0x1801, 1)), (2, 0x2AA));
    assert_eq!(bench.read(0x1800, 1), 0x181, "a value of the user's stays");
}

#[test]
fn statistics_survive_a_restore() {
    let mut bench = Bench::new("gxmm");
    for broken in [true, false] {
        bench.node.application.set_fault(Fault::Position, broken);
        bench.node.handle_change(bench.now);
        let emcy = bench.sent();
        let expected: [u8; 8] = if broken {
            [0x20, 0x73, 0x81, 1, 0, 0, 0, 0]
        } else {
            [0; 8]
        };
        assert_eq!(emcy, [Frame::standard(0x81, &expected)]);
    }
    bench.write(0x1011, 1, LOAD).unwrap();
    assert_eq!(bench.read(0x2201, 1), 1);
    assert_eq!(bench.read(0x1003, 1), 0x7320);
    bench.write(0x1010, 2, SAVE).unwrap();
    bench.node.application = crate::bench::encoder(find("gxmm").unwrap());
    bench.power_cycle();
    assert_eq!(bench.read(0x2201, 1), 1, "from the EEPROM");
}

#[test]
fn an_interrupted_save_leaves_the_set_before() {
    let mut bench = Bench::new("gxmm");
    bench.write(0x6001, 0, 1000).unwrap();
    bench.write(0x6002, 0, 5000).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    for cut in 0.. {
        bench.write(0x6001, 0, 2000).unwrap();
        bench.write(0x6002, 0, 7000).unwrap();
        bench.node.storage.cut_after(cut);
        let saved = bench.write(0x1010, 1, SAVE);
        bench.power_cycle();
        let values = (bench.read(0x6001, 0), bench.read(0x6002, 0));
        if saved.is_ok() {
            assert_eq!(values, (2000, 7000));
            break;
        }
        assert_eq!(saved, Err(0x0800_0021));
        assert_eq!(values, (1000, 5000), "cut at {cut}");
    }
}

/// Chapter 4.3.5: 5530h, EEPROM error. The node uses the factory values, and the error lasts until a
/// save or a restore writes a valid set.
#[test]
fn a_damaged_eeprom_is_an_error() {
    let mut bench = Bench::new("gxmm");
    bench.write(0x2300, 1, 7).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    bench.write(0x1010, 1, SAVE).unwrap();
    for byte in bench.node.storage.bytes_mut().iter_mut().skip(16) {
        *byte = byte.wrapping_add(1);
    }
    for _ in 0..2 {
        bench.power_cycle();
        assert_eq!(bench.read(0x2300, 1), 0, "the factory value");
        assert_eq!(bench.read(0x1001, 0), 1);
        assert_eq!(bench.read(0x1003, 1), 0x5530);
    }
    bench.write(0x1010, 1, SAVE).unwrap();
    assert_eq!(bench.read(0x1001, 0), 0, "a save clears it");
    bench.power_cycle();
    assert_eq!((bench.read(0x1001, 0), bench.read(0x1003, 0)), (0, 0));
}
