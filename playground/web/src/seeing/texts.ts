// The texts of statistics, plots, trigger and replay, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { seeing } from '../texts/seeing';

export let S: typeof seeing = seeing;
effect(() => {
  S = german.value?.S ?? seeing;
});
