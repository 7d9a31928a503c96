import { assert, test } from './testing';
import { bench } from './texts/bench';
import { bus } from './texts/bus';
import { cases } from './texts/cases';
import { classroom } from './texts/class';
import { catalogue } from './texts/de';
import { dialogs } from './texts/dialogs';
import { editor } from './texts/editor';
import { labs } from './texts/labs';
import { machine } from './texts/machine';
import { page } from './texts/page';
import { real } from './texts/real';
import { seeing } from './texts/seeing';

/** Texts with several words that are the same in both languages: what a user types, names of formats and of commands. */
const SAME = /^nmt |^emcy|^601#|^CAN-ID # |\(Wireshark\)|^(Vector|PEAK) |^Filter: node:5|^(slave|expect|write|heartbeat|sync) \d|^Enter Pre-operational$/;

/** Places at which the German catalogue lacks a text of the English one, has one more, or has it in English. */
function differences(english: unknown, german: unknown, place: string): string[] {
  if (typeof english === 'string') return typeof german !== 'string' ? [`${place} is missing`] : german === english && /\w \w/.test(english) && !SAME.test(english) ? [`${place} is English`] : [];
  if (typeof english === 'function') return typeof german === 'function' ? [] : [`${place} is missing`];
  if (typeof english !== 'object' || english === null) return [];
  if (typeof german !== 'object' || german === null) return [`${place} is missing`];
  const keys = new Set([...Object.keys(english), ...Object.keys(german)]);
  return [...keys].flatMap((key) => {
    const [one, other] = [english, german].map((texts) => (texts as Record<string, unknown>)[key]);
    return one === undefined ? [`${place}.${key} has no English text`] : differences(one, other, `${place}.${key}`);
  });
}

test('each text of the page is in German', () => {
  const english = { T: { ...bench, ...bus, ...page }, D: dialogs, E: editor, M: machine, R: real, S: seeing, L: labs, F: cases, C: classroom, W: (text: string) => text };
  assert.deepEqual(differences(english, catalogue, 'texts'), []);
  // The comparison itself sees each kind of difference.
  const { plot: _, ...less } = catalogue.T;
  assert.deepEqual(differences({ ...english.T, nmt: [...english.T.nmt, 'x y'], more: 'a b' }, { ...less, more: 'a b' }, 'T'), ['T.plot is missing', 'T.nmt.5 is missing', 'T.more is English']);
});
