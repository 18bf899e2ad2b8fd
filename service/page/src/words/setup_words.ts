// Words of the form of a new cell: they come with it. What is asked comes from the daemon.
import type {SetupRefused, SetupSection} from '../api/setup_documents.ts';
import {fill, type Language} from '../model/format.ts';

const en = {
  title: 'Set up a cell',
  intro: 'Nothing here changes this daemon or moves the arm. At the end you download the answers; the command below writes the cell’s files from them, at the cell. Those files are the truth.',
  forEngineer: 'This is for an engineer: sign in as one.',
  sections_arm: 'Arm and where it stands',
  sections_block: 'Block',
  sections_probe: 'Probe',
  sections_space: 'Space around it',
  sections_limits: 'Limits',
  sections_tools: 'Tools, recipe and controller',
  guessed: 'assumed',
  optional: 'may stay empty',
  entryAdd: 'Add one',
  entryRemove: 'Remove the last',
  entries: '{count} now',
  touched: 'Touched',
  sideName: 'Name of side {side}',
  armOther: 'another: a file, a URDF, a table',
  armOtherName: 'File, or urdf FILE BASE TIP, or dh FILE standard',
  numberOf: '{prompt}: {name}',
  joint: 'joint {number}',
  empty: 'Nothing is given: type an answer.',
  noNumber: 'This is no number: digits with a point or a comma before decimals, nothing between thousands (1500 or 1.5, not 1,500).',
  asking: 'The daemon is asked…',
  busy: 'The daemon is busy: it is asked again.',
  lost: 'The daemon does not answer: it is asked again. What you type is kept.',
  passes: 'The daemon takes these files (touchcald --check).',
  passesNot: 'Not yet a cell: {count} to mend.',
  passesUnknown: 'The answers are in order. Whether the files pass is seen at the cell.',
  guessedCount: '{count} answers are assumed: nobody has given them.',
  remarks: 'Doubtful',
  whole: 'Of the whole cell',
  scene: 'The scene in three views: arm in its park posture, probe, block, boxes',
  sceneNone: 'No scene: the arm’s file is at the cell, where touchcal setup draws it (--scene).',
  sceneWords: 'Orange: the arm, parked. Dark: probe. Grey: block and plate, the touched faces green. Red: kept out of. Dashed: workspace box.',
  sceneOld: 'The scene is of earlier answers.',
  download: 'Download setup.json',
  downloadNot: 'Mend what is refused first.',
  command: 'Then, at the cell, where its touches are planned too:',
  load: 'Load a setup.json',
  loadNot: 'This file holds no answers of touchcal setup (touchcal/setup/1, at most 64 KiB).',
  loaded: 'The answers of “{name}” are in the form.',
  anew: 'Begin anew',
  anewAsk: 'All answers in this form will be gone.',
  anewYes: 'Yes, begin anew',
  cancel: 'Cancel',
  files: 'The files that it would be',
  close: 'Close',
};

export type SetupWordKey = keyof typeof en;
export type SetupWords = Readonly<Record<SetupWordKey, string>>;

const fr: SetupWords = {
  title: 'Configurer une cellule',
  intro: 'Rien ici ne modifie ce démon ni ne bouge le bras. À la fin vous téléchargez les réponses ; la commande ci-dessous en écrit les fichiers de la cellule, sur place. Ce sont ces fichiers qui font foi.',
  forEngineer: 'C’est pour un ingénieur : identifiez-vous comme tel.',
  sections_arm: 'Le bras et son emplacement',
  sections_block: 'Bloc',
  sections_probe: 'Palpeur',
  sections_space: 'L’espace autour',
  sections_limits: 'Limites',
  sections_tools: 'Outils, recette et baie',
  guessed: 'supposé',
  optional: 'peut rester vide',
  entryAdd: 'En ajouter',
  entryRemove: 'Retirer le dernier',
  entries: '{count} pour l’instant',
  touched: 'Palpé',
  sideName: 'Nom du côté {side}',
  armOther: 'un autre : un fichier, un URDF, une table',
  armOtherName: 'Fichier, ou urdf FICHIER BASE POINTE, ou dh FICHIER standard',
  numberOf: '{prompt} : {name}',
  joint: 'articulation {number}',
  empty: 'Rien n’est donné : tapez une réponse.',
  noNumber: 'Ce n’est pas un nombre : des chiffres avec un point ou une virgule avant les décimales, rien entre les milliers (1500 ou 1.5, pas 1,500).',
  asking: 'Le démon est interrogé…',
  busy: 'Le démon est occupé : il est interrogé de nouveau.',
  lost: 'Le démon ne répond pas : il est interrogé de nouveau. Ce que vous tapez est gardé.',
  passes: 'Le démon accepte ces fichiers (touchcald --check).',
  passesNot: 'Pas encore une cellule : {count} à corriger.',
  passesUnknown: 'Les réponses sont en ordre. On voit sur place si les fichiers passent.',
  guessedCount: '{count} réponses sont supposées : personne ne les a données.',
  remarks: 'Douteux',
  whole: 'Pour toute la cellule',
  scene: 'La scène en trois vues : bras au repos, palpeur, bloc, volumes',
  sceneNone: 'Pas de scène : le fichier du bras est sur place, où touchcal setup la dessine (--scene).',
  sceneWords: 'Orange : le bras au repos. Foncé : palpeur. Gris : bloc et plaque, les faces palpées en vert. Rouge : à éviter. Tirets : volume de travail.',
  sceneOld: 'La scène est celle de réponses antérieures.',
  download: 'Télécharger setup.json',
  downloadNot: 'Corrigez d’abord ce qui est refusé.',
  command: 'Puis, sur place, où les palpages sont planifiés aussi :',
  load: 'Charger un setup.json',
  loadNot: 'Ce fichier n’a pas de réponses de touchcal setup (touchcal/setup/1, au plus 64 Kio).',
  loaded: 'Les réponses de « {name} » sont dans le formulaire.',
  anew: 'Recommencer',
  anewAsk: 'Toutes les réponses de ce formulaire seront perdues.',
  anewYes: 'Oui, recommencer',
  cancel: 'Annuler',
  files: 'Les fichiers que cela donnerait',
  close: 'Fermer',
};

const de: SetupWords = {
  title: 'Zelle einrichten',
  intro: 'Nichts hier ändert diesen Dienst oder bewegt den Arm. Am Ende laden Sie die Antworten herunter; der Befehl unten schreibt daraus die Dateien der Zelle, an der Zelle. Diese Dateien gelten.',
  forEngineer: 'Das ist für einen Ingenieur: melden Sie sich als solcher an.',
  sections_arm: 'Der Arm und wo er steht',
  sections_block: 'Block',
  sections_probe: 'Taster',
  sections_space: 'Der Raum darum',
  sections_limits: 'Grenzen',
  sections_tools: 'Werkzeuge, Rezept und Steuerung',
  guessed: 'angenommen',
  optional: 'kann leer bleiben',
  entryAdd: 'Einen hinzufügen',
  entryRemove: 'Den letzten entfernen',
  entries: 'jetzt {count}',
  touched: 'Angetastet',
  sideName: 'Name der Seite {side}',
  armOther: 'ein anderer: eine Datei, ein URDF, eine Tabelle',
  armOtherName: 'Datei, oder urdf DATEI BASIS SPITZE, oder dh DATEI standard',
  numberOf: '{prompt}: {name}',
  joint: 'Gelenk {number}',
  empty: 'Nichts angegeben: tippen Sie eine Antwort.',
  noNumber: 'Das ist keine Zahl: Ziffern mit Punkt oder Komma vor den Dezimalen, nichts zwischen den Tausendern (1500 oder 1.5, nicht 1,500).',
  asking: 'Der Dienst wird gefragt…',
  busy: 'Der Dienst ist beschäftigt: er wird wieder gefragt.',
  lost: 'Der Dienst antwortet nicht: er wird wieder gefragt. Was Sie tippen, bleibt.',
  passes: 'Der Dienst nimmt diese Dateien (touchcald --check).',
  passesNot: 'Noch keine Zelle: {count} zu berichtigen.',
  passesUnknown: 'Die Antworten sind in Ordnung. Ob die Dateien bestehen, zeigt sich an der Zelle.',
  guessedCount: '{count} Antworten sind angenommen: niemand hat sie gegeben.',
  remarks: 'Zweifelhaft',
  whole: 'Zur ganzen Zelle',
  scene: 'Die Szene in drei Ansichten: Arm in Parkstellung, Taster, Block, Kästen',
  sceneNone: 'Keine Szene: die Datei des Arms ist an der Zelle, wo touchcal setup sie zeichnet (--scene).',
  sceneWords: 'Orange: der geparkte Arm. Dunkel: Taster. Grau: Block und Platte, angetastete Flächen grün. Rot: zu meiden. Gestrichelt: Arbeitsraum.',
  sceneOld: 'Die Szene ist von früheren Antworten.',
  download: 'setup.json herunterladen',
  downloadNot: 'Berichtigen Sie zuerst, was abgelehnt ist.',
  command: 'Dann, an der Zelle, wo auch ihre Antastungen geplant werden:',
  load: 'Eine setup.json laden',
  loadNot: 'Diese Datei hat keine Antworten von touchcal setup (touchcal/setup/1, höchstens 64 KiB).',
  loaded: 'Die Antworten von „{name}“ sind im Formular.',
  anew: 'Neu beginnen',
  anewAsk: 'Alle Antworten in diesem Formular sind dann weg.',
  anewYes: 'Ja, neu beginnen',
  cancel: 'Abbrechen',
  files: 'Die Dateien, die es gäbe',
  close: 'Schließen',
};

export const kSetupWords: Readonly<Record<Language, SetupWords>> = {en, fr, de};

export const sectionKey = (section: SetupSection): SetupWordKey => `sections_${section}`;

/** A unit as it stands beside a field. */
const kUnits: Readonly<Record<string, Readonly<Record<Language, string>>>> = {
  deg: {en: '°', fr: '°', de: '°'},
  C: {en: '°C', fr: '°C', de: '°C'},
  'YYYY-MM-DD': {en: 'YYYY-MM-DD', fr: 'AAAA-MM-JJ', de: 'JJJJ-MM-TT'},
};
export const unitWords = (unit: string, language: Language): string => kUnits[unit]?.[language] ?? unit;

/** What is said most of a number, as the daemon says it in English; a refusal of other words stays as it is. */
const kRefusals: readonly {sentence: RegExp; remedy: RegExp; words: Readonly<Record<Exclude<Language, 'en'>, string>>}[] = [
  {sentence: /^is (\S+)$/, remedy: /^give ([-\d.e+]+) to ([-\d.e+]+)$/, words: {fr: 'vaut {1} ; donnez de {2} à {3}', de: 'ist {1}; geben Sie {2} bis {3}'}},
  {sentence: /^is (\S+)$/, remedy: /^give at least ([-\d.e+]+)$/, words: {fr: 'vaut {1} ; donnez au moins {2}', de: 'ist {1}; geben Sie mindestens {2}'}},
  {sentence: /^is (\S+)$/, remedy: /^give at most ([-\d.e+]+)$/, words: {fr: 'vaut {1} ; donnez au plus {2}', de: 'ist {1}; geben Sie höchstens {2}'}},
  {sentence: /^is (\S+)$/, remedy: /^give a number over 0$/, words: {fr: 'vaut {1} ; donnez un nombre supérieur à 0', de: 'ist {1}; geben Sie eine Zahl über 0'}},
  {sentence: /^is (\S+)$/, remedy: /^give a whole number from (\d+) to (\d+)$/,
   words: {fr: 'vaut {1} ; donnez un nombre entier de {2} à {3}', de: 'ist {1}; geben Sie eine ganze Zahl von {2} bis {3}'}},
  {sentence: /^is there twice$/, remedy: /^name each (?:place|tool) differently$/, words: {fr: 'y est deux fois ; donnez des noms différents', de: 'kommt zweimal vor; geben Sie verschiedene Namen'}},
  {sentence: /^is not above "min_mm" in each of x, y and z \(y is down\)$/, remedy: /^exchange or correct them$/,
   words: {fr: 'n’est pas au-dessus du plus petit pour chacun de x, y et z (y va vers le bas) ; échangez-les ou corrigez-les',
           de: 'ist nicht bei jedem von x, y und z größer als das kleinste (y zeigt nach unten); vertauschen oder berichtigen Sie sie'}},
];

/** A refusal in the page's language; null where the daemon's English has to do. */
export function refusalWords({sentence, remedy, file}: SetupRefused, language: Language): string | null {
  if (language === 'en' || file !== null) return null;
  for (const known of kRefusals) {
    const first = known.sentence.exec(sentence);
    const second = known.remedy.exec(remedy);
    if (first && second) return fill(known.words[language], Object.fromEntries([...first.slice(1), ...second.slice(1)].map((value, i) => [String(i + 1), value])));
  }
  return null;
}
