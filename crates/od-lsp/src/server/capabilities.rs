//! Initialization: the capabilities of the client and of the server.

use serde_json::{Value, json};

use super::Server;
use crate::features::actions::FIX_ALL;
use crate::features::tokens;
use crate::message;
use crate::text::Unit;

impl Server {
    /// Notes the capabilities of the client, and answers with those of the server.
    pub(super) fn initialize(&mut self, params: &Value) -> Value {
        let can = |pointer: &str| params.pointer(&format!("/capabilities/{pointer}"));
        let units = can("general/positionEncodings").and_then(Value::as_array);
        let mut units = units.into_iter().flatten().filter_map(Value::as_str);
        if units.any(|name| name == Unit::Utf8.name()) {
            self.unit = Unit::Utf8;
        }
        let lazy = can("textDocument/codeAction/resolveSupport/properties");
        let lazy = lazy.and_then(Value::as_array);
        self.later = lazy.is_some_and(|lazy| lazy.iter().any(|own| own == "edit"));
        let watches = can("workspace/didChangeWatchedFiles/dynamicRegistration");
        self.watches = watches == Some(&Value::Bool(true));
        let prepare = can("textDocument/rename/prepareSupport") == Some(&Value::Bool(true));
        json!({
            "serverInfo": { "name": "odkit", "version": env!("CARGO_PKG_VERSION") },
            "capabilities": {
                "positionEncoding": self.unit.name(),
                "textDocumentSync": { "openClose": true, "change": 2, "save": { "includeText": false } },
                "hoverProvider": true,
                "completionProvider": { "triggerCharacters": ["[", "=", "\"", "x"] },
                "definitionProvider": true,
                "referencesProvider": true,
                "documentHighlightProvider": true,
                "documentSymbolProvider": true,
                "foldingRangeProvider": true,
                "documentFormattingProvider": true,
                "inlayHintProvider": true,
                "renameProvider": if prepare { json!({ "prepareProvider": true }) } else { json!(true) },
                "codeActionProvider": {
                    "codeActionKinds": ["quickfix", FIX_ALL],
                    "resolveProvider": true,
                },
                "semanticTokensProvider": {
                    "legend": { "tokenTypes": tokens::LEGEND, "tokenModifiers": [] },
                    "range": true,
                    "full": { "delta": true },
                },
            },
        })
    }

    /// Requests notifications about files that the client has not opened.
    pub(super) fn watch(&mut self) {
        if !self.watches {
            return;
        }
        let patterns = ["**/odkit.toml", "**/*.{eds,dcf,xdd,xdc,overlay,EDS,DCF}"];
        let watchers = patterns.map(|pattern| json!({ "globPattern": pattern }));
        let params = json!({
            "registrations": [{
                "id": "files",
                "method": "workspace/didChangeWatchedFiles",
                "registerOptions": { "watchers": watchers },
            }],
        });
        let text = message::request("files", "client/registerCapability", &params);
        self.outbox.push_back(text);
    }
}
