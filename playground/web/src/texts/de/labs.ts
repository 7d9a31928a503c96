// The labs in German: the master, and the physics of the bus line.

import type { labs as english } from '../labs';

const micros = (nanos: number): string => (nanos < 10_000 ? `${Math.round(nanos)} ns` : `${(nanos / 1000).toFixed(1)} µs`);

export const labs = {
  labs: 'Labore',
  close: (name) => `${name} schließen`,
  failed: 'Das Labor konnte nicht geladen werden. Prüf die Verbindung und öffne es noch einmal.',
  master: {
    title: 'Master',
    summary: 'Ein kleiner NMT-Master, den du mit einer Liste programmierst. Er bootet seine Knoten nach CiA 302-2 und sagt, wo er warum angehalten hat.',
    list: 'Die Liste des Masters, eine Anweisung je Zeile',
    hint: (node) => `slave ${node}\nexpect ${node} 1000h = 0x00020196\nwrite ${node} 1017h = 100\nheartbeat ${node} 250ms\nsync 50ms`,
    boot: 'Booten',
    bootTitle: 'Der Master übernimmt diese Liste und bootet alle Knoten darin',
    clear: 'Leeren',
    clearTitle: 'Der Master vergisst seine Liste und beendet SYNC',
    changed: 'Die Liste ist geändert. Booten übernimmt sie.',
    line: (line, why) => `Zeile ${line}: ${why}`,
    none: 'Die Liste ist leer. Eine erste Zeile ist „slave“ und eine Node-ID.',
    guide: 'Zeilen der Liste',
    orders: [
      ['slave 5', 'bootet Knoten 5 (1F81h)'],
      ['expect 5 1018h:02 = 10', 'Knoten 5 wird nur mit diesem Wert gestartet; auch von 1000h und 1018h:01 bis 04 (1F84h bis 1F88h)'],
      ['write 5 1017h = 100', 'schreibt diesen Wert vor dem Start (1F22h)'],
      ['heartbeat 5 250ms', 'Knoten 5 ist verloren, wenn sein Heartbeat diese Zeit lang ausbleibt (1016h)'],
      ['sync 50ms', 'sendet SYNC mit dieser Periode (1006h)'],
    ],
    chart: (node) => `Boot-Vorgang von Knoten ${node}`,
    node: (node) => `Knoten ${node}`,
    stages: ['In der Liste', 'Reset', 'Boot-up', 'Gerätetyp', 'Identität', 'Konfiguration', 'Überwachung', 'Start'],
    objects: ['1F81h', 'NMT', '1F89h', '1F84h', '1F85h–1F88h', '1F22h', '1016h', 'NMT'],
    slave: { waiting: 'wartet', booting: 'wird gebootet', started: 'gestartet', failed: 'gescheitert', lost: 'verloren' } as Record<string, string>,
    stage: { done: 'erledigt', now: 'läuft', failed: 'hier angehalten', skipped: 'nichts zu tun', missed: 'kam nicht', open: 'nicht erreicht' } as Record<string, string>,
    status: (letter, meaning) => `Fehlerstatus ${letter}: ${meaning}`,
    after: (millis) => `+${millis < 10 ? millis.toFixed(1) : Math.round(millis)} ms`,
    dcf: (node) => `1F22h:${node.toString(16).toUpperCase().padStart(2, '0')}, Concise DCF`,
  },
  line: {
    title: 'Leitung',
    summary: 'Länge, Abtastpunkt, Abschlusswiderstände und Takte der Busleitung; Frames und Error-Frames sind ihre Wirkung.',
    rate: 'Bitrate',
    traffic: 'Um die Wirkung zu sehen, lass einen Knoten senden: Schreib 1000 nach 1017h für einen Heartbeat.',
    length: 'Länge',
    metres: (metres) => (metres ? `${metres} m` : 'kurz'),
    samplePoint: 'Abtastpunkt',
    sjw: 'SJW',
    quanta: (sjw, all) => `${sjw}/${all} Bit`,
    clock: (node) => `Takt von Knoten ${node}`,
    slow: (value) => (value === 0 ? 'genau' : `${Math.abs(value).toFixed(1)} % zu ${value > 0 ? 'langsam' : 'schnell'}`),
    terminators: 'Abschluss',
    bit: (rate, bit) => `Ein Bit bei ${rate} kbit/s, ${micros(bit)}`,
    sampled: (time) => `abgetastet nach ${micros(time)}`,
    returns: (time) => `hin und zurück ${micros(time)}`,
    settles: (time) => `rezessiv nach ${micros(time)}`,
    verdict: (isLate, isSlow, longest) =>
      isLate
        ? `Die Bestätigung kommt nach dem Abtastpunkt: Der Sender sieht sie nicht. Bei dieser Bitrate und diesem Abtastpunkt darf die Leitung ${longest} m haben.`
        : isSlow
          ? 'Die Leitung ist noch dominant, wenn ein rezessives Bit abgetastet wird: Ihr fehlen Abschlusswiderstände.'
          : `Die Bestätigung kommt vor dem Abtastpunkt. Bei dieser Bitrate und diesem Abtastpunkt darf die Leitung ${longest} m haben.`,
    bench: 'Die kurze Leitung des Aufbaus: Ihre Laufzeit spielt keine Rolle. Gib ihr eine Länge.',
    tolerance: (percent) => `Zwei Takte dürfen sich um ${percent.toFixed(2)} % unterscheiden.`,
    table: (rate, metres) => `CiA 301: ${metres} m bei ${rate} kbit/s.`,
    counters: 'Fehlerzähler',
    page: 'Interface',
    tec: 'TEC',
    rec: 'REC',
  },
} satisfies typeof english;
