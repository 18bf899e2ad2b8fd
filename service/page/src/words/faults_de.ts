import type {FaultWords} from './words.ts';

// The daemon's faults in German, each with its title.
const kStill = 'nichts hat sich bewegt';
const kClear = 'der Arm hat die Antastung beendet und steht frei von der Fläche';
const kUnrecorded = `${kClear}; nichts wurde aufgezeichnet`;
const kRanToEnd = 'der Arm fuhr bis ans Ende der Suche und zog sich zurück; nichts wurde aufgezeichnet';
const kStopped = 'der Arm hat angehalten und steht, wo er war';
const kAgain = 'dann touchcal retry, um diese Antastung zu wiederholen, touchcal skip, um sie auszulassen, oder touchcal stop';
const kAnew = 'dann touchcal clear, touchcal reset und ein neuer Lauf';
const kResumeOrAnew = 'dann touchcal resume, wo ein Lauf wartet, sonst touchcal reset und ein neuer Lauf';
const kResumeBroken = 'dann touchcal resume, um die unterbrochene Antastung zu wiederholen, oder touchcal stop; in ABORTED touchcal clear, dann touchcal reset';
const kResumeTouch = 'dann touchcal resume, um diese Antastung nochmals zu versuchen, oder touchcal stop';

const told = (title: string, cause: string, robot_action: string, next_step: string): [string, FaultWords] =>
    [title, {cause, robot_action, next_step}];

/** The daemon's table of faults, by code: title, cause, what the robot did, what to do. */
const kFaults: Readonly<Record<string, [string, FaultWords]>> = {
  controller_not_connected: told('Steuerung nicht verbunden', 'es gibt keine Verbindung zur Steuerung', kStill,
    'die Steuerung einschalten und ihre Anwendung starten; der Dienst versucht es weiter'),
  controller_state_unknown: told('Zustand der Steuerung unbekannt', 'die Steuerung hat ihren Zustand noch nicht gemeldet', kStill,
    'eine Sekunde warten und nochmals starten'),
  emergency_stop: told('Not-Halt', 'der Not-Halt ist gedrückt oder nicht quittiert', kStill, 'den Not-Halt lösen und quittieren'),
  not_remote: told('kein Fernbetrieb', 'die Steuerung ist nicht im Fernbetrieb', kStill, 'die Steuerung auf Fernbetrieb stellen'),
  not_powered: told('Arm ohne Leistung', 'der Arm hat keine Leistung', kStill, 'die Leistung des Arms einschalten'),
  hold: told('Halt am Handgerät', 'das Handgerät hält den Arm', kStill, 'den Halt am Handgerät aufheben'),
  not_calibrated: told('Nullpunkte unbekannt', 'der Arm kennt seine Gelenknullpunkte nicht', kStill,
    'die Steuerung ihre Gelenknullpunkte suchen lassen'),
  probe_touched: told('Taster meldet Kontakt', 'der Taster meldet Kontakt, bevor sich etwas bewegt hat', kStill,
    'den Taster befreien oder Kabel und Polung prüfen'),
  task_error: told('Task der Steuerung beendet', 'ein Task der Anwendung auf der Steuerung ist zu Ende', kStill,
    'die Anwendung auf der Steuerung neu starten'),
  monitor_speed: told('Monitorgeschwindigkeit verringert', 'die Monitorgeschwindigkeit ist nicht 100 %', kStill,
    'die Monitorgeschwindigkeit auf 100 % stellen'),
  probe_not_calibrated: told('Taster nicht kalibriert', 'der Vorlauf des Tasters wurde nicht bei der Geschwindigkeit dieser Kontakte gemessen', kStill,
    'den Taster bei der Kontaktgeschwindigkeit der Zelle kalibrieren oder diese auf die kalibrierte stellen'),
  run_active: told('Lauf im Gang', 'ein anderer Lauf ist im Gang', 'der Arm macht mit jenem Lauf weiter',
    'sein Ende abwarten, oder touchcal stop oder touchcal abort'),
  fault_unacknowledged: told('Störung nicht quittiert', 'eine angezeigte Störung hat noch niemand quittiert', kStill,
    'sie lesen, ihre Ursache beheben, dann touchcal acknowledge'),
  not_in_this_state: told('in diesem Zustand nicht möglich', 'der Zustand erlaubt diesen Befehl nicht', 'der Arm macht weiter wie zuvor',
    'einen der erlaubten Befehle geben'),
  answer_missing: told('Antwort der Steuerung fehlt', 'die Steuerung lebt, hat aber einen Befehl nicht rechtzeitig beantwortet',
    'die Verbindung wurde getrennt, worauf der Arm von selbst anhält', `den Bildschirm der Steuerung ansehen, ${kResumeBroken}`),
  plan_invalid: told('Plan ungültig', 'eine Antastung des Plans hat keine Länge, keine Geschwindigkeit oder keine Nummer', kStill,
    'Geschwindigkeiten und Rezept der Zelle oder die Grenzen der Anwendung berichtigen, dann touchcal resume, wo ein Lauf wartet, ' +
      'sonst touchcal clear, touchcal reset und ein neuer Lauf'),
  probe_triggered: told('Taster vor der Antastung ausgelöst', 'der Taster meldete Kontakt, bevor die Antastung begann',
    'der Arm ist nicht losgefahren und steht frei von der Fläche',
    `den Stift befreien und sein Kabel prüfen, ${kAgain}; nach einem Stopp touchcal reset, in ABORTED zuerst touchcal clear`),
  early_contact: told('Kontakt zu früh', 'der Taster löste aus, als die Suche kaum begonnen hatte', kUnrecorded,
    `nach Schmutz und Hindernissen vor der Fläche sehen, ${kAgain}`),
  false_trigger: told('Fehlauslösung', 'der Taster löste in der Luft aus, und bei der Wiederholung nochmals', kRanToEnd,
    `Kabel, Schirm und Sitz des Tasters prüfen, ${kAgain}`),
  monitor_speed_changed: told('Monitorgeschwindigkeit geändert', 'die Monitorgeschwindigkeit wurde während des Laufs geändert',
    'der Arm steht; wo er weitermacht, wiederholt er die Antastung',
    'die Monitorgeschwindigkeit auf 100 % stellen: der Lauf geht von selbst weiter, ein wartender durch touchcal resume; touchcal pause hält ihn, ' +
      'touchcal stop beendet ihn; nach einem Stopp touchcal reset, in ABORTED zuerst touchcal clear'),
  touch_spread: told('Kontakte streuen', 'die beiden Kontakte einer Antastung liegen jedes Mal zu weit auseinander', kUnrecorded,
    `prüfen, ob Block, Stift und Taster fest sind, ${kAgain}`),
  retries_worse: told('Wiederholung schlechter', 'eine wiederholte Antastung ist schlechter als zuvor', kUnrecorded,
    `die Befestigung von Block und Taster prüfen, ${kAgain}`),
  repeated_touch: told('Gelenkwinkel einer früheren Antastung', 'die Steuerung meldet nochmals die Gelenkwinkel einer früheren Antastung', kUnrecorded,
    `die Anwendung auf der Steuerung neu starten, wenn es wieder geschieht; sonst ${kAgain.replace('dann ', '')}`),
  touch_does_not_fit: told('Antastung passt nicht', 'eine Antastung passt nicht zu den anderen, und wiederholt weder zu ihnen noch zu sich selbst', kClear,
    'sehen, ob Block, Stift und Taster fest sind, dann touchcal retry, um sie zu wiederholen, touchcal skip, um sie auszulassen, oder touchcal resume, um sie zu behalten'),
  reference_drift: told('Drift der Referenz', 'die Referenzstelle ist nicht mehr, wo sie am Anfang war', kClear,
    'sehen, ob Block und Taster fest sind und der Arm warm ist, dann touchcal retry, um sie nochmals anzutasten, touchcal resume, um trotzdem weiterzumachen, oder touchcal stop'),
  wrong_stylus: told('anderer Stift', 'die Antastungen widersprechen dem Radius aus der Datei des Tasters', kClear,
    'prüfen, welcher Stift montiert ist, und seine Datei, dann touchcal stop, oder touchcal resume, um trotzdem weiterzumachen'),
  probe_bounced: told('Taster prellt', 'der Taster prellte nach einem Kontakt', 'die erste Flanke zählt, der Lauf geht weiter',
    'den Taster prüfen, wenn es oft vorkommt'),
  latch_missing: told('Kontakt nicht gespeichert', 'ein Kontakt wurde nicht gespeichert, sondern im nächsten Takt gelesen',
    'die Antastung zählt, der Lauf geht weiter', 'das Kabel des schnellen Eingangs prüfen'),
  stopped_in_search: told('Suche gestoppt', 'eine Suche wurde gestoppt', 'der Arm ging auf der Linie seiner Suche zurück',
    'touchcal reset führt weiter'),
  controller_overruns: told('Tasks der Steuerung verspätet', 'ein Task der Steuerung wurde in seinem Takt nicht fertig',
    'die Antastung zählt, der Lauf geht weiter', 'die Anzahl notieren; andere Anwendungen auf der Steuerung beenden'),
  first_touch_biased: told('erste Antastung weicht ab', 'die erste Antastung des Laufs weicht von ihrer Wiederholung ab',
    'der Arm tastet die Stelle nochmals an und macht weiter', 'den Taster vor dem nächsten Lauf mit einigen Antastungen warm machen'),
  arm_moved: told('Arm bewegt', 'der Arm steht nicht, wo ihn die Antastung zuvor gelassen hat', 'der Weg wurde von dort neu gesucht',
    'während eines Laufs das Handgerät nicht anfassen'),
  touch_outlier: told('Ausreißer', 'eine Antastung passt nicht zu den anderen, auch wiederholt nicht',
    'der Arm hat die Antastung wiederholt; die erste bleibt', 'die verworfenen Antastungen des Ergebnisses ansehen'),
  face_bias: told('Fläche passt nicht', 'die Antastungen einer Fläche passen schlechter als die der anderen', 'der Arm hat den Lauf beendet',
    'die Fläche reinigen und ihr Zertifikat prüfen'),
  false_triggers_many: told('viele Fehlauslösungen', 'Fehlauslösungen kommen oft vor', 'jede Antastung wurde wiederholt, der Lauf geht weiter',
    'vor dem nächsten Lauf Batterie, Fenster und Kabel des Tasters prüfen'),
  touches_left_out: told('Antastungen ausgelassen', 'Antastungen des Plans wurden ausgelassen: der Lauf ist unvollständig',
    'der Arm hat die übrigen Antastungen gemacht', 'für ein vollständiges Ergebnis einen neuen Lauf machen'),
  controller_unreachable: told('Steuerung nicht erreichbar', 'die Steuerung ist nicht zu erreichen', 'nichts: es gibt keine Verbindung',
    'prüfen, ob die Anwendung der Steuerung läuft und ihre Adresse stimmt; der Dienst versucht es weiter; dann touchcal resume, wo ein Lauf wartet'),
  controller_incompatible: told('andere Steuerung', 'die Steuerung ist nicht die dieser Zelle', 'nichts: sie wurde vor jeder Bewegung abgelehnt',
    'die passende Anwendung installieren oder die Datei der Zelle berichtigen; der Dienst versucht es weiter'),
  protocol_error: told('Protokollfehler', 'die Steuerung hat etwas gesendet, das das Protokoll nicht kennt',
    'ohne Verbindung hält der Arm von selbst an; er steht, wo er war',
    'prüfen, was unter der Adresse der Steuerung antwortet und dass kein anderer Rechner sie benutzt; der Dienst versucht es weiter; ' +
      'dann touchcal resume, wo ein Lauf wartet, in ABORTED touchcal clear und touchcal reset'),
  link_lost: told('Verbindung verloren', 'die Verbindung zur Steuerung ging verloren',
    'der Arm hält nach der Überwachungszeit von selbst an und steht, wo er war',
    'Kabel und Steuerung ansehen; der Dienst versucht es weiter; wo ein Lauf wartet, touchcal resume, um die unterbrochene Antastung zu wiederholen, ' +
      'oder touchcal stop; in STOPPED touchcal reset; in ABORTED touchcal clear, dann touchcal reset'),
  recipe_unreachable: told('Rezept nicht erreichbar', 'die Antastungen des Rezepts lassen sich in dieser Zelle nicht planen', kStill,
    'den Platz des Blocks, die Grenze der Neigung oder das Rezept ändern'),
  not_ready: told('Zelle nicht bereit', 'die Zelle wurde nicht rechtzeitig bereit gemacht', kStill, `die Zelle bereit machen, ${kResumeOrAnew}`),
  touch_test_missing: told('Stift nicht von Hand berührt', 'niemand hat den Stift von Hand berührt, seit die Zelle offen war', kStill,
    `den Stift im Handbetrieb oder ohne Leistung von Hand berühren, die Zelle verlassen und schließen, ${kResumeOrAnew}`),
  cell_open: told('Zelle offen', 'die Zelle ist offen', kStill, `den Stift von Hand berühren, die Zelle verlassen und schließen, ${kResumeOrAnew}`),
  not_confirmed: told('nicht bestätigt', 'an der Zelle hat niemand rechtzeitig bestätigt', kStill,
    'touchcal resume, wo ein Lauf wartet, sonst touchcal reset und ein neuer Lauf; die Bestätigungstaste an der Zelle innerhalb von 30 s drücken'),
  touch_rejected: told('Befehl abgelehnt', 'die Steuerung hat einen Befehl abgelehnt',
    'was abgelehnt wurde, hat nichts bewegt; ein schon laufender Befehl wurde gestoppt',
    `die Ursache an der Zelle beheben, ${kResumeTouch}; in ABORTED touchcal clear, dann touchcal reset`),
  no_contact: told('kein Kontakt', 'die Suche endete ohne Kontakt', kRanToEnd, `den Platz des Blocks und das Kabel des Tasters prüfen, ${kResumeTouch}`),
  unexpected_contact: told('unerwarteter Kontakt', 'der Taster hat außerhalb einer Suche etwas berührt', 'der Arm hat sofort angehalten und steht dort',
    `ihn mit dem Handgerät wegfahren, das Hindernis suchen, ${kAnew}`),
  probe_stuck: told('Taster klemmt', 'der Taster meldet nach dem Rückzug noch Kontakt',
    'der Arm hat sich zurückgezogen und steht frei von der Fläche; nichts wurde aufgezeichnet', `den Stift befreien, ${kResumeTouch}`),
  probe_fault: told('Störung des Tasters', 'die beiden Eingänge des Tasters widersprechen sich: ein Kabel ist unterbrochen oder kurzgeschlossen',
    'der Arm ist nicht losgefahren oder hat sofort angehalten und steht dort; nichts wurde aufgezeichnet',
    'Kabel, Stecker oder Schnittstelle des Tasters reparieren und den Stift von Hand berühren, dann touchcal resume, wo ein Lauf wartet, ' +
      'touchcal clear, wo er abgebrochen wurde, touchcal reset und ein neuer Lauf'),
  overtravel: told('zu weit gefahren', 'der Arm hielt zu weit hinter dem Auslösen an', 'der Arm hat angehalten und sich zurückgezogen',
    `den Stift prüfen und die Suchgeschwindigkeit verringern, ${kAnew}`),
  permission_lost: told('Bewegung gesperrt', 'Leistung, Betriebsart, Halt, Not-Halt oder eine offene Zelle haben die Bewegung gesperrt', kStopped,
    `Leistung, Fernbetrieb und Gelenkreferenzen herstellen, den Halt aufheben, die Zelle schließen, ${kResumeBroken}`),
  collision: told('Kollision', 'der Arm ist mit etwas zusammengestoßen', 'die Antriebe haben abgeschaltet; der Arm steht, wo er war',
    `Arm, Taster und Block ansehen, den Arm von Hand befreien, ${kAnew}`),
  motion_error: told('Bewegungsfehler', 'die Steuerung konnte eine Bewegung nicht ausführen', kStopped,
    `die Fehlernummer der Steuerung nachschlagen, ${kAnew}`),
  task_failed: told('Task der Steuerung abgebrochen', 'ein Task der Anwendung auf der Steuerung ist zu Ende', kStopped,
    `die Fehlernummer notieren, die Anwendung am Handgerät stoppen und starten und den Arm vom Block wegfahren, ${kResumeBroken}`),
  touch_deadline: told('Antastung zu lang', 'eine Antastung dauerte länger als ihre Frist', 'der Arm wurde gestoppt und steht, wo er war',
    'Halt und Monitorgeschwindigkeit prüfen, dann touchcal resume, um diese Antastung zu wiederholen, touchcal skip, um sie auszulassen, ' +
      'oder touchcal stop; in ABORTED touchcal clear, dann touchcal reset'),
  implausible_touch: told('Kontakt nicht glaubhaft', 'der gemeldete Kontakt kann nicht der der verlangten Antastung sein',
    'der Arm steht, wo er die Antastung beendet hat oder in ihr gehalten wurde; nichts wurde aufgezeichnet',
    `prüfen, ob die Datei des Arms zu diesem Arm gehört, ${kAnew}`),
  no_safe_way: told('kein freier Weg', 'von der Stellung des Arms führt kein kollisionsfreier Weg zur nächsten', kStill,
    'den Arm mit dem Handgerät vom Block wegfahren, am besten in seine Parkstellung, dann touchcal resume, um weiterzumachen, ' +
      'touchcal skip, um diese Antastung auszulassen, oder touchcal stop; in ABORTED touchcal clear, dann touchcal reset'),
  store_failed: told('Speichern nicht möglich', 'das Zustandsverzeichnis ließ sich nicht schreiben',
    'der Arm hat eine laufende Antastung beendet oder steht, wo ihn ein Stopp gelassen hat',
    'Platz auf der Platte schaffen, die Rechte des Zustandsverzeichnisses herstellen oder das Programm beenden, das die Datenbank sperrt, ' +
      'dann touchcal resume, wo der Lauf wartet; das Ende eines beendeten Laufs wird von selbst gespeichert; sonst touchcal clear und touchcal reset'),
  not_identifiable: told('Parameter nicht bestimmt', 'die Antastungen bestimmen die Parameter nicht', 'der Arm hat seine Antastungen beendet',
    'die Meldung des Ergebnisses lesen; das Rezept ändern und einen neuen Lauf machen'),
  daemon_restarted: told('Dienst neu gestartet', 'der Dienst wurde während des Laufs neu gestartet',
    'der Arm steht, wo ihn das Ende des letzten Dienstes gelassen hat: von ihm zurückgezogen oder ohne Verbindung angehalten',
    'touchcal resume, um hinter der letzten gespeicherten Antastung weiterzumachen, oder touchcal stop, um den Lauf so zu beenden; ' +
      'in ABORTED geht er nicht weiter: touchcal clear, dann touchcal reset'),
  block_moved: told('Block bewegt', 'der Block steht nicht, wo er gefunden wurde', 'der Arm hat bei dieser Antastung angehalten oder sich von ihr zurückgezogen',
    'touchcal stop, oder touchcal clear, wo der Lauf abgebrochen wurde, dann touchcal reset und touchcal locate, um den Block wieder zu finden; ' +
      'touchcal resume macht weiter, wo der Block sicher steht, wie er gefunden wurde'),
  state_missing: told('Zustand der Steuerung fehlt', 'die Steuerung meldet ihren Zustand nicht mehr', 'der Arm wurde angehalten',
    'den Bildschirm der Steuerung und den Arm ansehen, dann touchcal resume, um weiterzumachen, oder touchcal stop'),
  internal_error: told('innerer Fehler', 'der Dienst stieß auf einen eigenen Fehler', 'der Arm wurde angehalten und steht, wo er war',
    `die Meldung notieren und weitergeben, ${kAnew}`),
  computation_slow: told('Rechnung dauert lange', 'eine Rechnung dauert ungewöhnlich lange', 'der Arm beendet eine laufende Antastung, dann steht er',
    'warten: der Lauf geht von selbst weiter und diese Warnung endet mit der Rechnung; oder touchcal stop, das den Arm sofort anhält'),
  store_slow: told('Platte langsam', 'die Platte braucht ungewöhnlich lange zum Speichern',
    'der Arm beendet eine laufende Antastung, dann steht er, bis sie gespeichert ist',
    'die Platte des Zustandsverzeichnisses ansehen; der Lauf geht von selbst weiter und diese Warnung endet, wenn sie geantwortet hat; touchcal stop hält den Arm sofort an'),
  run_resumed: told('Lauf fortgesetzt', 'der Lauf ging nach einer neuen Bestätigung weiter',
    'der Arm fuhr an eine sichere Stelle und dann zur nächsten Antastung', 'lesen, was vorher geprüft wurde; sonst ist nichts zu tun'),
  block_to_move: told('Block umsetzen', 'der Block ist an einen anderen Platz zu bringen',
    'der Arm steht still; hat er schon angetastet, in seiner Parkstellung',
    'den Block an den genannten Platz bringen, dann touchcal resume; oder touchcal stop'),
};

export const kFaultTitlesDe: Readonly<Record<string, string>> =
    Object.fromEntries(Object.entries(kFaults).map(([code, [title]]) => [code, title]));
export const kFaultsDe: Readonly<Record<string, FaultWords>> =
    Object.fromEntries(Object.entries(kFaults).map(([code, [, words]]) => [code, words]));
