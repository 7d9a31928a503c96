// The worker that ships: the simulation in WebAssembly.

import init from '../wasm/od_playground';
import { host } from './host';
import { WasmBus } from './wasm-bus';

void host(async () => {
  await init({ module_or_path: new URL('od_playground_bg.wasm', import.meta.url) });
  return new WasmBus();
});
