// Byte streams to a bus: a WebSocket of the worker, or a port that the page has opened.

import type { RealReport, Why } from './api';

export interface Port {
  /** False if the port cannot accept them now. */
  write(bytes: Uint8Array): boolean;
  close(): void;
}

/** Events of a port. */
interface Ears {
  opened(): void;
  came(bytes: Uint8Array): void;
  ended(why: Why): void;
}

/** Maximum number of bytes that wait in a socket. */
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

/** Milliseconds to wait for the reason. */
const PATIENCE = 2000;

/** A browser does not report why a WebSocket was refused. With `why` odkit opens it and closes it with the reason. */
function reason(address: string): Promise<Why> {
  return new Promise((resolve) => {
    const own = new WebSocket(`${address}&why`);
    let isThere = false;
    const end = (why: Why): void => {
      resolve(why);
      own.close();
    };
    const timer = setTimeout(() => end({ kind: 'denied' }), PATIENCE);
    own.onopen = () => (isThere = true);
    own.onclose = ({ code, reason: text }) => {
      clearTimeout(timer);
      end(code === 1008 && text ? { kind: 'said', text } : { kind: isThere ? 'denied' : 'refused' });
    };
  });
}

export function ofPage(tell: (what: RealReport) => void): Port {
  return {
    write(bytes) {
      tell({ tells: 'bytes', bytes });
      return true;
    },
    close() {
      // The port belongs to the page.
    },
  };
}
