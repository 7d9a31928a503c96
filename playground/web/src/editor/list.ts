// A long list of findings by rule. Only visible rows are in the page.

import { html, nothing, render, type TemplateResult } from 'lit';
import type { Finding, Found, Group } from './api';
import { ask } from './client';
import { grouped } from '../format';
import { E } from './texts';
import { icons } from '../views/icons';
import { withCode } from '../views/view';

/** Groups of at most this many findings are open at the start, and all groups if the sum is not higher. */
const FEW = 100;
/** Number of findings that are fetched at once. */
const PORTION = 50;
/** Assumed height in pixels of a row that was not drawn yet. */
const GUESS = { group: 34, finding: 60 };
/** Distance in pixels outside the visible part in which rows are drawn, too. */
const SPARE = 120;

/** A line of the list: the heading of a group, or a finding by its number. */
interface Line {
  group: Group;
  finding: number | null;
}


export class FindingList {
  private readonly spacer = document.createElement('div');
  private readonly window = document.createElement('div');
  private readonly sizes = new ResizeObserver(() => this.redraw());
  private lines: Line[] = [];
  private heights = new Float64Array(0);
  /** Top of each line, and the end of the last. */
  private tops = new Float64Array(1);
  private portions = new Map<number, Promise<Finding[]> | Finding[]>();
  private readonly toggled = new Set<string>();
  private found: Found | null = null;
  private scheduled = 0;
  /** Number of the selected finding. */
  private chosen: number | null = null;

  constructor(
    private readonly viewport: HTMLElement,
    private readonly uri: string,
    /** Called with the finding that the user chose. */
    private readonly choose: (finding: Finding) => void,
    /** Content below the selected finding. */
    private readonly below: (finding: Finding) => unknown = () => nothing,
  ) {
    this.spacer.className = 'found-spacer';
    this.window.className = 'found-window';
    this.spacer.append(this.window);
    viewport.replaceChildren(this.spacer);
    viewport.addEventListener('scroll', this.redraw, { passive: true });
    this.sizes.observe(viewport);
  }

  dispose(): void {
    this.sizes.disconnect();
    this.viewport.removeEventListener('scroll', this.redraw);
    cancelAnimationFrame(this.scheduled);
  }

  show(found: Found): void {
    this.found = found;
    this.portions.clear();
    this.chosen = null;
    this.layOut();
  }

  /** Selects a finding by its number, like a click on it. */
  async pick(number: number): Promise<Finding | undefined> {
    this.get(number);
    const start = number - (number % PORTION);
    const one = (await this.portions.get(start))?.[number - start];
    if (!one) return undefined;
    this.chosen = number;
    this.choose(one);
    this.redraw();
    return one;
  }

  private isOpen(group: Group): boolean {
    const { counts } = this.found!;
    const isFew = counts.error + counts.warning + counts.info <= FEW || group.count <= FEW / 5 || group.severity === 'error';
    return isFew !== this.toggled.has(group.code);
  }

  private layOut(): void {
    const lines: Line[] = [];
    let number = 0;
    for (const group of this.found?.groups ?? []) {
      lines.push({ group, finding: null });
      if (this.isOpen(group)) for (let i = 0; i < group.count; i++) lines.push({ group, finding: number + i });
      number += group.count;
    }
    this.lines = lines;
    this.heights = Float64Array.from(lines, ({ finding }) => (finding === null ? GUESS.group : GUESS.finding));
    this.measure(0);
    this.redraw();
  }

  /** Computes the tops of the lines after the first `from`. */
  private measure(from: number): void {
    const { heights } = this;
    if (this.tops.length !== heights.length + 1) {
      this.tops = new Float64Array(heights.length + 1);
      from = 0;
    }
    for (let i = from; i < heights.length; i++) this.tops[i + 1] = this.tops[i]! + heights[i]!;
    this.spacer.style.height = `${this.tops[heights.length]}px`;
  }

  readonly redraw = (): void => {
    this.scheduled ||= requestAnimationFrame(() => {
      this.scheduled = 0;
      this.draw();
    });
  };

  /** The line at a height. */
  private lineAt(top: number): number {
    let [low, high] = [0, this.lines.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.tops[middle + 1]! > top) high = middle;
      else low = middle + 1;
    }
    return low;
  }

  private draw(): void {
    const { scrollTop, clientHeight } = this.viewport;
    const from = this.lineAt(scrollTop - SPARE);
    const to = Math.min(this.lines.length, this.lineAt(scrollTop + clientHeight + SPARE) + 1);
    this.window.style.transform = `translateY(${this.tops[from] ?? 0}px)`;
    render(this.parts(this.lines.slice(from, to)), this.window);
    const drawn = this.window.querySelectorAll<HTMLElement>('.rule, .finding');
    let changed = -1;
    drawn.forEach((row, i) => {
      const { height } = row.getBoundingClientRect();
      if (Math.abs(this.heights[from + i]! - height) < 0.5) return;
      this.heights[from + i] = height;
      if (changed < 0) changed = from + i;
    });
    if (changed >= 0) this.measure(changed);
  }

  /** Headings, and below each its findings as a list. */
  private parts(lines: Line[]): TemplateResult[] {
    const parts: TemplateResult[] = [];
    for (let at = 0; at < lines.length; ) {
      const { group, finding } = lines[at]!;
      if (finding === null) {
        parts.push(this.head(group));
        at += 1;
        continue;
      }
      let end = at;
      while (lines[end]?.finding != null) end += 1;
      parts.push(html`<ol>${lines.slice(at, end).map((line) => this.row(line.finding!))}</ol>`);
      at = end;
    }
    return parts;
  }

  private head(group: Group): TemplateResult {
    const isOpen = this.isOpen(group);
    const toggle = (): void => {
      if (!this.toggled.delete(group.code)) this.toggled.add(group.code);
      this.layOut();
    };
    return html`<div class="rule" data-severity=${group.severity} data-open=${isOpen}><button class="quiet" aria-expanded=${isOpen} @click=${toggle}>
      ${icons.chevron}<span class="code">${group.code}</span><span class="title">${group.title}</span><span class="badge">${grouped(group.count)}</span></button></div>`;
  }

  private row(number: number): TemplateResult {
    const one = this.get(number);
    if (!one) return html`<li class="finding"></li>`;
    const { line, character } = one.range.start;
    const isChosen = number === this.chosen;
    const { source } = one;
    return html`<li class="finding" data-severity=${one.severity} aria-current=${isChosen}>
      <button class="link num where" title=${E.goTo(line + 1, character + 1)} @click=${() => void this.pick(number)}>${line + 1}:${character + 1}</button>
      <div><span class="code">${one.code}</span> ${withCode(one.message)}
        ${source.trim() ? html`<code class="source">${source.slice(0, character)}<mark>${source.slice(character, character + 120).trimEnd()}</mark></code>` : nothing}
        ${one.help ? html`<span class="muted help">${withCode(one.help)}</span>` : nothing}
        ${isChosen ? this.below(one) : nothing}</div>
    </li>`;
  }

  /** Returns a finding if it was fetched; otherwise fetches it. */
  private get(number: number): Finding | undefined {
    const start = number - (number % PORTION);
    const portion = this.portions.get(start);
    if (Array.isArray(portion)) return portion[number - start];
    const { found } = this;
    if (!portion && found) {
      const asked = ask('rows', this.uri, found.version, start, start + PORTION);
      this.portions.set(start, asked);
      asked.then(
        (rows) => {
          if (this.found !== found) return;
          this.portions.set(start, rows);
          this.redraw();
        },
        () => this.portions.delete(start),
      );
    }
    return undefined;
  }
}
