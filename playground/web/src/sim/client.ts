// The page as SDO master: one transfer at a time, the others wait their turn.

import { Transfer, type Outcome, type Request } from '../can/sdo';
import { nodeId, powered, ring } from '../state';
import { T } from '../texts';
import { act, listen } from './link';

let active: Transfer | null = null;
const waiting: (() => void)[] = [];

/** Reads or writes an object over the bus. */
export function transfer(request: Request): Promise<Outcome> {
  return new Promise((resolve) => {
    const begin = (): void => {
      active = new Transfer(
        nodeId.value,
        request,
        (id, data) => act({ op: 'send', id, data, extended: false, remote: false }),
        (outcome) => {
          active = null;
          resolve(outcome);
          waiting.shift()?.();
        },
      );
      active.start();
    };
    if (active) waiting.push(begin);
    else begin();
  });
}

listen(({ now }, first) => {
  if (!active) return;
  for (let number = first; number < ring.end; number++) {
    const frame = ring.get(number);
    if (frame && !frame.disturbed && !frame.fromPage) active?.receive(frame.id, frame.data);
  }
  active?.tick(now);
});

/** Why nobody answered. */
export function silence(): string {
  return powered.value ? T.sdo.stopped : T.sdo.off;
}
