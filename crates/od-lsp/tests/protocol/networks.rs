//! A node list and the files that it names.

use serde_json::json;

use crate::support::{Client, Files, place};

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

/// The count of nodes is only safe to correct when the word for 1 is.
#[test]
fn all_safe_fixes_of_a_node_list_are_made_at_once() {
    let text = TEXT.replace("Nodes=1", "Nodes=0");
    let mut client = client(&text);
    let line = json!({ "line": 0, "character": 0 });
    let params = json!({
        "textDocument": { "uri": LIST },
        "range": { "start": line, "end": line },
        "context": { "diagnostics": [], "only": ["source.fixAll"] },
    });
    let actions = client.request("textDocument/codeAction", params);
    let edits = actions[0]["edit"]["changes"][LIST].as_array();
    let mut lines: Vec<&str> = text.lines().collect();
    for edit in edits.expect("edits") {
        let first = edit["range"]["start"]["line"].as_u64().expect("a line") as usize;
        let new = edit["newText"].as_str().expect("a text").trim_end();
        let last = edit["range"]["end"]["line"].as_u64().expect("a line") as usize;
        lines.splice(first..last, new.lines());
    }
    assert_eq!(lines[1..3], ["Nodes=0x01", "Node4Present=1"], "{edits:?}");
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

const BUS: &str = "file:///w/bus.yml";

const PROJECT: &str = "master:\n  node_id: 1\nnodes:\n  left: {dcf: n4.dcf, node_id: 4}\n  right:\n    dcf: \"./n4.dcf\"\n    hea\n";

/// Params of a request at the mark `|` in a text.
fn at(uri: &str, text: &str, mark: &str) -> serde_json::Value {
    json!({ "textDocument": { "uri": uri }, "position": place(text, mark) })
}

#[test]
fn a_key_of_a_network_is_explained() {
    let mut client = client(TEXT);
    client.open(BUS, PROJECT);
    for (uri, text, mark, part) in [
        (LIST, TEXT, "Node4Pre|sent", "if the node is present"),
        (LIST, TEXT, "Nod|es=", "Number of nodes"),
        (LIST, TEXT, "[Topo|logy]", "CiA 306-3"),
        (BUS, PROJECT, "  node_i|d: 1", "Node ID of the master"),
        (BUS, PROJECT, "node_id: |4", "Node ID, 1 to 127"),
    ] {
        let hover = client.request("textDocument/hover", at(uri, text, mark));
        let said = hover["contents"]["value"].as_str().unwrap_or_default();
        assert!(said.contains(part), "{mark}: {said}");
    }
}

#[test]
fn a_network_has_an_outline_and_leads_to_its_files() {
    let mut client = client(TEXT);
    client.open(BUS, PROJECT);
    for (uri, text, mark) in [
        (LIST, TEXT, "=n4|.dcf"),
        (BUS, PROJECT, "{dcf: n|4"),
        (BUS, PROJECT, "./n4|.dcf"),
    ] {
        let found = client.request("textDocument/definition", at(uri, text, mark));
        assert_eq!(found[0]["uri"], DCF, "{mark}");
    }
    let none = client.request("textDocument/definition", at(BUS, PROJECT, "node_id: 4|}"));
    assert_eq!(none, json!([]));
    for (uri, names) in [
        (LIST, &["Topology"][..]),
        (BUS, &["master", "nodes", "left", "right"]),
    ] {
        let params = json!({ "textDocument": { "uri": uri } });
        let symbols = client.request("textDocument/documentSymbol", params);
        let symbols = symbols.as_array().expect("symbols").iter();
        let found: Vec<_> = symbols
            .map(|one| one["name"].as_str().expect("a name"))
            .collect();
        assert_eq!(found, names);
    }
}

#[test]
fn keys_of_a_network_are_completed() {
    let list = format!("{TEXT}Node5\n");
    let mut client = client(&list);
    client.open(BUS, PROJECT);
    for (uri, text, mark, label, new) in [
        (
            LIST,
            list.as_str(),
            "Node5|\n",
            "Node5DCFName",
            "Node5DCFName=",
        ),
        (
            BUS,
            PROJECT,
            "    hea|\n",
            "heartbeat_producer",
            "heartbeat_producer: ",
        ),
        (BUS, PROJECT, "{d|cf:", "dcf", "dcf"),
    ] {
        let found = client.request("textDocument/completion", at(uri, text, mark));
        let items = found["items"].as_array().expect("items");
        let one = items.iter().find(|one| one["label"] == label);
        let one = one.unwrap_or_else(|| panic!("{mark}: {found}"));
        assert_eq!(one["textEdit"]["newText"], new, "{mark}");
    }
    let none = client.request("textDocument/completion", at(BUS, PROJECT, "node_id: 4|}"));
    assert_eq!(none["items"], json!([]));
}
