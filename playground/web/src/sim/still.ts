// A bench without its past: what has to be done to an empty one so that it stands as this
// one stands now. Shorter than a long run, and quicker to make again.

import type { Entry, Input, Status } from './api';
import type { World } from './world';

/** NMT commands that lead to a state. */
const COMMANDS: Record<string, number> = { operational: 1, stopped: 2 };

type Device = World['devices'][number];

/** Null where devices stand in an order that adding them does not give. */
export function still(world: World): Entry[] | null {
  const { bus, devices } = world;
  const past = world.journal.slice(0, world.done).map(({ input }) => input);
  if (!isRegular(devices, past)) return null;
  const stations = devices.map((_, node) => bus.status(node) as Status);
  // While it is set up, every frame comes through.
  const inputs: Input[] = [{ op: 'line', real: false, terminators: 2, rate: null }];
  for (const device of devices) {
    if (!isChannel(device)) inputs.push({ op: 'add', source: device.source, nodeId: device.nodeId });
  }
  const each = (made: (node: number, station: Status) => Input[]): void => stations.forEach((station, node) => inputs.push(...made(node, station)));
  each((node, station) => (station.shaft ? [{ op: 'turn', node, turns: station.shaft.turns }] : []));
  // What is not saved comes from a memory that it is saved in; the true one is put back
  // afterwards, and acts at the next start.
  each((node) => [{ op: 'eeprom', node, bytes: bus.image(node) }]);
  each(switches);
  each((node) => [{ op: 'power', node, on: false }]);
  each((node, station) => (station.powered ? [{ op: 'power', node, on: true }] : []));
  each((node) => [{ op: 'eeprom', node, bytes: bus.eeprom(node) }]);
  each((node, { faults }) => faults.map((name): Input => ({ op: 'fault', node, name, on: true })));
  each((node, { nmt }) => (COMMANDS[nmt] ? [{ op: 'deliver', node, id: 0, data: Uint8Array.of(COMMANDS[nmt], 0) }] : []));
  each((node, station) => motion(node, station, past));
  inputs.push(...rhythms(past));
  const { real, terminators, fixedRate: rate } = bus.line();
  inputs.push({ op: 'line', real, terminators, rate });
  const seed = past.findLast((input) => input.op === 'seed');
  if (seed) inputs.push(seed);
  each((node, { plugged }) => (plugged ? [] : [{ op: 'plug', station: node + 1, on: false }]));
  if (!bus.line().plugged) inputs.push({ op: 'plug', station: 0, on: false });
  return inputs.map((input) => ({ at: 0, input }));
}

const isChannel = ({ name, source }: Device): boolean => name.startsWith(`${source.name}.`);

/** The channels of an encoder come with its first one, behind all that is there by then. */
function isRegular(devices: Device[], past: Input[]): boolean {
  if (!devices.some(isChannel)) return true;
  const isInPlace = (device: Device, i: number): boolean => !isChannel(device) || devices[i - 1]?.source.name === device.source.name;
  return devices.every(isInPlace) && !past.some((input) => input.op === 'remove' || (input.op === 'add' && input.place !== undefined));
}

function switches(node: number, { nodeSwitch, rateSwitch }: Status): Input[] {
  const dips = [1, 2, 4].map((bit): Input => ({ op: 'switches', node, dip: { bit, on: (rateSwitch & bit) !== 0 } }));
  return [{ op: 'switches', node, id: nodeSwitch }, ...dips];
}

/** A shaft that follows a profile begins it again. */
function motion(node: number, { shaft, moves }: Status, past: Input[]): Input[] {
  const profile = moves ? past.findLast((input) => input.op === 'follow' && input.node === node) : undefined;
  if (profile) return [profile];
  return shaft && shaft.rpm !== 0 ? [{ op: 'rpm', node, rpm: shaft.rpm }] : [];
}

/** Frames that are sent again and again. */
function rhythms(past: Input[]): Input[] {
  const latest = new Map<number, Input & { op: 'repeat' }>();
  for (const input of past) if (input.op === 'repeat') latest.set(input.key, input);
  return [...latest.values()].filter((input) => input.micros > 0);
}
