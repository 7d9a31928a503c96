// The worker: messages in, reports out. An exception ends it, so that the
// page can start a new one.

import type { Command, Report } from './api';
import { Engine } from './engine';
import { World, type Modules } from './world';

const report = (message: Report, transfer: Transferable[] = []): void =>
  (self as unknown as Worker).postMessage(message, transfer);

export async function host(modules: Modules): Promise<void> {
  const crash = (reason: unknown): void =>
    report({ op: 'crashed', message: reason instanceof Error ? reason.message : String(reason) });
  self.addEventListener('error', (event) => {
    event.preventDefault();
    crash(event.message);
  });
  self.addEventListener('unhandledrejection', (event) => {
    event.preventDefault();
    crash(event.reason);
  });
  // Commands are done one after the other, although some have to load something.
  const waiting: Command[] = [];
  let engine: Engine | undefined;
  let isWorking = false;
  const work = async (): Promise<void> => {
    if (!engine || isWorking) return;
    isWorking = true;
    try {
      for (let next = waiting.shift(); next; next = waiting.shift()) {
        if (next.op === 'real') await (await import('../real/worker')).handle(engine, next.what);
        else await engine.handle(next);
      }
    } catch (reason) {
      crash(reason);
    }
    isWorking = false;
  };
  self.onmessage = ({ data }: MessageEvent<Command>) => {
    if (data.op === 'ping') return report({ op: 'pong' });
    waiting.push(data);
    void work();
  };
  try {
    const world = new World(modules, await modules.core());
    report({ op: 'ready', builtins: world.builtins(), module: modules.compiled() });
    engine = new Engine(world, report);
  } catch (reason) {
    crash(reason);
    return;
  }
  void work();
}
