// The texts of the page that the first visit needs, in its language. Views that are loaded on request have their own
// (`editor/texts.ts`, `real/texts.ts`, `seeing/texts.ts`). Texts of the simulation (frames in words, refusals, findings in EDS
// files, names of objects) come from Rust in English.

import { effect } from '@preact/signals-core';
import { german } from './language';
import { bench } from './texts/bench';
import { bus } from './texts/bus';
import { page } from './texts/page';

const english = { ...bench, ...bus, ...page };

export let T: typeof english = english;
effect(() => {
  T = german.value?.T ?? english;
});
