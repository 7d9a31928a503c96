// The texts of the fault cases, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { cases } from '../texts/cases';

export let F: typeof cases = cases;
effect(() => {
  F = german.value?.F ?? cases;
});
