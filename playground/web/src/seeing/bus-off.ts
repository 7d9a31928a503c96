// What a controller of the bench that is bus-off needs: the page's own below the frames, a node's in its hardware.

import { html, nothing } from 'lit';
import * as state from '../state';
import { act } from '../sim/link';
import { T } from '../texts';
import { View } from '../views/view';
import './style';
import { S } from './texts';

class BusOff extends View {
  static override properties = { node: {} };
  /** The number of the node; none is the page. */
  declare node?: number;

  protected override render() {
    const { node } = this;
    const one = node === undefined ? state.line.value : state.statuses.value[node];
    if (one?.controller !== 'bus-off') return nothing;
    const t = S.busOff;
    const again = (): void => {
      if (node === undefined) return act({ op: 'restart', station: 0 });
      act({ op: 'power', node, on: false });
      act({ op: 'power', node, on: true });
    };
    return html`<p class="bus-off note" data-tone="error" role="status"><span>${node === undefined ? t.page : t.node}</span>
      <button class="small" @click=${again}>${node === undefined ? T.hardware.restart : t.power}</button></p>`;
  }
}

customElements.define('od-bus-off', BusOff);
