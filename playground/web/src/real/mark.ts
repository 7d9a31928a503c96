// The red mark of a real bus, with the switch for sending.

import { html } from 'lit';
import * as state from '../state';
import { View } from '../views/view';
import { R } from './texts';
import { setSending } from './connect';

class Mark extends View {
  protected override render() {
    const real = state.real.value;
    if (!real) return html``;
    const isLost = real.status === 'lost';
    const trouble = real.dropped + real.unsent + real.refused + real.noise > 0;
    return html`<button class="real-mark" data-status=${real.status} aria-haspopup="dialog" title=${isLost ? R.lost : R.markTitle} @click=${() => (state.realDialog.value = true)}>
        <i></i><strong>${R.mark}</strong><span class="real-name">${isLost ? R.lost : real.name}</span>${trouble ? html`<span class="count-badge">!</span>` : ''}
      </button>
      <button class="switch real-send" role="switch" aria-checked=${real.sending} aria-label=${R.sending} title=${real.sending ? R.onTitle : R.offTitle} ?disabled=${isLost} @click=${() => setSending(!real.sending)}>
        <span class="switch-track"><span class="switch-thumb"></span></span><span>${real.sending ? R.on : R.off}</span>
      </button>`;
  }
}

customElements.define('od-real-mark', Mark);
