//! A node list and the files that it names.

use serde_json::json;

use crate::support::{Client, Files};

const LIST: &str = "file:///w/nodelist.cpj";
const DCF: &str = "file:///w/n4.dcf";

const TEXT: &str = "[Topology]\nNodes=1\nNode4Present=yes\nNode4DCFName=n4.dcf\n";

/// A DCF for this node ID.
fn dcf(id: u8) -> String {
    format!("[DeviceComissioning]\nNodeID={id}\nBaudrate=500\n[1000]\nDataType=7\nDefaultValue=0\n")
}

/// A client with a list, whose DCF on the disk is for node 4.
fn client(text: &str) -> Client {
    let mut files = Files::default();
    files.0.insert("/w/n4.dcf".into(), dcf(4).into_bytes());
    let mut client = Client::new(files, json!({}));
    client.open(LIST, text);
    client
}

#[test]
fn a_node_list_is_checked_with_the_unsaved_text_of_a_dcf() {
    let mut client = client(TEXT);
    assert_eq!(client.codes(LIST), ["W1207"]);
    client.open(DCF, &dcf(4));
    assert_eq!(client.codes(LIST), ["W1207"]);
    client.change(DCF, json!({ "text": dcf(5) }));
    let all = client.diagnostics(LIST);
    let message = all[1]["message"].as_str().expect("a message");
    assert!(message.contains("NodeID is 5 in the DCF"), "{message}");
    assert_eq!(
        (&all[1]["severity"], &all[1]["range"]["start"]["line"]),
        (&json!(1), &json!(3))
    );
}

#[test]
fn what_cannot_be_read_is_shown_at_its_line() {
    let mut client = client("[Topology]\nNode5Present=1\nNode5DCFName=none.dcf\n");
    let all = client.diagnostics(LIST);
    assert_eq!(all.len(), 1, "{all:?}");
    assert_eq!(all[0]["range"]["start"]["line"], 2);
    let message = all[0]["message"].as_str().expect("a message");
    assert!(message.contains("none.dcf: it cannot be read"), "{message}");
}

#[test]
fn a_node_list_has_quick_fixes() {
    let mut client = client(TEXT);
    let line = json!({ "line": 2, "character": 0 });
    let params = json!({
        "textDocument": { "uri": LIST },
        "range": { "start": line, "end": line },
        "context": { "diagnostics": [] },
    });
    let actions = client.request("textDocument/codeAction", params);
    let edits: Vec<_> = actions
        .as_array()
        .expect("actions")
        .iter()
        .map(|action| {
            let edit = &action["edit"]["changes"][LIST][0];
            (
                action["title"].as_str().expect("a title"),
                edit["newText"].as_str().expect("a text"),
            )
        })
        .collect();
    assert_eq!(
        edits,
        [
            (
                "Fix W1207: write 1 if the node is present, otherwise 0 (odkit assumes 1)",
                "1"
            ),
            ("Apply all safe fixes of odkit", "Node4Present=1\n"),
        ]
    );
}
