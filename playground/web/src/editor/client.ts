// The page's side of the language-server worker, which starts with the first request.

import { trusted } from '../trusted';
import type { Command, Found, Report, Requests } from './api';

let worker: Worker | null = null;
let ticket = 0;
const waiting = new Map<number, { resolve(value: unknown): void; reject(why: Error): void }>();
const listeners = new Map<string, (found: Found) => void>();

function receive(report: Report): void {
  if (report.op === 'found') return listeners.get(report.uri)?.(report.found);
  const asked = waiting.get(report.ticket);
  waiting.delete(report.ticket);
  if (report.op === 'answer') asked?.resolve(report.value);
  else asked?.reject(new Error(report.why));
}

function started(): Worker {
  if (worker) return worker;
  const own = new Worker(trusted('editor.js'), { type: 'module', name: 'odkit language server' });
  own.onmessage = ({ data }: MessageEvent<Report>) => receive(data);
  own.onerror = (event) => {
    event.preventDefault();
    own.terminate();
    worker = null;
    for (const { reject } of waiting.values()) reject(new Error(event.message));
    waiting.clear();
    // Each view with an open text opens it again.
    for (const again of restarted) again();
  };
  return (worker = own);
}

/** Called when the worker has crashed: the next request starts a new one, without texts. */
export const restarted = new Set<() => void>();

export const send = (command: Command): void => started().postMessage(command);

/** Sends a request to the worker. Rejects if it cannot answer. */
export function ask<K extends keyof Requests>(op: K, ...args: Parameters<Requests[K]>): Promise<ReturnType<Requests[K]>> {
  return new Promise((resolve, reject) => {
    ticket += 1;
    waiting.set(ticket, { resolve: resolve as (value: unknown) => void, reject });
    send({ op, ticket, args } as Command);
  });
}

/** Calls `listener` with the findings of a text after each change. */
export function listen(uri: string, listener: (found: Found) => void): () => void {
  listeners.set(uri, listener);
  return () => listeners.delete(uri);
}

let opened = 0;
/** A unique URI; the server reads the kind of the file from its name. */
export const uriOf = (name: string): string => `page:${(opened += 1)}/${name}`;
