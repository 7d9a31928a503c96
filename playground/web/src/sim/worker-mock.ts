import { host } from './host';
import { MockBus } from './mock';

void host(async () => new MockBus());
