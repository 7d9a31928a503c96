// Markdown as far as lessons use it, as templates: nothing of a text becomes markup unseen.

import { html, type TemplateResult } from 'lit';

/** `**strong**`, `*emphasis*`, `code`. */
function inline(text: string): unknown[] {
  return text.split(/(`[^`]+`|\*\*[^*]+\*\*|\*[^*\s][^*]*\*)/).map((part) => {
    if (part.startsWith('`') && part.length > 2) return html`<code>${part.slice(1, -1)}</code>`;
    if (part.startsWith('**') && part.length > 4) return html`<strong>${part.slice(2, -2)}</strong>`;
    if (part.startsWith('*') && part.length > 2) return html`<em>${part.slice(1, -1)}</em>`;
    return part;
  });
}

const cells = (line: string): string[] => line.trim().replace(/^\||\|$/g, '').split('|').map((cell) => cell.trim());

function block(text: string): TemplateResult {
  const lines = text.split('\n');
  if (lines[0]!.startsWith('```')) return html`<pre><code>${lines.slice(1).filter((line) => !line.startsWith('```')).join('\n')}</code></pre>`;
  if (/^\s*\|.*\|\s*$/.test(lines[0]!) && /^[\s|:-]+$/.test(lines[1] ?? '')) {
    return html`<table><thead><tr>${cells(lines[0]!).map((cell) => html`<th scope="col">${inline(cell)}</th>`)}</tr></thead>
      <tbody>${lines.slice(2).map((line) => html`<tr>${cells(line).map((cell) => html`<td>${inline(cell)}</td>`)}</tr>`)}</tbody></table>`;
  }
  if (lines.every((line) => /^\s*[-*] |^\s{2,}/.test(line))) {
    return html`<ul>${text.split(/\n(?=\s*[-*] )/).map((item) => html`<li>${inline(item.replace(/^\s*[-*] /, '').replace(/\s+/g, ' '))}</li>`)}</ul>`;
  }
  const heading = /^#{1,4} (.*)$/.exec(lines[0]!);
  if (heading) return html`<h4>${inline(heading[1]!)}</h4>${lines.length > 1 ? block(lines.slice(1).join('\n')) : ''}`;
  return html`<p>${inline(text.replace(/\s+/g, ' '))}</p>`;
}

export function markdown(text: string): TemplateResult[] {
  return text
    .trim()
    .split(/\n\s*\n/)
    .filter((part) => part.trim() !== '')
    .map(block);
}
