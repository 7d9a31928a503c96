// Finds objects by typed text: an index, a sub-index, parts of a name.

import type { Address, ObjectRecord } from '../sim/api';

/** `6004`, `0x6004`, `6004h`, `1018:1`, `1018h:01`, `1018sub1`, `1018.1`, and the same with a name after it. */
export function parseAddress(text: string): Address | null {
  const match = /^\s*(?:0x)?([0-9a-f]{4})h?\s*(?:(?:sub|[:./,])\s*(?:0x)?([0-9a-f]{1,2})h?)?(?:\s|$)/i.exec(text);
  if (!match?.[1]) return null;
  return { index: Number.parseInt(match[1], 16), sub: Number.parseInt(match[2] ?? '0', 16) };
}

/** Objects that match the text, in the order of the dictionary; all words must match. */
export function findObjects(objects: readonly ObjectRecord[], text: string): ObjectRecord[] {
  const words = text.toLowerCase().split(/\s+/).filter(Boolean);
  if (words.length === 0) return [...objects];
  return objects.filter((object) => {
    const index = object.index.toString(16).padStart(4, '0');
    const sub = object.sub.toString(16).padStart(2, '0');
    const spelled = `${index}h:${sub} ${object.name} ${object.parent ?? ''}`.toLowerCase();
    return words.every((word) => {
      const where = /^(?:0x)?([0-9a-f]{1,4})h?(?:(?:sub|[:./])([0-9a-f]{0,2})h?)?$/.exec(word);
      if (where?.[1] && index.startsWith(where[1])) {
        return where[2] === undefined || Number.parseInt(where[2] || '0', 16) === object.sub || where[2] === '';
      }
      return spelled.includes(word);
    });
  });
}

/** An object outside the dictionary, as far as it is known. */
export const standIn = (known: Pick<ObjectRecord, 'index' | 'sub' | 'name' | 'type' | 'bits'> & Partial<ObjectRecord>): ObjectRecord => ({
  parent: null, access: 'rw', mappable: false, fitsTpdo: false, fitsRpdo: false, isMapping: false, isSaved: false, default: null, low: null, high: null, ...known,
});
