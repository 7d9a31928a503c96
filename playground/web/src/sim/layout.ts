// Written by `ODKIT_ACCEPT=1 cargo test -p od-playground`, from playground/src/layout.rs.

/** Bytes of a packed frame (playground/src/packed.rs). */
export const FRAME_BYTES = 24;

/** Its flags. */
export const EXTENDED = 1;
export const REMOTE = 2;
export const FROM_PAGE = 4;
export const DISTURBED = 8;

/** Offsets of its parts; numbers are little endian. */
export const AT = {
  time: 0,
  id: 8,
  flags: 12,
  dlc: 13,
  device: 14,
  data: 16,
} as const;

/** Numbers of each frame in `tags`; of the first a mask for its parts, and the bits below the node ID and the object. */
export const TAG = { length: 2, mask: 255, node: 8, object: 16 } as const;

/** Codes of `frameBits` for a bit, and the numbers of two parts of a frame. */
export const BIT = {
  recessive: 128,
  stuffed: 64,
  part: 63,
  crc: 8,
  data: 16,
} as const;
