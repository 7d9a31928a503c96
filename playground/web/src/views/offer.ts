// Offers that the page shows once: the bench of the last visit, a new version of the page.

import { html } from 'lit';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { View } from './view';

class Offers extends View {
  protected override render() {
    const drop = (offer: state.Offer): void => void (state.offers.value = state.offers.value.filter((one) => one !== offer));
    // During a lesson the page does not offer the last bench; in a dialog it offers only what a trainer offers, and on a real bus
    // also a log that the user has opened.
    const few = this.closest('dialog') ? ['class'] : state.real.value ? ['class', 'log'] : null;
    const offers = state.offers.value.filter(({ key }) => few?.includes(key) ?? (key !== 'kept' || state.lesson.value === null));
    return html`<div class="offers" role="region" aria-live="polite" aria-label=${T.share.offers} ?hidden=${offers.length === 0}>${offers.map(
      (offer) => html`<div class="offer">
        <span>${offer.text}</span>
        <button class="small primary" @click=${() => { drop(offer); offer.run(); }}>${offer.action}</button>
        ${offer.others?.map(({ text, run }) => html`<button class="small" @click=${() => { drop(offer); run(); }}>${text}</button>`)}
        <button class="quiet" aria-label=${T.share.notNow} title=${T.share.notNow} @click=${() => drop(offer)}>${icons.close}</button>
      </div>`,
    )}</div>`;
  }
}

customElements.define('od-offers', Offers);
