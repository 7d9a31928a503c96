//! Calls of `object_dictionary!`.

use serde_json::{Value, json};

use crate::support::{Client, Files, TEXT, covered, labels, place};

#[test]
fn calls_of_the_macro_use_the_objects_of_their_file() {
    let mut files = Files::default();
    files.0.insert("/w/eds/a.eds".into(), TEXT.into());
    let mut client = Client::new(files, json!({}));
    let uri = "file:///w/src/lib.rs";
    let text = "object_dictionary! {\n    pub mod a {\n        eds = \"../eds/a.eds\";\n        \
        rename 0x6004 = POSITION;\n        modify 0x2001 { default = 300 }\n        remove 0x7777;\n        \
        modify 0x\n        variant v { modify 0x1018sub1 { access =  } }\n    }\n}\n";
    client.open(uri, text);
    let found = client.diagnostics(uri);
    let said: Vec<_> = found
        .iter()
        .map(|one| (one["code"].as_str().unwrap(), covered(text, &one["range"])))
        .collect();
    // Two PDOs of the file have the same COB-ID, and a device can be built with the three that follow.
    assert_eq!(
        said,
        [
            ("W0521", "../eds/a.eds"),
            ("W0216", "../eds/a.eds"),
            ("W0635", "../eds/a.eds"),
            ("W0904", "../eds/a.eds"),
            ("E0707", "300"),
            ("E0701", "0x7777")
        ]
    );
    let severities: Vec<_> = found.iter().map(|one| one["severity"].clone()).collect();
    assert_eq!(severities, [1, 2, 2, 2, 1, 1]);
    let at = |client: &mut Client, method: &str, mark: &str| {
        client.request(
            method,
            json!({ "textDocument": { "uri": uri }, "position": place(text, mark) }),
        )
    };
    let hover = at(&mut client, "textDocument/hover", "0x60|04");
    assert!(
        hover["contents"]["value"]
            .as_str()
            .unwrap()
            .contains("Position value (CiA 406)")
    );
    let jump = at(&mut client, "textDocument/definition", "0x1018|sub1");
    assert_eq!(jump["uri"], "file:///w/eds/a.eds");
    assert_eq!(covered(TEXT, &jump["range"]), "[1018sub1]");
    let found = at(&mut client, "textDocument/completion", "modify 0x|\n");
    assert!(labels(&found).contains(&"0x6004") && labels(&found).contains(&"0x1018sub1"));
    assert_eq!(
        labels(&at(&mut client, "textDocument/completion", "access = |")),
        ["ro", "wo", "rw", "rwr", "rww", "const"]
    );
    assert!(
        labels(&at(
            &mut client,
            "textDocument/completion",
            "        |remove"
        ))
        .contains(&"variant")
    );
    assert_eq!(
        at(&mut client, "textDocument/hover", "object_dict|ionary"),
        Value::Null
    );
    client.change(uri, json!({ "text": text.replace("a.eds", "b.eds") }));
    let found = client.diagnostics(uri);
    assert_eq!(found[0]["message"], "../eds/b.eds cannot be read");
}

#[test]
fn an_object_of_a_call_without_a_file_has_the_name_of_the_standard() {
    let uri = "file:///w/src/own.rs";
    let text = "odkit::object_dictionary! {\n    pub mod own {\n        add 0x1017 { name = \"h\"; type = u16 }\n    }\n}\n";
    let mut client = Client::new(Files::default(), json!({}));
    client.open(uri, text);
    let params = json!({ "textDocument": { "uri": uri }, "position": place(text, "0x10|17") });
    let hover = client.request("textDocument/hover", params);
    let said = hover["contents"]["value"].as_str().unwrap();
    assert!(said.contains("producer heartbeat time (CiA 301)"), "{said}");
}

#[test]
fn a_row_with_a_formula_counts() {
    let mut client = Client::new(Files::default(), json!({}));
    let uri = "file:///w/lib.rs";
    let rows = |cob_id: &str| {
        format!(
            "object_dictionary! {{ mod a {{ add 0x1000 {{ name = \"a\"; type = u32; access = const; default = 0 }}
add 0x1001 {{ name = \"b\"; type = u8; mappable = true }} add 0x1018 {{ code = record; name = \"c\" }}
add 0x1018sub1 {{ name = \"d\"; type = u32; default = 1 }} add 0x1017 {{ name = \"e\"; type = u16; access = rw }}
add 0x1800 {{ code = record; name = \"f\" }} add 0x1800sub1 {{ name = \"g\"; type = u32; access = rw; default = {cob_id} }}
add 0x1800sub2 {{ name = \"h\"; type = u8; access = rw; default = 254 }} add 0x1A00 {{ code = record; name = \"i\" }}
add 0x1A00sub1 {{ name = \"j\"; type = u32; access = rw; default = 0x1001_0008 }} }} }}"
        )
    };
    for (cob_id, expected) in [
        ("$NODEID + 0x180", &[][..]),
        ("$NODEID + 0x580", &["W0520"]),
        ("$NODEID", &["W0520"]),
        ("$NODEID + 0x7A0", &["W0520", "W0522"]),
    ] {
        let text = rows(cob_id);
        client.open(uri, &text);
        let found = client.diagnostics(uri);
        let codes: Vec<_> = found.iter().map(|one| one["code"].clone()).collect();
        assert_eq!(codes, expected, "{cob_id}: {found:?}");
    }
}

#[test]
fn a_warning_that_a_statement_brings_about_is_at_the_statement() {
    let mut files = Files::default();
    files.0.insert("/w/a.eds".into(), TEXT.into());
    let mut client = Client::new(files, json!({}));
    let uri = "file:///w/lib.rs";
    let text = "object_dictionary! {\n    mod a {\n        eds = \"a.eds\";\n        \
                modify 0x2001 { low = 9 }\n        variant v { modify 0x2001 { low = 0; high = 5 } }\n    }\n}\n";
    client.open(uri, text);
    let found = client.diagnostics(uri);
    let limits: Vec<_> = found
        .iter()
        .filter(|one| one["code"] == "W0452")
        .map(|one| (one["severity"].clone(), covered(text, &one["range"])))
        .collect();
    // The default of the file is 7.
    assert_eq!(limits, [(json!(2), "0x2001"), (json!(2), "0x2001")]);
    client.change(
        uri,
        json!({ "text": text.replace("eds = ", "warnings = off;\n        eds = ") }),
    );
    let found = client.diagnostics(uri);
    assert!(found.iter().all(|one| one["severity"] == 1), "{found:?}");
}

#[test]
fn a_variant_that_breaks_a_row_of_the_call_is_reported_at_its_statement() {
    let rows = "object_dictionary! {\n    mod a {\n        \
                add 0x1000 { name = \"t\"; type = u32; access = const; default = 0 }\n        \
                add 0x1001 { name = \"e\"; type = u8 }\n        \
                add 0x1018 { code = record; name = \"i\" }\n        \
                add 0x1018sub1 { name = \"v\"; type = u32; default = 0x5F }\n        \
                add 0x1017 { name = \"h\"; type = u16; access = rw; default = 1000 }\n        \
                add 0x2000 { name = \"x\"; type = i16; mappable = true; default = 215 }\n        \
                add 0x1800 { code = record; name = \"c\" }\n        \
                add 0x1800sub1 { name = \"i\"; type = u32; access = rw; default = $NODEID + 0x180 }\n        \
                add 0x1800sub2 { name = \"t\"; type = u8; access = rw; default = 254 }\n        \
                add 0x1A00 { code = record; name = \"m\" }\n        \
                add 0x1A00sub1 { name = \"1\"; type = u32; access = rw; default = 0x2000_0010 }\n        \
                variant v { STATEMENT }\n    }\n}\n";
    let mut client = Client::new(Files::default(), json!({}));
    for (statement, code) in [
        ("remove 0x2000;", "E0501"),
        ("modify 0x2000 { type = i32 }", "E0504"),
        ("modify 0x2000 { mappable = false }", "E0502"),
        ("modify 0x2000 { high = 100 }", "W0452"),
    ] {
        let text = rows.replace("STATEMENT", statement);
        let uri = format!("file:///w/{code}.rs");
        client.open(&uri, &text);
        let found = client.diagnostics(&uri);
        let [one] = &found[..] else {
            panic!("{statement}: {found:?}");
        };
        assert_eq!(one["code"], code);
        assert_eq!(covered(&text, &one["range"]), "0x2000", "{statement}");
        let at = one["range"]["start"]["line"].as_u64().unwrap() as usize;
        let line = text.lines().nth(at).unwrap();
        assert!(line.contains("variant v"), "{statement}: {line}");
    }
}
