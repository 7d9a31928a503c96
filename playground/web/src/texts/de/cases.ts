// Texts of the fault cases in German.

import type { cases as english } from '../cases';

export const cases = {
  title: 'Fehlerfälle',
  hint: '20 Maschinen mit einem Fehler. Du findest seine Ursache mit so wenigen Prüfschritten wie möglich. Ein Startwert lost die Ursache aus.',
  begin: 'Fehlerfälle',
  back: 'Alle Lektionen',
  all: 'Alle Fälle',
  failed: 'Die Fehlerfälle konnten nicht geladen werden. Prüf die Verbindung und öffne sie noch einmal.',
  solved: 'gelöst und bewiesen',
  another: 'Andere Ursache auslosen',
  anotherTitle: 'Dasselbe Symptom mit einer anderen Ursache',
  seed: (seed) => `Startwert ${seed}`,
  copy: 'Link kopieren',
  copied: 'Kopiert',
  copyTitle: 'Der Link enthält den Startwert: Er öffnet denselben Fall',
  probes: 'Prüfschritte',
  each: 'Jeder Prüfschritt geschieht an der Maschine, wie sie jetzt ist. Danach ist alles wie zuvor.',
  used: (used) => `${used} ${used === 1 ? 'Prüfschritt' : 'Prüfschritte'} gemacht`,
  frames: (count) => `${count} ${count === 1 ? 'Frame' : 'Frames'}`,
  more: (count) => `und ${count} weitere`,
  errorFrame: 'Error-Frame',
  cause: 'Nenne die Ursache',
  name: 'Antwort prüfen',
  nothing: 'Wähl zuerst eine Ursache.',
  right: 'Richtig.',
  wrong: (cause) => `Nicht richtig. Die Ursache ist: ${cause}.`,
  proven: (used, fewest) =>
    used <= fewest ? `Deine Prüfschritte beweisen es, und mit weniger geht es nicht: ${used} von ${fewest}.` : `Deine ${used} Prüfschritte beweisen es. ${fewest} hätten genügt.`,
  guessed: (left, fewest) => `Deine Prüfschritte beweisen es nicht: ${left} Ursachen passen zu ihnen. Es braucht ${fewest} ${fewest === 1 ? 'Prüfschritt' : 'Prüfschritte'}.`,
  told: (out, left) => (out === 0 ? `schließt nichts Neues aus, ${left} übrig` : `schließt ${out} aus, ${left} übrig`),
  best: 'Die wenigsten Prüfschritte, die es beweisen',
  explanation: 'Woran man es erkennt',
} satisfies typeof english;
