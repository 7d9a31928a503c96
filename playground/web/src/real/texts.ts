// The texts for a real bus, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { real } from '../texts/real';

export let R: typeof real = real;
effect(() => {
  R = german.value?.R ?? real;
});
