// Texts of the WebAssembly module in German: words of frames, refusals and notices. Names of objects and values stay English.

/** Texts of the SDO abort codes (CiA 301, table 22). */
const ABORTS: Record<string, string> = {
  '05030000': 'Toggle-Bit wechselte nicht',
  '05040000': 'SDO-Übertragung dauerte zu lange',
  '05040001': 'Kommando unbekannt oder nicht an der Reihe',
  '05040002': 'Blockgröße außerhalb des Bereichs',
  '05040003': 'Folgenummer im Block falsch',
  '05040004': 'Prüfsumme des Blocks falsch',
  '05040005': 'kein Speicher für die Übertragung',
  '06010000': 'so nicht zugreifbar',
  '06010001': 'Objekt kann nur geschrieben werden',
  '06010002': 'Objekt kann nur gelesen werden',
  '06010003': 'Subindex 0 muss zuerst 0 sein',
  '06020000': 'Objekt existiert nicht',
  '06040041': 'Objekt kann nicht in ein PDO gemappt werden',
  '06040042': 'Mapping länger als das PDO',
  '06040043': 'Parameter passen nicht zusammen',
  '06040047': 'das Gerät kann das intern nicht',
  '06060000': 'Hardwarefehler beim Zugriff auf das Objekt',
  '06070010': 'Länge passt nicht zum Datentyp',
  '06070012': 'Daten länger als das Objekt',
  '06070013': 'Daten kürzer als das Objekt',
  '06090011': 'Subindex existiert nicht',
  '06090030': 'Wert nicht erlaubt',
  '06090031': 'Wert über der oberen Grenze',
  '06090032': 'Wert unter der unteren Grenze',
  '06090036': 'Maximum kleiner als Minimum',
  '060A0023': 'Ressource nicht verfügbar',
  '08000000': 'allgemeiner Fehler',
  '08000020': 'Daten können nicht gespeichert werden (falsche Signatur)',
  '08000021': 'Daten können wegen lokaler Bedienung nicht gespeichert werden',
  '08000022': 'nicht in diesem Zustand des Geräts',
  '08000023': 'Objektverzeichnis fehlt oder wurde nicht erzeugt',
  '08000024': 'keine Daten verfügbar',
};

const abort = (code: string, english: string): string => `${code}h ${ABORTS[code] ?? english}`.trim();

/** Names of the LSS commands (CiA 305). */
const LSS: Record<string, string> = {
  'switch state global': 'Zustand global wechseln',
  'configure node ID': 'Node-ID einstellen',
  'configure bit timing': 'Bit-Timing einstellen',
  'activate bit timing': 'Bit-Timing aktivieren',
  'store configuration': 'Konfiguration speichern',
  'switch state selective, vendor-ID': 'Zustand selektiv wechseln, Vendor-ID',
  'switch state selective, product code': 'Zustand selektiv wechseln, Produktcode',
  'switch state selective, revision number': 'Zustand selektiv wechseln, Revisionsnummer',
  'switch state selective, serial number': 'Zustand selektiv wechseln, Seriennummer',
  'switch state selective, confirmed': 'Zustand selektiv wechseln, bestätigt',
  'identify remote slave, vendor-ID': 'Slave identifizieren, Vendor-ID',
  'identify remote slave, product code': 'Slave identifizieren, Produktcode',
  'identify remote slave, lowest revision': 'Slave identifizieren, kleinste Revisionsnummer',
  'identify remote slave, highest revision': 'Slave identifizieren, größte Revisionsnummer',
  'identify remote slave, lowest serial number': 'Slave identifizieren, kleinste Seriennummer',
  'identify remote slave, highest serial number': 'Slave identifizieren, größte Seriennummer',
  'identify non-configured slave': 'nicht konfigurierten Slave identifizieren',
  'identify slave': 'Slave identifiziert',
  'non-configured slave': 'nicht konfigurierter Slave',
  fastscan: 'Fastscan',
  'inquire vendor-ID': 'Vendor-ID abfragen',
  'inquire product code': 'Produktcode abfragen',
  'inquire revision number': 'Revisionsnummer abfragen',
  'inquire serial number': 'Seriennummer abfragen',
  'inquire node ID': 'Node-ID abfragen',
};

const commands = Object.keys(LSS).sort((a, b) => b.length - a.length).join('|');

/** Words after the name of an LSS command. */
const lssRest = (rest: string): string =>
  rest
    .replace(/^ (\d+)$/, ': $1')
    .replace(/^: done$/, ': erledigt')
    .replace(/^: error (.*)$/, ': Fehler $1')
    .replace(/^, table (\d+), index (\d+)$/, ', Tabelle $1, Index $2')
    .replace(/^, delay (.*)$/, ', Verzögerung $1')
    .replace(/^: (\d+) bytes?, but an LSS message has 8 (.*)$/, ': $1 Bytes, aber eine LSS-Nachricht hat 8 $2');

const IDENTITY: Record<string, string> = { 'device type': 'der Gerätetyp', 'vendor-ID': 'die Vendor-ID', 'product code': 'der Produktcode', 'revision number': 'die Revisionsnummer', 'serial number': 'die Seriennummer' };

/** Words after the node, from the whole text to its parts; the first match applies. `$1` stays as it is. */
const WORDS: [RegExp, string | ((...parts: string[]) => string)][] = [
  [/^(start|stop|enter Pre-operational|reset node|reset communication) node (\d+)$/, '$1, Knoten $2'],
  [/^boot-up$/, 'Boot-up'],
  [/^node guarding request$/, 'Anfrage (Node Guarding)'],
  [/^unknown state (.*)$/, 'unbekannter Zustand $1'],
  [/^one byte is required$/, 'ein Byte ist nötig'],
  [/^(.*), all nodes$/, '$1, alle Knoten'],
  [/^counter (\d+)$/, 'Zähler $1'],
  [/^triggers synchronous PDOs$/, 'löst synchrone PDOs aus'],
  [/^time stamp$/, 'Zeitstempel'],
  [/^no service uses this CAN-ID$/, 'kein Dienst nutzt diese CAN-ID'],
  [/^unknown command (.*)$/, 'unbekanntes Kommando $1'],
  [/^command not defined in CiA 301$/, 'Kommando nicht in CiA 301'],
  [/^eight bytes are required$/, 'acht Bytes sind nötig'],
  [/^(.*), but an SDO message has 8$/, '$1, aber eine SDO-Nachricht hat 8'],
  [/^(.*) aborted: ([0-9A-F]{8})h(?: (.*))?$/, (_, name, code, english) => `${name} abgebrochen: ${abort(code!, english ?? '')}`],
  [/^(?:.*) \(([0-9A-F]{8})h\): (.*) aborted$/, (_, code, name) => `${abort(code!, '')}: ${name} abgebrochen`],
  [/^read (.*) in blocks of (\d+)$/, '$1 in Blöcken von $2 lesen'],
  [/^read (.*)$/, '$1 lesen'],
  [/^write of (.*) confirmed$/, 'Schreiben von $1 bestätigt'],
  [/^write of (.*) accepted in blocks of (\d+)$/, 'Schreiben von $1 in Blöcken von $2 angenommen'],
  [/^write (.*), (\d+) bytes? in segments$/, '$1 schreiben, $2 Bytes in Segmenten'],
  [/^write (.*) in segments$/, '$1 in Segmenten schreiben'],
  [/^write (.*) in blocks(?:, (\d+) bytes?)?$/, (_, name, size) => `${name} in Blöcken schreiben${size ? `, ${size} Bytes` : ''}`],
  [/^write (.*)$/, '$1 schreiben'],
  [/^next segment of (.*)$/, 'nächstes Segment von $1'],
  [/^last segment of (.*)$/, 'letztes Segment von $1'],
  [/^last segment (\d+) of a block of (.*)$/, 'letztes Segment $1 eines Blocks von $2'],
  [/^segment (\d+) of a block of (.*)$/, 'Segment $1 eines Blocks von $2'],
  [/^segment of (.*) confirmed$/, 'Segment von $1 bestätigt'],
  [/^segment of (.*), (\d+) bytes?$/, 'Segment von $1, $2 Bytes'],
  [/^block of (.*) confirmed up to segment (\d+)$/, 'Block von $1 bis Segment $2 bestätigt'],
  [/^start blocks of (.*)$/, 'Blöcke von $1 beginnen'],
  [/^end of (.*), CRC (.*)$/, 'Ende von $1, CRC $2'],
  [/^(.*) is complete(.*)$/, '$1 ist vollständig$2'],
  [/^(.*) follows in segments$/, '$1 folgt in Segmenten'],
  [/^(.*) has (\d+) bytes?, in blocks$/, '$1 hat $2 Bytes, in Blöcken'],
  [/^(.*) has data, in blocks$/, '$1 hat Daten, in Blöcken'],
  [new RegExp(`^(${commands})([^]*)$`), (_, name, rest) => LSS[name!]! + lssRest(rest!)],
  [/^no command$/, 'kein Kommando'],
  // The reasons why a master does not start a node.
  [/^the node is not in the network list \(1F81h\)$/, 'der Knoten ist nicht in der Netzwerkliste (1F81h)'],
  [/^the node does not respond to the upload of its device type \(1000h\)$/, 'der Knoten antwortet nicht auf den Upload seines Gerätetyps (1000h)'],
  [/^the (device type|vendor-ID|product code|revision number|serial number) \((.*)\) differs from the expected one \((.*)\)$/, (_, what, is, expected) => `${IDENTITY[what!]!} (${is}) ist nicht wie erwartet (${expected})`],
  [/^the configuration \(1F22h\) could not be written$/, 'die Konfiguration (1F22h) konnte nicht geschrieben werden'],
  [/^no heartbeat came when error control began$/, 'es kam kein Heartbeat, als die Überwachung begann'],
  [/^no heartbeat (?:within|for) (\d+) ms$/, 'kein Heartbeat in $1 ms'],
  [/^the node has (.*), expected is (.*)$/, 'der Knoten hat $1, erwartet ist $2'],
  [/^no response comes in time$/, 'die Antwort kommt nicht rechtzeitig'],
  [/^(.*): SDO abort ([0-9A-F]{8})h(?: (.*))?$/, (_, name, code, english) => `${name}: SDO-Abbruch ${abort(code!, english ?? '')}`],
  [/^the network list is empty; write `slave (\d+)`$/, 'die Netzwerkliste ist leer; schreib `slave $1`'],
  // A line or a value that is refused.
  [/^the frame is missing$/, 'der Frame fehlt'],
  [/^a CAN frame has at most 8 bytes$/, 'ein CAN-Frame hat höchstens 8 Bytes'],
  [/^\[(\d+)\] is followed by (\d+) bytes$/, 'auf [$1] folgen $2 Bytes'],
  [/^an 11-bit CAN-ID is at most 7FF$/, 'eine CAN-ID mit 11 Bit ist höchstens 7FF'],
  [/^the CAN-ID has to be a hexadecimal number, such as 601$/, 'die CAN-ID muss eine hexadezimale Zahl sein, zum Beispiel 601'],
  [/^a CAN-ID has up to 3 digits, or 8 digits \(29 bits, up to 1FFFFFFF\)$/, 'eine CAN-ID hat bis zu 3 Ziffern, oder 8 (29 Bit, bis 1FFFFFFF)'],
  [/^“(.*)” is not a hexadecimal digit$/, '„$1“ ist keine hexadezimale Ziffer'],
  [/^the value is missing$/, 'der Wert fehlt'],
  [/^“(.*)” is longer than (\d+) bytes$/, '„$1“ ist länger als $2 Bytes'],
  [/^“(.*)” is not a number$/, '„$1“ ist keine Zahl'],
  [/^“(.*)” is not a whole number \(decimal, 0x1F or 1Fh\)$/, '„$1“ ist keine ganze Zahl (dezimal, 0x1F oder 1Fh)'],
  [/^(-?\d+) does not fit (.*)$/, '$1 passt nicht in $2'],
  [/^type the bytes in hexadecimal$/, 'gib die Bytes hexadezimal ein'],
  [/^a (number|duration) is missing$/, (_, what) => (what === 'number' ? 'eine Zahl fehlt' : 'eine Dauer fehlt')],
  [/^`(.*)` is not a duration$/, '`$1` ist keine Dauer'],
  [/^`(.*)` is not valid$/, '`$1` ist nicht gültig'],
  [/^unexpected `(.*)`$/, '`$1` ist hier nicht erlaubt'],
  [/^(.*) is missing$/, '$1 fehlt'],
  [/^(.*) `(.*)` does not exist$/, '$1 `$2` gibt es nicht'],
  [/^the transfer failed$/, 'die Übertragung ist gescheitert'],
  // Notices about the EEPROM of a device.
  [/^(\d+) saved values? in the EEPROM did not fit the device, which loaded the others$/, '$1 gespeicherte Werte im EEPROM passen nicht zum Gerät; es hat die anderen geladen'],
  [/^bits of the EEPROM changed; the device loaded the last save, which is whole$/, 'Bits des EEPROM haben sich geändert; das Gerät hat den letzten Speicherstand geladen, der ganz ist'],
  [/^the last save in the EEPROM is damaged; the device loaded the older one before it$/, 'der letzte Speicherstand im EEPROM ist beschädigt; das Gerät hat den älteren davor geladen'],
  [/^another device or an older odkit wrote the EEPROM; the device loaded defaults, and the saved values stay until the next save$/, 'ein anderes Gerät oder ein älteres odkit hat das EEPROM geschrieben; das Gerät hat Standardwerte geladen, und die gespeicherten Werte bleiben bis zum nächsten Speichern'],
  [/^the EEPROM is damaged; the device loaded defaults$/, 'das EEPROM ist beschädigt; das Gerät hat Standardwerte geladen'],
  [/^a save was interrupted; the device loaded its factory values$/, 'ein Speichern wurde unterbrochen; das Gerät hat seine Werkswerte geladen'],
  [/^a save (?:was interrupted|failed); the values saved before it remain$/, 'ein Speichern ist gescheitert; die Werte, die vorher gespeichert waren, bleiben'],
  [/^(.*) requested \(RTR\)$/, '$1 angefordert (RTR)'],
  [/^([0-9A-Fa-f]{4}h.*) has (\d+) bytes?$/, '$1 hat $2 Bytes'],
  [/^([0-9A-Fa-f]{4}h.*?) is (.*)$/, '$1 ist $2'],
  [/^([0-9A-F]{4}h) (.*), error register (\w\wh)(.*)$/, (_, code, english, register, rest) => `${code} ${EMCYS[english!] ?? english}, Fehlerregister ${register}${rest}`],
];

/** Error codes of EMCY messages that encoders and CANopen itself send. */
const EMCYS: Record<string, string> = {
  'no error, or error reset': 'kein Fehler, oder Fehler beendet',
  'life guard or heartbeat error': 'Fehler bei Life Guarding oder Heartbeat',
  'battery low': 'Batterie schwach',
  'position error': 'Positionsfehler',
  'EEPROM error': 'EEPROM-Fehler',
  'internal communication error': 'interner Kommunikationsfehler',
  'software reset (watchdog)': 'Software-Reset (Watchdog)',
  'CAN overrun (objects lost)': 'CAN-Überlauf (Frames verloren)',
  'CAN in error passive mode': 'CAN-Controller error passive',
  'recovered from bus-off': 'von Bus-off zurückgekehrt',
};

/** A text of the module in German; it begins with a capital letter. One that is not known stays English. */
export function words(text: string): string {
  const [, node, said = ''] = /^(?:Node (\d+): )?([^]*)$/.exec(text)!;
  const first = node ? `Knoten ${node}: ` : '';
  const rest = said.charAt(0).toLowerCase() + said.slice(1);
  for (const [pattern, german] of WORDS) {
    if (!pattern.test(rest)) continue;
    // `replace` has two forms for the two kinds.
    const whole = first + (typeof german === 'string' ? rest.replace(pattern, german) : rest.replace(pattern, german));
    return whole.charAt(0).toUpperCase() + whole.slice(1);
  }
  return first + said;
}
