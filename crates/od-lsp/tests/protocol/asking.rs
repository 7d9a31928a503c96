//! Hover, completion, jumps, outline and hints.

use serde_json::{Value, json};

use crate::support::{Client, Files, TEXT, URI, covered, edited, labels, place};

#[test]
fn a_hover_describes_the_place() {
    let mut client = Client::with(TEXT);
    for (mark, expected) in [
        (
            "[1000|]",
            &["1000h", "device type (CiA 301)", "device profile CiA 406"][..],
        ),
        ("[60|04]", &["Position value (CiA 406)", "UNSIGNED32, ro"]),
        ("0x6004002|0", &["maps 6004h:00, 32 bits", "Position value"]),
        ("$NODEID+|0x180", &["COB-ID 180h + node ID"]),
        ("DataTyp|e=0x0007", &["the index of its definition"]),
        ("DataType=0x00|07", &["UNSIGNED32, 0 to 4294967295"]),
        (
            "ObjectType=0x|9",
            &["RECORD: sub-objects of different types"],
        ),
        ("AccessType=c|onst", &["never changes"]),
        ("[FileInf|o]", &["its name, version"]),
        ("1=0x10|00", &["device type"]),
        ("LowLimi|t", &["Smallest valid value"]),
    ] {
        let found = client.at("textDocument/hover", TEXT, mark);
        let said = found["contents"]["value"]
            .as_str()
            .unwrap_or_else(|| panic!("{mark}"));
        for expected in expected {
            assert!(said.contains(expected), "{mark}: {said}");
        }
        assert!(found["range"]["start"].is_object(), "{mark}");
    }
    assert_eq!(
        client.at("textDocument/hover", TEXT, "|\n[FileInfo]"),
        Value::Null
    );
    let drive = "[1000]\nDataType=7\nAccessType=ro\nDefaultValue=0x00020192\n\
        [6060]\nParameterName=Modes of operation\nDataType=2\nAccessType=rw\nDefaultValue=1\n";
    client.change(URI, json!({ "text": drive }));
    let found = client.at("textDocument/hover", drive, "[60|60]");
    let said = found["contents"]["value"].as_str().unwrap();
    assert!(said.contains("profile position"), "{said}");
    let text = "[2000]\nParameterName=a\nDataType=5\nDefaultValue=300\n";
    client.change(URI, json!({ "text": text }));
    let found = client.at("textDocument/hover", text, "=3|00");
    let said = found["contents"]["value"].as_str().unwrap();
    assert!(
        said.contains("**E0412**") && said.contains("Source: CiA"),
        "{said}"
    );
}

#[test]
fn completion_offers_missing_items() {
    let mut client = Client::with(TEXT);
    let found = client.at("textDocument/completion", TEXT, "DataType=|0x0007");
    assert!(labels(&found).contains(&"0x001B"));
    let type_edit = &found["items"][0]["textEdit"];
    assert_eq!(covered(TEXT, &type_edit["range"]), "0x0007");
    let found = client.at("textDocument/completion", TEXT, "AccessType=|const");
    assert_eq!(labels(&found), ["ro", "wo", "rw", "rwr", "rww", "const"]);
    let found = client.at("textDocument/completion", TEXT, "DefaultValue=|0x60040020");
    assert_eq!(labels(&found), ["0x60000010", "0x60040020"]);
    // Mandatory objects come first, with their keys.
    let text = "[1000]\nParameterName=a\n\n[";
    client.change(URI, json!({ "text": text }));
    let found = client.at("textDocument/completion", text, "\n[|");
    assert_eq!(&labels(&found)[..2], ["1001", "1018"]);
    let identity = edited(text, &json!([found["items"][1]["textEdit"]]));
    let parsed = od_eds::parse(&identity);
    assert_eq!(
        parsed.description.objects[&0x1018].entries.len(),
        2,
        "{identity}"
    );
    assert!(labels(&found).contains(&"FileInfo") && labels(&found).contains(&"1017"));
    let text = "[1000]\nParameterName=a\nDataType=7\nAc";
    client.change(URI, json!({ "text": text }));
    let found = client.at("textDocument/completion", text, "\nAc|");
    let keys = labels(&found);
    assert!(
        keys.contains(&"AccessType")
            && !keys.contains(&"DataType")
            && !keys.contains(&"ParameterValue")
    );
    let text = "[OptionalObjects]\nSupportedObjects=1\n1=0x6000\n2=\n[6000]\nParameterName=a\n[6001]\nParameterName=b\n";
    client.change(URI, json!({ "text": text }));
    let found = client.at("textDocument/completion", text, "2=|");
    assert_eq!(labels(&found), ["0x6001"]);
    let found = client.at("textDocument/completion", text, "|2=");
    assert!(labels(&found).contains(&"2"));
}

#[test]
fn completion_offers_values_with_a_meaning() {
    let drive = |value: &str| {
        format!(
            "[DeviceInfo]\nBaudRate_125=1\nBaudRate_250=0\n[DeviceComissioning]\nBaudrate=\n\
             [1000]\nDataType=7\nAccessType=ro\nDefaultValue=0x00020192\n\
             [1800]\nObjectType=9\n[1800sub2]\nDataType=5\nDefaultValue=\n\
             [6060]\nDataType=2\nAccessType=rw\nDefaultValue={value}\n"
        )
    };
    let text = drive("");
    let mut client = Client::with(&text);
    let of = |client: &mut Client, mark: &str| {
        let found = client.at("textDocument/completion", &text, mark);
        labels(&found)
            .into_iter()
            .map(String::from)
            .collect::<Vec<_>>()
    };
    let modes = of(&mut client, "AccessType=rw\nDefaultValue=|");
    assert_eq!(modes[..3], ["0", "1", "2"]);
    assert!(!modes.contains(&"5".into()), "5 is reserved");
    let types = of(&mut client, "DataType=5\nDefaultValue=|");
    assert_eq!(types, ["255", "254", "0", "1", "253", "252"]);
    assert_eq!(of(&mut client, "Baudrate=|"), ["125"]);
}

#[test]
fn jumps_between_objects_lists_mappings_and_cob_ids() {
    let mut client = Client::with(TEXT);
    let covered = |found: &Value| -> Vec<String> {
        let found = found.as_array().unwrap().iter();
        found
            .map(|one| covered(TEXT, &one["range"]).to_owned())
            .collect()
    };
    for (mark, expected) in [
        ("1=0x10|00", "[1000]"),
        ("0x60040|020", "[6004]"),
        ("[1018su|b1]", "[1018]"),
        ("$NODEID+0x|180", "[1A00]"),
    ] {
        let found = client.at("textDocument/definition", TEXT, mark);
        assert_eq!(covered(&found), [expected], "{mark}");
    }
    let found = client.at("textDocument/references", TEXT, "[60|04]");
    assert_eq!(covered(&found), ["0x6004", "0x60040020", "6004"]);
    let position = place(TEXT, "[60|04]");
    let params = json!({ "textDocument": { "uri": URI }, "position": position, "context": { "includeDeclaration": false } });
    let found = client.request("textDocument/references", params);
    assert_eq!(covered(&found), ["0x6004", "0x60040020"]);
    let found = client.at("textDocument/references", TEXT, "$NODEID+0x|200");
    assert_eq!(covered(&found), ["$NODEID+0x200", "$NODEID+0x200"]);
    let found = client.at("textDocument/documentHighlight", TEXT, "[60|04]");
    assert_eq!(found.as_array().unwrap().len(), 3);
}

#[test]
fn outline_folding_and_hints() {
    let mut client = Client::with(TEXT);
    let symbols = client.of("textDocument/documentSymbol");
    let symbols = symbols.as_array().unwrap();
    let identity = symbols
        .iter()
        .find(|one| one["name"] == "1018h Identity object")
        .unwrap();
    assert_eq!(identity["detail"], "RECORD");
    assert_eq!(identity["children"][1]["name"], "1018h:01 Vendor-ID");
    let line = |mark: &str| place(TEXT, mark)["line"].clone();
    let folds = client.of("textDocument/foldingRange");
    let folds = folds.as_array().unwrap();
    let own = folds
        .iter()
        .find(|fold| fold["startLine"] == line("[|1018]"))
        .unwrap();
    assert!(own["endLine"].as_u64() > line("[|1018sub1]").as_u64());
    assert!(
        folds
            .iter()
            .any(|fold| fold["kind"] == "comment" && fold["startLine"] == 0)
    );
    let all =
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 9999, "character": 0 } });
    let hints = client.request(
        "textDocument/inlayHint",
        json!({ "textDocument": { "uri": URI }, "range": all }),
    );
    let said = labels(&hints);
    for expected in [
        "6004h:00, 32 bits",
        "UNSIGNED32",
        "RECORD",
        "180h + node ID",
        "Device type",
    ] {
        assert!(said.contains(&expected), "{expected}: {said:?}");
    }
    let at = line("DefaultValue=|0x60040020");
    let one =
        json!({ "start": { "line": at, "character": 0 }, "end": { "line": at, "character": 99 } });
    let hints = client.request(
        "textDocument/inlayHint",
        json!({ "textDocument": { "uri": URI }, "range": one }),
    );
    assert_eq!(labels(&hints), ["6004h:00, 32 bits"]);
}

/// A DCF tells the COB-ID of its node; the number of a list entry and a dummy tell what they are about.
#[test]
fn hover_tells_what_a_number_stands_for() {
    let node = "[DeviceComissioning]\nNodeID=0x11\nBaudrate=500\n";
    let dummy = "[DummyUsage]\nDummy0005=1\n";
    let text = format!("{TEXT}\n{node}{dummy}");
    let mut client = Client::with(&text);
    for (mark, part) in [
        ("NodeID=0x1|1", "17 (11h)"),
        (
            "DefaultValue=$NODEID+0x18|0",
            "180h + node ID (191h for node 17)",
        ),
        ("8|=0x6004", "Position value"),
        ("Dummy0005|=1", "UNSIGNED8"),
    ] {
        let hover = client.at("textDocument/hover", &text, mark);
        let said = hover["contents"]["value"].as_str().unwrap_or_default();
        assert!(said.contains(part), "{mark}: {said}");
    }
}

#[test]
fn a_dcf_and_an_overlay_lead_to_the_files_that_they_name() {
    let dcf = "[FileInfo]\nLastEDS=small.eds\n";
    let overlay = ";odkit-base=small.eds\n[2001]\nDefaultValue=8\n";
    let mut files = Files::default();
    files.0.insert("/w/small.eds".into(), TEXT.into());
    let mut client = Client::new(files, json!({}));
    for (uri, text, mark) in [
        ("file:///w/a.dcf", dcf, "LastEDS=sm|all.eds"),
        ("file:///w/a.overlay", overlay, ";odkit-base=sm|all.eds"),
    ] {
        client.open(uri, text);
        let params = json!({ "textDocument": { "uri": uri }, "position": place(text, mark) });
        let found = client.request("textDocument/definition", params);
        assert_eq!(found[0]["uri"], "file:///w/small.eds", "{mark}");
    }
}
