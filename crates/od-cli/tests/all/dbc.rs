//! `odkit convert --to dbc`. In tests/interop/test_dbc.py cantools reads the result.

use std::collections::BTreeMap;

use od_client::pdo;
use od_eds::Tables;
use od_model::{Dictionary, Kind, Literal};

use crate::support::{file, odkit, repository};

/// Signals of each message: first bit, bits, and whether it is signed.
type Messages = BTreeMap<String, Vec<(u8, u8, bool)>>;

fn messages(dbc: &str) -> Messages {
    let mut messages = Messages::new();
    let mut name = String::new();
    for line in dbc.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["BO_", _, message, _, _] => {
                name = message.trim_end_matches(':').into();
                messages.insert(name.clone(), Vec::new());
            }
            ["SG_", _, ":", bits, ..] => {
                let (first, rest) = bits.split_once('|').expect("first|bits@1+");
                let (length, order) = rest.split_once('@').expect("bits@1+");
                let signal = (first.parse(), length.parse());
                let (Ok(first), Ok(length)) = signal else {
                    panic!("{line}");
                };
                let signals = messages.get_mut(&name).expect("a message");
                signals.push((first, length, order == "1-"));
            }
            _ => {}
        }
    }
    messages
}

/// The mapping entries of a PDO.
fn mapping(dictionary: Dictionary<'_>, index: u16) -> Vec<u32> {
    let number = |sub| match dictionary.entry(index, sub)?.default {
        Literal::Unsigned(number) => u32::try_from(number).ok(),
        _ => None,
    };
    let count = number(0).unwrap_or(0);
    (1..=count as u8).filter_map(number).collect()
}

#[test]
fn signals_are_the_fields_of_the_mapping() {
    let mut pdos = 0;
    for path in [
        "tests/interop/mapped.eds",
        "devices/eds/GXMM.eds",
        "devices/eds/EAM_MT.eds",
        "devices/eds/EN580C.eds",
    ] {
        let path = repository(path);
        let made = odkit(&["convert", &path, "--to", "dbc", "--node-id", "7"], "");
        assert_eq!(made.code, 0, "{}", made.err);
        let messages = messages(&made.out);
        let text = std::fs::read_to_string(&path).expect("an EDS");
        let tables = Tables::new(&od_eds::parse(&text).description);
        let dictionary = tables.dictionary();
        for (kind, first) in [("TPDO", 0x1A00), ("RPDO", 0x1600)] {
            for pdo in 0..4 {
                let mapping = mapping(dictionary, first + pdo);
                if mapping.is_empty() {
                    continue;
                }
                pdos += 1;
                let signals = &messages[&format!("N7_{kind}{}", pdo + 1)];
                let fields = pdo::decode(&dictionary, &mapping, &[0; 8]).expect("64 bits");
                let fields = fields.filter(|field| !field.is_dummy()).map(|field| {
                    let kind = field.data_type().map(|data_type| data_type.kind());
                    let whole = field.data_type().and_then(|data_type| data_type.bits());
                    let is_signed = kind == Some(Kind::Signed)
                        || kind == Some(Kind::Real) && whole == Some(field.bits);
                    (field.first, field.bits, is_signed)
                });
                assert_eq!(*signals, fields.collect::<Vec<_>>(), "{path} {kind}{pdo}");
            }
        }
    }
    assert!(pdos > 8, "{pdos}");
}

#[test]
fn texts_follow_the_format() {
    let path = repository("tests/interop/mapped.eds");
    let made = odkit(&["convert", &path, "--to", "dbc"], "");
    for line in [
        "BU_: N1_Mapped_types",
        "BO_ 2147558213 N1_TPDO1: 8 N1_Mapped_types",
        " SG_ Signed_value_with_a_name_that_is : 8|24@1- (1,0) [-5|8388607] \"mm\" N1_Mapped_types",
        " SG_ Signed_value_with_a_name_that__2 : 24|16@1- (1,0) [0|0] \"mm\" Vector__XXX",
        "SIG_VALTYPE_ 513 Real_32 : 1;",
        "SIG_VALTYPE_ 2147558213 Real_64 : 2;",
        "CM_ BO_ 641 \"Not valid by default (bit 31 of its COB-ID)\";",
    ] {
        assert!(
            made.out.lines().any(|own| own == line),
            "{line}\n{}",
            made.out
        );
    }
}

/// A text in a PDO, two PDOs with one CAN-ID, a multiplexed PDO, and 72 bits.
const ODD: &str = "[2000]\nParameterName=Text\nDataType=9\nAccessType=ro\nPDOMapping=1\n\
    [1800]\nParameterName=a\nObjectType=9\n[1800sub1]\nParameterName=a\nDataType=7\nAccessType=rw\nDefaultValue=0x181\n\
    [1801]\nParameterName=b\nObjectType=9\n[1801sub1]\nParameterName=a\nDataType=7\nAccessType=rw\nDefaultValue=0x181\n\
    [1802]\nParameterName=c\nObjectType=9\n[1802sub1]\nParameterName=a\nDataType=7\nAccessType=rw\nDefaultValue=0x381\n\
    [1A00]\nParameterName=a\nObjectType=9\n[1A00sub0]\nParameterName=n\nDataType=5\nAccessType=rw\nDefaultValue=2\n\
    [1A00sub1]\nParameterName=a\nDataType=7\nAccessType=rw\nDefaultValue=0x20000028\n\
    [1A00sub2]\nParameterName=a\nDataType=7\nAccessType=rw\nDefaultValue=0x20000020\n\
    [1A01]\nParameterName=a\nObjectType=9\n[1A01sub0]\nParameterName=n\nDataType=5\nAccessType=rw\nDefaultValue=1\n\
    [1A01sub1]\nParameterName=a\nDataType=7\nAccessType=rw\nDefaultValue=0x20000008\n\
    [1A02]\nParameterName=a\nObjectType=9\n[1A02sub0]\nParameterName=n\nDataType=5\nAccessType=rw\nDefaultValue=254\n";

#[test]
fn content_that_a_dbc_cannot_express_is_reported() {
    let path = file("odd-dbc.eds", ODD).display().to_string();
    let made = odkit(&["convert", &path, "--to", "dbc"], "");
    assert_eq!(made.code, 1, "{}", made.err);
    for code in ["W1110", "W1111", "W1112", "W1113"] {
        assert!(
            made.err.contains(&format!("warning[{code}]")),
            "{code}\n{}",
            made.err
        );
    }
    assert!(
        made.out.contains("N1_TPDO1: 5 ") && !made.out.contains("N1_TPDO2"),
        "{}",
        made.out
    );
    let lossy = odkit(&["convert", &path, "--to", "dbc", "--lossy"], "");
    assert_eq!((lossy.code, lossy.out), (0, made.out));
}
