import {useEffect, useRef} from 'preact/hooks';
import uPlot from 'uplot';
import {kPaths, type Shape} from './symbol.tsx';
import {useShownTheme} from './theme.ts';

export interface Line {
  name: string;
  values: (number | null)[];
  stroke?: Stroke;  // how it is drawn; without it by its place among the lines
}
/** `isJoined`: it goes on over values that were left out. */
export interface Stroke { dash: number; width: number; hasPoints: boolean; isJoined: boolean }
/** A symbol at a point: the value of x that has this index. */
export interface Mark { index: number; value: number; shape: Shape }

interface Props {
  title: string;
  x: number[];
  xName: string;  // what x counts
  lines: Line[];
  marks?: Mark[];
  height: number;
  isLog?: boolean;
  isCounted?: boolean;  // x are numbers of runs: whole
  /** Draws numbers of the axes and of the legend. */
  write: (value: number) => string;
}

/** Grey lines that differ by their dashes: colour is for what is wrong. */
const kDashes = [[], [6, 4], [2, 3], [10, 3, 2, 3], [1, 4], [12, 6]];
/** The same for the borders that the legend is made of. */
const kBorders = ['solid', 'dashed', 'dotted', 'double', 'dotted', 'dashed'];

/** Ticks at whole numbers only. */
const kWhole = {incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000], values: (_: uPlot, ticks: number[]) => ticks.map(String)};

const strokeOf = ({stroke}: Line, i: number): Stroke => stroke ?? {dash: i % kDashes.length, width: 1.5, hasPoints: true, isJoined: false};

/** One value alone is not seen as a line. */
const isSingle = ({values}: Line): boolean => values.filter((value) => value !== null).length === 1;

const kMark_px = 16;
const kNoMarks: Mark[] = [];

/** In the colours of a warning or of a fault, above its point; below where there is no room. */
function drawMarks(plot: uPlot, marks: Mark[], style: CSSStyleDeclaration): void {
  const {ctx, bbox} = plot;
  const scale = (devicePixelRatio * kMark_px) / 18;  // the symbols are drawn on 18 by 18
  for (const {index, value, shape} of marks) {
    const x = plot.data[0][index];
    if (x === undefined) continue;
    const middle = plot.valToPos(x, 'x', true);
    if (middle < bbox.left || middle > bbox.left + bbox.width) continue;
    const place = plot.valToPos(value, 'y', true);
    const size = 18 * scale;
    const gap = 5 * devicePixelRatio;
    const top = place - gap - size < 0 ? place + gap : place - gap - size;
    const kind = shape === 'fault' ? 'fault' : 'warning';
    const path = new Path2D(kPaths[shape]);
    ctx.save();
    ctx.translate(middle - size / 2, top);
    ctx.scale(scale, scale);
    ctx.fillStyle = style.getPropertyValue(`--${kind}-ground`).trim();
    ctx.strokeStyle = style.getPropertyValue(`--${kind}`).trim();
    ctx.lineWidth = 2;
    ctx.lineJoin = 'round';
    ctx.setLineDash([]);
    ctx.fill(path);
    ctx.stroke(path);
    ctx.restore();
  }
}

/** Curves over x, as wide as their place. */
export function Curve({title, x, xName, lines, marks = kNoMarks, height, isLog, isCounted, write}: Props) {
  const place = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const theme = useShownTheme();  // the colours are read when the curve is made
  const shape = `${lines.map((line) => `${line.name} ${isSingle(line)}`).join('\n')}\n${isLog}\n${height}\n${title}\n${xName}`;
  const drawn = useRef(marks);
  drawn.current = marks;

  useEffect(() => {
    const element = place.current;
    if (!element) return;
    const style = getComputedStyle(element);
    const ink = style.getPropertyValue('--ink').trim() || '#333';
    const faint = style.getPropertyValue('--line').trim() || '#ccc';
    const axis = {stroke: ink, grid: {stroke: faint, width: 1}, ticks: {stroke: faint, width: 1}, font: '12px system-ui, sans-serif'};
    const width = (): number => Math.max(120, element.clientWidth);
    plot.current = new uPlot({
      width: width(),
      height,
      scales: {x: {time: false}, y: isLog ? {distr: 3} : {}},
      axes: [{...axis, size: 28, ...(isCounted ? kWhole : {})}, {...axis, size: 56, values: (_, ticks) => ticks.map((tick) => (tick === null ? '' : write(tick)))}],
      legend: {show: lines.length > 1, markers: {dash: (_, i) => kBorders[i === 0 ? 0 : strokeOf(lines[i - 1]!, i - 1).dash]!}},
      cursor: {y: false},
      series: [
        {label: xName, value: (_: uPlot, value: number | null) => (value === null ? '–' : String(value))},
        ...lines.map((line, i) => {
          const {dash, width: stroke_px, hasPoints, isJoined} = strokeOf(line, i);
          return {
            label: line.name, stroke: ink, width: stroke_px, dash: kDashes[dash]!, spanGaps: isJoined,
            points: {show: isSingle(line) || (hasPoints && x.length < 30)},
            value: (_: uPlot, value: number | null) => (value === null ? '–' : write(value)),
          };
        }),
      ],
      hooks: {draw: [(of) => drawMarks(of, drawn.current, style)]},
    }, [x, ...lines.map(({values}) => values)] as uPlot.AlignedData, element);
    const follow = new ResizeObserver(() => plot.current?.setSize({width: width(), height}));
    follow.observe(element);
    return () => {
      follow.disconnect();
      plot.current?.destroy();
      plot.current = null;
    };
  }, [shape, theme]);

  useEffect(() => {
    plot.current?.setData([x, ...lines.map(({values}) => values)] as uPlot.AlignedData);
  }, [x, lines, marks]);

  const last = lines[0]?.values[lines[0].values.length - 1];
  const label = `${title}${last === null || last === undefined ? '' : `: ${write(last)}`}`;
  return <div class="curve" ref={place} role="img" aria-label={label} />;
}
