//! The types of the Language Server Protocol 3.17 that this server sends and receives, with the
//! names of the protocol.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A position: both numbers count from 0; the unit of `character` is agreed on at the start.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Position {
    pub(crate) line: u32,
    pub(crate) character: u32,
}

/// A range; its end is excluded.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Range {
    pub(crate) start: Position,
    pub(crate) end: Position,
}

#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
pub(crate) struct Location {
    pub(crate) uri: String,
    pub(crate) range: Range,
}

#[derive(Serialize, Clone)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Diagnostic {
    pub(crate) range: Range,
    pub(crate) severity: u8,
    #[serde(skip_serializing_if = "str::is_empty")]
    pub(crate) code: &'static str,
    pub(crate) source: &'static str,
    pub(crate) message: String,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) related_information: Vec<RelatedInformation>,
}

#[derive(Serialize, Clone)]
pub(crate) struct RelatedInformation {
    pub(crate) location: Location,
    pub(crate) message: String,
}

#[derive(Serialize)]
pub(crate) struct PublishDiagnostics<'a> {
    pub(crate) uri: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) version: Option<i64>,
    pub(crate) diagnostics: Vec<Diagnostic>,
}

#[derive(Clone, PartialEq, Eq, Debug, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TextEdit {
    pub(crate) range: Range,
    pub(crate) new_text: String,
}

/// Edits by file.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct WorkspaceEdit {
    pub(crate) changes: BTreeMap<String, Vec<TextEdit>>,
}

impl WorkspaceEdit {
    /// Edits of one file.
    pub(crate) fn of(uri: &str, edits: Vec<TextEdit>) -> Self {
        Self {
            changes: BTreeMap::from([(uri.to_owned(), edits)]),
        }
    }
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct CodeAction {
    pub(crate) title: String,
    pub(crate) kind: &'static str,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) diagnostics: Vec<Diagnostic>,
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub(crate) is_preferred: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) edit: Option<WorkspaceEdit>,
    /// The file, for an edit that is requested later.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) data: Option<String>,
}

#[derive(Serialize)]
pub(crate) struct Hover {
    pub(crate) contents: Markup,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) range: Option<Range>,
}

#[derive(Serialize, Clone)]
pub(crate) struct Markup {
    kind: &'static str,
    pub(crate) value: String,
}

impl Markup {
    pub(crate) const fn markdown(value: String) -> Self {
        Self {
            kind: "markdown",
            value,
        }
    }
}

#[derive(Serialize, Clone)]
#[serde(rename_all = "camelCase")]
pub(crate) struct CompletionItem {
    pub(crate) label: String,
    pub(crate) kind: u8,
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(crate) detail: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) documentation: Option<Markup>,
    pub(crate) sort_text: String,
    pub(crate) filter_text: String,
    pub(crate) text_edit: TextEdit,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct CompletionList {
    pub(crate) is_incomplete: bool,
    pub(crate) items: Vec<CompletionItem>,
}

#[derive(Serialize, Clone)]
#[serde(rename_all = "camelCase")]
pub(crate) struct DocumentSymbol {
    pub(crate) name: String,
    #[serde(skip_serializing_if = "String::is_empty")]
    pub(crate) detail: String,
    pub(crate) kind: u8,
    pub(crate) range: Range,
    pub(crate) selection_range: Range,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) children: Vec<DocumentSymbol>,
}

#[derive(Serialize, PartialEq, Eq, Debug)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FoldingRange {
    pub(crate) start_line: u32,
    pub(crate) end_line: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) kind: Option<&'static str>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct InlayHint {
    pub(crate) position: Position,
    pub(crate) label: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) kind: Option<u8>,
    pub(crate) padding_left: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) tooltip: Option<String>,
}

#[derive(Serialize)]
pub(crate) struct Highlight {
    pub(crate) range: Range,
}

#[derive(Serialize)]
pub(crate) struct PrepareRename {
    pub(crate) range: Range,
    pub(crate) placeholder: String,
}

#[derive(Deserialize)]
pub(crate) struct DocumentId {
    pub(crate) uri: String,
}

/// Parameters of requests about a file.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct OfDocument {
    pub(crate) text_document: DocumentId,
}

/// Parameters of requests about a position.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct AtPosition {
    pub(crate) text_document: DocumentId,
    pub(crate) position: Position,
    /// For references: include the definition.
    #[serde(default)]
    pub(crate) context: ReferenceContext,
    /// For a rename.
    #[serde(default)]
    pub(crate) new_name: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct ReferenceContext {
    #[serde(default = "yes")]
    pub(crate) include_declaration: bool,
}

impl Default for ReferenceContext {
    fn default() -> Self {
        Self {
            include_declaration: true,
        }
    }
}

const fn yes() -> bool {
    true
}

/// Parameters of requests about a range.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct InRange {
    pub(crate) text_document: DocumentId,
    pub(crate) range: Range,
    /// For code actions.
    #[serde(default)]
    pub(crate) context: ActionContext,
}

#[derive(Deserialize, Default)]
pub(crate) struct ActionContext {
    #[serde(default)]
    pub(crate) only: Option<Vec<String>>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct DidOpen {
    pub(crate) text_document: Opened,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Opened {
    pub(crate) uri: String,
    #[serde(default)]
    pub(crate) language_id: String,
    #[serde(default)]
    pub(crate) version: Option<i64>,
    pub(crate) text: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct DidChange {
    pub(crate) text_document: Versioned,
    pub(crate) content_changes: Vec<Change>,
}

#[derive(Deserialize)]
pub(crate) struct Versioned {
    pub(crate) uri: String,
    #[serde(default)]
    pub(crate) version: Option<i64>,
}

#[derive(Deserialize)]
pub(crate) struct Change {
    /// Without a range, the whole text.
    #[serde(default)]
    pub(crate) range: Option<Range>,
    pub(crate) text: String,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct DeltaParams {
    pub(crate) text_document: DocumentId,
    pub(crate) previous_result_id: String,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Tokens<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) result_id: Option<&'a str>,
    pub(crate) data: &'a [u32],
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TokensDelta<'a> {
    pub(crate) result_id: &'a str,
    pub(crate) edits: Vec<TokensEdit<'a>>,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct TokensEdit<'a> {
    pub(crate) start: usize,
    pub(crate) delete_count: usize,
    pub(crate) data: &'a [u32],
}
