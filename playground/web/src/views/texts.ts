// The texts of dialogs and lessons, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { dialogs } from '../texts/dialogs';

export let D: typeof dialogs = dialogs;
effect(() => {
  D = german.value?.D ?? dialogs;
});
