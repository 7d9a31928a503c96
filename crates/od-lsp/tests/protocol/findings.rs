//! Findings and their fixes.

use serde_json::{Value, json};

use crate::support::{Client, Files, TEXT, URI, edited, place};

#[test]
fn findings_follow_each_keystroke_and_waiting_changes_are_checked_once() {
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
fn positions_are_counted_in_the_agreed_unit() {
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
        // The character after two that are longer in UTF-8.
        let at = if unit == "utf-8" { 20 } else { 17 };
        let range = json!({ "start": { "line": 1, "character": at }, "end": { "line": 1, "character": at + 2 } });
        client.change(URI, json!({ "range": range, "text": "!" }));
        let symbols = client.of("textDocument/documentSymbol");
        assert_eq!(symbols[0]["name"], "2000h µ😀!");
    }
}

#[test]
fn a_fix_removes_its_finding() {
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
    // A comment allows a finding without a fix.
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
fn fix_all_makes_the_safe_fixes_of_check() {
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
}

/// A base that is missing or unsuitable is a finding at the line of the overlay that names it.
#[test]
fn an_overlay_without_a_base_has_a_finding() {
    let mut files = Files::default();
    files.0.insert("/w/base.eds".into(), TEXT.into());
    files.0.insert("/w/b.xdd".into(), "<a/>".into());
    let mut client = Client::new(files, json!({}));
    let uri = "file:///w/small.overlay";
    client.open(uri, "");
    for (text, line, expected) in [
        (
            "; odkit-base=nothing.eds\n[2001]\n",
            0,
            "nothing.eds cannot be read",
        ),
        (";odkit-base=small.overlay\n", 0, "cannot be its own base"),
        (";odkit-base=other.overlay\n", 0, "is an overlay, too"),
        (";odkit-base=b.xdd\n", 0, "the base is XML"),
        (
            ";\n\n[5999]\nRemove=1\n",
            2,
            "section [5999] to remove is missing",
        ),
    ] {
        client.change(uri, json!({ "text": text }));
        let found = client.diagnostics(uri);
        assert_eq!(found.len(), 1, "{text}: {found:?}");
        assert_eq!(found[0]["range"]["start"]["line"], line, "{text}");
        assert!(
            found[0]["message"].as_str().unwrap().contains(expected),
            "{found:?}"
        );
    }
    let text = ";odkit-base=nothing.eds\n[2001]\nDefaultValue=7\n";
    client.change(uri, json!({ "text": text }));
    let params = json!({ "textDocument": { "uri": uri }, "position": place(text, "[20|01]") });
    let hover = client.request("textDocument/hover", params);
    let hover = hover["contents"]["value"].as_str().unwrap_or_default();
    assert!(
        hover.contains("does not know the objects of this overlay"),
        "{hover}"
    );
    assert!(!hover.contains("does not define"), "{hover}");
    client.change(uri, json!({ "text": "[2001]\nDefaultValue=7\n" }));
    assert_eq!(client.codes(uri), [""; 0]);
    // Two files that could be the base.
    let mut files = Files::default();
    for name in ["/w/a.eds", "/w/b.dcf"] {
        files.0.insert(name.into(), TEXT.into());
    }
    let mut client = Client::new(files, json!({}));
    client.open(uri, "[2001]\n");
    let found = client.diagnostics(uri);
    assert!(
        found[0]["message"]
            .as_str()
            .unwrap()
            .contains(";odkit-base=my.eds"),
        "{found:?}"
    );
}

/// The overlay is checked with the text in the editor, which may not be saved yet.
#[test]
fn an_overlay_is_checked_with_the_unsaved_text_of_its_base() {
    let mut files = Files::default();
    files.0.insert("/w/a.eds".into(), TEXT.into());
    let mut client = Client::new(files, json!({}));
    let uri = "file:///w/small.overlay";
    client.open(uri, ";odkit-base=a.eds\n[2001]\nDefaultValue=700\n");
    assert!(client.codes(uri).contains(&"E0412".to_owned()));
    // UNSIGNED8 becomes UNSIGNED16, so 700 is valid.
    let section = TEXT.find("[2001]").unwrap();
    let (before, behind) = TEXT.split_at(section);
    let wide = format!(
        "{before}{}",
        behind.replacen("DataType=0x0005", "DataType=0x0006", 1)
    );
    assert_ne!(wide, TEXT);
    client.open(URI, &wide);
    assert!(!client.codes(uri).contains(&"E0412".to_owned()));
}
