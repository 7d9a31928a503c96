// A real bus: fetched when the user connects to one.

import type { Why } from '../real/api';

const frames = (count: number): string => `${count.toLocaleString('en')} frame${count === 1 ? '' : 's'}`;

export const real = {
  mark: 'Real bus',
  markTitle: 'These frames are on a real bus. Click for the connection.',
  title: 'Connect to a real bus',
  connected: 'Real bus',
  what: 'The frames of a real CAN bus are shown in this page. The virtual bench is paused and kept. Sending is off until you switch it on. Without hardware, close this: the bench of the page needs none.',
  webSocket: 'odkit on this computer',
  address: 'Address',
  addressHint: 'odkit sim and odkit bridge print it, for example: odkit bridge --link socketcan:can0 --link ws:127.0.0.1:29538',
  connect: 'Connect',
  connecting: 'Connecting …',
  cancel: 'Cancel',
  serial: 'CAN adapter that speaks slcan',
  serialHint: 'The page opens the serial port of the adapter (Web Serial).',
  notChosen: 'No adapter was chosen. If the browser does not list yours, plug it in again and check that the computer shows it as a serial port; on Linux your user needs access to the port (often the group dialout).',
  noSerial: 'This browser does not support Web Serial; Chrome and Edge do. Every browser can connect to odkit.',
  rate: 'Bit rate of the bus',
  keepRate: 'as set in the adapter',
  kbit: (rate: number) => `${rate} kbit/s`,
  baud: 'Serial port',
  baudOf: (baud: number) => `${baud.toLocaleString('en')} baud`,
  choose: 'Choose adapter',
  along: 'The virtual devices go on the bus too',
  alongHint: 'Their frames are sent once sending is on. Give them node IDs that the bus does not have.',
  bad: {
    empty: 'Paste the address that odkit printed.',
    wrong: 'This is not an address. Write ws://127.0.0.1:29538/?token=… as odkit printed it.',
    far: 'Pages may connect to this computer only (127.0.0.1 or localhost). Run odkit bridge on this computer.',
    noToken: 'The address has no token. Copy the whole address that odkit printed.',
    port: (why: string) => `The port cannot be opened: ${why}`,
  },
  why: (why: Why, name: string, isSerial: boolean): string => {
    switch (why.kind) {
      case 'said':
        return `${name} refused the connection: ${why.text}`;
      case 'refused':
        return `Nothing answers at ${name}. Start odkit sim or odkit bridge there, and compare the port.`;
      case 'denied':
        return `${name} refused the connection. Too many clients may be connected.`;
      case 'slow':
        return `${name} does not complete the connection. Another program may use this port.`;
      case 'silent':
        return isSerial ? 'The adapter does not answer. Check that it speaks slcan, and the speed of its serial port.' : `${name} does not answer in slcan.`;
      case 'closed':
        return 'The adapter does not open its CAN channel. Choose a bit rate.';
      case 'gone':
        return isSerial ? 'The adapter was unplugged.' : `${name} closed the connection.`;
    }
  },
  lost: 'Connection lost',
  retries: 'The page tries again every few seconds. Sending stays off.',
  replug: 'Plug the adapter in again.',
  again: 'Reconnect',
  back: 'Back to the virtual bench',
  sending: 'Sending',
  on: 'Sending is on',
  off: 'Sending is off',
  onTitle: 'Frames of this page and of its virtual devices go out. Click to switch sending off.',
  offTitle: 'The page only listens. Click to switch sending on.',
  turnOn: 'Switch on',
  held: 'Sending to the real bus is off.',
  heldBack: (count: number) => `${frames(count)} held back while sending was off`,
  dropped: (count: number) => `${frames(count)} dropped: the page is too slow`,
  unsent: (count: number) => `${frames(count)} not sent: the link is too slow`,
  refused: (count: number) => `${frames(count)} refused by the adapter; it may be bus-off`,
  noise: (count: number) => `${count.toLocaleString('en')} line${count === 1 ? '' : 's'} not understood; check the speed of the serial port`,
  came: (count: number) => `${frames(count)} received`,
  saveTitle: 'Save the frames of the real bus',
  leftWith: (count: number) => `You are back on the virtual bench. ${frames(count)} of the real bus can be saved.`,
  left: 'You are back on the virtual bench.',
  save: 'Save log',
  nodes: 'Nodes that were heard',
  noNodes: 'No heartbeat or SDO response so far.',
  scan: 'Search for nodes',
  scanTitle: 'Reads 1000h of every node ID, 1 to 127',
  scanning: (node: number) => `Asking node ${node} …`,
  found: (count: number) => (count ? `${count} node${count === 1 ? '' : 's'} answered.` : 'No node answered.'),
  show: 'Show',
  node: (node: number) => `Node ${node}`,
  asked: (node: number) => `Reading the identity of node ${node} …`,
  noAnswer: (node: number) => `Node ${node} does not answer SDO requests.`,
  panel: 'Node',
  identity: 'Identity',
  readAll: 'Read all values',
  reading: (done: number, all: number) => `${done} of ${all} read`,
  stop: 'Stop',
  description: 'The objects are those of',
  changeDescription: 'Choose another description',
  valuesHint: 'Values appear when they are read or when a PDO carries them.',
  never: 'No heartbeat so far: the NMT state is not known.',
  describes: 'A node of the real bus, described by this file',
  virtual: 'A virtual device that goes on the real bus',
  kindOf: 'What to add to the bus',
};
