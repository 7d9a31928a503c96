// Asks a student for the name under which the trainer sees her.

import { html, nothing } from 'lit';
import { sheet } from '../sheet';
import { T } from '../texts';
import { icons } from '../views/icons';
import { languageButton } from '../views/language';
import { View } from '../views/view';
import { C } from './texts';

await sheet('dialogs');

export type Refused = 'name' | 'taken' | 'full' | 'unreachable';

/** Purpose of the dialog. */
interface Deeds {
  /** Joins the class; the reason if that is refused. */
  join(name: string): Promise<Refused | null>;
  /** Ends the session of another student in this page. */
  leave(): Promise<void>;
}

export class NameDialog extends View {
  static override properties = { known: { state: true }, said: { state: true }, isBusy: { state: true } };
  /** The name that this page had. */
  declare known: string;
  declare said: string;
  declare isBusy: boolean;
  private deeds: Deeds | undefined;

  constructor() {
    super();
    this.known = '';
    this.said = '';
    this.isBusy = false;
  }

  /** Opens the dialog of the page. */
  static open(known: string, deeds: Deeds): void {
    const home = document.querySelector<NameDialog>('od-name') ?? document.body.appendChild(new NameDialog());
    home.known = known;
    home.deeds = deeds;
    home.said = '';
    void home.updateComplete.then(() => {
      const dialog = home.querySelector('dialog')!;
      if (!dialog.open) dialog.showModal();
      const field = home.querySelector('input')!;
      field.value = known;
      field.focus();
    });
  }

  private async join(event: Event): Promise<void> {
    event.preventDefault();
    this.isBusy = true;
    const refused = (await this.deeds?.join(this.querySelector('input')!.value)) ?? null;
    this.isBusy = false;
    this.said = refused ? C.student.refused[refused]! : '';
    if (!refused) this.querySelector('dialog')!.close();
  }

  protected override render() {
    const t = C.student;
    return html`<dialog class="dialog" aria-labelledby="class-title">
      <form class="dialog-body" @submit=${(event: Event) => void this.join(event)}>
        <header class="dialog-head"><h2 id="class-title">${t.title}</h2><div class="spacer"></div>${languageButton()}<button type="button" class="icon-button" aria-label=${T.close} @click=${() => this.querySelector('dialog')!.close()}>${icons.close}</button></header>
        <p class="note">${t.hint}</p>
        <div class="share-field"><label for="class-name">${t.name}</label>
          <input id="class-name" autocomplete="name" maxlength="40" aria-describedby="class-said" aria-invalid=${this.said !== ''}>
          <button class="primary" type="submit" ?disabled=${this.isBusy}>${t.join}</button></div>
        <p id="class-said" class="note" role="status" data-tone="error" ?hidden=${!this.said}>${this.said}</p>
        ${this.known ? html`<div><button type="button" class="small" @click=${() => void this.deeds?.leave()}>${t.stranger(this.known)}</button></div>` : nothing}
      </form></dialog>`;
  }
}

customElements.define('od-name', NameDialog);
