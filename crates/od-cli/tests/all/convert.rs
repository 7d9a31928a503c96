//! `odkit convert`: EDS, DCF, XDD, Markdown, C header, JSON.

use std::io::Write;
use std::process::{Command, Stdio};

use crate::support::{file, odkit, repository};

#[test]
fn an_exported_eds_describes_the_same_device() {
    let text = odkit(&["convert", "gcmm", "--to", "eds"], "");
    assert_eq!(text.code, 0, "{}", text.err);
    let path = file("gcmm.eds", &text.out).display().to_string();
    let diff = odkit(&["diff", "gcmm", &path, "--fail-on", "any"], "");
    assert_eq!(diff.code, 0, "{}", diff.out);
}

#[test]
fn a_dcf_has_the_values_of_one_device() {
    let dcf = [
        "convert",
        "gxmm",
        "--to",
        "dcf",
        "--node-id",
        "5",
        "--bit-rate",
        "250",
        "--set",
        "6001h=4096",
        "--set",
        "1017h=1000",
    ];
    let made = odkit(&dcf, "");
    assert_eq!(made.code, 0, "{}", made.err);
    for line in [
        "[DeviceComissioning]",
        "NodeID=5",
        "Baudrate=250",
        "ParameterValue=0x1000",
    ] {
        assert!(made.out.contains(line), "{line}\n{}", made.out);
    }
    let path = file("five.dcf", &made.out).display().to_string();
    let again = odkit(&["convert", &path, "--to", "dcf"], "");
    assert_eq!((again.code, again.out), (0, made.out));
    let script = format!("device {path}\nexpect 705#00\nsdo read 6001h = 4096\n");
    let run = odkit(&["run", "-"], &script);
    assert_eq!(run.code, 0, "{}", run.err);
}

#[test]
fn an_xdd_describes_the_same_device() {
    for device in ["gxmm", "eam_mt", "en580c"] {
        let text = odkit(&["convert", device, "--to", "xdd"], "");
        assert_eq!(text.code, 0, "{}", text.err);
        let path = file(&format!("{device}.xdd"), &text.out)
            .display()
            .to_string();
        let diff = odkit(&["diff", device, &path, "--fail-on", "any"], "");
        assert_eq!(diff.code, 0, "{}{}", diff.out, diff.err);
        assert_eq!(odkit(&["check", &path], "").code, 0, "{device}");
    }
}

#[test]
fn markdown_has_the_objects() {
    let page = odkit(&["convert", "gxmm", "--to", "md"], "");
    assert_eq!(page.code, 0, "{}", page.err);
    assert!(page.out.contains("6004h"), "{}", page.out);
}

#[test]
fn values_that_cannot_be_set_are_reported() {
    for (arguments, said) in [
        (&["--to", "dcf"][..], "--node-id 5"),
        (
            &["--to", "dcf", "--node-id", "5", "--set", "6004h=1"],
            "6004h is `ro` and cannot be set",
        ),
        (
            &["--to", "dcf", "--node-id", "5", "--set", "6001h=9999999"],
            "outside 1..8192",
        ),
        (
            &["--to", "dcf", "--node-id", "5", "--set", "5FFFh=1"],
            "5FFFh",
        ),
        (&["--to", "eds", "--node-id", "5"], "--to dcf"),
        (&["--to", "canopennode", "--bit-rate", "5"], "--to dcf"),
        (&["-o", "x.txt"], "--to eds"),
    ] {
        let run = odkit(&[&["convert", "gxmm"], arguments].concat(), "");
        assert_eq!(run.code, 2, "{arguments:?} {}", run.err);
        assert!(run.err.contains(said), "{arguments:?} {}", run.err);
    }
}

#[test]
fn json_has_every_entry() {
    let json = odkit(&["convert", "gxmm", "--to", "json"], "");
    let value: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    let objects = value["objects"].as_array().expect("a list");
    let position = objects.iter().find(|object| object["index"] == "0x6004");
    let position = &position.expect("a position")["entries"][0];
    assert_eq!(position["dataType"], "UNSIGNED32");
    assert_eq!(
        (&position["tpdo"], &position["access"]),
        (&true.into(), &"ro".into())
    );
    let cob_id = objects.iter().find(|object| object["index"] == "0x1014");
    assert_eq!(
        cob_id.expect("an object")["entries"][0]["default"]["nodeIdPlus"],
        128
    );
}

/// A C compiler accepts the header, and code that uses its definitions.
#[test]
fn a_c_compiler_accepts_the_header() {
    let eds = repository("devices/eds/GXMM.eds");
    let header = odkit(&["convert", &eds, "--to", "c"], "");
    assert_eq!(header.code, 0, "{}", header.err);
    assert!(
        header
            .out
            .contains("#define GXMM_POSITION_VALUE_INDEX 0x6004u")
    );
    let program = format!(
        "#define NODE_ID 5u\n{}\nunsigned a[] = {{ GXMM_POSITION_VALUE_INDEX, \
         GXMM_COB_ID_EMERGENCY_MESSAGE_DEFAULT, GXMM_MEASURING_UNITS_PER_REVOLUTION_MAX }};\n",
        header.out
    );
    let compiler = Command::new("cc")
        .args([
            "-x",
            "c",
            "-std=c99",
            "-Wall",
            "-Werror",
            "-fsyntax-only",
            "-",
        ])
        .stdin(Stdio::piped())
        .spawn();
    let Ok(mut compiler) = compiler else {
        assert!(
            std::env::var_os("CI").is_none(),
            "CI needs a C compiler `cc`"
        );
        println!("skipped: the C compiler `cc` is missing");
        return;
    };
    let mut input = compiler.stdin.take().expect("a pipe");
    input.write_all(program.as_bytes()).expect("it reads");
    drop(input);
    assert!(compiler.wait().expect("it ends").success(), "{program}");
}

/// One object of an unknown type, one without a type, and two with a type in CiA 301.
const TYPES: &str = "[FileInfo]\nFileName=types.eds\n[DeviceInfo]\nVendorName=A & B\n\
    VendorNumber=0x5F\nProductName=P\nProductNumber=16\nRevisionNumber=2\n\
    BaudRate_125=1\nBaudRate_250=0\n[MandatoryObjects]\nSupportedObjects=1\n1=0x1018\n\
    [1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n\
    [1018sub0]\nParameterName=Highest\nAccessType=const\nDefaultValue=1\n\
    [1018sub1]\nParameterName=Vendor-ID\nAccessType=ro\nDefaultValue=0x5F\n\
    [OptionalObjects]\nSupportedObjects=1\n1=0x1017\n\
    [1017]\nParameterName=Heartbeat\nAccessType=rw\nDefaultValue=1000\nParameterValue=500\n\
    [ManufacturerObjects]\nSupportedObjects=3\n1=0x2000\n2=0x2001\n3=0x2002\n\
    [2000]\nParameterName=Odd\nDataType=0x0099\nAccessType=rw\nDefaultValue=5\n\
    [2001]\nParameterName=None\nAccessType=ro\n\
    [2002]\nParameterName=Sound\nDataType=3\nAccessType=rw\nDefaultValue=-5\nLowLimit=-9\nHighLimit=9\n";

#[test]
fn a_target_keeps_what_it_can_hold() {
    let path = file("types.eds", TYPES).display().to_string();
    let json = odkit(&["convert", &path, "--to", "json"], "");
    assert_eq!(json.code, 0, "{}", json.err);
    let value: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(value["format"], "odkit-dictionary/2");
    assert_eq!(value["identity"]["vendorNumber"], 0x5F);
    assert_eq!(value["device"]["bitRates"], serde_json::json!([125]));
    assert_eq!(value["file"]["name"], "types.eds");
    let object = |index: &str| {
        let objects = value["objects"].as_array().expect("a list");
        let found = objects.iter().find(|object| object["index"] == index);
        found.unwrap_or_else(|| panic!("{index}"))["entries"].clone()
    };
    assert_eq!(object("0x1018")[1]["dataType"], "UNSIGNED32");
    let heartbeat = &object("0x1017")[0];
    assert_eq!(
        (&heartbeat["default"], &heartbeat["parameter"]),
        (&1000.into(), &500.into())
    );
    let odd = &object("0x2000")[0];
    assert_eq!(
        (&odd["dataType"], &odd["extra"]["DataType"]),
        (&serde_json::Value::Null, &"0x0099".into())
    );
    assert_eq!(odd["extra"]["DefaultValue"], "5");
    assert_eq!(object("0x2001")[0]["dataType"], serde_json::Value::Null);
    let sound = &object("0x2002")[0];
    assert_eq!((&sound["low"], &sound["high"]), (&(-9).into(), &9.into()));
    let header = odkit(&["convert", &path, "--to", "c"], "");
    assert_eq!(header.code, 0, "{}", header.err);
    for line in [
        "TYPES_ODD_INDEX 0x2000u",
        "TYPES_IDENTITY_VENDOR_ID_DEFAULT 0x5Fu",
        "TYPES_NONE_SUB 0x00u",
    ] {
        assert!(header.out.contains(line), "{line}\n{}", header.out);
    }
    for target in ["eds", "xdd"] {
        let made = odkit(&["convert", &path, "--to", target], "");
        assert_eq!(made.code, 0, "{}", made.err);
        let path = file(&format!("types-again.{target}"), &made.out)
            .display()
            .to_string();
        let found = odkit(&["check", &path, "--format", "json"], "").out;
        // The types of CiA 301 are written; the value of an unknown type is unchanged.
        assert!(
            !found.contains("W0426") && found.contains("`0x0099` is not a data type"),
            "{found}"
        );
    }
}

#[test]
fn content_that_a_target_lacks_is_reported() {
    let path = file("lacking.eds", TYPES).display().to_string();
    let page = odkit(&["convert", &path, "--to", "md"], "");
    assert_eq!(page.code, 1);
    for said in [
        "E0401",
        "E0402",
        "lacks 2 objects of the source (2000h:00, 2001h:00)",
        "`--lossy`",
    ] {
        assert!(page.err.contains(said), "{said}\n{}", page.err);
    }
    assert!(
        page.out.contains("2002h") && !page.out.contains("2001h"),
        "{}",
        page.out
    );
    assert_eq!(
        odkit(&["convert", &path, "--to", "md", "--lossy"], "").code,
        0
    );
    assert_eq!(odkit(&["export", &path], "").code, 0);
    let nameless = "<ISO15745ProfileContainer><CANopenObject index=\"x\" name=\"a\"/>\
        <CANopenObject index=\"2000\" name=\"b\" objectType=\"7\" dataType=\"0005\" accessType=\"ro\"/>\
        </ISO15745ProfileContainer>";
    let path = file("nameless.xdd", nameless).display().to_string();
    for command in [&["export", &path][..], &["convert", &path, "--to", "json"]] {
        let run = odkit(command, "");
        assert_eq!(run.code, 1, "{}", run.err);
        assert!(
            run.err.contains("E0114") && run.err.contains("lacks 1 object"),
            "{}",
            run.err
        );
        assert!(run.out.contains("2000"), "{}", run.out);
        assert_eq!(odkit(&[command, &["--lossy"]].concat(), "").code, 0);
    }
}
