//! The server over its messages, in one process.

use serde_json::{Value, json};

use support::{Client, Files, URI, edited, place};

mod support;

const TEXT: &str = include_str!("device.eds");

fn labels(found: &Value) -> Vec<&str> {
    let items = found.get("items").unwrap_or(found).as_array().unwrap();
    items
        .iter()
        .map(|item| item["label"].as_str().unwrap())
        .collect()
}

/// The text that a range covers.
fn covered<'t>(text: &'t str, range: &Value) -> &'t str {
    let line = text
        .lines()
        .nth(range["start"]["line"].as_u64().unwrap() as usize)
        .unwrap();
    let at = |place: &Value| place["character"].as_u64().unwrap() as usize;
    &line[at(&range["start"])..at(&range["end"])]
}

#[test]
fn a_life_in_order_and_out_of_order() {
    let mut client = Client::raw(Files::default());
    let code = |answer: &Value| answer["error"]["code"].as_i64();
    assert_eq!(
        code(&client.ask("textDocument/hover", json!({}))),
        Some(-32002)
    );
    client.notify("textDocument/didOpen", json!({}));
    let result = client.request("initialize", json!({ "capabilities": {} }));
    assert_eq!(result["capabilities"]["positionEncoding"], "utf-16");
    assert_eq!(code(&client.ask("initialize", json!({}))), Some(-32600));
    assert_eq!(
        code(&client.ask("textDocument/nothing", json!({}))),
        Some(-32601)
    );
    assert_eq!(
        code(&client.ask("textDocument/hover", json!([1]))),
        Some(-32602)
    );
    let missing = json!({ "textDocument": { "uri": "x" }, "position": place("a", "|a") });
    assert_eq!(
        code(&client.ask("textDocument/hover", missing)),
        Some(-32803)
    );
    for text in ["", "{", "{}", "[]", "7", "\u{0}", &"[".repeat(5000)] {
        client.server.receive(text);
        let answer = client.all().remove(0);
        assert!(
            matches!(code(&answer), Some(-32700 | -32600)),
            "{text}: {answer}"
        );
        assert_eq!(answer["id"], Value::Null);
    }
    client
        .server
        .receive(r#"{"jsonrpc":"2.0","id":{},"method":"x"}"#);
    assert_eq!(code(&client.all()[0]), Some(-32600));
    client
        .server
        .receive(r#"{"jsonrpc":"2.0","id":"files","result":null}"#);
    client.notify("$/setTrace", json!({ "value": "off" }));
    client.notify(
        "textDocument/didChange",
        json!({ "textDocument": { "uri": 5 } }),
    );
    assert_eq!(client.all(), [0; 0]);
    assert_eq!(client.server.end_of_input(), 1);
    assert_eq!(client.request("shutdown", Value::Null), Value::Null);
    assert_eq!(
        code(&client.ask("textDocument/hover", json!({}))),
        Some(-32600)
    );
    client.notify("exit", Value::Null);
    assert_eq!(client.all(), [0; 0]);
    assert_eq!(client.server.exit_code(), Some(0));
    let mut client = Client::with(TEXT);
    client.notify("exit", Value::Null);
    client.all();
    assert_eq!(client.server.exit_code(), Some(1));
}

#[test]
fn a_cancelled_request_has_an_error_and_others_have_answers() {
    let mut client = Client::with(TEXT);
    client.all();
    for id in ["a", "b"] {
        let params = json!({ "textDocument": { "uri": URI } });
        let message = json!({ "jsonrpc": "2.0", "id": id, "method": "textDocument/foldingRange", "params": params });
        client.server.receive(&message.to_string());
    }
    client.notify("$/cancelRequest", json!({ "id": "a" }));
    client.notify("$/cancelRequest", json!({ "id": "never" }));
    let all = client.all();
    assert_eq!(all.len(), 2);
    assert_eq!(
        (&all[0]["id"], &all[0]["error"]["code"]),
        (&json!("a"), &json!(-32800))
    );
    assert!(all[1]["id"] == "b" && all[1]["result"].is_array());
}

#[test]
fn findings_follow_each_keystroke_and_are_sent_once_for_those_that_wait() {
    let mut client = Client::with(TEXT);
    let before = client.codes(URI);
    assert!(!before.contains(&"E0412".to_owned()), "{before:?}");
    let start = place(TEXT, "DefaultValue=|7");
    let mut end = start.clone();
    end["character"] = json!(start["character"].as_u64().unwrap() + 1);
    client.others.clear();
    client.change(
        URI,
        json!({ "range": { "start": start, "end": end }, "text": "70" }),
    );
    end["character"] = json!(start["character"].as_u64().unwrap() + 2);
    client.change(
        URI,
        json!({ "range": { "start": start, "end": end }, "text": "700" }),
    );
    let all = client.diagnostics(URI);
    assert_eq!(client.others.len(), 1, "one check for two changes");
    assert_eq!(client.others[0]["params"]["version"], 3);
    let fault = all.iter().find(|one| one["code"] == "E0412").unwrap();
    assert_eq!(
        (&fault["severity"], &fault["source"]),
        (&json!(1), &json!("odkit"))
    );
    assert_eq!(fault["range"]["start"], start);
    let related = &fault["relatedInformation"][0];
    assert_eq!(related["message"], "declared as UNSIGNED8 here");
    assert_eq!(related["location"]["uri"], URI);
    assert!(
        fault["message"]
            .as_str()
            .unwrap()
            .contains("help: write a number from 0 to 255")
    );
    client.notify(
        "textDocument/didClose",
        json!({ "textDocument": { "uri": URI } }),
    );
    assert_eq!(client.codes(URI), [""; 0]);
}

#[test]
fn places_are_counted_in_the_unit_agreed_on() {
    let text = "[2000]\nParameterName=µ😀 x\nDataType=5 ; 😀\nDefaultValue=300\nAccessType=😀z\n";
    for (offered, unit, character) in [
        (json!(["utf-8", "utf-16"]), "utf-8", 11),
        (json!(["utf-16"]), "utf-16", 11),
    ] {
        let mut client = Client::raw(Files::default());
        let capabilities = json!({ "general": { "positionEncodings": offered } });
        let result = client.request("initialize", json!({ "capabilities": capabilities }));
        assert_eq!(result["capabilities"]["positionEncoding"], unit);
        client.open(URI, text);
        let all = client.diagnostics(URI);
        let fault = all.iter().find(|one| one["code"] == "E0405").unwrap();
        assert_eq!(
            fault["range"]["start"],
            json!({ "line": 4, "character": character })
        );
        let end = if unit == "utf-8" { 16 } else { 14 };
        assert_eq!(fault["range"]["end"]["character"], end);
        // The character behind two that are longer in UTF-8.
        let at = if unit == "utf-8" { 20 } else { 17 };
        let range = json!({ "start": { "line": 1, "character": at }, "end": { "line": 1, "character": at + 2 } });
        client.change(URI, json!({ "range": range, "text": "!" }));
        let symbols = client.of("textDocument/documentSymbol");
        assert_eq!(symbols[0]["name"], "2000h µ😀!");
    }
}

#[test]
fn fixes_remove_what_they_are_about() {
    let text = "[2000]\nParameterName=a\nDataType:5\nAccessType=rw\nDefaultValue=300\n";
    let mut client = Client::with(text);
    let range = |line: u32| json!({ "start": { "line": line, "character": 0 }, "end": { "line": line, "character": 3 } });
    let ask = |client: &mut Client, line, only: Value| {
        let context = json!({ "diagnostics": [], "only": only });
        let params =
            json!({ "textDocument": { "uri": URI }, "range": range(line), "context": context });
        client.request("textDocument/codeAction", params)
    };
    let found = ask(&mut client, 2, Value::Null);
    let fix = found
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["isPreferred"] == true)
        .unwrap();
    assert_eq!(fix["kind"], "quickfix");
    let code = fix["diagnostics"][0]["code"].as_str().unwrap().to_owned();
    let fixed = edited(text, &fix["edit"]["changes"][URI]);
    assert!(fixed.contains("DataType=5"), "{fixed}");
    assert!(client.codes(URI).contains(&code));
    client.change(URI, json!({ "text": fixed }));
    assert!(!client.codes(URI).contains(&code));
    // A comment that allows what has no fix.
    let found = ask(&mut client, 4, json!(["quickfix"]));
    let allow = found
        .as_array()
        .unwrap()
        .iter()
        .find(|one| one["title"].as_str().unwrap().starts_with("Allow E0412"));
    let allowed = edited(&fixed, &allow.unwrap()["edit"]["changes"][URI]);
    assert!(
        allowed.starts_with("[2000]\n;odkit-allow=E0412 reason\nParameterName"),
        "{allowed}"
    );
    client.change(URI, json!({ "text": allowed }));
    assert!(!client.codes(URI).contains(&"E0412".to_owned()));
    assert_eq!(ask(&mut client, 2, json!(["refactor"])), json!([]));
}

#[test]
fn all_safe_fixes_at_once_are_those_of_check() {
    let text = "[2000]\r\nParameterName=a\r\nDataType:5\r\nDefaultValue:1\r\nAccessType=rw\r\n";
    let file = od_eds::Document::new(text);
    let expected = od_eds::fix::fix(&file, od_eds::fix::Applicability::Safe, |file| {
        file.load().findings
    });
    for lazy in [false, true] {
        let properties = if lazy { json!(["edit"]) } else { json!([]) };
        let support = json!({ "textDocument": { "codeAction": { "resolveSupport": { "properties": properties } } } });
        let mut client = Client::new(Files::default(), support);
        client.open(URI, text);
        let context = json!({ "diagnostics": [], "only": ["source.fixAll"] });
        let range =
            json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 0, "character": 0 } });
        let params = json!({ "textDocument": { "uri": URI }, "range": range, "context": context });
        let found = client.request("textDocument/codeAction", params);
        let mut action = found[0].clone();
        assert_eq!(action["kind"], "source.fixAll.odkit");
        assert_eq!(action.get("edit").is_none(), lazy);
        if lazy {
            action = client.request("codeAction/resolve", action);
        }
        assert_eq!(
            edited(text, &action["edit"]["changes"][URI]),
            expected.document.text()
        );
    }
}

#[test]
fn settings_of_the_project_are_honoured() {
    let text = "[2000]\nParameterName=a\nDataType=5\nDefaultValue=300\n";
    let mut client = Client::new(Files::default(), json!({}));
    client.open("file:///w/quiet.eds", text);
    assert!(
        !client
            .codes("file:///w/quiet.eds")
            .contains(&"E0412".into())
    );
    client.open("file:///w/misused.eds", text);
    assert!(
        client
            .codes("file:///w/misused.eds")
            .contains(&"E0412".into())
    );
    let shown = |message: &&Value| message["method"] == "window/showMessage";
    assert_eq!(client.others.iter().filter(shown).count(), 1);
    client.change("file:///w/misused.eds", json!({ "text": text }));
    client.all();
    assert_eq!(client.others.iter().filter(shown).count(), 1, "said once");
}

#[test]
fn a_hover_says_what_is_there() {
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
fn completion_offers_what_is_missing() {
    let mut client = Client::with(TEXT);
    let found = client.at("textDocument/completion", TEXT, "DataType=|0x0007");
    assert!(labels(&found).contains(&"0x001B"));
    let type_edit = &found["items"][0]["textEdit"];
    assert_eq!(covered(TEXT, &type_edit["range"]), "0x0007");
    let found = client.at("textDocument/completion", TEXT, "AccessType=|const");
    assert_eq!(labels(&found), ["ro", "wo", "rw", "rwr", "rww", "const"]);
    let found = client.at("textDocument/completion", TEXT, "DefaultValue=|0x60040020");
    assert_eq!(labels(&found), ["0x60000010", "0x60040020"]);
    // Mandatory objects first, with their keys.
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
fn an_index_is_renamed_everywhere() {
    let mut client = Client::with(TEXT);
    let rename = |client: &mut Client, mark: &str, name: &str| {
        let position = place(TEXT, mark);
        let params =
            json!({ "textDocument": { "uri": URI }, "position": position, "newName": name });
        client.ask("textDocument/rename", params)
    };
    let found = client.at("textDocument/prepareRename", TEXT, "0x60|040020");
    assert_eq!(
        (covered(TEXT, &found["range"]), &found["placeholder"]),
        ("6004", &json!("6004"))
    );
    assert_eq!(
        client.at("textDocument/prepareRename", TEXT, "FileNam|e"),
        Value::Null
    );
    for mark in ["[60|04]", "0x60|040020", "=0x60|04\n"] {
        let found = rename(&mut client, mark, "6008");
        let text = edited(TEXT, &found["result"]["changes"][URI]);
        assert_eq!(text, TEXT.replace("6004", "6008"), "{mark}");
    }
    // Into another list: the entries behind it move up, and both are counted.
    let found = rename(&mut client, "[60|00]", "0x2000");
    let text = edited(TEXT, &found["result"]["changes"][URI]);
    let (before, after) = (od_eds::load(TEXT), od_eds::load(&text));
    assert_eq!(
        before.description.objects.len(),
        after.description.objects.len()
    );
    assert!(after.description.objects.contains_key(&0x2000));
    let lists = |found: &od_eds::Parsed| {
        let own = found
            .findings
            .iter()
            .filter(|one| one.code()[1..].starts_with("02"));
        own.count()
    };
    assert_eq!(lists(&after), lists(&before), "{text}");
    for name in ["6004", "0", "12345", "x", "", "6000 "] {
        let answer = rename(&mut client, "[60|04]", name);
        let nothing = answer["result"]["changes"][URI] == json!([]);
        assert!(
            nothing || answer["error"]["message"].is_string(),
            "{name}: {answer}"
        );
    }
    assert!(
        rename(&mut client, "[60|04]", "6000")["error"].is_object(),
        "it exists"
    );
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

#[test]
fn the_canonical_form_keeps_comments_and_is_made_once() {
    let text = "; top\r\n[2000]\r\n;odkit-allow=W0311 mine\r\nDataType = 0x5 ; eight bits\r\n\
        ; a name\r\nParameterName=a\r\nnonsense\r\nAccessType=rw\r\nAccessType=ro\r\n; end\r\n";
    let mut client = Client::with(text);
    let params = json!({ "textDocument": { "uri": URI }, "options": { "tabSize": 4, "insertSpaces": true } });
    let edits = client.request("textDocument/formatting", params.clone());
    let once = edited(text, &edits);
    for line in [
        "; top",
        ";odkit-allow=W0311 mine",
        "; eight bits\r\nDataType=0x0005",
        "; a name\r\nParameterName=a",
        ";nonsense",
        ";AccessType=ro",
        "; end",
        "[FileInfo]",
    ] {
        assert!(once.contains(line), "{line}: {once}");
    }
    assert_eq!(once.matches('\n').count(), once.matches("\r\n").count());
    let objects = |text: &str| od_eds::parse(text).description.objects;
    assert_eq!(objects(text), objects(&once));
    client.change(URI, json!({ "text": once }));
    assert_eq!(client.request("textDocument/formatting", params), json!([]));
}

#[test]
fn tokens_and_their_differences() {
    let mut client = Client::with(TEXT);
    let full = client.of("textDocument/semanticTokens/full");
    let mut data: Vec<u64> = serde_json::from_value(full["data"].clone()).unwrap();
    assert!(data.len() > 500 && data.len().is_multiple_of(5));
    // The first two lines are comments.
    assert_eq!(
        &data[..5],
        [0, 0, TEXT.lines().next().unwrap().len() as u64, 4, 0]
    );
    let start = place(TEXT, "ParameterName=|Device");
    client.change(
        URI,
        json!({ "range": { "start": start, "end": start }, "text": "My " }),
    );
    let params = json!({ "textDocument": { "uri": URI }, "previousResultId": full["resultId"] });
    let delta = client.request("textDocument/semanticTokens/full/delta", params);
    assert_eq!(delta["edits"].as_array().unwrap().len(), 1);
    let edit = &delta["edits"][0];
    let new: Vec<u64> = serde_json::from_value(edit["data"].clone()).unwrap();
    let (at, gone) = (
        edit["start"].as_u64().unwrap() as usize,
        edit["deleteCount"].as_u64().unwrap() as usize,
    );
    assert_eq!(new.len(), 1);
    data.splice(at..at + gone, new);
    let again = client.of("textDocument/semanticTokens/full");
    assert_eq!(json!(data), again["data"]);
    let params = json!({ "textDocument": { "uri": URI }, "previousResultId": "unknown" });
    let whole = client.request("textDocument/semanticTokens/full/delta", params);
    assert_eq!(whole["data"], again["data"]);
    let range =
        json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 1, "character": 1 } });
    let some = client.request(
        "textDocument/semanticTokens/range",
        json!({ "textDocument": { "uri": URI }, "range": range }),
    );
    assert_eq!(some["data"].as_array().unwrap().len(), 10);
}

#[test]
fn xdd_and_overlays_have_findings() {
    let mut files = Files::default();
    files.0.insert("/w/base.eds".into(), TEXT.into());
    let mut client = Client::new(files, json!({}));
    let xdd = "<?xml version=\"1.0\"?>\n<ISO15745ProfileContainer/>";
    client.open("file:///w/a.xdd", xdd);
    assert!(!client.codes("file:///w/a.xdd").is_empty());
    let uri = "file:///w/small.overlay";
    client.open(uri, "[2001]\nDefaultValue=700\n");
    let found = client.diagnostics(uri);
    let fault = found.iter().find(|one| one["code"] == "E0412").unwrap();
    assert_eq!(
        fault["range"]["start"],
        json!({ "line": 1, "character": 13 })
    );
    client.change(
        uri,
        json!({ "text": "; odkit-base=nothing.eds\n[2001]\nDefaultValue=700\n" }),
    );
    assert_eq!(client.codes(uri), [""; 0]);
}

#[test]
fn calls_of_the_macro_know_the_objects_of_their_file() {
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
    assert_eq!(said, [("E0707", "300"), ("E0701", "0x7777")]);
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

/// Whatever is typed, at whatever place something is asked: an answer comes.
#[test]
fn nothing_stops_the_server() {
    let mut seed = 1u64;
    let mut random = move |below: usize| {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 33) as usize % below.max(1)
    };
    let pieces = [
        "[",
        "]",
        "=",
        "\r",
        "\n",
        "\r\n",
        "$NODEID",
        "0x60040020",
        "µ😀",
        "[1A00sub1]\nDefaultValue=",
        "\0",
        "ObjectType=",
        "[1600Value]\n1=",
        "object_dictionary! { mod a { eds = \"a.eds\"; add ",
        "\u{FEFF}",
        "'",
        "\"",
        "/*",
        ";",
    ];
    let methods = [
        "hover",
        "completion",
        "definition",
        "references",
        "prepareRename",
        "rename",
        "documentSymbol",
        "foldingRange",
        "formatting",
        "inlayHint",
        "semanticTokens/full",
        "semanticTokens/range",
        "codeAction",
        "documentHighlight",
    ];
    for uri in [
        URI,
        "file:///w/a.rs",
        "file:///w/a.overlay",
        "file:///w/a.xdd",
    ] {
        let mut files = Files::default();
        files.0.insert("/w/a.eds".into(), TEXT.into());
        let mut client = Client::new(files, json!({}));
        client.open(uri, &TEXT[..1200]);
        for _ in 0..60 {
            let mut at = || json!({ "line": random(80), "character": random(30) });
            let range = json!({ "start": at(), "end": at() });
            let (position, piece) = (at(), pieces[random(pieces.len())]);
            client.change(uri, json!({ "range": range, "text": piece }));
            let method = format!("textDocument/{}", methods[random(methods.len())]);
            let params = json!({ "textDocument": { "uri": uri }, "position": position, "range": range,
                "newName": "2345", "context": { "diagnostics": [] }, "options": {} });
            client.ask(&method, params);
        }
    }
}
