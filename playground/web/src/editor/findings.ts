// The findings of a text in the order of a list: errors first, then by rule.

import { PLACE, SEVERITIES, type Finding, type Group, type Severity } from './api';
import type { Diagnostic } from './protocol';

const rank = (one: Diagnostic): number => Math.min(Math.max(one.severity - 1, 0), SEVERITIES.length - 1);

export class Findings {
  readonly groups: Group[];
  readonly counts: Record<Severity, number> = { error: 0, warning: 0, info: 0 };
  /** In the order of the groups; inside a group by place. */
  private readonly sorted: Diagnostic[];

  constructor(all: Diagnostic[], titles: Record<string, string>) {
    const groups = new Map<string, { severity: Severity; all: Diagnostic[] }>();
    for (const one of all) {
      const severity = SEVERITIES[rank(one)]!;
      const key = `${rank(one)}${one.code}`;
      const group = groups.get(key);
      if (group) group.all.push(one);
      else groups.set(key, { severity, all: [one] });
      this.counts[severity] += 1;
    }
    const ordered = [...groups].sort(([a], [b]) => (a < b ? -1 : 1)).map(([, group]) => group);
    this.sorted = ordered.flatMap((group) => group.all.sort(byPlace));
    this.groups = ordered.map(({ severity, all: own }) => {
      const { code } = own[0]!;
      return { code, title: titles[code] ?? '', severity, count: own.length };
    });
  }

  slice(from: number, to: number): Diagnostic[] {
    return this.sorted.slice(from, to);
  }

  /** All places, for marks in the text. */
  readonly places = (): Uint32Array<ArrayBuffer> => {
    const all = [...this.sorted].sort(byPlace);
    const places = new Uint32Array(all.length * PLACE);
    all.forEach((one, i) => {
      const { start, end } = one.range;
      places.set([start.line, start.character, end.line, end.character, rank(one)], i * PLACE);
    });
    return places;
  };
}

const byPlace = (a: Diagnostic, b: Diagnostic): number => a.range.start.line - b.range.start.line || a.range.start.character - b.range.start.character;

/** A finding as a row; the help follows the message. */
export function finding(one: Diagnostic, lines: string[] | null): Finding {
  const [message = '', ...help] = one.message.split('\nhelp: ');
  const { range, code } = one;
  return { range, code, severity: SEVERITIES[rank(one)]!, message, help: help.join(' '), source: lines?.[range.start.line] ?? '' };
}
