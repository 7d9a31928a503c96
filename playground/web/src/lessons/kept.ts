// Which lessons were done in this browser.

const KEY = 'odkit.lessons';

export function finished(): Set<string> {
  try {
    return new Set(JSON.parse(localStorage.getItem(KEY) ?? '[]') as string[]);
  } catch {
    return new Set();
  }
}

export function finish(name: string): void {
  const all = finished();
  if (all.has(name)) return;
  try {
    localStorage.setItem(KEY, JSON.stringify([...all.add(name)]));
  } catch {
    // Storage is off: nothing is kept.
  }
}
