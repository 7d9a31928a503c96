//! `odkit convert --to canopennode`: OD.c and OD.h.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use od_eds::Tables;
use od_model::{Dictionary, Entry, Literal};

use crate::support::{file, folder, odkit, repository};

/// The files of these tests.
fn own(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/canopennode")
        .join(name)
}

/// The values of a node that was built from an EDS, as print.c prints them; `None` if there is no compiler.
fn printed(name: &str, eds: &str, node: &[&str]) -> Option<String> {
    let folder = folder(&format!("canopennode-{name}"), &[]);
    let output = folder.join("OD.c").display().to_string();
    let arguments = ["convert", eds, "-o", &output, "--to", "canopennode"];
    let made = odkit(&[&arguments, node].concat(), "");
    assert_eq!(made.code, 0, "{}", made.err);
    let program = folder.join("print");
    let compiler = Command::new("gcc")
        .args(["-Wall", "-Wextra", "-Werror", "-std=c11", "-I"])
        .args([folder.as_path(), Path::new("-I"), &own("")])
        .args([own("print.c"), "-o".into(), program.clone()])
        .output();
    let Ok(compiler) = compiler else {
        assert!(std::env::var_os("CI").is_none(), "CI needs `gcc`");
        println!("skipped: the C compiler `gcc` is missing");
        return None;
    };
    let said = String::from_utf8_lossy(&compiler.stderr);
    assert!(compiler.status.success(), "{said}");
    let run = Command::new(&program).output().expect("it runs");
    Some(String::from_utf8(run.stdout).expect("ASCII"))
}

/// The attributes of a value, by the numbers of CANopenNode.
fn attribute(entry: &Entry, is_text: bool) -> u8 {
    let access = entry.access;
    let flags = [
        (access.readable(), 1),
        (access.writable(), 2),
        (entry.mappable && access.maps_to_tpdo(), 4),
        (entry.mappable && access.maps_to_rpdo(), 8),
        (matches!(entry.data_type.bits(), Some(16 | 32 | 64)), 64),
        (is_text, 128),
    ];
    flags
        .iter()
        .filter(|(is_set, _)| *is_set)
        .map(|(_, bit)| bit)
        .sum()
}

/// The expected line of a value: the value in a node of odkit.
fn line(dictionary: Dictionary<'_>, entry: &Entry) -> String {
    let (address, size) = (entry.address, entry.data_type.size());
    let mut bytes = match (entry.default, size) {
        (Literal::None, Some(size)) => vec![0; size],
        (Literal::Real(real), Some(4)) => (real as f32).to_le_bytes().to_vec(),
        (Literal::Real(real), _) => real.to_le_bytes().to_vec(),
        // The node adds its node ID.
        (literal, Some(size)) => match literal.integer(0) {
            Some(number) => number.to_le_bytes()[..size].to_vec(),
            None => dictionary.literal_bytes(literal).to_vec(),
        },
        (literal, None) => dictionary.literal_bytes(literal).to_vec(),
    };
    if size.is_none() && (entry.access.writable() || bytes.is_empty()) {
        bytes.resize(64, 0);
    }
    let is_text = matches!(entry.default, Literal::Text(_));
    let data: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
    format!(
        "{:04X} {:02X} {:02X} {} {data}\n",
        address.index,
        address.sub,
        attribute(entry, is_text),
        bytes.len()
    )
}

#[test]
fn a_node_has_each_value_of_the_eds() {
    let every = own("every.eds").display().to_string();
    for (name, eds) in [
        ("every", every),
        ("gxmm", repository("devices/eds/GXMM.eds")),
        ("eam", repository("devices/eds/EAM_MT.eds")),
    ] {
        let Some(printed) = printed(name, &eds, &[]) else {
            return;
        };
        let text = fs::read_to_string(&eds).expect("an EDS");
        let tables = Tables::new(&od_eds::parse(&text).description);
        let dictionary = tables.dictionary();
        let entries = dictionary.entries();
        let expected: String = entries.map(|entry| line(dictionary, &entry)).collect();
        assert_eq!(printed, expected, "{name}");
    }
}

/// `ODKIT_ACCEPT=1` writes the expected files.
#[test]
fn the_files_are_as_expected() {
    let eds = own("every.eds").display().to_string();
    let folder = folder("canopennode-bytes", &[]);
    let output = folder.join("OD.c").display().to_string();
    let arguments = ["convert", &eds, "-o", &output, "--to", "canopennode"];
    assert_eq!(odkit(&arguments, "").code, 0);
    for name in ["OD.c", "OD.h"] {
        let made = fs::read_to_string(folder.join(name)).expect("a file");
        // The path of the source is that of this computer.
        let made = made.replace(&eds, "every.eds");
        let expected = own("expected").join(name);
        if std::env::var_os("ODKIT_ACCEPT").is_some() {
            fs::write(&expected, &made).expect("the expected file");
        }
        let expected = fs::read_to_string(expected).expect("the expected file");
        assert_eq!(made, expected, "{name}");
    }
}

/// A file with everything that CANopenNode cannot express.
const ODD: &str = "[1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\n\
    [1402]\nParameterName=RPDO\nObjectType=9\nSubNumber=2\n\
    [1402sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=1\n\
    [1402sub1]\nParameterName=c\nDataType=7\nAccessType=rw\nDefaultValue=0x400\n\
    [1602]\nParameterName=Map\nObjectType=9\nSubNumber=11\n\
    [1602sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=10\n\
    [1602sub1]\nParameterName=m\nDataType=7\nAccessType=rw\nDefaultValue=0x20000001\n\
    [2000]\nParameterName=a\nDataType=5\nAccessType=rw\nDefaultValue=$NODEID+0x10\nLowLimit=1\n\
    [2001]\nParameterName=Image\nObjectType=2\nDataType=15\nAccessType=rw\n";

#[test]
fn content_that_is_lost_is_reported() {
    let path = file("odd.eds", ODD).display().to_string();
    let output = folder("canopennode-odd", &[])
        .join("OD.c")
        .display()
        .to_string();
    let arguments = ["convert", &path, "-o", &output, "--to", "canopennode"];
    let made = odkit(&arguments, "");
    assert_eq!(made.code, 1, "{}", made.err);
    for said in [
        "warning[W1101]: OD.c has no storage for a DOMAIN",
        "warning[W1102]",
        "warning[W1103]: CANopenNode adds the node ID to COB-ID 400h",
        "warning[W1104]: CANopenNode needs 1400h",
        "warning[W1104]: CANopenNode needs 1601h",
        "10 mapping entries of a PDO",
        "remark[I1106]: the node does not check the limits of 1 value",
        "remark[I1107]: CANopenNode needs 1003h, 1014h, 1016h, unless",
        "remark[I1108]",
        "warning[W1109]: CANopenNode does not start without 1001h",
        "warning[W1109]: CANopenNode does not start without 1017h",
        "cannot express 10 objects",
    ] {
        assert!(made.err.contains(said), "{said}\n{}", made.err);
    }
    let lossy = odkit(&[&arguments[..], &["--lossy"]].concat(), "");
    assert_eq!(lossy.code, 0, "{}", lossy.err);
    let one = odkit(&[&arguments[..], &["--node-id", "5"]].concat(), "");
    assert!(!one.err.contains("W1102"), "{}", one.err);
    let source = fs::read_to_string(&output).expect("OD.c");
    assert!(source.contains(".x2000_a = 0x15"), "{source}");
}

#[test]
fn the_arguments_are_checked() {
    let gxmm = ["convert", "gxmm", "--to", "canopennode"];
    let made = odkit(&gxmm, "");
    assert_eq!(made.code, 2);
    assert!(made.err.contains("add `-o OD.c`"), "{}", made.err);
    // The name of the dictionary is the name of the file.
    let output = folder("canopennode-name", &[])
        .join("my-od.c")
        .display()
        .to_string();
    let made = odkit(&[&gxmm[..], &["-o", &output]].concat(), "");
    assert_eq!(made.code, 0, "{}", made.err);
    let source = fs::read_to_string(&output).expect("a file");
    assert!(source.contains("#include \"my-od.h\"") && source.contains("OD_t *my_od ="));
}
