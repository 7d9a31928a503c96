// The bus of the WebAssembly package, with the one device that the page shows.

import { Bus as Simulation, builtinDevices } from '../wasm/od_playground';
import type { Builtin, Bus, Diagnostic, Leds, Nmt, Opened, Shaft, Value } from './api';

const DEVICE = 0;

export class WasmBus implements Bus {
  private bus = new Simulation();

  /** A fresh bus at the same moment: the device before is unplugged. */
  private replace(add: (bus: Simulation) => { name: string; diagnostics: Diagnostic[] } | Diagnostic[]): Opened {
    const fresh = new Simulation(this.bus.now());
    const added = add(fresh);
    if (Array.isArray(added)) {
      fresh.free();
      return { device: null, diagnostics: added };
    }
    this.bus.free();
    this.bus = fresh;
    const device = { name: added.name, title: fresh.title(DEVICE), nodeId: fresh.nodeId(DEVICE), objects: fresh.dictionary(DEVICE) };
    return { device, diagnostics: added.diagnostics };
  }

  builtins(): Builtin[] {
    return builtinDevices();
  }

  openBuiltin(name: string, nodeId: number): Opened {
    return this.replace((bus) => {
      try {
        bus.addDevice(name, nodeId);
        return { name, diagnostics: [] };
      } catch (error) {
        const message = error instanceof Error ? error.message : String(error);
        return [{ code: '', severity: 'error', message, help: '', line: 0, column: 0, object: '' }];
      }
    });
  }

  openEds(text: string, nodeId: number, lenient: boolean): Opened {
    return this.replace((bus) => {
      const { device, diagnostics } = bus.addEds(text, nodeId, lenient);
      return device === null ? diagnostics : { name: bus.title(DEVICE), diagnostics };
    });
  }

  send(id: number, data: Uint8Array, extended: boolean, remote: boolean): void {
    this.bus.send(id, data, extended, remote);
  }
  advance(micros: number, maxFrames: number): number {
    return this.bus.advance(micros, maxFrames);
  }
  now(): number {
    return this.bus.now();
  }
  pending(): number {
    return this.bus.pending();
  }
  drain(): Uint8Array {
    return this.bus.drain();
  }
  describe(frame: Uint8Array): string {
    return this.bus.describe(frame);
  }
  read(index: number, sub: number): Value {
    return this.bus.read(DEVICE, index, sub);
  }
  nmt(): Nmt {
    return this.bus.nmt(DEVICE);
  }
  leds(): Leds {
    return this.bus.leds(DEVICE);
  }
  nodeId(): number {
    return this.bus.nodeId(DEVICE);
  }
  setPower(on: boolean): void {
    this.bus.setPower(DEVICE, on);
  }
  powered(): boolean {
    return this.bus.powered(DEVICE);
  }
  shaft(): Shaft | null {
    return this.bus.shaft(DEVICE);
  }
  setRpm(rpm: number): void {
    this.bus.setRpm(DEVICE, rpm);
  }
  turnTo(turns: number): void {
    this.bus.turnTo(DEVICE, turns);
  }
}
