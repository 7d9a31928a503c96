//! The language server in a page, and other functions of an editor.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use od_eds::diff::{Impact, compare};
use od_eds::{Document, Edit, Finding, Tables, check};
use od_lsp::{Host, Server};
use od_model::Refused;
use wasm_bindgen::prelude::*;

use crate::crossing::{Crosses, record};
use crate::record::Record;

record! {
    /// A difference between a device and its replacement that a master notices.
    Difference {
        /// `6001h`, or `1018h:02`.
        place: String,
        name: String,
        /// `default 0 -> 5`.
        change: String,
        /// Whether a master that was configured for the first device may fail.
        breaking: bool,
    }
}

/// Files of the page; there are no project settings.
#[derive(Clone, Default)]
struct Files(Rc<RefCell<BTreeMap<String, Vec<u8>>>>);

impl Host for Files {
    fn read(&self, path: &str) -> Option<Vec<u8>> {
        self.0.borrow().get(path).cloned()
    }

    fn beside(&self, _: &str) -> Vec<String> {
        self.0.borrow().keys().cloned().collect()
    }

    fn judge(&self, _: &str, _: &mut Vec<Finding>) -> Result<(), Refused> {
        Ok(())
    }
}

/// The server of `odkit lsp`: Language Server Protocol 3.17, each message is
/// a JSON text without headers.
#[wasm_bindgen]
pub struct LanguageServer {
    server: Server,
    files: Files,
}

#[wasm_bindgen]
impl LanguageServer {
    /// A server without files.
    #[allow(clippy::new_without_default)]
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        let files = Files::default();
        Self {
            server: Server::new(Box::new(files.clone())),
            files,
        }
    }

    /// Gives the server the bytes of a file on the disk: it reports an encoding that the
    /// text in the editor does not show. `path` is the one of the file's URI.
    pub fn put(&mut self, path: String, bytes: Vec<u8>) {
        self.files.0.borrow_mut().insert(path, bytes);
    }

    /// Handles a message. Waiting messages are answered by [`step`](Self::step), and a file is
    /// checked once for all changes in them.
    pub fn receive(&mut self, message: &str) {
        self.server.receive(message);
    }

    /// Does one pending step; returns `false` if there is none.
    pub fn step(&mut self) -> bool {
        self.server.step()
    }

    /// Returns the next message of the server; `undefined` if none waits.
    pub fn poll(&mut self) -> Option<String> {
        self.server.poll()
    }
}

/// Returns the EDS of a built-in device; `undefined` if there is none.
#[wasm_bindgen(js_name = deviceEds)]
pub fn device_eds(name: &str) -> Option<String> {
    od_devices::find(name).map(od_devices::text::eds)
}

/// Returns the differences that a master notices if the device of one EDS text replaces the device of
/// another, like `odkit diff`.
#[wasm_bindgen(js_name = compareEds, unchecked_return_type = "Difference[]")]
pub fn compare_eds(before: &str, after: &str) -> Vec<JsValue> {
    let tables = |text| Tables::new(&od_eds::load(text).description);
    let found = compare(tables(before).dictionary(), tables(after).dictionary());
    let difference = |one: od_eds::diff::Difference| Difference {
        place: one.place().to_string(),
        change: one.change().to_string(),
        breaking: one.impact == Impact::Breaking,
        name: one.name,
    };
    let found = found.into_iter().map(difference);
    found.map(Crosses::value).collect()
}

/// Returns the bytes of a file with a new text, in the encoding of the file.
#[wasm_bindgen(js_name = encodeEds)]
pub fn encode_eds(file: &[u8], text: &str) -> Vec<u8> {
    let mut document = Document::new(file);
    let edit = Edit {
        range: 0..document.text().len(),
        text: text.into(),
    };
    match document.apply(&[edit]) {
        Ok(()) => document.bytes().into(),
        // A character that the encoding does not have.
        Err(_) => text.into(),
    }
}

/// Returns the titles of all rules by code.
#[wasm_bindgen(js_name = ruleTitles, unchecked_return_type = "Record<string, string>")]
pub fn rule_titles() -> JsValue {
    let titles = Record::new();
    for rule in check::all() {
        titles.set(rule.code, rule.title.into());
    }
    titles.done()
}
