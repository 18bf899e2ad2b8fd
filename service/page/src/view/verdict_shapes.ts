import type {VerdictName} from '../api/documents.ts';
import type {Shape} from './symbol.tsx';

/** The shape beside the word of a verdict. */
export const kVerdictShapes: Record<VerdictName, Shape> = {accepted: 'ok', rejected: 'fault', incomplete: 'warning', none: 'work'};
