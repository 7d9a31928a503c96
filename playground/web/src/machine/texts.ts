// The texts of a drive or an I/O module, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { machine } from '../texts/machine';

export let M: typeof machine = machine;
effect(() => {
  M = german.value?.M ?? machine;
});
