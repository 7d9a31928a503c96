// The selected frame on the bus line: level over time, its fields by name, stuff bits marked.
// The bench supplies the bits; this view only draws them.

import { html, svg } from 'lit';
import { frameBits } from '../codec';
import { hexByte } from '../format';
import { BIT } from '../sim/layout';
import * as state from '../state';
import { T } from '../texts';
import { View } from './view';

/** Width of a bit and height of the two levels, in pixels. */
const WIDE = 8;
const HIGH = 6;
const LOW = 28;
const FULL = 40;

const { recessive: RECESSIVE, stuffed: STUFFED, part: PART, crc: CRC, data: DATA } = BIT;

interface Part {
  part: number;
  from: number;
  to: number;
  stuffed: number;
  value: number;
}

/** The fields in their order, with their values. */
function partsOf(bits: Uint8Array): Part[] {
  const parts: Part[] = [];
  bits.forEach((bit, i) => {
    const part = bit & PART;
    let last = parts.at(-1);
    if (last?.part !== part) parts.push((last = { part, from: i, to: i, stuffed: 0, value: 0 }));
    last.to = i + 1;
    if (bit & STUFFED) last.stuffed += 1;
    else last.value = last.value * 2 + (bit & RECESSIVE ? 1 : 0);
  });
  return parts;
}

class Bits extends View {
  static override properties = { frame: { attribute: false }, lit: { attribute: false }, shown: { state: true } };
  /** The packed frame. */
  declare frame: Uint8Array;
  /** Range of bytes that another view marks. */
  declare lit: [number, number] | null;
  /** The field under the pointer. */
  declare shown: number | null;

  constructor() {
    super();
    this.frame = new Uint8Array();
    this.lit = null;
    this.shown = null;
  }

  /** Marks a field, and reports it to the view of the bytes. */
  private mark(part: number | null): void {
    this.shown = part;
    this.dispatchEvent(new CustomEvent('byte', { detail: part !== null && part >= DATA ? part - DATA : null }));
  }

  private isLit({ part }: Part): boolean {
    return part === this.shown || (this.lit !== null && part >= DATA + this.lit[0] && part < DATA + this.lit[1]);
  }

  private value({ part, value, from, to, stuffed }: Part): string {
    if (part >= DATA) return hexByte(value);
    if (part === 1 || part === 4 || part === CRC) return `${value.toString(16).toUpperCase()}h`;
    return part === 12 ? `${to - from}` : to - from - stuffed > 1 ? String(value) : value ? '1' : '0';
  }

  protected override render() {
    const bits = frameBits(this.frame);
    const parts = partsOf(bits);
    const t = T.bits;
    const level = (bit: number): number => (bit & RECESSIVE ? HIGH : LOW);
    let path = `M0 ${HIGH}`;
    bits.forEach((bit, i) => (path += `H${i * WIDE}V${level(bit)}H${(i + 1) * WIDE}`));
    const stuffed = bits.filter((bit) => bit & STUFFED).length;
    const rate = state.line.value?.rate;
    const crc = parts.find(({ part }) => part === CRC)?.value ?? 0;
    const name = (part: number): string => (part >= DATA ? t.byte(part - DATA) : t.parts[part] ?? '');
    const words = t.words(bits.length, stuffed, `${crc.toString(16).toUpperCase().padStart(4, '0')}h`, rate ? (bits.length / rate).toFixed(3) : '');
    return html`<p class="bits-words num">${words}</p>
      <div class="scroll" tabindex="0" role="region" aria-label=${t.title}>
        <svg class="bits" width=${bits.length * WIDE} height=${FULL} role="img" aria-label=${words}>
          ${parts.map((one) => svg`<rect class="part" data-lit=${this.isLit(one)} x=${one.from * WIDE} width=${(one.to - one.from) * WIDE} height=${FULL} @pointerenter=${() => this.mark(one.part)} @pointerleave=${() => this.mark(null)}><title>${name(one.part)} ${this.value(one)}</title></rect>`)}
          ${Array.from(bits, (bit, i) => (bit & STUFFED ? svg`<rect class="stuffed" x=${i * WIDE} width=${WIDE} height=${FULL}></rect>` : ''))}
          <path d=${path}></path>
        </svg>
      </div>
      <ol class="bit-parts">${parts.map((one) => html`<li tabindex="0" data-lit=${this.isLit(one)} @pointerenter=${() => this.mark(one.part)} @pointerleave=${() => this.mark(null)} @focus=${() => this.mark(one.part)} @blur=${() => this.mark(null)}>
        ${name(one.part)} <b class="num">${this.value(one)}</b>${one.stuffed ? html` <i>${t.stuffed(one.stuffed)}</i>` : ''}</li>`)}</ol>`;
  }
}

customElements.define('od-bits', Bits);
