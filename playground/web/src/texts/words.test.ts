import { assert, test } from '../testing';
import { words } from './de/words';

test('the words of frames in German; names of objects and values stay', () => {
  for (const [english, german] of [
    ['Node 5: boot-up', 'Knoten 5: Boot-up'],
    ['Node 5: Operational', 'Knoten 5: Operational'],
    ['Start node 5', 'Start, Knoten 5'],
    ['Reset communication, all nodes', 'Reset communication, alle Knoten'],
    ['Triggers synchronous PDOs', 'Löst synchrone PDOs aus'],
    ['Read 1018h:01 Identity object.Vendor-ID', '1018h:01 Identity object.Vendor-ID lesen'],
    ['1000h Device type is 00020196h', '1000h Device type ist 00020196h'],
    ['Write 1017h Producer heartbeat time = 500', '1017h Producer heartbeat time = 500 schreiben'],
    ['Write of 1017h Producer heartbeat time confirmed', 'Schreiben von 1017h Producer heartbeat time bestätigt'],
    ['Value above the upper limit (06090031h): 6001h aborted', '06090031h Wert über der oberen Grenze: 6001h abgebrochen'],
    ['6001h aborted: 06020000h object does not exist', '6001h abgebrochen: 06020000h Objekt existiert nicht'],
    ['1008h Manufacturer device name has 26 bytes', '1008h Manufacturer device name hat 26 Bytes'],
    ['Last segment of 1008h Manufacturer device name: "gxmm"', 'Letztes Segment von 1008h Manufacturer device name: "gxmm"'],
    ['Node 5: 8130h life guard or heartbeat error, error register 11h, 00 00 00 00 00', 'Knoten 5: 8130h Fehler bei Life Guarding oder Heartbeat, Fehlerregister 11h, 00 00 00 00 00'],
    ['TPDO1 Position value = 5', 'TPDO1 Position value = 5'],
    ['Configure node ID 5', 'Node-ID einstellen: 5'],
    ['Switch state selective, serial number 1268h', 'Zustand selektiv wechseln, Seriennummer 1268h'],
    ['Store configuration: done', 'Konfiguration speichern: erledigt'],
    ['Read 1000h: 4 bytes, but an SDO message has 8', '1000h lesen: 4 Bytes, aber eine SDO-Nachricht hat 8'],
    ['1 byte, but an SDO message has 8', '1 Byte, aber eine SDO-Nachricht hat 8'],
    ['Node 5: 8210h PDO not processed, length error, error register 11h, 00 00 00 00 00', 'Knoten 5: 8210h PDO nicht verarbeitet, falsche Länge, Fehlerregister 11h, 00 00 00 00 00'],
    ['Switch state global: 2 bytes, but an LSS message has 8 (CiA 305)', 'Zustand global wechseln: 2 Bytes, aber eine LSS-Nachricht hat 8 (CiA 305)'],
    ['70000 does not fit UNSIGNED16', '70000 passt nicht in UNSIGNED16'],
    ['“g” is not a hexadecimal digit', '„g“ ist keine hexadezimale Ziffer'],
    ['Node 5: a save failed; the values saved before it remain', 'Knoten 5: ein Speichern ist gescheitert; die Werte, die vorher gespeichert waren, bleiben'],
    ['the product code (1018h:02) differs from the expected one (1F86h)', 'Der Produktcode (1018h:02) ist nicht wie erwartet (1F86h)'],
    ['no heartbeat within 250 ms', 'Kein Heartbeat in 250 ms'],
    ['6001h: SDO abort 06090031h value above the upper limit', '6001h: SDO-Abbruch 06090031h Wert über der oberen Grenze'],
    ['', ''],
  ]) assert.equal(words(english!), german);
  // An abort code that CiA 301 does not define has no text.
  assert.equal(words('Unknown abort code (12345678h): 6001h aborted'), '12345678h: 6001h abgebrochen');
});
