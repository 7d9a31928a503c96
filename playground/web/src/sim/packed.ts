// Packed frames, little endian: thousands are transferred from the worker at once, and the
// ring needs no object for each. layout.ts has their layout.

import { AT, DISTURBED, EXTENDED, FRAME_BYTES, FROM_PAGE, REMOTE } from './layout';

export { AT, DISTURBED, EXTENDED, FRAME_BYTES, FROM_PAGE, REMOTE };

/** One CAN frame, unpacked. */
export interface Packed {
  /** Virtual microseconds. */
  time: number;
  id: number;
  extended: boolean;
  remote: boolean;
  /** Sent by the page, not by a device. */
  fromPage: boolean;
  /** A failed attempt. The data has: reason, sender went bus-off, its transmit error counter (2 bytes), attempts (4). */
  disturbed: boolean;
  /** Number of the device that sent it, from 1; 0 for the page. */
  device: number;
  dlc: number;
  data: Uint8Array;
}

export function unpack(bytes: Uint8Array, at: number): Packed {
  const view = new DataView(bytes.buffer, bytes.byteOffset + at, FRAME_BYTES);
  const flags = view.getUint8(AT.flags);
  const dlc = view.getUint8(AT.dlc);
  return {
    time: view.getFloat64(AT.time, true),
    id: view.getUint32(AT.id, true),
    extended: (flags & EXTENDED) !== 0,
    remote: (flags & REMOTE) !== 0,
    fromPage: (flags & FROM_PAGE) !== 0,
    disturbed: (flags & DISTURBED) !== 0,
    device: view.getUint8(AT.device),
    dlc,
    data: bytes.subarray(at + AT.data, at + AT.data + (flags & REMOTE ? 0 : Math.min(dlc, 8))),
  };
}

export function pack(frame: Omit<Packed, 'dlc' | 'disturbed' | 'device'> & { dlc?: number; device?: number }): Uint8Array {
  const bytes = new Uint8Array(FRAME_BYTES);
  const view = new DataView(bytes.buffer);
  view.setFloat64(AT.time, frame.time, true);
  view.setUint32(AT.id, frame.id, true);
  view.setUint8(AT.flags, (frame.extended ? EXTENDED : 0) | (frame.remote ? REMOTE : 0) | (frame.fromPage ? FROM_PAGE : 0));
  view.setUint8(AT.dlc, frame.dlc ?? frame.data.length);
  view.setUint8(AT.device, frame.device ?? 0);
  bytes.set(frame.data.subarray(0, 8), AT.data);
  return bytes;
}
