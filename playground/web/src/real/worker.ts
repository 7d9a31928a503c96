// Handles the page's requests about a real bus, in the worker.

import type { Engine } from '../sim/engine';
import type { RealCommand } from './api';
import { Real } from './world';

/** The link that exists or is being opened. */
let real: Real | null = null;

export async function handle(engine: Engine, what: RealCommand): Promise<void> {
  engine.leave = () => leave(engine);
  switch (what.is) {
    case 'connect': {
      leave(engine);
      const own = new Real(engine.virtual, await engine.virtual.modules.whole(), what.to, (report) => engine.report({ op: 'real', what: report }));
      real = own;
      // Other work continues during this time.
      void own.open().then(async (why) => {
        if (why === null) {
          for (const { source, nodeId } of what.devices) await own.act({ op: 'add', source, nodeId });
          engine.show(own);
        } else if (real === own) {
          real = null;
        }
        engine.answer(what.ticket, why ?? { kind: 'open' });
      });
      break;
    }
    case 'leave':
      leave(engine);
      break;
    case 'sending':
      real?.setSending(what.on);
      break;
    case 'again':
      real?.retry();
      break;
    case 'describe':
      engine.answer(what.ticket, real?.describe(what.input) ?? null);
      engine.tellDevices();
      break;
    case 'identify':
      engine.answer(what.ticket, (await engine.virtual.tools()).identify?.(what.vendor, what.product) ?? null);
      break;
    case 'bytes':
      real?.ears?.came(what.bytes);
      break;
    case 'gone':
      real?.ears?.ended({ kind: 'gone' });
      break;
    case 'unsent':
      real?.miss(what.bytes);
      break;
  }
}

/** Returns to the virtual bench. */
function leave(engine: Engine): void {
  if (!real) return;
  real.close();
  real = null;
  if (engine.isLive) engine.show(null);
}
