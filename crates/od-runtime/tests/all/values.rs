//! Values of every type: their limits, their access in the store, and PDOs with many of them.

use crate::support::{Bench, Row, rows, unsigned};
use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Tables, Value};
use od_model::{Access, Address, DataType};
use od_runtime::storage::{NoStorage, Storage, StorageError};
use od_runtime::{AbortCode, Halt, NoApplication, NodeId, Store, StoreTooSmall, TextTooLong};

/// A number with limits at 2010h.
fn limited(data_type: DataType, low: Value, high: Value) -> Bench {
    let mut description = Description::default();
    for (index, data_type) in [(0x1000, DataType::Unsigned32), (0x2010, data_type)] {
        let mut entry = EntryDescription::new("Value", data_type);
        entry.access = Spanned::from(Access::Rw);
        if index == 0x2010 {
            entry.low = Some(Spanned::from(low.clone()));
            entry.high = Some(Spanned::from(high.clone()));
        }
        let object = ObjectDescription::var(entry);
        description.objects.insert(index, object);
    }
    let mut bench = Bench::of_tables(Tables::new(&description), NoApplication);
    bench.power_on();
    bench
}

/// Writes these bytes and returns the response: nothing, or the abort code in the byte order of the
/// bus.
fn write(bench: &mut Bench, bytes: &[u8]) -> String {
    let place = "102000";
    let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    let answer = if bytes.len() > 4 {
        bench.ask(&format!("601#21{place}{:02X}000000", bytes.len()));
        let segment: String = hex(&bytes[..7]);
        bench.ask(&format!("601#00{segment}"));
        let rest: String = hex(&bytes[7..]);
        let unused = 7 - (bytes.len() - 7);
        let command = 0x11 | unused << 1;
        bench.ask(&format!("601#{command:02X}{rest:0<14}"))
    } else {
        let command = 0x23 | (4 - bytes.len()) << 2;
        let data: String = hex(bytes);
        bench.ask(&format!("601#{command:02X}{place}{data:0<8}"))
    };
    match answer.strip_prefix("581#80") {
        Some(abort) => abort[6..].to_owned(),
        None => String::new(),
    }
}

const TOO_HIGH: &str = "31000906";
const TOO_LOW: &str = "32000906";
const NOT_ALLOWED: &str = "30000906";

#[test]
fn signed_numbers_of_each_length_have_their_limits() {
    use DataType::{Integer8, Integer16, Integer24, Integer32, Integer64};
    for (data_type, len) in [
        (Integer8, 1),
        (Integer16, 2),
        (Integer24, 3),
        (Integer32, 4),
    ] {
        let mut bench = limited(data_type, Value::Signed(-5), Value::Signed(7));
        for (value, answer) in [
            (-6i32, TOO_LOW),
            (-5, ""),
            (-1, ""),
            (0, ""),
            (7, ""),
            (8, TOO_HIGH),
            (127, TOO_HIGH),
            (-128, TOO_LOW),
        ] {
            let bytes = &value.to_le_bytes()[..len];
            assert_eq!(write(&mut bench, bytes), answer, "{data_type:?} {value}");
        }
    }
    let mut bench = limited(Integer64, Value::Signed(-5), Value::Signed(7));
    // Eight bytes need two segments.
    for (value, answer) in [(-6i64, TOO_LOW), (-5, ""), (7, ""), (8, TOO_HIGH)] {
        assert_eq!(write(&mut bench, &value.to_le_bytes()), answer, "{value}");
    }
}

#[test]
fn reals_of_both_lengths_have_their_limits() {
    let (low, high) = (Value::Real(-1.5), Value::Real(2.5));
    let mut single = limited(DataType::Real32, low.clone(), high.clone());
    let mut double = limited(DataType::Real64, low, high);
    for (value, answer) in [
        (-1.75f32, TOO_LOW),
        (-1.5, ""),
        (-0.0, ""),
        (1e-30, ""),
        (2.5, ""),
        (2.75, TOO_HIGH),
        (1e30, TOO_HIGH),
        (-1e30, TOO_LOW),
        (f32::INFINITY, TOO_HIGH),
        (f32::NEG_INFINITY, TOO_LOW),
        // NaN is not between the limits.
        (f32::NAN, NOT_ALLOWED),
        (-f32::NAN, NOT_ALLOWED),
    ] {
        assert_eq!(write(&mut single, &value.to_le_bytes()), answer, "{value}");
        let wide = f64::from(value).to_le_bytes();
        assert_eq!(write(&mut double, &wide), answer, "{value}");
    }
}

#[test]
fn reals_of_both_lengths_have_their_defaults() {
    use DataType::{Real32, Real64};
    let mut all = rows();
    for (index, data_type, access) in [
        (0x2010, Real32, Access::Rw),
        (0x2011, Real64, Access::Rw),
        (0x2012, Real32, Access::Const),
    ] {
        all.push((index, 0, data_type, access, false, Some(Value::Real(-1.5))));
    }
    let mut bench = Bench::with(all, NoApplication);
    bench.power_on();
    let single = u64::from((-1.5f32).to_bits());
    assert_eq!(bench.value(0x2010, 0), single);
    assert_eq!(bench.value(0x2011, 0), (-1.5f64).to_bits());
    assert_eq!(bench.value(0x2012, 0), single);
    assert_eq!(bench.ask("601#4012200000000000"), "581#431220000000C0BF");
}

#[test]
fn a_boolean_is_0_or_1() {
    let mut bench = Bench::new();
    bench.power_on();
    for (request, answer) in [
        ("601#2F06200001000000", "581#6006200000000000"),
        ("601#2F06200000000000", "581#6006200000000000"),
        ("601#2F06200002000000", "581#8006200030000906"),
        ("601#2F00100001000000", "581#8000100002000106"),
    ] {
        assert_eq!(bench.ask(request), answer);
    }
}

/// Numbers that no master can read, or that are not in the store.
fn odd() -> Vec<Row> {
    use Access::{Const, Wo};
    use DataType::{Integer8, Integer16, Unsigned8, Unsigned32, Unsigned64, VisibleString};
    let mut rows = rows();
    let text = Value::Text("ab".into());
    rows.extend([
        (0x2010, 0, Unsigned8, Const, false, unsigned(0x12)),
        (0x2011, 0, Integer8, Const, false, Some(Value::Signed(-1))),
        (0x2012, 0, Integer16, Const, false, Some(Value::Signed(-2))),
        (0x2013, 0, Unsigned32, Const, false, unsigned(0x1234_5678)),
        (0x2014, 0, Unsigned64, Const, false, unsigned(u64::MAX - 1)),
        (0x2015, 0, Unsigned32, Wo, false, unsigned(0x8765_4321)),
        (0x2016, 0, VisibleString, Const, false, Some(text.clone())),
        (0x2017, 0, VisibleString, Access::Rw, false, Some(text)),
    ]);
    rows
}

#[test]
fn every_number_can_be_read_from_the_store() {
    let mut bench = Bench::with(odd(), NoApplication);
    bench.power_on();
    for (index, value) in [
        (0x2010, 0x12),
        (0x2011, 0xFF),
        (0x2012, 0xFFFE),
        (0x2013, 0x1234_5678),
        (0x2014, u64::MAX - 1),
        (0x2015, 0x8765_4321),
        (0x2016, 0x6261),
        (0x2017, 0x6261),
        (0x2005, 0x0102_0304_0506_0708),
        (0x2001, 0xFFFE),
        (0x2018, 0),
    ] {
        assert_eq!(bench.value(index, 0), value, "{index:X}");
    }
}

#[test]
fn a_store_accepts_numbers_that_have_a_place_in_it() {
    let tables = crate::support::tables(odd());
    let dictionary = tables.dictionary();
    let mut values = vec![0; dictionary.store_len()];
    let mut store = Store::new(&dictionary, &mut values, NodeId::ONE).expect("it fits");
    store.reset(|_| true);
    for (index, is_taken) in [
        (0x2000, true),
        (0x2015, true),
        (0x2010, false),
        (0x2016, false),
        (0x2017, false),
        (0x2018, false),
    ] {
        let address = Address::new(index, 0);
        let before = store.unsigned(index, 0);
        assert_eq!(store.set_unsigned(address, 0x31), is_taken, "{index:X}");
        let now = if is_taken { 0x31 } else { before };
        assert_eq!(store.unsigned(index, 0), now, "{index:X}");
    }
}

#[test]
fn reasons_are_sentences() {
    let capacity = 9;
    assert_eq!(
        TextTooLong { capacity }.to_string(),
        "the text is longer than its object; the limit is 9 bytes"
    );
    assert_eq!(
        StoreTooSmall { needed: 9 }.to_string(),
        "the values of the dictionary need 9 bytes; lend a longer slice"
    );
    assert_eq!(
        Halt::from(AbortCode::UnsupportedAccess).to_string(),
        "the stream aborts the transfer: 06010000h object cannot be accessed like this"
    );
    use StorageError::{Device, Foreign, Full, NotWritten, OutOfRange, PowerCut};
    let all = [OutOfRange, Full, PowerCut, Device, NotWritten, Foreign];
    let mut texts = all.map(|error| error.to_string());
    assert_eq!(texts[0], "outside the storage");
    texts.sort();
    assert!(texts.windows(2).all(|two| two[0] != two[1]), "{texts:?}");
}

#[test]
fn a_device_without_storage_stores_nothing() {
    let mut none = NoStorage;
    assert_eq!(none.capacity(), 0);
    assert_eq!(none.read(0, &mut []), Ok(()));
    assert_eq!(none.read(0, &mut [0]), Err(StorageError::OutOfRange));
    assert_eq!(none.write(0, &[]), Ok(()));
    assert_eq!(none.write(0, &[0]), Err(StorageError::OutOfRange));
    assert_eq!(none.erase(0), Err(StorageError::Device));
}

/// PDO 1 of each direction with sixteen BOOLEANs and a byte: more entries than a node keeps.
fn many() -> Bench {
    use Access::{Const, Rw};
    use DataType::{Boolean, Unsigned8, Unsigned32};
    let mut rows = rows();
    rows.retain(|row| !matches!(row.0, 0x1600 | 0x1A00));
    for at in 0..16u8 {
        let index = 0x2020 + u16::from(at);
        let value = unsigned(u64::from(matches!(at, 0 | 3 | 9 | 15)));
        rows.push((index, 0, Boolean, Rw, true, value));
    }
    rows.push((0x2030, 0, Unsigned8, Rw, true, unsigned(0x5A)));
    for mapping in [0x1600, 0x1A00] {
        rows.push((mapping, 0, Unsigned8, Rw, false, unsigned(17)));
        for at in 0..17u8 {
            let bits = if at < 16 { 1 } else { 8 };
            let entry = (0x2020 + u64::from(at)) << 16 | bits;
            rows.push((mapping, at + 1, Unsigned32, Rw, false, unsigned(entry)));
        }
    }
    rows.retain(|row| row.3 != Const || row.0 < 0x2000);
    let mut bench = Bench::with(rows, NoApplication);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.power_on();
    bench
}

#[test]
fn a_pdo_maps_more_values_than_a_node_keeps() {
    let mut bench = many();
    bench.ask("601#2F00180201000000");
    bench.send("000#0101");
    assert_eq!(bench.send("080#"), ["181#09825A"]);
    assert_eq!(bench.send("201#F00F33"), [""; 0]);
    assert_eq!(bench.send("080#"), ["181#F00F33"]);
    for at in 0..16u16 {
        let expected = u64::from((4..12).contains(&at));
        assert_eq!(bench.value(0x2020 + at, 0), expected, "{at}");
    }
    assert_eq!(bench.value(0x2030, 0), 0x33);
}
