import {useEffect, useRef} from 'preact/hooks';
import uPlot from 'uplot';
import {useShownTheme} from './theme.ts';

export interface Line { name: string; values: (number | null)[] }

interface Props {
  title: string;
  x: number[];
  lines: Line[];
  height: number;
  isLog?: boolean;
  isCounted?: boolean;  // x are numbers of runs: whole
  /** Draws numbers of the axes and of the legend. */
  write: (value: number) => string;
}

/** Grey lines that differ by their dashes: colour is for what is wrong. */
const kDashes = [[], [6, 4], [2, 3], [10, 3, 2, 3], [1, 4], [12, 6]];

/** Ticks at whole numbers only. */
const kWhole = {incrs: [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000], values: (_: uPlot, ticks: number[]) => ticks.map(String)};

/** Curves over x, as wide as their place. */
export function Curve({title, x, lines, height, isLog, isCounted, write}: Props) {
  const place = useRef<HTMLDivElement>(null);
  const plot = useRef<uPlot | null>(null);
  const theme = useShownTheme();  // the colours are read when the curve is made
  const shape = `${lines.map(({name}) => name).join('\n')}\n${isLog}\n${height}\n${title}`;

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
      legend: {show: lines.length > 1},
      cursor: {y: false},
      series: [
        {},
        ...lines.map(({name}, i) => ({
          label: name, stroke: ink, width: 1.5, dash: kDashes[i % kDashes.length]!, points: {show: x.length < 30},
          value: (_: uPlot, value: number | null) => (value === null ? '–' : write(value)),
        })),
      ],
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
  }, [x, lines]);

  const last = lines[0]?.values[lines[0].values.length - 1];
  const label = `${title}${last === null || last === undefined ? '' : `: ${write(last)}`}`;
  return <div class="curve" ref={place} role="img" aria-label={label} />;
}
