// Recognises files that are not an EDS, by their first bytes or their text.

import type { Log } from '../sim/api';
import { use } from '../sim/link';
import { E } from './texts';

/** Description of the file, and what to do with it; a log can be shown. */
export interface Kind {
  what: string;
  next?: string;
  log?: Log;
  /** It is empty, so a description can be written into it. */
  isEmpty?: true;
}

/** First bytes, as a text with one character for each byte, and the kinds of file that begin with them. */
const magic = (k: typeof E.kinds): [RegExp, Kind][] => [
  [/^\x89PNG\r\n/, { what: k.picture('PNG') }],
  [/^\xff\xd8\xff/, { what: k.picture('JPEG') }],
  [/^GIF8[79]a/, { what: k.picture('GIF') }],
  [/^BM[^]{4}\0\0\0\0/, { what: k.picture('BMP') }],
  [/^RIFF[^]{4}WEBP/, { what: k.picture('WebP') }],
  [/^(II\*\0|MM\0\*)/, { what: k.picture('TIFF') }],
  [/^%PDF-/, { what: k.pdf }],
  [/^PK(\x03\x04|\x05\x06)/, { what: k.zip, next: k.unpack }],
  [/^\x1f\x8b/, { what: k.archive('gzip'), next: k.unpack }],
  [/^7z\xbc\xaf\x27\x1c/, { what: k.archive('7z'), next: k.unpack }],
  [/^Rar!\x1a\x07/, { what: k.archive('RAR'), next: k.unpack }],
  [/^(\x7fELF|MZ[^]{58})/, { what: k.program }],
  [/^\0asm/, { what: k.program }],
];
const HEAD = 4096;
/** A line of an EDS: a section, a comment or a key with a value. */
const SECTION = /^[ \t]*\[[^\]\r\n]+\]/m;

/** Kind of the file, or the text of a file that may be an EDS, a DCF or an XDD. */
export async function kindOf(bytes: Uint8Array): Promise<Kind | string> {
  const k = E.kinds;
  if (bytes.length === 0) return { what: k.empty, next: k.write, isEmpty: true };
  const head = Array.from(bytes.subarray(0, HEAD), (byte) => String.fromCharCode(byte)).join('');
  const known = magic(k).find(([pattern]) => pattern.test(head));
  if (known) return known[1];
  const log = await use('readLog', bytes);
  if ('value' in log && log.value.count > 0) return { what: k.log(log.value.count), log: log.value };
  const decoded = await use('decodeEds', bytes);
  const text = 'value' in decoded ? decoded.value : '';
  if (/^\s*$/.test(text)) return { what: k.blank, next: k.write, isEmpty: true };
  if (/\0/.test(text)) return { what: k.binary };
  const foreign = await use('foreignFile', text);
  if ('value' in foreign && foreign.value) return { what: foreign.value };
  if (/^\s*<(!doctype html|html)/i.test(text)) return { what: k.webPage };
  if (/^\s*<\?xml|^\s*<[a-z]/i.test(text)) return /ISO15745Profile/.test(text) ? text : { what: k.xml };
  // An array of JSON looks like a section.
  if (/^\s*[[{]/.test(text) && isJson(text)) return { what: k.json };
  return SECTION.test(text) ? text : { what: k.text };
}

function isJson(text: string): boolean {
  try {
    JSON.parse(text);
    return true;
  } catch {
    return false;
  }
}
