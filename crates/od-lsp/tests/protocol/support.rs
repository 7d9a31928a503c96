//! A client in the same process.

use std::collections::BTreeMap;

use od_eds::Finding;
use od_lsp::{Finder, Host, Server};
use od_model::Refused;
use serde_json::{Value, json};

/// Files by path.
#[derive(Default, Clone)]
pub(crate) struct Files(pub(crate) BTreeMap<String, Vec<u8>>);

impl Host for Files {
    fn read(&self, path: &str) -> Option<Vec<u8>> {
        self.0.get(path).cloned()
    }

    fn beside(&self, _: &str) -> Vec<String> {
        self.0.keys().cloned().collect()
    }

    fn judge(&self, path: &str, findings: &mut Vec<Finding>) -> Result<(), Refused> {
        if path.contains("misused") {
            return Err("odkit.toml: W9999 is not a rule".into());
        }
        findings.retain(|finding| !path.contains("quiet") || finding.code() != "E0412");
        Ok(())
    }

    fn network<'a>(
        &'a self,
        path: &'a str,
        find: &'a dyn Fn(&str) -> Option<Vec<u8>>,
    ) -> Finder<'a> {
        let (folder, _) = path.rsplit_once('/').unwrap_or_default();
        Box::new(move |text| {
            let lists = od_eds::network::node_lists(text, &|name| {
                let bytes = find(&format!("{folder}/{name}")).ok_or("it cannot be read")?;
                Ok(od_eds::parse(od_eds::Document::new(bytes).text()).description)
            });
            lists.into_iter().flat_map(|list| list.findings).collect()
        })
    }
}

pub(crate) struct Client {
    pub(crate) server: Server,
    id: i32,
    version: i64,
    /// Messages that are not responses.
    pub(crate) others: Vec<Value>,
}

/// A small device.
pub(crate) const TEXT: &str = include_str!("device.eds");

pub(crate) const URI: &str = "file:///w/a.eds";

impl Client {
    /// A client after initialization with these capabilities.
    pub(crate) fn new(files: Files, capabilities: Value) -> Self {
        let mut client = Self::raw(files);
        client.request("initialize", json!({ "capabilities": capabilities }));
        client.notify("initialized", json!({}));
        client
    }

    /// A client that has sent nothing yet.
    pub(crate) fn raw(files: Files) -> Self {
        Self {
            server: Server::new(Box::new(files)),
            id: 0,
            version: 1,
            others: Vec::new(),
        }
    }

    /// A client with an open file.
    pub(crate) fn with(text: &str) -> Self {
        let mut client = Self::new(Files::default(), json!({}));
        client.open(URI, text);
        client
    }

    pub(crate) fn open(&mut self, uri: &str, text: &str) {
        let document = json!({ "uri": uri, "languageId": "", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub(crate) fn change(&mut self, uri: &str, change: Value) {
        self.version += 1;
        let document = json!({ "uri": uri, "version": self.version });
        let params = json!({ "textDocument": document, "contentChanges": [change] });
        self.notify("textDocument/didChange", params);
    }

    pub(crate) fn notify(&mut self, method: &str, params: Value) {
        let message = json!({ "jsonrpc": "2.0", "method": method, "params": params });
        self.server.receive(&message.to_string());
    }

    /// Sends a request and returns the whole answer.
    pub(crate) fn ask(&mut self, method: &str, params: Value) -> Value {
        self.id += 1;
        let id = self.id;
        let message = json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": params });
        self.server.receive(&message.to_string());
        let mut answer = None;
        for message in self.all() {
            match message.get("method") {
                None if message["id"] == id => answer = Some(message),
                _ => self.others.push(message),
            }
        }
        answer.unwrap_or_else(|| panic!("{method} has no answer"))
    }

    /// Sends a request and returns its result.
    #[track_caller]
    pub(crate) fn request(&mut self, method: &str, params: Value) -> Value {
        let answer = self.ask(method, params);
        assert!(answer.get("error").is_none(), "{method}: {answer}");
        answer["result"].clone()
    }

    /// All messages that the server has now.
    pub(crate) fn all(&mut self) -> Vec<Value> {
        while self.server.step() {}
        let texts = std::iter::from_fn(|| self.server.poll());
        texts
            .map(|text| serde_json::from_str(&text).unwrap())
            .collect()
    }

    /// The last diagnostics of a file.
    pub(crate) fn diagnostics(&mut self, uri: &str) -> Vec<Value> {
        let new = self.all();
        self.others.extend(new);
        let mut own = self.others.iter().rev();
        let own = own.find(|message| {
            message["method"] == "textDocument/publishDiagnostics"
                && message["params"]["uri"] == uri
        });
        own.map(|own| own["params"]["diagnostics"].as_array().unwrap().clone())
            .unwrap_or_default()
    }

    pub(crate) fn codes(&mut self, uri: &str) -> Vec<String> {
        let all = self.diagnostics(uri);
        all.iter()
            .map(|one| one["code"].as_str().unwrap_or("").to_owned())
            .collect()
    }

    /// A request at the position of `mark` in the text, as [`place`] finds it.
    #[track_caller]
    pub(crate) fn at(&mut self, method: &str, text: &str, mark: &str) -> Value {
        self.request(
            method,
            json!({ "textDocument": { "uri": URI }, "position": place(text, mark) }),
        )
    }

    /// A request about the whole file.
    #[track_caller]
    pub(crate) fn of(&mut self, method: &str) -> Value {
        self.request(method, json!({ "textDocument": { "uri": URI } }))
    }
}

/// The position of `|` in `mark`; without it, `mark` is a part of an ASCII text.
#[track_caller]
pub(crate) fn place(text: &str, mark: &str) -> Value {
    let within = mark.find('|').unwrap();
    let plain = mark.replace('|', "");
    let at = text
        .find(&plain)
        .unwrap_or_else(|| panic!("{plain} is not in the text"))
        + within;
    let before = &text[..at];
    let line = before.matches('\n').count();
    let start = before.rfind('\n').map_or(0, |at| at + 1);
    json!({ "line": line, "character": at - start })
}

/// The text after edits of the protocol, in UTF-16.
pub(crate) fn edited(text: &str, edits: &Value) -> String {
    let offset = |place: &Value| {
        let line = place["line"].as_u64().unwrap() as usize;
        let starts: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let mut left = place["character"].as_u64().unwrap() as usize;
        let mut at = starts;
        for c in text[starts..].chars() {
            if left == 0 {
                break;
            }
            left -= c.len_utf16();
            at += c.len_utf8();
        }
        at
    };
    let mut edits: Vec<(usize, usize, String)> = edits
        .as_array()
        .unwrap()
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            let new = edit["newText"].as_str().unwrap().to_owned();
            (offset(&range["start"]), offset(&range["end"]), new)
        })
        .collect();
    edits.sort();
    let mut out = text.to_owned();
    for (start, end, new) in edits.into_iter().rev() {
        out.replace_range(start..end, &new);
    }
    out
}

/// The labels of a list.
pub(crate) fn labels(found: &Value) -> Vec<&str> {
    let items = found.get("items").unwrap_or(found).as_array().unwrap();
    items
        .iter()
        .map(|item| item["label"].as_str().unwrap())
        .collect()
}

/// The text in a range.
pub(crate) fn covered<'t>(text: &'t str, range: &Value) -> &'t str {
    let line = text
        .lines()
        .nth(range["start"]["line"].as_u64().unwrap() as usize)
        .unwrap();
    let at = |place: &Value| place["character"].as_u64().unwrap() as usize;
    &line[at(&range["start"])..at(&range["end"])]
}
