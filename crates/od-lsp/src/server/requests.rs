//! Passes requests about files to their features.

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{Open, Server};
use crate::features::{
    actions, complete, folding, format, hints, hover, jump, rename, symbols, tokens,
};
use crate::file::{File, Kind, Seen};
use crate::host::{Host, NoHost};
use crate::macros::features as macros;
use crate::message::{self, Fault};
use crate::types::{
    AtPosition, DeltaParams, DocumentId, Highlight, InRange, Location, OfDocument, PrepareRename,
    Range, Tokens, TokensDelta, TokensEdit, WorkspaceEdit,
};
use crate::uri;

fn read<T: DeserializeOwned>(params: Value) -> Result<T, Fault> {
    serde_json::from_value(params).map_err(|error| Fault::params(&error))
}

impl Server {
    fn open(&mut self, id: &DocumentId) -> Result<(&mut Open, &dyn Host), Fault> {
        self.lay(&id.uri);
        let host = &*self.host;
        match self.files.get_mut(&id.uri) {
            Some(open) => Ok((open, host)),
            None => Err(Fault::failed(format!("{} is not open", id.uri))),
        }
    }

    pub(super) fn request(
        &mut self,
        id: &Value,
        method: &str,
        params: Value,
    ) -> Result<String, Fault> {
        if let Some(text) = self.in_rust(id, method, &params) {
            return Ok(text);
        }
        match method {
            "textDocument/hover" => self.at(params, |file, seen, _, at| {
                Ok(message::answer(id, &hover::at(file, seen, at)))
            }),
            "textDocument/completion" => self.at(params, |file, seen, _, at| {
                Ok(message::answer(id, &complete::at(file, seen, at)))
            }),
            "textDocument/definition" => self.definition(id, params),
            "textDocument/references" => self.at(params, |file, seen, params, at| {
                let declared = params.context.include_declaration;
                let mut found = locations(file, jump::references(file, seen, at, declared));
                if let Some((base, others)) = jump::references_in_base(file, seen, at, declared) {
                    found.extend(locations(base, others));
                }
                Ok(message::answer(id, &found))
            }),
            "textDocument/documentHighlight" => self.at(params, |file, seen, _, at| {
                let found = jump::references(file, seen, at, true).into_iter();
                let found = found.map(|bytes| Highlight {
                    range: file.text.range(bytes),
                });
                Ok(message::answer(id, &found.collect::<Vec<_>>()))
            }),
            "textDocument/prepareRename" => self.at(params, |file, seen, _, at| {
                let found = rename::prepare(file, seen, at);
                let found = found.map(|(bytes, placeholder)| PrepareRename {
                    range: file.text.range(bytes),
                    placeholder,
                });
                Ok(message::answer(id, &found))
            }),
            "textDocument/rename" => self.rename(id, params),
            "textDocument/documentSymbol" => self.of(params, |file, seen| {
                let found = symbols::of(file, seen);
                Ok(message::answer(id, &found))
            }),
            "textDocument/foldingRange" => self.of(params, |file, seen| {
                Ok(message::answer(id, &folding::of(file, &seen.layout)))
            }),
            "textDocument/formatting" => self.of(params, |file, seen| {
                let edits = format::edits(file, seen).map_err(Fault::failed)?;
                Ok(message::answer(id, &edits))
            }),
            "textDocument/inlayHint" => self.within(params, |file, seen, _, bytes| {
                let found = hints::of(file, seen, bytes);
                Ok(message::answer(id, &found))
            }),
            "textDocument/semanticTokens/range" => self.within(params, |file, seen, _, bytes| {
                let data = tokens::of(file, &seen.layout, bytes);
                let result_id = None;
                Ok(message::answer(
                    id,
                    &Tokens {
                        result_id,
                        data: &data,
                    },
                ))
            }),
            "textDocument/semanticTokens/full" => {
                let params: OfDocument = read(params)?;
                self.tokens(id, &params.text_document, None)
            }
            "textDocument/semanticTokens/full/delta" => {
                let params: DeltaParams = read(params)?;
                self.tokens(id, &params.text_document, Some(&params.previous_result_id))
            }
            "textDocument/codeAction" => self.actions(id, params),
            "codeAction/resolve" => self.resolve(id, params),
            other => Err(Fault::unknown(other)),
        }
    }

    /// The answer to a request about a Rust source; `None` for requests that are answered as for
    /// an EDS.
    fn in_rust(&self, id: &Value, method: &str, params: &Value) -> Option<String> {
        let uri = params.pointer("/textDocument/uri")?.as_str()?;
        let file = &self.files.get(uri)?.file;
        if file.kind != Kind::Rust {
            return None;
        }
        let at: AtPosition = serde_json::from_value(params.clone()).ok()?;
        let offset = file.text.offset(at.position);
        let find = |path: &str| self.find(path);
        Some(match method {
            "textDocument/hover" => message::answer(id, &macros::hover(file, offset, &find)),
            "textDocument/definition" => {
                message::answer(id, &macros::definition(file, offset, &find))
            }
            "textDocument/completion" => {
                message::answer(id, &macros::complete(file, offset, &find))
            }
            _ => return None,
        })
    }

    /// A request about a file.
    fn of(
        &mut self,
        params: Value,
        answer: impl Fn(&File, &Seen) -> Result<String, Fault>,
    ) -> Result<String, Fault> {
        let params: OfDocument = read(params)?;
        let (open, host) = self.open(&params.text_document)?;
        answer(&open.file, open.file.seen(host))
    }

    /// A request about a position in a file.
    fn at(
        &mut self,
        params: Value,
        answer: impl Fn(&File, &Seen, &AtPosition, usize) -> Result<String, Fault>,
    ) -> Result<String, Fault> {
        let params: AtPosition = read(params)?;
        let (open, host) = self.open(&params.text_document)?;
        let offset = open.file.text.offset(params.position);
        answer(&open.file, open.file.seen(host), &params, offset)
    }

    /// A request about a range in a file.
    fn within(
        &mut self,
        params: Value,
        answer: impl Fn(&File, &Seen, &InRange, &std::ops::Range<usize>) -> Result<String, Fault>,
    ) -> Result<String, Fault> {
        let params: InRange = read(params)?;
        let (open, host) = self.open(&params.text_document)?;
        let bytes = open.file.text.bytes(params.range);
        answer(&open.file, open.file.seen(host), &params, &bytes)
    }

    /// The place that describes what a position is about, or the file that it names.
    fn definition(&mut self, id: &Value, params: Value) -> Result<String, Fault> {
        let params: AtPosition = read(params)?;
        let (open, host) = self.open(&params.text_document)?;
        let file = &open.file;
        let at = file.text.offset(params.position);
        let seen = file.seen(host);
        let named = jump::named_file(file, seen, at);
        let found = match (
            named.filter(|path| host.read(path).is_some()),
            jump::in_base(file, seen, at),
        ) {
            (Some(path), _) => vec![Location {
                uri: uri::of(&path, &file.uri),
                range: Range::default(),
            }],
            (None, Some((base, bytes))) => locations(base, vec![bytes]),
            (None, None) => locations(file, jump::definition(file, seen, at)),
        };
        Ok(message::answer(id, &found))
    }

    /// Gives an object another index, in its file, in the base below it, and in the open overlays above it.
    fn rename(&mut self, id: &Value, params: Value) -> Result<String, Fault> {
        let params: AtPosition = read(params)?;
        let (open, host) = self.open(&params.text_document)?;
        let file = &open.file;
        let (old, new) = rename::indices(file, file.seen(host), params.position, &params.new_name)
            .map_err(Fault::failed)?;
        let path = file.path.clone();
        let mut edit = WorkspaceEdit::of(&file.uri, Vec::new());
        let mut add = |file: &File, host: &dyn Host| {
            let edits = rename::edits(file, file.seen(host), old, new).map_err(Fault::failed)?;
            if !edits.is_empty() {
                edit.changes.insert(file.uri.clone(), edits);
            }
            Ok::<(), Fault>(())
        };
        add(file, host)?;
        if let Some(base) = file.below() {
            add(base, &NoHost)?;
        }
        let others: Vec<String> = self.files.keys().cloned().collect();
        for uri in others {
            self.lay(&uri);
            let open = self.files.get(&uri);
            let is_above = |open: &&Open| open.file.below().is_some_and(|base| base.path == path);
            if let Some(open) = open.filter(is_above) {
                add(&open.file, &*self.host)?;
            }
        }
        Ok(message::answer(id, &edit))
    }

    fn actions(&mut self, id: &Value, params: Value) -> Result<String, Fault> {
        let params: InRange = read(params)?;
        let (open, host) = self.open(&params.text_document)?;
        open.file.seen(host);
        let file = self.file(&params.text_document)?;
        let bytes = file.text.bytes(params.range);
        let only = params.context.only.as_deref();
        let fix_all = || self.fix_all(file);
        let seen = file.seen(&*self.host);
        let found = actions::of(file, seen, &fix_all, &bytes, only, self.later);
        Ok(message::answer(id, &found))
    }

    /// The edit of "fix all"; all other actions already have their edit.
    fn resolve(&mut self, id: &Value, mut action: Value) -> Result<String, Fault> {
        let uri = action
            .get("data")
            .and_then(Value::as_str)
            .map(str::to_owned);
        if let (Some(uri), Some(action)) = (uri, action.as_object_mut())
            && !action.contains_key("edit")
        {
            let edit = self.fix_all(self.file(&DocumentId { uri })?);
            let edit = serde_json::to_value(edit).map_err(|error| Fault::params(&error))?;
            action.insert("edit".into(), edit);
        }
        Ok(message::answer(id, &action))
    }

    fn file(&self, id: &DocumentId) -> Result<&File, Fault> {
        let open = self.files.get(&id.uri);
        let open = open.ok_or_else(|| Fault::failed(format!("{} is not open", id.uri)))?;
        Ok(&open.file)
    }

    /// The edit that applies all safe fixes, as `odkit check --fix` and `odkit network --fix` do.
    fn fix_all(&self, file: &File) -> WorkspaceEdit {
        let find = |path: &str| self.find(path).map(String::into_bytes);
        let network = self.host.network(&file.path, &find);
        actions::fix_all(file, &|document| {
            let mut findings = match file.kind {
                Kind::NodeList | Kind::Project => network(document.text()),
                Kind::Eds | Kind::Xdd | Kind::Overlay | Kind::Rust => document.load().findings,
            };
            // Errors in the settings are shown when the file is checked.
            let _ = self.host.judge(&file.path, &mut findings);
            findings
        })
    }

    /// All tokens, or the difference to the tokens of the client.
    fn tokens(
        &mut self,
        id: &Value,
        document: &DocumentId,
        has: Option<&str>,
    ) -> Result<String, Fault> {
        let (open, host) = self.open(document)?;
        let seen = open.file.seen(host);
        let whole = 0..open.file.str().len();
        let new = tokens::of(&open.file, &seen.layout, &whole);
        let (number, old) = std::mem::take(&mut open.tokens);
        let is_known = number > 0 && has.is_some_and(|has| has == number.to_string());
        let result_id = (number + 1).to_string();
        let text = if is_known {
            let edit = tokens::difference(&old, &new);
            let edits = edit.map(|(start, delete_count, data)| TokensEdit {
                start,
                delete_count,
                data,
            });
            message::answer(
                id,
                &TokensDelta {
                    result_id: &result_id,
                    edits: edits.into_iter().collect(),
                },
            )
        } else {
            message::answer(
                id,
                &Tokens {
                    result_id: Some(&result_id),
                    data: &new,
                },
            )
        };
        open.tokens = (number + 1, new);
        Ok(text)
    }
}

fn locations(file: &File, found: Vec<std::ops::Range<usize>>) -> Vec<Location> {
    let found = found.into_iter().map(|bytes| Location {
        uri: file.uri.clone(),
        range: file.text.range(bytes),
    });
    found.collect()
}
