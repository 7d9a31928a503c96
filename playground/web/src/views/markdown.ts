// Markdown of lessons: marked parses it, and DOMPurify removes everything except harmless markup. HTML in
// a lesson is text.

import { html, type TemplateResult } from 'lit';
import { unsafeHTML } from 'lit/directives/unsafe-html.js';
import DOMPurify from 'dompurify';
import { Marked } from 'marked';

const CODES: Record<string, string> = { '&': '&amp;', '<': '&lt;', '>': '&gt;' };

const reader = new Marked({
  async: false,
  renderer: { html: ({ text }) => text.replace(/[&<>]/g, (char) => CODES[char]!) },
  // Headings of a text are one level below those of the page.
  walkTokens: (token) => {
    if (token.type === 'heading') token.depth = 4;
  },
});

DOMPurify.addHook('afterSanitizeAttributes', (node) => {
  if (!(node instanceof HTMLAnchorElement) || !node.hasAttribute('href')) return;
  node.target = '_blank';
  node.rel = 'noopener noreferrer';
});

const known = new Map<string, TemplateResult>();

/** A text as a template; each text is parsed once. */
export function markdown(text: string): TemplateResult {
  const made = known.get(text) ?? html`${unsafeHTML(DOMPurify.sanitize(reader.parse(text) as string, { FORBID_TAGS: ['style', 'form', 'input', 'button'], FORBID_ATTR: ['style'] }))}`;
  known.set(text, made);
  return made;
}
