// Line icons on a 20 × 20 grid.

import { svg, html, type TemplateResult } from 'lit';

const icon = (body: TemplateResult): TemplateResult =>
  html`<svg class="icon" viewBox="0 0 20 20" width="16" height="16" fill="none" stroke="currentColor" stroke-width="1.6" stroke-linecap="round" stroke-linejoin="round" aria-hidden="true">${body}</svg>`;

export const icons = {
  play: icon(svg`<path d="M6.5 4.2v11.6l9-5.8z" fill="currentColor"/>`),
  pause: icon(svg`<path d="M7 4.5v11M13 4.5v11" stroke-width="2.4"/>`),
  step: icon(svg`<path d="M5 4.6v10.8l7.5-5.4z" fill="currentColor"/><path d="M15 4.5v11" stroke-width="2.2"/>`),
  back: icon(svg`<path d="M15 4.6v10.8L7.5 10z" fill="currentColor"/><path d="M5 4.5v11" stroke-width="2.2"/>`),
  stepFrame: icon(svg`<path d="M3 10h9M8.6 6.2 12.4 10l-3.8 3.8"/><path d="M16 5v10" stroke-width="2.2"/>`),
  plus: icon(svg`<path d="M10 4.5v11M4.5 10h11"/>`),
  power: icon(svg`<path d="M10 2.8v6.4"/><path d="M6 5.4a6.2 6.2 0 1 0 8 0"/>`),
  reset: icon(svg`<path d="M4 10a6 6 0 1 0 1.9-4.4"/><path d="M3.8 3.4v3.4h3.4"/>`),
  trash: icon(svg`<path d="M3.8 5.6h12.4M8 5.4V3.6h4v1.8M5.4 5.8l.7 10h7.8l.7-10M8.4 8.8v4.4M11.6 8.8v4.4"/>`),
  save: icon(svg`<path d="M10 3.2v8.6M6.4 8.4 10 12l3.6-3.6M3.8 13v3.2h12.4V13"/>`),
  search: icon(svg`<circle cx="9" cy="9" r="5"/><path d="m12.8 12.8 3.6 3.6"/>`),
  filter: icon(svg`<path d="M3.5 4.5h13L11.5 10.6v4.6l-3 1.6v-6.2z"/>`),
  fold: icon(svg`<path d="M4 5h12M7 10h9M7 15h9M4 8.2v7.4"/>`),
  trigger: icon(svg`<path d="M3 14.5h5V5.5h9M10.4 8 8 5.5 5.6 8"/>`),
  mark: icon(svg`<path d="M6 3.4h8v13.2l-4-3.4-4 3.4z"/>`),
  lesson: icon(svg`<path d="M10 5.2C8.4 4 6 3.6 3.4 3.8v11.4c2.6-.2 5 .2 6.6 1.4 1.6-1.2 4-1.6 6.6-1.4V3.8C14 3.6 11.6 4 10 5.2zM10 5.2v11.4"/>`),
  tick: icon(svg`<path d="m4.4 10.6 3.8 3.8 7.4-8.4" stroke-width="2"/>`),
  sun: icon(svg`<circle cx="10" cy="10" r="3.2"/><path d="M10 2.6v1.6M10 15.8v1.6M2.6 10h1.6M15.8 10h1.6M4.8 4.8l1.1 1.1M14.1 14.1l1.1 1.1M4.8 15.2l1.1-1.1M14.1 5.9l1.1-1.1"/>`),
  moon: icon(svg`<path d="M16.2 11.8A6.6 6.6 0 0 1 8.2 3.8a6.6 6.6 0 1 0 8 8z"/>`),
  chevron: icon(svg`<path d="m6 8 4 4 4-4"/>`),
  help: icon(svg`<circle cx="10" cy="10" r="7"/><path d="M7.9 8a2.1 2.1 0 1 1 3 1.9c-.6.3-.9.7-.9 1.3v.3"/><path d="M10 13.9v.1" stroke-width="2"/>`),
  share: icon(svg`<circle cx="5" cy="10" r="2"/><circle cx="14.6" cy="4.8" r="2"/><circle cx="14.6" cy="15.2" r="2"/><path d="m6.8 9 6-3.2M6.8 11l6 3.2"/>`),
  open: icon(svg`<path d="M8 4.5H4.2v11.3h11.3V12M11 3.8h5.2V9M16 4 9.4 10.6"/>`),
  plug: icon(svg`<path d="M7.5 2.8v4M12.5 2.8v4M5 6.8h10v2.4a5 5 0 0 1-10 0zM10 14.2v3.2"/>`),
  up: icon(svg`<path d="M10 16V5M5.6 9.2 10 4.8l4.4 4.4"/>`),
  close: icon(svg`<path d="m5 5 10 10M15 5 5 15"/>`),
  file: icon(svg`<path d="M5 2.8h6.4L15 6.4v10.8H5z"/><path d="M11.2 3v3.6h3.6"/>`),
  down: icon(svg`<path d="M10 4v11M5.6 10.8 10 15.2l4.4-4.4"/>`),
  send: icon(svg`<path d="m3.6 10 13-6.4-4.4 13L9.8 11z"/><path d="m9.8 11 6.6-7.2"/>`),
  encoder: icon(svg`<circle cx="10" cy="10" r="6.8"/><circle cx="10" cy="10" r="1.8"/><path d="M10 8.2V3.4"/>`),
  console: icon(svg`<path d="M3 5h14M3 10h9M3 15h11.5"/>`),
  objects: icon(svg`<path d="M3.4 4h13.2v12H3.4zM3.4 8h13.2M3.4 12h13.2M8 4v12"/>`),
};
