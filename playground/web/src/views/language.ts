// The button that shows the page in the other language.

import { html } from 'lit';
import { language, speak, type Language } from '../language';
import * as state from '../state';
import { T } from '../texts';

const other = (): Language => (language() === 'en' ? 'de' : 'en');

/** Changes the language and keeps the choice; the address no longer asks for one. */
async function change(): Promise<void> {
  const chosen = other();
  try {
    await speak(chosen);
  } catch {
    state.toast.value = { text: T.topbar.noLanguage, tone: 'error' };
    return;
  }
  const address = new URL(location.href);
  address.searchParams.delete('lang');
  const parts = new URLSearchParams(address.hash.slice(1));
  if (parts.has('lang')) {
    parts.delete('lang');
    address.hash = String(parts);
  }
  history.replaceState(null, '', address);
  // A frame in another page stores nothing.
  if ('embed' in document.documentElement.dataset) return;
  try {
    localStorage.setItem('odkit.lang', chosen);
  } catch {
    // Storage is not allowed: the choice exists as long as the page.
  }
}

export const languageButton = () =>
  html`<button class="icon-button language-button" lang=${other()} title=${T.topbar.language} @click=${() => void change()}>${other().toUpperCase()}<span class="sr"> ${T.topbar.language}</span></button>`;
