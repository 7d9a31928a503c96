// Lessons of the user, from files or a folder: a group of the list of lessons, kept in this browser.

import { signal } from '@preact/signals-core';
import { createStore, get, set } from 'idb-keyval';
import { use } from '../sim/link';
import * as state from '../state';
import { D } from '../views/texts';

/** A lesson of the list. */
export interface Listed {
  name: string;
  title: string;
  summary: string;
  level: number;
  minutes: number;
  /** Title and summary in German, if the lesson is translated. */
  de?: { title: string; summary: string };
  /** It is a lesson of the user or of the trainer; otherwise it comes with odkit. */
  isOwn?: boolean;
  /** Its text, if it has no file beside the page. */
  text?: string;
}

/** A lesson of the user, with its text. */
type Own = Listed & { text: string };

/** Maximum number of lessons; the oldest are removed. */
const MOST = 100;
/** Maximum size of a lesson in bytes. */
export const LONGEST = 1_000_000;

const KEY = 'all';
const kept = createStore('odkit-lessons', 'own');
/** A browser without storage may refuse at once; a promise is refused then. */
const store: typeof kept = async (mode, callback) => kept(mode, callback);
/** The lessons of this visit; undefined until they are read. */
let known: Own[] | undefined;
/** Counts how often the list changed. */
export const changes = signal(0);

/** The lessons of the user, by name; none if the browser stores nothing. */
export async function own(): Promise<Own[]> {
  known ??= await get<Own[]>(KEY, store).catch(() => undefined);
  return (known ??= []);
}

async function change(to: Own[]): Promise<void> {
  known = to;
  // Without storage the list exists as long as the page.
  await set(KEY, known, store).catch(() => undefined);
  changes.value += 1;
}

/** Adds lessons to the list; one of the same name is replaced. */
async function add(lessons: Own[]): Promise<void> {
  const names = new Set(lessons.map(({ name }) => name));
  const others = (await own()).filter(({ name }) => !names.has(name));
  const order = (one: Own, other: Own): number => one.name.localeCompare(other.name, undefined, { numeric: true });
  await change([...others, ...lessons].slice(-MOST).sort(order));
}

/** Removes all of them from the list. */
export const clear = (): Promise<void> => change([]);

/** Whether a text is a lesson: it begins with its front matter. */
const isLesson = (text: string): boolean => /^\uFEFF?\s*\+\+\+/.test(text);

/** Adds the text of a lesson that was opened. */
export async function keep(name: string, text: string): Promise<void> {
  const read = await use('parseLesson', text);
  if (!('value' in read) || !read.value.lesson) return;
  const { title, summary, level, minutes } = read.value.lesson;
  await add([{ name, title, summary, level, minutes, isOwn: true, text }]);
}

/**
 * Adds the lessons among these files to the list, and shows it with the errors of the others. Markdown files that do not
 * begin as a lesson are ignored: a folder of lessons may have a README.
 */
export async function openAll(files: File[]): Promise<void> {
  const lessons: Own[] = [];
  const failed: typeof state.lessonFailed.value = [];
  for (const file of files.filter(({ name }) => isMarkdown(name)).slice(0, MOST)) {
    const text = file.size > LONGEST ? '' : await file.text();
    if (!isLesson(text)) continue;
    const read = await use('parseLesson', text);
    if (!('value' in read)) continue;
    const { lesson, problems } = read.value;
    if (!lesson) {
      failed.push({ name: file.name, problems });
      continue;
    }
    const { title, summary, level, minutes } = lesson;
    lessons.push({ name: file.name, title, summary, level, minutes, isOwn: true, text });
  }
  if (lessons.length + failed.length === 0) {
    state.toast.value = { text: D.lessons.own.none, tone: 'error' };
    return;
  }
  await add(lessons);
  state.lessonFailed.value = failed;
  state.lessonDialog.value = true;
}

const isMarkdown = (name: string): boolean => /\.(md|markdown)$/i.test(name);

/** The files of what was dropped; a folder gives those that lie directly in it. */
export async function filesOf(entries: FileSystemEntry[]): Promise<File[]> {
  const file = (entry: FileSystemFileEntry): Promise<File> => new Promise((resolve, reject) => entry.file(resolve, reject));
  const read = (reader: FileSystemDirectoryReader): Promise<FileSystemEntry[]> => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
  const files: File[] = [];
  for (const entry of entries) {
    if (entry.isFile) files.push(await file(entry as FileSystemFileEntry));
    if (!entry.isDirectory) continue;
    const reader = (entry as FileSystemDirectoryEntry).createReader();
    // A reader gives its entries in portions; the last one is empty.
    for (let part = await read(reader); part.length > 0 && files.length < MOST; part = await read(reader)) {
      for (const one of part) if (one.isFile && isMarkdown(one.name)) files.push(await file(one as FileSystemFileEntry));
    }
  }
  return files;
}
