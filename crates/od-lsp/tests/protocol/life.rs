//! Messages in and out of order, settings, and unexpected input.

use serde_json::{Value, json};

use crate::support::{Client, Files, TEXT, URI, place};

#[test]
fn messages_in_and_out_of_order_have_an_answer() {
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
fn a_cancelled_request_has_an_error_and_other_requests_an_answer() {
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

/// Whatever is typed, and wherever a request points, there is an answer.
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
        for _ in 0..40 {
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
