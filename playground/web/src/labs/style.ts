// The style sheet of the labs; the first visit does not load it.

import { sheet } from '../sheet';

await sheet('labs');
