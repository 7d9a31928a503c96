// A drive (CiA 402): the axis with its course, and the state machine with its commands.

import { html, nothing, svg, type SVGTemplateResult, type TemplateResult } from 'lit';
import { doLine } from '../actions';
import { grouped } from '../format';
import type { Address } from '../sim/api';
import * as state from '../state';
import { icons } from '../views/icons';
import { number, pins, seen } from './look';
import { toggle } from './pins';
import { M } from './texts';

/** Distance between the objects of two axes. */
const AXIS = 0x800;
/** Units of a revolution. */
const TURN = 10_000;
/** Virtual microseconds of the course. */
const COURSE = 10_000_000;

const OBJECTS = [0x6040, 0x6041, 0x6061, 0x603f, 0x6062, 0x6064, 0x606c, 0x607a, 0x60ff];

/** The objects of an axis. */
export const objectsOf = (axis: number): Address[] => OBJECTS.map((index) => ({ index: index + axis * AXIS, sub: 0 }));

/** The number of axes of the selected device. */
export const axisCount = (): number => [0, 1, 2, 3, 4, 5, 6, 7].filter((axis) => state.objectsByKey.value.has(state.keyOf(0x6041 + axis * AXIS, 0))).length;

/** The states, modes and commands by the names of CiA 402, which are the same in each language. */
const STATES = {
  notReady: 'Not ready to switch on',
  disabled: 'Switch on disabled',
  ready: 'Ready to switch on',
  on: 'Switched on',
  enabled: 'Operation enabled',
  quickStop: 'Quick stop active',
  reaction: 'Fault reaction active',
  fault: 'Fault',
};
const MODES: [number, string][] = [
  [1, 'Profile position'],
  [3, 'Profile velocity'],
  [6, 'Homing'],
  [7, 'Interpolated position'],
  [8, 'Cyclic synchronous position'],
  [9, 'Cyclic synchronous velocity'],
];
/** Commands with their controlwords, and the states in which they have an effect. */
const COMMANDS: [number, string, Name[]][] = [
  [0x06, 'Shutdown', ['disabled', 'on', 'enabled']],
  [0x07, 'Switch on', ['ready', 'enabled']],
  [0x0f, 'Enable operation', ['ready', 'on', 'quickStop']],
  [0x02, 'Quick stop', ['ready', 'on', 'enabled']],
  [0x00, 'Disable voltage', ['ready', 'on', 'enabled', 'quickStop']],
  [0x80, 'Fault reset', ['fault']],
];

type Name = keyof typeof STATES;

/** The state in the statusword (CiA 402, statusword). */
function stateOf(word: number | null): Name | null {
  if (word === null) return null;
  const known: [number, number, Name][] = [
    [0x4f, 0x00, 'notReady'],
    [0x4f, 0x40, 'disabled'],
    [0x6f, 0x21, 'ready'],
    [0x6f, 0x23, 'on'],
    [0x6f, 0x27, 'enabled'],
    [0x6f, 0x07, 'quickStop'],
    [0x4f, 0x0f, 'reaction'],
    [0x4f, 0x08, 'fault'],
  ];
  return known.find(([mask, bits]) => (word & mask) === bits)?.[2] ?? 'notReady';
}

/** Places of the states in the chart: middle of the box. */
const PLACES: [Name, number, number][] = [
  ['disabled', 82, 24],
  ['ready', 82, 80],
  ['on', 82, 136],
  ['enabled', 82, 192],
  ['quickStop', 274, 192],
  ['reaction', 274, 108],
  ['fault', 274, 24],
];
/** Lines of the transitions with their numbers, and the places of the numbers. */
const LINES: [string, [string, number, number][]][] = [
  ['M70 38V66', [['2', 63, 56]]],
  ['M94 66V38', [['7', 101, 56]]],
  ['M70 94V122', [['3', 63, 112]]],
  ['M94 122V94', [['6', 101, 112]]],
  ['M70 150V178', [['4', 63, 168]]],
  ['M94 178V150', [['5', 101, 168]]],
  ['M20 178C0 150 0 122 20 94', [['8', 12, 140]]],
  ['M144 186C176 150 176 60 144 30', [['9', 172, 100]]],
  ['M144 130C160 110 160 64 144 38', [['10', 150, 88]]],
  ['M146 188H208', [['11', 176, 184]]],
  ['M210 200H148', [['16', 176, 212]]],
  ['M236 178C190 130 186 60 146 26', [['12', 206, 140]]],
  ['M274 94V40', [['14', 284, 70]]],
  ['M210 18H148', [['15', 180, 14]]],
  ['M336 160V140C336 128 332 124 326 122', [['13', 326, 152]]],
];

const chart = (now: Name | null): SVGTemplateResult => svg`
  <svg viewBox="0 0 352 222" role="img" aria-label=${M.chartIs(now ? STATES[now] : M.off)}>
    <defs><marker id="od-arrow" viewBox="0 0 8 8" refX="7" refY="4" markerWidth="6" markerHeight="6" orient="auto-start-reverse"><path d="M0 0L8 4L0 8Z"/></marker></defs>
    ${LINES.map(([path, numbers]) => svg`<path class="transition" d=${path} marker-end="url(#od-arrow)"/>${numbers.map(([text, x, y]) => svg`<text class="transition-number" x=${x} y=${y}>${text}</text>`)}`)}
    ${PLACES.map(([name, x, y]) => svg`<g class="drive-state" ?data-active=${name === now} data-name=${name}>
      <rect x=${x - 64} y=${y - 14} width="128" height="28" rx="6"/><text x=${x} y=${y + 4}>${STATES[name]}</text></g>`)}
  </svg>`;

/** Positions and targets of the last seconds. */
let course: { at: number; position: number; target: number }[] = [];
let courseOf = '';

function note(axis: number, position: number, target: number): void {
  const { at, node } = seen.value;
  const of = `${node}/${axis}`;
  const last = course.at(-1);
  if (of !== courseOf || (last && at < last.at)) course = [];
  courseOf = of;
  if (course.at(-1)?.at === at) return;
  course.push({ at, position, target });
  while (course.length > 1 && course[1]!.at < at - COURSE) course.shift();
}

/** The course as two lines: what the axis does, and what it should do. */
function lines(): SVGTemplateResult {
  const end = course.at(-1)?.at ?? 0;
  const all = course.flatMap(({ position, target }) => [position, target]);
  const [low, high] = [Math.min(...all), Math.max(...all)];
  const height = Math.max(high - low, 100);
  const middle = (low + high) / 2;
  const x = (at: number): string => (300 - ((end - at) / COURSE) * 300).toFixed(1);
  const y = (value: number): string => (32 - ((value - middle) / height) * 52).toFixed(1);
  const line = (of: 'position' | 'target'): string => course.map((one) => `${x(one.at)},${y(one[of])}`).join(' ');
  return svg`<svg class="course" viewBox="0 0 300 64" preserveAspectRatio="none" role="img" aria-label=${M.course}>
    <polyline class="course-target" points=${line('target')}/><polyline class="course-position" points=${line('position')}/></svg>`;
}

/** The shaft of the axis, with a mark for the position and one for the target. */
function dial(position: number, target: number): SVGTemplateResult {
  const angle = (value: number): string => `rotate(${((((value % TURN) + TURN) % TURN) / TURN) * 360})`;
  return svg`<svg class="axis-dial" viewBox="-50 -50 100 100" aria-hidden="true">
    <circle class="axis-rim" r="44"/>
    ${Array.from({ length: 12 }, (_, i) => svg`<path class="tick" d="M0 -44V-39" transform="rotate(${i * 30})"/>`)}
    <path class="axis-target" d="M0 -37L-4 -47H4Z" transform=${angle(target)}/>
    <circle class="axis-shaft" r="30"/>
    <path class="axis-mark" d="M0 -29V-10" transform=${angle(position)}/>
    <circle class="axis-hub" r="6"/>
  </svg>`;
}

const write = (axis: number, lines: [number, number][]): void =>
  void doLine(lines.map(([index, value]) => `sdo write ${(index + axis * AXIS).toString(16)}h = ${value}`).join('\n'));

/** Takes the axis to a target in its mode. */
function go(axis: number, mode: number, target: number): void {
  if (mode === 1) write(axis, [[0x607a, target], [0x6040, 0x0f], [0x6040, 0x1f]]);
  if (mode === 3) write(axis, [[0x60ff, target], [0x6040, 0x0f]]);
  if (mode === 6) write(axis, [[0x6040, 0x0f], [0x6040, 0x1f]]);
}

/** The view of an axis, with the buttons that choose one. */
export function drive(axis: number, axes: unknown): TemplateResult {
  const at = (index: number): number | null => number(index + axis * AXIS);
  const word = at(0x6041);
  const now = stateOf(word);
  const mode = at(0x6061) ?? 0;
  const isSpeed = mode === 3 || mode === 9;
  const position = at(0x6064) ?? 0;
  const demand = at(0x6062) ?? position;
  const target = at(isSpeed ? 0x60ff : 0x607a) ?? 0;
  const error = at(0x603f) ?? 0;
  const isOff = now === null;
  note(axis, position, demand);
  const shown = (value: number | null): string => (value === null ? '–' : grouped(value));
  const goes = (input: HTMLInputElement): void => go(axis, mode, Math.trunc(Number(input.value)) || 0);
  const field = (event: Event): HTMLInputElement => (event.currentTarget as HTMLElement).closest('.axis-go')!.querySelector('input')!;
  return html`
    <div class="axis-go">${axes}
      <span class="select bordered"><select aria-label=${M.mode} ?disabled=${isOff} @change=${(event: Event) => write(axis, [[0x6060, Number((event.target as HTMLSelectElement).value)]])}>
        ${[[0, M.noMode] as [number, string], ...MODES].map(([value, text]) => html`<option value=${value} ?selected=${value === mode}>${text}</option>`)}
      </select>${icons.chevron}</span>
      ${mode === 1 || mode === 3 || mode === 6
        ? html`${mode === 6 ? nothing : html`<input class="num" type="number" step="1" aria-label=${M.target} value=${target}
              @keydown=${(event: KeyboardEvent) => event.key === 'Enter' && goes(field(event))}>`}
            <button class="small primary" title=${M.goTitles[mode]!} ?disabled=${now !== 'enabled'} @click=${(event: Event) => (mode === 6 ? go(axis, 6, 0) : goes(field(event)))}>${M.go}</button>`
        : mode === 0 ? nothing : html`<span class="note">${M.byPdo}</span>`}
    </div>
    <div class="axis">
      ${dial(position, isSpeed ? position : target)}
      <dl class="axis-values">
        <div><dt>${M.position} <span class="muted">${M.units}</span></dt><dd class="num" data-value="position">${shown(at(0x6064))}</dd></div>
        <div><dt>${M.velocity} <span class="muted">${M.perSecond}</span></dt><dd class="num" data-value="velocity">${shown(at(0x606c))}</dd></div>
        <div><dt>${M.target} <span class="muted">${isSpeed ? M.perSecond : M.units}</span></dt><dd class="num" data-value="target">${isOff ? '–' : grouped(target)}</dd></div>
      </dl>
    </div>
    ${lines()}
    <section class="chart">
      ${chart(now)}
      <p class="words"><span class="num">6041h = ${word === null ? '–' : `${word.toString(16).toUpperCase().padStart(4, '0')}h`}</span>
        ${Object.entries(M.flags).map(([bit, text]) => (word !== null && (word >> Number(bit)) & 1 ? html`<span class="badge">${text}</span>` : nothing))}
        ${error ? html`<span class="badge" data-tone="bad">${M.error(error.toString(16).toUpperCase().padStart(4, '0'))}</span>` : nothing}
      </p>
      <div class="commands" role="group" aria-label=${M.commands}>
        ${COMMANDS.map(([word, name, states]) => html`<button class="small" title=${M.commandTitle(word)} ?disabled=${now === null || !states.includes(now)} @click=${() => write(axis, [[0x6040, word]])}>${name}</button>`)}
      </div>
    </section>
    <section class="pins"><div class="switches" role="group" aria-label=${M.inputs}>
      ${pins.value.filter(({ name }) => name.includes(String(axis + 1)) && !name.startsWith('shaft')).map((pin) => toggle(pin, M.pins[pin.name.replace(String(axis + 1), '')]))}
    </div></section>`;
}
