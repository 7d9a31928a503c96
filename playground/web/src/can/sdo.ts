// An SDO client (CiA 301, expedited and segmented). It sends and receives frames
// like any master on the bus; the console shows each of them.

export interface Request {
  index: number;
  sub: number;
  /** Bytes to write; none to read. */
  bytes: Uint8Array | null;
}

export type Outcome =
  | { kind: 'read'; bytes: Uint8Array }
  | { kind: 'written' }
  | { kind: 'aborted'; code: number }
  | { kind: 'silent' };

/** Virtual microseconds that the node may take to answer. */
export const PATIENCE = 500_000;

export class Transfer {
  private toggle = 0;
  private received: number[] = [];
  private sent = 0;
  private deadline = Number.POSITIVE_INFINITY;
  private state: 'initiate' | 'segments' = 'initiate';

  constructor(
    readonly nodeId: number,
    readonly request: Request,
    private readonly send: (id: number, data: Uint8Array) => void,
    private readonly done: (outcome: Outcome) => void,
  ) {}

  start(): void {
    const { index, sub, bytes } = this.request;
    const frame = new Uint8Array(8);
    frame.set([0x40, index & 255, index >> 8, sub]);
    if (bytes && bytes.length <= 4 && bytes.length > 0) {
      frame[0] = 0x23 | ((4 - bytes.length) << 2);
      frame.set(bytes, 4);
    } else if (bytes) {
      frame[0] = 0x21;
      new DataView(frame.buffer).setUint32(4, bytes.length, true);
    }
    this.transmit(frame);
  }

  private transmit(frame: Uint8Array): void {
    this.deadline = Number.POSITIVE_INFINITY;
    this.send(0x600 + this.nodeId, frame);
  }

  /** Gives up when the node is silent too long; called with the virtual time. */
  tick(now: number): void {
    if (this.deadline === Number.POSITIVE_INFINITY) this.deadline = now + PATIENCE;
    if (now > this.deadline) this.done({ kind: 'silent' });
  }

  /** A frame from the bus; true when it belonged to this transfer. */
  receive(id: number, data: Uint8Array): boolean {
    if (id !== 0x580 + this.nodeId || data.length < 8) return false;
    const command = data[0]!;
    const view = new DataView(data.buffer, data.byteOffset, data.length);
    if (command >> 5 === 4) {
      this.done({ kind: 'aborted', code: view.getUint32(4, true) });
    } else if (this.state === 'initiate') {
      if (view.getUint16(1, true) !== this.request.index || data[3] !== this.request.sub) return false;
      if (this.request.bytes) this.initiatedDownload(command);
      else this.initiatedUpload(command, data);
    } else if (this.request.bytes) {
      this.downloadSegment();
    } else {
      this.uploadedSegment(command, data);
    }
    return true;
  }

  private initiatedUpload(command: number, data: Uint8Array): void {
    if (command >> 5 !== 2) return;
    if (command & 2) {
      const length = command & 1 ? 4 - ((command >> 2) & 3) : 4;
      this.done({ kind: 'read', bytes: data.slice(4, 4 + length) });
      return;
    }
    this.state = 'segments';
    this.askSegment();
  }

  private askSegment(): void {
    const frame = new Uint8Array(8);
    frame[0] = 0x60 | this.toggle;
    this.toggle ^= 0x10;
    this.transmit(frame);
  }

  private uploadedSegment(command: number, data: Uint8Array): void {
    this.received.push(...data.subarray(1, 8 - ((command >> 1) & 7)));
    if (command & 1) this.done({ kind: 'read', bytes: Uint8Array.from(this.received) });
    else this.askSegment();
  }

  private initiatedDownload(command: number): void {
    if (command >> 5 !== 3) return;
    const bytes = this.request.bytes!;
    if (bytes.length <= 4 && bytes.length > 0) {
      this.done({ kind: 'written' });
      return;
    }
    this.state = 'segments';
    this.downloadSegment();
  }

  private downloadSegment(): void {
    const bytes = this.request.bytes!;
    if (this.sent >= bytes.length && this.sent > 0) {
      this.done({ kind: 'written' });
      return;
    }
    const part = bytes.subarray(this.sent, this.sent + 7);
    this.sent += Math.max(part.length, 1);
    const frame = new Uint8Array(8);
    frame[0] = this.toggle | ((7 - part.length) << 1) | (this.sent >= bytes.length ? 1 : 0);
    frame.set(part, 1);
    this.toggle ^= 0x10;
    this.transmit(frame);
  }
}
