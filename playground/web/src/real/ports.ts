// Carriers of bytes to a bus: a WebSocket of the worker, or a port that the page has opened.

import type { RealReport, Why } from './api';

export interface Port {
  /** False where there is no room for them now. */
  write(bytes: Uint8Array): boolean;
  close(): void;
}

/** What a port tells. */
export interface Ears {
  opened(): void;
  came(bytes: Uint8Array): void;
  ended(why: Why): void;
}

/** Bytes that may wait in a socket. */
const MOST_WAITING = 256 * 1024;

export function socket(address: string, ears: Ears): Port {
  const own = new WebSocket(address);
  let wasOpen = false;
  let isOver = false;
  own.binaryType = 'arraybuffer';
  own.onopen = () => {
    wasOpen = true;
    ears.opened();
  };
  const encoder = new TextEncoder();
  own.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) =>
    ears.came(typeof data === 'string' ? encoder.encode(data) : new Uint8Array(data));
  own.onclose = () => {
    if (isOver) return;
    isOver = true;
    if (wasOpen) ears.ended({ kind: 'gone' });
    else void reason(address).then((why) => ears.ended(why));
  };
  const decoder = new TextDecoder();
  return {
    write(bytes) {
      if (own.readyState !== WebSocket.OPEN || own.bufferedAmount > MOST_WAITING) return false;
      own.send(decoder.decode(bytes));
      return true;
    },
    close() {
      isOver = true;
      own.close();
    },
  };
}

/** A page is not told why a WebSocket was refused. The same address answers a plain request with the reason. */
async function reason(address: string): Promise<Why> {
  const plain = address.replace(/^ws/, 'http');
  try {
    const answer = await fetch(plain, { signal: AbortSignal.timeout(2000) });
    const text = (await answer.text()).trim();
    // It would have let us in: there was no room, or it came up only now.
    return answer.status === 426 || text.length > 300 ? { kind: 'denied' } : { kind: 'said', text };
  } catch {
    // An older odkit does not let the page read it; that somebody answers can be seen all the same.
    const answers = await fetch(plain, { mode: 'no-cors', signal: AbortSignal.timeout(2000) }).then(() => true, () => false);
    return { kind: answers ? 'denied' : 'refused' };
  }
}

export function ofPage(tell: (what: RealReport) => void): Port {
  return {
    write(bytes) {
      tell({ tells: 'bytes', bytes });
      return true;
    },
    close() {
      // It belongs to the page.
    },
  };
}
