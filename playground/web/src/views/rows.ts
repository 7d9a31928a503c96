// Long lists with few elements: a few rows are drawn, and reused while the
// list scrolls.

interface RowSource {
  /** Number of rows. */
  count(): number;
  /** Creates an empty row. */
  make(): HTMLElement;
  /** Fills a row; called again for each redraw. */
  fill(row: HTMLElement, index: number): void;
  /** Called after all visible rows were filled. */
  filled?(from: number, to: number): void;
}

const SPARE = 4;

/** The cells of a row, empty, with these classes. */
export const cells = (names: string[], role?: string): HTMLElement[] =>
  names.map((name) => {
    const cell = document.createElement('span');
    cell.className = name;
    if (role) cell.setAttribute('role', role);
    return cell;
  });

export class Rows {
  private readonly spacer = document.createElement('div');
  private readonly pool: HTMLElement[] = [];
  private scheduled = 0;
  private height = 24;
  private room = 0;
  private readonly sizes = new ResizeObserver(() => this.measure());

  constructor(
    readonly viewport: HTMLElement,
    private readonly source: RowSource,
  ) {
    this.spacer.className = 'rows-spacer';
    this.spacer.setAttribute('role', 'presentation');
    viewport.append(this.spacer);
    viewport.addEventListener('scroll', () => this.redraw(), { passive: true });
    this.sizes.observe(viewport);
    this.measure();
  }

  get rowHeight(): number {
    return this.height;
  }

  private measure(): void {
    const height = Number.parseFloat(getComputedStyle(this.viewport).getPropertyValue('--row-height'));
    if (height > 0) this.height = height;
    this.room = this.viewport.clientHeight;
    this.redraw();
  }

  /** Draws before the next refresh. */
  redraw(): void {
    this.scheduled ||= requestAnimationFrame(() => {
      this.scheduled = 0;
      this.draw();
    });
  }

  /**
   * Draws now, scrolled to `top` if that is given; returns the scroll position. Rows first,
   * then the position: so the browser computes the layout once.
   */
  draw(top?: number): number {
    const count = this.source.count();
    const wanted = top ?? this.viewport.scrollTop;
    if (this.room === 0) return wanted;
    const place = Math.max(0, Math.min(wanted, count * this.height - this.room));
    this.fill(Math.max(0, Math.floor(place / this.height) - 1), count);
    const height = `${count * this.height}px`;
    if (this.spacer.style.height !== height) this.spacer.style.height = height;
    if (top !== undefined) this.viewport.scrollTop = place;
    return place;
  }

  private fill(from: number, count: number): void {
    const to = Math.min(count, from + Math.ceil(this.room / this.height) + SPARE);
    while (this.pool.length < to - from) {
      const row = this.source.make();
      row.classList.add('row');
      this.spacer.append(row);
      this.pool.push(row);
    }
    // A row keeps its element while it is visible: selections and hovers stay.
    const size = this.pool.length;
    for (let i = 0; i < size; i++) {
      const index = size ? from + ((((i - from) % size) + size) % size) : 0;
      const row = this.pool[i]!;
      const isShown = index < to;
      if (row.hidden === isShown) row.hidden = !isShown;
      if (!isShown) continue;
      row.style.transform = `translateY(${index * this.height}px)`;
      this.source.fill(row, index);
    }
    this.source.filled?.(from, to);
  }

  /** Scrolls to a row. */
  reveal(index: number): void {
    const top = index * this.height;
    const { scrollTop, clientHeight } = this.viewport;
    if (top < scrollTop) this.viewport.scrollTop = top;
    else if (top + this.height > scrollTop + clientHeight) this.viewport.scrollTop = top + this.height - clientHeight;
  }

  dispose(): void {
    this.sizes.disconnect();
    cancelAnimationFrame(this.scheduled);
  }
}

/** Sets a text only if it changed. */
export function setText(element: Element | null | undefined, text: string): void {
  if (element && element.textContent !== text) element.textContent = text;
}
