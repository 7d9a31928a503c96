// Plots as files: values for a spreadsheet, and a picture.

import type { Series } from './series';

/** A line for each moment: seconds, then a column for each value; empty if it has no value at that moment. */
export function csv(columns: readonly { name: string; series: Series }[]): string {
  const rows = new Map<number, (number | null)[]>();
  columns.forEach(({ series }, column) =>
    series.times.forEach((time, i) => {
      const row = rows.get(time) ?? columns.map(() => null);
      row[column] = series.values[i]!;
      rows.set(time, row);
    }),
  );
  // A spreadsheet computes a cell that begins as a formula.
  const plain = (text: string): string => (/^[=+\-@]/.test(text) ? `'${text}` : text);
  const quoted = (text: string): string => `"${plain(text).replaceAll('"', '""')}"`;
  const head = ['time in s', ...columns.map(({ name }) => quoted(name))].join(',');
  const lines = [...rows].sort(([a], [b]) => a - b).map(([time, row]) => [+time.toFixed(6), ...row.map((value) => value ?? '')].join(','));
  return `${[head, ...lines].join('\n')}\n`;
}

/** Height of a caption above its chart. */
const CAPTION = 24;

interface Panel {
  canvas: HTMLCanvasElement;
  /** The lines, each with its colour. */
  captions: { text: string; colour: string }[];
}

/** One picture of all charts, on the background colour of the page. */
export async function png(panels: readonly Panel[], style: CSSStyleDeclaration, ground: string): Promise<Uint8Array<ArrayBuffer>> {
  const scale = devicePixelRatio;
  const picture = document.createElement('canvas');
  picture.width = Math.max(...panels.map(({ canvas }) => canvas.width));
  picture.height = panels.reduce((sum, { canvas, captions }) => sum + canvas.height + captions.length * CAPTION * scale, 0);
  const pen = picture.getContext('2d')!;
  pen.fillStyle = ground;
  pen.fillRect(0, 0, picture.width, picture.height);
  pen.font = `500 ${12 * scale}px ${style.fontFamily}`;
  pen.textBaseline = 'middle';
  let top = 0;
  for (const { canvas, captions } of panels) {
    for (const { text, colour } of captions) {
      pen.fillStyle = colour;
      pen.fillRect(12 * scale, top + (CAPTION / 2 - 1.5) * scale, 12 * scale, 3 * scale);
      pen.fillStyle = style.color;
      pen.fillText(text, 30 * scale, top + (CAPTION / 2) * scale);
      top += CAPTION * scale;
    }
    pen.drawImage(canvas, 0, top);
    top += canvas.height;
  }
  const blob = await new Promise<Blob | null>((resolve) => picture.toBlob(resolve, 'image/png'));
  return new Uint8Array((await blob?.arrayBuffer()) ?? new ArrayBuffer(0));
}
