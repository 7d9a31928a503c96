// The style sheet of views that are loaded on request.

import { sheet } from '../sheet';

await sheet('seeing');
