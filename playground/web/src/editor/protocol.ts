// The types of the Language Server Protocol, reduced to what our server sends.

import type * as lsp from 'vscode-languageserver-types';

export type { CodeAction, DocumentSymbol, Location, Position, Range, TextEdit } from 'vscode-languageserver-types';

export interface Diagnostic extends lsp.Diagnostic {
  severity: lsp.DiagnosticSeverity;
  code: string;
  message: string;
}

export interface Diagnostics {
  uri: string;
  version?: number;
  diagnostics: Diagnostic[];
}

export interface CompletionItem extends lsp.CompletionItem {
  documentation?: lsp.MarkupContent;
  textEdit: lsp.TextEdit;
}

export interface Hover extends lsp.Hover {
  contents: lsp.MarkupContent;
}
