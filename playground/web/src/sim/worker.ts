// The worker of the page: the simulation in WebAssembly. It starts with the small module;
// the whole one is fetched when the user opens an EDS text.

import init, * as core from '../wasm/core/od_playground';
import { host } from './host';
import type { Module } from './world';

let compiled: WebAssembly.Module;

void host({
  compiled: () => compiled,
  async core() {
    const answer = await fetch(new URL('core.wasm', import.meta.url));
    // A server that does not know the MIME type must not cause an error.
    const isKnown = answer.headers.get('content-type') === 'application/wasm';
    compiled = isKnown ? await WebAssembly.compileStreaming(answer) : await WebAssembly.compile(await answer.arrayBuffer());
    await init({ module_or_path: compiled });
    return { ...(core as unknown as Module), whole: false };
  },
  async whole() {
    const whole = await import('../wasm/od_playground');
    await whole.default({ module_or_path: new URL('whole.wasm', import.meta.url) });
    return { ...(whole as unknown as Module), whole: true };
  },
});
