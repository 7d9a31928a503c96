// What a tab keeps until it is closed: a reload continues a fault case and the final test where they were.

/** The last fault case: the probes in their order, and the answer. */
export interface KeptCase {
  name: string;
  seed: number;
  probes: number[];
  chosen: number | null;
  isMarked: boolean;
}

/** The final test: lesson and step of its questions, and the answers up to now. */
export interface KeptTest {
  asked: [lesson: string, step: number][];
  given: { text: string; isRight: boolean }[];
}

const KEYS = { case: 'odkit.case', test: 'odkit.test' };
type Kinds = { case: KeptCase; test: KeptTest };
/** Another version of the page may have stored something else. */
const LISTS = { case: ['probes'], test: ['asked', 'given'] };

export function kept<Kind extends keyof Kinds>(kind: Kind): Kinds[Kind] | null {
  try {
    const value = JSON.parse(sessionStorage.getItem(KEYS[kind]) ?? 'null') as Record<string, unknown> | null;
    return value && LISTS[kind].every((name) => Array.isArray(value[name])) ? (value as unknown as Kinds[Kind]) : null;
  } catch {
    return null;
  }
}

export function keep<Kind extends keyof Kinds>(kind: Kind, value: Kinds[Kind]): void {
  try {
    sessionStorage.setItem(KEYS[kind], JSON.stringify(value));
  } catch {
    // Storage is not allowed: a reload begins again.
  }
}

/** Removes both. */
export function forget(): void {
  try {
    for (const key of Object.values(KEYS)) sessionStorage.removeItem(key);
  } catch {
    // Storage is not allowed: there is nothing.
  }
}

/** Number of answers and of questions of the last final test; null if it has no answer. */
export function begunTest(): { given: number; all: number } | null {
  const test = kept('test');
  return test && test.given.length > 0 ? { given: test.given.length, all: test.asked.length } : null;
}
