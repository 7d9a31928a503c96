//! The server: messages wait in a queue and are answered in order. Changed files are
//! checked when no message waits.

use std::collections::{BTreeMap, VecDeque};

use od_model::Refused;
use serde_json::Value;

use crate::features::diagnostics;
use crate::file::{self, File, Kind};
use crate::host::Host;
use crate::macros::base::decoded;
use crate::macros::check;
use crate::message::{self, Fault, Incoming};
use crate::text::Unit;
use crate::types::{DidChange, DidOpen, OfDocument, PublishDiagnostics};

mod capabilities;
mod requests;

/// A language server for one client.
///
/// Every message goes to [`receive`](Self::receive); then [`step`](Self::step) is called until it
/// returns `false`, and [`poll`](Self::poll) until it returns `None`. A caller that has more
/// input should `receive` all of it first: a file is checked only once for all waiting changes.
pub struct Server {
    host: Box<dyn Host>,
    files: BTreeMap<String, Open>,
    inbox: VecDeque<Incoming>,
    outbox: VecDeque<String>,
    unit: Unit,
    /// The client can request the edits of code actions later.
    later: bool,
    /// The client reports changes of files that it has not opened.
    watches: bool,
    phase: Phase,
    exit: Option<u8>,
    /// The last reported error of the project's settings.
    complained: Option<Refused>,
}

/// An open file, and the results that the client has of it.
struct Open {
    file: File,
    /// The client waits for diagnostics.
    dirty: bool,
    /// The tokens of the client, and the number of their response.
    tokens: (u64, Vec<u32>),
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Phase {
    Before,
    Running,
    Shutdown,
}

impl Server {
    /// A server for a client that has not sent anything yet.
    pub fn new(host: Box<dyn Host>) -> Self {
        Self {
            host,
            files: BTreeMap::new(),
            inbox: VecDeque::new(),
            outbox: VecDeque::new(),
            unit: Unit::default(),
            later: false,
            watches: false,
            phase: Phase::Before,
            exit: None,
            complained: None,
        }
    }

    /// Takes a message: the text between two headers. An invalid text is answered with an error.
    pub fn receive(&mut self, text: &str) {
        let incoming = match Incoming::read(text) {
            Ok(incoming) => incoming,
            Err(fault) => {
                self.outbox
                    .push_back(message::refusal(&Value::Null, &fault));
                return;
            }
        };
        if incoming.method.as_deref() == Some("$/cancelRequest") {
            self.cancel(&incoming.params);
            return;
        }
        self.inbox.push_back(incoming);
    }

    /// Answers input that is not a message.
    pub fn reject(&mut self, why: &str) {
        let fault = message::refusal(&Value::Null, &Fault::parse(why));
        self.outbox.push_back(fault);
    }

    /// Does one task; `false` if there is none.
    pub fn step(&mut self) -> bool {
        if let Some(incoming) = self.inbox.pop_front() {
            self.handle(incoming);
            return true;
        }
        let dirty = self.files.values_mut().find(|open| open.dirty);
        let Some(open) = dirty.filter(|_| self.phase == Phase::Running) else {
            return false;
        };
        open.dirty = false;
        let uri = open.file.uri.clone();
        let misused = self.publish(&uri);
        self.complain(misused);
        true
    }

    /// The next message for the client.
    pub fn poll(&mut self) -> Option<String> {
        self.outbox.pop_front()
    }

    /// The exit code after the `exit` of the client: 0 after `shutdown`, otherwise 1.
    pub const fn exit_code(&self) -> Option<u8> {
        self.exit
    }

    /// The exit code when the input ends without `exit`.
    pub const fn end_of_input(&self) -> u8 {
        match self.phase {
            Phase::Shutdown => 0,
            Phase::Before | Phase::Running => 1,
        }
    }

    /// Answers a waiting request with "cancelled". A request that is already answered is ignored.
    fn cancel(&mut self, params: &Value) {
        let Some(id) = params.get("id") else {
            return;
        };
        let waiting = self.inbox.iter();
        let mut waiting = waiting.map(|incoming| incoming.id.as_ref() == Some(id));
        if let Some(at) = waiting.position(|own| own) {
            self.inbox.remove(at);
            let fault = message::refusal(id, &Fault::cancelled());
            self.outbox.push_back(fault);
        }
    }

    fn handle(&mut self, incoming: Incoming) {
        if self.exit.is_some() {
            return;
        }
        let Incoming { id, method, params } = incoming;
        let Some(method) = method else {
            // Responses of the client are ignored.
            return;
        };
        let Some(id) = id else {
            self.notified(&method, params);
            return;
        };
        if !id.is_string() && !id.is_number() {
            let fault = Fault::invalid("an id is a number or a string");
            let text = message::refusal(&Value::Null, &fault);
            self.outbox.push_back(text);
            return;
        }
        let text = match self.answer(&id, &method, params) {
            Ok(text) => text,
            Err(fault) => message::refusal(&id, &fault),
        };
        self.outbox.push_back(text);
    }

    fn answer(&mut self, id: &Value, method: &str, params: Value) -> Result<String, Fault> {
        match (self.phase, method) {
            (Phase::Before, "initialize") => {
                self.phase = Phase::Running;
                Ok(message::answer(id, &self.initialize(&params)))
            }
            (Phase::Before, _) => Err(Fault::not_initialized()),
            (Phase::Running, "initialize") => Err(Fault::invalid("`initialize` is sent once")),
            (Phase::Running, "shutdown") => {
                self.phase = Phase::Shutdown;
                Ok(message::answer(id, &Value::Null))
            }
            (Phase::Running, _) => self.request(id, method, params),
            (Phase::Shutdown, _) => Err(Fault::invalid("only `exit` follows `shutdown`")),
        }
    }

    fn notified(&mut self, method: &str, params: Value) {
        if method == "exit" {
            self.exit = Some(self.end_of_input());
            return;
        }
        if self.phase != Phase::Running {
            return;
        }
        // An unreadable notification has no answer.
        match method {
            "initialized" => self.watch(),
            "textDocument/didOpen" => {
                if let Ok(params) = serde_json::from_value::<DidOpen>(params) {
                    let own = params.text_document;
                    let (uri, text) = (own.uri.clone(), own.text);
                    let (language, unit) = (own.language_id.as_str(), self.unit);
                    let file = File::new(own.uri, language, own.version, text, unit, &*self.host);
                    let open = Open {
                        file,
                        dirty: true,
                        tokens: (0, Vec::new()),
                    };
                    self.files.insert(uri.clone(), open);
                    self.others(&uri);
                }
            }
            "textDocument/didChange" => {
                if let Ok(params) = serde_json::from_value::<DidChange>(params)
                    && let Some(open) = self.files.get_mut(&params.text_document.uri)
                {
                    for change in &params.content_changes {
                        open.file.text.change(change.range, &change.text);
                    }
                    open.file.version = params.text_document.version;
                    open.file.forget();
                    open.dirty = true;
                    if open.file.kind != Kind::Rust {
                        self.others(&params.text_document.uri);
                    }
                }
            }
            "textDocument/didClose" => {
                if let Ok(params) = serde_json::from_value::<OfDocument>(params)
                    && let Some(open) = self.files.remove(&params.text_document.uri)
                {
                    let params = PublishDiagnostics {
                        uri: &open.file.uri,
                        version: None,
                        diagnostics: Vec::new(),
                    };
                    let text = message::notification("textDocument/publishDiagnostics", &params);
                    self.outbox.push_back(text);
                }
            }
            // A file on the disk, or the settings of a project.
            "textDocument/didSave"
            | "workspace/didChangeWatchedFiles"
            | "workspace/didChangeConfiguration" => self.others(""),
            _ => {}
        }
    }

    /// Checks all files again that depend on other files; after a save, all files.
    fn others(&mut self, but: &str) {
        for (uri, open) in &mut self.files {
            let is_alone = matches!(open.file.kind, Kind::Eds | Kind::Xdd);
            let depends = !is_alone || but.is_empty();
            if uri != but && depends {
                open.file.forget();
                open.dirty = true;
            }
        }
    }

    /// Shows an error of the project's settings, only once.
    fn complain(&mut self, misused: Option<Refused>) {
        if let Some(why) = &misused
            && self.complained != misused
        {
            let params = serde_json::json!({ "type": 1, "message": why.to_string() });
            let text = message::notification("window/showMessage", &params);
            self.outbox.push_back(text);
        }
        self.complained = misused;
    }

    /// Sends the diagnostics of a file; returns the error of the project's settings, if there is one.
    fn publish(&mut self, uri: &str) -> Option<Refused> {
        self.lay(uri);
        let open = self.files.get(uri)?;
        let file = &open.file;
        let seen = file.seen(&*self.host);
        let diagnostics = match file.kind {
            Kind::Rust => check::of(file, &|path| self.find(path)),
            _ => diagnostics::of(file, seen),
        };
        let params = PublishDiagnostics {
            uri: &file.uri,
            version: file.version,
            diagnostics,
        };
        let text = message::notification("textDocument/publishDiagnostics", &params);
        let misused = seen.misused.clone();
        self.outbox.push_back(text);
        misused
    }

    /// Gives a file that is to be read what it needs of others, with the text of the client or of the disk: an overlay its
    /// base, a network the findings about its nodes.
    fn lay(&mut self, uri: &str) {
        let open = self.files.get(uri);
        let Some(open) = open.filter(|open| !open.file.is_seen()) else {
            return;
        };
        let file = &open.file;
        let (mut base, mut network) = (None, None);
        match file.kind {
            Kind::Overlay => {
                let find = |path: &str| self.find(path);
                base = Some(file::base(file, self.unit, &*self.host, &find));
            }
            Kind::NodeList | Kind::Project => {
                let find = |path: &str| self.find(path).map(String::into_bytes);
                network = Some(self.host.network(&file.path, &find)(file.str()));
            }
            Kind::Eds | Kind::Xdd | Kind::Rust => return,
        }
        if let Some(open) = self.files.get_mut(uri) {
            (open.file.base, open.file.network) = (base, network);
        }
    }

    /// The text of a file, from the client or from the disk.
    fn find(&self, path: &str) -> Option<String> {
        let mut open = self.files.values();
        match open.find(|open| open.file.path == path) {
            Some(open) => Some(open.file.str().to_owned()),
            None => self.host.read(path).map(decoded),
        }
    }
}
