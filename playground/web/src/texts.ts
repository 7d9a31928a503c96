// Every text of the page, in one place (`texts/`), so that another language can follow: `German satisfies
// Texts` beside `en` is all it takes. What the simulation says (frames in words, faults of EDS
// files) comes from Rust in English.

import { bench } from './texts/bench';
import { bus } from './texts/bus';
import { page } from './texts/page';

const en = { ...bench, ...bus, ...page };

export const T = en;
export type Texts = typeof en;
