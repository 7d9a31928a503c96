// The language of the page. The script of index.html has chosen it; the German texts are loaded before anything is drawn.

import { signal } from '@preact/signals-core';
import type { catalogue } from './texts/de';

export type Language = 'en' | 'de';

/** The German texts; null while the page is in English. Views draw themselves again when it changes. */
export const german = signal<typeof catalogue | null>(null);

/** The language of the page. */
export const language = (): Language => (german.value ? 'de' : 'en');

/** A text of the module, which speaks English, in the language of the page: words of a frame, a refusal, a notice. */
export const said = (english: string): string => german.peek()?.W(english) ?? english;

/** Shows the page in this language; rejects if its texts cannot be loaded. */
export async function speak(chosen: Language): Promise<void> {
  german.value = chosen === 'de' ? (await import('./texts/de')).catalogue : null;
  document.documentElement.lang = chosen;
}

// Workers and tests have no document.
if (globalThis.document?.documentElement.lang === 'de') await speak('de').catch(() => (document.documentElement.lang = 'en'));
