// Findings in an edited text: they belong to a version, and move with later changes.

import { StateEffect, StateField, type ChangeDesc, type Range as Marked, type Text } from '@codemirror/state';
import { Decoration, gutter, GutterMarker, ViewPlugin, type DecorationSet, type EditorView, type ViewUpdate } from '@codemirror/view';
import { PLACE, SEVERITIES } from './api';

/** Places of the findings of a text, and the changes since. */
interface Marks {
  places: Uint32Array;
  doc: Text;
  since: ChangeDesc | null;
}

export const setMarks = StateEffect.define<Marks>();

export const marks = StateField.define<Marks | null>({
  create: () => null,
  update(own, change) {
    const set = change.effects.find((effect) => effect.is(setMarks));
    if (set) return set.value as Marks;
    if (!own || !change.docChanged) return own;
    return { ...own, since: own.since ? own.since.composeDesc(change.changes.desc) : change.changes.desc };
  },
});

/** Calls `see` with each finding that overlaps a range of the current text. */
function each({ places, doc, since }: Marks, from: number, to: number, see: (from: number, to: number, rank: number) => void): void {
  const back = since?.invertedDesc;
  const first = doc.lineAt(Math.min(doc.length, back ? back.mapPos(from, -1) : from)).number - 1;
  const last = doc.lineAt(Math.min(doc.length, back ? back.mapPos(to, 1) : to)).number - 1;
  let [low, high] = [0, places.length / PLACE];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (places[middle * PLACE]! < first) low = middle + 1;
    else high = middle;
  }
  const now = (line: number, character: number, side: number): number => {
    const { from: start, to: end } = doc.line(Math.min(line + 1, doc.lines));
    const at = Math.min(start + character, end);
    return since ? since.mapPos(at, side) : at;
  };
  for (let at = low * PLACE; at < places.length && places[at]! <= last; at += PLACE) {
    see(now(places[at]!, places[at + 1]!, 1), now(places[at + 2]!, places[at + 3]!, -1), places[at + 4]!);
  }
}

const LINE = /^(\s*)(?:(\[[^\]]*\]?)|([;#].*)|([^=]+?)(\s*=\s*)([^;]*)(;.*)?)/;
const style = Object.fromEntries(['section', 'comment', 'key', 'value', ...SEVERITIES].map((name) => [name, Decoration.mark({ class: `od-${name}` })]));

/** Colours of the visible text, and its findings. */
export const colours = ViewPlugin.fromClass(
  class {
    decorations: DecorationSet;

    constructor(view: EditorView) {
      this.decorations = drawn(view);
    }

    update(update: ViewUpdate): void {
      if (update.docChanged || update.viewportChanged || update.startState.field(marks) !== update.state.field(marks)) this.decorations = drawn(update.view);
    }
  },
  { decorations: (plugin) => plugin.decorations },
);

function drawn(view: EditorView): DecorationSet {
  const all: Marked<Decoration>[] = [];
  const add = (name: string, from: number, length: number): number => {
    if (length > 0) all.push(style[name]!.range(from, from + length));
    return from + length;
  };
  const own = view.state.field(marks);
  for (const { from, to } of view.visibleRanges) {
    for (let at = from; at <= to; ) {
      const line = view.state.doc.lineAt(at);
      const [, space = '', section, comment, key, is = '', value = '', note = ''] = LINE.exec(line.text) ?? [];
      const start = line.from + space.length;
      if (section) add('section', start, section.length);
      else if (comment) add('comment', start, comment.length);
      else if (key) add('comment', add('value', add('key', start, key.length) + is.length, value.length), note.length);
      at = line.to + 1;
    }
    if (own) each(own, from, to, (start, end, rank) => end > start && all.push(style[SEVERITIES[rank]!]!.range(start, end)));
  }
  return Decoration.set(all, true);
}

const dots = SEVERITIES.map(
  (name) =>
    new (class extends GutterMarker {
      override elementClass = `od-dot od-dot-${name}`;
    })(),
);

/** A dot beside each line with findings, in the colour of the most severe. */
export const dotted = gutter({
  class: 'od-dots',
  lineMarker(view, { from, to }) {
    const own = view.state.field(marks);
    let worst: number = SEVERITIES.length;
    if (own) each(own, from, to, (start, _, rank) => start >= from && start <= to && (worst = Math.min(worst, rank)));
    return dots[worst] ?? null;
  },
  lineMarkerChange: (update) => update.startState.field(marks) !== update.state.field(marks),
});
