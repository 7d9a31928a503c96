//! Rename, formatting and tokens.

use serde_json::{Value, json};

use crate::support::{Client, TEXT, URI, covered, edited, place};

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
