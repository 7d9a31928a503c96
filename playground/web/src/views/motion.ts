// Motion profiles for a shaft: pairs of rpm and milliseconds.

import { act } from '../sim/link';

const STEP = 50;

/** A speed curve over one period, as steps. */
const curve = (seconds: number, rpm: (phase: number) => number): number[] => {
  const count = Math.round((seconds * 1000) / STEP);
  return Array.from({ length: count }, (_, i) => [Math.round(rpm((i + 0.5) / count) * 100) / 100, STEP]).flat();
};

const ramp = (phase: number): number => Math.min(1, phase * 5, (1 - phase) * 5);

export const PROFILES = [
  { key: 'swing', steps: [60, 2000, -60, 2000] },
  { key: 'sine', steps: curve(4, (phase) => 60 * Math.sin(2 * Math.PI * phase)) },
  { key: 'ramp', steps: [...curve(5, (phase) => 300 * ramp(phase)), 0, 1000] },
  { key: 'index', steps: [30, 500, 0, 1000] },
] as const;

const chosen = new Map<number, string>();

/** The profile that a device follows. */
export const motionOf = (node: number): string => chosen.get(node) ?? '';

/** The steps of a text such as `60 2, 0 1`; or the part that is not valid. */
export function parseMotion(text: string): number[] | string {
  const steps: number[] = [];
  for (const part of text.split(/[,;\n]/).map((one) => one.trim())) {
    const match = /^(-?\d+(?:\.\d+)?)\s*(?:rpm)?\s+(\d+(?:\.\d+)?)\s*s?$/i.exec(part);
    const seconds = Number(match?.[2]);
    if (!match || !(seconds > 0) || Math.abs(Number(match[1])) > 6000) return part;
    steps.push(Number(match[1]), seconds * 1000);
  }
  return steps;
}

/** Sets the profile of a shaft; none stops it. */
export function choose(node: number, key: string, text = ''): void {
  const parsed = key === 'own' ? parseMotion(text) : (PROFILES.find((one) => one.key === key)?.steps ?? []);
  if (typeof parsed === 'string') return;
  chosen.set(node, key);
  if (parsed.length) act({ op: 'follow', node, steps: [...parsed], repeats: true });
  else act({ op: 'rpm', node, rpm: 0 });
}
