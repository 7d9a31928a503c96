// All texts of the page in German: one module, which is loaded when the page is in German.
//
// A text that is missing here is a compile error (`satisfies typeof english` in each part), and `texts.test.ts` lists lists and
// texts that differ in number. The page says "du" and uses the imperative; buttons are infinitives (Speichern, Lesen).
//
// Words, as German CANopen trainers say them:
//   abort, abort code          abbrechen, Abort-Code       mapping, mapping entry    Mapping, Mapping-Eintrag
//   acknowledge                bestätigen                  node, node ID             Knoten, Node-ID
//   arbitration                Arbitrierung                object dictionary         Objektverzeichnis
//   bench                      Aufbau                      position value            Positionswert
//   bit rate                   Bitrate                     power cycle               aus- und einschalten
//   bus line, terminator       Busleitung,                 request, response         Anfrage, Antwort
//                              Abschlusswiderstand         revolution                Umdrehung
//   capture                    Aufzeichnung                SDO upload, download      SDO-Upload, SDO-Download
//   default, saved value       Standardwert,               shaft                     Welle
//                              gespeicherter Wert          sub-index                 Subindex
//   disable (a PDO), not valid abschalten, ungültig        switch the power on       Versorgung einschalten
//   error counter              Fehlerzähler                transmission type         Übertragungstyp
//   finding, fix               Befund, Korrektur           transmit error counter    Sendefehlerzähler
//   measuring units            Messschritte                value, current value      Wert, aktueller Wert
// Unchanged: Boot-up, CAN-ID, COB-ID, EMCY, Event-Timer, Frame, Guard Time, Heartbeat, Inhibit Time, LSS states, Master, NMT
// states and commands (Operational, Reset Node), Node Guarding, PDO, Preset, SYNC, Trace, the names of SDO abort codes.

import { bench } from './de/bench';
import { bus } from './de/bus';
import { cases } from './de/cases';
import { classroom } from './de/class';
import { dialogs } from './de/dialogs';
import { editor } from './de/editor';
import { labs } from './de/labs';
import { machine } from './de/machine';
import { page } from './de/page';
import { real } from './de/real';
import { seeing } from './de/seeing';
import { words } from './de/words';

/** `T`, `D`, `E`, `M`, `R`, `S`, `L`, `F` and `C` are the names under which the page uses these texts, `W` translates the words of a frame. */
export const catalogue = { T: { ...bench, ...bus, ...page }, D: dialogs, E: editor, M: machine, R: real, S: seeing, L: labs, F: cases, C: classroom, W: words };
