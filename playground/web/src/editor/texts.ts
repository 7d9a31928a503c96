// The texts of the editor and of the report of a file, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { editor } from '../texts/editor';

export let E: typeof editor = editor;
effect(() => {
  E = german.value?.E ?? editor;
});
