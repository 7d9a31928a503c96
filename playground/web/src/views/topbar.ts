// Which device, and virtual time.

import { html, nothing } from 'lit';
import * as state from '../state';
import { setRunning, setSpeed, step } from '../actions';
import { icons } from './icons';
import { View } from './view';

const SPEEDS = [0.01, 0.1, 0.5, 1, 2, 10, 100, 1000];

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
      // Storage is off: the choice lasts as long as the page.
    }
    this.requestUpdate();
  }

  protected override render() {
    const device = state.device.value;
    const source = state.source.value;
    const isRunning = state.running.value;
    return html`<header class="topbar">
      <a class="brand" href="#" aria-label="odkit, start again" @click=${(event: Event) => { event.preventDefault(); location.hash = ''; location.reload(); }}>
        <svg viewBox="0 0 32 32" width="24" height="24" aria-hidden="true"><rect width="32" height="32" rx="9" fill="var(--accent)"/><circle cx="16" cy="16" r="8.5" fill="none" stroke="var(--on-accent)" stroke-width="2.4"/><path d="M16 16V7.5" stroke="var(--on-accent)" stroke-width="2.4" stroke-linecap="round"/><circle cx="16" cy="16" r="2.4" fill="var(--on-accent)"/></svg>
        <span>odkit</span>
      </a>
      <button class="device-button" aria-haspopup="dialog" @click=${() => (state.deviceDialog.value = true)}>
        <strong>${device?.name ?? 'Starting'}</strong>
        <span class="device-title">${source.kind === 'eds' ? source.name : (device?.title ?? '')}</span>
        <span class="badge">node ${state.nodeId.value}</span>
        ${icons.chevron}
      </button>
      <div class="spacer"></div>
      <div class="timebar" role="group" aria-label="Virtual time">
        <button class="icon-button" aria-label=${isRunning ? 'Stop time' : 'Run time'} title=${isRunning ? 'Stop time' : 'Run time'} aria-pressed=${isRunning}
          @click=${() => setRunning(!isRunning)}>${isRunning ? icons.pause : icons.play}</button>
        <button class="icon-button step" aria-label="Step 1 millisecond" title="Step 1 ms" @click=${() => step(1000)}>${icons.step}</button>
        <od-clock></od-clock>
        <label class="select" title="Speed of virtual time">
          <span class="sr">Speed</span>
          <select aria-label="Speed" @change=${(event: Event) => setSpeed(Number((event.target as HTMLSelectElement).value))}>
            ${SPEEDS.map((factor) => html`<option value=${factor} ?selected=${factor === state.speed.value}>${factor}×</option>`)}
          </select>
          ${icons.chevron}
        </label>
      </div>
      <button class="icon-button help-button" aria-label="Keys" title="Keys (?)" @click=${() => (state.helpDialog.value = true)}>${icons.help}</button>
      <button class="icon-button" aria-label="Light or dark" title="Light or dark" @click=${() => this.toggleTheme()}>${this.isDark() ? icons.sun : icons.moon}</button>
    </header>`;
  }
}

/** The virtual time on its own: it changes with every picture. */
class Clock extends View {
  protected override render() {
    const seconds = state.now.value / 1e6;
    const hours = Math.floor(seconds / 3600);
    const minutes = Math.floor((seconds % 3600) / 60);
    const rest = (seconds % 60).toFixed(3).padStart(6, '0');
    const text = `${hours ? `${hours}:` : ''}${String(minutes).padStart(2, '0')}:${rest}`;
    const slow = state.running.value && state.rate.value > 0 && state.rate.value < state.speed.value * 0.7;
    return html`${slow ? html`<span class="slow num" title="As fast as it goes with so many frames">${state.rate.value < 10 ? state.rate.value.toFixed(1) : Math.round(state.rate.value)}×</span>` : nothing}
      <span class="clock num" role="timer" aria-label="Virtual time" aria-live="off" title="Virtual time">${text}</span>`;
  }
}

customElements.define('od-clock', Clock);
customElements.define('od-topbar', Topbar);
