//! Objects by address, name and glob, with a dictionary and without.

use od_model::values;
use od_tools::bench::OnBench;
use od_tools::master::Master;
use od_tools::objects::{encode, probe, select};

use crate::{bus, id};

#[test]
fn without_a_dictionary_a_glob_finds_the_same_objects() {
    let mut bus = bus(&[("gxmm", 5)]);
    let mut master = Master::new(OnBench(&mut bus), id(5));
    let dictionary = od_devices::find("gxmm").expect("a device").dictionary;
    for glob in ["60*", "1018:*", "0x10??", "1a00h:?1", "180?:*"] {
        let known = select(dictionary, glob).expect(glob);
        let known = known.iter().map(|one| one.address);
        // 1003h has as many sub-objects as there are errors.
        let known = known.filter(|address| address.index != 0x1003 || address.sub == 0);
        let known: Vec<_> = known.collect();
        let probed = probe(&mut master, glob).expect(glob);
        // Without a dictionary odkit does not know which objects cannot be read.
        let probed: Vec<_> = probed.iter().map(|one| one.address).collect();
        let readable = probed.iter().filter(|address| {
            let entry = dictionary.find(**address).expect("an entry");
            entry.access.readable()
        });
        assert_eq!(readable.copied().collect::<Vec<_>>(), known, "{glob}");
    }
    assert!(probe(&mut master, "5*").is_err());
    assert!(probe(&mut master, "*position*").is_err());
    assert!(probe(&mut master, "position").is_err());
}

#[test]
fn an_index_selects_all_values_of_a_record() {
    let dictionary = od_devices::find("gxmm").expect("a device").dictionary;
    let count = |text| select(dictionary, text).map(|found| found.len());
    assert_eq!(count("1018h"), Ok(5));
    assert_eq!(count("1018h:01"), Ok(1));
    assert_eq!(count("6004"), Ok(1));
    assert_eq!(count("position VALUE"), Ok(1));
    assert!(count("*position*").is_ok_and(|count| count > 1));
    assert_eq!(
        count("7999h"),
        Ok(1),
        "an EDS may lack objects of the device"
    );
    assert!(count("7*9").is_err());
    assert!(count("no such name").is_err());
}

#[test]
fn values_are_checked_before_they_are_sent() {
    let dictionary = od_devices::find("gxmm").expect("a device").dictionary;
    let check = |object, text| {
        let entry = values::find(dictionary, object).expect(object);
        encode(&entry, 5, text)
    };
    assert_eq!(check("6001h", "4096").as_deref(), Ok(&[0, 0x10, 0, 0][..]));
    for (object, text) in [
        ("6001h", "8193"),
        ("6001h", "0"),
        ("6001h", "x"),
        ("6001h", "[01]"),
        ("6004h", "1"),
        ("1017h", "65536"),
    ] {
        assert!(check(object, text).is_err(), "{object}={text}");
    }
}
