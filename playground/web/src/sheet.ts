// Style sheets that the first visit does not load.

const sheets = new Map<string, Promise<void>>();

/** Loads a style sheet of the page once; resolves when it is active, or could not be loaded. */
export function sheet(name: 'cases' | 'dialogs' | 'editing' | 'labs' | 'lesson' | 'real' | 'seeing'): Promise<void> {
  let known = sheets.get(name);
  if (!known) {
    const link = Object.assign(document.createElement('link'), { rel: 'stylesheet', href: new URL(`${name}.css`, import.meta.url).href });
    known = new Promise((resolve) => (link.onload = link.onerror = () => resolve()));
    sheets.set(name, known);
    document.head.append(link);
  }
  return known;
}
