// The base of all views: a custom element without a shadow root that draws itself
// again when a signal changes that its last drawing read.

import { html, LitElement } from 'lit';
import { effect } from '@preact/signals-core';
import { german } from '../language';
import * as state from '../state';
import { T } from '../texts';

/** A text in which the parts between backticks are code. */
export const withCode = (text: string): unknown[] => text.split('`').map((part, i) => (i % 2 ? html`<code>${part}</code>` : part));

/** Loads a view that the first visit does not need. Its element draws itself when it is there. */
export function load(part: () => Promise<unknown>): void {
  part().catch(() => (state.toast.value = { text: T.frames.unloaded, tone: 'error' }));
}

export class View extends LitElement {
  private stop: (() => void) | undefined;

  protected override createRenderRoot(): HTMLElement {
    return this;
  }

  protected override performUpdate(): void {
    if (!this.isUpdatePending) return;
    this.stop?.();
    let isDrawing = true;
    this.stop = effect(() => {
      if (isDrawing) {
        isDrawing = false;
        // Another language is another drawing.
        void german.value;
        super.performUpdate();
      } else {
        this.requestUpdate();
      }
    });
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.requestUpdate();
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stop?.();
    this.stop = undefined;
  }
}
