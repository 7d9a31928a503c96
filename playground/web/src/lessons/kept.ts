// The progress in lessons, kept in this browser, and the code with which a learner reports it. Nothing is sent.

/** Steps done, all steps, the day of the last one, and the number of steps that `Show me` did. */
export type Done = [done: number, all: number, day: string, shown?: number];
export type Progress = Record<string, Done>;

/** A class serves the page: what it keeps belongs to the class. */
export const isClass = 'class' in (globalThis.document?.documentElement.dataset ?? {});

/** Lessons that are done, as earlier versions of the page kept them. */
const OLD = 'odkit.lessons';
const KEY = isClass ? 'odkit.class.progress' : 'odkit.progress';

const read = <T>(key: string, none: T): T => {
  try {
    return (JSON.parse(localStorage.getItem(key) ?? 'null') as T | null) ?? none;
  } catch {
    return none;
  }
};

const isDone = (value: unknown): value is Done =>
  Array.isArray(value) && (value.length === 3 || value.length === 4) && [value[0], value[1], value[3] ?? 0].every((count) => Number.isSafeInteger(count) && count >= 0) && /^\d{4}-\d\d-\d\d$/.test(String(value[2]));

/** The progress of this visit, if the browser stores nothing. */
let unstored: Progress = {};

/** Removes the progress. */
export function clear(): void {
  unstored = {};
  try {
    localStorage.removeItem(KEY);
  } catch {
    // Storage is not allowed: there is none.
  }
}

/** Other content of the storage is ignored. */
export const progress = (): Progress => {
  const known: unknown = { ...read(KEY, {}), ...unstored };
  return Object.fromEntries(Object.entries(known ?? {}).filter((one): one is [string, Done] => isDone(one[1])));
};

const old = (): string[] => {
  const names: unknown = isClass ? [] : read(OLD, []);
  return Array.isArray(names) ? names.filter((name) => typeof name === 'string') : [];
};

/** Number of questions of the final test, and of right answers for a certificate. */
export const QUESTIONS = 12;
export const NEEDED = 10;

/** Name of the final test in the progress. */
export const FINAL = 'final-test';

export const finished = (): Set<string> =>
  new Set([...old(), ...Object.entries(progress()).filter(([, [done, all]]) => done >= all).map(([name]) => name)]);

/** Records the number of completed steps, and whether `Show me` did the last one; repeating a lesson does not reduce it. */
export function reached(name: string, done: number, all: number, wasShown: boolean): void {
  const known = progress();
  const [before = 0, of, , shown = 0] = Object.hasOwn(known, name) ? known[name]! : [];
  if (done === 0 || (done <= before && of === all)) return;
  const now: Progress = { ...known, [name]: [done, all, new Date().toISOString().slice(0, 10), shown + (wasShown ? 1 : 0)] };
  try {
    localStorage.setItem(KEY, JSON.stringify(now));
  } catch {
    // Storage is not allowed, or full.
    unstored = now;
  }
}

/** FNV-1a of 32 bits, which detects a truncated or mistyped code. */
function sum(text: string): string {
  let hash = 0x811c9dc5;
  for (const byte of new TextEncoder().encode(text)) hash = Math.imul(hash ^ byte, 0x01000193) >>> 0;
  return hash.toString(16).toUpperCase().padStart(8, '0');
}

/** A word of the code: no white space, no `=`. */
const word = (text: string): string => encodeURIComponent(text.trim()).replaceAll(/[!'()*]/g, (one) => `%${one.charCodeAt(0).toString(16).toUpperCase()}`);

/** The code of a learner, which `odkit lesson progress` reads. */
export function codeOf(learner: string, known: Progress): string {
  const lessons = Object.entries(known).map(([name, [done, all, day, shown = 0]]) => `${word(name)}=${done}/${all}${shown ? `~${shown}` : ''}@${day}`);
  const text = ['odkit-progress/1', `learner=${word(learner)}`, ...lessons].join(' ');
  return `${text} sum=${sum(text)}`;
}
