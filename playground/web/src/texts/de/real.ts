// A real bus, in German.

import type { real as english } from '../real';
import { grouped } from './number';

const frames = (count: number): string => `${grouped(count)} Frame${count === 1 ? '' : 's'}`;

export const real = {
  mark: 'Realer Bus',
  markTitle: 'Diese Frames sind auf einem realen Bus. Klick führt zur Verbindung.',
  title: 'Mit einem realen Bus verbinden',
  connected: 'Realer Bus',
  what: 'Diese Seite zeigt die Frames eines realen CAN-Busses. Der virtuelle Aufbau ist in dieser Zeit angehalten und bleibt erhalten. Das Senden ist aus, bis du es einschaltest. Ohne Hardware schließ dieses Fenster: Der Aufbau dieser Seite braucht keine.',
  webSocket: 'odkit auf diesem Computer',
  address: 'Adresse',
  addressHint: 'odkit sim und odkit bridge geben sie aus, zum Beispiel: odkit bridge --link socketcan:can0 --link ws:127.0.0.1:29538',
  connect: 'Verbinden',
  connecting: 'Verbindet …',
  cancel: 'Abbrechen',
  serial: 'CAN-Adapter mit slcan',
  serialHint: 'Die Seite öffnet den seriellen Port des Adapters (Web Serial).',
  notChosen: 'Es wurde kein Adapter gewählt. Wenn der Browser deinen nicht nennt, steck ihn neu ein und prüfe, ob der Rechner ihn als seriellen Port zeigt; unter Linux braucht dein Benutzer Zugriff auf den Port (oft die Gruppe dialout).',
  noSerial: 'Dieser Browser unterstützt Web Serial nicht; Chrome und Edge tun es. Mit odkit kann sich jeder Browser verbinden.',
  rate: 'Bitrate des Busses',
  keepRate: 'wie im Adapter eingestellt',
  kbit: (rate) => `${rate} kbit/s`,
  baud: 'Serieller Port',
  baudOf: (baud) => `${grouped(baud)} Baud`,
  choose: 'Adapter wählen',
  along: 'Die virtuellen Geräte kommen mit an den Bus',
  alongHint: 'Ihre Frames werden gesendet, sobald das Senden an ist. Gib ihnen Node-IDs, die der Bus nicht hat.',
  bad: {
    empty: 'Füg die Adresse ein, die odkit ausgegeben hat.',
    wrong: 'Das ist keine Adresse. Schreib ws://127.0.0.1:29538/?token=…, wie odkit sie ausgegeben hat.',
    far: 'Seiten dürfen sich nur mit diesem Computer verbinden (127.0.0.1 oder localhost). Starte odkit bridge auf diesem Computer.',
    noToken: 'In der Adresse fehlt das Token. Kopiere die ganze Adresse, die odkit ausgegeben hat.',
    port: (why) => `Der Port lässt sich nicht öffnen: ${why}`,
  },
  why: (why, name, isSerial) => {
    switch (why.kind) {
      case 'said':
        return `${name} hat die Verbindung abgelehnt: ${why.text}`;
      case 'refused':
        return `Bei ${name} antwortet nichts. Starte dort odkit sim oder odkit bridge, und vergleich den Port.`;
      case 'denied':
        return `${name} hat die Verbindung abgelehnt. Vielleicht sind zu viele Clients verbunden.`;
      case 'slow':
        return `${name} stellt die Verbindung nicht her. Vielleicht benutzt ein anderes Programm diesen Port.`;
      case 'silent':
        return isSerial ? 'Der Adapter antwortet nicht. Prüf, ob er slcan spricht, und die Geschwindigkeit seines seriellen Ports.' : `${name} antwortet nicht in slcan.`;
      case 'closed':
        return 'Der Adapter öffnet seinen CAN-Kanal nicht. Wähl eine Bitrate.';
      case 'gone':
        return isSerial ? 'Der Adapter wurde abgezogen.' : `${name} hat die Verbindung geschlossen.`;
    }
  },
  lost: 'Verbindung verloren',
  retries: 'Die Seite versucht es alle paar Sekunden neu. Das Senden bleibt aus.',
  replug: 'Steck den Adapter wieder an.',
  again: 'Neu verbinden',
  back: 'Zurück zum virtuellen Aufbau',
  sending: 'Senden',
  on: 'Senden ist an',
  off: 'Senden ist aus',
  onTitle: 'Frames dieser Seite und ihrer virtuellen Geräte gehen hinaus. Klick schaltet das Senden aus.',
  offTitle: 'Die Seite hört nur zu. Klick schaltet das Senden ein.',
  turnOn: 'Einschalten',
  held: 'Das Senden auf den realen Bus ist aus.',
  heldBack: (count) => `${frames(count)} zurückgehalten, während das Senden aus war`,
  dropped: (count) => `${frames(count)} verworfen: Die Seite ist zu langsam`,
  unsent: (count) => `${frames(count)} nicht gesendet: Die Verbindung ist zu langsam`,
  refused: (count) => `${frames(count)} vom Adapter abgelehnt; vielleicht ist er Bus-off`,
  noise: (count) => `${grouped(count)} ${count === 1 ? 'Zeile' : 'Zeilen'} nicht verstanden; prüf die Geschwindigkeit des seriellen Ports`,
  came: (count) => `${frames(count)} empfangen`,
  saveTitle: 'Die Frames des realen Busses speichern',
  leftWith: (count) => `Du bist wieder beim virtuellen Aufbau. ${frames(count)} des realen Busses lassen sich speichern.`,
  left: 'Du bist wieder beim virtuellen Aufbau.',
  save: 'Log speichern',
  nodes: 'Gehörte Knoten',
  noNodes: 'Bisher kein Heartbeat und keine SDO-Antwort.',
  scan: 'Knoten suchen',
  scanTitle: 'Liest 1000h von jeder Node-ID, 1 bis 127',
  scanning: (node) => `Knoten ${node} wird gefragt …`,
  found: (count) => (count ? `${count} Knoten ${count === 1 ? 'hat' : 'haben'} geantwortet.` : 'Kein Knoten hat geantwortet.'),
  show: 'Zeigen',
  node: (node) => `Knoten ${node}`,
  asked: (node) => `Die Identität von Knoten ${node} wird gelesen …`,
  noAnswer: (node) => `Knoten ${node} beantwortet keine SDO-Anfragen.`,
  panel: 'Knoten',
  identity: 'Identität',
  readAll: 'Alle Werte lesen',
  reading: (done, all) => `${done} von ${all} gelesen`,
  stop: 'Stopp',
  description: 'Die Objekte sind die von',
  changeDescription: 'Andere Beschreibung wählen',
  valuesHint: 'Werte erscheinen, wenn sie gelesen werden oder ein PDO sie trägt.',
  never: 'Bisher kein Heartbeat: Der NMT-Zustand ist unbekannt.',
  describes: 'Ein Knoten des realen Busses, den diese Datei beschreibt',
  virtual: 'Ein virtuelles Gerät, das an den realen Bus kommt',
  kindOf: 'Was an den Bus kommt',
} satisfies typeof english;
