// The functions of Node.js that the unit tests need, declared here: the page has no Node types.

interface Assert {
  ok(value: unknown, message?: string): asserts value;
  equal(actual: unknown, expected: unknown, message?: string): void;
  deepEqual(actual: unknown, expected: unknown, message?: string): void;
  match(text: string, pattern: RegExp, message?: string): void;
}

// @ts-expect-error its types are not installed
import nodeAssert from 'node:assert/strict';
// @ts-expect-error its types are not installed
import { test as nodeTest } from 'node:test';

// @ts-expect-error its types are not installed
import { readFileSync } from 'node:fs';
import { begin } from './codec';

export const assert: Assert = nodeAssert as Assert;
export const test = nodeTest as (name: string, body: () => void | Promise<void>) => void;

// The page's own instance; `npm test` runs in the folder of the page.
begin(new WebAssembly.Module(readFileSync('src/wasm/core/od_playground_bg.wasm') as BufferSource));
