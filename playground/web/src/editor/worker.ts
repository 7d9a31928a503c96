// The worker of the editor: the language server of `odkit lsp`, outside the page's thread.

import init, { compareEds, decodeEds, deviceEds, encodeEds, LanguageServer, ruleTitles } from '../wasm/od_playground';
import type { Command, Finding, Found, Origin, Outline, Report, Requests } from './api';
import { finding, Findings } from './findings';
import type { Diagnostics, DocumentSymbol } from './protocol';

const post = (report: Report, transfer: Transferable[] = []): void => (self as unknown as Worker).postMessage(report, transfer);

/** An open text. */
interface Open {
  /** The lines of the opened text; empty after a change. */
  lines: string[] | null;
  version: number;
  found: Findings;
}

let server: LanguageServer;
let titles: Record<string, string> = {};
const texts = new Map<string, Open>();
const early: Command[] = [];
/** Requests of the protocol without an answer yet. */
const waiting = new Map<number, (value: unknown) => unknown>();
let isWorking = false;

const textOf = (origin: Origin): string => ('text' in origin ? origin.text : 'bytes' in origin ? decodeEds(origin.bytes) : (deviceEds(origin.name) ?? ''));

const tell = (method: string, params: object): void => server.receive(JSON.stringify({ jsonrpc: '2.0', method, params }));

/** Sends a request to the server; `read` converts its answer for the page. */
function ask(ticket: number, method: string, params: object, read: (value: unknown) => unknown = (value) => value): void {
  waiting.set(ticket, read);
  server.receive(JSON.stringify({ jsonrpc: '2.0', id: ticket, method, params }));
}

function open(uri: string, origin: Origin): string {
  const text = textOf(origin);
  if ('bytes' in origin) server.put(uri, origin.bytes);
  texts.set(uri, { lines: text.split(/\r\n|\r|\n/), version: 1, found: new Findings([], titles) });
  tell('textDocument/didOpen', { textDocument: { uri, languageId: 'eds', version: 1, text } });
  return text;
}

function rows(uri: string, version: number, from: number, to: number): Finding[] {
  const own = texts.get(uri);
  if (own?.version !== version) return [];
  return own.found.slice(from, to).map((one) => finding(one, own.lines));
}

function outline(symbols: DocumentSymbol[]): Outline {
  const flat = symbols.flatMap((one) => [[one, 0] as const, ...(one.children ?? []).map((child) => [child, 1] as const)]);
  return {
    names: flat.map(([one]) => one.name).join('\n'),
    lines: Uint32Array.from(flat, ([one]) => one.range.start.line),
    depths: Uint8Array.from(flat, ([, depth]) => depth),
  };
}

const answers: { [K in Exclude<keyof Requests, 'request' | 'outline'>]: Requests[K] } = {
  open,
  rows,
  compare: compareEds,
  encode: (origin, text) => ('bytes' in origin ? encodeEds(origin.bytes, text) : new TextEncoder().encode(text)),
};

function take(command: Command): void {
  switch (command.op) {
    case 'change': {
      const own = texts.get(command.uri);
      if (own) own.lines = null;
      return tell('textDocument/didChange', { textDocument: { uri: command.uri, version: command.version }, contentChanges: command.changes });
    }
    case 'close':
      texts.delete(command.uri);
      return tell('textDocument/didClose', { textDocument: { uri: command.uri } });
    case 'request':
      return ask(command.ticket, ...command.args);
    case 'outline':
      return ask(command.ticket, 'textDocument/documentSymbol', { textDocument: { uri: command.args[0] } }, (value) => outline(value as DocumentSymbol[]));
    default: {
      const { op, args, ticket } = command;
      try {
        post({ op: 'answer', ticket, value: (answers[op] as (...args: unknown[]) => unknown)(...args) });
      } catch (error) {
        post({ op: 'refused', ticket, why: String(error) });
      }
    }
  }
}

/** Messages of the server are sent to the page. */
function flush(): void {
  for (let text = server.poll(); text !== undefined; text = server.poll()) {
    const message = JSON.parse(text) as { id?: number; method?: string; result?: unknown; error?: { message: string }; params: Diagnostics };
    if (message.method === 'textDocument/publishDiagnostics') published(message.params);
    if (message.id === undefined || message.method) continue;
    const read = waiting.get(message.id);
    waiting.delete(message.id);
    if (message.error) post({ op: 'refused', ticket: message.id, why: message.error.message });
    else if (read) post({ op: 'answer', ticket: message.id, value: read(message.result) });
  }
}

function published({ uri, version, diagnostics }: Diagnostics): void {
  const own = texts.get(uri);
  if (!own || version === undefined) return;
  own.found = new Findings(diagnostics, titles);
  own.version = version;
  const { counts, groups, places } = own.found;
  const found: Found = { version, counts, groups, places: places() };
  post({ op: 'found', uri, found }, [found.places.buffer]);
}

/** Runs steps of the server; messages of the page are handled in between. */
function work(): void {
  isWorking = server.step();
  flush();
  if (isWorking) setTimeout(work);
}

self.onmessage = ({ data }: MessageEvent<Command>) => {
  if (!server) return void early.push(data);
  take(data);
  if (isWorking) return;
  isWorking = true;
  setTimeout(work);
};

// An exception reaches the page as an error of the worker, and the page starts a new one.
void init({ module_or_path: new URL('whole.wasm', import.meta.url) }).then(
  () => {
    titles = ruleTitles();
    server = new LanguageServer();
    const capabilities = { textDocument: { codeAction: { resolveSupport: { properties: ['edit'] } } } };
    server.receive(JSON.stringify({ jsonrpc: '2.0', id: 0, method: 'initialize', params: { capabilities } }));
    tell('initialized', {});
    for (const command of early) take(command);
    work();
  },
  (error: unknown) =>
    setTimeout(() => {
      throw error;
    }),
);
