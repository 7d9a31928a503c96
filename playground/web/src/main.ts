import { begin, recall } from './actions';
import { start } from './sim/link';
import { deviceDialog } from './state';
import './views/app';

start();
void begin(recall());
window.addEventListener('hashchange', () => {
  deviceDialog.value = null;
  void begin(recall());
});
