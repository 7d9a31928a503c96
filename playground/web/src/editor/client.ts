// The page's end of the worker with the language server. It starts with the first question.

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
    // Every view with an open text opens it again.
    for (const again of restarted) again();
  };
  return (worker = own);
}

/** Called when the worker broke: the next question starts a fresh one, without texts. */
export const restarted = new Set<() => void>();

export const send = (command: Command): void => started().postMessage(command);

/** Asks the worker. Rejects where it cannot answer. */
export function ask<K extends keyof Requests>(op: K, ...args: Parameters<Requests[K]>): Promise<ReturnType<Requests[K]>> {
  return new Promise((resolve, reject) => {
    ticket += 1;
    waiting.set(ticket, { resolve: resolve as (value: unknown) => void, reject });
    send({ op, ticket, args } as Command);
  });
}

/** Calls `listener` with what is found in a text, after each change. */
export function listen(uri: string, listener: (found: Found) => void): () => void {
  listeners.set(uri, listener);
  return () => listeners.delete(uri);
}

let opened = 0;
/** A URI that no other text has; the server reads the kind of the file in its name. */
export const uriOf = (name: string): string => `page:${(opened += 1)}/${name}`;
