// Frames in bulk: 24 bytes each, little endian, so that thousands cross from the
// worker in one transfer and the ring needs no object per frame.
//
//  0  f64  virtual microseconds
//  8  u32  identifier
// 12  u8   flags: 1 = extended, 2 = remote, 4 = sent from the page, 8 = disturbed on the wire
// 13  u8   DLC
// 14  u8   device on the bus (0 = the page)
// 15  u8   reserved
// 16  [u8; 8] data

export const FRAME_BYTES = 24;

export const EXTENDED = 1;
export const REMOTE = 2;
export const FROM_PAGE = 4;
/** The data says what happened: why, attempts, came through, sender went bus-off, its counter. */
export const DISTURBED = 8;

/** One CAN frame, unpacked. */
export interface Packed {
  /** Virtual microseconds. */
  time: number;
  id: number;
  extended: boolean;
  remote: boolean;
  /** Sent from the page, not by a device. */
  fromPage: boolean;
  /** Disturbed on the wire; the data says how. */
  disturbed: boolean;
  /** Number of the device that sent it, from 1; 0 for the page. */
  device: number;
  dlc: number;
  data: Uint8Array;
}

export function unpack(bytes: Uint8Array, at: number): Packed {
  const view = new DataView(bytes.buffer, bytes.byteOffset + at, FRAME_BYTES);
  const flags = view.getUint8(12);
  const dlc = view.getUint8(13);
  return {
    time: view.getFloat64(0, true),
    id: view.getUint32(8, true),
    extended: (flags & EXTENDED) !== 0,
    remote: (flags & REMOTE) !== 0,
    fromPage: (flags & FROM_PAGE) !== 0,
    disturbed: (flags & DISTURBED) !== 0,
    device: view.getUint8(14),
    dlc,
    data: bytes.subarray(at + 16, at + 16 + (flags & REMOTE ? 0 : Math.min(dlc, 8))),
  };
}

export function pack(frame: Omit<Packed, 'dlc' | 'disturbed' | 'device'> & { dlc?: number; device?: number }): Uint8Array {
  const bytes = new Uint8Array(FRAME_BYTES);
  const view = new DataView(bytes.buffer);
  view.setFloat64(0, frame.time, true);
  view.setUint32(8, frame.id, true);
  view.setUint8(12, (frame.extended ? EXTENDED : 0) | (frame.remote ? REMOTE : 0) | (frame.fromPage ? FROM_PAGE : 0));
  view.setUint8(13, frame.dlc ?? frame.data.length);
  view.setUint8(14, frame.device ?? 0);
  bytes.set(frame.data.subarray(0, 8), 16);
  return bytes;
}
