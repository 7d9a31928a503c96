// The flange seen from the front, with a shaft to turn: by pointer any number of
// revolutions, and by keys.

import { html, svg, type TemplateResult } from 'lit';
import * as state from '../state';
import { turnTo } from '../actions';
import { T } from '../texts';
import { View } from './view';

/** Degrees for an arrow key, without and with Shift. */
const COARSE = 5;
const FINE = 0.1;

const TICKS: TemplateResult[] = Array.from({ length: 72 }, (_, i) => {
  const isMain = i % 18 === 0;
  const isLong = i % 6 === 0;
  return svg`<path class=${isMain ? 'tick main' : isLong ? 'tick long' : 'tick'} d=${`M0 ${isLong ? -104 : -107}V-111`} transform=${`rotate(${i * 5})`}/>`;
});

const LABELS: TemplateResult[] = [0, 90, 180, 270].map((degrees) => {
  const angle = (degrees * Math.PI) / 180;
  return svg`<text x=${(Math.sin(angle) * 121).toFixed(1)} y=${(-Math.cos(angle) * 121 + 3.6).toFixed(1)}>${degrees}</text>`;
});

const HOLES: TemplateResult[] = [60, 180, 300].map(
  (degrees) => svg`<g transform=${`rotate(${degrees}) translate(0 -66)`}>
    <circle r="7.5" class="hole-rim"/><circle r="5.4" class="hole"/><circle r="5.4" class="thread"/><circle r="3.6" class="thread"/>
  </g>`,
);

class ShaftDial extends View {
  private drag: { pointer: number; angle: number; turns: number } | null = null;
  private keyedAt = -Infinity;
  private keyedTo = 0;
  private calmAt = 0;
  private calmTurns = 0;

  /** Angle of the pointer around the shaft, in degrees clockwise from the top. */
  private pointerAngle(event: PointerEvent): number {
    const box = this.getBoundingClientRect();
    const x = event.clientX - box.left - box.width / 2;
    const y = event.clientY - box.top - box.height / 2;
    return (Math.atan2(x, -y) * 180) / Math.PI;
  }

  private onDown(event: PointerEvent): void {
    if (event.button !== 0) return;
    const turns = state.shaft.value?.turns ?? 0;
    this.drag = { pointer: event.pointerId, angle: this.pointerAngle(event), turns };
    (event.currentTarget as Element).setPointerCapture(event.pointerId);
    turnTo(turns);
    this.requestUpdate();
  }

  private onMove(event: PointerEvent): void {
    if (this.drag?.pointer !== event.pointerId) return;
    const angle = this.pointerAngle(event);
    let delta = angle - this.drag.angle;
    if (delta > 180) delta -= 360;
    if (delta < -180) delta += 360;
    this.drag.angle = angle;
    this.drag.turns += (event.shiftKey ? delta / 20 : delta) / 360;
    turnTo(this.drag.turns);
  }

  private onUp(event: PointerEvent): void {
    if (this.drag?.pointer !== event.pointerId) return;
    this.drag = null;
    this.requestUpdate();
  }

  private onKey(event: KeyboardEvent): void {
    // Key presses are faster than snapshots: each one continues from the last target.
    const turns = performance.now() - this.keyedAt < 250 ? this.keyedTo : (state.shaft.value?.turns ?? 0);
    const step = (event.shiftKey ? FINE : COARSE) / 360;
    const to: Record<string, number> = {
      ArrowRight: turns + step,
      ArrowUp: turns + step,
      ArrowLeft: turns - step,
      ArrowDown: turns - step,
      PageUp: turns + 1,
      PageDown: turns - 1,
      Home: 0,
    };
    const target = to[event.key];
    if (target === undefined) return;
    event.preventDefault();
    this.keyedAt = performance.now();
    this.keyedTo = target;
    turnTo(target);
  }

  /** The drawn position; with reduced motion a running shaft moves twice a second. */
  private drawnTurns(): number {
    const shaft = state.shaft.value;
    if (!shaft) return 0;
    const isCalm = shaft.rpm !== 0 && matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (!isCalm || performance.now() - this.calmAt > 500) {
      this.calmAt = performance.now();
      this.calmTurns = shaft.turns;
    }
    return this.calmTurns;
  }

  protected override render() {
    const turns = state.shaft.value?.turns ?? 0;
    const degrees = (turns - Math.floor(turns)) * 360;
    const drawn = this.drawnTurns();
    const rotation = (drawn - Math.floor(drawn)) * 360;
    return html`<div class="dial" role="slider" tabindex="0" aria-label=${T.encoder.shaft} aria-valuemin="0" aria-valuemax="360"
      aria-valuenow=${degrees.toFixed(1)} aria-valuetext=${T.encoder.shaftValue(Math.floor(turns), degrees.toFixed(1))}
      aria-keyshortcuts="ArrowLeft ArrowRight PageUp PageDown Home" ?data-dragging=${this.drag !== null}
      title=${T.encoder.shaftTitle}
      @pointerdown=${this.onDown} @pointermove=${this.onMove} @pointerup=${this.onUp} @pointercancel=${this.onUp} @keydown=${this.onKey}>
      <svg viewBox="-130 -130 260 260" aria-hidden="true">
        <defs>
          <linearGradient id="od-body" x1="0" y1="0" x2="0.55" y2="1"><stop offset="0" stop-color="var(--metal-1)"/><stop offset="0.5" stop-color="var(--metal-2)"/><stop offset="1" stop-color="var(--metal-3)"/></linearGradient>
          <linearGradient id="od-collar" x1="0" y1="0" x2="0.4" y2="1"><stop offset="0" stop-color="var(--metal-3)"/><stop offset="1" stop-color="var(--metal-1)"/></linearGradient>
          <linearGradient id="od-shaft" x1="0" y1="0" x2="0.6" y2="1"><stop offset="0" stop-color="#fff"/><stop offset="0.45" stop-color="#c9d0d8"/><stop offset="1" stop-color="#7d8894"/></linearGradient>
          <radialGradient id="od-drill"><stop offset="0" stop-color="#2c333b"/><stop offset="1" stop-color="#8f99a5"/></radialGradient>
          <filter id="od-drop" x="-30%" y="-30%" width="160%" height="160%"><feDropShadow dx="0" dy="3" stdDeviation="4" flood-opacity="0.28"/></filter>
        </defs>
        <g class="scale">${TICKS}${LABELS}</g>
        <circle r="96" class="body" fill="url(#od-body)"/>
        <circle r="90" class="groove"/>
        ${HOLES}
        <circle r="50" class="collar-edge"/>
        <circle r="48" fill="url(#od-collar)"/>
        <circle r="41" class="seal"/>
        <g filter="url(#od-drop)"><circle r="33" fill="url(#od-shaft)" class="shaft-edge"/></g>
        <g transform=${`rotate(${rotation.toFixed(3)})`} class="turning">
          <path class="flat" d="M-24 -22.6A33 33 0 0 1 24 -22.6Z"/>
          <path class="mark" d="M0 -22V-9"/>
          <path class="pointer" d="M0 -101L-5.5 -90.5H5.5Z"/>
          <path class="pointer-line" d="M0 -89V-50"/>
        </g>
        <circle r="6" fill="url(#od-drill)"/>
        <circle r="2" fill="#14181c"/>
      </svg>
    </div>`;
  }
}

customElements.define('od-shaft', ShaftDial);
