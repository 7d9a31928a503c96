// A drive, an I/O module, in German.

import type { machine as english } from '../machine';

export const machine = {
  noShaft: 'Dieses Gerät hat keine Welle. Seine EDS-Datei legt seine Objekte fest.',
  axis: (axis: number) => `Achse ${axis}`,
  axes: 'Achse',
  position: 'Position',
  velocity: 'Geschwindigkeit',
  target: 'Ziel',
  units: 'Einheiten',
  perSecond: 'Einheiten/s',
  mode: 'Betriebsart',
  noMode: 'Keine Betriebsart',
  go: 'Los',
  goTitles: { 1: '607Ah, dann das Bit „new set-point“ von 6040h', 3: '60FFh', 6: 'Startet Homing mit Bit 4 von 6040h' } as Record<number, string>,
  byPdo: 'In dieser Betriebsart gibt ein Master das Ziel vor, Zyklus für Zyklus.',
  chart: 'Zustandsmaschine',
  chartIs: (state: string) => `Zustandsmaschine nach CiA 402: ${state}`,
  off: 'Keine Versorgung',
  commands: 'Kommandos von 6040h',
  commandTitle: (word: number) => `Schreibt ${word.toString(16).toUpperCase().padStart(2, '0')}h per SDO in 6040h`,
  flags: { 9: 'remote', 10: 'Ziel erreicht', 11: 'Grenze aktiv', 12: 'Betriebsart', 13: 'Fehler' } as Record<number, string>,
  error: (code: string) => `Fehler ${code}h`,
  course: 'Position und Ziel der letzten 10 Sekunden',
  inputs: 'Eingänge',
  outputs: 'Ausgänge',
  analogueInputs: 'Analogeingänge',
  analogueOutputs: 'Analogausgänge',
  pins: { 'limit-': 'Grenze −', 'limit+': 'Grenze +', home: 'Referenz', sto: 'STO', held: 'Welle blockiert', brake: 'Bremse offen' } as Record<string, string>,
  inputTitle: (name: string, on: boolean) => `${name}: ${on ? '1' : '0'}. Ein Klick ändert ihn.`,
  outputTitle: (name: string, on: boolean) => `${name}: ${on ? '1' : '0'}`,
} satisfies typeof english;
