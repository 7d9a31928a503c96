// What both workers (WebAssembly and stand-in) share: messages in, reports out, and
// an end when something throws, so that the page can start a fresh one.

import type { Bus, Command, Report } from './api';
import { Engine } from './engine';

const report = (message: Report, transfer: Transferable[] = []): void =>
  (self as unknown as Worker).postMessage(message, transfer);

export async function host(makeBus: () => Promise<Bus>): Promise<void> {
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
  const waiting: Command[] = [];
  let engine: Engine | undefined;
  self.onmessage = ({ data }: MessageEvent<Command>) => {
    if (engine) engine.handle(data);
    else waiting.push(data);
  };
  let builtins;
  try {
    const bus = await makeBus();
    builtins = bus.builtins();
    engine = new Engine(bus, report);
  } catch (reason) {
    crash(reason);
    return;
  }
  report({ op: 'ready', builtins });
  for (const command of waiting.splice(0)) engine.handle(command);
}
