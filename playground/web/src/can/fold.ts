// SDO transfers as one: a segmented or block transfer is folded into the row of its first frame.

import type { Frame } from '../sim/packed';

export interface Fold {
  /** Numbers of its frames. */
  frames: number[];
  node: number;
  index: number;
  sub: number;
  isWrite: boolean;
  /** What was transferred so far. */
  bytes: number[];
  /** How long it says it is; null where it does not. */
  length: number | null;
  state: 'under way' | 'done' | 'aborted';
}

type Phase = 'request' | 'upload' | 'download' | 'block upload' | 'block download' | 'block end';

interface Open extends Fold {
  phase: Phase;
  /** Its request; after the last segment went by, `LAST`. */
  first: Frame;
}

/** Most bytes that are kept of a transfer. */
const MOST = 1 << 20;

export class Folder {
  private readonly open = new Map<number, Open>();

  clear(): void {
    this.open.clear();
  }

  /**
   * Takes the next frame. Answers with the fold that swallows it, or null where it has a row
   * of its own; the first frame of a fold has.
   */
  take(frame: Frame, number: number): Fold | null {
    const { id } = frame;
    if (frame.extended || frame.disturbed || frame.remote || id < 0x581 || id > 0x67f || (id > 0x5ff && id < 0x601)) return null;
    const node = id & 0x7f;
    const isAnswer = id < 0x600;
    const fold = this.open.get(node);
    const command = frame.data[0] ?? 0;
    if (!isAnswer && begins(command, fold)) {
      this.begin(frame, number, node, command);
      return null;
    }
    if (!fold || (fold.phase === 'request' && !isAnswer)) return null;
    if (command === 0x80) {
      this.open.delete(node);
      if (fold.phase === 'request') return null;
      fold.state = 'aborted';
      fold.frames.push(number);
      return fold;
    }
    const isSwallowed = isAnswer ? this.answer(fold, frame, command) : this.request(fold, frame, command);
    if (fold.state !== 'under way' || fold.phase === 'request') this.open.delete(node);
    if (!isSwallowed) return null;
    fold.frames.push(number);
    return fold;
  }

  private begin(frame: Frame, number: number, node: number, command: number): void {
    const { data } = frame;
    const kind = command >> 5;
    const isWrite = kind === 1 || kind === 6;
    const length = (kind === 1 && command & 1) || (kind === 6 && command & 2) ? uint32(data) : null;
    this.open.set(node, {
      frames: [number], node, index: (data[1] ?? 0) | ((data[2] ?? 0) << 8), sub: data[3] ?? 0, isWrite, bytes: [], length,
      state: 'under way', phase: 'request', first: frame,
    });
  }

  private answer(fold: Open, { data }: Frame, command: number): boolean {
    const kind = command >> 5;
    switch (fold.phase) {
      case 'request':
        if (fold.isWrite && kind === 3 && !(fold.first.data[0]! & 2) && fold.first.data[0]! >> 5 === 1) fold.phase = 'download';
        else if (fold.isWrite && kind === 5) fold.phase = 'block download';
        else if (!fold.isWrite && kind === 2 && !(command & 2)) fold.phase = 'upload';
        else if (!fold.isWrite && kind === 6) fold.phase = 'block upload';
        else return false;
        if (!fold.isWrite && command & (kind === 6 ? 2 : 1)) fold.length = uint32(data);
        return true;
      case 'upload':
        keep(fold, data.subarray(1, 8 - ((command >> 1) & 7)));
        if (command & 1) fold.state = 'done';
        return true;
      case 'block upload':
        if (kind === 6 && (command & 3) === 1 && fold.bytes.length > 0) {
          fold.bytes.length = Math.max(0, fold.bytes.length - ((command >> 2) & 7));
          fold.phase = 'block end';
        } else {
          keep(fold, data.subarray(1, 8));
        }
        return true;
      case 'download':
        if (fold.first === LAST) fold.state = 'done';
        return true;
      case 'block download':
        if (kind === 5 && (command & 3) === 1) fold.state = 'done';
        return true;
      default:
        return true;
    }
  }

  private request(fold: Open, { data }: Frame, command: number): boolean {
    switch (fold.phase) {
      case 'download':
        keep(fold, data.subarray(1, 8 - ((command >> 1) & 7)));
        if (command & 1) fold.first = LAST;
        return true;
      case 'block download':
        if (fold.first === LAST && command >> 5 === 6 && command & 1) fold.bytes.length = Math.max(0, fold.bytes.length - ((command >> 2) & 7));
        else {
          keep(fold, data.subarray(1, 8));
          if (command & 0x80) fold.first = LAST;
        }
        return true;
      case 'block end':
        fold.state = 'done';
        return true;
      default:
        return true;
    }
  }
}

/** Stands for the first frame once the last segment went by. */
const LAST = { data: new Uint8Array([0]) } as unknown as Frame;

/** Does a request begin a new transfer? Segments and confirmations do not. */
function begins(command: number, fold: Open | undefined): boolean {
  if (fold?.phase === 'block download') return false;
  const kind = command >> 5;
  if (kind === 1 || kind === 2) return true;
  if (kind === 6) return (command & 1) === 0;
  return kind === 5 && (command & 3) === 0;
}

const uint32 = (data: Uint8Array): number => new DataView(data.buffer, data.byteOffset, data.length).getUint32(4, true);

function keep(fold: Open, bytes: Uint8Array): void {
  if (fold.bytes.length < MOST) fold.bytes.push(...bytes);
}
