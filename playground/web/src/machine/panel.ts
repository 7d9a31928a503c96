// A device without a shaft: the axes of a drive, the terminals of an I/O module. Loaded when a bench has one.

import { html, nothing } from 'lit';
import { View } from '../views/view';
import { axisCount, drive, objectsOf } from './drive';
import { pins, start, want } from './look';
import { terminals } from './pins';
import { M } from './texts';

// The style sheet of this view; the first visit does not load it.
document.head.append(Object.assign(document.createElement('link'), { rel: 'stylesheet', href: new URL('machine.css', import.meta.url).href }));

class Machine extends View {
  static override properties = { axis: { state: true } };
  declare axis: number;

  private end: (() => void) | undefined;

  constructor() {
    super();
    this.axis = 0;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.end = start();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.end?.();
  }

  protected override render() {
    const count = axisCount();
    const axis = Math.min(this.axis, count - 1);
    want(count ? objectsOf(axis) : []);
    const axes = count > 1 ? Array.from({ length: count }, (_, i) => html`<button class="small" aria-pressed=${i === axis} @click=${() => (this.axis = i)}>${M.axis(i + 1)}</button>`) : nothing;
    return html`<div class="machine scroll">
      ${count ? drive(axis, axes) : pins.value.length ? terminals(pins.value) : html`<p class="empty">${M.noShaft}</p>`}
      <od-leds></od-leds>
    </div>`;
  }
}

customElements.define('od-machine', Machine);
