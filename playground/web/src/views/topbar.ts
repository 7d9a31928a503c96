// The devices on the bus, and virtual time.

import { html, nothing } from 'lit';
import * as state from '../state';
import { MOST_NODES, setRunning, setSpeed, step, stepBack } from '../actions';
import { select } from '../sim/link';
import { T } from '../texts';
import { icons } from './icons';
import { languageButton } from './language';
import { View } from './view';

const SPEEDS = [0.01, 0.1, 0.5, 1, 2, 10, 100, 1000];

/** The dialog is loaded on request. */
const openShare = (): void => void import('./share').then(() => (state.shareDialog.value = true));

/** Opens a real bus; its mark is loaded with it. */
const openConnect = (): void => void import('../real/dialog').then(() => (state.realDialog.value = true));

const openLessons = (): void => void (state.lessonDialog.value = true);

/** Opens this bench in a tab of its own. */
async function openFull(event: Event): Promise<void> {
  event.preventDefault();
  const { hashOf, now } = await import('../share/make');
  window.open(location.pathname + (await hashOf(await now(false))), '_blank', 'noopener');
}

class Topbar extends View {
  private isDark(): boolean {
    const chosen = document.documentElement.dataset['theme'];
    return chosen ? chosen === 'dark' : matchMedia('(prefers-color-scheme: dark)').matches;
  }

  private toggleTheme(): void {
    const theme = this.isDark() ? 'light' : 'dark';
    document.documentElement.dataset['theme'] = theme;
    try {
      localStorage.setItem('odkit.theme', theme);
    } catch {
      // Storage is not allowed: the choice exists as long as the page.
    }
    this.requestUpdate();
  }

  /** One button for each device; that of the selected device opens the dialog. */
  private nodes() {
    const { value: devices } = state.devices;
    const { value: chosen } = state.selectedNode;
    if (devices.length === 0) return html`<button class="device-button" aria-haspopup="dialog" @click=${() => (state.deviceDialog.value = 'new')}><strong>${state.real.value ? T.topbar.noNode : T.topbar.starting}</strong></button>`;
    return devices.map((device, number) => {
      const status = state.statuses.value[number];
      const nmt = status?.nmt ?? 'off';
      const isChosen = number === chosen;
      const node = status?.powered ? status.nodeId : device.nodeId;
      return html`<button class=${isChosen ? 'device-button' : 'node-button'} aria-haspopup=${isChosen ? 'dialog' : 'false'} aria-current=${isChosen}
        title=${isChosen ? T.topbar.change : T.topbar.choose}
        @click=${() => (isChosen ? (state.deviceDialog.value = number) : select(number))}>
        <i class="nmt-dot" data-nmt=${nmt}></i>
        <strong>${device.name}</strong>
        ${devices.length === 1 ? html`<span class="device-title">${device.source.kind === 'eds' ? device.source.name : T.dialog.kind(device.title.replace(/^[A-Z0-9]+, /, ''))}</span>` : nothing}
        <span class="badge">${T.topbar.nodeBadge(node)}</span><span class="sr">, ${nmt}</span>
        ${isChosen ? icons.chevron : nothing}
      </button>`;
    });
  }

  protected override render() {
    const isRunning = state.running.value;
    const t = T.topbar;
    return html`<header class="topbar">
      <a class="brand" href="#" aria-label=${t.again} @click=${(event: Event) => { event.preventDefault(); location.hash = ''; location.reload(); }}>
        <svg viewBox="0 0 32 32" width="24" height="24" aria-hidden="true"><rect width="32" height="32" rx="9" fill="var(--accent)"/><circle cx="16" cy="16" r="8.5" fill="none" stroke="var(--on-accent)" stroke-width="2.4"/><path d="M16 16V7.5" stroke="var(--on-accent)" stroke-width="2.4" stroke-linecap="round"/><circle cx="16" cy="16" r="2.4" fill="var(--on-accent)"/></svg>
        <span>odkit</span>
      </a>
      <div class="nodes" role="group" aria-label=${t.devices}>
        ${this.nodes()}
        ${state.devices.value.length > 0 && state.devices.value.length < (state.real.value ? 16 : MOST_NODES)
          ? html`<button class="icon-button add-node" aria-label=${t.add} title=${t.add} @click=${() => (state.deviceDialog.value = 'new')}>${icons.plus}</button>`
          : nothing}
      </div>
      <div class="spacer"></div>
      ${state.real.value ? html`<od-real-mark></od-real-mark>` : nothing}
      <div class="timebar" role="group" aria-label=${t.time}>
        <button class="icon-button step" aria-label=${t.back} title=${t.back} @click=${stepBack}>${icons.back}</button>
        <button class="icon-button" aria-label=${isRunning ? t.stop : t.run} title=${isRunning ? t.stop : t.run} aria-pressed=${isRunning}
          @click=${() => setRunning(!isRunning)}>${isRunning ? icons.pause : icons.play}</button>
        <button class="icon-button step" aria-label=${t.stepFrame} title=${t.stepFrame} @click=${() => step(0, 1)}>${icons.stepFrame}</button>
        <button class="icon-button step" aria-label=${t.step} title=${t.step} @click=${() => step(1000)}>${icons.step}</button>
        <od-clock></od-clock>
        <label class="select" title=${t.speedTitle}>
          <span class="sr">${t.speed}</span>
          <select aria-label=${t.speed} @change=${(event: Event) => setSpeed(Number((event.target as HTMLSelectElement).value))}>
            ${SPEEDS.map((factor) => html`<option value=${factor} ?selected=${factor === state.speed.value}>${factor}×</option>`)}
          </select>
          ${icons.chevron}
        </label>
      </div>
      <button class="learn-button" aria-haspopup="dialog" title=${T.lessons.title} @click=${openLessons}>${icons.lesson}<span>${T.lessons.learn}</span></button>
      <button class="icon-button connect-button" aria-label=${t.connect} title=${t.connect} aria-haspopup="dialog" @click=${openConnect}>${icons.plug}</button>
      <button class="icon-button share-button" aria-label=${t.share} title=${t.share} aria-haspopup="dialog" @click=${openShare}>${icons.share}</button>
      <a class="icon-button full-button" href=${location.pathname} target="_blank" aria-label=${T.share.full} title=${T.share.full} @click=${openFull}>${icons.open}</a>
      <button class="icon-button help-button" aria-label=${t.keys} title=${`${t.keys} (?)`} @click=${() => (state.helpDialog.value = true)}>${icons.help}</button>
      ${languageButton()}
      <button class="icon-button" aria-label=${t.theme} title=${t.theme} @click=${() => this.toggleTheme()}>${this.isDark() ? icons.sun : icons.moon}</button>
    </header>`;
  }
}

/** The virtual time, separate because it changes with every snapshot. */
class Clock extends View {
  protected override render() {
    const seconds = state.now.value / 1e6;
    const hours = Math.floor(seconds / 3600);
    const minutes = Math.floor((seconds % 3600) / 60);
    const rest = (seconds % 60).toFixed(3).padStart(6, '0');
    const text = `${hours ? `${hours}:` : ''}${String(minutes).padStart(2, '0')}:${rest}`;
    const slow = state.running.value && state.rate.value > 0 && state.rate.value < state.speed.value * 0.7;
    return html`${state.replaying.value ? html`<span class="slow">${T.topbar.replaying}</span>` : slow ? html`<span class="slow num" title=${T.topbar.slow}>${state.rate.value < 10 ? state.rate.value.toFixed(1) : Math.round(state.rate.value)}×</span>` : nothing}
      <span class="clock num" role="timer" aria-label=${T.topbar.time} aria-live="off" title=${T.topbar.time}>${text}</span>`;
  }
}

customElements.define('od-clock', Clock);
customElements.define('od-topbar', Topbar);
