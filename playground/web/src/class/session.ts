// The part of a student in a class: the page reports to the computer of the trainer where it is, and shows what is offered.

import { effect } from '@preact/signals-core';
import { clear as clearProgress, finished, progress } from '../lessons/kept';
import { lessons, openNamed, words } from '../lessons/open';
import { forget as forgetTab, kept } from '../lessons/tab';
import { forget as forgetBench } from '../share/keep';
import * as state from '../state';
import type { Refused } from './name';
import { CASE, TEST } from './places';
import { C } from './texts';

/** The student, as the class knows her. */
interface Member {
  name: string;
  key: string;
  group: string;
}

/** Milliseconds between two reports, before the report of a change, and that the class has for its answer. */
const PAUSE = 2000;
const SOON = 200;
const PATIENCE = 5000;
/** Failed reports after which the student is told. */
const MOST_FAILED = 3;

/** Without wrong answers and help: a fault case and the final test mark them at the end. */
const ALONE = { wrong: 0, hints: 0, shown: 0 };

const KEY = 'odkit.class';
/** The page that the student used last reports, if she has several of them. */
const LAST = 'odkit.class.page';
const PAGE = String(Math.random());
let member: Member | null = null;
/** The class has accepted a report of this visit. */
let isKnown = false;
let failed = 0;
let isReporting = false;
let timer = 0;
/** Number of the offer that is shown, and of the last one that the student accepted or dismissed. */
let shown = 0;
let answered = 0;

const post = (what: string, body: unknown): Promise<Response> =>
  fetch(`class/${what}`, { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body), signal: AbortSignal.timeout(PATIENCE) });

function become(one: Member | null): void {
  member = one;
  try {
    if (one) localStorage.setItem(KEY, JSON.stringify(one));
    else localStorage.removeItem(KEY);
  } catch {
    // Storage is not allowed: the student joins again after a reload.
  }
  state.member.value = { name: one?.name ?? '', change: () => void ask(member?.name ?? '') };
}

function stored(): Member | null {
  try {
    const { name, key, group } = JSON.parse(localStorage.getItem(KEY) ?? '{}') as Partial<Member>;
    return [name, key, group].every((text) => typeof text === 'string') ? ({ name, key, group } as Member) : null;
  } catch {
    return null;
  }
}

/** Makes this page the one that reports, as the member that another page of the student may have become. */
function use(): void {
  if (document.hidden) return;
  try {
    localStorage.setItem(LAST, PAGE);
  } catch {
    // Storage is not allowed: each page is a student of its own.
  }
  const now = stored();
  if (now && now.key !== member?.key) become(now);
}

/** Returns whether the student uses another page of this class. */
function isElsewhere(): boolean {
  try {
    return (localStorage.getItem(LAST) ?? PAGE) !== PAGE;
  } catch {
    return false;
  }
}

/** Asks for the name. `known`: a name that may be that of the student; empty for none. */
async function ask(known: string): Promise<void> {
  const { NameDialog } = await import('./name');
  NameDialog.open(known, { join, leave });
}

/** Joins the class; the reason if that is refused. */
async function join(name: string): Promise<Refused | null> {
  try {
    const response = await post('join', { name, key: member?.key });
    const answer = (await response.json()) as Member & { why?: Refused };
    if (!response.ok) return answer.why ?? 'unreachable';
    become(answer);
    // A class that was started again counts its offers from 1.
    [shown, answered] = [0, 0];
    soon();
    return null;
  } catch {
    return 'unreachable';
  }
}

/** Ends the session: what this page keeps of the class is removed, and it begins again. */
async function leave(): Promise<void> {
  member = null;
  window.clearTimeout(timer);
  become(null);
  clearProgress();
  forgetTab();
  await forgetBench().catch(() => undefined);
  location.replace(location.pathname + location.search);
}

/** Place in a fault case or in the final test, which cover the lesson; null elsewhere. */
function cover() {
  if (!state.lessonDialog.value) return null;
  const { value: wanted } = state.faultCase;
  if (wanted?.name) {
    const known = kept('case');
    const isMarked = known?.isMarked && known.name === wanted.name && known.seed === wanted.seed;
    return { name: CASE, step: isMarked ? 1 : 0, of: 1, ...ALONE };
  }
  const test = location.hash === TEST ? kept('test') : null;
  return test && { name: TEST, step: test.given.length, of: test.asked.length, ...ALONE };
}

/** The fault case, final test or lesson in progress; null on a free bench. */
function place() {
  const covering = cover();
  if (covering) return covering;
  const { value: lesson } = state.lesson;
  const { value: at } = state.lessonState;
  const { name } = state.lessonRun.value;
  if (!lesson || !at || !name) return null;
  const { wrong, hints } = state.effort.value;
  return { name, step: at.step, of: lesson.steps.length, wrong, hints, shown: progress()[name]?.[3] ?? 0 };
}

async function offer(number: number, name: string): Promise<void> {
  shown = number;
  const one = (await lessons().catch(() => [])).find((other) => other.name === name);
  const others = state.offers.value.filter(({ key }) => key !== 'class');
  state.offers.value = [...others, { key: 'class', text: C.student.offer(one ? words(one).title : name), action: C.student.open, run: () => void openNamed(name) }];
}

/** Answer of the class to a report. */
async function heard(response: Response): Promise<void> {
  const answer = (await response.json()) as { offer?: { number: number; lesson: string } | null; why?: 'reset' | 'removed' | 'unknown' };
  if (answer.why === 'reset') return leave();
  if (answer.why === 'removed') {
    const name = member?.name ?? '';
    become(null);
    return ask(name);
  }
  if (answer.why === 'unknown') {
    // The class was started again. A page that is opened later may belong to somebody else.
    const name = member?.name ?? '';
    member = null;
    if (!isKnown || (await join(name))) await ask(name);
    return;
  }
  if (!response.ok) throw new Error(String(response.status));
  isKnown = true;
  if (answer.offer && answer.offer.number > Math.max(shown, answered)) await offer(answer.offer.number, answer.offer.lesson);
}

async function report(): Promise<void> {
  if (isReporting) return;
  window.clearTimeout(timer);
  if (member && !isElsewhere()) {
    isReporting = true;
    const { key, group } = member;
    try {
      await heard(await post('report', { key, group, hidden: document.hidden, lesson: place(), finished: [...finished()], answered }));
      if (failed >= MOST_FAILED && state.toast.value?.text === C.student.lost) state.toast.value = null;
      failed = 0;
    } catch {
      failed += 1;
      if (failed === MOST_FAILED) state.toast.value = { text: C.student.lost, tone: 'error' };
    }
    isReporting = false;
  }
  timer = window.setTimeout(() => void report(), PAUSE);
}

function soon(): void {
  window.clearTimeout(timer);
  timer = window.setTimeout(() => void report(), SOON);
}

/** Begins to report; asks for the name first if the page does not know it. */
export function start(): void {
  become(stored());
  let step = '';
  effect(() => {
    const { name, count } = state.lessonRun.value;
    const now = `${name} ${count} ${state.lessonState.value?.step}`;
    // Answers and hints are those of a step.
    if (now !== step) state.effort.value = { wrong: 0, hints: 0 };
    step = now;
  });
  let before = '';
  effect(() => {
    // The state of a lesson comes with each snapshot, mostly without a change.
    const now = JSON.stringify(place());
    if (now !== before) soon();
    before = now;
  });
  effect(() => {
    const isShown = state.offers.value.some(({ key }) => key === 'class');
    if (!shown || isShown) return;
    answered = Math.max(answered, shown);
    shown = 0;
    soon();
  });
  use();
  for (const name of ['focus', 'visibilitychange']) window.addEventListener(name, () => { use(); soon(); });
  if (!member) void ask('');
  soon();
}
