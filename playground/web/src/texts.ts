// All texts of the page, in `texts/`, so that another language can be added: `German satisfies
// Texts` beside `en` is all it takes. Texts of the simulation (frames in words, faults of EDS
// files) come from Rust in English.

import { bench } from './texts/bench';
import { bus } from './texts/bus';
import { page } from './texts/page';

const en = { ...bench, ...bus, ...page };

export const T = en;
export type Texts = typeof en;
