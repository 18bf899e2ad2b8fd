import type {StateName} from '../api/documents.ts';

/** A shape for what a colour says: colour alone says nothing to many eyes. */
export type Shape =
  | 'ok' | 'rest' | 'work' | 'wait' | 'warning' | 'fault' | 'unknown' | 'later' | 'lost' | 'notReady' | 'locating' | 'motionDisabled' | 'blockToMove' | 'person'
  | StateName;

/** Each state has its own: what is under way has dots behind it. */
export const kPaths: Record<Shape, string> = {
  ok: 'M3 9l4 4 8-9',
  rest: 'M4 9h10',
  work: 'M5 3l9 6-9 6z',
  wait: 'M6 3v12M12 3v12',
  warning: 'M9 2l8 14H1zM9 7v4M9 13v1',
  fault: 'M5 1h8l4 4v8l-4 4H5l-4-4V5zM9 5v5M9 12v1',
  unknown: 'M6 6a3 3 0 1 1 3 4v2M9 14v1',
  later: 'M9 3a6 6 0 1 0 .1 0M9 6v3l2 2',
  lost: 'M7 6L5 4a3 3 0 0 0-3 4l3 3M11 12l2 2a3 3 0 0 0 3-4l-3-3M3 15L15 3',
  notReady: 'M9 2a7 7 0 1 0 .1 0M5 9h8',
  motionDisabled: 'M9 2a7 7 0 1 0 .1 0M4 4l10 10',
  blockToMove: 'M1 9h7v7H1zM4 6V3h9v10M9.5 9.5L13 13l3.5-3.5',
  person: 'M9 2a3.5 3.5 0 1 0 .1 0M2 17c0-4 3-6 7-6s7 2 7 6',
  locating: 'M9 5a4 4 0 1 0 .1 0M9 1v4M9 13v4M1 9h4M13 9h4',
  STOPPED: 'M3 3h12v12H3z',
  RESETTING: 'M14 5a6 6 0 1 0 1 4M14 1v4h-4',
  IDLE: 'M9 2a7 7 0 1 0 .1 0M5 9l3 3 5-6',
  STARTING: 'M3 3v12M7 3l8 6-8 6z',
  EXECUTE: 'M4 2l12 7-12 7z',
  COMPLETING: 'M3 3l6 6-6 6M10 3l5 6-5 6',
  COMPLETE: 'M4 17V2h11l-3 4 3 4H4',
  HOLDING: 'M5 3v12M10 3v12M14 9h.1M16.5 9h.1',
  HELD: 'M6 3v12M12 3v12',
  UNHOLDING: 'M3 3v12M7 3v12M11 5l5 4-5 4z',
  SUSPENDING: 'M4 2h8M4 16h8M4 2l8 14M12 2L4 16M14 9h.1M16.5 9h.1',
  SUSPENDED: 'M4 2h10M4 16h10M5 2l8 14M13 2L5 16',
  UNSUSPENDING: 'M2 2h7M2 16h7M2 2l7 14M9 2L2 16M12 5l5 4-5 4z',
  STOPPING: 'M2 4h10v10H2zM14 9h.1M16.5 9h.1',
  ABORTING: 'M3 3l9 12M12 3L3 15M14 9h.1M16.5 9h.1',
  ABORTED: 'M5 1h8l4 4v8l-4 4H5l-4-4V5zM6 6l6 6M12 6l-6 6',
  CLEARING: 'M3 15l7-12 4 3-7 9zM3 15h12',
};

export function Symbol({shape}: {shape: Shape}) {
  return (
    <svg class={`symbol ${shape}`} viewBox="0 0 18 18" width="18" height="18" aria-hidden="true" focusable="false">
      <path d={kPaths[shape]} />
    </svg>
  );
}
