import { assert, test } from '../testing';
import { pack } from '../sim/packed';
import { isLate, Nodes } from './nodes';
import { Ring } from './ring';

const send = (ring: Ring, time: number, id: number, ...bytes: number[]): void =>
  ring.append(pack({ time, id, extended: false, remote: false, fromPage: false, data: Uint8Array.from(bytes) }));

test('a node is what its frames tell', () => {
  const ring = new Ring();
  const nodes = new Nodes(ring);
  send(ring, 0, 0x705, 0);
  send(ring, 100, 0x605, 0x40, 0, 0x10, 0, 0, 0, 0, 0);
  send(ring, 200, 0x585, 0x43, 0, 0x10, 0, 0x96, 0x01, 0x02, 0);
  send(ring, 300, 0x204, 1);
  send(ring, 400, 0x085, 0x30, 0x81, 0x11, 0, 0, 0, 0, 0);
  nodes.follow();
  assert.equal(nodes.all.length, 1, 'a request and an RPDO do not make a node');
  const [five] = nodes.all;
  assert.deepEqual([five!.node, five!.frames, five!.state, five!.type, five!.emcy?.code, five!.emcy?.number], [5, 3, 'pre-operational', 0x20196, 0x8130, 4]);
  assert.equal(five!.heartbeat, null, 'a boot-up message is not a heartbeat');
  // An order is a guess until a heartbeat confirms it.
  send(ring, 500, 0x000, 1, 5);
  nodes.follow();
  assert.deepEqual([five!.state, five!.isOrdered], ['operational', true]);
  send(ring, 1000, 0x705, 5);
  send(ring, 2000, 0x705, 5);
  nodes.follow();
  assert.deepEqual([five!.state, five!.isOrdered, five!.heartbeat, five!.period], ['operational', false, 2000, 1000]);
  assert.equal(isLate(five!, 3400), false);
  assert.equal(isLate(five!, 3600), true);
  // A restart ends the errors of before.
  send(ring, 4000, 0x705, 0);
  nodes.follow();
  assert.deepEqual([five!.state, five!.emcy, five!.period], ['pre-operational', null, null]);
});

test('orders to all, other nodes, and a capture that was cleared', () => {
  const ring = new Ring();
  const nodes = new Nodes(ring);
  send(ring, 0, 0x706, 127);
  send(ring, 0, 0x181, 1, 2);
  send(ring, 1, 0x000, 2, 0);
  nodes.follow();
  assert.deepEqual(nodes.all.map(({ node, state }) => [node, state]), [[1, 'stopped'], [6, 'stopped']]);
  ring.truncate(1);
  nodes.follow();
  assert.deepEqual(nodes.all.map(({ node, state }) => [node, state]), [[6, 'pre-operational']]);
  // Bytes of a hostile log: no data, codes that do not exist.
  for (let id = 0; id < 0x800; id += 1) send(ring, 2, id, ...Array.from({ length: id % 9 }, () => 0xff));
  nodes.follow();
  assert.equal(nodes.all.find(({ node }) => node === 1)!.state, 'unknown');
  nodes.restart();
  assert.deepEqual(nodes.all, []);
});
