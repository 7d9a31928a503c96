// Charts on canvases: one for each value, or one for all of them; two cursors in each.

import uPlot from 'uplot';
import type { Series } from './series';

export interface Line {
  series: Series;
  /** An element with the colour of the line as its background. */
  swatch: HTMLElement;
}

export interface Cursors {
  a: number | null;
  b: number | null;
}

export class Charts {
  private plots: uPlot[] = [];
  private lines: Line[][] = [];
  private built = '';

  constructor(
    /** Range of virtual seconds that is drawn. */
    private readonly span: () => [number, number],
    private readonly cursors: () => Cursors,
    /** The user chose a moment. */
    private readonly choose: (seconds: number) => void,
  ) {}

  /** Creates the charts again when `name` changes: one for each area, with these lines. */
  build(name: string, areas: HTMLElement[], lines: Line[][]): void {
    this.lines = lines;
    if (name === this.built) return;
    this.drop();
    this.built = name;
    this.lines = lines;
    this.plots = areas.map((area, i) => this.chart(area, lines[i] ?? []));
  }

  private chart(area: HTMLElement, lines: Line[]): uPlot {
    // The colours follow the theme, so they are read at each drawing.
    const style = getComputedStyle(area);
    const axis = { stroke: () => style.borderTopColor, grid: { stroke: () => style.outlineColor, width: 1 }, ticks: { show: false }, font: `11px ${style.fontFamily}` };
    const plot = new uPlot(
      {
        width: area.clientWidth || 300,
        height: area.clientHeight || 100,
        legend: { show: false },
        cursor: { sync: { key: 'odkit' }, drag: { x: false, y: false } },
        scales: { x: { time: false, range: () => this.span() } },
        axes: [
          { ...axis, size: 24, values: (_, ticks) => ticks.map((tick) => `${+tick.toFixed(6)} s`) },
          { ...axis, size: 76, values: (_, ticks) => ticks.map((tick) => tick.toLocaleString('en').replaceAll(',', '\u2009')) },
        ],
        series: [{}, ...lines.map(({ swatch }) => ({ stroke: () => getComputedStyle(swatch).backgroundColor, width: 1, points: { show: false } }))],
        hooks: { draw: [(self) => this.marks(self, style)] },
      },
      [[], ...lines.map(() => [])],
      area,
    );
    plot.over.addEventListener('click', () => {
      const { left } = plot.cursor;
      if (left !== undefined && left >= 0) this.choose(plot.posToVal(left, 'x'));
    });
    return plot;
  }

  private marks(plot: uPlot, style: CSSStyleDeclaration): void {
    const { ctx, bbox } = plot;
    for (const [name, at] of Object.entries(this.cursors())) {
      if (at === null) continue;
      const x = plot.valToPos(at, 'x', true);
      if (x < bbox.left || x > bbox.left + bbox.width) continue;
      ctx.save();
      ctx.strokeStyle = ctx.fillStyle = style.borderTopColor;
      ctx.lineWidth = devicePixelRatio;
      ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      ctx.font = `${11 * devicePixelRatio}px ${style.fontFamily}`;
      ctx.fillText(name.toUpperCase(), x + 3 * devicePixelRatio, bbox.top + 11 * devicePixelRatio);
      ctx.restore();
    }
  }

  draw(): void {
    this.plots.forEach((plot, i) => {
      const tables = (this.lines[i] ?? []).map(({ series }) => [series.times, series.values] as uPlot.AlignedData);
      plot.setData(tables.length === 1 ? tables[0]! : uPlot.join(tables));
    });
  }

  fit(): void {
    for (const plot of this.plots) {
      const area = plot.root.parentElement!;
      plot.setSize({ width: area.clientWidth, height: area.clientHeight });
    }
  }

  canvases(): HTMLCanvasElement[] {
    return this.plots.map((plot) => plot.ctx.canvas);
  }

  drop(): void {
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
    this.built = '';
  }
}
