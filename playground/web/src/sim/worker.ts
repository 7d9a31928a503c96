// The worker that ships: the simulation in WebAssembly. It begins with the small module;
// the whole one is fetched when somebody opens an EDS text.

import init, * as core from '../wasm/core/od_playground';
import { host } from './host';
import type { Module } from './world';

void host({
  async core() {
    await init({ module_or_path: new URL('core.wasm', import.meta.url) });
    return { ...(core as unknown as Module), whole: false };
  },
  async whole() {
    const whole = await import('../wasm/od_playground');
    await whole.default({ module_or_path: new URL('whole.wasm', import.meta.url) });
    return { ...(whole as unknown as Module), whole: true };
  },
});
