// The texts of a class, in the language of the page.

import { effect } from '@preact/signals-core';
import { german } from '../language';
import { classroom } from '../texts/class';

export let C: typeof classroom = classroom;
effect(() => {
  C = german.value?.C ?? classroom;
});
