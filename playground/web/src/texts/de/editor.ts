// The editor of EDS files and the report of a file, in German.

import type { editor as english } from '../editor';
import { grouped } from './number';

const count = (number: number, one: string, more: string): string => `${grouped(number)} ${number === 1 ? one : more}`;

export const editor = {
  counts: (errors, warnings, remarks) => `${grouped(errors)} Fehler, ${count(warnings, 'Warnung', 'Warnungen')}, ${count(remarks, 'Hinweis', 'Hinweise')}`,
  goTo: (line, column) => `Zu Zeile ${line}, Spalte ${column}`,
  checking: 'Wird geprüft …',
  broken: 'Der Sprachserver ist stehen geblieben und wird neu gestartet.',
  report: {
    label: 'Befunde in der Datei',
    runs: (name, node) => `${name} ist als Knoten ${node} am Bus.`,
    lenient: (name, node) => `${name} ist ohne die ungültigen Teile als Knoten ${node} am Bus.`,
    cannot: (name) => `${name} kann nicht starten.`,
    full: (name, why) => `${name} ist nicht am Bus: ${why}`,
    clean: 'Keine Befunde.',
    list: 'Befunde nach Regel, Fehler zuerst',
    edit: 'Im Editor öffnen',
    close: 'Bericht schließen',
    not: (name, what, next = '') => `${name} ist ${what}, keine EDS-Datei von CANopen. ${next}Der Aufbau ist unverändert.`,
    asLog: 'Als Log öffnen',
  },
  kinds: {
    empty: 'leer',
    picture: (format) => `ein Bild (${format})`,
    pdf: 'ein PDF-Dokument',
    zip: 'ein ZIP-Archiv',
    write: 'Der Editor sagt, was eine neue braucht. ',
    unpack: 'Entpacke es und öffne dann die EDS-Datei darin. ',
    blank: 'ein Text ohne Inhalt',
    archive: (format) => `ein Archiv (${format})`,
    program: 'ein Programm',
    log: (frames) => `ein Log eines Busses mit ${count(frames, 'Frame', 'Frames')}`,
    webPage: 'eine Webseite',
    xml: 'eine XML-Datei ohne CANopen-Profil',
    json: 'eine JSON-Datei',
    binary: 'eine Binärdatei',
    text: 'ein Text ohne einen Abschnitt wie [FileInfo]',
  },
  editor: {
    title: (name, node) => `${name}, Knoten ${node}`,
    text: 'Text der EDS',
    run: 'Starten',
    runTitle: 'Das Gerät bootet mit diesem Text',
    ran: (node) => `Knoten ${node} bootet mit diesem Text. Sein EEPROM ist das eines neuen Geräts.`,
    ranLenient: (node) => `Knoten ${node} bootet mit diesem Text, ohne die ungültigen Teile. Sein EEPROM ist das eines neuen Geräts.`,
    cannot: (line, message) => `Kann nicht starten. Zeile ${line}: ${message}`,
    cannotNow: 'Kann nicht starten: Behebe zuerst die Fehler.',
    toBench: 'Aufbau zeigen',
    fixAll: 'Alle beheben',
    fixAllTitle: 'Alle sicheren Korrekturen anwenden, wie odkit check --fix',
    draft: 'Deine Änderungen an diesem Text sind wieder da. Strg+Z macht sie rückgängig.',
    mixed: (ending) => `Diese Datei hat Zeilen, die mit CRLF enden, und Zeilen, die mit LF enden. Sobald du sie änderst, wird sie in jeder Zeile mit ${ending} gespeichert.`,
    fixed: 'Alle sicheren Korrekturen sind angewendet. Strg+Z macht sie rückgängig.',
    nothingToFix: 'Kein Befund hat eine sichere Korrektur.',
    noFix: 'Keine Korrektur; berichtige den Text selbst.',
    jump: 'Zum Objekt',
    jumpTitle: 'Von einem PDO-Mapping, einer Liste oder einer COB-ID zu ihrem Objekt (F12, oder Strg und Klick)',
    noTarget: 'Setz den Cursor zuerst auf einen PDO-Mapping-Eintrag, einen Listeneintrag oder eine COB-ID.',
    search: 'Suchen',
    searchTitle: 'Suchen und ersetzen (Strg+F)',
    save: 'Als Datei speichern',
    side: 'Neben dem Text',
    sides: { findings: 'Befunde', outline: 'Gliederung', changes: 'Änderungen' },
  },
  outline: {
    search: 'Abschnitte durchsuchen',
    hint: 'Index oder Name',
    list: 'Abschnitte der Datei',
  },
  changes: {
    sum: (all, breaking) =>
      all === 0
        ? 'Ein Master bemerkt keinen Unterschied zu dem Gerät, das hier war.'
        : `Ein Master bemerkt ${count(all, 'Unterschied', 'Unterschiede')}, ${breaking ? `davon ${grouped(breaking)} unverträglich` : 'keinen unverträglichen'}:`,
    list: 'Unterschiede für einen Master',
    breaking: 'unverträglich',
    more: (rest) => `und ${grouped(rest)} weitere`,
  },
} satisfies typeof english;
