// The API's documents about a cell that is set up.

export type SetupSection = 'arm' | 'block' | 'probe' | 'space' | 'limits' | 'tools';
export type SetupKind = 'text' | 'number' | 'numbers' | 'yes_no' | 'count' | 'sides' | 'arm';

/** touchcal/setup/1, also while it is not whole: what a person has typed is in it as it was typed. */
export type SetupAnswers = Record<string, unknown>;

export interface SetupQuestion {
  pointer: string;        // RFC 6901, of the answer
  section: SetupSection;
  kind: SetupKind;        // count: the answer is a list, of which it is asked how long it is
  optional: boolean;      // null is an answer
  count: number | null;   // of numbers: how many
  prompt: string;
  unit: string;
  explanation: string;
  choices: string[];
  guessed: boolean;       // nobody has answered it
  new_entry: Record<string, unknown> | null;
}

export interface SetupRefused {
  pointer: string;      // of the answer; of a place in `file` where there is one
  sentence: string;
  remedy: string;
  file: string | null;
}

export interface SetupCheck {
  schema: 'touchcal/setup-check/1';
  passes: boolean | null;    // null: not known to the daemon, as the arm's file is at the cell
  refused: SetupRefused[];
  remarks: string[];
  files: {name: string; text: string}[];
  scene_svg: string | null;
  answers: SetupAnswers;     // whole: with the defaults of what is not answered, or refused
  questions: SetupQuestion[];
}
