// The texts of the labs, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { labs } from '../texts/labs';

export let L: typeof labs = labs;
effect(() => {
  L = german.value?.L ?? labs;
});
