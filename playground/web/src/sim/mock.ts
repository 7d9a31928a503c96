// A stand-in for the WebAssembly bus: enough of an encoder to work on the page
// without a Rust toolchain (`npm run build -- --mock`). It never ships.

import type { Builtin, Bus, DeviceInfo, Leds, Nmt, ObjectRecord, Opened, Shaft, Value } from './api';
import { pack } from './packed';

const row = (index: number, sub: number, name: string, type: string, bits: number, access: ObjectRecord['access'], value: Value, parent: string | null = null, high: Value = null): ObjectRecord => ({
  index, sub, name, parent, type, bits, access, mappable: index === 0x6004, default: value, low: high === null ? null : 0, high,
});

const OBJECTS: ObjectRecord[] = [
  row(0x1000, 0, 'Device type', 'UNSIGNED32', 32, 'ro', 0x20196),
  row(0x1001, 0, 'Error register', 'UNSIGNED8', 8, 'ro', 0),
  row(0x1008, 0, 'Device name', 'VISIBLE_STRING', 0, 'const', 'GXMM'),
  row(0x1017, 0, 'Producer heartbeat time', 'UNSIGNED16', 16, 'rw', 0),
  row(0x1018, 0, 'Number of entries', 'UNSIGNED8', 8, 'ro', 4, 'Identity object'),
  row(0x1018, 1, 'Vendor ID', 'UNSIGNED32', 32, 'ro', 0xec, 'Identity object'),
  row(0x1018, 2, 'Product code', 'UNSIGNED32', 32, 'ro', 10, 'Identity object'),
  row(0x1018, 3, 'Revision number', 'UNSIGNED32', 32, 'ro', 0x10000, 'Identity object'),
  row(0x1018, 4, 'Serial number', 'UNSIGNED32', 32, 'ro', 4711, 'Identity object'),
  row(0x1800, 0, 'Number of entries', 'UNSIGNED8', 8, 'ro', 5, 'Transmit PDO1 parameter'),
  row(0x1800, 1, 'COB-ID', 'UNSIGNED32', 32, 'rw', 0x181, 'Transmit PDO1 parameter'),
  row(0x1800, 2, 'Transmission type', 'UNSIGNED8', 8, 'rw', 0xfe, 'Transmit PDO1 parameter'),
  row(0x1800, 5, 'Event timer', 'UNSIGNED16', 16, 'rw', 0x203, 'Transmit PDO1 parameter'),
  row(0x2100, 0, 'Baud rate', 'UNSIGNED8', 8, 'rw', 2, null, 8),
  row(0x2101, 0, 'Node ID', 'UNSIGNED8', 8, 'rw', 1, null, 127),
  ...Array.from({ length: 9 }, (_, sub) => row(0x2300, sub, sub ? `Data ${sub - 1}` : 'Number of entries', sub ? 'UNSIGNED16' : 'UNSIGNED8', sub ? 16 : 8, sub ? 'rw' : 'ro', sub ? 0 : 8, 'Customer EEPROM range')),
  row(0x6000, 0, 'Operating parameters', 'UNSIGNED16', 16, 'rw', 4),
  row(0x6001, 0, 'Measuring units per revolution', 'UNSIGNED32', 32, 'rw', 0x2000, null, 0x2000),
  row(0x6002, 0, 'Total measuring range', 'UNSIGNED32', 32, 'rw', 0x20000000, null, 0x20000000),
  row(0x6003, 0, 'Preset value', 'UNSIGNED32', 32, 'rw', 0),
  row(0x6004, 0, 'Position value', 'UNSIGNED32', 32, 'ro', 0),
  row(0x6200, 0, 'Cyclic timer', 'UNSIGNED16', 16, 'rw', 0x203),
  row(0x6503, 0, 'Alarms', 'UNSIGNED16', 16, 'ro', 0),
  row(0x6505, 0, 'Warnings', 'UNSIGNED16', 16, 'ro', 0),
  row(0x6509, 0, 'Offset value', 'UNSIGNED32', 32, 'ro', 0),
];

const key = (index: number, sub: number): number => index * 256 + sub;

export class MockBus implements Bus {
  private time = 0;
  private frames: Uint8Array[] = [];
  private values = new Map<number, Value>();
  private state: Nmt = 'off';
  private node = 1;
  private turns = 60.747;
  private speed = 0;
  private nextPdo = 0;

  builtins(): Builtin[] {
    return [{ name: 'gxmm', title: 'stand-in' }];
  }

  openBuiltin(name: string, nodeId: number): Opened {
    this.node = nodeId;
    const device: DeviceInfo = { name, title: 'Stand-in', nodeId, objects: OBJECTS };
    this.setPower(false);
    this.setPower(true);
    return { device, diagnostics: [] };
  }
  openEds(text: string, nodeId: number, lenient: boolean): Opened {
    if (!lenient && !text.includes('[1000]')) return { device: null, diagnostics: [{ code: 'E0101', severity: 'error', message: 'object 1000h is missing; every device has it', help: '', line: 1, column: 1, object: '1000h' }] };
    return this.openBuiltin('eds', nodeId);
  }
  private emit(id: number, bytes: number[], fromPage = false): void {
    this.frames.push(pack({ time: this.time, id, extended: false, remote: false, fromPage, data: new Uint8Array(bytes) }));
  }
  private le(value: number, bytes: number): number[] {
    return Array.from({ length: bytes }, (_, i) => Math.floor(value / 2 ** (8 * i)) & 255);
  }
  send(id: number, data: Uint8Array, extended: boolean, remote: boolean): void {
    this.frames.push(pack({ time: this.time, id, extended, remote, fromPage: true, data }));
    this.time += 200;
    if (this.state === 'off') return;
    if (id === 0 && (data[1] === 0 || data[1] === this.node)) {
      if (data[0] === 1) this.state = 'operational';
      if (data[0] === 2) this.state = 'stopped';
      if (data[0] === 0x80) this.state = 'pre-operational';
      if (data[0] === 0x81 || data[0] === 0x82) this.boot();
      this.nextPdo = this.time;
    }
    if (id === 0x600 + this.node && this.state !== 'stopped') this.sdo(data);
  }
  private sdo(data: Uint8Array): void {
    const index = data[1]! | (data[2]! << 8);
    const sub = data[3]!;
    const object = OBJECTS.find((o) => o.index === index && o.sub === sub);
    const answer = (command: number, value: number): void => this.emit(0x580 + this.node, [command, data[1]!, data[2]!, sub, ...this.le(value, 4)]);
    if (!object) answer(0x80, 0x06020000);
    else if (data[0] === 0x40) answer(object.bits === 8 ? 0x4f : object.bits === 16 ? 0x4b : 0x43, object.type === 'VISIBLE_STRING' ? 0x4d4d5847 : Number(this.read(index, sub)));
    else if (object.access === 'ro' || object.access === 'const') answer(0x80, 0x06010002);
    else {
      const view = new DataView(data.buffer, data.byteOffset);
      const value = object.bits === 8 ? data[4]! : object.bits === 16 ? view.getUint16(4, true) : view.getUint32(4, true);
      if (object.high !== null && value > Number(object.high)) return answer(0x80, 0x06090030);
      this.values.set(key(index, sub), value);
      answer(0x60, 0);
    }
  }
  private boot(): void {
    this.state = 'pre-operational';
    this.time += 1000;
    this.emit(0x700 + this.node, [0]);
  }
  advance(micros: number, maxFrames: number): number {
    const end = this.time + micros;
    const start = this.time;
    let count = 0;
    while (this.state === 'operational' && this.nextPdo <= end && count++ < maxFrames) {
      this.move(this.nextPdo - this.time);
      this.emit(0x180 + this.node, this.le(Number(this.read(0x6004, 0)), 4));
      this.nextPdo += Number(this.read(0x1800, 5)) * 1000;
    }
    this.move(end - this.time);
    return this.time - start;
  }
  private move(micros: number): void {
    if (micros <= 0) return;
    this.time += micros;
    this.turns += (this.speed * micros) / 60e6;
  }
  now(): number { return this.time; }
  pending(): number { return this.frames.length; }
  drain(): Uint8Array {
    const all = new Uint8Array(this.frames.length * 24);
    this.frames.forEach((frame, i) => all.set(frame, i * 24));
    this.frames = [];
    return all;
  }
  describe(frame: Uint8Array): string {
    const id = new DataView(frame.buffer, frame.byteOffset).getUint32(8, true);
    const d = frame.subarray(16);
    const name = OBJECTS.find((o) => o.index === (d[1]! | (d[2]! << 8)) && o.sub === d[3]);
    const what = `${(d[1]! | (d[2]! << 8)).toString(16).toUpperCase()}h ${name?.name ?? ''}`;
    if (id === 0) return ['', 'Start', 'Stop'][d[0]!] ?? 'Enter pre-operational';
    if (id > 0x700) return d[0] ? 'Heartbeat' : 'Boot-up: node 1 is there';
    if (id > 0x600) return d[0] === 0x40 ? `Read ${what}` : `Write ${what}`;
    if (id > 0x580) return d[0] === 0x80 ? `Abort ${what}: value outside the limits` : `Answer ${what}`;
    return 'TPDO1: Position value = 497 636';
  }
  read(index: number, sub: number): Value {
    if (this.state === 'off') return null;
    if (index === 0x6004) return Math.floor((this.turns * Number(this.read(0x6001, 0))) % 0x20000000);
    return this.values.get(key(index, sub)) ?? OBJECTS.find((o) => o.index === index && o.sub === sub)?.default ?? null;
  }
  nmt(): Nmt { return this.state; }
  leds(): Leds {
    return { green: this.state === 'off' ? 'off' : this.state === 'pre-operational' ? 'flashing' : 'on', red: 'off' };
  }
  nodeId(): number { return this.node; }
  setPower(on: boolean): void {
    if (on === this.powered()) return;
    this.state = 'off';
    if (on) this.boot();
  }
  powered(): boolean { return this.state !== 'off'; }
  shaft(): Shaft { return { turns: this.turns, rpm: this.speed, raw: Math.floor(this.turns * 8192) }; }
  setRpm(rpm: number): void { this.speed = rpm; }
  turnTo(turns: number): void { this.turns = turns; }
}
