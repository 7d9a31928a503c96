// The page as SDO master: one transfer at a time, the others wait their turn.

import { Transfer, type Outcome, type Request } from '../can/sdo';
import { nodeId, powered } from '../state';
import { T } from '../texts';
import { act } from './link';
import type { Frame } from './packed';

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

export function frameArrived(frame: Frame): void {
  active?.receive(frame.id, frame.data);
}

export function tick(now: number): void {
  active?.tick(now);
}

/** Why nobody answered. */
export function silence(): string {
  return powered.value ? T.sdo.stopped : T.sdo.off;
}
