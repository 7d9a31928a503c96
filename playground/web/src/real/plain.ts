// The description of a node without an EDS: what CiA 301 lets every node have.

import type { Source } from '../sim/api';

interface Row {
  index: number;
  sub?: number;
  name: string;
  /** Data type as in CiA 301. */
  type?: number;
  access?: string;
  value?: string;
  /** Number of sub-indices of a record (9). */
  members?: number;
}

const hex = (value: number): string => value.toString(16).toUpperCase();

function section({ index, sub, name, type = 7, access = 'ro', value = '', members }: Row): string {
  const head = `[${hex(index)}${sub === undefined ? '' : `sub${hex(sub)}`}]\nParameterName=${name}\n`;
  if (members !== undefined) return `${head}ObjectType=0x9\nSubNumber=${members}\n`;
  return `${head}ObjectType=0x7\nDataType=0x${hex(type).padStart(4, '0')}\nAccessType=${access}\nDefaultValue=${value}\nPDOMapping=0\n`;
}

const [U8, U16, U32, TEXT] = [5, 6, 7, 9];

/** The parameters of four PDOs: communication, and mapping. */
function pdos(parameter: number, mapping: number, kind: string, bases: number[]): Row[] {
  return bases.flatMap((base, i): Row[] => [
    { index: parameter + i, name: `${kind}PDO${i + 1} communication parameter`, members: 3 },
    { index: parameter + i, sub: 0, name: 'Highest sub-index', type: U8, value: '2' },
    { index: parameter + i, sub: 1, name: 'COB-ID', type: U32, access: 'rw', value: `$NODEID+0x${hex(base)}` },
    { index: parameter + i, sub: 2, name: 'Transmission type', type: U8, access: 'rw', value: '255' },
    { index: mapping + i, name: `${kind}PDO${i + 1} mapping parameter`, members: 9 },
    { index: mapping + i, sub: 0, name: 'Number of mapped objects', type: U8, access: 'rw', value: '0' },
    ...Array.from({ length: 8 }, (_, sub): Row => ({ index: mapping + i, sub: sub + 1, name: `Mapped object ${sub + 1}`, type: U32, access: 'rw', value: '0' })),
  ]);
}

const ROWS: Row[] = [
  { index: 0x1000, name: 'Device type', value: '0' },
  { index: 0x1001, name: 'Error register', type: U8, value: '0' },
  { index: 0x1018, name: 'Identity object', members: 5 },
  { index: 0x1018, sub: 0, name: 'Highest sub-index', type: U8, value: '4' },
  ...['Vendor-ID', 'Product code', 'Revision number', 'Serial number'].map((name, i): Row => ({ index: 0x1018, sub: i + 1, name, value: '0' })),
  { index: 0x1002, name: 'Manufacturer status register', value: '0' },
  { index: 0x1005, name: 'COB-ID SYNC message', access: 'rw', value: '0x80' },
  { index: 0x1008, name: 'Manufacturer device name', type: TEXT, access: 'const' },
  { index: 0x1009, name: 'Manufacturer hardware version', type: TEXT, access: 'const' },
  { index: 0x100a, name: 'Manufacturer software version', type: TEXT, access: 'const' },
  { index: 0x1014, name: 'COB-ID EMCY message', access: 'rw', value: '$NODEID+0x80' },
  { index: 0x1017, name: 'Producer heartbeat time', type: U16, access: 'rw', value: '0' },
  ...pdos(0x1400, 0x1600, 'R', [0x200, 0x300, 0x400, 0x500]),
  ...pdos(0x1800, 0x1a00, 'T', [0x180, 0x280, 0x380, 0x480]),
];

/** A list of objects, as CiA 306 counts them. */
function list(name: string, indices: number[]): string {
  return `[${name}]\nSupportedObjects=${indices.length}\n${indices.map((index, i) => `${i + 1}=0x${hex(index)}\n`).join('')}`;
}

const MANDATORY = [0x1000, 0x1001, 0x1018];

export function plain(name: string): Extract<Source, { kind: 'eds' }> {
  const indices = [...new Set(ROWS.map(({ index }) => index))].filter((index) => !MANDATORY.includes(index));
  const title = name.replace(/[\r\n]/g, ' ');
  const text = [
    `[DeviceInfo]\nVendorName=\nProductName=${title}\nNrOfRXPDO=4\nNrOfTXPDO=4\n`,
    list('MandatoryObjects', MANDATORY),
    list('OptionalObjects', indices),
    list('ManufacturerObjects', []),
    ...ROWS.map(section),
  ].join('\n');
  return { kind: 'eds', name, text, lenient: true };
}
