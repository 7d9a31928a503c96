// The capture and the log beside it: a click shows one of them.

import { html, nothing } from 'lit';
import { icons } from '../views/icons';
import { View } from '../views/view';
import { beside, close, show } from './shelf';
import './style';
import { S } from './texts';

class Shelf extends View {
  protected override render() {
    const log = beside.value;
    if (!log) return nothing;
    return html`<span class="segmented" role="group" aria-label=${S.log.shown}>
      <button class="small" aria-pressed=${!log.isShown} @click=${() => show(false)}>${S.log.capture}</button>
      <button class="small log-name" aria-pressed=${log.isShown} title=${log.name} @click=${() => show(true)}>${log.name}</button>
      <button class="small" aria-label=${S.log.close(log.name)} title=${S.log.close(log.name)} @click=${close}>${icons.close}</button>
    </span>`;
  }
}

customElements.define('od-shelf', Shelf);
