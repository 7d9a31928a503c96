// Connections of a device: inputs to click, outputs as lamps.

import { html, nothing, type TemplateResult } from 'lit';
import { doLine } from '../actions';
import type { Pin } from '../sim/api';
import { M } from './texts';

const set = (name: string, value: number): void => void doLine(`pin ${name} ${value}`);

/** A digital connection: a switch, or a lamp. */
export function toggle({ name, input, value }: Pin, text = name): TemplateResult {
  const on = value !== 0;
  return input
    ? html`<button class="pin" role="switch" aria-checked=${on} data-pin=${name} title=${M.inputTitle(name, on)} @click=${() => set(name, on ? 0 : 1)}><i></i>${text}</button>`
    : html`<span class="pin" role="img" aria-label=${M.outputTitle(name, on)} data-pin=${name} data-lit=${on} title=${M.outputTitle(name, on)}><i></i>${text}</span>`;
}

/** The limits of an analogue connection. */
const [LOW, HIGH] = [-32768, 32767];

function level({ name, input, value }: Pin): TemplateResult {
  const change = (event: Event): void => {
    const wanted = Math.trunc(Number((event.target as HTMLInputElement).value));
    if (Number.isFinite(wanted)) set(name, Math.max(LOW, Math.min(HIGH, wanted)));
  };
  return html`<div class="level" data-pin=${name}><span>${name}</span>
    ${input
      ? html`<input type="range" min=${LOW} max=${HIGH} step="1" aria-label=${name} .value=${String(value)} @change=${change}>
          <input class="num" type="number" min=${LOW} max=${HIGH} aria-label=${name} .value=${String(value)} @change=${change}>`
      : html`<span class="bar" aria-hidden="true"><span style=${`width: ${((value - LOW) / (HIGH - LOW)) * 100}%`}></span></span><span class="num">${value}</span>`}
  </div>`;
}

/** All connections of a device. */
export function terminals(pins: readonly Pin[]): TemplateResult {
  const part = (title: string, list: Pin[], draw: (pin: Pin) => TemplateResult, name: string) =>
    list.length ? html`<section class="pins"><p>${title}</p><div class=${name} role="group" aria-label=${title}>${list.map(draw)}</div></section>` : nothing;
  const isLevel = ({ name }: Pin): boolean => /^a(in|out)/.test(name);
  const digital = pins.filter((pin) => !isLevel(pin));
  const levels = pins.filter(isLevel);
  return html`
    ${part(M.inputs, digital.filter(({ input }) => input), (pin) => toggle(pin), 'switches')}
    ${part(M.outputs, digital.filter(({ input }) => !input), (pin) => toggle(pin), 'switches')}
    ${part(M.analogueInputs, levels.filter(({ input }) => input), level, 'levels')}
    ${part(M.analogueOutputs, levels.filter(({ input }) => !input), level, 'levels')}`;
}
