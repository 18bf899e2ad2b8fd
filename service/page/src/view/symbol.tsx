/** A shape for what a colour says: colour alone says nothing to many eyes. */
export type Shape = 'ok' | 'rest' | 'work' | 'wait' | 'warning' | 'fault' | 'unknown' | 'later';

const kPaths: Record<Shape, string> = {
  ok: 'M3 9l4 4 8-9',
  rest: 'M4 9h10',
  work: 'M5 3l9 6-9 6z',
  wait: 'M6 3v12M12 3v12',
  warning: 'M9 2l8 14H1zM9 7v4M9 13v1',
  fault: 'M5 1h8l4 4v8l-4 4H5l-4-4V5zM9 5v5M9 12v1',
  unknown: 'M6 6a3 3 0 1 1 3 4v2M9 14v1',
  later: 'M9 3a6 6 0 1 0 .1 0M9 6v3l2 2',
};

export function Symbol({shape}: {shape: Shape}) {
  return (
    <svg class={`symbol ${shape}`} viewBox="0 0 18 18" width="18" height="18" aria-hidden="true" focusable="false">
      <path d={kPaths[shape]} />
    </svg>
  );
}
