import { openDevice, recall } from './actions';
import { start } from './sim/link';
import { deviceDialog } from './state';
import './views/app';

start();
const { source, nodeId } = recall();
void openDevice(source, nodeId).then(async (isOpen) => {
  if (!isOpen && source.kind === 'builtin') await openDevice({ kind: 'builtin', name: 'gxmm' }, nodeId);
});
window.addEventListener('hashchange', () => {
  const wanted = recall();
  deviceDialog.value = false;
  void openDevice(wanted.source, wanted.nodeId);
});
