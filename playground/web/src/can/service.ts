// Which CANopen service a COB-ID belongs to, by the predefined connection set (CiA 301).

export type Service = 'NMT' | 'SYNC' | 'TIME' | 'EMCY' | 'PDO' | 'SDO' | 'HB' | 'LSS' | 'CAN' | 'ERR';

export interface Tag {
  service: Service;
  /** What the console shows: `PDO1`, `SDO`, … */
  text: string;
}

const tag = (service: Service, text: string = service): Tag => ({ service, text });

const FIXED = {
  nmt: tag('NMT'),
  sync: tag('SYNC'),
  time: tag('TIME'),
  emcy: tag('EMCY'),
  sdo: tag('SDO'),
  heartbeat: tag('HB'),
  lss: tag('LSS'),
  can: tag('CAN'),
  error: tag('ERR'),
  pdo: [1, 2, 3, 4].flatMap((n) => [tag('PDO', `PDO${n}`), tag('PDO', `RPDO${n}`)]),
};

export function classify(id: number, extended: boolean): Tag {
  if (extended) return FIXED.can;
  if (id === 0) return FIXED.nmt;
  if (id === 0x80) return FIXED.sync;
  if (id === 0x100) return FIXED.time;
  if (id === 0x7e4 || id === 0x7e5) return FIXED.lss;
  const node = id & 0x7f;
  if (node === 0) return FIXED.can;
  const code = id >> 7;
  if (code === 1) return FIXED.emcy;
  if (code >= 3 && code <= 10) return FIXED.pdo[code - 3] ?? FIXED.can;
  if (code === 11 || code === 12) return FIXED.sdo;
  if (code === 14) return FIXED.heartbeat;
  return FIXED.can;
}

/** The tag of a captured frame: one that was disturbed on the wire is an error. */
export const tagOf = (frame: { id: number; extended: boolean; disturbed: boolean }): Tag =>
  frame.disturbed ? FIXED.error : classify(frame.id, frame.extended);
