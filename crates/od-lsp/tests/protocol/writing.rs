//! Rename, formatting and tokens.

use serde_json::{Value, json};

use crate::support::{Client, Files, TEXT, URI, covered, edited, place};

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
    // In another list: later entries move up, and both lists are counted.
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
fn formatting_keeps_comments_and_is_stable() {
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

const OVERLAY: &str = "file:///w/small.overlay";

/// A client with an overlay of the device, and with the device where `is_open`.
fn above(is_open: bool, overlay: &str) -> Client {
    let mut files = Files::default();
    files.0.insert("/w/a.eds".into(), TEXT.into());
    let mut client = Client::new(files, json!({}));
    client.open(OVERLAY, overlay);
    if is_open {
        client.open(URI, TEXT);
    }
    client
}

#[test]
fn an_overlay_leads_to_its_base() {
    let overlay = "[2001]\nDefaultValue=8\n[1A00sub1]\nDefaultValue=0x60040020\n";
    for is_open in [false, true] {
        let mut client = above(is_open, overlay);
        for (mark, expected) in [
            ("[20|01]", "[2001]"),
            ("[1A00s|ub1]", "[1A00sub1]"),
            ("0x60|040020", "[6004]"),
        ] {
            let params =
                json!({ "textDocument": { "uri": OVERLAY }, "position": place(overlay, mark) });
            let found = client.request("textDocument/definition", params);
            assert_eq!(found[0]["uri"], URI, "{mark}");
            assert_eq!(covered(TEXT, &found[0]["range"]), expected, "{mark}");
        }
        let params =
            json!({ "textDocument": { "uri": OVERLAY }, "position": place(overlay, "[20|01]") });
        let found = client.request("textDocument/references", params);
        let uris: Vec<_> = found
            .as_array()
            .unwrap()
            .iter()
            .map(|one| &one["uri"])
            .collect();
        assert_eq!(
            uris,
            [OVERLAY, URI, URI],
            "its sections, and the entry of the list"
        );
    }
}

#[test]
fn a_rename_reaches_base_and_overlay() {
    let overlay = ";odkit-base=a.eds\n[2001]\nDefaultValue=8\n";
    for (uri, text) in [(OVERLAY, overlay), (URI, TEXT)] {
        let mut client = above(true, overlay);
        let params = json!({
            "textDocument": { "uri": uri },
            "position": place(text, "[20|01]"),
            "newName": "2005",
        });
        let found = client.request("textDocument/rename", params);
        let base = edited(TEXT, &found["changes"][URI]);
        assert!(
            base.contains("[2005]") && base.contains("1=0x2005"),
            "{base}"
        );
        let above = edited(overlay, &found["changes"][OVERLAY]);
        assert_eq!(above, overlay.replace("[2001]", "[2005]"));
    }
}

/// A fix whose edits are all in the overlay is a quick fix there.
#[test]
fn an_overlay_has_quick_fixes() {
    let overlay = "[2001]\nAccessType=r0\n";
    let mut client = above(false, overlay);
    let line = json!({ "line": 1, "character": 0 });
    let params = json!({
        "textDocument": { "uri": OVERLAY },
        "range": { "start": line, "end": line },
        "context": { "diagnostics": [] },
    });
    let actions = client.request("textDocument/codeAction", params);
    let edit = &actions[0]["edit"]["changes"][OVERLAY][0];
    assert_eq!(
        (&edit["newText"], &edit["range"]["start"]["line"]),
        (&json!("ro"), &json!(1))
    );
}
