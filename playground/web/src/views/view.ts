// The base of all views: a custom element without a shadow root that draws itself
// again when a signal changes that its last drawing read.

import { LitElement } from 'lit';
import { effect } from '@preact/signals-core';

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
